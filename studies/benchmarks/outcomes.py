"""The goals beside what was measured."""

from __future__ import annotations

import statistics
from collections.abc import Callable
from typing import NamedTuple

from studies.benchmarks import goals
from studies.benchmarks.breakdown import (
    Measurement,
    floor_of,
    in_words,
    over_floor,
    shares,
)
from studies.benchmarks.results import Results
from studies.benchmarks.solving import DEFAULT, DRAG, DRAG_GAP, GAP, PAPER

_NEEDS_REX = f"needs the reference shapes, of which {goals.REX} is one"
_NOT_IN_RUN = "left out of this run"


class Outcome(NamedTuple):
    """One goal; words, for a table."""

    goal: str
    wanted: str
    measured: str
    verdict: str
    limit: str
    """What limits it, or why it was not measured."""


def outcomes(results: Results) -> list[Outcome]:
    """Every goal of :mod:`studies.benchmarks.goals`, met, missed by how much, or not measured."""
    return [*_iterations(results), *_whole_solves(results), *_others(results)]


def ratio(paper: dict, default: dict) -> float:
    """How many times faster ``default`` reaches the gap."""
    return paper["to_gap"]["median"] / default["to_gap"]["median"]


def on_gpu(results: Results) -> bool:
    """Whether JAX computed on a GPU."""
    return any(device.startswith(("gpu", "cuda", "rocm")) for device in results.machine["devices"])


def _judged(goal: str, value: float | None, most: float, unit: str, limit: str) -> Outcome:
    """An outcome of what should be at most ``most``; ``limit`` counts where it is not."""
    scale, digits = {"ms": (1e3, 1), "GB": (1e-9, 2), "times": (1.0, 1), "programs": (1.0, 0)}[unit]
    wanted = f"<= {scale * most:.3g} {unit}"
    if value is None:
        return Outcome(goal, wanted, "-", "not measured", limit)
    measured = f"{scale * value:.{digits}f} {unit}"
    if value <= most:
        return Outcome(goal, wanted, measured, "met", "")
    by = f"by {value / most - 1:.0%}" if most else f"by {value:.0f}"
    return Outcome(goal, wanted, measured, f"missed {by}", limit)


def _judged_by(
    goal: str,
    source: Measurement | None,
    value: Callable[[Measurement], float],
    most: float,
    unit: str,
    limit: Callable[[Measurement], str],
    missing: str = _NEEDS_REX,
) -> Outcome:
    """What a measurement says of a goal; ``missing`` is why there is none."""
    if source is None:
        return _judged(goal, None, most, unit, missing)
    return _judged(goal, value(source), most, unit, limit(source))


def _iteration(solve: Measurement) -> float:
    return solve["per_iteration"]["median"]


def _at_least(goal: str, value: float | None, least: float, limit: str) -> Outcome:
    wanted = f">= {least:g} times"
    if value is None:
        return Outcome(goal, wanted, "-", "not measured", limit)
    verdict = "met" if value >= least else f"missed by {1 - value / least:.0%}"
    return Outcome(goal, wanted, f"{value:.1f} times", verdict, "" if value >= least else limit)


def _iterations(results: Results) -> list[Outcome]:
    paper = results.solves[PAPER].get(goals.REX)
    default = results.solves[DEFAULT].get(goals.REX)
    slowest = max(results.solves[DEFAULT].values(), key=_iteration, default=None)
    return [
        _judged_by(
            f"`paper`, {goals.REX}: one iteration, certificate included",
            paper,
            _iteration,
            goals.PAPER_ITERATION,
            "ms",
            in_words,
        ),
        _judged_by(
            f"`paper`, {goals.REX}: the same over the machine's floor",
            paper,
            over_floor,
            goals.FLOOR_FACTOR,
            "times",
            lambda solve: (
                f"the floor is {1e3 * floor_of(solve):.1f} ms, each part at the best "
                "rate seen and nothing between the parts; stage by stage below"
            ),
        ),
        _judged_by(
            f"`default`, {goals.REX}: one iteration",
            default,
            _iteration,
            goals.DEFAULT_ITERATION,
            "ms",
            in_words,
        ),
        _judged_by(
            f"`default`, a cage with {goals.CAGE_VERTICES} vertices: one iteration",
            results.cage,
            _iteration,
            goals.CAGE_ITERATION,
            "ms",
            in_words,
            _NOT_IN_RUN,
        ),
        _judged_by(
            "`default` on a GPU, every shape: one iteration",
            slowest if on_gpu(results) else None,
            _iteration,
            goals.GPU_ITERATION,
            "ms",
            lambda solve: f"{solve['name']}: {in_words(solve)}",
            "no GPU in this machine",
        ),
    ]


