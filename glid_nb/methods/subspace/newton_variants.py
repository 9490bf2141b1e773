"""Newton's method whose Hessian is made positive definite in other ways than ours."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
import scipy
from numpy.typing import NDArray

from glid_nb._jax import jnp
from glid_nb.methods.subspace.descent import DirectedDescent, SecondOrderMethod
from glid_nb.solvers import Method, MethodError, OptionError, Result, Status
from glid_nb.solvers.loop import Ending
from glid_nb.solvers.method import Inputs
from glid_nb.solvers.newton import descend

Array = NDArray[Any]

_RIDGE = 1e-9

FLOOR = 1e-10
"""What negative eigenvalues become (Section 10)."""


@dataclass(frozen=True)
class _CompiledNewton(Method):
    """Our own loop with other options."""

    family = "harmonic"
    changed: ClassVar[dict[str, Any]]
    """Options that are not the caller's."""

    tolerance: float = 1e-10

    def run(self, inputs: Inputs) -> Result:
        changes = {"tolerance": self.tolerance, "corrections": 0, **self.changed}
        return descend(replace(inputs, options=replace(inputs.options, **changes)), self)


@dataclass(frozen=True)
class NewtonPaper(_CompiledNewton):
    """The paper's solver: uniform samples, Lipschitz certificate, projected Hessian."""

    name = "newton-paper"
    label = "Newton, the paper's"
    options = ("p2p_weight", "conformal", "align", "max_iterations", "iterations_per_call")
    changed: ClassVar = {
        "sampling": "uniform",
        "certificate": "lipschitz",
        "hessian": "projected",
    }


@dataclass(frozen=True)
class NewtonUnmodified(_CompiledNewton):
    """Newton's method with the exact Hessian; it halts where that is not positive definite."""

    name = "newton-unmodified"
    label = "Newton, unmodified"
    options = (*SecondOrderMethod.options, "iterations_per_call")
    changed: ClassVar = {"hessian": "exact"}


@dataclass(frozen=True)
class NewtonStaged(SecondOrderMethod):
    """Newton's method with the projected Hessian and its stages run one by one.

    With ``Options.paper()`` it makes the paper's iterations. ``hessian_samples``, ``|H|`` of
    Figure 8, needs the uniform sampling.
    """

    name = "newton-staged"
    label = "Newton, stage by stage"

    hessian_samples: int | None = None

    def started(self, inputs: Inputs) -> DirectedDescent:
        at, count = super().started(inputs), self.hessian_samples
        if count is None:
            return at
        panels = len(at.discretisation.panels)
        if inputs.options.sampling != "uniform":
            raise OptionError("hessian_samples needs sampling='uniform'")
        if not 1 <= count <= panels:
            raise OptionError(f"hessian_samples must be from 1 to {panels}, got {count}")
        matrices = at.problem.matrices._replace(
            hessian_index=jnp.asarray(np.linspace(0, panels, count, endpoint=False).astype(int)),
            hessian_weights=jnp.full(count, 1 / count),
        )
        at.problem = at.problem._replace(matrices=matrices)
        return at

    def direction(self, at: DirectedDescent) -> Array | Ending:
        h = at.hessian("projected") + at.p2p_hessian
        return _solve_semidefinite(h, at.gradient)


@dataclass(frozen=True)
class NewtonEigen(SecondOrderMethod):
    """Newton's method with a full eigen-factorisation, negative eigenvalues raised to 1e-10 or,
    with absolute, by their modulus.

    Newton-Eigen (Section 10). 1e-10 is no scale of the problem: along a direction of negative
    curvature the step is 1e10 times the gradient's component, and the line search shortens all of
    it to what that one direction allows. With ``absolute``, negative eigenvalues change their sign.
    """

    name = "newton-eigen"
    label = "Newton-Eigen"

    absolute: bool = False

    def direction(self, at: DirectedDescent) -> Array:
        h = at.hessian("exact") + at.p2p_hessian
        values, vectors = scipy.linalg.eigh(h, check_finite=False)
        values = np.maximum(np.abs(values) if self.absolute else values, FLOOR)
        return -vectors @ ((vectors.T @ at.gradient) / values)


@dataclass(frozen=True)
class NewtonShift(SecondOrderMethod):
    """Newton's method with a multiple of the identity added until the Hessian is definite.

    Nocedal & Wright 2006, Algorithm 3.3, as in Fu & Liu 2016; their constant ``beta`` is taken
    relative to the isometric Hessian's mean diagonal, for the coefficients have a unit of length.
    """

    name = "newton-shift"
    label = "Newton, shifted diagonal"

    beta: float = 1e-3

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.beta <= 0:
            raise MethodError(
                f"beta, the least multiple of the identity, must be positive; got {self.beta!r}"
            )

    def direction(self, at: DirectedDescent) -> Array:
        iso = at.hessian("exact")
        h = iso + at.p2p_hessian
        beta = self.beta * float(np.abs(np.diag(iso)[at.free > 0]).mean())
        least = float(np.diag(h).min())
        shift = 0.0 if least > 0 else beta - least
        while True:
            direction = _solve(h + shift * np.eye(len(h)), at.gradient)
            if direction is not None:
                return direction
            shift = max(2 * shift, beta)


@dataclass(frozen=True)
class GaussNewton(SecondOrderMethod):
    """Gauss-Newton for ARAP, whose energy is a sum of squares."""

    name = "gauss-newton"
    label = "Gauss-Newton"
    energies = ("arap",)

    damping: float = 0.0

    def remembered(self) -> float:
        return self.damping

    def direction(self, at: DirectedDescent) -> Array | Ending:
        iso = at.hessian("gauss-newton")
        if at.step is not None:
            at.memory *= 0.2 if at.step >= 1 else 2.0
        shift = at.memory * float(np.diag(iso)[at.free > 0].mean())
        h = iso + at.p2p_hessian + shift * np.diag(at.free)
        return _solve_semidefinite(h, at.gradient)


@dataclass(frozen=True)
class LevenbergMarquardt(GaussNewton):
    """Gauss-Newton for ARAP with an adaptive damping.

    The multiple of the identity is relative to the Hessian's mean diagonal: divided by 5 after a
    full step, doubled after a shortened one.
    """

    name = "levenberg-marquardt"
    label = "Levenberg-Marquardt"

    damping: float = 1e-4


def _solve_semidefinite(h: Array, gradient: Array) -> Array | Ending:
    """``-H^-1 g``, where H is singular for want of samples or handles by Section 9.1's epsilon."""
    direction = _solve(h, gradient)
    if direction is None:
        ridge = _RIDGE * float(np.diag(h).mean())
        direction = _solve(h + ridge * np.eye(len(h)), gradient)
    return Ending(Status.INDEFINITE) if direction is None else direction


def _solve(h: Array, gradient: Array) -> Array | None:
    """``-H^-1 g`` by Cholesky's factorisation; ``None`` where H is not positive definite."""
    try:
        factor = scipy.linalg.cho_factor(h, lower=True, check_finite=False)
    except np.linalg.LinAlgError:
        return None
    return -scipy.linalg.cho_solve(factor, gradient, check_finite=False)
