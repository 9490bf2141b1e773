"""Newton's method on the device: one compiled call runs several iterations (paper Algorithm 1)."""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from glid_nb._arrays import AnyArray
from glid_nb._runtime import COMPILER_OPTIONS
from glid_nb.certificate import PanelBounds
from glid_nb.energies import Energy
from glid_nb.harmonic.cauchy import Singularities
from glid_nb.solvers import evaluation, line_search
from glid_nb.solvers.discretisation import CertificateKind, Matrices
from glid_nb.solvers.evaluation import Constraints, Samples
from glid_nb.solvers.hessian import (
    LocalHessian,
    assemble,
    assemble_across_f,
    local_hessian,
    positive_part,
)
from glid_nb.solvers.options import HessianKind
from glid_nb.solvers.outcome import CONVERGED, INDEFINITE, RUNNING
from glid_nb.solvers.unknowns import Unknowns, expand, restrict_gradient, restrict_hessian


class Record(NamedTuple):
    """History of one iteration, the state after its step."""

    energy_iso: Float[AnyArray, ""]
    energy_p2p: Float[AnyArray, ""]
    step: Float[AnyArray, ""]
    decrement: Float[AnyArray, ""]
    sigma2_lower: Float[AnyArray, ""]
    modified: Bool[AnyArray, ""]


class State(NamedTuple):
    """State of the loop."""

    coefficients: Float[Array, " 4c"]
    samples: Samples
    energy_iso: Float[Array, ""]
    energy_p2p: Float[Array, ""]
    start_energy: Float[Array, ""]
    """Total energy before the first iteration of this call."""
    iteration: Int[Array, ""]
    outcome: Int[Array, ""]
    decrement: Float[Array, ""]
    records: Record
    refused: Bool[Array, " p"]
    """Panels that refused the last preferred step."""
    sigma2_lower: Float[Array, " p"]
    """Certified bound per panel at ``coefficients``, once a step was taken."""


class Settings(NamedTuple):
    """Numbers that may change without compiling again."""

    tolerance: Float[AnyArray, ""]
    iterations: Int[AnyArray, ""]
    may_refine: Bool[AnyArray, ""]
    """Whether to return as soon as a panel refuses a step, so that it can be split."""
    ridge: Float[AnyArray, ""]
    """Added to the Hessian's diagonal, relative to its mean (Section 9.1's epsilon)."""


