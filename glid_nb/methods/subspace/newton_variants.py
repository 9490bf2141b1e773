"""Newton directions whose Hessian is made positive definite in other ways than the paper's."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
import scipy
from numpy.typing import NDArray

from glid_nb.methods.recording import Ending
from glid_nb.methods.subspace.descent import View
from glid_nb.methods.subspace.evaluation import Curvature
from glid_nb.solvers import Status

Array = NDArray[Any]

_RIDGE = 1e-9

FLOOR = 1e-10
"""What negative eigenvalues become (Section 10)."""


class HessianDirection:
    """Newton's direction with one of the pointwise Hessians: ``projected`` is the paper's."""

    second_order: ClassVar[bool] = True

    def __init__(self, curvature: Curvature) -> None:
        self.curvature: Curvature = curvature

    def __call__(self, view: View) -> Array | Ending:
        h = view.problem.hessian(view.point, self.curvature) + view.problem.p2p_hessian
        direction = _solve(h, view.gradient)
        if direction is None and self.curvature == "projected":
            direction = _solve_semidefinite(h, view.gradient)
        return Ending(Status.INDEFINITE) if direction is None else direction

    def forget(self) -> bool:
        return False


class EigenDirection:
    """Newton-Eigen: full eigen-factorisation, negative eigenvalues raised to 1e-10 (Section 10).

    1e-10 is no scale of the problem: along a direction of negative curvature the step is 1e10 times
    the gradient's component, and the line search shortens all of it to what that one direction
    allows. With ``absolute``, negative eigenvalues change their sign instead.
    """

    second_order: ClassVar[bool] = True

    def __init__(self, absolute: bool = False) -> None:
        self.absolute = absolute

    def __call__(self, view: View) -> Array:
        h = view.problem.hessian(view.point, "exact") + view.problem.p2p_hessian
        values, vectors = scipy.linalg.eigh(h, check_finite=False)
        values = np.maximum(np.abs(values) if self.absolute else values, FLOOR)
        return -vectors @ ((vectors.T @ view.gradient) / values)

    def forget(self) -> bool:
        return False


class ShiftDirection:
    """Newton with a multiple of the identity added until Cholesky's factorisation succeeds.

    Nocedal & Wright 2006, Algorithm 3.3, as in Fu & Liu 2016; their constant is taken relative to
    the isometric Hessian's mean diagonal, for the coefficients have a unit of length.
    """

    second_order: ClassVar[bool] = True

    def __init__(self, beta: float = 1e-3) -> None:
        self.beta = beta

    def __call__(self, view: View) -> Array:
        iso = view.problem.hessian(view.point, "exact")
        h = iso + view.problem.p2p_hessian
        free = view.problem.unknowns.free > 0
        beta = self.beta * float(np.abs(np.diag(iso)[free]).mean())
        least = float(np.diag(h).min())
        shift = 0.0 if least > 0 else beta - least
        while True:
            direction = _solve(h + shift * np.eye(len(h)), view.gradient)
            if direction is not None:
                return direction
            shift = max(2 * shift, beta)

    def forget(self) -> bool:
        return False


class LevenbergMarquardt:
    """Gauss-Newton with an adaptive multiple of the identity, for ARAP, a sum of squares.

    The multiple is relative to the Hessian's mean diagonal: divided by 5 after a full step,
    doubled after a shortened one. With ``damping = 0`` this is plain Gauss-Newton.
    """

    second_order: ClassVar[bool] = True

    def __init__(self, damping: float = 1e-4) -> None:
        self.damping = damping

    def __call__(self, view: View) -> Array | Ending:
        iso = view.problem.hessian(view.point, "gauss-newton")
        if np.isfinite(view.step):
            self.damping *= 0.2 if view.step >= 1 else 2.0
        free = view.problem.unknowns.free
        shift = self.damping * float(np.diag(iso)[free > 0].mean())
        h = iso + view.problem.p2p_hessian + shift * np.diag(free)
        direction = _solve(h, view.gradient)
        if direction is None:
            direction = _solve_semidefinite(h, view.gradient)
        return Ending(Status.INDEFINITE) if direction is None else direction

    def forget(self) -> bool:
        return False


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
