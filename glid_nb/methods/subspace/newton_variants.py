"""Newton's method whose Hessian is made positive definite in other ways than ours."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
import scipy
from numpy.typing import NDArray

from glid_nb.methods.subspace.descent import Direction, Memoryless, SecondOrderMethod, View
from glid_nb.methods.subspace.problem import Curvature, SubspaceProblem
from glid_nb.solvers import Method, MethodError, Result, Status
from glid_nb.solvers.loop import Ending
from glid_nb.solvers.method import Family, Inputs
from glid_nb.solvers.newton import descend

Array = NDArray[Any]

_RIDGE = 1e-9

FLOOR = 1e-10
"""What negative eigenvalues become (Section 10)."""


@dataclass(frozen=True)
class _CompiledNewton(Method):
    """Our own loop with other options."""

    family: ClassVar[Family] = "harmonic"
    changed: ClassVar[dict[str, Any]]
    """Options that are not the caller's."""

    tolerance: float = 1e-10

    def run(self, inputs: Inputs) -> Result:
        """One descent."""
        changes = {"tolerance": self.tolerance, "corrections": 0, **self.changed}
        return descend(replace(inputs, options=replace(inputs.options, **changes)), self)


@dataclass(frozen=True)
class NewtonPaper(_CompiledNewton):
    """The paper's settings throughout, but for the start."""

    name: ClassVar[str] = "newton-paper"
    label: ClassVar[str] = "Newton, the paper's"
    summary: ClassVar[str] = (
        "The paper's solver: uniform samples, Lipschitz certificate, projected Hessian."
    )
    options: ClassVar[tuple[str, ...]] = (
        "p2p_weight",
        "conformal",
        "align",
        "max_iterations",
        "iterations_per_call",
    )
    changed: ClassVar[dict[str, Any]] = {
        "sampling": "uniform",
        "certificate": "lipschitz",
        "hessian": "projected",
    }


@dataclass(frozen=True)
class NewtonUnmodified(_CompiledNewton):
    """Newton's method with the exact Hessian."""

    name: ClassVar[str] = "newton-unmodified"
    label: ClassVar[str] = "Newton, unmodified"
    summary: ClassVar[str] = (
        "Newton's method with the exact Hessian; it halts where that is not positive definite."
    )
    options: ClassVar[tuple[str, ...]] = (*SecondOrderMethod.options, "iterations_per_call")
    changed: ClassVar[dict[str, Any]] = {"hessian": "exact"}


@dataclass(frozen=True)
class NewtonStaged(SecondOrderMethod):
    """Newton's method with the projected Hessian and its stages run one by one.

    With ``Options.paper()`` it makes the paper's iterations. ``hessian_samples``, ``|H|`` of
    Figure 8, needs the uniform sampling.
    """

    name: ClassVar[str] = "newton-staged"
    label: ClassVar[str] = "Newton, stage by stage"
    summary: ClassVar[str] = (
        "Newton's method with the projected Hessian and its stages run one by one."
    )

    hessian_samples: int | None = None

    def problem(self, inputs: Inputs) -> SubspaceProblem:
        """With as many Hessian samples as asked for."""
        return SubspaceProblem(
            inputs.domain,
            inputs.pose,
            inputs.energy,
            inputs.options,
            self.harmonic_start(inputs),
            hessian_samples=self.hessian_samples,
        )

    def direction(self) -> Direction:
        """The paper's direction."""
        return HessianDirection("projected")


@dataclass(frozen=True)
class NewtonEigen(SecondOrderMethod):
    """Newton-Eigen: full eigen-factorisation, negative eigenvalues raised to 1e-10 (Section 10).

    1e-10 is no scale of the problem: along a direction of negative curvature the step is 1e10 times
    the gradient's component, and the line search shortens all of it to what that one direction
    allows. With ``absolute``, negative eigenvalues change their sign instead.
    """

    name: ClassVar[str] = "newton-eigen"
    label: ClassVar[str] = "Newton-Eigen"
    summary: ClassVar[str] = (
        "Newton's method with a full eigen-factorisation, negative eigenvalues raised to 1e-10 "
        "or, with absolute, by their modulus."
    )

    absolute: bool = False

    def direction(self) -> Direction:
        """By the eigenvalues of the whole Hessian."""
        return EigenDirection(self.absolute)


@dataclass(frozen=True)
class NewtonShift(SecondOrderMethod):
    """Newton with a multiple of the identity added until Cholesky's factorisation succeeds.

    Nocedal & Wright 2006, Algorithm 3.3, as in Fu & Liu 2016; their constant ``beta`` is taken
    relative to the isometric Hessian's mean diagonal, for the coefficients have a unit of length.
    """

    name: ClassVar[str] = "newton-shift"
    label: ClassVar[str] = "Newton, shifted diagonal"
    summary: ClassVar[str] = (
        "Newton's method with a multiple of the identity added until the Hessian is definite."
    )

    beta: float = 1e-3

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.beta <= 0:
            raise MethodError(
                f"beta, the least multiple of the identity, must be positive; got {self.beta!r}"
            )

    def direction(self) -> Direction:
        """By a shifted Hessian."""
        return ShiftDirection(self.beta)


