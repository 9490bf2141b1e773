"""How the package runs JAX: full precision, one BLAS thread, a persistent compilation cache.

Importing the package changes no JAX configuration. Entry points that compute are decorated with
:func:`double_precision`, which leaves the user's configuration alone.
"""

import functools
import os
import sys
import tempfile
import threading
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, nullcontext
from contextvars import ContextVar
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import ThreadpoolController

from glid_nb._cache_folder import can_write
from glid_nb._features import enable_x64, release_blas
from glid_nb._jax import check_fork, jax

P = ParamSpec("P")
R = TypeVar("R")

CHUNK_ELEMENTS = 1 << 15

_watcher: ContextVar[Callable[[str], None] | None] = ContextVar("watcher", default=None)

_lock = threading.Lock()
_depth = 0
_limiter: Any = None


def _unlock() -> None:
    """Replace the lock in a forked process: a thread that no longer exists may have held it."""
    global _lock
    _lock = threading.Lock()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_unlock)


@contextmanager
def watched(by: Callable[[str], None]) -> Iterator[None]:
    """Call ``by`` with the name of every stage that begins inside the context. An exception of
    ``by`` ends the work."""
    token = _watcher.set(by)
    try:
        yield
    finally:
        _watcher.reset(token)


def stage(name: str) -> None:
    """Tell the watcher of this thread, if any, that a stage of the work begins."""
    if (by := _watcher.get()) is not None:
        by(name)


@contextmanager
def single_blas_thread() -> Iterator[None]:
    """Limit BLAS to one thread while solver calls run.

    XLA runs Cholesky on SciPy's BLAS, whose threads compete with XLA's own threads. A 384 x 384
    factorisation took up to 240 ms instead of 1 ms. The whole process shares one limiter.
    """
    global _depth, _limiter
    with _lock:
        if _depth == 0:
            # Another thread may lift the limit, so control is released after each change.
            release_blas()
            _limiter = _controller().limit(limits=1, user_api="blas")
            release_blas()
        _depth += 1
    try:
        yield
    finally:
        with _lock:
            _depth -= 1
            if _depth == 0:
                _limiter.restore_original_limits()
                release_blas()


@functools.cache
def _controller() -> ThreadpoolController:
    import scipy.linalg  # noqa: F401, PLC0415 - loads the BLAS that XLA calls

    return ThreadpoolController()


def blas_libraries() -> list[str]:
    """The BLAS libraries of this process, for example ``openblas 0.3.30, 2 threads``."""
    found = [one for one in _controller().info() if one["user_api"] == "blas"]
    return [f"{b['internal_api']} {b['version']}, {b['num_threads']} threads" for b in found]


def double_precision(function: Callable[P, R]) -> Callable[P, R]:
    """Run ``function`` with 64-bit JAX types and matrix products in full precision.

    This is independent of the caller's JAX configuration and does not change it. By default, a GPU
    multiplies single precision matrices in TF32, which has 10 bits. With
    ``jax_default_matmul_precision`` a caller may also have reduced the precision of double
    precision products. The certificate does not allow for this.
    """

    @functools.wraps(function)
    def wrapped(*args: P.args, **kwargs: P.kwargs) -> R:
        check_fork()
        with enable_x64(), jax.default_matmul_precision("highest"):
            return function(*args, **kwargs)

    return wrapped


def in_chunks(
    program: Callable[..., R], n_columns: int, rows: Sequence[NDArray[Any]], *fixed: Any
) -> R:
    """``program(*rows, *fixed)``, in chunks of rows whose matrices fit in the processor's cache.

    The matrices have ``n_columns``. ``program`` returns a pytree of NumPy arrays with one row for
    each given row; there may be no rows. Overflows and undefined results give no warnings.
    """
    size, parts = max(CHUNK_ELEMENTS // n_columns, 1), []
    # If SciPy's BLAS is not loaded, no solver is running.
    limited = single_blas_thread() if "scipy.linalg" in sys.modules else nullcontext()
    with np.errstate(all="ignore"), limited:
        for first in range(0, max(len(rows[0]), 1), size):
            stage("rows")
            parts.append(program(*(a[first : first + size] for a in rows), *fixed))
    return parts[0] if len(parts) == 1 else _joined(parts)


def _joined(parts: Sequence[Any]) -> Any:
    """Concatenate arrays, or tuples and dicts of them, without importing JAX."""
    first = parts[0]
    if first is None:
        return None
    if isinstance(first, dict):
        return {key: _joined([part[key] for part in parts]) for key in first}
    if isinstance(first, tuple):
        columns = [_joined(column) for column in zip(*parts, strict=True)]
        return type(first)(*columns) if hasattr(first, "_fields") else tuple(columns)
    return np.concatenate(parts)


def cache_directory() -> Path:
    """The folder for compiled programs: ``$GLID_NB_CACHE``, else the user's cache directory."""
    return _directory("GLID_NB_CACHE", "XDG_CACHE_HOME", ".cache")


def data_directory() -> Path:
    """The folder for kept work: ``$GLID_NB_DATA``, else the user's data directory."""
    return _directory("GLID_NB_DATA", "XDG_DATA_HOME", ".local/share")


def _directory(own: str, common: str, usual: str) -> Path:
    if named := os.environ.get(own):
        return Path(named)
    if not (base := os.environ.get(common)):
        try:
            base = Path.home() / usual
        except RuntimeError:  # a user without a name and a home directory, as in containers
            return Path(tempfile.gettempdir()) / f"glid_nb-{os.getuid()}"
    return Path(base) / "glid_nb"


def jax_option(name: str) -> Any:
    """The value of an option of JAX. Type checkers do not know these options."""
    return getattr(jax.config, name)


def default_device() -> Any:
    """The device on which JAX computes. JAX's option may also name only a platform."""
    chosen = jax_option("jax_default_device")
    if chosen is None or isinstance(chosen, str):
        return jax.local_devices(backend=chosen)[0]
    return chosen


def enable_compilation_cache() -> Path | None:
    """Keep compiled programs in :func:`cache_directory` between processes. Returns the folder.

    JAX has one such setting per process. So the command line and the editor call this, but
    importing the package and ``solve`` do not. A folder that the user configured before stays in
    use. If the folder cannot be written to, one warning says so, and the result is None.
    """
    if configured := jax_option("jax_compilation_cache_dir"):
        return Path(configured)
    folder = cache_directory() / "compiled"
    if not can_write(folder):
        return None
    jax.config.update("jax_compilation_cache_dir", str(folder))
    # Keep small programs too: reading them all takes a quarter of the time of compiling them.
    jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)
    # If the folder fails later, our own warning is enough.
    warnings.filterwarnings("ignore", "Error (reading|writing) persistent compilation cache entry")
    return folder


_STAGES = ("jaxpr_trace", "jaxpr_to_mlir_module", "backend_compile")
_COMPILING = tuple(f"/jax/core/compile/{stage}_duration" for stage in _STAGES)


class CompilationClock:
    """Counts the programs that JAX compiles or loads, and the seconds of tracing, lowering and
    compiling."""

    programs, seconds = 0, 0.0

    def __init__(self) -> None:
        jax.monitoring.register_event_duration_secs_listener(self._listen)

    def _listen(self, event: str, duration_secs: float, **_: str | int) -> None:
        if event in _COMPILING:
            self.seconds += duration_secs
            self.programs += event == _COMPILING[-1]


compilation_clock = functools.cache(CompilationClock)  # one clock per process
