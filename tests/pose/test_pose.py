"""Handles and targets."""

from __future__ import annotations

import dataclasses
import math
import re
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb.geometry import Cage, Domain
from glid_nb.pose import Pose, PoseError

from ..support.domains import domain

coordinates = st.floats(-1e6, 1e6)


@given(
    handles=st.lists(st.tuples(coordinates, coordinates), unique=True, max_size=8),
    data=st.data(),
)
@settings(max_examples=25)
def test_a_pose_keeps_what_it_is_given(
    handles: list[tuple[float, float]], data: st.DataObject
) -> None:
    targets = data.draw(
        st.lists(st.tuples(coordinates, coordinates), min_size=len(handles), max_size=len(handles))
    )
    pose = Pose(handles, targets)
    assert len(pose) == len(handles)
    assert pose.handles.shape == pose.targets.shape == (len(handles), 2)
    assert pose.handles.tolist() == [list(p) for p in handles]
    again = Pose.from_dict({**pose.to_dict(), "lambda": "ignored"})
    assert again.to_dict() == pose.to_dict() == {
        "handles": [list(p) for p in handles],
        "targets": [list(p) for p in targets],
    }  # fmt: skip


def test_a_pose_is_immutable() -> None:
    handles = np.array([[0.0, 1.0]])
    pose = Pose(handles, [[2, 3]])
    handles[0] = 9
    assert pose.handles.tolist() == [[0, 1]]
    for array in (pose.handles, pose.targets):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1
    with pytest.raises(dataclasses.FrozenInstanceError):
        pose.targets = handles  # type: ignore[misc]
    moved = pose.with_targets([[5, 6]])
    assert moved.targets.tolist() == [[5, 6]]
    assert pose.targets.tolist() == [[2, 3]]


def test_names_go_where_their_handles_go() -> None:
    pose = Pose([[0, 0], [1, 0], [2, 0]], [[0, 0]] * 3, names=["head", "", "tail"])
    assert pose.only([2, 1]).names.tolist() == ["tail", ""]
    assert Pose.from_dict(pose.to_dict()).names.tolist() == ["head", "", "tail"]
    assert "names" not in pose.only([1]).to_dict()
    for wrong in (["head"], "abc", [1, 2, 3], 5):
        with pytest.raises(PoseError, match="names must be 3 texts, one per handle"):
            Pose(pose.handles, pose.targets, names=wrong)  # type: ignore[arg-type]


def test_a_number_that_cannot_be_is_named() -> None:
    pose = Pose([[0, 0], [1, 0]], [[0, 0]] * 2)
    for wrong, named in (([1, -1], r"scales\[1\] is -1"), ([1e3, None], r"scales\[0\] is 1000")):
        with pytest.raises(PoseError, match=rf"{named}; scales must be 2 numbers from 0.01 to 100"):
            Pose(pose.handles, pose.targets, scales=wrong)


def test_targets_may_coincide() -> None:
    assert len(Pose([[0, 0], [1, 0]], [[3, 3], [3, 3]])) == 2


@pytest.mark.parametrize(
    ("handles", "targets", "message"),
    [
        ([[0, 0], [1, 0]], [[0, 0]], "2 handles but 1 target;"),
        ([], [[0, 0]], "0 handles but 1 target;"),
        ([[0, 0], [1, 1], [0, 0]], [[0, 0]] * 3, r"handles 0 and 2 are the same point \(0, 0\)"),
        ([[0.0, 0], [-0.0, 0]], [[0, 0]] * 2, "handles 0 and 1 are the same point"),
        ([[3, 0], [1, 1], [1, 1], [3, 0]], [[0, 0]] * 4, "handles 1 and 2 are the same"),
        ([[math.nan, 0]], [[0, 0]], r"handles\[0\] is \(nan, 0\)"),
        ([[0, 0], [1, 0]], [[0, 0], [0, math.nan]], r"targets\[1\] is \(0, nan\)"),
        ([[0, 0]], [[math.inf, 0]], r"targets\[0\] is \(inf, 0\)"),
        ([[0, 0]], [[1e200, 0]], r"targets\[0\] is \(1e\+200, 0\); .* out of scale"),
        ([[0, None]], [[0, 0]], r"handles\[0\]"),
        ([0, 0], [[0, 0]], r"handles must be a list of \[x, y\] pairs; the shape is \(2,\)"),
        ([[0, 0, 0]], [[0, 0]], r"handles must be .* \(1, 3\)"),
        ([[0, 0]], [[0, 0], [0]], "targets must be a list of"),
        ([["left", 0]], [[0, 0]], "handles must be a list of"),
        ("handles", [[0, 0]], "handles must be a list of"),
        ([[1j, 0]], [[0, 0]], "handles must be a list of"),
        ({"x": 1}, [[0, 0]], "handles must be a list of"),
        (None, [[0, 0]], "handles"),
        ([[10**400, 0]], [[0, 0]], "handles"),
        (np.array([[1 + 2j]]), [[1, 2]], "handles"),
        ([[], []], [[], []], "handles"),
    ],
    ids=lambda value: str(value)[:24],
)
def test_bad_poses_are_refused(handles: Any, targets: Any, message: str) -> None:
    with pytest.raises(PoseError, match=message):
        Pose(handles, targets)


@pytest.mark.parametrize("data", [None, [], 3, "pose"])
def test_what_is_no_object_is_refused(data: Any) -> None:
    with pytest.raises(PoseError, match="a pose must be an object"):
        Pose.from_dict(data)


@pytest.mark.parametrize("key", ["handles", "targets"])
def test_missing_keys_are_named(key: str) -> None:
    data = {"handles": [[0, 0]], "targets": [[0, 0]]}
    del data[key]
    with pytest.raises(PoseError, match=f'lacks the key "{key}"'):
        Pose.from_dict(data)


def test_handles_must_lie_in_the_domain() -> None:
    d = domain("ring")
    inside, outside, in_hole = [2, 0.1], [9, 0.5], [0.1, 0.2]
    on_boundary = d.cage.exterior[3].tolist()
    Pose([inside, on_boundary], [[99, 99], [0, 0]]).check_inside(d)
    for point in (outside, in_hole):
        with pytest.raises(PoseError, match=re.escape(f"handle 1 at ({point[0]}, {point[1]})")):
            Pose([inside, point, outside[::-1]], [[0, 0]] * 3).check_inside(d)
    Pose([], []).check_inside(d)


def test_one_handle_outside_is_told_where_the_shape_is() -> None:
    domain = Domain.from_cage(Cage([[-10, -3], [10, -3], [10, 3], [-10, 3]]))
    with pytest.raises(PoseError, match=r"world coordinates.*x from -10 to 10 and y from -3 to 3"):
        Pose([[0, 8]], [[0, 0]]).check_inside(domain)


def test_the_bounds_of_a_shape_far_away_have_enough_digits() -> None:
    corners = np.array([[-10, -3], [10, -3], [10, 3], [-10, 3]]) + 1e6
    with pytest.raises(PoseError, match="x from 999990 to 1000010 and y from 999997 to 1000003"):
        Pose([[0, 8]], [[0, 0]]).check_inside(Domain.from_cage(Cage(corners)))


def test_complex_handles() -> None:
    pose = Pose([0j, 1 + 2j], np.array([0j, 3 - 1j]))
    assert pose.handles.tolist() == [[0, 0], [1, 2]]
    assert pose.targets.tolist() == [[0, 0], [3, -1]]
