"""A small problem, and the folder of it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest


@pytest.fixture
def problems(tmp_path: Path) -> Path:
    """A folder with one problem, called bar: a bar with a hole and three handles, one moved."""
    folder = tmp_path / "problems"
    folder.mkdir()
    data = {
        "cage": [[-8, -2], [8, -2], [8, 2], [-8, 2]],
        "holes": [[[-1, -1], [1, -1], [1, 1], [-1, 1]]],
        "handles": [[-7, 0], [0, -1.5], [7, 0]],
        "targets": [[-7, 0], [0, -1.5], [6, 3]],
    }
    (folder / "bar.json").write_text(json.dumps(data))
    return folder
