"""The timeline: when poses are shown, and how a recorded drag is thinned."""

from __future__ import annotations

import contextlib
import itertools
from typing import Any

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given, settings
from scipy.interpolate import CubicSpline

from glid_nb.harmonic import HarmonicMap
from glid_nb.motion import MotionError
from glid_nb.pose import Pose
from glid_nb.session import actions
from glid_nb.session.edit_state import EditError, EditState
from glid_nb.session.model import History
from glid_nb.session.timeline import Timeline, on_grid, thinned

from ..support.domains import domain

index = st.integers(-1, 6)
time = st.floats(-2, 12)
easing = st.one_of(
    st.sampled_from(["linear", "in", "out", "in-out", "hold"]),
    st.tuples(*[st.floats(0, 1)] * 4),
)
steps = st.one_of(
    st.tuples(st.just("save_pose")),
    st.tuples(st.sampled_from(["duplicate_pose", "delete_pose", "go_to_pose"]), index),
    st.tuples(st.just("move_pose"), index, time),
    st.tuples(st.just("set_easing"), index, easing),
    st.tuples(st.just("set_repeat"), st.sampled_from(["once", "loop", "ping-pong"])),
    st.tuples(st.just("play_all"), st.sampled_from(["once", "loop", "ping-pong"])),
    st.tuples(st.just("set_loop_range"), st.none() | st.tuples(st.floats(0, 4), st.floats(5, 9))),
    st.tuples(st.just("keep_between"), time),
    st.tuples(st.just("keep_after"), time),
    st.tuples(st.just("record"), st.lists(st.floats(0.01, 2), min_size=1, max_size=4)),
)


def done(state: EditState, name: str, *arguments: Any) -> EditState:
    """One action; those of a recording and of a map between poses get their poses."""
    if name == "record":
        offsets = list(itertools.accumulate(arguments[0]))
        return actions.record(state, state.current, [state.current] * (len(offsets) - 1), offsets)
    if name == "keep_between":
        return actions.keep_between(state, arguments[0], state.map)
    return getattr(actions, name)(state, *arguments)


@settings(max_examples=60)
@given(st.lists(steps, max_size=12))
def test_whatever_is_done_times_increase_and_undo_returns(hand: list[Any]) -> None:
    pose = Pose([[2, 0], [-2, 0]], [[2.5, 0], [-2, 0]])
    history = History(EditState.initial(domain("ring"), pose))
    states = [history.present]
    for step in hand:
        with contextlib.suppress(EditError):
            history = history.step(done(history.present, *step))
            states.append(history.present)
    for state in reversed(states):
        assert history.present is state
        timeline, count = state.timeline, len(state.poses)
        assert len(timeline.times) == len(timeline.easing) == count
        assert 0 <= state.active < count
        assert timeline.times[0] >= 0
        assert all(a < b for a, b in itertools.pairwise(timeline.closed_times))
        assert len({pose.name for pose in state.poses}) == count
        assert Timeline(**vars(timeline)) == timeline
        history = history.undone()


def state_of(count: int) -> EditState:
    state = EditState.initial(domain("ring"))
    for _ in range(count - 1):
        state = actions.save_pose(state)
    return state


def names(state: EditState) -> list[str]:
    return [pose.name for pose in state.poses]


def test_poses_are_a_second_apart_and_a_new_one_comes_midway() -> None:
    three = state_of(3)
    assert three.timeline.times == (0, 1, 2)
    more = actions.duplicate_pose(three, 0)
    assert more.timeline.times == (0, 0.5, 1, 2)
    assert names(more) == ["Pose 1", "Pose 4", "Pose 2", "Pose 3"]
    assert actions.delete_pose(more, 1).timeline.times == (0, 1, 2)


def test_a_pose_moves_past_others_and_stays_the_edited_one() -> None:
    three = actions.set_easing(state_of(3), 0, "in")
    moved = actions.move_pose(actions.go_to_pose(three, 0), 0, 1.5)
    assert names(moved) == ["Pose 2", "Pose 1", "Pose 3"]
    assert moved.timeline.times == (1, 1.5, 2)
    assert moved.timeline.easing == ("linear", "in", "linear")
    assert (moved.active, moved.current.name) == (1, "Pose 1")
    # A place that is taken is not shared, and no time is before 0.
    assert actions.move_pose(three, 0, 2.0).timeline.times == (1, 2, 2.01)
    assert actions.move_pose(three, 2, -5.0).timeline.times == (0, 0.01, 1)
    assert actions.move_pose(three, 1, 1.0) is three


def test_a_loop_returns_after_its_last_pose() -> None:
    loop = actions.set_repeat(state_of(2), "loop")
    assert loop.timeline.closed_times == (0, 1, 2)
    later = actions.move_pose(loop, 2, 4.5)
    assert later.timeline.closed_times == (0, 1, 4.5)
    assert actions.move_pose(later, 1, 2).timeline.closed_times == (0, 2, 5.5)
    assert actions.move_pose(loop, 2, 0).timeline.end == pytest.approx(1.01)
    with pytest.raises(EditError, match="no pose 3"):
        actions.move_pose(state_of(2), 2, 4.5)


