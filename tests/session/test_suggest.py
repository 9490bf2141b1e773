"""The automatic pose: handles inside, spread out, and one or two of them moved."""

from __future__ import annotations

import numpy as np
import pytest

from glid_nb.geometry import Cage, Domain
from glid_nb.session.suggest import suggest_pose

T = np.linspace(0, 2 * np.pi, 40, endpoint=False)
CIRCLE = np.column_stack([np.cos(T), np.sin(T)])
SHAPES = {
    "disc": Cage(8 * CIRCLE),
    "ring": Cage(8 * CIRCLE, [5 * CIRCLE]),
    "angle": Cage([[0, 0], [10, 0], [10, 1], [1, 1], [1, 9], [0, 9]]),
    "bar": Cage([[-10, -1], [10, -1], [10, 1], [-10, 1]]),
    "triangle": Cage([[0, 0], [10, 0], [0, 0.5]]),
}


@pytest.fixture(params=SHAPES, ids=list(SHAPES))
def domain(request: pytest.FixtureRequest) -> Domain:
    return Domain.from_cage(SHAPES[request.param])


def test_handles_lie_inside_and_one_or_two_move(domain: Domain) -> None:
    pose = suggest_pose(domain)
    pose.check_inside(domain)
    assert 2 <= len(pose) <= 7
    moved = np.linalg.norm(pose.targets - pose.handles, axis=1) > 0
    assert 1 <= moved.sum() <= 2
    assert not moved[0]


def test_handles_are_spread_out(domain: Domain) -> None:
    handles = suggest_pose(domain).handles
    gaps = np.linalg.norm(handles[:, None] - handles, axis=2) + np.eye(len(handles)) * 1e9
    assert gaps.min() > 0.1 * domain.cage.longer_side


def test_the_number_of_handles_is_limited(domain: Domain) -> None:
    assert len(suggest_pose(domain, max_handles=2)) == 2


def test_both_ends_of_an_angle_get_a_handle() -> None:
    handles = suggest_pose(Domain.from_cage(SHAPES["angle"])).handles
    for end in ([10, 0.5], [0.5, 9]):
        assert np.linalg.norm(handles - end, axis=1).min() < 2


def test_the_same_shape_gives_the_same_pose(domain: Domain) -> None:
    first, second = suggest_pose(domain), suggest_pose(domain)
    np.testing.assert_array_equal(first.targets, second.targets)


def test_at_least_two_handles_are_asked_for() -> None:
    with pytest.raises(ValueError, match="max_handles is 1; it must be at least 2"):
        suggest_pose(Domain.from_cage(SHAPES["disc"]), max_handles=1)
