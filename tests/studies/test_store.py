"""What is kept of a measurement, and what is measured again."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from studies.processes import StudyError, in_new_process
from studies.store import Store

HERE, THERE = {"processor": "this one"}, {"processor": "another"}


def value(folder: Path, here: dict, number: int, of: str = "rex", fresh: bool = False) -> int:
    return Store(folder, here, fresh).get("speed", of, lambda: {"value": number})["value"]


def test_what_is_there_is_not_measured_again(tmp_path: Path) -> None:
    assert value(tmp_path, HERE, 1) == 1
    assert value(tmp_path, HERE, 2) == 1
    assert value(tmp_path, HERE, 3, fresh=True) == 3


def test_another_machine_or_problem_is_measured_again(tmp_path: Path) -> None:
    assert value(tmp_path, THERE, 1) == 1
    assert value(tmp_path, HERE, 2) == 2
    assert value(tmp_path, HERE, 3, of="raptor") == 3


def test_values_come_back_as_plain_ones_and_arrays(tmp_path: Path) -> None:
    images = np.random.default_rng(0).normal(size=(3, 2))
    measured = {"many": [1.5, np.nan, np.inf], "count": np.int64(3), "arrays": {"w": images}}
    again = Store(tmp_path, HERE).get("a", "", lambda: measured)
    assert again["many"] == [1.5, None, None]
    assert again["count"] == 3
    np.testing.assert_array_equal(again["arrays"]["w"], images)


def test_an_interrupted_measurement_is_made_again(tmp_path: Path) -> None:
    def interrupted() -> dict:
        raise KeyboardInterrupt

    store = Store(tmp_path, HERE)
    with pytest.raises(KeyboardInterrupt):
        store.get("a", "", interrupted)
    assert store.get("a", "", lambda: {"value": 7})["value"] == 7


def test_all_measurements_of_a_study_are_found(tmp_path: Path) -> None:
    for name, here in (("solves-rex", HERE), ("solves-deer", THERE), ("solve", HERE)):
        Store(tmp_path, here).get(name, "", lambda name=name: {"name": name})
    assert [m["name"] for m in Store(tmp_path, HERE).all("solves")] == ["solves-deer", "solves-rex"]


def test_a_measurement_without_its_machine_counts_as_missing(tmp_path: Path) -> None:
    (tmp_path / "speed.json").write_text('{"value": 1}')
    assert Store(tmp_path, HERE).kept("speed") is None


def test_a_broken_file_is_named(tmp_path: Path) -> None:
    (tmp_path / "speed.json").write_text("{")
    with pytest.raises(StudyError, match=r"speed\.json is not a JSON file"):
        Store(tmp_path, HERE).kept("speed")


def test_a_process_that_fails_is_quoted() -> None:
    with pytest.raises(StudyError, match="exit code 1: ValueError: nothing to do"):
        in_new_process("-c", "raise ValueError('nothing to do')", None)


def test_a_process_reads_and_prints_json() -> None:
    script = "import json, os, sys; print(json.dumps([json.load(sys.stdin), os.environ['WORD']]))"
    assert in_new_process("-c", script, {"a": 1}, WORD="b") == [{"a": 1}, "b"]
