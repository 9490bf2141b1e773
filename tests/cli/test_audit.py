"""`glid-nb audit`."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from .conftest import Run


@pytest.fixture
def good(tmp_path: Path) -> Path:
    np.save(tmp_path / "good.npy", np.zeros((6, 8, 2), np.float32))
    return tmp_path / "good.npy"


@pytest.fixture
def bad(tmp_path: Path) -> Path:
    field = np.zeros((6, 8, 2))
    field[2, 3] = (2, 0)
    np.save(tmp_path / "bad.npy", field)
    return tmp_path / "bad.npy"


def test_a_field_that_is_proved(run: Run, good: Path) -> None:
    outcome = run("audit", good)
    assert (outcome.code, outcome.err) == (0, "")
    assert outcome.out.startswith(f"{good}: It is free of folds, proved on 8 x 6 pixels")
    assert outcome.out.count("\n") == 1


def test_a_field_that_folds_with_a_picture_and_a_report(run: Run, bad: Path) -> None:
    figure, report = bad.with_name("folds.png"), bad.with_name("audit.json")
    outcome = run("audit", bad, "--figure", figure, "--report", report)
    assert (outcome.code, outcome.err) == (3, "")
    assert "It folds: the determinant is -1 at the pixel" in outcome.out
    assert figure.read_bytes()[1:4] == b"PNG"
    data = json.loads(report.read_text())
    assert (data["verdict"], data["file"]) == ("folds", str(bad))


def test_json(run: Run, bad: Path) -> None:
    outcome = run("audit", bad, "--json")
    assert outcome.code == 3
    assert json.loads(outcome.out)["folded"] == 2


def test_a_report_to_standard_output(run: Run, good: Path) -> None:
    outcome = run("audit", good, "--report", "-")
    assert json.loads(outcome.out)["verdict"] == "proved"
    assert "free of folds" in outcome.err
    assert run("audit", good, "--report", "-", "--json").code == 1


def test_many_files(run: Run, good: Path, bad: Path, tmp_path: Path) -> None:
    outcome = run("audit", good, bad, "--report", f"{tmp_path}/reports/")
    assert outcome.code == 3
    assert len(outcome.out.splitlines()) == 2
    assert sorted(p.name for p in (tmp_path / "reports").iterdir()) == ["bad.json", "good.json"]
    assert run("audit", good, tmp_path / "none.npy", bad).code == 1


def test_options_of_fields(run: Run, tmp_path: Path) -> None:
    y, x = np.mgrid[:6, :8]
    path = tmp_path / "field.npy"
    np.save(path, np.stack([-0.75 * x, 0 * y], axis=-1))  # it halves x with steps of 1.5
    assert run("audit", path, "--json", "--spacing", "0.5", "1").code == 3
    assert json.loads(run("audit", path, "--json").out)["smallest"] == 0.25
    assert json.loads(run("audit", path, "--json", "--spacing", 1.5, 1).out)["smallest"] == 0.5
    assert run("audit", path, "--order", "yx").code == 0


def test_a_mesh(run: Run, tmp_path: Path) -> None:
    text = "v 0 0\nv 1 0\nv 0 1\nvt 0 0\nvt 1 0\nvt 0 -1\nf 1/1 2/2 3/3\n"
    (tmp_path / "mesh.obj").write_text(text)
    (tmp_path / "rest.obj").write_text("v 0 0\nv 2 0\nv 0 2\nf 1 2 3\n")
    assert run("audit", tmp_path / "mesh.obj").code == 3
    outcome = run("audit", tmp_path / "mesh.obj", "--source", tmp_path / "rest.obj", "--json")
    assert outcome.code == 0
    assert json.loads(outcome.out)["smallest"] == 0.25


def test_bad_input_is_one_line(run: Run, tmp_path: Path, good: Path) -> None:
    path = tmp_path / "nan.npy"
    np.save(path, np.full((3, 3, 2), np.nan))
    for words, message in (
        ([path], f"{path}: dx is nan at the pixel x = 0, y = 0"),
        ([good, "--figure", tmp_path / "a.pdf"], "only .png is written"),
        ([good, "--figure", good], "only .png is written"),
        ([good, "--source", path], "a source is for meshes"),
    ):
        outcome = run("audit", *words)
        assert outcome.code == 1
        assert message in outcome.err
        assert outcome.err.count("\n") == 1
