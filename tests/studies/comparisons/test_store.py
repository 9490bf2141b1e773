"""Measurements survive, and only whole ones do."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from studies.comparisons.store import Store


def measured(value: float) -> dict:
    return {
        "value": value,
        "many": [1.5, np.nan, np.inf],
        "count": np.int64(3),
        "arrays": {"w": np.arange(6.0).reshape(3, 2)},
    }


def test_what_is_there_is_not_measured_again(tmp_path: Path) -> None:
    calls = []

    def measure() -> dict:
        calls.append(1)
        return measured(len(calls))

    first = Store(tmp_path).get("a", measure)
    again = Store(tmp_path).get("a", measure)
    assert len(calls) == 1
    assert first["value"] == again["value"] == 1
    assert again["many"] == [1.5, None, None]
    assert again["count"] == 3
    np.testing.assert_array_equal(again["arrays"]["w"], np.arange(6.0).reshape(3, 2))
    assert Store(tmp_path, fresh=True).get("a", measure)["value"] == 2


def test_what_is_kept_of_another_problem_does_not_count(tmp_path: Path) -> None:
    store = Store(tmp_path)
    store.get("a", lambda: measured(1), "one shape")
    assert store.kept("a", "another shape") is None
    assert store.kept("b") is None
    kept = store.kept("a", "one shape")
    assert kept is not None
    assert kept["value"] == 1
    assert store.get("a", lambda: measured(2), "another shape")["value"] == 2
    assert store.get("a", lambda: measured(3), "another shape")["value"] == 2


def test_an_interrupted_measurement_is_made_again(tmp_path: Path) -> None:
    def interrupted() -> dict:
        raise KeyboardInterrupt

    store = Store(tmp_path)
    with pytest.raises(KeyboardInterrupt):
        store.get("a", interrupted)
    # Killed between its two files.
    (tmp_path / "a.npz").write_bytes(b"half")
    assert store.get("a", lambda: measured(7))["value"] == 7
    assert json.loads((tmp_path / "a.json").read_text())["value"] == 7
