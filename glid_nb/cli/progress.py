"""Progress on stderr, for what takes over a second."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TextIO

PATIENCE = 1.0
"""Seconds that a step may take unannounced."""

_REFRESH = 0.2
# Where lines pile up, in a log file say, one in so many seconds is enough.
_REPEAT = 15.0


class Progress:
    """Says what is going on, but only where it takes longer than a second.

    On a terminal one line is rewritten as details come in and erased at the end; elsewhere a line
    is written when a step turns out to be long, every 15 seconds, and when it has ended.

    Parameters
    ----------
    stream : text stream, optional
        Where to write; stderr by default.
    patience : float, optional
        Seconds that a step may take unannounced; :data:`PATIENCE` by default.
    """

    def __init__(self, stream: TextIO | None = None, patience: float | None = None) -> None:
        self._stream = sys.stderr if stream is None else stream
        self._patience = PATIENCE if patience is None else patience
        self._live = self._stream.isatty()

    @contextmanager
    def step(self, doing: str) -> Iterator[Callable[[str], None]]:
        """Run a step called ``doing``; yields a function that takes what is known meanwhile."""
        step = _Step(doing, self._stream, self._live)
        # The step may be one long call into compiled code, so another thread has to speak up.
        speaker = threading.Thread(target=step.speak, args=(self._patience,), daemon=True)
        speaker.start()
        try:
            yield step.detail
        finally:
            step.done.set()
            speaker.join()
            step.sum_up()


class _Step:
    """One step. All writing is done by one thread, and by the main thread after it has ended."""

    def __init__(self, doing: str, stream: TextIO, live: bool) -> None:
        self._doing, self._stream, self._live = doing, stream, live
        self._detail, self._announced = "", False
        self._start = time.perf_counter()
        self.done = threading.Event()

    def speak(self, patience: float) -> None:
        """Announce the step when it takes too long, then keep a terminal's line up to date."""
        if self.done.wait(patience):
            return
        self._announced = True
        if not self._live:
            self._write(f"glid-nb: {self._doing} ...\n")
            while not self.done.wait(_REPEAT):
                self._write(f"glid-nb: {self._line()} ...\n")
            return
        self._write(f"\r\x1b[K{self._line()}")
        while not self.done.wait(_REFRESH):
            self._write(f"\r\x1b[K{self._line()}")

    def detail(self, text: str) -> None:
        self._detail = text

    def sum_up(self) -> None:
        """Erase the terminal's line, or say how long the step took."""
        if self._announced:
            self._write("\r\x1b[K" if self._live else f"glid-nb: {self._line()}\n")

    def _line(self) -> str:
        seconds = time.perf_counter() - self._start
        detail = f", {self._detail}" if self._detail else ""
        return f"{self._doing}: {seconds:.1f} s{detail}"

    def _write(self, text: str) -> None:
        self._stream.write(text)
        self._stream.flush()
