"""Sessions of the editor for a lecture: ``python notebooks/sessions.py FOLDER``.

Each file holds one shape and one task, once for each method that is compared, as a pose of its own.
Open one with ``glid.Editor(path="FOLDER/hand-above-head.glid")``: clicking a pose shows what its
method makes of the task, and the handles can be dragged on from there.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path

import numpy as np

import glid_nb as glid
from glid_nb import methods
from glid_nb.methods import Method


def hand_above_head() -> glid.io.Document:
    """The gingerbread man of chapter 03: closed formulas fold his arm and head."""
    start = glid.io.load_pose(glid.samples.pose_path("gingerbread", "gentle"))
    targets = start.handles.copy()
    targets[4] = 0.0, 7.5
    compared = {
        "ours": methods.Newton(),
        "moving least squares": methods.MovingLeastSquares(),
        "mean value coordinates": methods.MeanValueCoordinates(),
        "Cauchy coordinates": methods.CauchyCoordinates(),
    }
    return session("gingerbread", glid.Pose(start.handles, targets), compared)


def ends_turned() -> glid.io.Document:
    """The bar of chapter 07 from rest: Newton's method with the plain Hessian halts on the way."""
    z = np.array([-6.2 - 1j, -6.2 + 1j, 6.2 - 1j, 6.2 + 1j])
    centre = np.array([-3, -3, 3, 3])
    w = centre + 1j * (z - centre)
    pose = glid.Pose(np.stack([z.real, z.imag], 1), np.stack([w.real, w.imag], 1))
    compared = {
        "Newton, projected": methods.Newton(),
        "Newton, unmodified": methods.NewtonUnmodified(),
    }
    return session("bar", pose, compared, glid.Options(align=False, restarts=0))


def limbs_crossed() -> glid.io.Document:
    """The gecko's outer limbs to the other side: several minima, and folds without a proof."""
    pose = glid.io.load_pose(glid.samples.pose_path("gecko", "extreme"))
    middle = pose.handles.mean(axis=0)
    far = np.argsort(np.linalg.norm(pose.handles - middle, axis=1))[-2:]
    targets = pose.handles.copy()
    targets[far] = 2 * middle - pose.handles[far]
    compared = {"ours": methods.Newton(), "moving least squares": methods.MovingLeastSquares()}
    return session("gecko", pose.with_targets(targets), compared)


SESSIONS = {
    "hand-above-head": hand_above_head,
    "ends-turned": ends_turned,
    "limbs-crossed": limbs_crossed,
}


def session(
    sample: str,
    pose: glid.Pose,
    compared: Mapping[str, Method],
    options: glid.Options | None = None,
) -> glid.io.Document:
    """A document with the pose once for each method; the editor solves a pose when it is shown."""
    image, how = glid.samples.image(sample), options or glid.Options()
    domain = glid.Domain.from_cage(glid.trace(image).cage)
    rest, energy = glid.HarmonicMap.identity(domain), glid.energies.SymmetricDirichlet()
    poses = [
        glid.io.NamedPose(name, pose, energy, how, rest, method, solution=None)
        for name, method in compared.items()
    ]
    return glid.io.Document(image, domain.cage, domain, glid.TraceOptions(), None, tuple(poses), 0)


def main() -> None:
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, made in SESSIONS.items():
        path = folder / f"{name}.glid"
        glid.io.save_document(made(), path)
        print("wrote", path)


if __name__ == "__main__":
    main()
