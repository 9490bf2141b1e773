"""JAX, imported on first use.

An editor shows its canvas before JAX is imported. Modules import ``jax``, ``jnp``, ``lax`` from
here. At module level they use :func:`jit` instead of ``jax.jit``, and :func:`once_loaded` for other
calls.
"""

import functools
import importlib
import os
import sys
import threading
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, version
from types import ModuleType
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias

import numpy as np

from glid_nb._errors import IncompatibleVersionsError, InputError

AnyArray: TypeAlias = "jax.Array | np.ndarray[Any, Any]"
"""An array on the device or on the host. Compiled programs accept both."""

_forked = False  # whether this process was forked from one that had run JAX


class ForkError(InputError):
    """JAX is used in a process in which it cannot run."""


def _note_fork() -> None:
    """Threads do not survive a fork, but JAX would wait for its threads forever."""
    global _forked, _lock
    _lock = threading.RLock()  # a thread that no longer exists may have held the lock
    if (bridge := sys.modules.get("jax._src.xla_bridge")) is not None:
        ran = getattr(bridge, "backends_are_initialized", None)
        _forked = _forked or ran is None or bool(ran())


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_note_fork)


def check_fork() -> None:
    """Raise a :class:`ForkError` if JAX would hang."""
    if _forked:
        what = "this process was forked from one that had run JAX, so JAX would wait here for ever"
        remedy = 'multiprocessing.get_context("spawn") or "forkserver"'
        raise ForkError(f"{what}; start processes with {remedy}")


_lock = threading.RLock()
_waiting: list[Callable[[], Any]] = []
_settling = False


def once_loaded(action: Callable[[], Any]) -> None:
    """Call ``action`` once JAX is imported, before the package computes anything."""
    _waiting.append(action)
    settle()


def settle(waits: bool = False) -> None:
    """Run the pending actions if JAX is imported. If not, the thread that imports it runs them."""
    global _settling
    if not _waiting or "jax" not in sys.modules or not _lock.acquire(blocking=waits):
        return
    nested, _settling = _settling, True  # nested: called by a pending action
    try:
        while _waiting and not nested:
            _waiting[0]()
            del _waiting[0]  # after the call, because other threads must wait until it has run
    finally:
        _settling = nested
        _lock.release()


def installed(*names: str) -> str:
    """Versions of distributions as text, such as ``jax 0.10.2, jaxlib missing``."""

    def told(name: str) -> str:
        try:
            return f"{name} {version(name)}"
        except PackageNotFoundError:
            return f"{name} missing"

    return ", ".join(map(told, names))


def incompatible(problem: str) -> IncompatibleVersionsError:
    """An error that names the versions. ``problem`` continues a sentence that begins "glid-nb"."""
    libraries = installed("jax", "jaxlib", "numpy", "scipy", "ml_dtypes")
    return IncompatibleVersionsError(
        f"glid-nb {problem}. Installed are {libraries}; install versions that belong together: "
        "pip install --upgrade glid-nb jax jaxlib"
    )


def import_jax(name: str) -> ModuleType:
    """The module ``name`` of JAX. Raises an IncompatibleVersionsError if it cannot be imported."""
    try:
        importlib.import_module("jax")
        return importlib.import_module(name)
    except Exception as error:  # JAX and its dependencies raise many kinds of errors
        reason = " ".join(str(error).split())
        raise incompatible(f"cannot import {name} ({type(error).__name__}: {reason})") from error


class CompiledOnUse:
    """``jax.jit(function, **options())``, made on the first call."""

    def __init__(self, function: Callable[..., Any], options: Callable[[], dict[str, Any]]) -> None:
        functools.update_wrapper(self, function)
        self._options = options

    @functools.cached_property
    def _program(self) -> Any:
        return jax.jit(self.__wrapped__, **self._options())  # type: ignore[attr-defined]

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        return self._program(*args, **kwargs)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):  # doctest and others probe for optional attributes
            raise AttributeError(name)
        return getattr(self._program, name)


if TYPE_CHECKING:
    import jax
    import jax.numpy as jnp
    from jax import Array, jit, lax
    from jaxtyping import Bool, Complex, Float, Int
else:
    # Nothing evaluates the shapes in annotations, and importing jaxtyping takes 0.1 s.
    Array, Bool, Complex, Float, Int = Any, Annotated, Annotated, Annotated, Annotated

    class _Module:
        def __init__(self, name: str) -> None:
            self._name = name
            self._module: ModuleType | None = None

        def __getattr__(self, name: str) -> Any:
            if _forked:
                check_fork()
            if self._module is None:
                with _lock:  # otherwise parallel imports find parts of JAX half initialised
                    self._module = import_jax(self._name)
            settle(waits=True)
            try:
                return getattr(self._module, name)
            except AttributeError:
                raise incompatible(f"needs {self._name}.{name}") from None

    def jit(function: Callable[..., Any], **options: Any) -> Callable[..., Any]:
        return CompiledOnUse(function, lambda: options)

    jax, jnp, lax = _Module("jax"), _Module("jax.numpy"), _Module("jax.lax")
