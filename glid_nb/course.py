"""Helpers of the course: checks of exercises, sealed maps, and domains.

An exercise is checked by ``with check("exercise 1"): assert ...``.
"""

import importlib.util
import os
import re
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np

from glid_nb._errors import InputError
from glid_nb._features import enable_x64
from glid_nb.geometry import Cage, Domain, as_points
from glid_nb.geometry._loops import subdivided
from glid_nb.harmonic import HarmonicMap

SECONDS = 180.0  # that a check may take, unless it says otherwise
# Names of distributions that differ from the imported name.
_DISTRIBUTIONS = {"igl": "libigl", "glid_check": "glid-check"}
NOT_TRACED = "TracerArrayConversionError"  # JAX's, if NumPy is called while it differentiates
CALL_JNP = "JAX differentiates this function, so call jnp and not np in it, such as jnp.sqrt"
CHECK_HEADING = re.compile(r"^# %% exercise (\d+)\n", re.MULTILINE)  # in a file of checks


class MissingChecksError(InputError):
    """The file with the checks of a chapter does not lie beside the student edition."""


class MissingPackageError(InputError):
    """A chapter cannot run without a package that is not installed."""


def needs(*packages: str, without: str | None = None) -> None:
    """Print a sentence that names the packages (by their import names) that are not installed.

    ``without`` names the parts that the chapter then leaves out. If the chapter cannot run without
    the packages, leave ``without`` out; then a :class:`MissingPackageError` is raised.
    """
    missing = [name for name in packages if importlib.util.find_spec(name) is None]
    if not missing:
        return
    names = " and ".join(_DISTRIBUTIONS.get(name, name) for name in missing)
    which = f"{names}, which {'is' if len(missing) == 1 else 'are'} not installed"
    remedy = "pip install 'glid-nb[course]', and restart the kernel"
    if without is None:
        raise MissingPackageError(f"this chapter needs {which}; run: {remedy}")
    print(f"Without {which}, this chapter leaves out {without}. To see it, run: {remedy}.")


class _TooSlow(KeyboardInterrupt):
    """A check's time is over. The reader's ``except Exception`` does not catch it."""


@contextmanager
def _at_most(seconds: float) -> Iterator[None]:
    """Raise _TooSlow in the block when the time is over.

    Code in C that does not return is not interrupted, and there is no limit outside the main
    thread, because Python handles signals only there.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    over, done = threading.Event(), threading.Event()

    def interrupt() -> None:
        over.set()
        if os.name == "posix":  # this ends waiting calls too
            signal.pthread_kill(main, signal.SIGINT)
        else:
            signal.raise_signal(signal.SIGINT)

    def on_interrupt(number: int, frame: FrameType | None) -> None:
        if done.is_set():
            return
        if over.is_set():
            raise _TooSlow
        if callable(before):
            before(number, frame)

    main = threading.main_thread().ident or 0
    timer = threading.Timer(seconds, interrupt)
    timer.daemon = True
    before = signal.signal(signal.SIGINT, on_interrupt)
    timer.start()
    try:
        yield
    finally:
        done.set()
        timer.cancel()
        timer.join()
        signal.signal(signal.SIGINT, before)


@contextmanager
def check(name: str, seconds: float = SECONDS) -> Iterator[None]:
    """Print whether the assertions of a block hold. All exceptions in the block are caught.

    The block is interrupted after some ``seconds``.

    >>> with check("exercise 1"):
    ...     assert 1 + 1 == 3, "the sum is not 3"
    exercise 1: not yet: the sum is not 3
    """
    failure = None
    try:
        with _at_most(seconds), in_double_precision():
            yield
    except (Exception, _TooSlow) as raised:  # the reader's own code may raise anything
        failure = raised
    report(name, failure, seconds)


def in_double_precision() -> AbstractContextManager[None]:
    """Answers in ``jax.numpy`` compute with 16 digits; JAX's default is 7."""
    return enable_x64() if "jax" in sys.modules else nullcontext()


class Sealed:
    """A map for an answer that must not read its coefficients: it can only be evaluated."""

    def __init__(self, map: HarmonicMap) -> None:
        self._map = map
        self.domain = map.domain
        self.wirtinger = map.wirtinger
        self.wirtinger_derivatives = map.wirtinger_derivatives

    def __call__(self, points: Any) -> Any:
        return self._map(points)


def run_check(path: str | Path, number: int, namespace: dict[str, Any]) -> None:
    """Run the check of an exercise from a file of the student edition (`make student`).

    Raises a :class:`MissingChecksError` if there is no such file.
    """
    try:
        text = Path(path).read_text(encoding="utf-8")
    except FileNotFoundError:
        where = f"The folder {Path(path).parent.name} must lie beside this notebook"
        remedy = "ask your lecturer, or run make student"
        raise MissingChecksError(f"{where}; {remedy}.") from None
    parts = CHECK_HEADING.split(text)
    checks = dict(zip(map(int, parts[1::2]), parts[2::2], strict=True))
    exec(compile(checks[number], str(path), "exec"), namespace)


def report(name: str, failure: BaseException | None, seconds: float) -> None:
    """Print the outcome of a check. `glid-nb grade` puts its own function here."""
    print(f"{name}: {'right' if failure is None else f'not yet: {why(failure, seconds)}'}")
    if failure is not None and os.environ.get("NBGRADER_EXECUTION"):
        raise failure  # nbgrader gives the points of a cell that raises nothing


def why(failure: BaseException, seconds: float) -> str:
    """What a reader is told about an exception in a check, on one line."""
    if isinstance(failure, _TooSlow):
        return f"your code takes longer than {seconds:g} seconds"
    if isinstance(failure, AssertionError):
        return str(failure) or "an assertion does not hold"
    lines = str(failure).splitlines() or ["no message"]
    if type(failure).__name__ == NOT_TRACED:
        return CALL_JNP
    raised = f"your code raises {type(failure).__name__}: {lines[0]}"
    if isinstance(failure, TypeError) and re.search("NoneType|ellipsis", lines[0]):
        return f"the cell still holds None or `...`, or returns nothing ({raised})"
    return raised


def bar() -> Domain:
    """The bar of chapters 08 to 12, 8 by 2, with 40 vertices on its offset cage."""
    outer = np.array([-4.15 - 1.15j, 4.15 - 1.15j, 4.15 + 1.15j, -4.15 + 1.15j])
    offset = as_points(subdivided(outer, np.array([16, 4, 16, 4])))
    return Domain(Cage([[-4, -1], [4, -1], [4, 1], [-4, 1]]), Cage(offset))


def ring() -> Domain:
    """The ring of chapters 09 and 12, with 24 vertices on each loop of its cages."""
    turn = np.exp(2j * np.pi * np.arange(24) / 24)
    outer, inner, *offset = (as_points(radius * turn) for radius in (3, 1.2, 3.45, 0.84))
    return Domain(Cage(outer, [inner]), Cage(offset[0], offset[1:]), [[0.1, 0.0]])