@dataclass(frozen=True)
class GaussNewton(SecondOrderMethod):
    """Gauss-Newton for ARAP, whose energy is a sum of squares."""

    name: ClassVar[str] = "gauss-newton"
    label: ClassVar[str] = "Gauss-Newton"
    summary: ClassVar[str] = "Gauss-Newton for ARAP, whose energy is a sum of squares."
    energies: ClassVar[tuple[str, ...] | None] = ("arap",)

    damping: float = 0.0

    def direction(self) -> Direction:
        """By the Gauss-Newton matrix."""
        return DampedDirection(self.damping)


@dataclass(frozen=True)
class LevenbergMarquardt(GaussNewton):
    """Gauss-Newton with an adaptive multiple of the identity, for ARAP, a sum of squares.

    The multiple is relative to the Hessian's mean diagonal: divided by 5 after a full step,
    doubled after a shortened one.
    """

    name: ClassVar[str] = "levenberg-marquardt"
    label: ClassVar[str] = "Levenberg-Marquardt"
    summary: ClassVar[str] = "Gauss-Newton for ARAP with an adaptive damping."

    damping: float = 1e-4


class HessianDirection(Memoryless):
    """Newton's direction with one of the pointwise Hessians: ``projected`` is the paper's."""

    def __init__(self, curvature: Curvature) -> None:
        self.curvature: Curvature = curvature

    def __call__(self, view: View) -> Array | Ending:
        h = view.problem.hessian(view.point, self.curvature) + view.problem.p2p_hessian
        direction = _solve(h, view.gradient)
        if direction is None and self.curvature == "projected":
            direction = _solve_semidefinite(h, view.gradient)
        return Ending(Status.INDEFINITE) if direction is None else direction


class EigenDirection(Memoryless):
    """The direction of :class:`NewtonEigen`."""

    def __init__(self, absolute: bool = False) -> None:
        self.absolute = absolute

    def __call__(self, view: View) -> Array:
        h = view.problem.hessian(view.point, "exact") + view.problem.p2p_hessian
        values, vectors = scipy.linalg.eigh(h, check_finite=False)
        values = np.maximum(np.abs(values) if self.absolute else values, FLOOR)
        return -vectors @ ((vectors.T @ view.gradient) / values)


class ShiftDirection(Memoryless):
    """The direction of :class:`NewtonShift`."""

    def __init__(self, beta: float = 1e-3) -> None:
        self.beta = beta

    def __call__(self, view: View) -> Array:
        iso = view.problem.hessian(view.point, "exact")
        h = iso + view.problem.p2p_hessian
        free = view.problem.free > 0
        beta = self.beta * float(np.abs(np.diag(iso)[free]).mean())
        least = float(np.diag(h).min())
        shift = 0.0 if least > 0 else beta - least
        while True:
            direction = _solve(h + shift * np.eye(len(h)), view.gradient)
            if direction is not None:
                return direction
            shift = max(2 * shift, beta)


class DampedDirection(Memoryless):
    """The direction of :class:`LevenbergMarquardt`; with ``damping = 0`` Gauss-Newton's."""

    def __init__(self, damping: float = 1e-4) -> None:
        self.damping = damping

    def __call__(self, view: View) -> Array | Ending:
        iso = view.problem.hessian(view.point, "gauss-newton")
        if view.step is not None:
            self.damping *= 0.2 if view.step >= 1 else 2.0
        free = view.problem.free
        shift = self.damping * float(np.diag(iso)[free > 0].mean())
        h = iso + view.problem.p2p_hessian + shift * np.diag(free)
        direction = _solve(h, view.gradient)
        if direction is None:
            direction = _solve_semidefinite(h, view.gradient)
        return Ending(Status.INDEFINITE) if direction is None else direction


def _solve_semidefinite(h: Array, gradient: Array) -> Array | None:
    """The same where H is singular, for want of samples or handles: Section 9.1's epsilon."""
    ridge = _RIDGE * float(np.diag(h).mean())
    return _solve(h + ridge * np.eye(len(h)), gradient)


def _solve(h: Array, gradient: Array) -> Array | None:
    """``-H^-1 g`` by Cholesky's factorisation; ``None`` where H is not positive definite."""
    try:
        factor = scipy.linalg.cho_factor(h, lower=True, check_finite=False)
    except np.linalg.LinAlgError:
        return None
    return -scipy.linalg.cho_solve(factor, gradient, check_finite=False)
