"""What a map's coefficients say on the panels: values, energy gradient, certificate.

All methods in the harmonic subspace evaluate maps by these functions.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from glid_nb._arrays import AnyArray
from glid_nb._jax import jnp, lax
from glid_nb.certificate import EndValues, PanelBounds
from glid_nb.energies import Differentials
from glid_nb.harmonic.cauchy import Singularities
from glid_nb.solvers.discretisation import Matrices

if TYPE_CHECKING:
    from jaxtyping import Array, Bool, Float


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


def bounds(
    matrices: Matrices,
    singularities: Singularities,
    coefficients: Float[Array, " 4c"],
    samples: Samples,
    largest: Float[Array, ""],
) -> PanelBounds:
    """The certificate's bounds on every panel.

    ``largest`` is the largest modulus of a coefficient since the samples were computed anew.
    """
    truncation = _truncation(matrices, singularities, coefficients)
    remainder = truncation + matrices.rounding * largest
    chord = lax.complex(*matrices.chord)
    panels = chord.shape[0]
    f, g = _complex_rows(samples.nodes[:, :panels])
    df, dg = _complex_rows(samples.slopes)
    after = matrices.next
    fz = EndValues(f, f[after], df * chord, df[after] * chord)
    fzb_conj = EndValues(g, g[after], dg * chord, dg[after] * chord)
    return matrices.proof.bounds(fz, fzb_conj, remainder)


def tightened_by_splitting(
    matrices: Matrices,
    singularities: Singularities,
    coefficients: Float[Array, " 4c"],
    largest: Float[Array, ""],
) -> Bool[Array, " p"]:
    """Panels whose bounds are loose by more than rounding, which no splitting lessens."""
    truncation = _truncation(matrices, singularities, coefficients)
    return jnp.max(truncation, axis=0) > matrices.rounding * largest


def largest_modulus(coefficients: Float[Array, " 4c"]) -> Float[Array, ""]:
    """The largest modulus of a coefficient."""
    return jnp.maximum(*(jnp.abs(part).max() for part in _complex_pair(coefficients)))


def turning(matrices: Matrices, nodes: Float[Array, "4 s"]) -> Float[Array, " p"]:
    """Principal ``Arg`` of the quotient of ``f_z`` at the ends of each panel."""
    start = nodes[:2, : matrices.real.shape[0]]
    end = start[:, matrices.next]
    cross = start[0] * end[1] - start[1] * end[0]
    return jnp.arctan2(cross, jnp.sum(start * end, axis=0))


def products(matrices: Matrices, y: Float[Array, " 4c"]) -> Samples:
    """``f_z``, ``conj(f_zbar)`` and their derivatives on the panels (G.6), one product each."""
    c = y.shape[0] // 4
    rows = []
    for first in (0, 2 * c):
        re, im = y[first : first + c], y[first + c : first + 2 * c]
        rows += [jnp.concatenate([re, im]), jnp.concatenate([im, -re])]
    y4 = jnp.stack(rows)
    return Samples(y4 @ matrices.nodes, y4 @ matrices.slopes)


def energy_gradient(
    matrices: Matrices, nodes: Float[Array, "4 s"], d: Differentials
) -> Float[Array, " 4c"]:
    """Gradient of the isometric energy, (G.7) with the last block's sign corrected."""
    w1, w2 = 2 * matrices.weights * d.alpha1, 2 * matrices.weights * d.alpha2
    m = matrices.nodes @ (nodes * jnp.stack([w1, w1, w2, w2])).T
    c = m.shape[0] // 2
    re, im = m[:c].T, m[c:].T
    # D^H v = (Re D^T - i Im D^T) v with the stored halves Re D and -Im D.
    return jnp.concatenate([re[0] - im[1], re[1] + im[0], re[2] - im[3], re[3] + im[2]])


def constraint_matrix(constraints: Constraints) -> Float[Array, "2h 4c"]:
    """The matrix of (F.5): first all rows for the real parts, then those for the imaginary."""
    c = constraints.handles.shape[1] // 2
    re, minus_im = constraints.handles[:, :c], constraints.handles[:, c:]
    return jnp.block([[re, minus_im, re, minus_im], [-minus_im, re, minus_im, -re]])


def squares(nodes: Float[Array, "4 s"]) -> tuple[Array, Array]:
    """``|f_z|^2`` and ``|f_zbar|^2``."""
    return nodes[0] ** 2 + nodes[1] ** 2, nodes[2] ** 2 + nodes[3] ** 2


def directions(nodes: Float[Array, "4 s"]) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Unit vectors along both derivatives; (1, 0) where one vanishes."""
    pairs = []
    for k in (0, 2):
        modulus = jnp.hypot(nodes[k], nodes[k + 1])
        vanishes = modulus == 0
        safe = jnp.where(vanishes, 1, modulus)
        pairs.append((jnp.where(vanishes, 1, nodes[k] / safe), nodes[k + 1] / safe))
    return pairs[0], pairs[1]


def _truncation(
    matrices: Matrices, singularities: Singularities, coefficients: Float[Array, " 4c"]
) -> Float[Array, "2 p"]:
    """How far the derivatives of ``phi`` and ``psi`` may be from what their ends say."""
    return matrices.proof.remainder(jnp.stack(_complex_pair(coefficients)), singularities)


def _complex_pair(y: Float[Array, " 4c"]) -> tuple[Array, Array]:
    c = y.shape[0] // 4
    return lax.complex(y[:c], y[c : 2 * c]), lax.complex(y[2 * c : 3 * c], y[3 * c :])


def _complex_rows(a: Float[Array, "4 s"]) -> tuple[Array, Array]:
    return lax.complex(a[0], a[1]), lax.complex(a[2], a[3])
