"""Paths of targets along which the parts of a shape turn rigidly, either way round."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from glid_nb.geometry import Cage
from glid_nb.solvers import Pose
from glid_nb.solvers.turning import turning_of

CAGE = Cage([[-10, -1], [10, -1], [10, 1], [-10, 1]])
BAR = np.array([[-9, -0.5], [-9, 0.5], [0, -0.5], [0, 0.5], [9, -0.5], [9, 0.5]])


def turned(points: np.ndarray, degrees: float, centre: complex = 0) -> np.ndarray:
    z = (points @ np.array([1, 1j]) - centre) * np.exp(1j * np.deg2rad(degrees)) + centre
    return np.stack([z.real, z.imag], axis=1)


@given(degrees=st.floats(-179, 179), x=st.floats(-20, 20))
def test_a_rigid_motion_has_no_joints_and_stays_rigid(degrees: float, x: float) -> None:
    turning = turning_of(Pose(BAR, turned(BAR, degrees) + np.array([x, 0])), CAGE)
    assert turning.joints == []
    assert list(turning.ways) == ["staged targets"]
    distances = [np.linalg.norm(BAR - BAR[i], axis=1) for i in range(len(BAR))]
    for stage in turning.ways["staged targets"]:
        for i, expected in enumerate(distances):
            there = np.linalg.norm(stage.targets - stage.targets[i], axis=1)
            np.testing.assert_allclose(there, expected, atol=1e-9)


def test_an_end_turns_rigidly_in_either_direction() -> None:
    targets = BAR.copy()
    targets[4:] = turned(BAR[4:], 150, 9)
    turning = turning_of(Pose(BAR, targets), CAGE)
    assert len(turning.joints) == 1
    for way, whole in (("left", 150), ("right", -210)):
        stages = turning.ways[f"staged targets, {way}"]
        z = np.array([s.targets @ np.array([1, 1j]) for s in stages])
        end = (z[:, 5] - z[:, 4]) / 1j
        np.testing.assert_allclose(np.abs(end), 1, atol=1e-9)
        even = whole * np.arange(1, len(stages) + 1) / (len(stages) + 1)
        np.testing.assert_allclose(end, np.exp(1j * np.deg2rad(even)), atol=1e-9)
        np.testing.assert_allclose(z[:, :4], np.tile(BAR[:4] @ np.array([1, 1j]), (len(z), 1)))


@given(seed=st.integers(0, 10**6), count=st.integers(1, 9))
def test_stages_lead_evenly_to_the_targets(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    pose = Pose(rng.normal(size=(count, 2)), rng.normal(size=(count, 2)))
    turning = turning_of(pose, CAGE)
    for name, stages in turning.ways.items():
        if not name.startswith("staged"):
            continue
        line = np.array([pose.handles, *(s.targets for s in stages), pose.targets])
        assert np.isfinite(line).all()
        # No stage turns any line by more than 40 degrees.
        for i, j, _, _ in turning.lines:
            z = (line[:, i] - line[:, j]) @ np.array([1, 1j])
            assert np.abs(np.angle(z[1:] / z[:-1])).max() < np.deg2rad(40.1)


def test_targets_that_coincide_are_no_division_by_zero() -> None:
    turning = turning_of(Pose([[0, 0], [1, 0], [2, 0]], [[0, 0], [0, 0], [0, 0]]), CAGE)
    assert all(np.isfinite(s.targets).all() for stages in turning.ways.values() for s in stages)


@pytest.mark.parametrize("count", [2, 3])
def test_several_joints_turn_alike_or_in_turn(count: int) -> None:
    targets = BAR.copy()
    for k in range(count):
        targets[2 * k : 2 * k + 2] = targets[2 * k : 2 * k + 2][::-1]
    ways = turning_of(Pose(BAR, targets), CAGE).ways
    assert sum(name.startswith("staged") for name in ways) == 4


def test_a_part_turns_rigidly_about_its_joint_either_way() -> None:
    """Both of a limb's handles turn about a joint at x = 3, while the whole shape is moved too."""
    targets = BAR.copy()
    targets[4:] = turned(BAR[4:], 120, 3)
    targets = turned(targets, 70) + np.array([4, -2])
    ways = turning_of(Pose(BAR, targets), CAGE).ways
    joint = turned(np.array([[3.0, 0.0]]), 70)[0] + np.array([4, -2])
    for name, whole in (("rigid parts, left", 120), ("rigid parts, right", -240)):
        stages = ways[name]
        for k, stage in enumerate(stages, start=1):
            there = turned(BAR[4:], whole * k / (len(stages) + 1), 3)
            there = turned(there, 70) + np.array([4, -2])
            np.testing.assert_allclose(stage.targets[4:], there, atol=1e-9)
            np.testing.assert_allclose(stage.targets[:4], targets[:4], atol=1e-9)
            away = np.linalg.norm(stage.targets[4:] - joint, axis=1)
            np.testing.assert_allclose(away, np.linalg.norm(BAR[4:] - [3, 0], axis=1), atol=1e-9)


def test_an_end_led_round_turns_about_its_own_middle() -> None:
    targets = BAR.copy()
    targets[4:] = turned(BAR[4:], 342, 9) + np.array([-16, 1])
    stages = turning_of(Pose(BAR, targets), CAGE).ways["rigid parts, left"]
    for k, stage in enumerate(stages, start=1):
        time = k / (len(stages) + 1)
        there = turned(BAR[4:], 342 * time, 9) + time * np.array([-16, 1])
        np.testing.assert_allclose(stage.targets[4:], there, atol=1e-9)


def test_handles_that_change_places_turn_about_their_middle() -> None:
    targets = BAR.copy()
    targets[[1, 5]] = BAR[[5, 1]]
    ways = turning_of(Pose(BAR, targets), CAGE).ways
    middle = (BAR[1] + BAR[5]) / 2
    for stage in ways["rigid parts, left"]:
        away = np.linalg.norm(stage.targets[[1, 5]] - middle, axis=1)
        np.testing.assert_allclose(away, 9, atol=1e-9)
        np.testing.assert_allclose(stage.targets[[0, 2, 3, 4]], BAR[[0, 2, 3, 4]], atol=1e-9)
