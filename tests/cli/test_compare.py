"""`glid-nb compare`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest


def test_it_explains_itself(run) -> None:
    outcome = run("compare", "--help")
    assert outcome.code == 0
    assert "--reference" in outcome.out


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--only", "magic"], "unknown experiment 'magic'"),
        (["--reference", "nowhere"], "no JSON file there holds a cage and handles"),
    ],
)
def test_bad_input_is_one_line(run, tmp_path: Path, words: list[str], message: str) -> None:
    outcome = run("compare", "--out", tmp_path / "out", *words)
    assert outcome.code == 1
    assert message in outcome.err
    assert outcome.err.count("\n") == 1


@pytest.mark.slow
def test_one_experiment_writes_its_figure_and_page(run, tmp_path: Path) -> None:
    out = tmp_path / "figures"
    outcome = run("compare", "--out", out, "--only", "exponential")
    assert outcome.code == 0, outcome.err
    page = tmp_path / "figures.md"
    assert outcome.out.strip() == str(page)
    text = page.read_text(encoding="utf-8")
    assert "the exponential lowers the maximal distortion" in text
    assert "**Reproduced.**" in text
    assert (out / "exponential.png").stat().st_size > 10_000
    kept = out / "data" / "exponential-bar-extreme.json"
    assert json.loads(kept.read_text())["runs"]["exp"]["status"] == "converged"
