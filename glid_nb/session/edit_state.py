"""The values of the deformation editor: its state, the solver's tasks and frames, a moment."""

import functools
from dataclasses import dataclass, field, replace
from typing import Any, Self

from glid_nb._errors import InputError
from glid_nb.certificate import Certificate
from glid_nb.energies import Energy, SymmetricDirichlet
from glid_nb.geometry import Domain, MeshMap
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.order import Order, order_of
from glid_nb.pose import DeformationMap, Pose
from glid_nb.session.document import NamedPose, Solution
from glid_nb.session.timeline import Timeline
from glid_nb.solvers import Iteration, Options

LIVE_OPTIONS = Options(restarts=0, iterations_per_call=1)
"""Options for solving during a drag: a frame per iteration, and no restarts."""


class EditError(InputError):
    """An action that the editor refuses; the message says why and what to do."""


@dataclass(frozen=True, eq=False)
class EditState:
    """Everything that undo restores: the domain and all poses, one of them being edited."""

    domain: Domain
    poses: tuple[NamedPose, ...]
    """At least one. Their maps are the best ones so far, and always certified."""
    active: int = 0  # index of the pose that is edited
    timeline: Timeline = field(default_factory=Timeline)
    """When the poses are shown: each is a keyframe, and they are in the order of time."""

    def __post_init__(self) -> None:
        assert len(self.timeline) == len(self.poses)
        assert all(pose.map.domain is self.domain for pose in self.poses)

    @classmethod
    def initial(
        cls,
        domain: Domain,
        pose: Pose | None = None,
        energy: Energy | None = None,
        options: Options | None = None,
    ) -> Self:
        """One pose on a domain, at the identity map."""
        pose = Pose([], []) if pose is None else pose
        pose.check_inside(domain)
        how = energy or SymmetricDirichlet(), options or LIVE_OPTIONS
        identity = HarmonicMap.identity(domain)
        return cls(domain, (NamedPose("Pose 1", pose, *how, identity, solution=None),))

    @property
    def current(self) -> NamedPose:
        """The pose that is edited."""
        return self.poses[self.active]

    @property
    def map(self) -> HarmonicMap:
        """The certified map that is shown."""
        return self.current.map

    @property
    def pose(self) -> Pose:
        """Handles and targets of the pose that is edited."""
        return self.current.pose

    @property
    def order(self) -> Order:
        """Which part of the shape covers which, by the depths of the handles."""
        return order_of(self.domain.cage, self.pose)

    @functools.cached_property
    def orders(self) -> tuple[Order, ...]:
        """The same for each pose."""
        return tuple(order_of(self.domain.cage, pose.pose) for pose in self.poses)

    @functools.cached_property
    def identity(self) -> HarmonicMap:
        return HarmonicMap.identity(self.domain)

    def changed(self, **changes: Any) -> Self:
        """A copy with another pose, energy, options, map or method of the pose that is edited."""
        return self.with_current(self.current.changed(**changes))

    def with_current(self, current: NamedPose) -> Self:
        """A copy with another value of the pose that is edited."""
        before, after = self.poses[: self.active], self.poses[self.active + 1 :]
        return replace(self, poses=(*before, current, *after))


@dataclass(frozen=True, eq=False)
class Task:
    """What to solve, and the map to start from."""

    pose: NamedPose
    chain: int  # a task continues from the map of the task before it only if both are of one chain
    single: bool = False  # stop after one compiled call, or one iteration of another method


@dataclass(frozen=True, eq=False)
class Frame:
    """A map during a solve, or its final one."""

    task: Task
    map: HarmonicMap  # certified; for a method on a mesh the task's own
    history: tuple[Iteration, ...]  # the latest iterations of this gesture
    starts: tuple[int, ...]  # numbers of the iterations at which the targets had moved
    solution: Solution | None = None  # None while the solve goes on
    proof: Certificate | None = None  # the solver's, of ``map``; None for a method on a mesh
    mesh: MeshMap | None = None  # the map of a method on a mesh, which may fold


@dataclass(frozen=True, eq=False)
class Moment:
    """Everything that a view of a deformation draws, read at one moment and so consistent."""

    state: EditState
    frame: Frame | None  # the solver's last frame, if it belongs to the state; else None
    busy: bool
    paused: bool
    error: Exception | None = None  # the exception that ended the last solve, if one did
    selection: tuple[int, ...] = ()
    dragged: tuple[int, ...] = ()  # indices of handles, as the selection
    prepared: float = 1.0  # how much is done, from 0 to 1, of what the first solve of a shape needs

    @property
    def map(self) -> HarmonicMap:
        """The certified map."""
        return self.state.map

    @property
    def comparison(self) -> MeshMap | None:
        """The uncertified map of a method on a mesh, which lags behind the state; else None."""
        return None if self.frame is None else self.frame.mesh

    @property
    def shown(self) -> DeformationMap:
        """The map to draw: the comparison, or the certified map."""
        return self.map if self.comparison is None else self.comparison

    @property
    def solution(self) -> Solution | None:
        """How the solve of the pose ended; None before."""
        current, frame = self.state.current, self.frame
        if current.method.certified:
            return current.solution
        # The result of a method on a mesh is only in the frame.
        if frame is None or not frame.task.pose.asks_the_same(current):
            return None
        return frame.solution

    @property
    def solved(self) -> bool:
        """Whether the solve of the pose has come to its end."""
        return self.solution is not None and self.solution.ended
