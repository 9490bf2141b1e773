"""Golden numbers of the package for the tests of ``glid_nb/page/js/live``.

``python -m tests.page.live.golden`` writes ``tests/page/live/*.json`` again.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

import glid_nb as glid
from glid_nb._runtime import double_precision
from glid_nb.energies import by_name
from glid_nb.geometry import graded_panels
from glid_nb.harmonic import HarmonicMap
from glid_nb.page import coefficients_of
from glid_nb.solvers import evaluation, problem
from glid_nb.solvers.discretisation import discretise

FOLDER = Path(__file__).parent
SAMPLES = ("bar", "teapot", "frog", "gecko")
"""Shapes with 0, 1, 2 and 0 holes."""
ENERGIES = (("iso", 1.0), ("exp", 0.2), ("exp", 1.0), ("amips", 0.5), ("mips", 1.0), ("arap", 1.0))
MINIMA = (("iso", 1.0), ("exp", 0.2), ("amips", 0.5), ("arap", 1.0))
"""Energies, with their parameters, whose minima are compared."""


def minimum(domain: glid.Domain, pose: glid.Pose, name: str, s: float) -> glid.Result:
    energy = by_name(name, s)
    return glid.solve(domain, pose, energy, options=glid.Options(restarts=0))


def shape(name: str) -> tuple[glid.Domain, glid.Pose]:
    domain = glid.Domain.from_cage(glid.trace(glid.samples.image(name)).cage)
    return domain, glid.io.load_pose(glid.samples.pose_path(name, "extreme"))


@double_precision
def energies_of(map: HarmonicMap) -> list[float]:
    """The isometric energies of a map on graded panels, one for each entry of ENERGIES."""
    matrices = discretise(map.domain).matrices
    values = evaluation.products(matrices, problem.real_coefficients(map)).values
    named = [by_name(name, s) for name, s in ENERGIES]
    return [float(evaluation.energy_distortion(values, matrices, energy)) for energy in named]


def numbers_of(map: HarmonicMap) -> dict[str, Any]:
    """What the page must compute of a map: panels, energies, values and certificate."""
    panels = graded_panels(map.domain)
    proof = glid.certify(map)
    points = np.asarray(map.domain.cage.polygon.representative_point().coords)
    points = np.concatenate([points, map.domain.cage.exterior[::9]])
    fz, fzbar = map.wirtinger(points)
    return {
        "panels": len(panels),
        "starts": [float(np.abs(panels.start).sum()), float(panels.length.sum())],
        "energies": energies_of(map),
        "sigma2_lower": proof.sigma2_lower,
        "sigma1_upper": proof.sigma1_upper,
        "k_upper": proof.k_upper,
        "windings": list(proof.windings),
        "points": points.tolist(),
        "images": map(points).tolist(),
        "fz": np.stack([fz.real, fz.imag], axis=1).tolist(),
        "fzbar": np.stack([fzbar.real, fzbar.imag], axis=1).tolist(),
    }


def golden(name: str) -> dict[str, Any]:
    domain, pose = shape(name)
    results = [minimum(domain, pose, *energy) for energy in MINIMA]
    map = results[0].map
    return {
        "outline": domain.to_dict(),
        "pose": pose.to_dict(),
        "coefficients": coefficients_of(map),
        **numbers_of(map),
        "minima": [energy_of_minimum(result) for result in results],
    }


def energy_of_minimum(result: glid.Result) -> float | None:
    """The energy of a solve that has converged; None for others, which end anywhere."""
    return result.energy if result.status is glid.Status.CONVERGED else None


def map_of(data: dict[str, Any]) -> HarmonicMap:
    """The map of a golden file."""
    phi_re, phi_im, psi_re, psi_im = np.reshape(data["coefficients"], (4, -1))
    domain = glid.Domain.from_dict(data["outline"])
    return HarmonicMap(domain, phi_re + 1j * phi_im, psi_re + 1j * psi_im)


if __name__ == "__main__":
    for name in SAMPLES:
        text = json.dumps(golden(name), separators=(",", ":"))
        (FOLDER / f"{name}.json").write_text(f"{text}\n", encoding="utf-8")