def test_a_loop_returns_as_fast_as_its_poses_follow_one_another() -> None:
    fast = actions.move_pose(actions.move_pose(state_of(3), 1, 0.25), 2, 0.5)
    loop = actions.set_repeat(fast, "loop")
    assert loop.timeline.end == 0.75
    # Its own time stays, also when the motion is played otherwise in between.
    slow = actions.move_pose(loop, 3, 1.1)
    again = actions.set_repeat(actions.set_repeat(slow, "once"), "loop")
    assert again.timeline.back == 0.6


def test_a_loop_range_is_played_as_far_as_the_motion_reaches() -> None:
    state = actions.set_loop_range(state_of(3), (0.5, 3))
    assert state.timeline.played_range == (0.5, 2)
    assert actions.set_loop_range(state, (0.5, 3)) is state
    assert actions.move_pose(state, 2, 8).timeline.played_range == (0.5, 3)
    assert state.timeline.lasting(4).played_range == (1, 4)
    assert actions.set_repeat(state, "loop").timeline.played_range == (0.5, 3)
    for whole in (None, (0.0, 9.0), (5.0, 6.0)):
        assert actions.set_loop_range(state, whole).timeline.played_range is None
    assert actions.set_loop_range(state_of(1), (0.0, 1.0)).timeline.played_range is None


def test_playing_all_ends_the_loop_range_and_sets_the_repetition_at_once() -> None:
    state = actions.set_loop_range(state_of(3), (0.5, 3))
    all_of_it = actions.play_all(state, "loop").timeline
    assert (all_of_it.loop_range, all_of_it.repeat) == (None, "loop")
    assert actions.play_all(state_of(3), "once").timeline == state_of(3).timeline
    unchanged = state_of(3)
    assert actions.play_all(unchanged, "once") is unchanged


def test_what_lies_between_can_be_kept() -> None:
    two = state_of(2)
    new = actions.keep_between(two, 0.25, two.map)
    assert new.timeline.times == (0, 0.25, 1)
    assert new.active == 1
    assert new.map is two.map
    for taken in (0.0, 1.0, -1.0, 1e-5, 1 - 1e-5):
        with pytest.raises(EditError, match="a pose"):
            actions.keep_between(two, taken, two.map)
    folded = HarmonicMap(two.domain, two.map.psi.conj(), two.map.phi.conj())
    with pytest.raises(EditError, match=r"cannot be kept\. The map is not locally injective"):
        actions.keep_between(two, 0.25, folded)


def test_the_last_pose_can_be_kept_at_a_later_time() -> None:
    state = actions.keep_after(state_of(1), 2.5)
    assert (state.timeline.times, state.active) == ((0.0, 2.5), 1)
    assert state.map is state.poses[0].map
    for taken in (2.5, 1.0, np.nan):
        with pytest.raises(EditError, match="already a pose"):
            actions.keep_after(state, taken)


def test_settings_that_are_not_valid_are_refused() -> None:
    for wrong in (
        {"times": ()},
        {"times": (-1.0,)},
        {"times": (0.0, 0.0), "easing": ("in", "in")},
        {"easing": ("up",)},
        {"easing": ((0.5, 0, 0.5),)},
        {"easing": ((0.5, -0.1, 0.5, 1),)},
        {"repeat": "twice"},
        {"loop_range": (1.0, 1.0)},
        {"loop_range": (-0.5, 1.0)},
        {"loop_range": (1.0,)},
        {"back": 0.0},
        {"repeat": "loop", "back": 1e-12},
        {"times": (0.0, 1.0, 1 + 1e-12), "easing": ("in",) * 3},
    ):
        with pytest.raises(MotionError):
            Timeline(**wrong)  # type: ignore[arg-type]


@given(st.integers(1, 60), st.floats(0.01, 1), st.integers(0, 2**32 - 1))
def test_a_spline_through_kept_places_meets_all_others(n: int, tolerance: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    times = on_grid(np.cumsum(rng.uniform(0, 1, n)))
    assert np.diff(times).min(initial=0.01) > 0.009
    points = np.cumsum(rng.normal(size=(n, 3, 2)), axis=0)
    kept = thinned(times, points, tolerance)
    assert kept[0] == 0
    assert kept[-1] == n - 1
    if n > 1:  # at about their times
        smooth = CubicSpline(times[kept], points[kept], bc_type="natural")
        near = smooth(np.clip(times + np.linspace(-0.1, 0.1, 5)[:, None], 0, times[-1]))
        off = np.linalg.norm(near - points, axis=3).max(axis=2).min(axis=0)
        off[np.abs(times[kept][:, None] - times).min(axis=0) < 0.1] = 0
        assert off.max() <= tolerance * (1 + 1e-9)


def test_a_straight_drag_needs_its_ends_alone() -> None:
    times = np.linspace(0, 1, 50)
    straight = np.stack([3 * times, -times], axis=-1)[:, None]
    assert thinned(times, straight, 1e-6) == [0, 49]
    bow = np.sin(6 * times)[:, None, None] * np.ones((1, 1, 2))  # nearly a whole wave
    assert len(thinned(times, bow, 0.1)) <= 5
