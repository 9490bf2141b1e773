"""The Hermite-Bernstein certificate: cubic interpolants with a remainder bound.

On a panel of length ``l`` let ``p`` and ``q`` be the cubic Hermite interpolants of ``f_z`` and
``conj(f_zbar)``, and ``e_f >= |f_z - p|``, ``e_g >= |conj(f_zbar) - q|`` their remainders, at most
``l^4 / 384`` times a bound on the fourth derivative (Peano's kernel of cubic Hermite
interpolation does not change sign, so the bound holds for complex functions too). Then
``|p|^2 - |q|^2`` is a real polynomial of degree 6, whose Bernstein coefficients enclose it.
"""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Complex, Float

from glid_nb.certificate.bounds import EndValues, PanelBounds, turning

DERIVATIVE_ORDER = 4


def remainder_factor(length: Float[Array, " p"]) -> Float[Array, " p"]:
    """``l^4 / 384``: remainder per unit of the bound on the fourth derivative."""
    return length**4 / 384


def panel_bounds(
    values: EndValues,
    remainder_fz: Float[Array, " p"],
    remainder_fzb: Float[Array, " p"],
    pieces: int = 2,
) -> PanelBounds:
    """Bounds that hold on each whole panel.

    ``pieces`` (1, 2 or 4) is how finely the polynomials are subdivided, which tightens the
    enclosure without another evaluation of the map.
    """
    p = _control_points(values.fz_start, values.fz_end, values.dfz_start, values.dfz_end)
    q = _control_points(values.fzb_start, values.fzb_end, values.dfzb_start, values.dfzb_end)
    e_f, e_g = remainder_fz[:, None], remainder_fzb[:, None]

    split = _subdivision(pieces)
    p_pieces = jnp.einsum("sij,pj->psi", split, p)
    q_pieces = jnp.einsum("sij,pj->psi", split, q)
    p_square = _squared_modulus(p_pieces)
    q_square = _squared_modulus(q_pieces)
    p_most = jnp.abs(p_pieces).max(axis=-1)
    q_most = jnp.abs(q_pieces).max(axis=-1)

    # |p| - |q| = (|p|^2 - |q|^2) / (|p| + |q|), the denominator being at most the control points'.
    least = (p_square - q_square).min(axis=-1)
    sigma2 = least / (p_most + q_most) - e_f - e_g
    sigma1 = p_most + q_most + e_f + e_g

    # kappa^2 |p|^2 - |q|^2 >= 0 coefficient by coefficient bounds |q| / |p| by kappa.
    p_least_square = p_square.min(axis=-1)
    p_least = jnp.sqrt(jnp.maximum(p_least_square, 0))
    kappa = jnp.sqrt(jnp.max(jnp.maximum(q_square, 0) / p_square, axis=-1))
    k = (kappa * p_least + e_g) / (p_least - e_f)
    k = jnp.where((p_least_square > 0) & (p_least > e_f), k, jnp.inf)

    # If the control polygon lies in a half plane further than e_f from 0, so does f_z.
    direction = p[:, 0] / jnp.abs(p[:, 0]) + p[:, 3] / jnp.abs(p[:, 3])
    direction = direction / jnp.abs(direction)
    offset = jnp.real(jnp.conj(direction)[:, None] * p).min(axis=-1)
    return PanelBounds(
        jnp.nan_to_num(sigma2.min(axis=-1), nan=-jnp.inf),
        sigma1.max(axis=-1),
        k.max(axis=-1),
        offset > remainder_fz,
        turning(values),
    )


def _control_points(
    start: Complex[Array, " p"],
    end: Complex[Array, " p"],
    slope_start: Complex[Array, " p"],
    slope_end: Complex[Array, " p"],
) -> Complex[Array, "p 4"]:
    return jnp.stack([start, start + slope_start / 3, end - slope_end / 3, end], axis=-1)


def _squared_modulus(c: Complex[Array, "... 4"]) -> Float[Array, "... 7"]:
    """Bernstein coefficients of degree 6 of ``|cubic|^2``."""

    def dot(i: int, j: int) -> Float[Array, ...]:
        a, b = c[..., i], c[..., j]
        return jnp.real(a) * jnp.real(b) + jnp.imag(a) * jnp.imag(b)

    return jnp.stack(
        [
            dot(0, 0),
            dot(0, 1),
            (2 * dot(0, 2) + 3 * dot(1, 1)) / 5,
            (dot(0, 3) + 9 * dot(1, 2)) / 10,
            (2 * dot(1, 3) + 3 * dot(2, 2)) / 5,
            dot(2, 3),
            dot(3, 3),
        ],
        axis=-1,
    )


def _subdivision(pieces: int) -> Float[np.ndarray, "s 4 4"]:
    """De Casteljau's subdivision of a cubic's control points into equal pieces."""
    left = np.array([[8, 0, 0, 0], [4, 4, 0, 0], [2, 4, 2, 0], [1, 3, 3, 1]]) / 8
    right = left[::-1, ::-1]
    matrices = [np.eye(4)]
    while len(matrices) < pieces:
        matrices = [half @ m for m in matrices for half in (left, right)]
    return np.stack(matrices)
