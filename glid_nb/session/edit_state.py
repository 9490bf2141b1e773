"""The values of the deformation editor: its state, the solver's tasks and frames, moments."""

import functools
from dataclasses import dataclass, field, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from glid_nb._errors import InputError
from glid_nb.certificate import Certificate
from glid_nb.energies import Energy, SymmetricDirichlet
from glid_nb.geometry import Domain, MeshMap
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.order import Order, order_of
from glid_nb.pose import DeformationMap, Pose
from glid_nb.session.document import NamedPose, Solution
from glid_nb.session.pin_marks import PinMark, PinMarks
from glid_nb.session.timeline import Timeline
from glid_nb.solvers import Iteration, Options

LIVE_OPTIONS = Options(restarts=0, iterations_per_call=1)
"""Options for solving during a drag: one frame per iteration, no restarts."""


class EditError(InputError):
    """The editor refuses an action; the message says why and what to do."""


@dataclass(frozen=True, eq=False)
class Part:
    """One of several shapes of a session: a picture, the domain of its shape, and its poses."""

    key: int  # names the part in all states of a session, whatever its place in the order
    name: str
    image: NDArray[np.uint8]  # (h, w, 4); the pictures of all parts have the same size
    domain: Domain
    poses: tuple[NamedPose, ...]  # one for each keyframe
    visible: bool = True


@dataclass(frozen=True, eq=False)
class EditState:
    """Everything that undo restores: the domain and all poses, one of which is edited.

    A session may have several shapes, its parts. All have the same keyframes. Domain and poses of
    the state are those of one of them, the edited part.
    """

    domain: Domain
    poses: tuple[NamedPose, ...]
    """At least one. Their maps are the best ones so far and always certified."""
    active: int = 0  # index of the edited pose
    timeline: Timeline = field(default_factory=Timeline)
    """The times of the poses. Each pose is a keyframe, and they are sorted by time."""
    parts: tuple[Part, ...] = ()
    """The parts, the rearmost first; empty in a session with one shape."""
    part: int = 0  # index of the edited part
    pins: PinMarks = field(default_factory=PinMarks)
    """Which pins are locked, hidden or grouped, in all poses."""

    def __post_init__(self) -> None:
        assert len(self.timeline) == len(self.poses)
        assert all(pose.map.domain is self.domain for pose in self.poses)
        if self.parts:  # the edited part follows the state
            edited = replace(self.parts[self.part], domain=self.domain, poses=self.poses)
            before, after = self.parts[: self.part], self.parts[self.part + 1 :]
            vars(self)["parts"] = (*before, edited, *after)
            assert all(len(part.poses) == len(self.poses) for part in self.parts)

    @classmethod
    def initial(
        cls,
        domain: Domain,
        pose: Pose | None = None,
        energy: Energy | None = None,
        options: Options | None = None,
    ) -> Self:
        """A state with one pose, at the identity map."""
        pose = Pose([], []) if pose is None else pose
        pose.check_inside(domain)
        how = energy or SymmetricDirichlet(), options or LIVE_OPTIONS
        identity = HarmonicMap.identity(domain)
        return cls(domain, (NamedPose("Pose 1", pose, *how, identity, solution=None),))

    @property
    def current(self) -> NamedPose:
        """The edited pose."""
        return self.poses[self.active]

    @property
    def map(self) -> HarmonicMap:
        """The certified map of the edited pose."""
        return self.current.map

    @property
    def pose(self) -> Pose:
        """Handles and targets of the edited pose."""
        return self.current.pose

    @functools.cached_property
    def marks(self) -> tuple[PinMark, ...]:
        """The marks of the edited pose's handles."""
        return self.pins.of(self.pose.handles)

    @property
    def order(self) -> Order:
        """The order in which parts of the shape cover each other, by the handles' depths."""
        return order_of(self.domain.cage, self.pose)

    @functools.cached_property
    def orders(self) -> tuple[Order, ...]:
        """The order of each pose."""
        return tuple(order_of(self.domain.cage, pose.pose) for pose in self.poses)

    @functools.cached_property
    def identity(self) -> HarmonicMap:
        return HarmonicMap.identity(self.domain)

    @property
    def edited_part(self) -> Part | None:
        """The edited part; None in a session with one shape."""
        return self.parts[self.part] if self.parts else None

    @property
    def shapes(self) -> tuple[Self, ...]:
        """A state without other parts for each part, in their order; without parts itself."""
        return self._shapes if self.parts else (self,)

    @functools.cached_property
    def _shapes(self) -> tuple[Self, ...]:
        return tuple(
            replace(self, domain=part.domain, poses=part.poses, parts=(), part=0)
            for part in self.parts
        )

    @property
    def keys(self) -> tuple[int, ...]:
        """The keys of the parts, in the order of `shapes`; 0 is that of the only shape."""
        return tuple(part.key for part in self.parts) or (0,)

    def with_solved(self, pose: NamedPose, solved: NamedPose) -> Self:
        """A copy where ``solved`` replaces a pose, of whichever part."""

        def swapped(poses: tuple[NamedPose, ...]) -> tuple[NamedPose, ...]:
            return tuple(solved if each is pose else each for each in poses)

        parts = tuple(replace(part, poses=swapped(part.poses)) for part in self.parts)
        return replace(self, poses=swapped(self.poses), parts=parts)

    def changed(self, **changes: Any) -> Self:
        """A copy where the edited pose has another pose, energy, options, map or method."""
        return self.with_current(self.current.changed(**changes))

    def with_current(self, current: NamedPose) -> Self:
        """A copy where ``current`` replaces the edited pose."""
        before, after = self.poses[: self.active], self.poses[self.active + 1 :]
        return replace(self, poses=(*before, current, *after))


