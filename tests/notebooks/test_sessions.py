"""The sessions prepared for a lecture open, and each holds a method that fails."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import pytest

import glid_nb as glid

SCRIPT = Path(__file__).parents[2] / "notebooks" / "sessions.py"

pytestmark = pytest.mark.slow  # solves poses of three samples


@pytest.fixture(scope="module")
def sessions() -> dict[str, Any]:
    spec = importlib.util.spec_from_file_location("sessions", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.SESSIONS


@pytest.mark.parametrize("name", ["hand-above-head", "ends-turned", "limbs-crossed"])
def test_a_session_opens_and_a_method_in_it_folds_or_halts(
    sessions: dict[str, Any], name: str, tmp_path: Path
) -> None:
    path = tmp_path / f"{name}.glid"
    glid.io.save_document(sessions[name](), path)
    document = glid.io.load_document(path)
    first, *others = document.poses
    assert first.method.label == glid.methods.Newton().label
    fails = []
    for one in others:
        result = glid.solve(document.domain, one.pose, one.energy, one.options, method=one.method)
        folded = isinstance(result.map, glid.MeshMap) and bool(result.map.flipped.any())
        fails.append(folded or result.status is glid.Status.INDEFINITE)
    assert any(fails)
