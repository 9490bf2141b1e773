"""The process that judges one hand-in: ``python -m glid_nb.grading.referee``.

It runs the chapter's own cells and checks. A student's function is replaced by a `Remote`, which
calls it in another process (`glid_nb.grading.student`) and waits no longer than the limit. So the
checks see values and nothing else of a student's code. A verdict leaves by standard output as a
line that begins with a token, which only this process and the one that started it know.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import queue
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from glid_nb import course
from glid_nb._errors import InputError
from glid_nb.grading.chapters import Answer, Cell, Notebook, answers
from glid_nb.grading.quiet import namespace_of_a_chapter, without_figures
from glid_nb.grading.verdicts import CRASHED, RIGHT, SLOW, WRONG
from glid_nb.grading.wire import WireError, decoded, encoded

_CHAPTER = 900  # seconds that a chapter's own cells may take in the process of the answers
_LONGEST = 1 << 28  # bytes of a message


class StudentError(InputError):
    """The student's code raised something, ended its process, or sent something else."""

    verdict = CRASHED


class TooSlowError(StudentError):
    """The student's code did not return in time."""

    verdict = SLOW


class NotTracedError(StudentError):
    """The student's code calls NumPy while JAX differentiates it. The check in a notebook says so
    too."""

    verdict = WRONG


class Student:
    """The process of the answers. If it has died, it is started again for the next answer."""

    def __init__(self, folder: Path, limit: float) -> None:
        self._folder, self._limit = folder, limit
        self._ran = list[str]()
        self._process: subprocess.Popen[bytes] | None = None
        self._lines: queue.SimpleQueue[bytes] = queue.SimpleQueue()
        self._objects = list[Any]()
        self._behind = False  # it may still run the chapter's cells
        self._left = limit  # seconds that the student's code may still take

    def run(self, source: str) -> None:
        """Run a cell of the chapter there, without waiting for it."""
        self._ran.append(source)
        self._behind = True
        if self._process is not None:
            with contextlib.suppress(StudentError):
                self._send({"do": "run", "source": source})

    def begin(self) -> None:
        """From now on the student's code may take the whole limit again."""
        self._left = self._limit

    def answer(self, source: str) -> None:
        """Run the student's cells. Raises a StudentError."""
        self.start()
        self.begin()
        self._catch_up()
        self.request({"do": "answer", "source": source})
        self._ran.append(source)

    def _catch_up(self) -> None:
        """Wait for the chapter's own cells. Their time is not the student's."""
        if self._behind:
            left, self._left = self._left, _CHAPTER
            self.request({"do": "wait"})
            self._left, self._behind = left, False

    def call(self, name: str, args: Any, kwargs: Mapping[str, Any]) -> Any:
        """The value of a student's function. Raises a StudentError."""
        self._catch_up()
        values = {k: encoded(v, self._reference) for k, v in kwargs.items()}
        args = encoded(args, self._reference)
        return self._decoded(
            self.request({"do": "call", "name": name, "args": args, "kwargs": values})
        )

    def expression(self, name: str, count: int) -> Any:
        """The operations of a student's function. Raises a StudentError."""
        self._catch_up()
        return self.request({"do": "trace", "name": name, "count": count})

    def end(self) -> None:
        if self._process is not None:
            self._process.kill()
            self._process.wait()
            self._process = None

    def start(self) -> None:
        """Start the process, if there is none, and run there what was run before."""
        if self._process is not None and self._process.poll() is None:
            return
        self._objects.clear()
        self._lines = queue.SimpleQueue()
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-m", "glid_nb.grading.student"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            cwd=self._folder,
        )
        threading.Thread(
            target=_read, args=(self._process.stdout, self._lines), daemon=True
        ).start()
        self._behind = True
        for source in self._ran:
            self._send({"do": "run", "source": source})

    def _send(self, message: dict[str, Any]) -> None:
        assert self._process is not None
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(json.dumps(message).encode() + b"\n")
            self._process.stdin.flush()
        except OSError:
            raise self._ended() from None

    def _ended(self) -> StudentError:
        self.end()
        return StudentError("the process of the answer ended")

    def request(self, message: dict[str, Any]) -> Any:
        """Send a request, and serve what the answer asks for until the reply comes."""
        if self._process is None:
            raise StudentError("the process of the answer ended")
        self._send(message)
        while True:
            reply = self._received()
            if "ask" in reply:
                self._send(self.served(reply))
            elif "raise" in reply:
                if reply["raise"] == course.NOT_TRACED:
                    raise NotTracedError(course.CALL_JNP)
                raise StudentError(f"{reply['raise']!s:.80}: {reply.get('text', '')!s:.2000}")
            else:
                return reply.get("value")

    def _received(self) -> dict[str, Any]:
        since = time.monotonic()
        try:
            line = self._lines.get(timeout=max(0.0, self._left))
        except queue.Empty:
            self.end()
            raise TooSlowError(f"the answer takes longer than {self._limit:g} seconds") from None
        self._left -= time.monotonic() - since
        if not line:
            raise self._ended()
        try:
            reply = json.loads(line)
        except (ValueError, RecursionError):
            reply = None
        if not isinstance(reply, dict):
            self.end()
            raise StudentError("the answer sent something that is no message")
        return reply

    def served(self, request: dict[str, Any]) -> dict[str, Any]:
        """Read a public attribute of an object that was passed to the answer, or call it."""
        try:
            target = self._objects[int(request["number"])]
            if request["ask"] == "get":
                name = str(request["name"])
                if name.startswith("_"):
                    raise WireError("only public attributes can be read")
                value = getattr(target, name)
            else:
                kwargs = {str(k): self._decoded(v) for k, v in request["kwargs"].items()}
                value = target(*self._decoded(request["args"]), **kwargs)
            return {"value": encoded(value, self._reference)}
        except Exception as error:
            return {"raise": type(error).__name__, "text": str(error)[:2000]}

    def _reference(self, value: Any) -> int:
        self._objects.append(value)
        return len(self._objects) - 1

    def _decoded(self, data: Any) -> Any:
        try:
            return decoded(data, lambda number: self._objects[number])
        except WireError as error:
            raise StudentError(str(error)) from None


