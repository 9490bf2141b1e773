"""Cholesky's factorisation of the Hessian, and the solves with it.

XLA stores matrices by rows and LAPACK by columns, so ``jax.lax.linalg`` copies every matrix twice,
which takes longer than the factorisation. The upper half by rows is the lower half by columns:
LAPACK gets the same memory. On other platforms, or should a later JAX call LAPACK otherwise,
``jax.lax.linalg`` does the work.
"""

import functools
from collections.abc import Callable

import numpy as np

from glid_nb._jax import Array, Float, jax, jnp, lax

_FACTORISE, _SOLVE = "lapack_dpotrf_ffi", "lapack_dtrsm_ffi"
_VMAP = "broadcast_all"
_L, _N, _T = np.frombuffer(b"LNT", np.uint8)  # LAPACK's letters
# What JAX's own calls must look like for ours to be understood.
_EXPECTED = (
    f"@{_FACTORISE}(",
    "{uplo = 76 : ui8}",
    f"@{_SOLVE}(",
    "{diag = 78 : ui8, side = 76 : ui8, trans_x = 84 : ui8, uplo = 76 : ui8}",
)


def factorise(h: Float[Array, "n n"]) -> Float[Array, "n n"]:
    """The factor of a matrix's upper half, for :func:`solve`; NaN last where it is indefinite."""
    return _by_platform(
        _lapack_factor, lambda h: lax.linalg.cholesky(h.T, symmetrize_input=False), h
    )


def solve(factor: Float[Array, "n n"], b: Float[Array, " n"]) -> Float[Array, " n"]:
    return _by_platform(
        _lapack_solve, lambda factor, b: jax.scipy.linalg.cho_solve((factor, True), b), factor, b
    )


def _by_platform(lapack: Callable, portable: Callable, *arguments: Array) -> Array:
    if not understood():
        return portable(*arguments)
    return lax.platform_dependent(*arguments, cpu=lapack, default=portable)


def _lapack_factor(h: Float[Array, "n n"]) -> Float[Array, "n n"]:
    outputs = jax.ShapeDtypeStruct(h.shape, h.dtype), jax.ShapeDtypeStruct((), np.int32)
    call = jax.ffi.ffi_call(_FACTORISE, outputs, input_output_aliases={0: 0}, vmap_method=_VMAP)
    factor, info = call(h, uplo=_L)
    return factor.at[-1, -1].set(jnp.where(info == 0, factor[-1, -1], jnp.nan))


def _lapack_solve(factor: Float[Array, "n n"], b: Float[Array, " n"]) -> Float[Array, " n"]:
    column = b[:, None]
    output = jax.ShapeDtypeStruct(column.shape, column.dtype)
    call = jax.ffi.ffi_call(_SOLVE, output, input_output_aliases={1: 0}, vmap_method=_VMAP)
    for transposed in (_N, _T):
        column = call(factor, column, trans_x=transposed, side=_L, uplo=_L, diag=_N)
    return column[:, 0]


@functools.cache
def understood() -> bool:
    """Whether this JAX calls LAPACK as we do. To ask also makes LAPACK ready to be called."""

    def both(h: Array, b: Array) -> Array:
        lower = lax.linalg.cholesky(h, symmetrize_input=False)
        return lax.linalg.triangular_solve(lower, b, left_side=True, lower=True, transpose_a=True)

    with jax.enable_x64(True):
        shapes = jax.ShapeDtypeStruct((2, 2), np.float64), jax.ShapeDtypeStruct((2, 1), np.float64)
        text = jax.jit(both).trace(*shapes).lower(lowering_platforms=("cpu",)).as_text()
    return all(part in text for part in _EXPECTED)
