"""The Hessian of the isometric energy and its analytic modification (paper Section 7).

At one sample ``nabla^2 E = B^T K B`` (18). In the orthonormal frame ``f/|f|, i f/|f|`` for ``f_z``
and likewise for ``g = conj(f_zbar)``, the 4 x 4 matrix ``K`` (19) splits into two 1 x 1 blocks,
the eigenvalues ``lambda_1 = 2 alpha_1`` and ``lambda_2 = 2 alpha_2`` across ``f`` and ``g``, and
one symmetric 2 x 2 block along them, whose eigenvalues are ``lambda_3,4`` (23). Written so, the
eigenvectors (24) need no division by ``|f_zbar|`` and a zero of ``f_zbar`` is no special case.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from glid_nb.energies import Differentials

Samples = Float[Array, " h"]


class LocalHessian(NamedTuple):
    """``K`` at each sample in the frames of ``f_z`` and ``conj(f_zbar)``."""

    across_f: Samples
    """``lambda_1``."""
    across_g: Samples
    """``lambda_2``."""
    along_ff: Samples
    along_gg: Samples
    along_fg: Samples


def local_hessian(d: Differentials, x: Samples, y: Samples) -> LocalHessian:
    """``K`` (19), with ``x = |f_z|^2`` and ``y = |f_zbar|^2``."""
    return LocalHessian(
        2 * d.alpha1,
        2 * d.alpha2,
        2 * d.alpha1 + 4 * d.beta1 * x,
        2 * d.alpha2 + 4 * d.beta2 * y,
        4 * d.beta3 * jnp.sqrt(x * y),
    )


def positive_part(k: LocalHessian) -> LocalHessian:
    """``K+``, the closest positive semidefinite matrix to ``K`` (Section 7.1)."""
    mean = (k.along_ff + k.along_gg) / 2
    half = (k.along_ff - k.along_gg) / 2
    # Scaled, for the squares of an exponential energy's entries can overflow.
    scale = jnp.maximum(jnp.abs(half), jnp.abs(k.along_fg))
    safe = jnp.where(scale > 0, scale, 1)
    radius = scale * jnp.sqrt((half / safe) ** 2 + (k.along_fg / safe) ** 2)
    large, small = jnp.maximum(mean + radius, 0), jnp.maximum(mean - radius, 0)
    # K+ of the block is `centre` I + `stretch` (block - mean I), with the clipped eigenvalues.
    centre = (large + small) / 2
    stretch = jnp.where(radius > 0, (large - small) / (2 * jnp.where(radius > 0, radius, 1)), 1.0)
    return LocalHessian(
        jnp.maximum(k.across_f, 0),
        jnp.maximum(k.across_g, 0),
        centre + stretch * half,
        centre - stretch * half,
        stretch * k.along_fg,
    )


def assemble(
    nodes: Float[Array, "h 2c"],
    weights: Samples,
    f: tuple[Samples, Samples],
    g: tuple[Samples, Samples],
    k: LocalHessian,
) -> Float[Array, "4c 4c"]:
    """``sum_i w_i B_i^T K_i B_i`` over the unknowns ``[Re phi, Im phi, Re psi, Im psi]``.

    ``f`` and ``g`` are unit vectors (Re, Im) along ``f_z`` and ``conj(f_zbar)``; any direction
    serves where a derivative vanishes.
    """
    columns = nodes.shape[1] // 2
    re, im = nodes[:, :columns], -nodes[:, columns:]
    phi_phi, u_f, v_f = _diagonal_block(re, im, f, weights * k.along_ff, weights * k.across_f)
    psi_psi, u_g, v_g = _diagonal_block(re, im, g, weights * k.along_gg, weights * k.across_g)
    cross = (weights * k.along_fg)[:, None]
    along_f = jnp.concatenate([u_f, -v_f], axis=1)
    along_g = jnp.concatenate([u_g, -v_g], axis=1)
    phi_psi = along_f.T @ (cross * along_g)
    return jnp.block([[phi_phi, phi_psi], [phi_psi.T, psi_psi]])


def _diagonal_block(
    re: Float[Array, "h c"],
    im: Float[Array, "h c"],
    direction: tuple[Samples, Samples],
    along: Samples,
    across: Samples,
) -> tuple[Float[Array, "2c 2c"], Float[Array, "h c"], Float[Array, "h c"]]:
    """One diagonal block of the Hessian, and ``conj(direction) D`` as real and imaginary part."""
    c, s = direction[0][:, None], direction[1][:, None]
    u, v = c * re + s * im, c * im - s * re
    a, b = along[:, None], across[:, None]
    # The component along the direction has the row [u, -v], the one across it [v, u].
    stacked = jnp.concatenate([u, v])
    top = stacked.T @ jnp.concatenate(
        [jnp.concatenate([a * u, b * v]), jnp.concatenate([-a * v, b * u])], axis=1
    )
    columns = re.shape[1]
    corner = jnp.concatenate([v, u]).T @ jnp.concatenate([a * v, b * u])
    block = jnp.block([[top], [top[:, columns:].T, corner]])
    return block, u, v
