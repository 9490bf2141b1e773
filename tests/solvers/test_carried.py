"""A proof from carried values is confirmed by computing the values anew."""

from __future__ import annotations

import pytest

from glid_nb.certificate import certify
from glid_nb.energies import ARAP
from glid_nb.harmonic import HarmonicMap
from glid_nb.minima import solve
from glid_nb.pose import Pose
from glid_nb.solvers import Options, Progress, Status

from ..support.domains import domain

pytestmark = pytest.mark.slow  # most of the time is compiling


def test_every_map_of_a_collapse_far_away_is_proved_anew() -> None:
    """ARAP has no barrier: handles pulled together far away crumple the shape to sigma_2 < 1e-6.

    Coefficients of several hundred leave rounding errors.
    """
    maps: dict[int, HarmonicMap] = {}

    def keep(progress: Progress) -> None:
        maps[len(progress.history)] = progress.map

    options = Options(align=False, restarts=0)
    ring = domain("ring")
    pose = Pose([(0.96, -2.2), (2.2, 0.5), (-2.2, 0.5)], [(662, 0), (662, 0.05), (662, -0.05)])
    result = solve(ring, pose, ARAP(), options, HarmonicMap.identity(ring), keep)
    certificates = [certify(map) for map in [*maps.values(), result.map]]
    assert all(c.certified for c in certificates)
    assert min(c.sigma2_lower for c in certificates) < 1e-6
    # Finer panels do not help against rounding, so the solve ends instead of splitting all.
    assert result.status is Status.BLOCKED
    assert result.n_panels < 200


def test_one_handle_takes_the_shape_along_however_far() -> None:
    ring = domain("ring")
    start = HarmonicMap.identity(ring)
    pose = Pose([(0.96, -2.2)], [(662, 0)])
    result = solve(ring, pose, ARAP(), Options(align=False, restarts=0), start)
    assert result.status.ok, result.status
    assert result.energy < 1e-6
    assert result.certificate.sigma2_lower > 0.999


def test_a_perfect_pose_has_converged() -> None:
    """The energy is then 0, so a relative comparison makes no sense."""
    ring = domain("ring")
    start = HarmonicMap.identity(ring)
    pose = Pose([(2.2, 0.5)], [(-3, 30)])
    result = solve(ring, pose, ARAP(), Options(align=False, restarts=0), start)
    assert result.status.ok, result.status
    assert result.energy < 1e-9
