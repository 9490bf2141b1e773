"""What every method in the harmonic subspace computes on the device, and the state of its panels.

Three programs: values and gradient at a map, the Hessian, and the step along a direction with
Newton's own line search and certificate. The direction itself is the method's affair, on the host.
"""

from __future__ import annotations

import functools
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from glid_nb._jax import AnyArray, jax, jit, jnp
from glid_nb._runtime import COMPILER_OPTIONS, compilation_clock, double_precision
from glid_nb.energies import Energy
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.solvers import OptionError, Options, Pose, evaluation, line_search
from glid_nb.solvers.discretisation import discretise
from glid_nb.solvers.evaluation import Point
from glid_nb.solvers.hessian import LocalHessian, assemble, local_hessian, positive_part
from glid_nb.solvers.problem import Positional, Problem, constraints_of, real_coefficients
from glid_nb.solvers.start import aligned, check_conformal, check_proved
from glid_nb.solvers.unknowns import expand, restrict_gradient, restrict_hessian, unknowns_of

if TYPE_CHECKING:
    from jaxtyping import Array, Bool, Float, Int

T = TypeVar("T")

Curvature = Literal["exact", "projected", "gauss-newton", "dirichlet"]


class Move(NamedTuple):
    """The outcome of one step."""

    outcome: Int[AnyArray, ""]
    point: Point
    gradient: Float[Array, " 4c"]
    step: Float[AnyArray, ""]
    sigma2_lower: Float[AnyArray, " p"]
    """Certified bound per panel."""
    refused: Bool[AnyArray, " p"]


@functools.partial(jit, compiler_options=COMPILER_OPTIONS)
def evaluate(
    problem: Problem, coefficients: Float[Array, " 4c"]
) -> tuple[Point, Float[Array, " 4c"]]:
    """A map's energies, and their gradient with respect to the unknowns, 0 elsewhere."""
    return _evaluated(problem, Positional.of(problem.constraints), coefficients)


def _evaluated(problem: Problem, positional: Positional, y: Float[Array, " 4c"]) -> Any:
    point = evaluation.evaluated(problem, positional, y)
    gradient = evaluation.gradient(problem, positional, point)
    return point, restrict_gradient(gradient, problem.unknowns)


@functools.partial(jit, static_argnames="curvature", compiler_options=COMPILER_OPTIONS)
def hessian(problem: Problem, point: Point, *, curvature: Curvature) -> Float[Array, "4c 4c"]:
    """Hessian of the isometric energy alone with respect to the unknowns (33).

    ``gauss-newton`` is for ARAP, whose density is ``2 (|f_z| - 1)^2 + 2 |f_zbar|^2``, a sum of
    squares: second derivatives of the residuals are left out. ``dirichlet`` is the Hessian of the
    Dirichlet energy ``|f_z|^2 + |f_zbar|^2``.
    """
    matrices = problem.matrices
    nodes = point.samples.nodes[:, matrices.hessian_index]
    x, y = evaluation.squares(nodes)
    if curvature == "gauss-newton":
        zero, four = jnp.zeros_like(x), jnp.full_like(x, 4.0)
        local = LocalHessian(zero, four, four, four, zero)
    elif curvature == "dirichlet":
        two, zero = jnp.full_like(x, 2.0), jnp.zeros_like(x)
        local = LocalHessian(two, two, two, two, zero)
    else:
        local = local_hessian(problem.energy.differentials(x, y), x, y)
        if curvature == "projected":
            local = positive_part(local)
    f, g = evaluation.directions(nodes)
    basis = matrices.nodes[:, matrices.hessian_index]
    h = assemble(basis, matrices.hessian_weights, f, g, local)
    upper = jnp.triu(restrict_hessian(h, problem.unknowns))
    return upper + jnp.triu(upper, 1).T


@functools.partial(jit, compiler_options=COMPILER_OPTIONS)
def advance(
    problem: Problem,
    point: Point,
    gradient: Float[Array, " 4c"],
    direction: Float[Array, " 4c"],
    may_refine: Bool[AnyArray, ""],
) -> Move:
    """The best certified step along ``direction``, a change of the unknowns."""
    positional = Positional.of(problem.constraints)
    slope = jnp.dot(gradient, direction)
    line = evaluation.line_along(problem, expand(direction, problem.unknowns), slope)
    found = line_search.search(problem, positional, point, line)
    end = line_search.backtrack(problem, positional, point, line, found, may_refine)
    # Values anew from the coefficients: their rounding errors must not add up over thousands of
    # iterations, for which the certificate makes no allowance.
    y = point.coefficients + end.step * line.direction
    after, gradient = _evaluated(problem, positional, y)
    return Move(end.outcome, after, gradient, end.step, end.panel.sigma2_lower, end.refused)