def iterations(
    matrices: Matrices,
    singularities: Singularities,
    unknowns: Unknowns,
    constraints: Constraints,
    energy: Energy,
    coefficients: Float[Array, " 4c"],
    settings: Settings,
    *,
    hessian: HessianKind,
    certificate: CertificateKind,
    capacity: int,
) -> State:
    """Up to ``settings.iterations`` (at most ``capacity``) Newton iterations, to be compiled."""
    p2p_matrix = evaluation.constraint_matrix(constraints)
    row_weights = jnp.concatenate([constraints.weights, constraints.weights])
    p2p_hessian = p2p_matrix.T @ (row_weights[:, None] * p2p_matrix)

    def energies(samples: Samples, y: Float[Array, " 4c"]) -> tuple[Array, Array]:
        residual = p2p_matrix @ y - constraints.targets.T.ravel()
        return (
            line_search.isometric_energy(samples.nodes, matrices.weights, energy),
            0.5 * jnp.sum(row_weights * residual**2),
        )

    def factor(samples: Samples) -> tuple[Float[Array, "4c 4c"], Bool[Array, ""]]:
        """Cholesky factor of the Hessian, NaN where that fails, and whether ``K`` was projected."""
        x, yy = evaluation.squares(samples.hessian)
        f, g = evaluation.directions(samples.hessian)
        local = local_hessian(energy.differentials(x, yy), x, yy)
        projected = positive_part(local)

        def assembled(k: LocalHessian) -> Float[Array, "4c 4c"]:
            return assemble(matrices.hessian_nodes, matrices.hessian_weights, f, g, k)

        def cholesky(h: Float[Array, "4c 4c"]) -> Float[Array, "4c 4c"]:
            h = restrict_hessian(h + p2p_hessian, unknowns)
            shift = settings.ridge * jnp.mean(jnp.diag(h))
            return lax.linalg.cholesky(h + shift * jnp.eye(h.shape[0]), symmetrize_input=False)

        def project(h: Float[Array, "4c 4c"]) -> Float[Array, "4c 4c"]:
            if not energy.indefinite_across_f_only:
                return assembled(projected)
            across = projected.across_f - local.across_f
            block = assemble_across_f(matrices.hessian_nodes, matrices.hessian_weights, f, across)
            return h.at[: block.shape[0], : block.shape[0]].add(block)

        if hessian == "projected":
            return cholesky(assembled(projected)), jnp.array(True)
        exact = assembled(local)
        lower = cholesky(exact)
        definite = jnp.isfinite(lower[-1, -1])
        if hessian == "exact":
            return lower, jnp.array(False)
        lower = lax.cond(definite, lambda _: lower, lambda h: cholesky(project(h)), exact)
        return lower, ~definite

    def keep_going(state: State) -> Bool[Array, ""]:
        return (state.outcome == RUNNING) & (state.iteration < settings.iterations)

    def iterate(state: State) -> State:
        y, nodes = state.coefficients, state.samples.nodes
        x, yy = evaluation.squares(nodes)
        d = energy.differentials(x, yy)
        residual = p2p_matrix @ y - constraints.targets.T.ravel()
        gradient = evaluation.energy_gradient(matrices, nodes, d)
        gradient = gradient + p2p_matrix.T @ (row_weights * residual)
        gradient = restrict_gradient(gradient, unknowns)

        lower, modified = factor(state.samples)
        definite = jnp.isfinite(lower[-1, -1])
        direction = -jax.scipy.linalg.cho_solve((lower, True), gradient)
        direction = expand(jnp.where(definite, direction, 0), unknowns)
        squared_decrement = -jnp.dot(gradient, direction)

        change = evaluation.products(matrices, direction)
        p2p_change = p2p_matrix @ direction
        total = state.energy_iso + state.energy_p2p
        search = line_search.search(
            nodes,
            change.nodes,
            matrices.weights,
            energy,
            residual,
            p2p_change,
            row_weights,
            total,
            squared_decrement,
        )

        def certified(t: Float[Array, ""]) -> PanelBounds:
            moved = Samples(*(a + t * b for a, b in zip(state.samples, change, strict=True)))
            return evaluation.bounds(matrices, singularities, y + t * direction, moved, certificate)

        turning = evaluation.turning(matrices, nodes)
        outcome, t, panel, refused = line_search.backtrack(
            search, certified, turning, matrices.real, settings.may_refine
        )
        converged = squared_decrement / 2 <= settings.tolerance * jnp.abs(total)
        outcome = jnp.where(converged, CONVERGED, outcome)
        outcome = jnp.where(definite, outcome, INDEFINITE)
        t = jnp.where(outcome == RUNNING, t, 0.0)

        y = y + t * direction
        samples = Samples(*(a + t * b for a, b in zip(state.samples, change, strict=True)))
        iso, p2p = energies(samples, y)
        decrement = jnp.sqrt(jnp.maximum(squared_decrement, 0))
        least = jnp.min(jnp.where(matrices.real, panel.sigma2_lower, jnp.inf))
        record = Record(iso, p2p, t, decrement, least, modified)
        stepped = outcome == RUNNING
        records = jax.tree.map(
            lambda all_, one: all_.at[state.iteration].set(
                jnp.where(stepped, one, all_[state.iteration])
            ),
            state.records,
            record,
        )
        return State(
            y,
            samples,
            iso,
            p2p,
            state.start_energy,
            state.iteration + stepped,
            outcome,
            decrement,
            records,
            refused,
            jnp.where(stepped, panel.sigma2_lower, state.sigma2_lower),
        )

    samples = evaluation.products(matrices, coefficients)
    iso, p2p = energies(samples, coefficients)
    blank = jnp.full(capacity, jnp.nan)
    empty = Record(blank, blank, blank, blank, blank, jnp.zeros(capacity, bool))
    start = State(
        coefficients,
        samples,
        iso,
        p2p,
        iso + p2p,
        jnp.array(0),
        jnp.array(RUNNING),
        jnp.array(jnp.inf),
        empty,
        jnp.zeros_like(matrices.real),
        jnp.full(matrices.real.shape, jnp.nan),
    )
    return lax.while_loop(keep_going, iterate, start)


run = jax.jit(
    iterations,
    static_argnames=("hessian", "certificate", "capacity"),
    compiler_options=COMPILER_OPTIONS,
)
""":func:`iterations` compiled, for one pose."""
