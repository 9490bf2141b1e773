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
_ERASE_LINE = "\r\x1b[K"


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

    @contextmanager
    def step(self, doing: str) -> Iterator[Callable[[str], None]]:
        """Run a step called ``doing``; yields a function that takes what is known meanwhile."""
        details: list[str] = []
        done = threading.Event()
        start = time.perf_counter()
        live = self._stream.isatty()

        def line() -> str:
            seconds = time.perf_counter() - start
            return ", ".join([f"{doing}: {seconds:.1f} s", *details[-1:]])

        def speak() -> None:
            if done.wait(self._patience):
                return
            self._write(f"{_ERASE_LINE}{line()}" if live else f"glid-nb: {doing} ...\n")
            while not done.wait(_REFRESH if live else _REPEAT):
                self._write(f"{_ERASE_LINE}{line()}" if live else f"glid-nb: {line()} ...\n")
            self._write(_ERASE_LINE if live else f"glid-nb: {line()}\n")

        # The step may be one long call into compiled code, so another thread has to speak.
        speaker = threading.Thread(target=speak, daemon=True)
        speaker.start()
        try:
            yield details.append
        finally:
            done.set()
            speaker.join()

    def _write(self, text: str) -> None:
        self._stream.write(text)
        self._stream.flush()
