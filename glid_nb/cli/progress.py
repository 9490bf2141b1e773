"""Progress on stderr for steps that take over a second."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TextIO

# Seconds before a step is announced.
PATIENCE = 1.0

_REFRESH = 0.2
# Seconds between lines where they are kept, as in a log file.
_REPEAT = 15.0
_ERASE_LINE = "\r\x1b[K"


class Progress:
    """Reports steps that take longer than a second.

    On a terminal one line is updated and finally erased; elsewhere a line is written when a step
    turns out to be long, every 15 seconds, and at its end.

    Parameters
    ----------
    stream : text stream, optional
        Where to write; stderr by default.
    patience : float, optional
        Seconds before a step is announced; :data:`PATIENCE` by default.
    """

    def __init__(self, stream: TextIO | None = None, patience: float | None = None) -> None:
        self._stream = sys.stderr if stream is None else stream
        self._patience = PATIENCE if patience is None else patience

    @contextmanager
    def step(self, doing: str) -> Iterator[Callable[[str], None]]:
        """Run a step called ``doing``; yields a function that sets the detail to show."""
        details: list[str] = []
        done = threading.Event()
        start = time.perf_counter()
        live = self._stream.isatty()

        def line() -> str:
            seconds = time.perf_counter() - start
            return ", ".join([f"{doing}: {seconds:.1f} s", *details[-1:]])

        def report() -> None:
            if done.wait(self._patience):
                return
            self._write(f"{_ERASE_LINE}{line()}" if live else f"glid-nb: {doing} ...\n")
            while not done.wait(_REFRESH if live else _REPEAT):
                self._write(f"{_ERASE_LINE}{line()}" if live else f"glid-nb: {line()} ...\n")
            self._write(_ERASE_LINE if live else f"glid-nb: {line()}\n")

        # The step may be one long call into compiled code, so another thread reports.
        reporter = threading.Thread(target=report, daemon=True)
        reporter.start()
        try:
            yield details.append
        finally:
            done.set()
            reporter.join()

    def _write(self, text: str) -> None:
        self._stream.write(text)
        self._stream.flush()
