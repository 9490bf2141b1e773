"""Goals beside made-up measurements."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from studies.benchmarks.outcomes import outcomes
from studies.benchmarks.results import Results
from studies.benchmarks.stages import STAGES


def solve(mode: str, seconds: float, iterations: int) -> dict[str, Any]:
    part = seconds / iterations
    return {
        "name": "rex",
        "mode": mode,
        "unknowns": 384,
        "padded": 416,
        "panels": 700,
        "iterations": iterations,
        "corrections": 0,
        "energy": 2.0,
        "modified": 0.0,
        "to_gap": {"median": seconds},
        "per_iteration": {"median": part},
        "before": {"median": part / 10},
        "floor": {"products": part / 12, "hessian": part / 12, "factor": part / 12},
        "stages": dict.fromkeys(STAGES, part / 6),
    }


RESULTS = Results(
    run={"cases": ["rex"], "reference": True, "repeats": 1, "quick": False},
    machine={"devices": ["cpu: cpu"]},
    solves={
        "paper": {"rex": solve("paper", 0.26, 10)},
        "default": {"rex": solve("default", 0.03, 6)},
        "paper-aligned": {},
    },
    cage=None,
    drags=[],
    start=None,
    compilations={"counts": {"targets moved": 0, "handles added": 1}},
    scaling={"vertices": [{"vertices": 1000, "memory": 1.9e9}]},
    batches=None,
    elsewhere=[],
)


def verdicts(results: Results) -> list[str]:
    return [outcome.verdict for outcome in outcomes(results)]


def test_goals_are_met_or_missed_by_so_much() -> None:
    assert verdicts(RESULTS) == [
        "missed by 100%",
        "missed by 100%",
        "met",
        "not measured",
        "not measured",
        "met",
        "met",
        "met",
        "not measured",
        "missed by 1",
        "met",
    ]


def test_what_is_missed_says_what_limits_it() -> None:
    for outcome in outcomes(RESULTS):
        assert bool(outcome.limit) == (outcome.verdict != "met")
    assert "Gflop/s" in outcomes(RESULTS)[0].limit


def test_a_ratio_too_low_is_missed() -> None:
    slow = {**RESULTS.solves, "default": {"rex": solve("default", 0.13, 6)}}
    median, least = outcomes(replace(RESULTS, solves=slow))[5:7]
    assert (median.measured, median.verdict) == ("2.0 times", "missed by 60%")
    assert least.verdict == "missed by 20%"


@pytest.mark.parametrize("device", ["gpu: NVIDIA H100", "cuda: NVIDIA H100"])
def test_the_goal_of_a_gpu_is_judged_on_one(device: str) -> None:
    on_gpu = replace(RESULTS, machine={"devices": [device]})
    assert outcomes(on_gpu)[4].verdict == "missed by 233%"


def test_nothing_measured_misses_nothing() -> None:
    none = {"paper": {}, "default": {}, "paper-aligned": {}}
    empty = replace(RESULTS, solves=none, compilations=None, scaling={})
    assert set(verdicts(empty)) == {"not measured"}
