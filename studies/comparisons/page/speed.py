"""How much faster ours is, by three criteria."""

from __future__ import annotations

from typing import Any

import numpy as np

from studies.comparisons import drawing, paper
from studies.comparisons.distortion import densities
from studies.comparisons.drawing import LOOK
from studies.comparisons.page import cost
from studies.comparisons.page.words import joined, spread, table, verdict
from studies.comparisons.progress import MESH
from studies.comparisons.runs import NEAR, VISIBLE
from studies.comparisons.store import Measurement
from studies.comparisons.units import percent, seconds

_TITLES = {
    "energy": f"Energy within {100 * NEAR:.0f}% of its minimum",
    "rest": "No visible movement in an iteration",
    "map": "No visible distance from the minimum",
}

_TIMES = 2.0
"""From so many times its minimum on an energy is not given in percent above it."""

WANTED = 25
"""The median that the ratios should have for SLIM and for AQP."""

_LATE = 100
"""Iterations at the end of a run that tell how fast its energy still falls."""


def section(cases: list[Measurement]) -> list[str]:
    """A table and the medians for each criterion, and what the speed is paid with."""
    lines = [
        "### Speed",
        "",
        "Time to the first iteration from which on a criterion holds. Each method is measured "
        "against its own minimum: ours and Newton-Eigen against where they converge, SLIM and AQP "
        "against the minimum of their own energy on their mesh (above), SLIM's total energy with "
        "soft constraints, AQP's E_iso with hard ones. Visible is "
        f"{VISIBLE:g} world units, a pixel where a picture's longer side is 500 pixels. Of these "
        "criteria the paper's is closest to the second; the third asks for what a user would call "
        "converged.",
        "",
        f"*Paper*, with its GPU, in Figure 10 and from the times of Figure 11: SLIM takes "
        f"{_paper('slim')}, AQP {_paper('aqp')} as long as its solver; against its own CPU "
        f"{paper.SPEED_ON_CPU['slim']} and {paper.SPEED_ON_CPU['aqp']} times (Figure 11). "
        f"Newton-Eigen takes {_paper('newton-eigen')} (Figures 10 and 1). All is on a CPU here.",
        "",
        "The start is the identity, as in the paper. A shape can have several minima, and the "
        "methods may end in different ones: each is timed to its own, and *Distortion at the "
        "minimum* below tells how good that is. Ours by itself would begin with a rigid alignment, "
        "which can lead to a lower one.",
        "",
        *_summary(cases),
        "",
        *_eigen(cases),
        "",
    ]
    for criterion, title in _TITLES.items():
        lines += _criterion(cases, criterion, title)
    lines += [_why_slow(cases), "", *_flat(cases), _how(cases), ""]
    return [*lines, *cost.preparation(cases), "", *cost.energies(cases)]


def _summary(cases: list[Measurement]) -> list[str]:
    """The medians of all criteria, with and without shapes where the minima are not alike."""
    apart = cost.other_minima(cases)
    alike = [d for d in cases if d["name"] not in apart]
    rows = []
    for criterion, title in _TITLES.items():
        row = [f"{title} *(the paper's)*" if criterion == "rest" else title]
        for method in MESH:
            for chosen in (cases, alike):
                values = _ratios(chosen, method, criterion)
                row.append(_times_of(values) if values else "-")
        rows.append(row)
    named = f"without {joined(apart)}" if apart else "same minima"
    heads = [f"{LOOK[m][0]}, {which}" for m in MESH for which in ("all", named)]
    return [
        "Time over ours, median over shapes (least to most; `+`: at least that):",
        "",
        *table(["criterion", *heads], rows),
    ]


def _ratios(cases: list[Measurement], method: str, criterion: str) -> list[tuple[float, bool]]:
    cells = (
        _cell(d["runs"].get(method), criterion, d["runs"]["newton"]["reached"][criterion]["time"])
        for d in cases
    )
    return [ratio for _, ratio in cells if ratio is not None]


def _times_of(values: list[tuple[float, bool]]) -> str:
    """For example ``164x (15x to 2393x+)``."""
    low, high = min(values), max(values)
    return f"{_factor(_median_of(values))} ({_factor(low)} to {_factor(high)})"


def _factor(value: tuple[float, bool]) -> str:
    ratio, bounded = value
    return f"{ratio:.0f}x{'+' if bounded else ''}"