def _read(stream: Any, lines: queue.SimpleQueue[bytes]) -> None:
    while line := stream.readline(_LONGEST):
        lines.put(line)
    lines.put(b"")


class Remote:
    """A function of the student."""

    def __init__(self, student: Student, name: str) -> None:
        self._student, self.__name__ = student, name
        self._expression: Any = None

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        if any(map(_is_traced, args)):
            from glid_nb.grading.expressions import evaluated  # noqa: PLC0415 - imports JAX

            if self._expression is None:
                self._expression = self._student.expression(self.__name__, len(args))
            try:
                return evaluated(self._expression, args)
            except (KeyError, IndexError, TypeError, ValueError) as error:
                raise StudentError(f"this is no function of numbers: {error}") from None
        return self._student.call(self.__name__, args, kwargs)


def _is_traced(value: Any) -> bool:
    jax = sys.modules.get("jax")
    return jax is not None and isinstance(value, jax.core.Tracer)


class Referee:
    """One chapter with one student's answers."""

    def __init__(
        self,
        chapter: Notebook,
        given: Mapping[str, Answer],
        student: Student,
        tell: Callable[[int, str, str], None],
    ) -> None:
        self._chapter, self._given, self._student, self._tell = chapter, given, student, tell
        self._namespace = namespace_of_a_chapter()
        self._failure: BaseException | None = None
        self._note = ""

    def judge(self) -> None:
        """Run the chapter up to its last check, and tell the verdict of each exercise."""
        course.report = self._record
        cells, number, current = self._chapter.cells, 0, None
        last = max((i for i, cell in enumerate(cells) if "check" in cell.tags), default=-1)
        for cell in cells[: last + 1]:
            if "check" in cell.tags:
                assert current is not None, "a check comes after its exercise"
                number += 1
                self._check(number, current, cell)
            elif "nbval-skip" not in cell.tags:
                self._chapters_own(cell)
            if "exercise" in cell.tags:
                current = cell
            elif "answer" in cell.tags:
                self._take(cell)

    def _chapters_own(self, cell: Cell) -> None:
        """Run a cell of the chapter, here and in the student's process, at the same time.

        If the cell may call the student's functions, it is run here first, with a limit.
        """
        if not any(isinstance(value, Remote) for value in self._namespace.values()):
            self._student.run(cell.source)
            self._run(cell.source)
            return
        self._student.begin()
        try:
            self._run(cell.source)
        except StudentError as error:
            self._give_up(error)
            self._run(cell.source)
        self._student.run(cell.source)

    def _take(self, cell: Cell) -> None:
        """Go on with the student's answer in a cell that has no check."""
        answer = self._given[cell.id]
        if answer.untouched:
            return
        try:
            self._student.answer(answer.source)
        except StudentError as error:
            self._give_up(error)
        else:
            self._bind(cell)

    def _check(self, number: int, exercise: Cell, check: Cell) -> None:
        answer = self._given[exercise.id]
        if answer.untouched:
            self._tell(number, answer.nothing, answer.untouched)
            return
        self._failure = WireError("the check has not reported anything")
        try:
            self._student.answer(answer.source)
            self._bind(exercise)
            self._run(check.source)
        except StudentError as error:
            self._failure = error
        verdict, text = self._verdict()
        if verdict != RIGHT:
            text = self._note + text
            self._restore(exercise)
        self._tell(number, verdict, text)

    def _verdict(self) -> tuple[str, str]:
        failure = self._failure
        if failure is None:
            return RIGHT, ""
        if isinstance(failure, StudentError):
            return failure.verdict, str(failure)
        text = course.why(failure, course.SECONDS)
        if isinstance(failure, KeyboardInterrupt):
            self._student.end()  # a request may be under way
            return SLOW, text
        return WRONG, text

    def _record(self, name: str, failure: BaseException | None, seconds: float) -> None:
        del name, seconds
        self._failure = failure

    def _give_up(self, error: StudentError) -> None:
        """Go on with the course's own functions."""
        self._note = f"the chapter went on with its own cells, because of {error}; "
        for cell in self._chapter.cells:
            if any(isinstance(self._namespace.get(name), Remote) for name in cell.functions):
                self._restore(cell)

    def _restore(self, cell: Cell) -> None:
        self._student.run(cell.source)
        self._run(cell.source)

    def _bind(self, cell: Cell) -> None:
        for name in cell.functions:
            self._namespace[name] = Remote(self._student, name)

    def _run(self, source: str) -> None:
        with contextlib.redirect_stdout(io.StringIO()):
            exec(compile(source, "<chapter>", "exec"), self._namespace)


def main() -> None:
    job = json.loads(sys.stdin.buffer.readline())
    out = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    chapter, handed_in = (Notebook.parsed(job[k]) for k in ("chapter", "handed_in"))

    def tell(number: int, verdict: str, text: str) -> None:
        line = json.dumps({"exercise": number, "verdict": verdict, "text": " ".join(text.split())})
        print(job["token"], line, file=out, flush=True)

    without_figures()
    student = Student(Path(job["folder"]), job["limit"])
    try:
        student.start()  # it runs the chapter's cells beside this process
        Referee(chapter, answers(chapter, handed_in), student, tell).judge()
    finally:
        student.end()


if __name__ == "__main__":
    main()
