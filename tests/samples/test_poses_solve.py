"""Every pose of every picture, from the pixels to a certified map."""

from __future__ import annotations

import json
from typing import get_args

import numpy as np
import pytest
import shapely
from numpy.typing import NDArray

from glid_nb import samples
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.trace import trace
from glid_nb.solvers import Pose, Status, solve

pytestmark = pytest.mark.slow

# Of all poses, with room: a retouched picture or solver may change the figures, not the verdict.
MOST_ENERGY = {"gentle": 2.4, "extreme": 3.2}
LEAST_SIGMA2 = {"gentle": 0.5, "extreme": 0.25}


def boundary_image(map: HarmonicMap) -> shapely.Polygon:
    """The image of the cage, thirty points an edge."""

    def ring(loop: NDArray[np.float64]) -> NDArray[np.float64]:
        t = np.linspace(0, 1, 30, endpoint=False)[:, None]
        ends = zip(loop, np.roll(loop, -1, axis=0), strict=True)
        return map(np.concatenate([(1 - t) * a + t * b for a, b in ends]))

    exterior, *holes = (ring(loop) for loop in map.domain.cage.loops)
    return shapely.Polygon(exterior, holes)


@pytest.mark.parametrize("name", samples.names())
def test_the_poses_are_reached_certified_and_in_the_frame(name: str) -> None:
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
        assert result.energy_iso < MOST_ENERGY[kind]
        assert np.abs(result.map(pose.handles) - pose.targets).max() < 1e-4
        shape = boundary_image(result.map)
        assert shape.is_valid, f"{kind}: limbs overlap"
        assert frame.contains(shape), f"{kind}: leaves the picture"