def _eigen(cases: list[Measurement]) -> list[str]:
    """The claim about Newton-Eigen, on one processor as far as the paper's numbers go."""
    ratios = [ratio for ratio, _ in _ratios(cases, "newton-eigen", "rest")]
    if not ratios:
        return []
    said = {
        name: (count.newton_eigen * row.newton_eigen) / (count.newton * row.newton_cpu)
        for name, count in paper.ITERATIONS.items()
        if name is not None and (row := paper.TABLE_2[name])
    }
    each = joined([f"{ratio:.1f} on {name}" for name, ratio in said.items()])
    middle = float(np.median(ratios))
    return [
        f"*Newton-Eigen takes {_paper('newton-eigen')} as long* (paper, against its GPU; on one "
        f"CPU its iterations and Table 2 amount to {each}): here {middle:.0f} times in the median, "
        f"{spread(ratios, 0)}, on one CPU, with more iterations and dearer ones. "
        f"{verdict(middle >= min(said.values()), middle > 1)}"
    ]


def _gap(gap: float) -> str:
    return f"{gap + 1:.2g} times it" if gap + 1 >= _TIMES else percent(gap)


def _paper(method: str) -> str:
    low, high = paper.SPEED[method]
    return f"{low} to {high} times"


def _criterion(cases: list[Measurement], criterion: str, title: str) -> list[str]:
    rows = []
    for d in cases:
        ours = d["runs"]["newton"]["reached"][criterion]["time"]
        row = [d["name"], seconds(ours)]
        for method in ("newton-eigen", *MESH):
            cell, _ = _cell(d["runs"].get(method), criterion, ours)
            row.append(cell)
        rows.append(row)
    ratios = {method: _ratios(cases, method, criterion) for method in MESH}
    heads = ["shape", "ours", *(LOOK[m][0] for m in ("newton-eigen", *MESH))]
    lines = [f"**{title}**", "", *table(heads, rows), "", *_notes(cases, criterion)]
    if any(ratios.values()):
        each = [_median(LOOK[m][0], values) for m, values in ratios.items() if values]
        medians = [_median_of(values)[0] for values in ratios.values() if values]
        everything = [ratio for values in ratios.values() for ratio, _ in values]
        fast = sum(ratio >= WANTED for ratio in everything)
        lines += [
            f"Their time over ours, median over shapes: {joined(each)}; {fast} of "
            f"{len(everything)} runs at {WANTED}x or more. By medians of {WANTED}x for both: "
            f"{verdict(min(medians) >= WANTED, max(medians) >= WANTED)}{_weak(cases, criterion)}",
            "",
        ]
    return lines


def _weak(cases: list[Measurement], criterion: str) -> str:
    """Methods whose steps are so small that they seem to rest far from the minimum."""
    if criterion != "rest":
        return ""
    early = []
    for d in cases:
        for method in MESH:
            found = d["runs"].get(method, {}).get("reached", {})
            rest, near = found.get("rest"), found.get("energy")
            if rest is not None and (near is None or rest["iteration"] < near["iteration"]):
                early.append(f"{LOOK[method][0]} on {d['name']}")
    if not early:
        return ""
    return (
        " It is the weakest of the three criteria, for small steps meet it as well as the end of "
        f"the way does: {joined(early)} met it before the energy was within "
        f"{100 * NEAR:.0f}% of its minimum."
    )


def _cell(
    run: dict[str, Any] | None, criterion: str, ours: float
) -> tuple[str, tuple[float, bool] | None]:
    """What the table says, and the ratio with whether it is a lower bound."""
    if run is None:
        return "not installed", None
    if "reached" not in run:
        return "no minimum" if "minimum" in run else "unconverged", None
    found = run["reached"][criterion]
    if found is not None:
        ratio = found["time"] / ours
        return f"{seconds(found['time'])}, {ratio:.0f}x", (ratio, False)
    spent = run["time"][-1]
    return f"{seconds(spent)}+, {spent / ours:.0f}x+", (spent / ours, True)


def _notes(cases: list[Measurement], criterion: str) -> list[str]:
    """What the words and signs in a table's cells stand for."""
    runs = [
        (f"{LOOK[m][0]} on {d['name']}", d["runs"][m])
        for m in ("newton-eigen", *MESH)
        for d in cases
        if m in d["runs"]
    ]
    stopped = [
        f"{name} ({_left(run, criterion)})"
        for name, run in runs
        if "reached" in run and run["reached"][criterion] is None
    ]
    lost = [f"{name} ({run['reason']})" for name, run in runs if "reason" in run]
    astray = [name for name, run in runs if "reached" not in run and "minimum" not in run]
    notes = []
    if stopped:
        notes.append(f"A `+` marks runs that were stopped before: {joined(stopped)}.")
    if astray:
        notes.append(f"Unconverged, and in no ratio: {joined(astray)}.")
    if lost:
        notes.append(f"There is no minimum to compare with for {joined(lost)}.")
    return [" ".join(notes), ""] if notes else []


