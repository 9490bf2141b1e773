"""What is kept of a run, and what is measured again."""

from __future__ import annotations

from pathlib import Path

import pytest

from studies.benchmarks.measurements import BenchmarkError, Measurements, kept
from studies.benchmarks.processes import in_new_process
from studies.benchmarks.results import read

HERE, THERE = {"processor": "this one"}, {"processor": "another"}


def store(folder: Path, here: dict, value: int, of: str = "rex", fresh: bool = False) -> int:
    return Measurements(folder, here, fresh).get("speed", of, lambda: {"value": value})["value"]


def test_what_is_there_is_not_measured_again(tmp_path: Path) -> None:
    assert store(tmp_path, HERE, 1) == 1
    assert store(tmp_path, HERE, 2) == 1
    assert store(tmp_path, HERE, 3, fresh=True) == 3


def test_another_machine_or_problem_is_measured_again(tmp_path: Path) -> None:
    assert store(tmp_path, THERE, 1) == 1
    assert store(tmp_path, HERE, 2) == 2
    assert store(tmp_path, HERE, 3, of="raptor") == 3


def test_a_measurement_without_its_machine_counts_as_missing(tmp_path: Path) -> None:
    (tmp_path / "speed.json").write_text('{"value": 1}')
    assert kept(tmp_path, "speed") is None


def test_a_broken_file_is_named(tmp_path: Path) -> None:
    (tmp_path / "speed.json").write_text("{")
    with pytest.raises(BenchmarkError, match=r"speed\.json is not a JSON file"):
        kept(tmp_path, "speed")


def test_what_was_taken_elsewhere_is_named(tmp_path: Path) -> None:
    here = Measurements(tmp_path, HERE)
    here.get("run", "", lambda: {"cases": ["rex"]})
    here.get("machine", "", dict)
    Measurements(tmp_path, THERE).get("rex-drag", "", dict)
    assert read(tmp_path).elsewhere == ["rex-drag"]


def test_a_process_that_fails_is_quoted() -> None:
    with pytest.raises(BenchmarkError, match="exit code 1: ValueError: nothing to do"):
        in_new_process("-c", "raise ValueError('nothing to do')", None)


def test_a_process_reads_and_prints_json() -> None:
    script = "import json, os, sys; print(json.dumps([json.load(sys.stdin), os.environ['WORD']]))"
    assert in_new_process("-c", script, {"a": 1}, WORD="b") == [{"a": 1}, "b"]
