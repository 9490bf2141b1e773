"""The model of the deformation editor, and its thread."""

from __future__ import annotations

import gc
import signal
import threading
import weakref
from collections.abc import Iterator

import numpy as np
import pytest

from glid_nb.certificate import certify
from glid_nb.energies import AMIPS, ARAP
from glid_nb.pose import Pose
from glid_nb.session.deformation import Deformation
from glid_nb.session.edit_state import EditError
from glid_nb.solvers import Status

from ..support.domains import domain
from ..support.preparation import Preparation
from ..support.threads import NewThreads

pytestmark = pytest.mark.slow  # most of the time is compiling

TIMEOUT = 120.0
SOLVER = "live solver"  # the thread's name


@pytest.fixture
def threads() -> NewThreads:
    return NewThreads()


@pytest.fixture
def ring(threads: NewThreads) -> Iterator[Deformation]:  # noqa: ARG001 - made before
    """Two solved handles on a ring."""
    with Deformation(domain("ring")) as deformation:
        deformation.add_handles([(2, 0), (-2, 0)])
        assert deformation.solve(TIMEOUT)
        yield deformation


def test_a_drag_is_solved_to_its_end(ring: Deformation) -> None:
    ring.drag(0, to=(3, 0.5))
    assert ring.solve(TIMEOUT)
    np.testing.assert_allclose(ring.map([[2, 0]]), [[3, 0.5]], atol=1e-3)
    assert ring.state.current.solved
    assert ring.status.level == "good"
    assert "Converged" in ring.status.text


def test_the_solver_can_be_told_when_to_begin(threads: NewThreads) -> None:
    with Deformation(domain("ring"), begin=False) as deformation:
        assert threads.named(SOLVER) is None
        assert "No pins" in deformation.status.text
        deformation.begin()
        assert threads.named(SOLVER) is not None
        assert deformation.solve(TIMEOUT)
        solution = deformation.moment.solution
        deformation.begin()  # nothing is left to begin
        assert not deformation.busy
        assert deformation.moment.solution is solution


def test_a_change_begins_too(threads: NewThreads) -> None:
    pose = Pose([(2, 0), (-2, 0)], [(2.5, 0), (-2, 0)])
    with Deformation(domain("ring"), pose, begin=False) as deformation:
        assert deformation.status.text == "Not solved yet"
        deformation.drag(1, to=(-2.5, 0))
        assert threads.named(SOLVER) is not None
        assert deformation.solve(TIMEOUT)
        np.testing.assert_allclose(deformation.map([[2, 0]]), [[2.5, 0]], atol=1e-3)


def test_a_drag_is_one_step_and_undo_is_exact(ring: Deformation) -> None:
    before, steps = ring.state, len(ring.history.past)
    ring.begin_drag([0])
    for x in np.linspace(2, 3, 20):
        ring.drag_to([(x, 0.2)])
    ring.end_drag()
    assert len(ring.history.past) == steps + 1
    assert ring.solve(TIMEOUT)
    after = ring.state
    ring.undo()
    assert ring.state is before
    ring.redo()
    assert ring.state is after


def test_the_undeformed_shape_stays_so_and_undo_brings_all_back(ring: Deformation) -> None:
    ring.move_target(0, (3, 0.2))
    ring.set_pins([1], angles=0.5)
    assert ring.solve(TIMEOUT)
    before = ring.state
    ring.reset()
    assert ring.solve(TIMEOUT)
    points = np.array([(2, 0), (-2, 0), (0, 2)])
    np.testing.assert_allclose(ring.map(points), points, atol=1e-9)
    ring.undo()
    assert ring.state is before


def test_a_cancelled_drag_leaves_no_trace(ring: Deformation) -> None:
    before, history = ring.state, ring.history
    ring.begin_drag([0])
    ring.drag_to([(3, 0)])
    ring.solve(TIMEOUT)
    assert ring.state is not before
    ring.cancel_drag()
    assert ring.state is before
    assert ring.history.past == history.past
    assert ring.dragged == ()