def _whole_solves(results: Results) -> list[Outcome]:
    pairs = results.pairs
    by_ratio = sorted(pairs, key=lambda pair: ratio(*pair))
    missing = "no shape has both modes"
    rex = results.solves[DEFAULT].get(goals.REX)
    drag = next((d for d in results.drags if d["name"] == goals.REX), None)
    return [
        _at_least(
            f"`paper` over `default`, identity to a gap of {GAP:g}: median of all shapes",
            statistics.median(ratio(*pair) for pair in pairs) if pairs else None,
            goals.MEDIAN_RATIO,
            _ratio_limit(results) if pairs else missing,
        ),
        _at_least(
            "the same: the least",
            ratio(*by_ratio[0]) if pairs else None,
            goals.LEAST_RATIO,
            _least_limit(*by_ratio[0]) if pairs else missing,
        ),
        _judged_by(
            f"`default`, {goals.REX}: identity to a gap of {GAP:g} (the paper's GPU: "
            f"{1e3 * goals.PUBLISHED_SECONDS:.0f} ms)",
            rex,
            lambda solve: solve["to_gap"]["median"],
            goals.IDENTITY,
            "ms",
            lambda solve: f"{solve['iterations']} iterations, for what one takes see its row above",
        ),
        _judged_by(
            f"drag step, {goals.REX}: one target moved by {DRAG:.0%}, to a gap of {DRAG_GAP:g}",
            drag,
            lambda step: step["time"]["median"],
            goals.DRAG_STEP,
            "ms",
            lambda step: f"{step['iterations']} iterations with {step['corrections']} corrections",
        ),
    ]


def _ratio_limit(results: Results) -> str:
    pairs = results.pairs
    fewer = statistics.median(p["iterations"] / d["iterations"] for p, d in pairs)
    cheaper = statistics.median(
        p["per_iteration"]["median"] / d["per_iteration"]["median"] for p, d in pairs
    )
    factor = statistics.median(shares(d)["factor"] / d["per_iteration"]["median"] for _, d in pairs)
    return (
        f"in the median {fewer:.1f} times fewer iterations, each {cheaper:.1f} times cheaper: in "
        "both modes a Hessian of equal size is factored, which takes "
        f"{factor:.0%} of an iteration of `default`"
    )


def _least_limit(paper: dict, default: dict) -> str:
    times = [1e3 * s["per_iteration"]["median"] for s in (paper, default)]
    return (
        f"{default['name']}: {paper['iterations']} iterations of {times[0]:.1f} ms against "
        f"{default['iterations']} of {times[1]:.1f} ms; {in_words(default)}; the floor of the "
        f"Hessian's products is {1e3 * default['floor']['hessian']:.1f} ms with its "
        f"{default['panels']} panels against {1e3 * paper['floor']['hessian']:.1f}"
    )


def _others(results: Results) -> list[Outcome]:
    largest = [
        row for row in results.scaling.get("vertices", ()) if row["vertices"] == goals.LARGEST_CAGE
    ]
    counts = None if results.compilations is None else results.compilations["counts"]
    return [
        _judged(
            "programs compiled when targets move, handles are added up to the bucket, panels "
            "split, an energy's parameter changes",
            None if counts is None else sum(counts.values()),
            goals.COMPILED_AGAIN,
            "programs",
            _NOT_IN_RUN if counts is None else "the table below says which",
        ),
        _judged(
            f"peak memory, a cage with {goals.LARGEST_CAGE} vertices, Python and JAX included",
            largest[0]["memory"] if largest else None,
            goals.MEMORY,
            "GB",
            "the Hessian, its factor and copies of both" if largest else _NOT_IN_RUN,
        ),
    ]
