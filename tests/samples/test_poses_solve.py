"""Every pose of every picture, from the pixels to a certified map."""

from __future__ import annotations

import json
from pathlib import Path
from typing import get_args

import numpy as np
import pytest
import shapely
from numpy.typing import NDArray

import glid_check
from glid_nb import samples
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.trace import trace
from glid_nb.minima import solve
from glid_nb.pose import Pose
from glid_nb.solvers import Options, Status

from ..support.domains import divided

pytestmark = pytest.mark.slow

# The limits hold for all poses with a margin, so small changes of pictures or solver keep the
# verdict.
MOST_ENERGY = {"gentle": 2.4, "extreme": 3.2}
LEAST_SIGMA2 = {"gentle": 0.5, "extreme": 0.25}


def boundary_image(map: HarmonicMap) -> shapely.Polygon:
    """The image of the cage, thirty points per edge."""

    def ring(loop: NDArray[np.float64]) -> NDArray[np.float64]:
        t = np.linspace(0, 1, 30, endpoint=False)[:, None]
        ends = zip(loop, np.roll(loop, -1, axis=0), strict=True)
        return map(np.concatenate([(1 - t) * a + t * b for a, b in ends]))

    exterior, *holes = (ring(loop) for loop in map.domain.cage.loops)
    return shapely.Polygon(exterior, holes)


@pytest.mark.parametrize("name", samples.names())
def test_the_poses_are_reached_certified_and_in_the_frame(name: str, tmp_path: Path) -> None:
    image = samples.image(name)
    height, width = image.shape[:2]
    x, y = 10 * width / max(width, height), 10 * height / max(width, height)
    frame = shapely.box(-x, -y, x, y)
    domain = Domain.from_cage(trace(image).cage)
    for kind in get_args(samples.PoseKind):
        text = samples.pose_path(name, kind).read_text(encoding="utf-8")
        pose = Pose.from_dict(json.loads(text))
        result = solve(domain, pose)
        assert result.status is Status.CONVERGED
        assert result.certificate.certified
        assert result.certificate.sigma2_lower > LEAST_SIGMA2[kind]
        assert result.energy_distortion < MOST_ENERGY[kind]
        assert np.abs(result.map(pose.handles) - pose.targets).max() < 1e-4
        shape = boundary_image(result.map)
        assert shape.is_valid, f"{kind}: limbs overlap"
        assert frame.contains(shape), f"{kind}: leaves the picture"
        paths = [tmp_path / "map.json", tmp_path / "proof.json"]
        result.map.save(paths[0])
        result.certificate.save(paths[1])
        assert glid_check.main([str(path) for path in paths]) == 0


@pytest.mark.parametrize("name", ["bar", "frog"])
def test_a_random_division_of_the_edges_changes_neither_energy_nor_iterations(name: str) -> None:
    domain = Domain.from_cage(trace(samples.image(name)).cage)
    pose = Pose.from_dict(json.loads(samples.pose_path(name, "extreme").read_text("utf-8")))
    fine = divided(domain, lambda n: np.random.default_rng(n).integers(1, 6, n))
    result, least = (solve(d, pose, options=Options(restarts=0)) for d in (fine, domain))
    assert result.status is Status.CONVERGED
    assert result.energy < 1.01 * least.energy
    assert result.iterations <= least.iterations + 3
