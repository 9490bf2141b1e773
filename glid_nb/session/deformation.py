"""The model of the deformation editor: handles, drags, undo, and the solver's thread."""

import functools
import time
import weakref
from collections.abc import Callable, Iterable, Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from numbers import Real
from typing import Any, Concatenate, ParamSpec, Self

import numpy as np
from numpy.typing import ArrayLike

from glid_nb._arguments import check_type
from glid_nb._arrays import Array
from glid_nb._errors import plainly
from glid_nb.certificate import Certificate, certificate_of
from glid_nb.energies import Energy
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.order import Sheets
from glid_nb.pose import Pose
from glid_nb.session import actions, parts, pose_text
from glid_nb.session.document import NamedPose, Solution
from glid_nb.session.edit_state import EditError, EditState, Frame, Moment, Task
from glid_nb.session.live_solver import LiveSolver, solve_edited
from glid_nb.session.model import History, Undoable
from glid_nb.session.pin_marks import with_groups
from glid_nb.session.status_line import StatusLine, describe
from glid_nb.session.worker import LatestWins, weakly
from glid_nb.solvers import Options
from glid_nb.solvers.method import Inputs

P = ParamSpec("P")


def _step(
    action: Callable[Concatenate[EditState, P], EditState],
) -> Callable[Concatenate["Deformation", P], None]:
    @functools.wraps(action)
    def method(self: "Deformation", *arguments: P.args, **named: P.kwargs) -> None:
        self.apply(action, *arguments, **named)

    return method


