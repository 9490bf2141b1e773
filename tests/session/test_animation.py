"""The motion between the poses of a deformation, proved in the background."""

from __future__ import annotations

import re
import threading
from collections.abc import Iterator
from dataclasses import replace
from typing import Any
from unittest.mock import Mock

import numpy as np
import pytest

from glid_nb.harmonic import HarmonicMap
from glid_nb.motion import Motion, MotionError
from glid_nb.pose import Pose
from glid_nb.session import actions
from glid_nb.session.animation import Animation
from glid_nb.session.deformation import Deformation
from glid_nb.session.document import AS_SEEN, NamedPose
from glid_nb.session.edit_state import EditError, EditState

from ..support.domains import domain

pytestmark = pytest.mark.slow

TIMEOUT = 60.0
POSE = Pose([[2, 0], [-2, 0]], [[2, 0], [-2, 0]])


@pytest.fixture
def model() -> Iterator[Deformation]:
    with Deformation(domain("ring"), POSE) as model:
        yield model


@pytest.fixture
def animation(model: Deformation) -> Iterator[Animation]:
    animation = Animation(model)
    yield animation
    animation.close()


def put(model: Deformation, *maps: HarmonicMap) -> None:
    """Make these maps the poses of a model that is paused."""
    for i, map in enumerate(maps):
        if i:
            model.save_pose()
        model.apply(lambda state, map=map: state.with_current(as_seen(state.current, map)))


def as_seen(pose: NamedPose, map: HarmonicMap) -> NamedPose:
    return replace(pose, map=map, solution=AS_SEEN)


def seen(state: EditState) -> NamedPose:
    """A pose whose map is far from its targets, like a recorded frame."""
    targets = np.array(state.pose.targets) + 0.3
    pose = state.pose.with_targets(targets)
    return replace(state.current, pose=pose, solution=AS_SEEN)


def statuses(animation: Animation) -> list[str]:
    return [span.status for span in animation.spans]


def test_all_is_proved_once_the_poses_have_come_to_rest(
    model: Deformation, animation: Animation
) -> None:
    told: list[Any] = []
    assert animation.spans == ()
    with pytest.raises(MotionError, match="at least 2 keyframes"):
        animation.motion  # noqa: B018
    model.save_pose()
    model.drag(0, (2.5, 0.5))
    animation.observe(lambda what: told.append((what, statuses(animation))))
    assert animation.wait(TIMEOUT)
    model.save_pose()
    model.drag(1, (-2.5, 1))
    assert animation.wait(TIMEOUT)
    assert told[-1] == ("motion", ["proved", "proved"])
    motion = animation.motion
    assert min(min(span.sigma2) for span in animation.spans) == motion.certificate.sigma2_lower
    for time in (0.0, 0.3, 1.0, 1.7, 2.0):
        shown = animation.at(time)
        assert shown is not None
        np.testing.assert_array_equal(shown.phi, motion(time).phi)
    assert animation.at(2.5) is None
    # A drag makes the proof stale. The solved pose is proved again.
    model.begin_drag([0])
    model.drag_to((2.8, 0))
    assert model.solve(TIMEOUT)
    assert statuses(animation) == ["computing", "computing"]
    assert animation.at(0.5) is model.state.poses[0].map
    model.end_drag()
    assert animation.wait(TIMEOUT)
    assert statuses(animation) == ["proved", "proved"]
    model.set_repeat("loop")
    assert animation.wait(TIMEOUT)
    assert statuses(animation) == ["proved"] * 3
    assert isinstance(animation.motion, Motion)


def misses(model: Deformation) -> list[float]:
    """The largest distance of a handle from its target, for each pose."""
    poses = model.state.poses
    return [np.abs(pose.map(pose.pose.handles) - pose.pose.targets).max() for pose in poses]


