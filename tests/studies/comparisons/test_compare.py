"""The comparisons as a command."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from studies.comparisons.__main__ import main


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--only", "magic"], "unknown experiment 'magic'"),
        (["--reference", "nowhere"], "no JSON file there holds a cage and handles"),
    ],
)
def test_bad_input_is_refused(tmp_path: Path, words: list[str], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        main(["--out", str(tmp_path / "out"), *words])


@pytest.mark.slow
def test_one_experiment_writes_its_figure_and_page(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "figures"
    main(["--out", str(out), "--only", "exponential"])
    page = tmp_path / "figures.md"
    assert capsys.readouterr().out.strip() == str(page)
    text = page.read_text(encoding="utf-8")
    assert "the exponential lowers the maximal distortion" in text
    assert "**Reproduced.**" in text
    assert (out / "exponential.png").stat().st_size > 10_000
    kept = out / "data" / "exponential-bar-extreme.json"
    assert json.loads(kept.read_text())["runs"]["exp"]["status"] == "converged"
