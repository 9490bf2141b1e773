"""The records of a solve: its progress and its result, the same for every method."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import Enum
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from glid_nb._arrays import Array
from glid_nb.certificate import Certificate, certificate_of, certify
from glid_nb.energies import Energy
from glid_nb.geometry import MeshMap
from glid_nb.harmonic import HarmonicMap, Inverse, MapError
from glid_nb.pose import DeformationMap, Pose
from glid_nb.solvers import misses
from glid_nb.solvers.discretisation import Discretisation
from glid_nb.solvers.options import Options
from glid_nb.solvers.sensitivity import Minimum, Of, Sensitivity, minimum_of, sensitivity

if TYPE_CHECKING:
    from glid_nb.solvers.method import Method

Make = Callable[[], Certificate | MeshMap]
"""Makes the current map: a Certificate that contains a harmonic map, or a map of a mesh."""


class Status(Enum):
    """Outcome of a solve. The value of a member is a word, its ``message`` a full sentence."""

    CONVERGED = ("converged", "The solver converged: the Newton decrement is below the tolerance.")
    STATIONARY = (
        "stationary",
        "The solver converged as far as double precision allows: no step lowers the energy.",
    )
    MAX_ITERATIONS = "max_iterations", "The solver stopped at the maximal number of iterations."
    STOPPED = "stopped", "The solver was stopped from outside."
    BLOCKED = (
        "blocked",
        "No further step could be proved locally injective; the last certified map is returned.",
    )
    INDEFINITE = (
        "indefinite",
        "The Hessian is not positive definite and modifying it was not allowed; the last "
        "certified map is returned.",
    )

    UNPROVED = (
        "unproved",
        "No map that the solver reached could be proved locally injective; the certified map that "
        "it was to start from is returned.",
    )

    message: str

    def __new__(cls, value: str, message: str) -> Self:
        member = object.__new__(cls)
        member._value_, member.message = value, message
        return member

    @property
    def ok(self) -> bool:
        """Whether a local minimum was reached."""
        return self in (Status.CONVERGED, Status.STATIONARY)


@dataclass(frozen=True, kw_only=True)
class Energies:
    """The energy of a map."""

    energy_distortion: float
    """Isometric part."""
    energy_p2p: float
    """Positional part, ``lambda / 2`` times the sum of squared distances."""

    @property
    def energy(self) -> float:
        """Total energy, (20)."""
        return self.energy_distortion + self.energy_p2p


@dataclass(frozen=True, kw_only=True)
class Iteration(Energies):
    """One iteration of a method, after its step. A field is None if the method does not have it.

    Energies are means of the density over the boundary, or over the area of a mesh.
    """

    iteration: int = 0
    """1 for the first; 0 for the start."""
    time: float = 0.0
    """Seconds without compilation and without the work for this record alone. The iterations of
    one compiled call share its time evenly. For the start: the seconds that making it took, without
    the preparation of the domain."""
    step: float | None = None
    """Step length along the method's own direction."""
    decrement: float | None = None
    """Newton decrement before the step: ``sqrt(-gradient . direction)``."""
    sigma2_lower: float | None = None
    """Certified lower bound on ``sigma_2`` after the step."""
    hessian_modified: bool | None = None
    """Whether the projected Hessian was used."""
    corrections: int | None = None
    """Further steps with the same Hessian but new gradients."""
    panels: int | None = None
    """Number of panels of the boundary."""
    panels_split: int | None = None
    """Number of panels split since the last iteration because they refused a step."""
    flips: int | None = None
    """Number of triangles of a mesh that are flipped or flat."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Course(Energies):
    """The state of a method: its iterations so far and its energy."""

    method: Method
    initial: Iteration
    """The start, as iteration 0."""
    history: tuple[Iteration, ...]
    """All iterations so far. Empty at the start, and while panels are split before the first."""
    discretisation: Discretisation | None = field(default=None, repr=False)
    """Panels and matrices of a method in the harmonic subspace, from which to continue."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Progress(Course):
    """The state of a running solve, as a callback sees it."""

    make: Make = field(repr=False)
    sigma2_lower: Array | None = None
    """(p,) certified bound per panel; None before the first step."""

    @functools.cached_property
    def _made(self) -> Certificate | MeshMap:
        return self.make()

    @property
    def certificate(self) -> Certificate | None:
        """The proof of :attr:`map`; None for a map of a mesh."""
        return self._made if isinstance(self._made, Certificate) else None

    @property
    def map(self) -> DeformationMap:
        """The current map. A harmonic map is certified."""
        return self._made.map if isinstance(self._made, Certificate) else self._made


Callback = Callable[[Progress], bool | None]


@dataclass(frozen=True)
class Attempt:
    """One of several descents to a minimum, by different ways."""

    name: str
    status: Status
    energy: float
    iterations: int
    given_up: bool = False
    """Whether it was abandoned before its end, because it distorted the shape more than the best
    attempt so far. Then its energy is that of the last stage."""