class Stopwatch:
    """Seconds of work, without compilation."""

    def __init__(self) -> None:
        self.seconds = 0.0

    def run(self, function: Callable[..., T], *arguments: Any, **named: Any) -> T:
        """Call a function and wait for its result; calls within it count themselves."""
        clock, counted = compilation_clock(), self.seconds
        began, compiling = time.perf_counter(), clock.seconds
        result = jax.block_until_ready(function(*arguments, **named))
        elapsed = time.perf_counter() - began - (clock.seconds - compiling)
        self.seconds += max(elapsed - (self.seconds - counted), 0.0)
        return result

    def lap(self) -> float:
        """Seconds since the last lap."""
        seconds, self.seconds = self.seconds, 0.0
        return seconds


class SubspaceProblem:
    """Domain, pose and energy, discretised; its state is the discretisation, which may be refined.

    Parameters
    ----------
    options : Options
        ``sampling``, ``certificate``, ``p2p_weight``, ``conformal`` and ``align`` count here.

    Raises
    ------
    StartError
        When the map to start from is not proved locally injective, or not conformal though the
        options ask for it.
    """

    @double_precision
    def __init__(
        self,
        domain: Domain,
        pose: Pose,
        energy: Energy,
        options: Options,
        start: HarmonicMap | None = None,
    ) -> None:
        self.options, self.watch = options, Stopwatch()
        self.discretisation = discretise(domain, options.sampling, options.certificate)
        basis = self.discretisation.basis
        self.problem = Problem(
            matrices=self.discretisation.matrices,
            singularities=basis.singularities,
            unknowns=unknowns_of(basis, options.conformal),
            constraints=constraints_of(domain, pose, options.p2p_weight),
            energy=energy,
        )
        map_ = HarmonicMap.identity(domain)
        if start is not None:
            check_proved(start)
            if options.conformal:
                check_conformal(start)
            map_ = start
        if options.align:
            map_ = aligned(map_, pose)
        self.start = real_coefficients(basis, map_)

    @property
    def free(self) -> NDArray[Any]:
        """(4c,) 1 for an unknown, 0 for what is fixed or tied."""
        return np.asarray(self.problem.unknowns.free)

    @functools.cached_property
    def p2p_hessian(self) -> NDArray[Any]:
        """(4c, 4c) Hessian of the positional energy, fixed and tied unknowns left out."""
        positional = Positional.of(self.problem.constraints)
        h = positional.matrix.T @ (positional.weights[:, None] * positional.matrix)
        # The identity on what is fixed is already in the isometric Hessian.
        return np.asarray(restrict_hessian(h, self.problem.unknowns)) - np.diag(1 - self.free)

    def evaluate(self, coefficients: NDArray[Any]) -> tuple[Point, NDArray[Any]]:
        """The point with these coefficients, and the gradient there."""
        point, gradient = self.watch.run(evaluate, self.problem, jnp.asarray(coefficients))
        return point, np.asarray(gradient)

    def hessian(self, point: Point, curvature: Curvature) -> NDArray[Any]:
        """(4c, 4c) Hessian of the isometric energy; the identity on what is fixed or tied."""
        return np.asarray(self.watch.run(hessian, self.problem, point, curvature=curvature))

    def advance(
        self, point: Point, gradient: NDArray[Any], direction: NDArray[Any], may_refine: bool
    ) -> Move:
        """One step of the line search."""
        return self.watch.run(
            advance,
            self.problem,
            point,
            jnp.asarray(gradient),
            jnp.asarray(direction),
            np.asarray(may_refine and self.discretisation.can_refine),
        )

    def split(self, refused: NDArray[Any]) -> int:
        """Split the panels that refused a step; 0 when none can be."""
        wanted = self.discretisation.splittable(refused)
        if wanted.any():
            self.discretisation = self.watch.run(self.discretisation.refined, wanted)
            self.problem = self.problem._replace(matrices=self.discretisation.matrices)
        return int(wanted.sum())

    @double_precision
    def take_hessian_samples(self, count: int | None) -> None:
        """Put the Hessian on so many of the uniform samples, ``|H|`` (Figure 8); None changes none.

        Raises
        ------
        OptionError
            When the sampling is another, or there are not so many.
        """
        if count is None:
            return
        panels = len(self.discretisation.panels)
        if self.options.sampling != "uniform":
            raise OptionError("hessian_samples needs sampling='uniform'")
        if not 1 <= count <= panels:
            raise OptionError(f"hessian_samples must be from 1 to {panels}, got {count}")
        index = np.linspace(0, panels, count, endpoint=False).astype(int)
        weights = jnp.full(count, 1 / count)
        matrices = self.problem.matrices._replace(
            hessian_index=jnp.asarray(index), hessian_weights=weights
        )
        self.problem = self.problem._replace(matrices=matrices)
