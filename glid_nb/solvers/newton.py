"""Newton's method on the device: one compiled call runs several iterations (paper Algorithm 1)."""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from glid_nb._arrays import AnyArray
from glid_nb._runtime import COMPILER_OPTIONS
from glid_nb.certificate import EndValues, PanelBounds, hermite, lipschitz
from glid_nb.energies import Differentials, Energy
from glid_nb.harmonic.cauchy import Singularities, slope_jumps
from glid_nb.solvers import line_search
from glid_nb.solvers.discretisation import CertificateKind, Matrices
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


class Constraints(NamedTuple):
    """Handles and targets, padded to a bucket (paper Section 6.1, Appendix F)."""

    handles: Float[AnyArray, "h 2c"]
    """``C`` at the handles as ``[Re C, -Im C]``."""
    targets: Float[AnyArray, "h 2"]
    weights: Float[AnyArray, " h"]
    """``lambda`` for a handle, 0 for padding."""


class Samples(NamedTuple):
    """``f_z`` and ``conj(f_zbar)`` as rows (Re, Im, Re, Im), and their derivatives."""

    nodes: Float[Array, "4 p+q"]
    slopes: Float[Array, "4 p"]
    hessian: Float[Array, "4 h"]


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
    p2p_matrix = _constraint_matrix(constraints)
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
        x, yy = _squares(samples.hessian)
        f, g = _directions(samples.hessian)
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
        x, yy = _squares(nodes)
        d = energy.differentials(x, yy)
        residual = p2p_matrix @ y - constraints.targets.T.ravel()
        gradient = _energy_gradient(matrices, nodes, d) + p2p_matrix.T @ (row_weights * residual)
        gradient = restrict_gradient(gradient, unknowns)

        lower, modified = factor(state.samples)
        definite = jnp.isfinite(lower[-1, -1])
        direction = -jax.scipy.linalg.cho_solve((lower, True), gradient)
        direction = expand(jnp.where(definite, direction, 0), unknowns)
        squared_decrement = -jnp.dot(gradient, direction)

        change = _products(matrices, direction)
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
            return bounds(matrices, singularities, y + t * direction, moved, certificate)

        outcome, t, panel, refused = line_search.backtrack(
            search, certified, _turning(matrices, nodes), matrices.real, settings.may_refine
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

    samples = _products(matrices, coefficients)
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


def bounds(
    matrices: Matrices,
    singularities: Singularities,
    coefficients: Float[Array, " 4c"],
    samples: Samples,
    certificate: CertificateKind,
) -> PanelBounds:
    """The certificate's bounds on every panel."""
    phi, psi = _complex_pair(coefficients)
    jumps = jnp.abs(slope_jumps(jnp.stack([phi, psi]), singularities))
    largest = jnp.maximum(jnp.abs(phi).max(), jnp.abs(psi).max())
    remainder = jumps @ matrices.remainder + matrices.rounding * largest
    chord = lax.complex(*matrices.chord)
    panels = chord.shape[0]
    f, g = _complex_rows(samples.nodes[:, :panels])
    df, dg = _complex_rows(samples.slopes)
    after = matrices.next
    values = EndValues(
        f, f[after], g, g[after], df * chord, df[after] * chord, dg * chord, dg[after] * chord
    )
    method = hermite if certificate == "hermite" else lipschitz
    return method.panel_bounds(values, remainder[0], remainder[1])


def _turning(matrices: Matrices, nodes: Float[Array, "4 s"]) -> Float[Array, " p"]:
    """Principal ``Arg`` of the quotient of ``f_z`` at the ends of each panel."""
    start = nodes[:2, : matrices.real.shape[0]]
    end = start[:, matrices.next]
    cross = start[0] * end[1] - start[1] * end[0]
    return jnp.arctan2(cross, jnp.sum(start * end, axis=0))


def _products(matrices: Matrices, y: Float[Array, " 4c"]) -> Samples:
    """``f_z``, ``conj(f_zbar)`` and their derivatives on the panels (G.6), one product each."""
    c = y.shape[0] // 4
    rows = []
    for first in (0, 2 * c):
        re, im = y[first : first + c], y[first + c : first + 2 * c]
        rows += [jnp.concatenate([re, im]), jnp.concatenate([im, -re])]
    y4 = jnp.stack(rows)
    return Samples(y4 @ matrices.nodes, y4 @ matrices.slopes, y4 @ matrices.hessian_nodes)


def _energy_gradient(
    matrices: Matrices, nodes: Float[Array, "4 s"], d: Differentials
) -> Float[Array, " 4c"]:
    """Gradient of the isometric energy, (G.7) with the last block's sign corrected."""
    w1, w2 = 2 * matrices.weights * d.alpha1, 2 * matrices.weights * d.alpha2
    m = matrices.nodes @ (nodes * jnp.stack([w1, w1, w2, w2])).T
    c = m.shape[0] // 2
    re, im = m[:c].T, m[c:].T
    # D^H v = (Re D^T - i Im D^T) v with the stored halves Re D and -Im D.
    return jnp.concatenate([re[0] - im[1], re[1] + im[0], re[2] - im[3], re[3] + im[2]])


def _constraint_matrix(constraints: Constraints) -> Float[Array, "2h 4c"]:
    """The matrix of (F.5): first all rows for the real parts, then those for the imaginary."""
    c = constraints.handles.shape[1] // 2
    re, minus_im = constraints.handles[:, :c], constraints.handles[:, c:]
    return jnp.block([[re, minus_im, re, minus_im], [-minus_im, re, minus_im, -re]])


def _squares(nodes: Float[Array, "4 s"]) -> tuple[Array, Array]:
    return nodes[0] ** 2 + nodes[1] ** 2, nodes[2] ** 2 + nodes[3] ** 2


def _directions(nodes: Float[Array, "4 s"]) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Unit vectors along both derivatives; (1, 0) where one vanishes."""
    pairs = []
    for k in (0, 2):
        modulus = jnp.hypot(nodes[k], nodes[k + 1])
        vanishes = modulus == 0
        safe = jnp.where(vanishes, 1, modulus)
        pairs.append((jnp.where(vanishes, 1, nodes[k] / safe), nodes[k + 1] / safe))
    return pairs[0], pairs[1]


def _complex_pair(y: Float[Array, " 4c"]) -> tuple[Array, Array]:
    c = y.shape[0] // 4
    return lax.complex(y[:c], y[c : 2 * c]), lax.complex(y[2 * c : 3 * c], y[3 * c :])


def _complex_rows(a: Float[Array, "4 s"]) -> tuple[Array, Array]:
    return lax.complex(a[0], a[1]), lax.complex(a[2], a[3])
