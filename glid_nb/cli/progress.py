"""Progress on stderr for steps that take over a second, and a solve that Ctrl-C stops."""

import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import glid_nb

PATIENCE = 1.0  # seconds before a step is announced
_REFRESH = 0.2
_REPEAT = 15.0  # seconds between lines where they are kept, as in a log file
_ERASE_LINE = "\r\x1b[K"


@contextmanager
def step(doing: str) -> Iterator[Callable[[str], None]]:
    """Run a step called ``doing``; yields a function that sets the detail to show.

    On a terminal one line is updated and finally erased; elsewhere lines are written now and then.
    """
    out, details = sys.stderr, list[str]()
    done, start, live = threading.Event(), time.perf_counter(), out.isatty()

    def write(text: str) -> None:
        out.write(_ERASE_LINE + text if live else f"glid-nb: {text}\n")
        out.flush()

    def line() -> str:
        return ", ".join([f"{doing}: {time.perf_counter() - start:.1f} s", *details[-1:]])

    def report() -> None:
        if done.wait(PATIENCE):
            return
        write(line() if live else f"{doing} ...")
        while not done.wait(_REFRESH if live else _REPEAT):
            write(line() if live else f"{line()} ...")
        write("" if live else line())

    # The step may be one long call into compiled code, so another thread reports.
    reporter = threading.Thread(target=report, daemon=True)
    reporter.start()
    try:
        yield details.append
    finally:
        done.set()
        reporter.join()


def run_solver(
    domain: glid_nb.Domain,
    pose: glid_nb.Pose,
    energy: glid_nb.Energy,
    options: glid_nb.Options,
    start: glid_nb.HarmonicMap | None = None,
    refine: bool = False,
) -> tuple[glid_nb.Result, dict[str, Any]]:
    """The result, with ``refine`` that of the finest basis worth it, and its report.

    Ctrl-C ends the solve with the last certified map; a second Ctrl-C raises KeyboardInterrupt.
    """
    glid_nb.enable_compilation_cache()
    doing = "solving (new shapes are compiled first; Ctrl-C stops)"
    with step(doing) as detail, _interruptible() as interrupted:

        def show(state: glid_nb.Progress) -> bool:
            if state.history:
                last = state.history[-1]
                detail(f"iteration {last.iteration}, energy {last.energy:.6g}")
            else:  # the first step was refused, so panels are split first
                detail("before the first iteration, splitting panels")
            return interrupted()

        result = glid_nb.solve(domain, pose, energy, options, start=start, callback=show)
        if refine:
            result = glid_nb.refine(result, callback=show)
    with step("proving the result"):
        return result, glid_nb.build_report(result)


@contextmanager
def _interruptible() -> Iterator[Callable[[], bool]]:
    """Turn the first Ctrl-C into a request; yields a function that tells whether it was made."""
    asked = threading.Event()

    def ask(signal_number: int, frame: Any) -> None:
        if asked.is_set():
            signal.default_int_handler(signal_number, frame)
        asked.set()

    previous = signal.signal(signal.SIGINT, ask)
    try:
        yield asked.is_set
    finally:
        signal.signal(signal.SIGINT, previous)