@dataclass(frozen=True)
class Refinement:
    """The solve in one of several bases, each finer than the one before."""

    unknowns: int
    status: Status
    energy: float
    iterations: int
    solve_time: float
    """Seconds without compilation."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Result(Course):
    """The best map that a solve found, and how the solve found it.

    A map of the harmonic subspace is certified. A map of a mesh is not certified and has no
    certificate.
    """

    map: DeformationMap
    """A HarmonicMap, or a MeshMap if the method works on a mesh."""
    status: Status
    pose: Pose
    options: Options
    energy_measure: Energy
    """The isometric energy that was minimised."""
    compile_time: float
    """Seconds spent compiling during this solve."""
    solve_time: float
    """Seconds of the solve without compilation."""
    detail: str | None = None
    """The outcome as a full sentence, if the status's own sentence says too little."""
    factor: Any = field(default=None, repr=False)
    """Cholesky factor of the last Hessian, for a solve that continues from here."""
    attempts: tuple[Attempt, ...] = ()
    """All attempts, the first one included; empty if the solve tried no other."""
    refinements: tuple[Refinement, ...] = ()
    """All bases of :func:`glid_nb.refine`, the first one included; empty without it."""
    step_certificate: Certificate | None = field(default=None, repr=False)
    """What the solver proved of its last step; always certified. None for a map of a mesh."""

    def __getstate__(self) -> dict[str, Any]:
        """Pickle NumPy arrays: outside the package, JAX arrays would load in single precision."""
        known = {key: value for key, value in vars(self).items() if key != "minimum"}
        return {**known, "factor": None if self.factor is None else np.asarray(self.factor)}

    @property
    def start_energy(self) -> float:
        """Total energy of the map that the first iteration started from."""
        return self.initial.energy

    @functools.cached_property
    def misses(self) -> Array:
        """(h,) distances of the handles' images from their targets, world units."""
        return misses.misses_of(self.map, self.pose)

    @property
    def inverse(self) -> Inverse:
        """The inverse of :attr:`map`; a MapError for a map of a mesh, which has none."""
        if not isinstance(self.map, HarmonicMap):
            raise MapError("a map of a mesh has no inverse; solve by a method of the harmonic maps")
        return self.map.inverse

    @property
    def message(self) -> str:
        """The outcome as a full sentence. If a handle misses its target notably, a second sentence
        gives the largest miss and, if the targets would fold the shape, the conflict."""
        outcome = self.detail or self.status.message
        if self.status is Status.STOPPED:
            return outcome
        missed = misses.told(self.pose, self.misses, misses.unit_of(self.map))
        return f"{outcome} {missed[0].upper()}{missed[1:]}." if missed else outcome

    @property
    def iterations(self) -> int:
        """Iterations taken."""
        return len(self.history)

    @property
    def n_unknowns(self) -> int | None:
        """Real unknowns of the harmonic subspace, ``4 n - 10 N - 2`` unless conformal."""
        if self.discretisation is None:
            return None
        basis = self.discretisation.basis
        if not self.options.conformal:
            return basis.n_unknowns
        return 2 * int(basis.phi_free.sum()) - 2 * self.discretisation.domain.n_holes

    @property
    def n_panels(self) -> int | None:
        """Panels of the boundary at the end."""
        return None if self.discretisation is None else len(self.discretisation.panels)

    @property
    def panels_split(self) -> int | None:
        """Panels that were split during the solve."""
        if self.discretisation is None:
            return None
        return sum(iteration.panels_split or 0 for iteration in self.history)

    @property
    def flips(self) -> int | None:
        """Number of triangles that are flipped or flat; None for a harmonic map."""
        return int(np.sum(self.map.flipped)) if isinstance(self.map, MeshMap) else None

    @functools.cached_property
    def certificate(self) -> Certificate | None:
        """The proof for a harmonic map, with tight bounds from its coefficients alone.

        Computed on first use. If this computation proves nothing, :attr:`step_certificate` still
        holds.
        """
        disc, known = self.discretisation, self.step_certificate
        if isinstance(self.map, MeshMap):
            return None
        own = known is not None and known.belongs_to(self.map)  # the map may have been replaced
        if disc is None:
            return known if own else certify(self.map)
        tight = certify(self.map, disc.certificate, disc.panels, split=disc.can_split)
        return certificate_of(self.map) if own and not tight.certified else tight

    @functools.cached_property
    def minimum(self) -> Minimum:
        """The factor of the exact Hessian, for derivatives. Raises a SensitivityError if the solve
        has reached no isolated minimum."""
        return minimum_of(self)

    def sensitivity(self, handle: int | None = None, of: Of = "targets") -> Sensitivity:
        """How the map moves with a handle's target, the default, or with another of its numbers.

        ``of`` is "targets", "handles" (the place in the undeformed shape), "weights", "angles",
        "scales", or "s", the parameter of the energy, which needs no handle. The derivative is
        that of the implicit function theorem at the minimum, in the solve's unknowns and panels.
        The first call factors the exact Hessian, the others use that factor.

        Raises a SensitivityError, an InputError, if the solve has not converged or has no basis; if
        the minimum is not isolated, as with fewer than two handles; if there is no such handle or
        parameter; for an angle or a scale that is free.
        """
        return sensitivity(self.minimum, handle, of)
