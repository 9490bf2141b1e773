"""Small pictures and problems, and the command line run in this process."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from PIL import Image

from glid_nb.cli import main, output


class Outcome(NamedTuple):
    """The result of a run of the command line."""

    code: int
    out: str
    err: str


Run = Callable[..., Outcome]


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Run:
    """Runs ``glid-nb`` with the given words. No progress is printed, even on a slow machine."""
    monkeypatch.setattr(output, "PATIENCE", 1e6)

    def run_command(*words: object) -> Outcome:
        try:
            code = main([str(word) for word in words])
        except SystemExit as stop:
            code = int(stop.code or 0)
        out, err = capsys.readouterr()
        return Outcome(code, out, err)

    return run_command


@pytest.fixture
def picture(tmp_path: Path) -> Path:
    """A red plus sign with a hole, 160 x 120 pixels, on a transparent ground."""
    rgba = np.zeros((120, 160, 4), dtype=np.uint8)
    rgba[45:75, 15:145] = (200, 40, 40, 255)
    rgba[15:105, 55:105] = (200, 40, 40, 255)
    rgba[50:70, 70:90] = 0
    path = tmp_path / "plus.png"
    Image.fromarray(rgba).save(path)
    return path


@pytest.fixture
def problem_data() -> dict[str, Any]:
    """A bar with a hole and three handles, one of them moved."""
    return {
        "cage": [[-8, -2], [8, -2], [8, 2], [-8, 2]],
        "holes": [[[-1, -1], [1, -1], [1, 1], [-1, 1]]],
        "handles": [[-7, 0], [0, -1.5], [7, 0]],
        "targets": [[-7, 0], [0, -1.5], [6, 3]],
    }


@pytest.fixture
def problem(tmp_path: Path, problem_data: dict[str, Any]) -> Path:
    """The file of it."""
    path = tmp_path / "problem.json"
    path.write_text(json.dumps(problem_data), encoding="utf-8")
    return path
