"""The figures of the page of benchmarks."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter, NullLocator

from glid_nb.figures.style import BLUE, FAINT, GREY, INK, ORANGE, SKY, SMALL, VERMILION
from studies.benchmarks import goals
from studies.benchmarks.breakdown import floor_of
from studies.benchmarks.outcomes import ratio
from studies.benchmarks.results import Results
from studies.benchmarks.solving import same_minimum
from studies.comparisons import drawing

SOLVES, SPEEDUPS, SCALING = "solves.png", "speedups.png", "scaling.png"
"""File names."""

# Room above the highest point, so that none touches the top.
_ROOM = 1.25
_BAR = 0.36
# Axes up to so many decades have ticks at 1, 2 and 5, longer ones at 1 alone; across, long numbers
# stand side by side.
_SHORT_ACROSS, _SHORT_UP = 1.6, 3.0


def draw(results: Results, folder: Path) -> None:
    """Write the figures of what was measured into ``folder``."""
    if results.pairs:
        _draw_iterations(results, folder / SOLVES)
        _draw_ratios(results, folder / SPEEDUPS)
    if results.scaling or results.batches is not None:
        _draw_scaling(results, folder / SCALING)


def _draw_iterations(results: Results, path: Path) -> None:
    """Bars of the measured time per iteration, each with a line at its floor."""
    figure = drawing.figure(9.0, 3.2)
    axes: Any = figure.subplots()
    solves = results.pairs
    place = np.arange(len(solves))
    for i, (mode, color) in enumerate((("paper", SKY), ("default", BLUE))):
        x = place + (i - 0.5) * _BAR
        timings = [pair[i]["per_iteration"] for pair in solves]
        middle = np.array([t["median"] for t in timings])
        spread = np.abs([[t["low"], t["high"]] for t in timings] - middle[:, None]).T
        axes.bar(x, 1e3 * middle, 0.94 * _BAR, color=color, label=f"{mode}, measured")
        axes.errorbar(x, 1e3 * middle, 1e3 * spread, fmt="none", ecolor=INK, elinewidth=0.7)
        floors = [1e3 * floor_of(pair[i]) for pair in solves]
        half = 0.47 * _BAR
        label = "floor of the machine" if i == 0 else None
        axes.hlines(floors, x - half, x + half, color=ORANGE, lw=2, label=label)
    axes.set_xticks(place, [f"{p['name']}\n{p['unknowns']}" for p, _ in solves])
    drawing.label_axes(axes, "shape and unknowns", "ms per iteration")
    axes.legend(fontsize=SMALL, frameon=False, ncols=3)
    axes.set_ylim(top=_ROOM * axes.get_ylim()[1])
    drawing.save(figure, path)


def _draw_ratios(results: Results, path: Path) -> None:
    """Bars of how many times faster ``default`` is, with the two goals as lines."""
    pairs = results.pairs
    figure = drawing.figure(9.0, 2.8)
    axes: Any = figure.subplots()
    place, values = np.arange(len(pairs)), [ratio(*pair) for pair in pairs]
    same = [same_minimum(p["energy"], d["energy"]) for p, d in pairs]
    colors = [BLUE if alike else FAINT for alike in same]
    bars = axes.bar(place, values, 0.6, color=colors)
    plain = {"facecolor": "white", "edgecolor": "none", "pad": 0.8}
    axes.bar_label(bars, fmt="%.1f", fontsize=SMALL, padding=3, bbox=plain)
    # Past the last bar, where the lines' labels have room.
    axes.set_xlim(-0.6, len(pairs) + 0.6)
    for goal, name in ((goals.MEDIAN_RATIO, "median"), (goals.LEAST_RATIO, "least")):
        axes.axhline(goal, color=VERMILION, lw=0.8, ls="--", zorder=0)
        axes.annotate(
            f"goal, {name}: {goal:g}",
            (len(pairs) + 0.55, goal + 0.1),
            fontsize=SMALL,
            ha="right",
            va="bottom",
            bbox=plain,
        )
    middle = float(np.median(values))
    axes.axhline(middle, color=INK, lw=0.8, ls=":", zorder=0, label=f"median: {middle:.1f}")
    if not all(same):
        axes.bar([0], [0], color=FAINT, label="ends at other minima")
    axes.set_xticks(place, [p["name"] for p, _ in pairs])
    axes.set_ylim(top=_ROOM * max(*values, goals.MEDIAN_RATIO))
    drawing.label_axes(axes, "", "paper / default, times faster")
    axes.legend(fontsize=SMALL, frameon=False, loc="upper left", ncols=2)
    drawing.save(figure, path)


def _draw_scaling(results: Results, path: Path) -> None:
    figure = drawing.figure(12.0, 6.0)
    axes: Any = figure.subplots(2, 4)
    steps = (
        ("vertices", "vertices", "cage vertices", 3),
        ("holes", "unknowns", "unknowns, 0 to 50 holes", 3),
        ("panels", "panels", "panels, same basis", 1),
        ("handles", "handles", "handles", 1),
    )
    for ax, (name, x, label, slope) in zip(axes[0], steps, strict=True):
        rows = results.scaling.get(name, [])
        drawing.label_axes(ax, label, "ms per iteration")
        _curve(ax, [r[x] for r in rows], [_scaled(r["step"], 1e3) for r in rows])
        _reference(ax, [r[x] for r in rows], [1e3 * r["step"]["median"] for r in rows], slope)
        _plain(ax)
    _draw_memory(axes[1, 0], results.scaling.get("vertices", []))
    mesh = results.scaling.get("mesh", [])
    for ax, key, label in (
        (axes[1, 1], "triangulate", "triangulate, ms"),
        (axes[1, 2], "evaluate", "evaluate the map, ms"),
    ):
        drawing.label_axes(ax, "display vertices", label)
        x = [r["mesh_vertices"] for r in mesh]
        _curve(ax, x, [_scaled(r[key], 1e3) for r in mesh])
        _reference(ax, x, [1e3 * r[key]["median"] for r in mesh], 1)
        _plain(ax)
    _draw_batches(axes[1, 3], results.batches)
    drawing.save(figure, path)


def _scaled(timing: dict[str, float], factor: float) -> tuple[float, float, float]:
    return factor * timing["median"], factor * timing["low"], factor * timing["high"]


def _curve(
    ax: Axes,
    x: Sequence[float],
    values: Sequence[tuple[float, float, float]],
    color: str = BLUE,
    marker: str = "o",
    label: str | None = None,
) -> None:
    """Medians joined by a line, quartiles as bars."""
    if not values:
        return
    middle, low, high = np.array(values).T
    # The difference of two calls can have a quartile below nothing.
    errors = np.maximum([middle - low, high - middle], 0)
    ax.errorbar(
        x, middle, errors, fmt=f"{marker}-", color=color, ms=4, lw=1.2, elinewidth=0.8, label=label
    )


def _reference(
    ax: Axes,
    x: Sequence[float],
    y: Sequence[float],
    power: int,
    place: Literal["upper left", "lower left"] = "upper left",
) -> None:
    """A dashed line of a given slope that ends at the last point; its legend has a place."""
    if len(x) < 2 or min(y) <= 0:
        return
    ends = np.array([x[0], x[-1]], dtype=float)
    line = y[-1] * (ends / ends[-1]) ** power
    bottom = min(y) / 2
    if line[0] < bottom:
        ends[0] = ends[-1] * (bottom / y[-1]) ** (1 / power)
        line[0] = bottom
    ax.plot(ends, line, "--", color=GREY, lw=0.9, zorder=0, label=f"slope {power}")
    ax.legend(fontsize=SMALL, frameon=False, loc=place)


def _draw_memory(ax: Axes, rows: list[dict[str, Any]]) -> None:
    drawing.label_axes(ax, "cage vertices", "peak memory, GB")
    ax.axhline(goals.MEMORY / 1e9, color=VERMILION, lw=0.8, ls="--", zorder=0)
    if rows:
        x = [r["vertices"] for r in rows]
        ax.annotate(
            f"goal: {goals.MEMORY / 1e9:g} GB",
            (x[0], goals.MEMORY / 1e9),
            xytext=(0, -3),
            textcoords="offset points",
            fontsize=SMALL,
            va="top",
        )
        memory = [r["memory"] / 1e9 for r in rows]
        ax.plot(x, memory, "o-", color=BLUE, ms=4, lw=1.2)
        _reference(ax, x, memory, 2, "lower left")
    _plain(ax)


def _draw_batches(ax: Axes, batches: dict[str, Any] | None) -> None:
    drawing.label_axes(ax, "poses in a batch", "poses per second")
    if batches is None:
        return
    looks = ((BLUE, "o"), (ORANGE, "s"))
    highest = 0.0
    for series, (color, marker) in zip(batches["series"], looks, strict=False):
        values = [_scaled(r["per_second"], 1.0) for r in series["rows"]]
        count = series["devices"]
        label = f"{count} device{'s' if count > 1 else ''}"
        _curve(ax, [r["poses"] for r in series["rows"]], values, color, marker, label)
        highest = max(highest, *(high for _, _, high in values))
    alone = batches["series"][0]["one_by_one"]["median"]
    ax.axhline(alone, color=GREY, lw=1, ls="--", zorder=0, label="one by one")
    ax.set_xscale("log")
    ax.set_ylim(0, _ROOM * max(highest, alone))
    sizes = [r["poses"] for r in batches["series"][0]["rows"]]
    ax.set_xticks(sizes, [str(size) for size in sizes])
    ax.xaxis.set_minor_locator(NullLocator())
    ax.legend(fontsize=SMALL, frameon=False, loc="lower right")


def _plain(ax: Axes) -> None:
    """Logarithmic axes with plain numbers, and room around what is drawn."""
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.margins(0.08)
    for axis, limits, short in (
        (ax.xaxis, ax.get_xlim(), _SHORT_ACROSS),
        (ax.yaxis, ax.get_ylim(), _SHORT_UP),
    ):
        decades = np.log10(limits[1] / limits[0])
        subs = (1.0, 2.0, 5.0) if decades <= short else (1.0,)
        axis.set_major_locator(LogLocator(10, subs, numticks=20))
        axis.set_major_formatter(FuncFormatter(lambda value, _: _number(value)))
        axis.set_minor_formatter(NullFormatter())


def _number(value: float) -> str:
    """``1,000,000`` rather than a power of ten."""
    return f"{value:,.0f}" if value >= 1 else f"{value:g}"
