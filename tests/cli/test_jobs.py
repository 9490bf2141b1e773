"""`glid-nb solve` with --jobs, --scheduler, --summary and --kept."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import pytest

from glid_nb import HarmonicMap
from glid_nb.cli import jobs

pytestmark = pytest.mark.slow


@pytest.fixture
def problems(tmp_path: Path, problem_data: dict[str, Any]) -> list[Path]:
    """Two problems of one shape; between them one with a handle outside, and no problem."""
    paths = [tmp_path / name for name in ("one.json", "outside.json", "no.json", "two.json")]
    other = {**problem_data, "targets": [[-7, 0], [0, -1.5], [6, -1]]}
    outside = {**problem_data, "handles": [[99, 99]], "targets": [[0, 0]]}
    for path, data in zip(paths, (problem_data, outside, [], other), strict=True):
        path.write_text(json.dumps(data), encoding="utf-8")
    return paths


def table(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_a_line_for_each_result_and_a_table(run: Any, problems: Any, tmp_path: Path) -> None:
    folders = {flag: tmp_path / flag for flag in ("out", "proof", "report")}
    words = [word for flag, path in folders.items() for word in (f"--{flag}", f"{path}/")]
    words += ["--summary", tmp_path / "table.csv", "--kept", tmp_path / "kept"]
    outcome = run("solve", *problems, *words)
    assert outcome.code == 1
    first, second = outcome.out.splitlines()
    assert first.startswith(f"{problems[0]}: converged, energy ")
    assert first.endswith(str(folders["report"] / "one.json"))
    assert "sigma_2 >= 0." in second
    *errors, last = outcome.err.splitlines()
    assert errors[0].startswith(f"glid-nb: error: {problems[1]}: handle 0 at (99, 99) lies")
    assert str(problems[2]) in errors[1]
    assert last == "glid-nb: error: 2 of 4 inputs failed, for the reasons above"
    for path in folders.values():
        assert sorted(file.name for file in path.iterdir()) == ["one.json", "two.json"]
    HarmonicMap.load(folders["out"] / "one.json")
    rows = table(tmp_path / "table.csv")
    assert [row["name"] for row in rows] == list(map(str, problems))
    assert [row["status"] for row in rows] == ["converged", "failed", "failed", "converged"]
    assert [row["certified"] for row in rows] == ["True", "", "", "True"]
    assert "lies outside the domain" in rows[1]["error"]
    assert float(rows[0]["energy"]) > 2

    # Everything is kept, so no process is started.
    good = problems[0], problems[3]
    again = run("solve", *good, *words, "--jobs", 2, "--json")
    assert again.code == 0, again.err
    lines = [json.loads(line) for line in again.out.splitlines()]
    assert [line["name"] for line in lines] == list(map(str, good))
    assert all(line["kept"] and line["certified"] for line in lines)
    assert [row["kept"] for row in table(tmp_path / "table.csv")] == ["True", "True"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--jobs", "2", "--refine"), "--refine is for problems one by one; leave --jobs"),
        (("--jobs", "2", "--scheduler", "tcp://127.0.0.1:1"), "--jobs and --scheduler exclude"),
        (("--jobs", "0"), "--jobs must be at least 1"),
        (("--jobs", "2", "--out", "-"), "--out -: each result is a line there; name a folder"),
        (("--scheduler", "tcp://127.0.0.1:1"), "--scheduler tcp://127.0.0.1:1: no scheduler"),
        (("--scheduler", "nowhere"), "--scheduler nowhere: no scheduler answers"),
    ],
)
def test_what_does_not_fit_is_refused(
    run: Any, problem: Path, monkeypatch: Any, words: Any, message: str
) -> None:
    monkeypatch.setattr(jobs, "CONNECT", 0.5)
    outcome = run("solve", problem, *words)
    assert outcome.code == 1
    assert message in outcome.err
    assert len(outcome.err.splitlines()) == 1
