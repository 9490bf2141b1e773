"""What the deformation editor holds at one moment, as an immutable value."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from glid_nb._errors import InputError
from glid_nb.energies import Energy, SymmetricDirichlet
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.session.document import NamedPose
from glid_nb.solvers import Iteration, Method, Newton, Options, Pose, Result, Status

LIVE_OPTIONS = Options(restarts=0, iterations_per_call=1)
"""Settings for solving under a hand: the next frame soon, and no other way to a minimum."""


MOST_ITERATIONS = 200
"""So many of a gesture's iterations are kept, the latest ones."""


class EditError(InputError):
    """An action that the editor refuses; the message says why and what to do."""


@dataclass(frozen=True, eq=False)
class Solution:
    """How a finished solve ended. Small, so that an undo history may hold many."""

    status: Status
    message: str
    energy: float
    energy_iso: float
    energy_p2p: float
    history: tuple[Iteration, ...]
    starts: tuple[int, ...] = ()
    """Which of the gesture's iterations began with moved targets."""

    @property
    def ended(self) -> bool:
        """Whether the solver came to its end, rather than being stopped."""
        return self.status is not Status.STOPPED

    @classmethod
    def of(
        cls, result: Result, before: Sequence[Iteration] = (), starts: tuple[int, ...] = (1,)
    ) -> Solution:
        """The outcome of a solve that continued one with the iterations ``before``."""
        return cls(
            result.status,
            result.message,
            result.energy,
            result.energy_iso,
            result.energy_p2p,
            continued_history(before, result.history),
            starts,
        )


def continued_history(
    before: Sequence[Iteration], more: Sequence[Iteration]
) -> tuple[Iteration, ...]:
    """One history of two, numbered through."""
    last = before[-1].iteration if before else 0
    latest = more[-MOST_ITERATIONS:]
    return (*before, *(replace(i, iteration=last + i.iteration) for i in latest))[-MOST_ITERATIONS:]


@dataclass(frozen=True, eq=False)
class EditedPose:
    """One pose in the making.

    Parameters
    ----------
    name : str
        What the list of poses shows.
    pose : Pose
        Handles and targets.
    energy : Energy
    options : Options
    map : HarmonicMap
        The best map so far; always certified.
    solution : Solution or None
        How the solve that found ``map`` ended; None while there is none for this very pose,
        energy, options and method.
    method : Method
        What solves it. A method on a mesh leaves ``map`` as it is.
    """

    name: str
    pose: Pose
    energy: Energy
    options: Options
    map: HarmonicMap
    solution: Solution | None = None
    method: Method = field(default_factory=Newton)

    @property
    def solved(self) -> bool:
        """Whether ``map`` is where a solve came to its end; never so for a method on a mesh."""
        return self.solution is not None and self.solution.ended

    def asks_the_same(self, other: EditedPose) -> bool:
        """Whether the same problem is to be solved by the same method; values are not compared."""
        return (
            self.pose is other.pose
            and self.energy is other.energy
            and self.options is other.options
            and self.method is other.method
        )

    def changed(self, **changes: Any) -> EditedPose:
        """With another pose, energy, options or method: the map stays, and is no solution."""
        return replace(self, solution=None, **changes)

    def named(self) -> NamedPose:
        """As a document keeps it."""
        return NamedPose(self.name, self.pose, self.energy, self.options, self.map, self.method)

    @classmethod
    def from_named(cls, pose: NamedPose) -> EditedPose:
        """A document's pose; whether its map is the solution is not written there."""
        return cls(pose.name, pose.pose, pose.energy, pose.options, pose.map, method=pose.method)


@dataclass(frozen=True, eq=False)
class EditState:
    """Everything an undo brings back: the domain and all poses, one of them being edited.

    Parameters
    ----------
    domain : Domain
        All maps live on it.
    poses : tuple of EditedPose
        At least one.
    active : int
        Which of them is edited.
    """

    domain: Domain
    poses: tuple[EditedPose, ...]
    active: int = 0

    @classmethod
    def initial(
        cls,
        domain: Domain,
        pose: Pose | None = None,
        energy: Energy | None = None,
        options: Options | None = None,
    ) -> EditState:
        """One pose on a domain, at the identity map."""
        pose = Pose([], []) if pose is None else pose
        pose.check_inside(domain)
        first = EditedPose(
            "Pose 1",
            pose,
            SymmetricDirichlet() if energy is None else energy,
            LIVE_OPTIONS if options is None else options,
            HarmonicMap.identity(domain),
        )
        return cls(domain, (first,))

    @classmethod
    def from_poses(cls, domain: Domain, poses: Sequence[NamedPose], active: int = 0) -> EditState:
        """The poses of a document; without any, one at the identity map."""
        if not poses:
            return cls.initial(domain)
        return cls(domain, tuple(map(EditedPose.from_named, poses)), active)

    @property
    def current(self) -> EditedPose:
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

    @functools.cached_property
    def identity(self) -> HarmonicMap:
        """The map that moves nothing."""
        return HarmonicMap.identity(self.domain)

    def with_current(self, current: EditedPose) -> EditState:
        """The same with another value of the pose that is edited."""
        before, after = self.poses[: self.active], self.poses[self.active + 1 :]
        return replace(self, poses=(*before, current, *after))
