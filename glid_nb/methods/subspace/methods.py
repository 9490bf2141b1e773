"""First-order methods, and Newton methods with other Hessians than ours."""

import functools
from collections import deque
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, Literal

import numpy as np
import scipy

from glid_nb._arrays import Array
from glid_nb._jax import jnp
from glid_nb.methods.subspace.descent import DirectedDescent, SecondOrderMethod, SubspaceMethod
from glid_nb.solvers import Inputs, Method, OptionError, Result, Status
from glid_nb.solvers.loop import Ending
from glid_nb.solvers.newton import descend

Initial = Literal["identity", "dirichlet"]

# The published L-BFGS code sums the energy over this many samples; we take the mean. Its initial
# Hessian is twice the identity.
_SAMPLES = 1e4
_RIDGE = 1e-9
FLOOR = 1e-10  # the value that replaces negative eigenvalues (Section 10)


@dataclass(frozen=True)
class LBFGS(SubspaceMethod):
    """L-BFGS with ``memory`` pairs (Nocedal & Wright 2006, Algorithm 7.4).

    Its initial Hessian is the exact Hessian of the positional energy plus a simple one for the
    isometric energy. With ``initial="identity"`` this is a multiple of the identity, as in the
    published code. With "dirichlet" it is the Hessian of the Dirichlet energy, an alternative in
    the published code. The initial Hessian is factored once.

    Its success depends on ``lambda`` of (20). The published code uses 20, with which L-BFGS reaches
    Newton's minimum. With 1e5 the targets outweigh the distortion. Then directions lead straight to
    the targets, through a fold, and thousands of iterations change little.
    """

    name = "lbfgs"
    label = "L-BFGS"
    max_iterations = 3000

    memory: int = 5
    initial: Initial = "identity"

    def forget(self, memory: "Pairs") -> bool:
        had = bool(memory.pairs)
        memory.pairs.clear()
        memory.last = None
        return had

    def direction(self, at: DirectedDescent) -> Array:
        if at.memory is None:
            per_area = at.unit**-2  # makes the steps scale with the shape
            iso = np.diag(np.where(at.free > 0, 2 / _SAMPLES * per_area, 1.0))
            if self.initial == "dirichlet":
                # With all handles in one place, the Dirichlet Hessian is singular.
                iso = at.hessian("dirichlet") + 1e-9 * per_area * np.eye(len(iso))
            factor = scipy.linalg.cho_factor(at.p2p_hessian + iso, lower=True)
            at.memory = Pairs(self.memory, factor)
        pairs: Pairs = at.memory
        pairs.add(np.asarray(at.coefficients) * at.free, at.gradient)
        solve = functools.partial(scipy.linalg.cho_solve, pairs.factor)
        return -two_loop(at.gradient, list(pairs.pairs), solve)


@dataclass(frozen=True)
class GradientDescent(SubspaceMethod):
    """Steepest descent."""

    name = "gradient-descent"
    label = "Gradient descent"
    max_iterations = 1000

    def direction(self, at: DirectedDescent) -> Array:
        # Scale the step to the size of the coefficients, which suits the line search.
        slope = float(np.linalg.norm(at.gradient))
        return -(at.size / slope if slope > 0 else 1.0) * at.gradient


class Pairs:
    def __init__(self, most: int, factor: Any) -> None:
        self.pairs: deque[tuple[Array, Array]] = deque(maxlen=most)
        self.last: tuple[Array, Array] | None = None
        self.factor = factor

    def add(self, x: Array, gradient: Array) -> None:
        if self.last is not None:
            s, y = x - self.last[0], gradient - self.last[1]
            # A pair without positive curvature would make the approximation indefinite.
            if s @ y > 1e-12 * np.linalg.norm(s) * np.linalg.norm(y):
                self.pairs.append((s, y))
        self.last = (x, gradient)


