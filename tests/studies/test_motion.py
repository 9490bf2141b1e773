"""The measurements of motions between two poses."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from glid_nb import Motion
from glid_nb.certificate import certificate_of
from studies.__main__ import main
from studies.bench.scaling import flower
from studies.motion import excess, pair

pytestmark = pytest.mark.slow


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_a_pose_and_random_motions_are_measured(
    problems: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("studies.motion.names", list)  # no bundled samples
    monkeypatch.setattr("studies.motion.TIMES", 5)
    out = tmp_path / "out"
    main(["motion", "--quick", "--repeats", "1", "--reference", str(problems), "--out", str(out)])
    (bar,) = rows(out / "between.csv")
    assert bar["shape"] == "bar (28, 1)"
    k = [float(value) for value in bar["k, bounded"].split()]
    assert np.all(np.diff([0, *k, float(bar["k at the end"]) + 0.01]) > 0)
    assert float(bar["proof, ms"]) > 0
    attacked = rows(out / "attack.csv")
    assert [row["holes"] for row in attacked] == list("0123456")
    assert all(row["certified"] == row["motions"] == "2" for row in attacked)
    assert all(float(row["least room of bounds"]) > 0 for row in attacked)


def test_random_pairs_are_certified_and_a_blend_is_worse_than_its_ends() -> None:
    maps = pair(flower(30, 2), 3)
    assert all(certificate_of(map).certified for map in maps)
    assert excess(Motion(maps), [0.5]) < 0.02
    assert excess(Motion(maps, between="linear"), [0.5]) > 0.02
