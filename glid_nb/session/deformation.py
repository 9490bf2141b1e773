"""The deformation editor without a picture or a widget: what a hand does, undo, and the solver."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glid_nb._arguments import check_type
from glid_nb.certificate import Certificate, certify
from glid_nb.energies import Energy
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods import DeformationMap, MeshMap
from glid_nb.session import actions
from glid_nb.session.edit_state import EditedPose, EditError, EditState, Solution
from glid_nb.session.history import History
from glid_nb.session.live_solver import Frame, LiveSolver, Task
from glid_nb.session.moment import Moment
from glid_nb.session.point_finder import PointFinder
from glid_nb.session.status_line import StatusLine, describe
from glid_nb.solvers import Options, Pose

Array = NDArray[Any]
Observer = Callable[[str], None]


class Deformation:
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
        new._start(history, begin)
        return new

    def _start(self, history: History[EditState], begin: bool) -> None:
        self._lock = threading.RLock()
        self._history = history
        self._observers: list[Observer] = []
        self._chain = 0
        self._drag: tuple[EditState, tuple[int, ...]] | None = None
        self._selection: tuple[int, ...] = ()
        self._frame: Frame | None = None
        self._error: Exception | None = None
        self._certificates: weakref.WeakKeyDictionary[HarmonicMap, Certificate]
        self._certificates = weakref.WeakKeyDictionary()
        self._finder = PointFinder(history.present.domain)
        self._solver = LiveSolver(self._accept, self._fail)
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
    def comparison(self) -> MeshMap | None:
        """What the method on a mesh has come to, uncertified, beside :attr:`map`; else None.

        It is not part of the state, and lags behind it while the method works.
        """
        return self.moment.comparison

    @property
    def shown(self) -> DeformationMap:
        """What there is to see: the comparison, or the certified map."""
        comparison = self.comparison
        return self.map if comparison is None else comparison

    @property
    def solution(self) -> Solution | None:
        """How the present pose was solved; None while it is not."""
        return self.moment.solution

    @property
    def solved(self) -> bool:
        """Whether the present pose's method has come to its end."""
        solution = self.solution
        return solution is not None and solution.ended

    @property
    def pose(self) -> Pose:
        """The handles and targets of this moment."""
        return self.state.pose

    @property
    def poses(self) -> tuple[EditedPose, ...]:
        """The list of poses; ``state.active`` says which is edited."""
        return self.state.poses

    @property
    def selection(self) -> tuple[int, ...]:
        """Indices of the selected handles."""
        return self._selection

    @property
    def dragged(self) -> tuple[int, ...]:
        """Indices of the handles that are being dragged."""
        return self._drag[1] if self._drag else ()

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
    def moment(self) -> Moment:
        """The state and what the solver makes of it, both as they are at this moment."""
        with self._lock:
            solver = self._solver
            return Moment(self.state, self._frame, solver.busy, solver.paused, self._error)

    @property
    def busy(self) -> bool:
        """Whether the solver has work."""
        return self._solver.busy

    @property
    def begun(self) -> bool:
        """Whether the solver was ever asked for something."""
        return self._begun

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

    def observe(self, observer: Observer) -> Callable[[], None]:
        """Call ``observer`` with the name of every change; returns what ends that."""
        with self._lock:
            self._observers.append(observer)

        def end() -> None:
            with self._lock:
                if observer in self._observers:
                    self._observers.remove(observer)

        return end

    # What a hand does

    def add_handle(self, point: ArrayLike, to: ArrayLike | None = None) -> int:
        """Pin a point of the undeformed shape; by default where it is now. Returns its index."""
        with self._lock:
            self.apply(actions.add_handles, point, to)
            return len(self.pose) - 1

    def add_handles(self, points: ArrayLike, to: ArrayLike | None = None) -> tuple[int, ...]:
        """Pin several points (h, 2) in one step; returns their indices."""
        with self._lock:
            before = len(self.pose)
            self.apply(actions.add_handles, points, to)
            return tuple(range(before, len(self.pose)))

    def remove_handles(self, *indices: int) -> None:
        """Let go of handles."""
        with self._lock:
            self.apply(actions.remove_handles, indices)

    def clear_handles(self) -> None:
        """Let go of all handles."""
        self.apply(actions.clear_handles)

    def move_target(self, handle: int, to: ArrayLike) -> None:
        """Put one target elsewhere."""
        self.apply(actions.move_targets, [handle], to)

    def nudge(self, indices: Iterable[int], delta: ArrayLike) -> None:
        """Shift the targets of some handles."""
        self.apply(actions.nudge, indices, delta)

    def reset(self) -> None:
        """The undeformed shape again, the handles on it."""
        self.apply(actions.reset)

    def set_energy(self, energy: Energy) -> None:
        """Minimise another energy."""
        self.apply(actions.set_energy, energy)

    def set_options(self, **changes: Any) -> None:
        """Solve with other options."""
        self.apply(actions.set_options, **changes)

    def set_method(self, name: str, **settings: Any) -> None:
        """Solve by another of :func:`glid_nb.methods`."""
        self.apply(actions.set_method, name, **settings)

    def set_pose(self, pose: Pose) -> None:
        """Other handles and targets."""
        self.apply(actions.set_pose, pose)

    def set_domain(self, domain: Domain) -> None:
        """Another domain; handles that lie in it are kept.

        One with the present cage changes nothing. One with the cage of the step before takes that
        step back, with all the handles that it had.
        """
        with self._lock:
            past = self.history.past
            if domain.cage.equals(self.state.domain.cage):
                return
            if past and domain.cage.equals(past[-1].domain.cage) and not self.dragged:
                self.undo()
                return
            self.apply(actions.set_domain, domain)

    def drop_hole(self, index: int) -> None:
        """Fill a hole, counted from 0."""
        self.apply(actions.drop_hole, index)

    def save_pose(self, name: str | None = None) -> None:
        """Keep the pose as it is, and go on with a copy of it."""
        self.apply(actions.save_pose, name)

    def duplicate_pose(self, index: int) -> None:
        """Copy a pose and edit the copy."""
        self.apply(actions.duplicate_pose, index)

    def rename_pose(self, index: int, name: str) -> None:
        """Another name for a pose."""
        self.apply(actions.rename_pose, index, name)

    def delete_pose(self, index: int) -> None:
        """Take a pose from the list."""
        self.apply(actions.delete_pose, index)

    def go_to_pose(self, index: int) -> None:
        """Edit another pose."""
        self.apply(actions.go_to_pose, index)

    def apply(self, action: Callable[..., EditState], *arguments: Any, **named: Any) -> None:
        """Take one step: the state that ``action(state, ...)`` makes of the present one.

        A drag that is going on ends before it, and goes on after it with the handles that are left.

        Raises
        ------
        EditError, PoseError, OptionError, EnergyError, MethodError, GeometryError
            When the action is refused, or this is closed; nothing has changed then.
        """
        with self._lock:
            self._check_open()
            new = action(self.state, *arguments, **named)
            grip = self._drag
            if grip is not None:
                self.end_drag()
            before = self.state
            if new is before:
                return
            self._set(self._history.step(new), moved=before)
            if grip is not None:
                self._grip_again(grip[1], before)
        self._tell("state", "frame", "selection", "status")

    # Dragging: many small steps under a hand, one for undo

    def drag(self, handle: int, to: ArrayLike) -> None:
        """Drag one handle's target from where it is, in one go; what a pointer does in many."""
        with self._lock:
            self.begin_drag([handle])
            try:
                self.drag_to(to)
            finally:
                self.end_drag()

    def begin_drag(self, indices: Sequence[int]) -> None:
        """Take hold of some handles."""
        with self._lock:
            self._check_open()
            self.end_drag()
            actions.nudge(self.state, indices, (0, 0))  # refuses what does not exist
            self._drag = (self.state, tuple(int(i) for i in indices))

    def drag_to(self, targets: ArrayLike) -> None:
        """Put the targets of the held handles at (h, 2)."""
        with self._lock:
            if self._drag is None:
                raise EditError("nothing is being dragged; begin a drag first")
            indices = self._drag[1]
            moved = actions.move_targets(self.state, indices, targets)
            if np.array_equal(moved.pose.targets, self.state.pose.targets):
                return
            self._history = self._history.refined(moved)
            self._error = None
            self._submit()
        self._tell("state", "status")

    def end_drag(self) -> None:
        """Let go: the whole drag is one step. Nothing happens when nothing is held."""
        with self._lock:
            if self._drag is None:
                return
            before, _ = self._drag
            self._drag = None
            targets, earlier = self.state.pose.targets, before.pose.targets
            if targets.shape != earlier.shape or not np.array_equal(targets, earlier):
                self._history = self._history.step_from(before, self.state)
        self._tell("state")

    def cancel_drag(self) -> None:
        """Let go, and be exactly where the drag began."""
        with self._lock:
            if self._drag is None:
                return
            before, _ = self._drag
            self._drag = None
            self._set(self._history.refined(before), moved=before)
        self._tell("state", "frame", "status")

    def _grip_again(self, indices: tuple[int, ...], before: EditState) -> None:
        """Hold the same points as before the action, where they still are."""
        old, new = before.pose.handles, self.pose.handles
        places = [np.flatnonzero((new == old[i]).all(axis=1)) for i in indices if i < len(old)]
        held = tuple(int(p[0]) for p in places if p.size)
        self._drag = (self.state, held) if held else None

    # Undo

    def undo(self) -> None:
        """One step back, to exactly what was; during a drag, to where that began."""
        with self._lock:
            self._check_open()
            if self._drag is not None:
                self.cancel_drag()
                return
            if not self._history.past:
                return
            self._set(self._history.undone(), moved=self.state)
        self._tell("state", "frame", "selection", "status")

    def redo(self) -> None:
        """One step forward again."""
        with self._lock:
            self._check_open()
            if self._drag is not None or not self._history.future:
                return
            self._set(self._history.redone(), moved=self.state)
        self._tell("state", "frame", "selection", "status")

    # Selection

    def select(self, indices: Iterable[int]) -> None:
        """Select these handles and no others."""
        with self._lock:
            count = len(self.pose)
            chosen = tuple(dict.fromkeys(int(i) for i in indices if 0 <= i < count))
            if chosen == self._selection:
                return
            self._selection = chosen
        self._tell("selection")

    # Solving

    def begin(self) -> None:
        """Solve what is not solved yet, and compile before a hand has to wait for it.

        Returns at once. Nothing happens when the solver has been asked for something before.
        """
        with self._lock:
            if self._begun:
                return
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
        with self._lock:
            self._check_open()
            if not self.solved and not self._solver.busy:
                self._submit()
        try:
            return self._solver.wait(timeout)
        except KeyboardInterrupt:
            self.stop()
            raise

    def stop(self) -> None:
        """Give up solving; the map stays as it is."""
        self._solver.stop()

    @property
    def paused(self) -> bool:
        """Whether the solver waits instead of following."""
        return self._solver.paused

    @paused.setter
    def paused(self, value: bool) -> None:
        with self._lock:
            if value == self._solver.paused:
                return
            self._solver.paused = value
            if not value and not self.solved:
                self._submit()
        self._tell("state", "status")

    def step(self) -> None:
        """One compiled call of the solver, also while paused."""
        with self._lock:
            self._submit(single=True)

    def close(self) -> None:
        """End the solver's thread. The state can still be read, and no longer be changed."""
        with self._lock:
            self._closed = True
            self._observers.clear()
        self._solver.close()

    @property
    def alive(self) -> bool:
        """Whether the solver's thread runs."""
        return self._solver.alive

    def __enter__(self) -> Deformation:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    # Behind it; the lock is held where these are called

    def _check_open(self) -> None:
        if self._closed:
            raise EditError("it is closed: what was deformed here can be read, but not changed")

    def _set(self, history: History[EditState], moved: EditState) -> None:
        """Make a history the present one. ``moved`` is the state whose selection is to be kept."""
        new = history.present
        self._history, self._error = history, None
        self._chain += 1
        if new.domain is not self._finder.domain:
            self._finder = PointFinder(new.domain)
        if self._frame is not None and not _belongs(self._frame, new):
            self._frame = None
        self._selection = _still_there(self._selection, moved.pose, new.pose)
        self._submit()

    def _submit(self, single: bool = False) -> None:
        self._begun = True
        current = self.state.current
        if single or not self.solved:
            self._solver.submit(Task(current, self._chain, single))
        else:
            self._solver.stop()

    def _accept(self, frame: Frame) -> None:
        """A frame from the solver's thread."""
        with self._lock:
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
        with self._lock:
            self._error = error
            if self.comparison is not None:
                self._frame = None  # of an earlier problem
        self._tell("frame", "status")

    def _tell(self, *names: str) -> None:
        for observer in tuple(self._observers):
            for name in names:
                observer(name)


def _belongs(frame: Frame, state: EditState) -> bool:
    """Whether a frame may still be shown for a state."""
    same_method = frame.task.pose.method is state.current.method
    return frame.map is state.map and (frame.mesh is None or same_method)


def _still_there(chosen: tuple[int, ...], old: Pose, new: Pose) -> tuple[int, ...]:
    """Indices of the same handles in another pose."""
    kept = []
    for i in chosen:
        if i < len(old):
            found = np.flatnonzero((new.handles == old.handles[i]).all(axis=1))
            kept.extend(int(j) for j in found[:1])
    return tuple(kept)