def two_loop(gradient: Array, pairs: list[tuple[Array, Array]], apply_initial: Any) -> Array:
    """Apply the L-BFGS approximation of the inverse Hessian to a gradient. The oldest pair is
    first."""
    q = gradient.copy()
    alphas = []
    for s, y in reversed(pairs):
        alphas.append((s @ q) / (s @ y))
        q -= alphas[-1] * y
    r = apply_initial(q)
    for (s, y), alpha in zip(pairs, reversed(alphas), strict=True):
        r = r + (alpha - (y @ r) / (s @ y)) * s
    return r


@dataclass(frozen=True)
class _CompiledNewton(Method):
    family = "harmonic"
    changed: ClassVar[dict[str, Any]]  # options that override the caller's

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
    changed: ClassVar = {"sampling": "uniform", "certificate": "lipschitz", "hessian": "projected"}


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
        return _solve_semidefinite(at.hessian("projected") + at.p2p_hessian, at.gradient)


@dataclass(frozen=True)
class NewtonEigen(SecondOrderMethod):
    """Newton's method with a full eigen-factorisation. Negative eigenvalues are replaced by 1e-10
    or, with absolute, by their modulus.

    Newton-Eigen (Section 10), for lengths in twentieths of the cage's longer side. The value 1e-10
    is much smaller than the problem's scale. Along a direction of negative curvature, the step is
    1e10 times the gradient's component. The line search then shortens the whole step because of
    this one direction. With ``absolute``, negative eigenvalues change their sign.
    """

    name = "newton-eigen"
    label = "Newton-Eigen"

    absolute: bool = False

    def direction(self, at: DirectedDescent) -> Array:
        h = at.hessian("exact") + at.p2p_hessian
        values, vectors = scipy.linalg.eigh(h, check_finite=False)
        values = np.maximum(np.abs(values) if self.absolute else values, FLOOR / at.unit**2)
        return -vectors @ ((vectors.T @ at.gradient) / values)


@dataclass(frozen=True)
class NewtonShift(SecondOrderMethod):
    """Newton's method with a multiple of the identity added until the Hessian is definite.

    Nocedal & Wright 2006, Algorithm 3.3, as in Fu & Liu 2016. Here their constant ``beta`` is
    relative to the isometric Hessian's mean diagonal, because the coefficients have a unit of
    length.
    """

    name = "newton-shift"
    label = "Newton, shifted diagonal"

    beta: float = field(
        default=1e-3, metadata={"above": 0, "why": ", because it is the least shift"}
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

    def direction(self, at: DirectedDescent) -> Array | Ending:
        iso = at.hessian("gauss-newton")
        if at.step is None:
            at.memory = self.damping
        else:
            at.memory *= 0.2 if at.step >= 1 else 2.0
        shift = at.memory * float(np.diag(iso)[at.free > 0].mean())
        h = iso + at.p2p_hessian + shift * np.diag(at.free)
        return _solve_semidefinite(h, at.gradient)


@dataclass(frozen=True)
class LevenbergMarquardt(GaussNewton):
    """Gauss-Newton for ARAP with an adaptive damping.

    The multiple of the identity is relative to the Hessian's mean diagonal. It is divided by 5
    after a full step and doubled after a shortened one.
    """

    name = "levenberg-marquardt"
    label = "Levenberg-Marquardt"

    damping: float = 1e-4


def _solve_semidefinite(h: Array, gradient: Array) -> Array | Ending:
    """``-H^-1 g``. If H is singular (few samples or handles), Section 9.1's epsilon is added."""
    direction = _solve(h, gradient)
    if direction is None:
        ridge = _RIDGE * float(np.diag(h).mean())
        direction = _solve(h + ridge * np.eye(len(h)), gradient)
    return Ending(Status.INDEFINITE) if direction is None else direction


def _solve(h: Array, gradient: Array) -> Array | None:
    try:
        factor = scipy.linalg.cho_factor(h, lower=True, check_finite=False)
    except np.linalg.LinAlgError:
        return None
    return -scipy.linalg.cho_solve(factor, gradient, check_finite=False)
