"""Progress on stderr for steps that take over a second."""

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TextIO

PATIENCE = 1.0  # seconds before a step is announced

_REFRESH = 0.2
_REPEAT = 15.0  # seconds between lines where they are kept, as in a log file
_ERASE_LINE = "\r\x1b[K"


@contextmanager
def step(
    doing: str, stream: TextIO | None = None, patience: float | None = None
) -> Iterator[Callable[[str], None]]:
    """Run a step called ``doing``; yields a function that sets the detail to show.

    On a terminal one line is updated and finally erased; elsewhere a line is written when a step
    turns out to be long, every 15 seconds, and at its end. By default it writes to stderr, and
    after :data:`PATIENCE` seconds.
    """
    out = sys.stderr if stream is None else stream
    details: list[str] = []
    done, start, live = threading.Event(), time.perf_counter(), out.isatty()

    def write(text: str) -> None:
        out.write(_ERASE_LINE + text if live else f"glid-nb: {text}\n")
        out.flush()

    def line() -> str:
        return ", ".join([f"{doing}: {time.perf_counter() - start:.1f} s", *details[-1:]])

    def report() -> None:
        if done.wait(PATIENCE if patience is None else patience):
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
