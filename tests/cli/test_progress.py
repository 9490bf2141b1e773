"""Progress is printed only for steps that take long."""

from __future__ import annotations

import contextlib
import io
import threading
from collections.abc import Callable, Iterator
from unittest import mock

import pytest

from glid_nb.cli import output


@contextlib.contextmanager
def step(doing: str, stream: io.StringIO, patience: float) -> Iterator[Callable[[str], None]]:
    """A step that is reported on a stream."""
    with (
        mock.patch.object(output, "PATIENCE", patience),
        contextlib.redirect_stderr(stream),
        output.step(doing) as detail,
    ):
        yield detail


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


class Recorder(io.StringIO):
    """A stream that signals each write."""

    def __init__(self) -> None:
        super().__init__()
        self.written = threading.Event()

    def write(self, text: str) -> int:
        count = super().write(text)
        self.written.set()
        return count


def test_a_short_step_is_silent() -> None:
    stream = io.StringIO()
    with step("tracing", stream, patience=60):
        pass
    assert stream.getvalue() == ""


def test_a_long_step_is_announced_while_it_runs_and_summed_up_after() -> None:
    stream = Recorder()
    with step("solving", stream, patience=0) as detail:
        assert stream.written.wait(10)
        assert stream.getvalue() == "glid-nb: solving ...\n"
        detail("iteration 7")
    last = stream.getvalue().splitlines()[-1]
    assert last.startswith("glid-nb: solving: ")
    assert last.endswith(" s, iteration 7")


def test_a_failing_step_ends_its_line() -> None:
    stream = Terminal()
    with pytest.raises(RuntimeError), step("solving", stream, patience=60):
        raise RuntimeError
    assert stream.getvalue() == ""


def test_a_terminal_line_is_rewritten_and_erased() -> None:
    class RecordingTerminal(Terminal):
        shown = threading.Event()

        def write(self, text: str) -> int:
            if "iteration 7" in text:
                self.shown.set()
            return super().write(text)

    stream = RecordingTerminal()
    with step("solving", stream, patience=0) as detail:
        detail("iteration 7")
        assert stream.shown.wait(10)
    text = stream.getvalue()
    assert "\n" not in text
    *_, shown, spaces, after = text.split("\r")
    assert spaces == " " * len(shown) != ""
    assert after == ""
    assert "\x1b" not in text  # older consoles of Windows print these
