"""What a solve returns."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass, field
from typing import Any

from glid_nb.certificate import Certificate, certify
from glid_nb.energies import Energy
from glid_nb.harmonic import HarmonicMap
from glid_nb.solvers.discretisation import Discretisation
from glid_nb.solvers.options import Options
from glid_nb.solvers.pose import Pose
from glid_nb.solvers.status import Status


@dataclass(frozen=True)
class Iteration:
    """One Newton iteration, as it was after its step."""

    iteration: int
    """1 for the first."""
    energy: float
    """Total energy, (20)."""
    energy_iso: float
    """Isometric part, the mean of the density along the boundary."""
    energy_p2p: float
    """Positional part, ``lambda / 2`` times the sum of squared distances."""
    step: float
    """Step length ``t`` along the Newton direction."""
    decrement: float
    """Newton decrement before the step: ``sqrt(-gradient . direction)``."""
    sigma2_lower: float
    """Certified lower bound on ``sigma_2`` after the step."""
    hessian_modified: bool
    """Whether the projected Hessian was used."""
    corrections: int
    """Further steps by the same Hessian, from gradients of their own."""
    panels: int
    """Panels of the boundary."""
    panels_split: int
    """Panels split since the iteration before, because they refused a step."""
    time: float
    """Seconds without compilation, shared evenly within one compiled call."""


@dataclass(frozen=True)
class Attempt:
    """One of several ways to a minimum."""

    name: str
    status: Status
    energy: float
    iterations: int


@dataclass(frozen=True, eq=False)
class Result:
    """The best certified map that a solve found, and how it got there."""

    map: HarmonicMap
    status: Status
    energy: float
    energy_iso: float
    energy_p2p: float
    history: tuple[Iteration, ...]
    pose: Pose
    options: Options
    energy_measure: Energy
    discretisation: Discretisation = field(repr=False)
    compile_time: float
    """Seconds spent compiling during this solve."""
    solve_time: float
    """Seconds of the solve without compilation."""
    start_energy: float = math.nan
    """Total energy of the map that the first iteration started from."""
    factor: Any = field(default=None, repr=False)
    """Cholesky factor of the last Hessian, for a solve that goes on from here; None without."""
    attempts: tuple[Attempt, ...] = ()
    """All ways to a minimum that were tried, when the first was not the only one."""

    @property
    def message(self) -> str:
        """The outcome as a full sentence."""
        return self.status.message

    @property
    def iterations(self) -> int:
        """Newton iterations taken."""
        return len(self.history)

    @property
    def n_unknowns(self) -> int:
        """Real unknowns of the harmonic subspace, ``4 n - 10 N - 2`` unless conformal."""
        basis = self.discretisation.basis
        if not self.options.conformal:
            return basis.n_unknowns
        return 2 * int(basis.phi_free.sum()) - 2 * self.map.domain.n_holes

    @property
    def n_panels(self) -> int:
        """Panels of the boundary at the end."""
        return len(self.discretisation.panels)

    @property
    def panels_split(self) -> int:
        """Panels that were split during the solve."""
        return sum(iteration.panels_split for iteration in self.history)

    @functools.cached_property
    def certificate(self) -> Certificate:
        """The proof for :attr:`map`, recomputed from its coefficients alone on first use."""
        disc = self.discretisation
        return certify(self.map, disc.certificate, disc.panels, refine=disc.can_refine)
