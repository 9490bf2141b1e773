"""Features of the installed libraries that other versions of them lack.

All calls that another version of a library may refuse are here. Each has a fallback for the
versions that refuse it. The package then works without the feature, only slower.
"""

import copyreg
import functools
import importlib
import platform
import re
import sys
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any

import numpy as np
from threadpoolctl import OpenBLASController

from glid_nb._jax import Array, CompiledOnUse, import_jax, incompatible, jax, lax

WANTED_OPTIONS: dict[str, Any] = {
    # XLA's older CPU emitters compile programs with many small fusions 1.6 times faster. JAX 0.11
    # and later no longer have them.
    "xla_cpu_use_fusion_emitters": False,
}

FACTORISE, SOLVE = "lapack_dpotrf_ffi", "lapack_dtrsm_ffi"
"""JAX's names, on a CPU, of LAPACK's Cholesky factorisation and triangular solve."""
# Patterns of JAX's own calls of LAPACK, in the versions whose calls we know. The factorisation has
# one matrix. The solve has a factor and right-hand sides; older versions have a third argument.
KNOWN_CALLS = (
    rf"@{FACTORISE}\(%\w+\) .*\{{uplo = 76 : ui8\}}",
    rf"@{SOLVE}\(%\w+, %\w+\) .*"
    r"\{diag = 78 : ui8, side = 76 : ui8, trans_x = 84 : ui8, uplo = 76 : ui8\}",
)


def enable_x64(enabled: bool = True) -> AbstractContextManager[None]:
    """``jax.enable_x64``, a context in which JAX computes in double precision.

    Before JAX 0.8 it is in ``jax.experimental``.
    """
    return x64_context()(enabled)


@functools.cache
def x64_context() -> Any:
    """JAX's own function behind :func:`enable_x64`."""
    for module in ("jax", "jax.experimental"):
        if (found := getattr(import_jax(module), "enable_x64", None)) is not None:
            return found
    raise incompatible("needs jax.enable_x64")


def is_traced(value: Any) -> bool:
    """Whether a value is a tracer of JAX, which has no numbers yet. Other values need no JAX."""
    of_jax = type(value).__module__.partition(".")[0] == "jax"
    return of_jax and isinstance(value, import_jax("jax.core").Tracer)


@functools.cache
def compiler_options() -> dict[str, Any]:
    """The XLA options that we want to set and that this version knows."""
    return {name: value for name, value in WANTED_OPTIONS.items() if _is_known(name, value)}


def unknown_options() -> list[str]:
    """The XLA options that we want to set but that this version does not know."""
    return sorted(set(WANTED_OPTIONS) - set(compiler_options()))


def _is_known(option: str, value: Any) -> bool:
    try:
        jax.jit(lambda x: x, compiler_options={option: value}).lower(0).compile()
    except Exception as error:  # its class differs between versions of JAX
        if option in str(error):
            return False
        raise
    return True


def solver_jit(function: Callable[..., Any], **options: Any) -> Callable[..., Any]:
    """``jax.jit`` for the solver's programs, with :func:`compiler_options`, on first use."""
    return CompiledOnUse(function, lambda: {**options, "compiler_options": compiler_options()})


@functools.cache
def lapack_in_place() -> bool:
    """Whether this JAX calls LAPACK in the same way as ``solvers.cholesky``.

    JAX's own calls are read from lowered text; the lowering also prepares LAPACK for calls. If the
    calls look different, ``jax.lax.linalg`` does the work.
    """

    def both(h: Array, b: Array) -> Array:
        lower = lax.linalg.cholesky(h, symmetrize_input=False)
        return lax.linalg.triangular_solve(lower, b, left_side=True, lower=True, transpose_a=True)

    if not hasattr(jax, "ffi"):
        return False
    with enable_x64():
        shapes = jax.ShapeDtypeStruct((2, 2), np.float64), jax.ShapeDtypeStruct((2, 1), np.float64)
        text = jax.jit(both).trace(*shapes).lower(lowering_platforms=("cpu",)).as_text()
    return all(re.search(call, text) for call in KNOWN_CALLS)


def release_blas() -> None:
    """Let any thread set the number of BLAS threads next.

    Since version 3.8, threadpoolctl binds the control of OpenBLAS to one Python thread.
    """
    release = getattr(OpenBLASController, "clear_controlling_thread", None)
    if release is not None:
        release(force=True)


@functools.cache
def executables() -> Any | None:
    """The module of JAX that writes compiled programs as bytes; None if this JAX has none."""
    try:
        module = importlib.import_module("jax.experimental.serialize_executable")
    except ImportError:
        return None
    _write_layout_by_name()
    return module if hasattr(module, "serialize") else None


def _write_layout_by_name() -> None:
    """Let pickle write the layout "automatic" by its name.

    Types of arrays hold it since JAX 0.12, and compare it by identity. Read by value it is another
    one: the results of a program that was read had a type of their own, for which all that took
    them was compiled or read again.
    """
    automatic = getattr(jax.typeof(np.float32(0)), "layout", None)
    if automatic is None:
        return
    kind, name = type(automatic), repr(automatic)
    if getattr(sys.modules[kind.__module__], name, None) is automatic:
        copyreg.pickle(kind, repr)


@functools.cache
def processor() -> str:
    """A text that differs between processors that need different compiled programs, as far as NumPy
    knows their features."""
    # NumPy's table of features has no public name.
    umath = getattr(getattr(np, "_core", None), "_multiarray_umath", None)
    features: dict[str, bool] = getattr(umath, "__cpu_features__", {})
    names = sorted(name for name, has in features.items() if has)
    return " ".join([platform.system(), platform.machine(), platform.processor(), *names])
