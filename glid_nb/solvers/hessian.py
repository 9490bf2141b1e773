"""The Hessian of the isometric energy and its analytic modification (paper Section 7).

At one sample ``nabla^2 E = B^T K B`` (18). The 4 x 4 matrix ``K`` (19) is written in the frames
``f/|f|, i f/|f|`` of ``f = f_z`` and of ``g = conj(f_zbar)``. There it splits into two eigenvalues
across ``f`` and ``g``, ``lambda_1 = 2 alpha_1`` and ``lambda_2 = 2 alpha_2``, and a symmetric 2 x 2
block along them with the eigenvalues ``lambda_3,4`` (23). So the eigenvectors (24) need no division
by ``|f_zbar|``.
"""

import functools
from collections.abc import Callable
from typing import Any, NamedTuple

from glid_nb._jax import Array, Float, jax, jnp, lax
from glid_nb.energies import Differentials

Columns = Float[Array, "u h"]
Square = Float[Array, "u u"]

PerNode = Float[Array, " h"]
Pair = tuple[Columns, Columns]

# Elements of a basis matrix that are processed at once. Copies of more elements would take more
# memory than the Hessian.
PIECE = 1 << 19


class LocalHessian(NamedTuple):
    """``K`` at each sample in the frames of ``f_z`` and ``conj(f_zbar)``."""

    across_f: PerNode  # lambda_1
    across_g: PerNode  # lambda_2
    along_ff: PerNode
    along_gg: PerNode
    along_fg: PerNode


def local_hessian(d: Differentials, x: PerNode, y: PerNode) -> LocalHessian:
    """``K`` (19), with ``x = |f_z|^2`` and ``y = |f_zbar|^2``."""
    return LocalHessian(
        2 * d.alpha1,
        2 * d.alpha2,
        2 * d.alpha1 + 4 * d.beta1 * x,
        2 * d.alpha2 + 4 * d.beta2 * y,
        4 * d.beta3 * jnp.sqrt(x * y),
    )


def positive_part(k: LocalHessian) -> LocalHessian:
    """``K+`` of (21), the closest positive semidefinite matrix to ``K``, by (23) and (24)."""
    mean = (k.along_ff + k.along_gg) / 2
    half = (k.along_ff - k.along_gg) / 2
    # Scale first: the squares of an exponential energy's entries can overflow.
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


