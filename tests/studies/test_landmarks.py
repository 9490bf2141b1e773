"""The study of warps from landmarks."""

from __future__ import annotations

import numpy as np
import pytest

from glid_nb import audit
from studies.compare.landmarks import METHODS, SIDE, TRUTHS, measure, tables
from studies.study import Plan

RNG = np.random.default_rng(1)
SRC = RNG.uniform(10, 90, (12, 2))
OTHERS = [name for name in METHODS if "ours" not in name and "pieces" not in name]


@pytest.mark.parametrize("truth", TRUTHS)
def test_the_truth_does_not_fold(truth: str) -> None:
    rows, columns = np.mgrid[:SIDE, :SIDE]
    pixels = np.stack([columns, rows], axis=-1).astype(float)
    moved = TRUTHS[truth](pixels.reshape(-1, 2)).reshape(pixels.shape)
    assert audit(moved - pixels).proved


@pytest.mark.parametrize("name", OTHERS)
def test_methods_meet_affine_landmarks_and_show_folds(name: str) -> None:
    affine = np.array([[1.1, 0.2], [-0.1, 0.9]])
    warp = METHODS[name](SRC, SRC @ affine)
    middle = SRC.mean(axis=0, keepdims=True)
    np.testing.assert_allclose(warp.images(middle), middle @ affine, atol=1e-6)
    assert not warp.folds()
    swapped = SRC.copy()
    swapped[[0, 1]] = SRC[[1, 0]]
    assert METHODS[name](SRC, swapped).folds()


@pytest.mark.slow
def test_the_study_measures_all_methods() -> None:
    found = [measure("the whole bends", noise, Plan(quick=True)) for noise in (0.0, 3.0)]
    made = tables(found)
    assert len(made["landmarks"]) == 2 * len(METHODS)
    ours = [row for row in made["landmarks"] if row["method"] not in OTHERS]
    assert len(ours) == 4
    assert all(row["folds"] == "0 of 2" for row in ours)
    exact = {row["method"]: row for row in made["landmarks"] if row["clicks off by, px"] == "0"}
    assert all(row["median error at left-out landmarks, px"] < 5 for row in exact.values())
    assert {row["method"] for row in made["landmark-times"]} == set(METHODS)
