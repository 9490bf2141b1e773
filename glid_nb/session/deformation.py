"""The deformation editor without a picture or a widget: what a hand does, undo, and the solver."""

from __future__ import annotations

import functools
import weakref
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from numbers import Real
from typing import Any, Concatenate, ParamSpec

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glid_nb._arguments import check_type
from glid_nb.certificate import Certificate, certify
from glid_nb.energies import Energy
from glid_nb.geometry import Domain, MeshMap
from glid_nb.harmonic import HarmonicMap
from glid_nb.session import actions
from glid_nb.session.edit_state import EditedPose, EditError, EditState, Solution
from glid_nb.session.history import History
from glid_nb.session.live_solver import Frame, LiveSolver, Task
from glid_nb.session.moment import Moment
from glid_nb.session.observed import Observed
from glid_nb.session.point_finder import PointFinder
from glid_nb.session.status_line import StatusLine, describe
from glid_nb.session.worker import LatestWins
from glid_nb.solvers import DeformationMap, Options, Pose

Array = NDArray[Any]
P = ParamSpec("P")


@dataclass(frozen=True, eq=False)
class _Drag:
    """A hand that holds some handles; what it does is one gesture of the history."""

    handles: tuple[int, ...]


def _step(
    action: Callable[Concatenate[EditState, P], EditState],
) -> Callable[Concatenate[Deformation, P], None]:
    """A method of :class:`Deformation` that takes an action's step."""

    @functools.wraps(action)
    def method(self: Deformation, *arguments: P.args, **named: P.kwargs) -> None:
        self.apply(action, *arguments, **named)

    return method