def test_undo_during_a_drag_cancels_it(ring: Deformation) -> None:
    before = ring.state
    ring.begin_drag([0])
    ring.drag_to([(3, 0)])
    ring.undo()
    assert ring.state is before


def test_a_drag_that_goes_nowhere_is_no_step(ring: Deformation) -> None:
    steps = len(ring.history.past)
    ring.begin_drag([0])
    ring.end_drag()
    assert len(ring.history.past) == steps


def test_another_action_splits_a_drag(ring: Deformation) -> None:
    steps = len(ring.history.past)
    ring.begin_drag([1])
    ring.drag_to([(-2.4, 0)])
    ring.add_handle((0, 2))
    ring.remove_handles(0)
    assert ring.dragged == (0,)
    ring.drag_to([(-2.6, 0)])
    ring.end_drag()
    assert len(ring.history.past) == steps + 4
    np.testing.assert_allclose(ring.pose.targets[0], [-2.6, 0])
    ring.undo()
    np.testing.assert_allclose(ring.pose.targets[0], [-2.4, 0])


def test_every_frame_is_certified(ring: Deformation) -> None:
    maps = []
    ring.observe(lambda name: maps.append(ring.map) if name == "frame" else None)
    ring.begin_drag([0])
    for angle in np.linspace(0, 3, 15):
        ring.drag_to([(3 * np.cos(angle), 3 * np.sin(angle))])
        ring.solve(TIMEOUT)
    ring.end_drag()
    assert len({id(m) for m in maps}) >= 15
    for map_ in maps[:: max(1, len(maps) // 20)]:
        assert certify(map_).certified


def test_an_unreachable_target_is_followed_as_far_as_it_goes(ring: Deformation) -> None:
    ring.add_handle((0, 2))
    # Three pinned points cannot change their orientation without a fold.
    ring.drag(2, to=(0, -200))
    assert ring.solve(TIMEOUT)
    assert certify(ring.map).certified
    solution = ring.state.current.solution
    assert solution is not None
    if solution.status is Status.BLOCKED:
        assert ring.status.level == "blocked"
    assert np.isfinite(ring.map(ring.pose.handles)).all()


def test_a_blocked_shape_follows_when_all_its_pins_move_together(ring: Deformation) -> None:
    ring.add_handle((0, 2))
    ring.set_energy(ARAP())
    ring.drag(2, to=(0, -20))
    assert ring.solve(TIMEOUT)
    assert ring.status.level == "blocked"
    before = ring.map(ring.pose.handles)
    ring.begin_drag([0, 1, 2])
    for _ in range(3):
        ring.drag_to(np.add(ring.pose.targets, (0.5, -0.25)))
        ring.solve(TIMEOUT)
    ring.end_drag()
    np.testing.assert_allclose(ring.map(ring.pose.handles), np.add(before, (1.5, -0.75)), atol=0.05)
    assert certify(ring.map).certified


def test_steps_without_pins_go_on_from_each_other(ring: Deformation) -> None:
    ring.paused = True
    ring.drag(0, to=(5, 4))
    ring.step()
    assert ring.solve(TIMEOUT)
    ring.clear_handles()
    for _ in range(3):
        ring.step()
        assert ring.solve(TIMEOUT)
        assert ring.status.level == "idle", ring.status.text


def test_solver_errors_reach_the_status(ring: Deformation, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object, **__: object) -> None:
        raise RuntimeError("no more magic smoke")

    shown = ring.map
    with monkeypatch.context() as patch:
        patch.setattr("glid_nb.session.live_solver.solve", broken)
        ring.drag(0, to=(2.5, 0))
        assert ring.solve(TIMEOUT)
        assert ring.status.level == "error"
        assert "no more magic smoke" in ring.status.text
        assert ring.map is shown
    ring.drag(0, to=(2.6, 0))
    assert ring.solve(TIMEOUT)
    assert ring.status.level == "good"


def test_changing_the_energy_while_solving(ring: Deformation) -> None:
    ring.begin_drag([0])
    ring.drag_to([(3, 1)])
    ring.set_energy(AMIPS(0.5))
    ring.drag_to([(3, 1.2)])
    ring.end_drag()
    assert ring.solve(TIMEOUT)
    assert ring.state.current.energy == AMIPS(0.5)
    np.testing.assert_allclose(ring.map([[2, 0]]), [[3, 1.2]], atol=1e-2)
    assert certify(ring.map).certified


def test_conformal_maps_begin_at_one(ring: Deformation) -> None:
    ring.drag(0, to=(2.5, 0.5))
    ring.solve(TIMEOUT)
    ring.set_options(conformal=True)
    assert ring.solve(TIMEOUT)
    assert np.ptp(np.abs(ring.map.psi)) == 0
    ring.undo()
    ring.solve(TIMEOUT)
    assert not ring.state.current.options.conformal


def test_dropping_a_hole_with_handles_near_it(ring: Deformation) -> None:
    ring.add_handle((0, 1.3))
    ring.drag(2, to=(0, 1.0))
    ring.solve(TIMEOUT)
    before = ring.state
    ring.drop_hole(0)
    ring.select([2])
    assert ring.solve(TIMEOUT)
    assert ring.state.domain.n_holes == 0
    assert certify(ring.map).certified
    assert ring.find((0, 0)) is not None
    ring.undo()
    assert ring.state is before


def test_pausing_and_stepping(ring: Deformation) -> None:
    ring.paused = True
    assert ring.status.text.startswith("Paused")
    shown = ring.map
    ring.drag(0, to=(4, 2))
    assert ring.map is shown
    ring.step()
    assert ring.solve(TIMEOUT)
    assert ring.map is not shown
    assert not ring.state.current.solved
    ring.paused = False
    assert ring.solve(TIMEOUT)
    assert ring.state.current.solved


def test_poses_keep_their_maps(ring: Deformation) -> None:
    ring.save_pose("rest")
    ring.drag(0, to=(3, 1))
    ring.solve(TIMEOUT)
    bent = ring.map
    ring.go_to_pose(0)
    np.testing.assert_allclose(ring.map([[2, 0]]), [[2, 0]], atol=1e-6)
    ring.go_to_pose(1)
    assert ring.map is bent


def test_find_inverts_the_map(ring: Deformation) -> None:
    ring.drag(0, to=(3, 1))
    ring.solve(TIMEOUT)
    inside = np.array([[0, 2], [-1.5, -1.5], [2, 0], [2.5, 0.3]])
    for point, image in zip(inside, ring.map(inside), strict=True):
        found = ring.find(image)
        assert found is not None
        np.testing.assert_allclose(found, point, atol=1e-7)
    assert ring.find((0, 0)) is None
    assert ring.find((100, 0)) is None


def test_selection_follows_the_handles(ring: Deformation) -> None:
    ring.select([1, 1, 7])
    assert ring.selection == (1,)
    ring.remove_handles(0)
    assert ring.selection == (0,)
    ring.undo()
    assert ring.selection == (1,)


def test_what_is_refused_changes_nothing(ring: Deformation) -> None:
    state, history = ring.state, ring.history
    with pytest.raises(EditError):
        ring.add_handle((0, 0))
    with pytest.raises(EditError, match="nothing is being dragged"):
        ring.drag_to([(0, 0)])
    assert ring.state is state
    assert ring.history is history


def test_the_thread_dies_with_the_model(threads: NewThreads) -> None:
    deformation = Deformation(domain("ring"))
    thread = threads.named(SOLVER)
    assert thread is not None
    gone = weakref.ref(deformation)
    deformation.observe(lambda _: None)
    del deformation
    gc.collect()
    assert gone() is None
    thread.join(TIMEOUT)
    assert not thread.is_alive()


@pytest.fixture
def preparation(monkeypatch: pytest.MonkeyPatch) -> Preparation:
    return Preparation.instead_of_solving(monkeypatch)


def test_the_status_says_how_far_the_solver_is_prepared(preparation: Preparation) -> None:
    deformation, seen = Deformation(domain("ring"), begin=False), []
    deformation.observe(lambda _: seen.append(deformation.moment.prepared))
    deformation.begin()
    preparation.go_on("basis", "rows", "trace", "compile")
    assert sorted(set(seen)) == [0.0, 0.2, 0.3, 0.5, 1.0]
    assert deformation.status.text == "Preparing the solver… 50%"
    handle = deformation.add_handle((2, 0))  # the user can go on
    deformation.drag(handle, to=(3, 0))
    assert deformation.busy
    deformation.close()
    preparation.go_on("rows", wait=False)


def test_the_status_says_so_also_when_a_shape_is_shown(
    ring: Deformation, monkeypatch: pytest.MonkeyPatch
) -> None:
    preparation = Preparation.instead_of_solving(monkeypatch)
    ring.drag(0, to=(3, 0.5))
    preparation.go_on("compile")
    assert ring.moment.frame is not None
    assert ring.status.text == "Preparing the solver… 50%"
    ring.drag(0, to=(3.2, 0.5))  # pins still follow
    assert ring.pose.targets[0].tolist() == [3.2, 0.5]
    ring.close()
    preparation.go_on("rows", wait=False)


def test_closing_does_not_wait_for_a_solver_that_is_prepared(
    preparation: Preparation, threads: NewThreads
) -> None:
    deformation = Deformation(domain("ring"))
    preparation.go_on("trace")
    thread, before = threads.named(SOLVER), deformation.state
    assert thread is not None
    deformation.close()
    assert thread.is_alive()
    preparation.go_on("compile", wait=False)  # it never begins
    thread.join(TIMEOUT)
    assert not thread.is_alive()
    assert deformation.moment.prepared < 0.5
    assert deformation.state is before


def test_closing_ends_the_thread(ring: Deformation, threads: NewThreads) -> None:
    thread = threads.named(SOLVER)
    assert thread is not None
    ring.close()
    thread.join(TIMEOUT)
    assert not thread.is_alive()
    state = ring.state
    for change in (
        lambda: ring.drag(0, to=(3, 0)),
        lambda: ring.add_handle((2, 0)),
        lambda: ring.solve(1.0),
        ring.undo,
        ring.redo,
    ):
        with pytest.raises(EditError, match="closed"):
            change()
    assert ring.state is state
    assert certify(ring.map).certified


def test_an_interrupt_stops_the_solve_only(
    ring: Deformation, threads: NewThreads, monkeypatch: pytest.MonkeyPatch
) -> None:
    from glid_nb.session import live_solver

    real, entered, go_on = live_solver.solve, threading.Event(), threading.Event()

    def slow(*arguments: object, **named: object) -> object:
        entered.set()
        assert go_on.wait(TIMEOUT)
        return real(*arguments, **named)

    monkeypatch.setattr("glid_nb.session.live_solver.solve", slow)
    ring.drag(0, to=(4, 2))
    assert entered.wait(TIMEOUT)
    # The signal goes to the main thread, as for a real process, so it ends the wait itself.
    main = threading.main_thread().ident
    assert main is not None
    timer = threading.Timer(0.2, lambda: signal.pthread_kill(main, signal.SIGINT))
    previous = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            ring.solve()
    finally:
        signal.signal(signal.SIGINT, previous)
        timer.join()
        go_on.set()
    monkeypatch.undo()
    assert ring.solve(TIMEOUT)
    assert threads.named(SOLVER) is not None
    assert ring.state.current.solved
