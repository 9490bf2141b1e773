"""Measurements in a process of their own: its memory, its devices, its first compilation."""

import json
import os
import subprocess
import sys
from typing import Any, Literal

from glid_nb import InputError


class StudyError(InputError):
    """A measurement is missing or could not be taken, or there is no such study."""


def in_new_process(how: Literal["-m", "-c"], program: str, given: Any, **environment: str) -> Any:
    """What a program prints as JSON on its last line.

    ``-m`` and a module's name, or ``-c`` and a script, say which; ``given`` is written to its
    standard input as JSON, and ``environment`` is set beside this process's variables. A
    StudyError that ends with its last words when the process fails.
    """
    run = subprocess.run(
        [sys.executable, how, program],
        input=json.dumps(given),
        # A GPU's memory is shared with the process that waits.
        env={"XLA_PYTHON_CLIENT_PREALLOCATE": "false", **os.environ, **environment},
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    if run.returncode:
        last = (run.stderr.strip().splitlines() or ["no message"])[-1]
        called = program if how == "-m" else "a measurement's script"
        raise StudyError(f"{called} ended with exit code {run.returncode}: {last}")
    return json.loads(run.stdout.splitlines()[-1])
