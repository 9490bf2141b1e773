"""Settings of a solve."""

from __future__ import annotations

import math
import numbers
from dataclasses import dataclass, field, fields
from typing import Any, Literal

import numpy as np

from glid_nb._errors import InputError
from glid_nb.certificate.rounding import CARRIED_STEPS
from glid_nb.solvers.discretisation import CertificateKind, Sampling

MOST_CORRECTIONS = 3
# The certificate's allowance for rounding covers so many steps of one compiled call.
_MOST_PER_CALL = CARRIED_STEPS // (1 + MOST_CORRECTIONS)

HessianKind = Literal["adaptive", "projected", "exact"]


class OptionError(InputError):
    """A setting is out of range."""


def _shown(label: str, help: str, **choices: str) -> dict[str, Any]:
    """How flags and controls present a field; ``choices`` are values and their labels."""
    return {"label": label, "help": help, "choices": choices}


@dataclass(frozen=True)
class Options:
    """How to solve. The defaults are ours; the paper's are ``Options.paper()``.

    Parameters
    ----------
    sampling : "graded" or "uniform"
        Where the energy is integrated: panels graded by their distance to the singularities,
        or the paper's 10^4 uniform samples (31).
    certificate : "hermite", "lipschitz" or "bdhm"
        How local injectivity is proved; "lipschitz" is the paper's (Section 8), "bdhm" has the
        larger constants that the paper replaces (Figure 7).
    hessian : "adaptive", "projected" or "exact"
        The exact Hessian where it is positive definite, else the projected one; always the
        projected one (the paper's, Section 7); or always the exact one, halting where it is
        not positive definite.
    p2p_weight : float
        ``lambda`` of (20), positive.
    conformal : bool
        Restrict the maps to conformal ones, ``psi = 0`` (Section 6).
    align : bool
        Begin with the rigid motion that brings the handles closest to their targets. It changes
        neither distortion nor certificate and often saves half of the iterations.
    restarts : int
        How many other ways to a minimum (see :mod:`glid_nb.solvers.restarts`) a solve from the
        identity may try when its first one ends blocked or at a high energy; 0 tries none.
    max_iterations : int, optional
        Most iterations of one attempt, at least 0; by default the method's own, 200 for Newton's.
    tolerance : float
        The solve has converged when the Newton decrement's promise of a decrease,
        ``decrement^2 / 2``, falls below ``tolerance`` times the energy. Other methods have
        tolerances of their own.
    corrections : int
        Most steps that an iteration close to the minimum adds by the Hessian it has, 0 to 3. They
        save iterations, and a solve that goes on from another takes that one's last Hessian first;
        0 for Newton's method proper.
    iterations_per_call : int
        Newton iterations that one compiled call runs before the host sees the state, 1 to 7.

    Raises
    ------
    OptionError
        When a value is out of range; the message names it.
    """

    sampling: Sampling = field(
        default="graded",
        metadata=_shown(
            "Sampling",
            "Where the energy is integrated",
            graded="Graded panels",
            uniform="Uniform (paper)",
        ),
    )
    certificate: CertificateKind = field(
        default="hermite",
        metadata=_shown(
            "Certificate",
            "How local injectivity is proved",
            hermite="Hermite–Bernstein",
            lipschitz="Lipschitz (paper)",
            bdhm="Lipschitz (BDHM)",
        ),
    )
    hessian: HessianKind = field(
        default="adaptive",
        metadata=_shown(
            "Hessian",
            "The matrix of Newton's method",
            adaptive="Adaptive",
            projected="Projected (paper)",
            exact="Exact",
        ),
    )
    p2p_weight: float = field(
        default=1e5, metadata=_shown("Weight λ", "How strongly handles are drawn to their targets")
    )
    conformal: bool = field(
        default=False,
        metadata=_shown("Conformal maps only", "No shear anywhere"),
    )
    align: bool = field(
        default=True, metadata=_shown("Align", "Begin at the best rigid motion to the targets")
    )
    restarts: int = field(
        default=3, metadata=_shown("Restarts", "Other ways to try after a high energy")
    )
    max_iterations: int | None = field(
        default=None,
        metadata=_shown("Iterations", "Most iterations of one attempt; Newton's method makes 200"),
    )
    tolerance: float = field(
        default=1e-10, metadata=_shown("Tolerance", "Relative decrease at which the solve ends")
    )
    corrections: int = field(
        default=MOST_CORRECTIONS, metadata=_shown("Corrections", "Most steps by an old Hessian")
    )
    iterations_per_call: int = field(
        default=_MOST_PER_CALL,
        metadata=_shown("Iterations / frame", "Iterations between two frames"),
    )

    def __post_init__(self) -> None:
        for known in fields(self):
            value, choices = getattr(self, known.name), known.metadata["choices"]
            if choices and value not in tuple(choices):
                names = ", ".join(choices)
                raise OptionError(f"unknown {known.name} {value!r}; choose one of {names}")
        for name in ("conformal", "align"):
            if not isinstance(getattr(self, name), bool | np.bool_):
                raise OptionError(f"{name} must be True or False, got {getattr(self, name)!r}")
        _check_number("p2p_weight", self.p2p_weight, 0.0, strict=True)
        _check_number("tolerance", self.tolerance, 0.0, strict=False)
        _check_integer("restarts", self.restarts, 0)
        if self.max_iterations is not None:
            _check_integer("max_iterations", self.max_iterations, 0)
        _check_integer("corrections", self.corrections, 0, MOST_CORRECTIONS)
        _check_integer("iterations_per_call", self.iterations_per_call, 1, _MOST_PER_CALL)

    @classmethod
    def paper(cls, **changes: Any) -> Options:
        """The paper's own settings: uniform samples, Lipschitz certificate, projected Hessian.

        They start at the identity itself and try no other way.
        """
        settings: dict[str, Any] = {
            "sampling": "uniform",
            "certificate": "lipschitz",
            "hessian": "projected",
            "align": False,
            "restarts": 0,
            "corrections": 0,
        }
        return cls(**{**settings, **changes})


def _check_number(name: str, value: Any, least: float, strict: bool) -> None:
    real = isinstance(value, numbers.Real) and not isinstance(value, bool)
    valid = real and math.isfinite(value)
    if not valid or (value <= least if strict else value < least):
        relation = "greater than" if strict else "at least"
        raise OptionError(f"{name} must be a finite number {relation} {least:g}, got {value!r}")


def _check_integer(name: str, value: Any, least: int, most: float = math.inf) -> None:
    whole = isinstance(value, numbers.Integral) and not isinstance(value, bool)
    if not whole or not least <= int(value) <= most:
        wanted = f"of at least {least}" if most == math.inf else f"from {least} to {most}"
        raise OptionError(f"{name} must be a whole number {wanted}, got {value!r}")
