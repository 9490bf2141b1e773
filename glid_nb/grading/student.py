"""The process in which a student's code runs: ``python -m glid_nb.grading.student``.

It holds no secret and decides nothing. It runs the chapter's cells and the student's, and calls the
student's functions for the referee. Messages are lines of JSON.
"""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from typing import IO, Any

from glid_nb.course import in_double_precision
from glid_nb.grading.quiet import namespace_of_a_chapter, without_figures
from glid_nb.grading.wire import decoded, encoded


class Reference:
    """An object of the referee. Its public attributes can be read, and it can be called."""

    def __init__(self, link: Link, number: int) -> None:
        self.__dict__.update(_link=link, _number=number)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return self._link.ask({"ask": "get", "number": self._number, "name": name})

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        values = {"args": encoded(args), "kwargs": {k: encoded(v) for k, v in kwargs.items()}}
        return self._link.ask({"ask": "call", "number": self._number, **values})


class Link:
    """The messages to and from the referee."""

    def __init__(self, read: IO[bytes], write: IO[bytes]) -> None:
        self._read, self._write = read, write
        self.namespace = namespace_of_a_chapter()

    def serve(self) -> None:
        """Answer requests until the referee closes the link."""
        while line := self._read.readline():
            request = json.loads(line)
            try:
                with in_double_precision():
                    reply = {"value": self.done(request)}
            except BaseException as error:  # the student's code may raise anything, also SystemExit
                reply = {"raise": type(error).__name__, "text": _text(error)}
            if request["do"] != "run":
                self._send(reply)

    def ask(self, request: dict[str, Any]) -> Any:
        """Ask the referee for something of its own, while it waits for a function's value."""
        self._send(request)
        reply = json.loads(self._read.readline())
        if "raise" in reply:
            raise RuntimeError(reply["text"])
        return self.decoded(reply["value"])

    def done(self, request: dict[str, Any]) -> Any:
        """Run code, or call a function; its value, encoded."""
        what = request["do"]
        if what in ("run", "answer"):
            exec(compile(request["source"], "<answer>", "exec"), self.namespace)
            return None
        if what == "wait":
            return None
        function = self.namespace[request["name"]]
        if what == "trace":
            from glid_nb.grading.expressions import expression_of  # noqa: PLC0415 - imports JAX

            return expression_of(function, request["count"])
        kwargs = {name: self.decoded(value) for name, value in request["kwargs"].items()}
        return encoded(function(*self.decoded(request["args"]), **kwargs))

    def decoded(self, data: Any) -> Any:
        """A value that came from the referee."""
        return decoded(data, lambda number: Reference(self, number), trusted=True)

    def _send(self, message: dict[str, Any]) -> None:
        self._write.write(json.dumps(message).encode() + b"\n")
        self._write.flush()


def _text(error: BaseException) -> str:
    try:
        return str(error)[:2000]
    except Exception:  # the class is the student's, and so is its text
        return ""


def main() -> None:
    read, write = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    nothing = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):  # what the student's code prints goes nowhere
        os.dup2(nothing, stream)
    sys.path.append(str(Path.cwd()))  # for modules that were handed in too
    without_figures()
    Link(read, write).serve()


if __name__ == "__main__":
    main()
