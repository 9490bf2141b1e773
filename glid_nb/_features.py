"""What the installed libraries can do that other versions of them cannot.

Every request that a library may refuse in another version is made here, once, and has an answer for
the versions that refuse it. The package then works without that feature, only slower.
"""

import functools
from collections.abc import Callable
from typing import Any

from glid_nb._jax import CompiledOnUse, jax

_WANTED_OPTIONS: dict[str, Any] = {
    # For programs with many small fusions: XLA's older CPU emitters compile them 1.6 times faster.
    # JAX 0.11 and later no longer have them.
    "xla_cpu_use_fusion_emitters": False,
}


@functools.cache
def compiler_options() -> dict[str, Any]:
    """The options of XLA that we would like to set, less those that this version does not know."""
    return {name: value for name, value in _WANTED_OPTIONS.items() if _is_known(name, value)}


def _is_known(option: str, value: Any) -> bool:
    try:
        jax.jit(lambda x: x, compiler_options={option: value}).lower(0).compile()
    except jax.errors.JaxRuntimeError as error:
        if option in str(error):
            return False
        raise
    return True


def solver_jit(function: Callable[..., Any], **options: Any) -> Callable[..., Any]:
    """``jax.jit`` for the solver's programs: with :func:`compiler_options`, on first use."""
    return CompiledOnUse(function, lambda: {**options, "compiler_options": compiler_options()})