class Deformation(Undoable[EditState], AbstractContextManager["Deformation"]):
    """A domain being deformed: its state, its undo history, and a thread that solves.

    Every method may be called from any thread. ``observe`` reports changes by name: ``"state"``
    (handles, targets, poses, options, undo), ``"frame"`` (a new map), ``"selection"``,
    ``"status"``, ``"press"`` (a drag begins) and ``"hand"`` (a gesture on a canvas ended). The
    default pose has no handles. The default options are
    :data:`~glid_nb.session.edit_state.LIVE_OPTIONS`. With ``begin`` it solves from the start.
    Otherwise it solves after :meth:`begin` or the first change.

    >>> from glid_nb.geometry import Cage, Domain
    >>> square = Domain.from_cage(Cage([[-1, -1], [1, -1], [1, 1], [-1, 1]]))
    >>> with Deformation(square) as deformation:
    ...     left = deformation.add_handle((-0.8, 0))
    ...     right = deformation.add_handle((0.8, 0))
    ...     deformation.drag(right, to=(1.2, 0.2))
    ...     solved = deformation.solve()
    ...     deformation.map([[0.8, 0]]).round(3)
    array([[1.2, 0.2]])
    """

    def __init__(
        self,
        domain: Domain,
        pose: Pose | None = None,
        energy: Energy | None = None,
        options: Options | None = None,
        *,
        begin: bool = True,
    ) -> None:
        check_type("domain", domain, Domain, "make one with Domain.from_cage(cage)")
        super().__init__(EditState.initial(domain, pose, energy, options))
        self.selection: tuple[int, ...] = ()  # indices of the selected handles
        self.dragged: tuple[int, ...] = ()
        """Indices of the dragged handles. They are the gesture of the history."""
        self.begun = False  # whether the solver was ever given a task
        self._chain = 0
        self._frame: Frame | None = None
        self._error: Exception | None = None
        self._prepared = 1.0
        self._solver = solver = LiveSolver(self._accept, self._fail, self._prepare)
        self._worker = LatestWins(solver.solve, self, "live solver", waits=False)
        others = weakly(self._solve_others)
        self._others: LatestWins[None] = LatestWins(others, self, "other poses", waits=False)
        # The exceptions of failed solves, for poses that are not edited.
        self._failures = weakref.WeakKeyDictionary[NamedPose, Exception]()
        self._closed = self._paused = False
        if begin:
            self.begin()

    @classmethod
    def from_history(cls, history: History[EditState]) -> Self:
        """A deformation with a given state and undo history. The solver waits for :meth:`begin`."""
        new = cls(history.present.domain, begin=False)
        new.history = history.ended()
        return new

    # State

    @property
    def map(self) -> HarmonicMap:
        """The present certified map."""
        return self.state.map

    @property
    def pose(self) -> Pose:
        """The present handles and targets."""
        return self.state.pose

    @property
    def moment(self) -> Moment:
        """The state and the solver's progress, both at the same moment."""
        with self._lock:
            return Moment(
                state=self.state,
                frame=self._frame,
                busy=self._worker.busy,
                paused=self._paused,
                error=self._error,
                selection=self.selection,
                dragged=self.dragged,
                prepared=self._prepared,
            )

    @property
    def certificate(self) -> Certificate:
        """The certificate of the present map, computed from its coefficients alone."""
        return certificate_of(self.map)

    @property
    def status(self) -> StatusLine:
        """The status of the editor in words; at rest with the bounds of :attr:`certificate`."""
        return describe(self.moment)

    @property
    def busy(self) -> bool:
        """Whether the solver has work."""
        return self._worker.busy

    @property
    def can_undo(self) -> bool:
        """Whether there is something to undo, for example the current drag."""
        return bool(self.history.past or self.dragged)

    @property
    def can_redo(self) -> bool:
        """Whether there is something to redo; not during a drag."""
        return bool(self.history.future) and not self.dragged

    def sheets(self, image: Array | None = None) -> Sheets:
        """The sheets of the drawn shape. With a picture, its transparent parts hide nothing."""
        moment = self.moment
        return Sheets(moment.shown, moment.state.order, image)

    def find(self, point: ArrayLike) -> Array | None:
        """The point of the undeformed shape that is drawn at ``point``; None outside the shape."""
        return self.sheets().source(point)

    # Actions

    clear_handles = _step(actions.clear_handles)
    move_target = _step(actions.move_target)
    move_targets = _step(actions.move_targets)
    nudge = _step(actions.nudge)
    set_depths = _step(actions.set_depths)
    bring_forward = _step(actions.bring_forward)
    name_pin = _step(actions.name_pin)
    name_pins = _step(actions.name_pins)
    set_pins = _step(actions.set_pins)
    mark_pins = _step(actions.mark_pins)
    group_pins = _step(actions.group_pins)
    ungroup_pins = _step(actions.ungroup_pins)
    show_all_pins = _step(actions.show_all_pins)
    turn = _step(actions.turn)
    mirror_pose = _step(pose_text.mirror_pose)
    paste_pose = _step(pose_text.paste_pose)
    set_stiffness = _step(actions.set_stiffness)
    reset = _step(actions.reset)
    set_energy = _step(actions.set_energy)
    set_options = _step(actions.set_options)
    set_method = _step(actions.set_method)
    set_pose = _step(actions.set_pose)
    drop_hole = _step(actions.drop_hole)
    save_pose = _step(actions.save_pose)
    duplicate_pose = _step(actions.duplicate_pose)
    rename_pose = _step(actions.rename_pose)
    delete_pose = _step(actions.delete_pose)
    go_to_pose = _step(actions.go_to_pose)
    move_pose = _step(actions.move_pose)
    set_easing = _step(actions.set_easing)
    set_repeat = _step(actions.set_repeat)
    play_all = _step(actions.play_all)
    set_loop_range = _step(actions.set_loop_range)
    keep_between = _step(actions.keep_between)
    keep_after = _step(actions.keep_after)
    add_parts = _step(parts.add_parts)
    select_part = _step(parts.select_part)
    select_next_part = _step(parts.select_next)
    show_part = _step(parts.show_part)
    rename_part = _step(parts.rename_part)
    move_part = _step(parts.move_part)
    remove_part = _step(parts.remove_part)

    def add_handle(self, point: ArrayLike, to: ArrayLike | None = None) -> int:
        """Add a handle at a point of the undeformed shape. Returns its index."""
        return self.add_handles(point, to)[0]

    def add_handles(self, points: ArrayLike, to: ArrayLike | None = None) -> tuple[int, ...]:
        """Add handles at points (h, 2) in one step. Returns their indices."""
        with self.locked():
            before = len(self.pose)
            self.apply(actions.add_handles, points, to)
            return tuple(range(before, len(self.pose)))

    def remove_handles(self, *indices: int, keep_shape: bool = False) -> None:
        """Remove handles. Then the shape relaxes, without handles to the undeformed one.

        With ``keep_shape`` it stays until a change.
        """
        self.apply(actions.remove_handles, indices, keep_shape)

    def set_domain(self, domain: Domain) -> None:
        """Replace the domain. Handles inside the new one are kept.

        A domain with the present cage changes nothing. A domain with the cage of the previous step
        undoes that step, which brings its handles back.
        """
        with self.locked():
            past = self.history.past
            if domain.cage.equals(self.state.domain.cage):
                return
            if past and domain.cage.equals(past[-1].domain.cage) and not self.dragged:
                self.undo()
            else:
                self.apply(actions.set_domain, domain)

    def apply(
        self,
        action: Callable[Concatenate[EditState, P], EditState],
        *arguments: P.args,
        **named: P.kwargs,
    ) -> None:
        """Make ``action(state, ...)`` the present state, as one step for undo.

        A current drag ends before the action. It begins again after it, with the remaining handles.
        Raises EditError, PoseError, OptionError, EnergyError, MethodError or GeometryError when the
        action is refused or this object is closed. Then nothing has changed.
        """
        with self.locked():
            self._check_open()
            new = action(self.state, *arguments, **named)
            held = self.dragged
            self.end_drag()
            before = self.state
            if new is before:
                return
            self._go_to(self.history.step(new))
            if new.keys[new.part] == before.keys[before.part]:
                self.dragged = _still_there(held, before.pose, new.pose)

    # Dragging: many small moves are one step for undo

    def drag(self, handle: int, to: ArrayLike) -> None:
        """Drag one handle's target to a place, in one move."""
        with self.locked():
            self.begin_drag([handle])
            try:
                self.drag_to(to)
            finally:
                self.end_drag()

    def begin_drag(self, indices: Sequence[int]) -> None:
        """Begin to drag some handles."""
        with self.locked():
            self._check_open()
            self.end_drag()
            actions.nudge(self.state, indices, (0, 0))  # raises for missing handles
            self.dragged = tuple(int(i) for i in indices)
            self._others.cancel()  # the drag needs the processor
            self.tell("press")

    def drag_to(self, targets: ArrayLike) -> None:
        """Move the targets of the dragged handles to (h, 2)."""
        self._drag(actions.move_targets, targets)

    def drag_pins(self, **numbers: ArrayLike) -> None:
        """Apply `actions.set_pins` to the dragged handles."""
        self._drag(actions.set_pins, **numbers)

    def _drag(self, action: Callable[..., EditState], *arguments: Any, **named: Any) -> None:
        with self.locked():
            if not self.dragged:
                raise EditError("nothing is being dragged; begin a drag first")
            moved = action(self.state, self.dragged, *arguments, **named)
            if _asks_alike(moved.pose, self.pose):
                return
            self.history = self.history.step(moved, gesture=self.dragged)
            self._error = None
            self._submit()
            self.tell("state", "status")

    def end_drag(self) -> None:
        """End the drag, if there is one. The whole drag is one step for undo."""
        with self.locked():
            if not self.dragged:
                return
            self.dragged = ()
            origin = self.history.origin
            if origin is not None and _asks_alike(origin.present.pose, self.pose):
                self.history = origin.amended(self.state)  # the drag came back to its start
            self.history = self.history.ended()
            self._go_on()
            self.tell("state")

    def cancel_drag(self) -> bool:
        """End the drag and restore exactly the state before it. Returns whether there was one."""
        with self.locked():
            if not self.dragged:
                return False
            self.dragged = ()
            self.tell("state")
            self._go_to(self.history.cancelled())
            return True

    def record(
        self, first: NamedPose, poses: Sequence[NamedPose], offsets: Sequence[float]
    ) -> None:
        """Apply `actions.record` as a part of the last step, which was the drag."""
        with self.locked():
            self._check_open()
            self._go_to(self.history.amended(actions.record(self.state, first, poses, offsets)))

    # Undo

    def undo(self) -> bool:
        """Go one step back; during a drag, to its start. Returns whether there was a step."""
        with self.locked():
            self._check_open()
            return self.cancel_drag() if self.dragged else super().undo()

    def redo(self) -> bool:
        """Go one step forward again. Returns whether there was one."""
        with self.locked():
            self._check_open()
            return not self.dragged and super().redo()

    # Selection

    def select(self, indices: Iterable[int]) -> None:
        """Select these handles, with those of their groups, and no others."""
        with self.locked():
            marks = self.state.marks
            chosen = with_groups(marks, (int(i) for i in indices if 0 <= i < len(marks)))
            if chosen != self.selection:
                self.selection = chosen
                self.tell("selection")

    # Solving

    def begin(self) -> None:
        """Start the solver if it has not started, so that it compiles before the first drag.

        Returns at once.
        """
        with self.locked():
            if not self.begun:
                self._submit()
                self.tell("status")

    def solve(self, timeout: float | None = None) -> bool:
        """Wait until the present pose is solved, and then all other poses.

        Other poses can be unsolved after a change of the cage, or after switching to another pose
        too early. Returns False if it takes longer than ``timeout`` seconds. An interrupt stops the
        solve and keeps the map reached so far.
        """
        check_type("timeout", timeout, Real | None, "give seconds, or None to wait to the end")
        with self.locked():
            self._check_open()
            if not self.moment.solved and not self.busy:
                self._submit()
        return self._wait(timeout)

    def finish(self, timeout: float | None = None) -> bool:
        """Like `solve`, but stopped, recorded and opened poses stay as they are."""
        with self.locked():
            current = self.state.current
            if current.unsolved and current.method.certified and not self.busy and not self._closed:
                self._submit()
        return self._wait(timeout)

    def solved_state(self, *, only_current: bool = False) -> EditState:
        """Wait until all poses, or only the edited one of each part, are solved. Returns the state.

        Raises an EditError that names the unsolved poses and says why: the solver is paused or has
        failed, or the pose's method gives no certified map.
        """
        self.finish()
        with self.locked():
            state = self.state
            poses = [pose for shape in state.shapes for pose in shape.poses]
            wanted = [shape.current for shape in state.shapes] if only_current else poses
            reasons = [reason for pose in wanted if (reason := self.why_unsolved(pose)) is not None]
        if reasons:
            raise EditError("; ".join(map(str, reasons)), "; ".join(one.plain for one in reasons))
        return state

    def why_unsolved(self, pose: NamedPose) -> EditError | None:
        """Why a pose is not solved; None if it is solved."""
        with self.locked():
            name, error = f"the pose {pose.name!r}", self._failures.get(pose)
            if part := next((part for part in self.state.parts if pose in part.poses), None):
                name += f" of {part.name!r}"
            if not pose.unsolved:
                return None
            if not pose.method.certified:
                what = f"is deformed by {pose.method.label}, which gives no certified map"
                return EditError(f"{name} {what}; choose another method for it")
            if error is None and pose is self.state.current:
                error = self._error
            if error is not None:
                what = f"{name} could not be solved"
                return EditError(f"{what}: {error}", f"{what}: {plainly(error)}")
            if self._paused:
                what = "is not solved, because the solver is paused; resume it"
            elif self._closed:
                what = "was not solved before it was closed; open it again"
            else:
                what = "is not solved yet; solve it first"
            return EditError(f"{name} {what}")

    def settled(self) -> bool:
        """Whether no solve is running or waiting."""
        with self.locked():
            return self._at_rest() and self._next_other() is None

    def next_inputs(self) -> Inputs:
        """The problem of the edited pose, with the start that the next solve would have."""
        return self._solver.inputs(self.state.current)

    def stop(self) -> None:
        """Stop solving. The maps stay as they are."""
        self._worker.cancel()
        self._others.cancel()

    @property
    def paused(self) -> bool:
        """Whether the solver is paused."""
        return self._paused

    @paused.setter
    def paused(self, value: bool) -> None:
        with self.locked():
            if value == self.paused:
                return
            self._paused = value
            if not self.moment.solved and (self.begun or not value):
                self._submit()
            self._go_on()
            self.tell("state", "status")

    def step(self) -> None:
        """Make one compiled call of the solver, also while paused."""
        with self.locked():
            self._submit(single=True)

    def close(self) -> None:
        """End the solver at once. The state can still be read, but no longer be changed."""
        with self.locked():
            self._closed = True
            self._observers.clear()
        self._worker.close()
        self._others.close()

    def __exit__(self, *_: object) -> None:
        self.close()

    # Internals, called with the lock held

    def _check_open(self) -> None:
        if self._closed:
            raise EditError("it is closed: its state can be read, but not changed")

    def _go_to(self, history: History[EditState]) -> bool:
        if history is self.history:
            return False
        old, new = self.state, history.present
        self.history, self._error = history, None
        self._chain += 1
        if (frame := self._frame) is not None:
            same_method = frame.task.pose.method is new.current.method
            if frame.map is not new.map or (frame.mesh is not None and not same_method):
                self._frame = None
        same_part = new.keys[new.part] == old.keys[old.part]
        selected = self.selection if same_part else ()
        self.selection = _still_there(selected, old.pose, new.pose)
        self._submit()
        self._go_on()
        self.tell("state", "frame", "selection", "status")
        return True

    def _submit(self, single: bool = False) -> None:
        self.begun, solved = True, self.moment.solved
        if single or not (solved or self._paused):
            self._worker.submit(Task(self.state.current, self._chain, single))
        elif self._paused and self._worker.busy and not solved:
            self._worker.submit(None)  # the running solve ends after its present call
        else:
            self._worker.cancel()

    def _accept(self, frame: Frame) -> None:
        with self.locked():
            if frame.task.chain != self._chain or self._closed:
                return
            if frame.mesh is None:
                current = self.state.current
                latest = frame.task.pose.asks_the_same(current)
                new = replace(current, map=frame.map, solution=frame.solution if latest else None)
                self.history = self.history.amended(self.state.with_current(new))
            self._frame, self._error = frame, None
            self._go_on(at_rest=frame.solution is not None)
            self.tell("frame", "status")

    def _prepare(self, share: float) -> None:
        with self.locked():
            self._prepared = share
            self.tell("status")

    def _fail(self, error: Exception) -> None:
        with self.locked():
            self._error = error
            if self.moment.comparison is not None:
                self._frame = None  # it belongs to an earlier problem
            self._go_on(at_rest=True)
            self.tell("frame", "status")

    # The poses that are not edited

    def _wait(self, timeout: float | None) -> bool:
        """Wait until the edited pose and then the others are solved or cannot be solved."""
        until = None if timeout is None else time.monotonic() + timeout

        def rest() -> float | None:
            return None if until is None else max(until - time.monotonic(), 0.0)

        try:
            if not self._worker.wait(rest()):
                return False
            while self._go_on(at_rest=True):
                if not self._others.wait(rest()):
                    return False
            return self._others.wait(rest())  # it may still be telling of the last pose
        except KeyboardInterrupt:
            self.stop()
            raise

    def _at_rest(self) -> bool:
        # While paused, the solver may still end its last call. Its map then comes as a frame.
        ended = self.moment.solved or self._error is not None
        stopped = self.begun and (self._paused or not self._worker.busy)
        return not self.dragged and (ended or stopped)

    def _next_other(self) -> NamedPose | None:
        """The next pose to solve among those that are not edited."""
        if self._paused or self._closed or self.dragged:
            return None
        state = self.state
        poses = (pose for shape in state.shapes for pose in shape.poses)
        others = (pose for pose in poses if pose is not state.current)
        left = (p for p in others if p.unsolved and p.method.certified)
        return next((pose for pose in left if pose not in self._failures), None)

    def _go_on(self, at_rest: bool = False) -> bool:
        """Solve other poses if the edited one is at rest, else stop solving them.

        Returns whether another pose is left to solve.
        """
        with self.locked():
            left = (at_rest or self._at_rest()) and self._next_other() is not None
            if not left:
                self._others.cancel()
            elif not self._others.busy:
                self._others.submit(None)
            return left

    def _solve_others(self, _: None, worker: LatestWins[None]) -> None:
        while not worker.overtaken and (pose := self._next_other()) is not None:
            try:
                result = solve_edited(pose, lambda _: worker.overtaken)
            except Exception as error:  # shown in the timeline, and where the pose is needed
                self._failures[pose] = error
                self.tell("state")
                continue
            if not worker.overtaken:
                solution = Solution(result.status, result.message, result.history, (1,))
                self._amend(pose, replace(pose, map=result.map, solution=solution))

    def _amend(self, pose: NamedPose, solved: NamedPose) -> None:
        """Replace a pose that is not edited by its solved version. This is no step for undo."""
        with self.locked():
            state = self.state
            if pose is not state.current and not self._closed:
                self.history = self.history.amended(state.with_solved(pose, solved))
                self.tell("state")


def _asks_alike(a: Pose, b: Pose) -> bool:
    return np.array_equal(a.targets, b.targets) and a.same_constraints(b)


def _still_there(chosen: Iterable[int], old: Pose, new: Pose) -> tuple[int, ...]:
    places = {tuple(handle): j for j, handle in enumerate(new.handles.tolist())}
    before = [tuple(old.handles[i].tolist()) for i in chosen if i < len(old)]
    return tuple(places[handle] for handle in before if handle in places)