def _left(run: dict[str, Any], criterion: str) -> str:
    """How far a run was from a criterion when it was stopped."""
    if criterion == "map":
        return f"{run['left']:.2g} units away"
    if criterion == "rest":
        return "still moving"
    gap = run["energy"][-1] / run["minimum"] - 1
    return f"at {_gap(gap)}" if gap + 1 >= _TIMES else f"{_gap(gap)} above"


def _median_of(values: list[tuple[float, bool]]) -> tuple[float, bool]:
    """The median of ratios, and whether it is only a lower bound."""
    ratios = sorted(ratio for ratio, _ in values)
    # Of an even number the median depends on the upper one of the two in the middle as well.
    upper = ratios[len(ratios) // 2]
    return float(np.median(ratios)), any(bound and ratio <= upper for ratio, bound in values)


def _median(name: str, values: list[tuple[float, bool]]) -> str:
    median, bounded = _median_of(values)
    ratios = [ratio for ratio, _ in values]
    most_bounded = any(bound and ratio == max(ratios) for ratio, bound in values)
    return (
        f"{'at least ' if bounded else ''}{median:.0f}x for {name} (least {min(ratios):.0f}x, most "
        f"{'over ' if most_bounded else ''}{max(ratios):.0f}x)"
    )


def _why_slow(cases: list[Measurement]) -> str:
    """What is left to do for runs that were not visibly at their minimum."""
    runs = [d["runs"][m] for d in cases for m in MESH if m in d["runs"]]
    known = [r for r in runs if r["minimum"] is not None]
    away = [r for r in known if r["reached"]["map"] is None]
    if not away:
        return ""
    gaps = [r["energy"][-1] / r["minimum"] - 1 for r in away]
    lefts = [r["left"] for r in away]
    middle = float(np.median(gaps))
    return (
        f"{len(away)} of {len(known)} runs of SLIM and AQP were not visibly at their minimum when "
        f"they were stopped: {min(lefts):.2g} to {max(lefts):.2g} units away, "
        f"{np.median(lefts):.2g} in the median, with an energy that is {percent(middle)} above it "
        f"in the median ({_gap(min(gaps))} to {_gap(max(gaps))}). Limbs that no handle holds "
        "turn at next to no cost in energy, and a first-order method takes them there by small "
        "steps; Newton's method does not mind."
    )


def _flat(cases: list[Measurement]) -> list[str]:
    """Why a run of SLIM never gets near the minimum of its energy."""
    stuck = [
        (d, run)
        for d in cases
        if (run := d["runs"].get("slim"))
        and run["minimum"] is not None
        and run["energy"][-1] >= _TIMES * run["minimum"]
    ]
    if not stuck:
        return []
    each = []
    for d, run in stuck:
        arrays = d["arrays"]
        last = arrays["images_slim"][-2]  # the very last is the minimum's
        density = densities(arrays["mesh"], arrays["mesh_triangles"], last)
        energy = drawing.values_of(run["energy"])[-_LATE:]
        fall = 1 - (energy[-1] / energy[0]) ** (1 / max(len(energy) - 1, 1))
        each.append(
            f"on {d['name']} its triangles reach a density of {density.max():.2g} and the energy "
            f"falls by {percent(fall)} in an iteration at the end"
        )
    return [
        "SLIM's failure: the first steps towards targets on the other side of the shape bring "
        "triangles next to flat, where its proxy weighs them so much, and the largest step without "
        f"an inversion is so short, that it hardly moves any more: {'; '.join(each)}. AQP, whose "
        "start has its targets met already, is spared that.",
        "",
    ]


def _how(cases: list[Measurement]) -> str:
    runs = [d["runs"][m] for d in cases for m in MESH if m in d["runs"]]
    shares = [100 * (r["watching"] - 1) for r in runs if r.get("watching")]
    watched = ""
    if shares:
        middle = float(np.median(shares))
        watched = (
            f" The same iterations took {abs(middle):.0f}% {'longer' if middle > 0 else 'less'} "
            "in the median while they were watched."
        )
    return (
        "How times are taken: of a run's own steps alone, from the identity, with AQP's start and "
        "without compilation. Which iteration meets a criterion is found in a first run, whose "
        "iterates are kept; its time is that of a later run that nothing looks at, with programs "
        "compiled and in memory, for all methods alike."
        f"{watched} Where a criterion was not met the time is that of the first run. Iterations of "
        "ours that are one call to its program, up to four, share its time evenly."
    )
