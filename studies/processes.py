"""Measurements in separate processes: of memory, of devices, of the first compilation."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Sequence
from typing import Any, Literal, NamedTuple

from glid_nb import InputError


class StudyError(InputError):
    """A measurement is missing or could not be taken, or there is no such study."""


def in_new_process(how: Literal["-m", "-c"], program: str, given: Any, **environment: str) -> Any:
    """The JSON value that a program prints on its last line.

    The program is ``-m`` and a module's name, or ``-c`` and a script. ``given`` is written to its
    standard input as JSON. ``environment`` is added to this process's variables. If the process
    fails, raises a StudyError that ends with the last line of its errors.
    """
    run = subprocess.run(
        [sys.executable, how, program],
        input=json.dumps(given),
        env=_variables(environment),
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    if run.returncode:
        called = program if how == "-m" else "a measurement's script"
        raise StudyError(f"{called} {_last_words(run.returncode, run.stderr)}")
    return json.loads(run.stdout.splitlines()[-1])


class Printed(NamedTuple):
    """The lines that a process printed until it ended or was stopped."""

    lines: list[str]
    seconds: float
    ending: str
    """Empty if the process ended by itself and without an error."""


def printed_by(arguments: Sequence[str], given: Any, limit: float, **environment: str) -> Printed:
    """The lines that Python prints when called with ``arguments``; its input is ``given`` as JSON.

    It is stopped after ``limit`` seconds. A stop or a failure raises nothing; see ``ending``.
    """
    lines, began = list[str](), time.perf_counter()
    with tempfile.TemporaryFile("w+", encoding="utf-8") as errors:
        process = subprocess.Popen(
            [sys.executable, *arguments],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=errors,
            env=_variables(environment),
            text=True,
            encoding="utf-8",
            start_new_session=True,
        )
        assert process.stdin is not None
        assert process.stdout is not None
        reader = threading.Thread(target=lines.extend, args=(process.stdout,))
        reader.start()
        # A process may end before it has read its input. What it printed and its exit code tell.
        with contextlib.suppress(BrokenPipeError), process.stdin as entrance:
            entrance.write(json.dumps(given))
        ending = ""
        try:
            process.wait(timeout=limit)
        except subprocess.TimeoutExpired:
            _kill(process)
            ending = f"stopped after {limit:.0f} s"
        reader.join()
        process.stdout.close()
        errors.seek(0)
        if process.returncode and not ending:
            ending = _last_words(process.returncode, errors.read())
    return Printed(lines, time.perf_counter() - began, ending)


def _kill(process: subprocess.Popen[str]) -> None:
    """End a process that leads its own session, and all processes that it started."""
    if hasattr(os, "killpg"):
        os.killpg(process.pid, signal.SIGKILL)
    else:
        process.kill()
    process.wait()


def _variables(more: dict[str, str]) -> dict[str, str]:
    # The waiting process uses the same GPU, so leave it some memory.
    return {"XLA_PYTHON_CLIENT_PREALLOCATE": "false", **os.environ, **more}


def _last_words(code: int, errors: str) -> str:
    last = (errors.strip().splitlines() or ["no message"])[-1]
    return f"ended with exit code {code}: {last}"
