"""What a referee says, read without waiting for processes that an answer has left behind."""

from __future__ import annotations

import os
import secrets
import subprocess
import threading

_GRACE = 2.0  # seconds to read what an ended referee has written
_LONGEST = 1 << 20  # bytes of a line


class Said:
    """The lines of a process that begin with a token.

    A thread reads them. A process that an answer started may keep the pipe open, or write to it,
    for as long as it likes: `lines` does not wait for its end.
    """

    def __init__(self, process: subprocess.Popen[bytes], token: str) -> None:
        assert process.stdout is not None
        self._stream, self._token = process.stdout, token.encode()
        self._found, self._over = list[str](), threading.Event()
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def lines(self) -> list[str]:
        """The lines without the token. Call this when the process has ended."""
        self._thread.join(_GRACE)
        self._over.set()
        return list(self._found)

    def _read(self) -> None:
        # os.read, because at the interpreter's end a blocked buffered stream stops the interpreter.
        rest = b""
        with self._stream:
            while not self._over.is_set():
                try:
                    read = os.read(self._stream.fileno(), 1 << 16)
                except OSError:
                    break
                if not read:
                    break
                *lines, rest = (rest + read).split(b"\n")
                rest = rest[:_LONGEST]
                for line in lines:
                    self._hear(line)

    def _hear(self, line: bytes) -> None:
        said, _, text = line.partition(b" ")
        if secrets.compare_digest(said, self._token):
            self._found.append(text.decode(errors="replace"))