class Deformation(Observed):
    """A domain being deformed: its state, its undo history, and a thread that solves.

    Every method may be called from any thread. ``observe`` tells of changes by name: ``"state"``
    (handles, targets, poses, options, what undo offers), ``"frame"`` (a new map), ``"selection"``
    and ``"status"``.

    Parameters
    ----------
    domain : Domain
    pose : Pose, optional
        By default without handles.
    energy : Energy, optional
    options : Options, optional
        By default :data:`~glid_nb.session.edit_state.LIVE_OPTIONS`.
    begin : bool, optional
        Solve, and compile the solver, from the start; else from :meth:`begin` or the first change.

    Examples
    --------
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
        self._start(History(EditState.initial(domain, pose, energy, options)), begin)

    @classmethod
    def from_state(cls, state: EditState, *, begin: bool = True) -> Deformation:
        """Go on from a state, with an empty undo history."""
        return cls.from_history(History(state), begin=begin)

    @classmethod
    def from_history(cls, history: History[EditState], *, begin: bool = True) -> Deformation:
        """Go on from another one's present, with its past and what was undone."""
        new = cls.__new__(cls)
        new._start(history.ended(), begin)
        return new

    def _start(self, history: History[EditState], begin: bool) -> None:
        super().__init__()
        self._history = history
        self._chain = 0
        self._drag: _Drag | None = None
        self._selection: tuple[int, ...] = ()
        self._frame: Frame | None = None
        self._error: Exception | None = None
        self._certificates: weakref.WeakKeyDictionary[HarmonicMap, Certificate]
        self._certificates = weakref.WeakKeyDictionary()
        self._finder = PointFinder(history.present.domain)
        solver = LiveSolver(self._accept, self._fail)
        self._worker = LatestWins(solver.solve, self, "live solver")
        self._begun = self._closed = False
        if begin:
            self.begin()

    # What is

    @property
    def history(self) -> History[EditState]:
        """What was, is and was undone."""
        return self._history

    @property
    def state(self) -> EditState:
        """Everything as it is now."""
        return self._history.present

    @property
    def domain(self) -> Domain:
        """The domain of all maps."""
        return self.state.domain

    @property
    def map(self) -> HarmonicMap:
        """The certified map of this moment."""
        return self.state.map

    @property
    def pose(self) -> Pose:
        """The handles and targets of this moment."""
        return self.state.pose

    @property
    def poses(self) -> tuple[EditedPose, ...]:
        """The list of poses; ``state.active`` says which is edited."""
        return self.state.poses

    @property
    def moment(self) -> Moment:
        """The state and what the solver makes of it, both as they are at this moment."""
        with self._lock:
            worker = self._worker
            return Moment(
                self.state,
                self._frame,
                worker.busy,
                worker.paused,
                self._error,
                self._selection,
                self.dragged,
            )

    @property
    def comparison(self) -> MeshMap | None:
        """What the method on a mesh has come to: see :attr:`Moment.comparison`."""
        return self.moment.comparison

    @property
    def shown(self) -> DeformationMap:
        """What there is to see: the comparison, or the certified map."""
        return self.moment.shown

    @property
    def solution(self) -> Solution | None:
        """How the present pose was solved; None while it is not."""
        return self.moment.solution

    @property
    def solved(self) -> bool:
        """Whether the present pose's method has come to its end."""
        return self.moment.solved

    @property
    def selection(self) -> tuple[int, ...]:
        """Indices of the selected handles."""
        return self._selection

    @property
    def dragged(self) -> tuple[int, ...]:
        """Indices of the handles that are being dragged."""
        return self._drag.handles if self._drag else ()

    @property
    def frame(self) -> Frame | None:
        """What the solver published last for the present map; None if that is older."""
        return self._frame

    @property
    def certificate(self) -> Certificate:
        """The proof for the present map, recomputed from its coefficients alone."""
        return self.certificate_of(self.map)

    def certificate_of(self, map: HarmonicMap) -> Certificate:
        """The proof for a map, recomputed from its coefficients alone, once."""
        known = self._certificates.get(map)
        if known is None:
            known = self._certificates[map] = certify(map)
        return known

    @property
    def status(self) -> StatusLine:
        """What is going on, in words, and at rest what :attr:`certificate` proves."""
        return describe(self.moment, self.certificate_of)

    @property
    def busy(self) -> bool:
        """Whether the solver has work."""
        return self._worker.busy

    @property
    def begun(self) -> bool:
        """Whether the solver was ever asked for something."""
        return self._begun

    @property
    def alive(self) -> bool:
        """Whether the solver's thread runs."""
        return self._worker.alive

    @property
    def can_undo(self) -> bool:
        """Whether there is something to undo."""
        return bool(self._history.past) or self._drag is not None

    @property
    def can_redo(self) -> bool:
        """Whether there is something to redo."""
        return bool(self._history.future) and self._drag is None

    def find(self, point: ArrayLike) -> Array | None:
        """The point of the undeformed shape that is seen at ``point``; None beside the shape."""
        return self._finder.find(self.shown, point)

    # What a hand does

    clear_handles = _step(actions.clear_handles)
    move_target = _step(actions.move_target)
    nudge = _step(actions.nudge)
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

    def add_handle(self, point: ArrayLike, to: ArrayLike | None = None) -> int:
        """Pin a point of the undeformed shape; by default where it is now. Returns its index."""
        return self.add_handles(point, to)[0]

    def add_handles(self, points: ArrayLike, to: ArrayLike | None = None) -> tuple[int, ...]:
        """Pin several points (h, 2) in one step; returns their indices."""
        with self.locked():
            before = len(self.pose)
            self.apply(actions.add_handles, points, to)
            return tuple(range(before, len(self.pose)))

    def remove_handles(self, *indices: int) -> None:
        """Let go of handles."""
        self.apply(actions.remove_handles, indices)

    def set_domain(self, domain: Domain) -> None:
        """Another domain; handles that lie in it are kept.

        One with the present cage changes nothing. One with the cage of the step before takes that
        step back, with all the handles that it had.
        """
        with self.locked():
            past = self.history.past
            if domain.cage.equals(self.state.domain.cage):
                return
            if past and domain.cage.equals(past[-1].domain.cage) and not self.dragged:
                self.undo()
                return
            self.apply(actions.set_domain, domain)

    def apply(
        self,
        action: Callable[Concatenate[EditState, P], EditState],
        *arguments: P.args,
        **named: P.kwargs,
    ) -> None:
        """Take one step: the state that ``action(state, ...)`` makes of the present one.

        A drag that is going on ends before it, and goes on after it with the handles that are left.

        Raises
        ------
        EditError, PoseError, OptionError, EnergyError, MethodError, GeometryError
            When the action is refused, or this is closed; nothing has changed then.
        """
        with self.locked():
            self._check_open()
            new = action(self.state, *arguments, **named)
            drag = self._drag
            self.end_drag()
            before = self.state
            if new is before:
                return
            self._set(self._history.step(new))
            if drag is not None:
                held = _still_there(drag.handles, before.pose, new.pose)
                self._drag = _Drag(held) if held else None

    # Dragging: many small steps under a hand, one for undo

    def drag(self, handle: int, to: ArrayLike) -> None:
        """Drag one handle's target from where it is, in one go; what a pointer does in many."""
        with self.locked():
            self.begin_drag([handle])
            try:
                self.drag_to(to)
            finally:
                self.end_drag()

    def begin_drag(self, indices: Sequence[int]) -> None:
        """Take hold of some handles."""
        with self.locked():
            self._check_open()
            self.end_drag()
            actions.nudge(self.state, indices, (0, 0))  # refuses what does not exist
            self._drag = _Drag(tuple(int(i) for i in indices))

    def drag_to(self, targets: ArrayLike) -> None:
        """Put the targets of the held handles at (h, 2)."""
        with self.locked():
            if self._drag is None:
                raise EditError("nothing is being dragged; begin a drag first")
            moved = actions.move_targets(self.state, self.dragged, targets)
            if np.array_equal(moved.pose.targets, self.pose.targets):
                return
            self._history = self._history.step(moved, gesture=self._drag)
            self._error = None
            self._submit()
            self._tell("state", "status")

    def end_drag(self) -> None:
        """Let go: the whole drag is one step. Nothing happens when nothing is held."""
        with self.locked():
            if self._drag is None:
                return
            self._drag = None
            origin = self._history.origin
            if origin is not None and _same_targets(origin.present, self.state):
                self._history = origin.refined(self.state)  # it went nowhere
            self._history = self._history.ended()
            self._tell("state")

    def cancel_drag(self) -> None:
        """Let go, and be exactly where the drag began."""
        with self.locked():
            if self._drag is None:
                return
            self._drag = None
            self._set(self._history.cancelled())

    # Undo

    def undo(self) -> None:
        """One step back, to exactly what was; during a drag, to where that began."""
        with self.locked():
            self._check_open()
            if self._drag is not None:
                self.cancel_drag()
            elif self._history.past:
                self._set(self._history.undone())

    def redo(self) -> None:
        """One step forward again."""
        with self.locked():
            self._check_open()
            if self.can_redo:
                self._set(self._history.redone())

    # Selection

    def select(self, indices: Iterable[int]) -> None:
        """Select these handles and no others."""
        with self.locked():
            count = len(self.pose)
            chosen = tuple(dict.fromkeys(int(i) for i in indices if 0 <= i < count))
            if chosen != self._selection:
                self._selection = chosen
                self._tell("selection")

    # Solving

    def begin(self) -> None:
        """Solve what is not solved yet, and compile before a hand has to wait for it.

        Returns at once. Nothing happens when the solver has been asked for something before.
        """
        with self.locked():
            if not self._begun:
                self._submit()
                self._tell("status")

    def solve(self, timeout: float | None = None) -> bool:
        """Wait until the present pose is solved; whether that came within ``timeout`` seconds.

        An interrupt stops the solve; the editor lives on, with the map as far as it came.

        Raises
        ------
        EditError
            When this is closed.
        """
        check_type("timeout", timeout, Real | None, "give seconds, or None to wait to the end")
        with self.locked():
            self._check_open()
            if not self.solved and not self.busy:
                self._submit()
        try:
            return self._worker.wait(timeout)
        except KeyboardInterrupt:
            self.stop()
            raise

    def stop(self) -> None:
        """Give up solving; the map stays as it is."""
        self._worker.cancel()

    @property
    def paused(self) -> bool:
        """Whether the solver waits instead of following."""
        return self._worker.paused

    @paused.setter
    def paused(self, value: bool) -> None:
        with self.locked():
            if value == self.paused:
                return
            self._worker.paused = value
            if not value and not self.solved:
                self._submit()
            self._tell("state", "status")

    def step(self) -> None:
        """One compiled call of the solver, also while paused."""
        with self.locked():
            self._submit(single=True)

    def close(self) -> None:
        """End the solver's thread. The state can still be read, and no longer be changed."""
        with self.locked():
            self._closed = True
            self._observers.clear()
        self._worker.close()

    def __enter__(self) -> Deformation:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    # Behind it; the lock is held where these are called

    def _check_open(self) -> None:
        if self._closed:
            raise EditError("it is closed: what was deformed here can be read, but not changed")

    def _set(self, history: History[EditState]) -> None:
        """Make a history the present one, and keep what is selected where it is still there."""
        old, new = self.state, history.present
        self._history, self._error = history, None
        self._chain += 1
        if new.domain is not self._finder.domain:
            self._finder = PointFinder(new.domain)
        if self._frame is not None and not _belongs(self._frame, new):
            self._frame = None
        self._selection = _still_there(self._selection, old.pose, new.pose)
        self._submit()
        self._tell("state", "frame", "selection", "status")

    def _submit(self, single: bool = False) -> None:
        self._begun = True
        if single or not self.solved:
            task = Task(self.state.current, self._chain, single)
            self._worker.submit(task, at_once=single)
        else:
            self._worker.cancel()

    def _accept(self, frame: Frame) -> None:
        """A frame from the solver's thread."""
        with self.locked():
            if frame.task.chain != self._chain:
                return
            if frame.mesh is None:
                current = self.state.current
                latest = frame.task.pose.asks_the_same(current)
                solved = frame.solution if latest else None
                new = replace(current, map=frame.map, solution=solved)
                self._history = self._history.refined(self.state.with_current(new))
            self._frame, self._error = frame, None
            self._tell("frame", "status")

    def _fail(self, error: Exception) -> None:
        """An exception in the solver's thread: shown, and the map stays."""
        with self.locked():
            self._error = error
            if self.comparison is not None:
                self._frame = None  # of an earlier problem
            self._tell("frame", "status")


def _belongs(frame: Frame, state: EditState) -> bool:
    """Whether a frame may still be shown for a state."""
    same_method = frame.task.pose.method is state.current.method
    return frame.map is state.map and (frame.mesh is None or same_method)


def _same_targets(one: EditState, other: EditState) -> bool:
    return np.array_equal(one.pose.targets, other.pose.targets)


def _still_there(chosen: Iterable[int], old: Pose, new: Pose) -> tuple[int, ...]:
    """Indices of the same handles in another pose."""
    kept = []
    for i in chosen:
        if i < len(old):
            found = np.flatnonzero((new.handles == old.handles[i]).all(axis=1))
            kept.extend(int(j) for j in found[:1])
    return tuple(kept)