def _in_pieces(assembled: Callable[..., Array]) -> Callable[..., Array]:
    """Compute a sum over samples (the arguments' last axis) in pieces if it needs much memory."""

    @functools.wraps(assembled)
    def summed(*arguments: Any) -> Array:
        nodes, count = arguments[0], arguments[0].shape[1]
        pieces = -(-nodes.size // (2 * PIECE))
        if pieces == 1:
            return assembled(*arguments)
        length = -(-count // pieces)

        def piece(i: Array | int) -> Array:
            # The last piece starts earlier, so that it is as long as the others.
            start = jnp.minimum(i * length, count - length)
            part, weights, *rest = jax.tree.map(
                lambda a: lax.dynamic_slice_in_dim(a, start, length, -1), arguments
            )
            fresh = start + jnp.arange(length) >= i * length
            return assembled(part, jnp.where(fresh, weights, 0), *rest)

        blank = jax.eval_shape(piece, 0)
        zero = jnp.zeros(blank.shape, blank.dtype)
        return lax.fori_loop(0, pieces, lambda i, total: total + piece(i), zero)

    return summed


@_in_pieces
def assemble(
    nodes: Float[Array, "2u h"],
    weights: PerNode,
    f: tuple[PerNode, PerNode],
    g: tuple[PerNode, PerNode],
    k: LocalHessian,
) -> Float[Array, "4u 4u"]:
    """Upper triangle of ``sum_i w_i B_i^T K_i B_i`` over ``[Re phi, Im phi, Re psi, Im psi]``.

    This is (14) as a sum of (18), over the nodes of (33), in the blocks of Appendix E, (E.8) and
    (E.10). The products differ from those of (G.10). The block below the diagonal blocks is zero,
    because the Cholesky factorisation does not read it.

    ``nodes`` is ``D`` as ``[Re D, -Im D]``, transposed. ``f`` and ``g`` are unit vectors (Re, Im)
    along ``f_z`` and ``conj(f_zbar)``; where a derivative vanishes, any unit vector is right.

    The diagonal block of ``K`` for ``phi`` is ``p I + m R``. ``R`` is the reflection about ``f_z``.
    ``p`` is half the sum of the entries along and across ``f_z``, ``m`` half their difference. The
    first term gives the Hermitian matrix ``D^H p D``, the second the complex symmetric matrix
    ``(D')^T m D'`` with ``D' = conj(f) D``. Two real products are enough for each, because only
    their symmetric (or antisymmetric) parts are used.
    """
    columns = nodes.shape[0] // 2
    re, im = nodes[:columns], -nodes[columns:]
    plus = [weights * (k.along_ff + k.across_f) / 2, weights * (k.along_gg + k.across_g) / 2]
    minus = [weights * (k.along_ff - k.across_f) / 2, weights * (k.along_gg - k.across_g) / 2]
    sums, parts = _hermitian_products(re, im, jnp.stack(plus))

    diagonal, along = [], []
    for direction, m, total, part in zip((f, g), minus, sums, parts, strict=True):
        u, v = _rotated(re, im, direction)
        mixed = part + part.T
        a_re, a_im = total - mixed, part - part.T
        s_re, s_im = _symmetric_product(u, v, m)
        # Re(z^H A z + z^T S z) over [Re z, Im z].
        diagonal.append(jnp.block([[a_re + s_re, -a_im - s_im], [a_im - s_im, a_re - s_re]]))
        along.append(jnp.concatenate([u, -v]))
    cross = (weights * k.along_fg * along[0]) @ along[1].T
    return jnp.block([[diagonal[0], cross], [jnp.zeros_like(cross), diagonal[1]]])


@_in_pieces
def assemble_across_f(
    nodes: Float[Array, "2u h"], weights: PerNode, f: tuple[PerNode, PerNode], across: PerNode
) -> Float[Array, "2u 2u"]:
    """The part of :func:`assemble` that depends on ``across_f``; it lies in the block of ``phi``.

    With ``across = max(-lambda_1, 0)``, adding it to the exact Hessian gives (25).
    """
    columns = nodes.shape[0] // 2
    u, v = _rotated(nodes[:columns], -nodes[columns:], f)
    # The component across f has the row [v, u].
    w = weights * across
    corner = (w * u) @ v.T
    return jnp.block([[(w * v) @ v.T, corner.T], [corner, (w * u) @ u.T]])


def _rotated(re: Columns, im: Columns, direction: tuple[PerNode, PerNode]) -> Pair:
    """``conj(direction) D`` as real and imaginary part."""
    c, s = direction
    return c * re + s * im, c * im - s * re


def _hermitian_products(re: Columns, im: Columns, weights: Array) -> tuple[Array, Array]:
    """``(re + im) w (re + im)^T`` and ``re w im^T``, each (2, u, u), for (2, h) weights.

    They give ``(re + i im)^H w (re + i im)``. Its imaginary part is the second product minus its
    transpose. Its real part is the first product minus the second product and its transpose.
    """
    columns = re.shape[0]

    def against(left: Columns, right: Columns) -> Float[Array, "2 u u"]:
        product = left @ jnp.concatenate([weights[0] * right, weights[1] * right]).T
        return jnp.stack([product[:, :columns], product[:, columns:]])

    return against(re + im, re + im), against(re, im)


def _symmetric_product(u: Columns, v: Columns, weights: PerNode) -> tuple[Square, Square]:
    """Real and imaginary part of ``(u + iv) diag(weights) (u + iv)^T``, by two real products."""
    # (u - v) w (u + v)^T differs from u w u^T - v w v^T by an antisymmetric matrix.
    real = (u - v) @ (weights * (u + v)).T
    imaginary = (weights * u) @ v.T
    return (real + real.T) / 2, imaginary + imaginary.T
