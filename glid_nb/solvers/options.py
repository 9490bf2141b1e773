"""Settings of a solve."""

from __future__ import annotations

import math
import numbers
from dataclasses import dataclass
from typing import Any, Literal, get_args

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

    sampling: Sampling = "graded"
    certificate: CertificateKind = "hermite"
    hessian: HessianKind = "adaptive"
    p2p_weight: float = 1e5
    conformal: bool = False
    align: bool = True
    restarts: int = 3
    max_iterations: int | None = None
    tolerance: float = 1e-10
    corrections: int = MOST_CORRECTIONS
    iterations_per_call: int = _MOST_PER_CALL

    def __post_init__(self) -> None:
        for name, kinds in (
            ("sampling", Sampling),
            ("certificate", CertificateKind),
            ("hessian", HessianKind),
        ):
            value, allowed = getattr(self, name), get_args(kinds)
            if value not in allowed:
                raise OptionError(f"unknown {name} {value!r}; choose one of {', '.join(allowed)}")
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
