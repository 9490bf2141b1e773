"""The Cholesky factorisation of the Hessian, and the solves with it.

XLA stores matrices by rows and LAPACK by columns, so ``jax.lax.linalg`` copies every matrix twice.
The copies take longer than the factorisation. Here LAPACK gets the memory as it is, because the
upper half by rows is the lower half by columns. ``jax.lax.linalg`` does the work on other
platforms, and with a JAX version that calls LAPACK differently.
"""

from collections.abc import Callable

import numpy as np

from glid_nb._features import FACTORISE, SOLVE, lapack_in_place
from glid_nb._jax import Array, Float, jax, jnp, lax

_VMAP = "broadcast_all"
_L, _N, _T = np.frombuffer(b"LNT", np.uint8)  # LAPACK's letters


def factorise(h: Float[Array, "n n"]) -> Float[Array, "n n"]:
    """The Cholesky factor of a symmetric matrix, to solve (1) with. Reads the upper half only.

    If the matrix is not positive definite, the last element is NaN.
    """
    return _by_platform(
        _lapack_factor, lambda h: lax.linalg.cholesky(h.T, symmetrize_input=False), h
    )


def solve(factor: Float[Array, "n n"], b: Float[Array, " n"]) -> Float[Array, " n"]:
    """Solve a linear system such as (1) with the factor of its matrix."""
    return _by_platform(
        _lapack_solve, lambda factor, b: jax.scipy.linalg.cho_solve((factor, True), b), factor, b
    )


def _by_platform(lapack: Callable, portable: Callable, *arguments: Array) -> Array:
    if not lapack_in_place():
        return portable(*arguments)
    return lax.platform_dependent(*arguments, cpu=lapack, default=portable)


def _lapack_factor(h: Float[Array, "n n"]) -> Float[Array, "n n"]:
    outputs = jax.ShapeDtypeStruct(h.shape, h.dtype), jax.ShapeDtypeStruct((), np.int32)
    call = jax.ffi.ffi_call(FACTORISE, outputs, input_output_aliases={0: 0}, vmap_method=_VMAP)
    factor, info = call(h, uplo=_L)
    return factor.at[-1, -1].set(jnp.where(info == 0, factor[-1, -1], jnp.nan))


def _lapack_solve(factor: Float[Array, "n n"], b: Float[Array, " n"]) -> Float[Array, " n"]:
    column = b[:, None]
    output = jax.ShapeDtypeStruct(column.shape, column.dtype)
    call = jax.ffi.ffi_call(SOLVE, output, input_output_aliases={1: 0}, vmap_method=_VMAP)
    for transposed in (_N, _T):
        column = call(factor, column, trans_x=transposed, side=_L, uplo=_L, diag=_N)
    return column[:, 0]
