"""What the installed libraries can do that other versions of them cannot.

Every request that a library may refuse in another version is made here, once, and has an answer for
the versions that refuse it. The package then works without that feature, only slower.
"""

import functools
import importlib
import platform
import re
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any

import numpy as np
from threadpoolctl import OpenBLASController

from glid_nb._jax import Array, CompiledOnUse, import_jax, incompatible, jax, lax

_WANTED_OPTIONS: dict[str, Any] = {
    # For programs with many small fusions: XLA's older CPU emitters compile them 1.6 times faster.
    # JAX 0.11 and later no longer have them.
    "xla_cpu_use_fusion_emitters": False,
}

FACTORISE, SOLVE = "lapack_dpotrf_ffi", "lapack_dtrsm_ffi"
"""The names under which JAX on a CPU knows LAPACK's Cholesky factorisation and triangular solve."""
# Patterns of JAX's own calls in the versions whose way of calling LAPACK we know: one matrix is
# factorised; a factor and right-hand sides are solved (older versions give a third argument).
_KNOWN_CALLS = (
    rf"@{FACTORISE}\(%\w+\) .*\{{uplo = 76 : ui8\}}",
    rf"@{SOLVE}\(%\w+, %\w+\) .*"
    r"\{diag = 78 : ui8, side = 76 : ui8, trans_x = 84 : ui8, uplo = 76 : ui8\}",
)


def enable_x64(enabled: bool = True) -> AbstractContextManager[None]:
    """``jax.enable_x64``, a context in which JAX computes in double precision.

    JAX before 0.8 has it in ``jax.experimental``.
    """
    return _enable_x64()(enabled)


@functools.cache
def _enable_x64() -> Any:
    for module in ("jax", "jax.experimental"):
        if (found := getattr(import_jax(module), "enable_x64", None)) is not None:
            return found
    raise incompatible("needs jax.enable_x64")


def is_traced(value: Any) -> bool:
    """Whether JAX traces a value, which then has no numbers yet."""
    return isinstance(value, import_jax("jax.core").Tracer)


@functools.cache
def compiler_options() -> dict[str, Any]:
    """The options of XLA that we would like to set, less those that this version does not know."""
    return {name: value for name, value in _WANTED_OPTIONS.items() if _is_known(name, value)}


def unknown_options() -> list[str]:
    """The options of XLA that we would like to set and this version does not know."""
    return sorted(set(_WANTED_OPTIONS) - set(compiler_options()))


def _is_known(option: str, value: Any) -> bool:
    try:
        jax.jit(lambda x: x, compiler_options={option: value}).lower(0).compile()
    except Exception as error:  # its class differs between versions of JAX
        if option in str(error):
            return False
        raise
    return True


def solver_jit(function: Callable[..., Any], **options: Any) -> Callable[..., Any]:
    """``jax.jit`` for the solver's programs: with :func:`compiler_options`, on first use."""
    return CompiledOnUse(function, lambda: {**options, "compiler_options": compiler_options()})


@functools.cache
def lapack_in_place() -> bool:
    """Whether this JAX calls LAPACK as ``solvers.cholesky`` does.

    JAX's own calls are read from lowered text, which also makes LAPACK ready to be called. Where
    they look otherwise, or nothing is known of them, ``jax.lax.linalg`` does the work.
    """

    def both(h: Array, b: Array) -> Array:
        lower = lax.linalg.cholesky(h, symmetrize_input=False)
        return lax.linalg.triangular_solve(lower, b, left_side=True, lower=True, transpose_a=True)

    if not hasattr(jax, "ffi"):
        return False
    with enable_x64():
        shapes = jax.ShapeDtypeStruct((2, 2), np.float64), jax.ShapeDtypeStruct((2, 1), np.float64)
        text = jax.jit(both).trace(*shapes).lower(lowering_platforms=("cpu",)).as_text()
    return all(re.search(call, text) for call in _KNOWN_CALLS)


def release_blas() -> None:
    """Let any thread set the number of BLAS threads next.

    threadpoolctl from 3.8 on binds control of OpenBLAS to one Python thread; before, none is bound.
    """
    release = getattr(OpenBLASController, "clear_controlling_thread", None)
    if release is not None:
        release(force=True)


@functools.cache
def executables() -> Any | None:
    """The module of JAX that writes compiled programs as bytes; None where it has none."""
    try:
        module = importlib.import_module("jax.experimental.serialize_executable")
    except ImportError:
        return None
    return module if hasattr(module, "serialize") else None


@functools.cache
def processor() -> str:
    """What tells processors apart whose compiled programs differ, as far as NumPy knows it."""
    # NumPy's table has no public name.
    umath = getattr(getattr(np, "_core", None), "_multiarray_umath", None)
    features: dict[str, bool] = getattr(umath, "__cpu_features__", {})
    names = sorted(name for name, has in features.items() if has)
    return " ".join([platform.system(), platform.machine(), platform.processor(), *names])