def test_poses_that_were_left_before_they_were_solved_are_solved_first() -> None:
    with Deformation(domain("ring"), POSE, begin=False) as model:
        animation = Animation(model)
        model.drag(0, (2.5, 0.5))  # nothing is compiled yet
        model.save_pose()
        model.drag(0, (2.0, 1.0))
        steps = len(model.history.past)
        assert max(misses(model)) > 0.5
        assert animation.wait(TIMEOUT)
        assert max(misses(model)) < 1e-3
        assert statuses(animation) == ["proved"]
        assert len(model.history.past) == steps
        # The same after undo brings back an unsolved pose, but not while paused.
        model.undo()
        assert animation.wait(TIMEOUT)
        assert max(misses(model)) < 1e-3
        model.paused = True
        model.drag(0, (2.2, 0.5))
        model.go_to_pose(0)
        assert animation.worker.wait(TIMEOUT)
        assert misses(model)[1] > 0.1
        assert statuses(animation) == ["refused"]
        assert "'Pose 2' is not solved, because the solver is paused" in animation.spans[0].reason
        with pytest.raises(EditError, match="the solver is paused"):
            animation.motion  # noqa: B018
        model.paused = False
        assert animation.wait(TIMEOUT)
        assert max(misses(model)) < 1e-3
        animation.close()


def test_a_pause_while_the_solver_works_reaches_the_timeline() -> None:
    """It waited for a proof that nobody began."""
    with Deformation(domain("ring"), POSE) as model:
        animation = Animation(model)
        model.drag(0, (2.5, 0.5))
        model.save_pose()
        model.paused = True
        assert animation.wait(TIMEOUT)
        assert "computing" not in statuses(animation)
        animation.close()


def test_recorded_and_loaded_poses_stay_as_they_were(
    model: Deformation, animation: Animation
) -> None:
    model.apply(lambda state: actions.record(state, seen(state), [seen(state)], [0.5, 1.0]))
    model.drag(0, (2.5, 0.5))
    before = [pose.map for pose in model.state.poses]
    assert animation.wait(TIMEOUT)
    assert [pose.map for pose in model.state.poses][:2] == before[:2]


