"""Timings: what is called, how often, and in which order."""

from __future__ import annotations

from studies.timing import LEAST_REPEATS, summary, timed, timed_in_turn


def test_functions_take_turns() -> None:
    calls: list[str] = []
    functions = {"a": lambda: calls.append("a"), "b": lambda: calls.append("b")}
    timings = timed_in_turn(functions, repeats=3)
    assert calls == ["a", "b"] * 4  # the first call of each is a warm-up
    assert {name: timing["runs"] for name, timing in timings.items()} == {"a": 3, "b": 3}
    for timing in timings.values():
        assert 0 <= timing["least"] <= timing["low"] <= timing["median"] <= timing["high"]


def test_a_spent_budget_ends_a_timing_after_the_least_repeats() -> None:
    calls: list[int] = []
    timing = timed(lambda: calls.append(0), repeats=50, warm_up=2, budget=-1.0)
    assert timing["runs"] == LEAST_REPEATS
    assert len(calls) == LEAST_REPEATS + 2


def test_a_summary_has_quartiles() -> None:
    timing = summary([3.0, 1.0, 2.0, 4.0, 5.0])
    assert timing == {"median": 3.0, "low": 2.0, "high": 4.0, "least": 1.0, "runs": 5}
