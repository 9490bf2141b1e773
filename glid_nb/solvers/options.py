"""Settings of a solve."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from glid_nb._arguments import check_fields, option
from glid_nb._errors import InputError
from glid_nb.certificate.rounding import CARRIED_STEPS
from glid_nb.geometry import Cage
from glid_nb.solvers.discretisation import CertificateKind, Sampling

MOST_CORRECTIONS = 3
# The certificate's allowance for rounding covers CARRIED_STEPS steps of one compiled call.
MOST_PER_CALL = CARRIED_STEPS // (1 + MOST_CORRECTIONS)

HessianKind = Literal["adaptive", "projected", "exact"]

# Names in menus.
_SAMPLINGS = {"graded": "Graded panels", "uniform": "Uniform (paper)"}
_LIPSCHITZ = {"lipschitz": "Lipschitz (paper)", "bdhm": "Lipschitz (BDHM)"}
_CERTIFICATES = {"hermite": "Hermite–Bernstein", **_LIPSCHITZ}
_HESSIANS = {"adaptive": "Adaptive", "projected": "Projected (paper)", "exact": "Exact"}


class OptionError(InputError):
    """A setting is out of range."""


@dataclass(frozen=True)
class Options:
    """How to solve. The defaults are ours; the paper's are ``Options.paper()``.

    Raises an OptionError that names a value out of range.
    """

    sampling: Sampling = option("graded", "Where the energy is integrated", "Sampling", _SAMPLINGS)
    """Where the energy is integrated: on panels graded by their distance to the singularities
    ("graded"), or at the paper's 10^4 uniform samples (31) ("uniform")."""
    certificate: CertificateKind = option(
        "hermite", "How local injectivity is proved", "Certificate", _CERTIFICATES
    )
    """How local injectivity is proved. "lipschitz" is the paper's certificate (Section 8). "bdhm"
    has the larger constants that the paper replaces (Figure 7)."""
    hessian: HessianKind = option("adaptive", "The matrix of Newton's method", "Hessian", _HESSIANS)
    """The matrix of Newton's method. "adaptive" uses the exact Hessian where it is positive
    definite, else the projected one (Section 7). "projected" always uses the projected one, as in
    the paper. "exact" never projects and stops at an indefinite Hessian."""
    p2p_weight: float = option(1e5, "How strongly targets attract the shape", "Weight λ", above=0)
    """``lambda`` of (20), positive, for lengths in twentieths of the cage's longer side. So a shape
    deforms the same way in every unit of length. :meth:`lambda_on` gives ``lambda`` in the cage's
    own units. Methods with certified maps use at most 2.5e10, because rounding would hide the
    distortion beside a larger weight."""
    conformal: bool = option(False, "No shear anywhere", "Conformal maps only")
    """Restrict the maps to conformal ones, ``psi = 0`` (Section 6)."""
    align: bool = option(True, "Begin at the best rigid motion to the targets", "Align")
    """Begin with the rigid motion that brings the handles closest to their targets. This motion
    changes neither distortion nor certificate and often saves half of the iterations."""
    restarts: int = option(10, "Restarts to try after a high energy", "Restarts")
    """How many restarts (see :mod:`glid_nb.minima.ways`) a solve from the identity may try; 0
    tries none. It tries them when the first descent does not converge, ends at a high energy, or
    turns parts so far that they might turn the other way round. The result's ``attempts`` list what
    each of them reached."""
    max_iterations: int | None = option(
        None, "Largest number of iterations; 200 for Newton's method", "Iterations"
    )
    """Most iterations of one attempt, at least 0. The default is the method's: 200 for Newton's."""
    tolerance: float = option(
        1e-10, "Relative decrease at which the solve ends", "Tolerance", least=0
    )
    """The solve has converged when the decrease predicted by the Newton decrement, ``decrement^2 /
    2``, is below ``tolerance`` times the energy. Other methods have their own tolerances."""
    corrections: int = option(
        MOST_CORRECTIONS,
        "Most steps with an old Hessian",
        "Corrections",
        most=MOST_CORRECTIONS,
    )
    """Most extra steps with the same Hessian, 0 to 3, in an iteration close to the minimum. They
    save iterations. Also, a solve that continues another one begins with the last Hessian of that
    one. 0 gives the plain Newton method."""
    iterations_per_call: int = option(
        MOST_PER_CALL,
        "Iterations between two frames",
        "Iterations / frame",
        least=1,
        most=MOST_PER_CALL,
    )
    """Newton iterations that one compiled call runs before the host sees the state, 1 to 7."""

    def __post_init__(self) -> None:
        check_fields(self, OptionError)

    def lambda_on(self, cage: Cage) -> float:
        """``lambda`` of (20) for lengths in the cage's own units."""
        return self.p2p_weight / cage.unit**2

    @classmethod
    def paper(cls, **changes: Any) -> Options:
        """The paper's settings (Section 10).

        They are uniform samples, the Lipschitz certificate and the projected Hessian. They start at
        the identity itself, without alignment, restarts or corrections. The paper gives
        ``lambda = 1e5`` in its cages' own units. For exactly that, pass
        ``p2p_weight=1e5 * cage.unit**2``.
        """
        kinds = {"sampling": "uniform", "certificate": "lipschitz", "hessian": "projected"}
        settings: dict[str, Any] = {**kinds, "align": False, "restarts": 0, "corrections": 0}
        return cls(**{**settings, **changes})