def test_what_cannot_be_solved_is_told(
    model: Deformation, animation: Animation, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(*_: Any) -> None:
        raise ValueError("it is too warm.")

    monkeypatch.setattr("glid_nb.session.deformation.solve_edited", fails)
    model.paused = True
    model.drag(0, (2.5, 0.5))
    for _ in range(2):
        model.save_pose()
        model.reset()
    model.paused = False
    assert animation.wait(TIMEOUT)
    told = "the pose 'Pose 1' could not be solved: it is too warm."
    assert [span.reason for span in animation.spans] == [told, ""]
    assert statuses(animation) == ["refused", "proved"]
    with pytest.raises(EditError, match=re.escape(told)):
        animation.motion  # noqa: B018


def test_what_lies_between_is_kept_where_it_is_proved(
    model: Deformation, animation: Animation
) -> None:
    model.save_pose()
    model.drag(0, (2.5, 0.5))
    assert animation.wait(TIMEOUT)
    shown = animation.at(0.25)
    assert shown is not None
    animation.keep(0.25)
    assert model.state.timeline.times == (0, 0.25, 1)
    assert model.state.active == 1
    np.testing.assert_allclose(model.pose.targets, shown(POSE.handles))
    animation.keep(0.25)  # a pose stands there already, so a copy follows
    assert model.state.timeline.times == (0, 0.25, 0.625, 1)
    assert animation.wait(TIMEOUT)
    animation.keep(0.5000000810054317)
    assert model.state.timeline.times == (0, 0.25, 0.5, 0.625, 1)
    assert animation.wait(TIMEOUT)
    model.begin_drag([0])
    model.drag_to((2.8, 0))
    assert model.solve(TIMEOUT)
    with pytest.raises(EditError, match=r"nothing is proved at 0\.10 s"):
        animation.keep(0.1)
    model.cancel_drag()


def test_after_the_last_pose_there_can_be_another(model: Deformation, animation: Animation) -> None:
    assert animation.is_later(0.5)
    assert animation.at(0.5) is None
    seen = animation.seen(0.5)
    assert seen is not None
    assert seen[0] is model.map
    animation.go_to(0.5)
    assert (model.state.timeline.times, model.state.active) == ((0, 0.5), 1)
    model.go_to_pose(0)
    animation.keep(2.0)
    assert (model.state.timeline.times, model.state.active) == ((0, 0.5, 2), 2)
    model.set_repeat("loop")
    assert not animation.is_later(9.0)


def test_poses_that_wind_otherwise_are_not_joined_and_the_others_are() -> None:
    """The ring turned inside out; no motion of locally injective maps leads there."""
    d = domain("ring")
    vertices = np.concatenate(d.offset_cage.loops_complex)
    phi = np.append(9 / (vertices - d.hole_points_complex[0]), 0)  # Cauchy's integral formula
    identity, inverse = HarmonicMap.identity(d), HarmonicMap(d, phi, np.zeros_like(phi))
    with Deformation(d, begin=False) as model:
        model.paused = True  # so the maps that are put there stay
        animation = Animation(model)
        put(model, identity, inverse, inverse)
        model.set_repeat("loop")
        assert animation.worker.wait(TIMEOUT)
        assert statuses(animation) == ["refused", "proved", "refused"]
        reason = animation.spans[0].reason
        assert reason.startswith("'Pose 1' and 'Pose 2' cannot be joined without folding")
        assert animation.at(0.9) is identity
        animation.close()


def test_a_motion_that_folds_stops_where_its_proof_does(monkeypatch: pytest.MonkeyPatch) -> None:
    identity = HarmonicMap.identity(domain("ell"))
    turned = HarmonicMap(domain("ell"), -identity.phi, -identity.psi)

    def blended(task: Any, *_: Any) -> Motion:
        return Motion([pose.map for pose in task.poses], between="linear")

    monkeypatch.setattr("glid_nb.session.animation.motion_of", blended)
    with Deformation(domain("ell"), begin=False) as model:
        model.paused = True
        animation = Animation(model)
        put(model, identity, turned)
        assert animation.worker.wait(TIMEOUT)
        (span,) = animation.spans
        assert span.status == "fails"
        assert span.reason.startswith("Proved up to 0.49")
        last = span.pieces[-1]
        assert 0.4 < last.end < 0.5
        assert animation.at(0.9) is last.end_map
        with pytest.raises(EditError, match=r"nothing is proved at 0\.60 s"):
            animation.keep(0.6)
        animation.close()


def test_a_recorded_drag_becomes_keyframes_in_one_step(
    model: Deformation, animation: Animation, monkeypatch: pytest.MonkeyPatch
) -> None:
    watch = Mock(monotonic=Mock(return_value=100.0))
    monkeypatch.setattr("glid_nb.session.animation.time", watch)
    assert model.solve(TIMEOUT)
    before = model.state
    animation.record(True)
    model.begin_drag([0])
    for s in np.linspace(0, 1, 12):
        watch.monotonic.return_value = 100.0123 + 2 * s
        model.drag_to((2 + 0.5 * s, np.sin(3 * s)))
        assert model.solve(TIMEOUT)
    model.end_drag()
    assert not animation.recording
    poses, timeline = model.state.poses, model.state.timeline
    assert 3 <= len(poses) <= 5
    assert timeline.times[-1] == pytest.approx(20 / 11, abs=0.02)  # since the first change
    assert all(time == round(time, 2) for time in timeline.times)
    assert model.state.active == len(poses) - 1
    assert poses[0].map is before.map
    assert poses[-1].pose.targets[0].tolist() == [2.5, np.sin(3)]
    assert animation.wait(TIMEOUT)
    assert set(statuses(animation)) == {"proved"}
    model.undo()
    assert model.state is before
    # A cancelled drag leaves nothing, and ends the recording.
    animation.record(True)
    model.begin_drag([0])
    model.drag_to((2.4, 0))
    model.cancel_drag()
    assert model.state is before
    assert not animation.recording


def test_closing_does_not_wait_for_a_proof(
    model: Deformation, monkeypatch: pytest.MonkeyPatch
) -> None:
    proving, closed = threading.Event(), threading.Event()

    def proved(*_: object) -> Iterator[Any]:
        proving.set()
        assert closed.wait(TIMEOUT)
        yield from ()

    monkeypatch.setattr("glid_nb.session.animation.proved_spans", proved)
    model.save_pose()
    animation = Animation(model)
    assert proving.wait(TIMEOUT)
    threading.Timer(TIMEOUT / 10, closed.set).start()  # so a close that waits returns at last
    animation.close()
    assert not closed.is_set()
    closed.set()
    animation.worker.thread.join(TIMEOUT)
    assert not animation.worker.thread.is_alive()
