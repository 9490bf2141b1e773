"""The state of the deformation editor, as an immutable value."""

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
"""Options for solving during a drag: a frame per iteration, and no restarts."""

MOST_ITERATIONS = 200
"""Most iterations of a gesture that are kept, the latest ones."""


class EditError(InputError):
    """An action that the editor refuses; the message says why and what to do."""


@dataclass(frozen=True, eq=False)
class Solution:
    """How a solve ended; small, since an undo history holds many."""

    status: Status
    message: str
    energy: float
    energy_iso: float
    energy_p2p: float
    history: tuple[Iteration, ...]
    starts: tuple[int, ...] = ()
    """Numbers of the gesture's iterations at which the targets had moved."""

    @property
    def ended(self) -> bool:
        """Whether the solver came to its end, rather than being stopped."""
        return self.status is not Status.STOPPED

    @classmethod
    def of(
        cls, result: Result, before: Sequence[Iteration] = (), starts: tuple[int, ...] = (1,)
    ) -> Solution:
        """The end of a solve that went on after the iterations ``before``."""
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
    """Both histories as one, numbered consecutively."""
    last = before[-1].iteration if before else 0
    latest = more[-MOST_ITERATIONS:]
    return (*before, *(replace(i, iteration=last + i.iteration) for i in latest))[-MOST_ITERATIONS:]


@dataclass(frozen=True, eq=False)
class EditedPose:
    """A pose that is edited, and the map found for it so far."""

    name: str
    pose: Pose
    energy: Energy
    options: Options
    map: HarmonicMap
    """The best map so far; always certified."""
    solution: Solution | None = None
    """How the solve of this pose, energy, options and method ended with ``map``; None before."""
    method: Method = field(default_factory=Newton)
    """A method on a mesh leaves ``map`` as it is."""

    @property
    def solved(self) -> bool:
        """Whether a solve ended with ``map``; never for a method on a mesh."""
        return self.solution is not None and self.solution.ended

    def asks_the_same(self, other: EditedPose) -> bool:
        """Whether pose, energy, options and method are the very same objects."""
        return (
            self.pose is other.pose
            and self.energy is other.energy
            and self.options is other.options
            and self.method is other.method
        )

    def changed(self, **changes: Any) -> EditedPose:
        """A copy with another pose, energy, options or method; it is no longer solved."""
        return replace(self, solution=None, **changes)

    def named(self) -> NamedPose:
        """The pose as a document keeps it."""
        return NamedPose(self.name, self.pose, self.energy, self.options, self.map, self.method)

    @classmethod
    def from_named(cls, pose: NamedPose) -> EditedPose:
        """A document's pose, not solved: documents do not keep the solution."""
        return cls(pose.name, pose.pose, pose.energy, pose.options, pose.map, method=pose.method)


@dataclass(frozen=True, eq=False)
class EditState:
    """Everything that undo restores: the domain and all poses, one of them being edited."""

    domain: Domain
    """The domain of all maps."""
    poses: tuple[EditedPose, ...]
    """At least one."""
    active: int = 0
    """Index of the pose that is edited."""

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
        """The poses of a document; if it has none, one at the identity map."""
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
        """A copy with another value of the pose that is edited."""
        before, after = self.poses[: self.active], self.poses[self.active + 1 :]
        return replace(self, poses=(*before, current, *after))