@dataclass(frozen=True, eq=False)
class Task:
    """A pose to solve, with the map to start from."""

    pose: NamedPose
    chain: int  # a task continues from the previous task's map only if both have the same chain
    single: bool = False  # stop after one compiled call, or one iteration of another method


@dataclass(frozen=True, eq=False)
class Frame:
    """A map during a solve, or the final map."""

    task: Task
    map: HarmonicMap  # certified; for a method on a mesh, the map of the task
    history: tuple[Iteration, ...]  # the latest iterations of this gesture
    starts: tuple[int, ...]  # numbers of the iterations at which the targets had moved
    solution: Solution | None = None  # None during the solve
    certificate: Certificate | None = None  # the solver's, for ``map``; None for a mesh
    mesh: MeshMap | None = None  # the map of a method on a mesh, which may fold


@dataclass(frozen=True, eq=False)
class Moment:
    """Everything that a view of a deformation draws, read at one moment, so consistent."""

    state: EditState
    frame: Frame | None  # the solver's last frame, if it belongs to the state; else None
    busy: bool
    paused: bool
    error: Exception | None = None  # the exception that ended the last solve, if any
    selection: tuple[int, ...] = ()
    dragged: tuple[int, ...] = ()  # indices of the dragged handles
    prepared: float = 1.0  # the finished share, 0 to 1, of the preparation for the first solve

    @property
    def map(self) -> HarmonicMap:
        """The certified map."""
        return self.state.map

    @property
    def comparison(self) -> MeshMap | None:
        """The uncertified map of a method on a mesh; else None. It may be older than the state."""
        return None if self.frame is None else self.frame.mesh

    @property
    def shown(self) -> DeformationMap:
        """The map to draw: the comparison, or the certified map."""
        return self.map if self.comparison is None else self.comparison

    @property
    def solution(self) -> Solution | None:
        """How the solve of the pose ended; None before its end."""
        current, frame = self.state.current, self.frame
        if current.method.certified:
            return current.solution
        # Only the frame has the result of a method on a mesh.
        if frame is None or not frame.task.pose.asks_the_same(current):
            return None
        return frame.solution

    @property
    def solved(self) -> bool:
        """Whether the solve of the pose has ended."""
        return self.solution is not None and self.solution.ended
