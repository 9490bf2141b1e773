"""Figures of functions: levels of an energy, the curve of f_z, convergence, any line plot."""

from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.ticker import NullFormatter
from numpy.typing import ArrayLike

from glid_nb._runtime import double_precision
from glid_nb.energies import Energy
from glid_nb.energies.energy import as_energy
from glid_nb.figures import style
from glid_nb.figures.drawing import NotebookFigure, label_levels, log_ticks
from glid_nb.figures.style import BLUE, FAINT, GREEN, GREY, INK, ORANGE, PURPLE, SKY, VERMILION
from glid_nb.geometry import as_points, loop_name, uniform_panels
from glid_nb.harmonic import HarmonicMap
from glid_nb.solvers import Result

# These looks differ in grey too. Vermilion is reserved for folds and thresholds.
_LOOKS = [
    {"color": color, "linestyle": line}
    for line in ("-", (0, (4, 1.5)))
    for color in (BLUE, ORANGE, GREEN, INK, PURPLE, SKY)
]
_WIDTH = 7.4  # inches
_PLOT_WIDTH = 4.6  # narrower, so that its text is legible on a phone
_SAMPLES = 8000  # of the boundary


@double_precision
def energy_levels(*energies: Energy | str) -> NotebookFigure:
    """Level sets of energies' densities over (sigma_1, sigma_2), side by side.

    The energies are values or names, such as `SymmetricDirichlet()` or "amips". The cross marks the
    isometry (1, 1). On and below the line sigma_2 = 0 a map folds. The area above the diagonal is
    empty, because sigma_2 <= sigma_1.
    """
    chosen = [as_energy(energy) for energy in energies]
    if not chosen:
        raise ValueError("there is no energy to draw; give one, such as 'iso'")
    columns = min(len(chosen), 2)
    rows, width = -(-len(chosen) // columns), min(_WIDTH, 3.6 * columns)
    figure = NotebookFigure(width, rows * (0.87 * width / columns + 0.3))
    sigma1, sigma2 = np.meshgrid(np.linspace(0.02, 3, 240), np.linspace(0.0, 2.4, 240) + 0.004)
    x: Any = ((sigma1 + sigma2) / 2) ** 2
    y: Any = ((sigma1 - sigma2) / 2) ** 2
    isometry: Any = np.ones(1), np.zeros(1)
    for place, energy in enumerate(chosen, 1):
        axes = figure.add_subplot(rows, columns, place)
        # An exponential may overflow near a fold, and infinite values would stay white.
        density = np.minimum(energy.density(x, y), 1e200)
        least = float(energy.density(*isometry)[0])
        above = np.where(sigma2 <= sigma1, density - least, np.nan)
        levels = 0.02 * 3.0 ** np.arange(10)
        labels = [_round_nearby(least + levels[i], 0.25 * levels[i]) for i in (2, 4, 6)]
        levels[2:8:2] = np.array(labels) - least
        look: Any = {"levels": levels, "norm": LogNorm(levels[0], levels[-1])}
        axes.contourf(sigma1, sigma2, above, cmap=style.distortion_colors(), extend="both", **look)
        lines = axes.contour(sigma1, sigma2, above, colors=INK, linewidths=0.4, **look)
        label_levels(axes, lines, dict(zip(levels[2:8:2], map("{:g}".format, labels), strict=True)))
        axes.axhspan(-0.4, 0.0, facecolor="white", edgecolor=VERMILION, hatch="////", linewidth=0)
        axes.axhline(0.0, color=VERMILION, linewidth=style.LINE)
        axes.plot([0, 2.4], [0, 2.4], color=GREY, linewidth=0.6)
        axes.plot(1, 1, "+", color=BLUE, markersize=8, markeredgewidth=1.5)
        axes.set(xlim=(0, 3), ylim=(-0.4, 2.4), aspect="equal")
        _named(axes, "σ₁", "σ₂", energy.label)
    return figure


def derivative_curve(map: HarmonicMap, which: Literal["fz", "fzb"] = "fz") -> NotebookFigure:
    """The curve of a derivative along the boundary, loop by loop, around 0.

    Each loop's curve begins at a dot. The legend gives how often the curve winds around 0, computed
    from samples (holes clockwise). For f_z the windings add up to the number of its zeros in the
    domain (Section 8).
    """
    if which not in ("fz", "fzb"):
        raise ValueError(f"which is {which!r}; choose 'fz' or 'fzb'")
    boundary = uniform_panels(map.domain.cage, _SAMPLES)
    values = map.wirtinger(boundary.start)[0 if which == "fz" else 1]
    figure = NotebookFigure(4.6, 4.2)
    axes = figure.add_subplot()
    axes.axhline(0, color=FAINT, linewidth=0.6)
    axes.axvline(0, color=FAINT, linewidth=0.6)
    for loop in range(len(map.domain.cage.loops)):
        curve = values[boundary.loop == loop]
        closed = np.append(curve, curve[0])
        turns = round(float(np.angle(closed[1:] / closed[:-1]).sum()) / (2 * np.pi))
        look = _LOOKS[loop % len(_LOOKS)]
        label = f"{loop_name(loop)}: {turns} turn{'' if abs(turns) == 1 else 's'}"
        axes.plot(*as_points(closed).T, linewidth=style.LINE, label=label, **look)
        axes.plot(*as_points(curve[:1]).T, "o", color=look["color"], markersize=3.5)
    axes.plot(0, 0, "+", color=INK, markersize=12, markeredgewidth=1.5, zorder=4)
    axes.set_aspect("equal", adjustable="datalim")
    name = "$f_z$" if which == "fz" else r"$f_{\overline{z}}$"
    _named(axes, f"Re {name}", f"Im {name}", "")
    figure.legend(loc="outside lower center", ncols=2, **style.LEGEND)
    return figure


def convergence(
    results: Result | Sequence[Result] | Mapping[str, Result],
    against: Literal["iterations", "seconds"] = "iterations",
    gap_to: float | None = None,
) -> NotebookFigure:
    """Total energies of results, on a logarithmic axis, labelled by the results' or methods' names.

    A ring marks the last iteration of each result.

    The horizontal axis shows "iterations" or "seconds" (`Iteration.time`, without compiling). With
    ``gap_to``, for example the lowest known energy, the curves show (E - gap_to) / gap_to.
    """
    if against not in ("iterations", "seconds"):
        raise ValueError(f"against is {against!r}; choose 'iterations' or 'seconds'")
    results = _by_name(results)
    figure = NotebookFigure(_PLOT_WIDTH, 3.2)
    axes = figure.add_subplot()
    for below, (name, result) in zip(range(len(results))[::-1], results.items(), strict=True):
        look = _LOOKS[(len(results) - 1 - below) % len(_LOOKS)]
        # Lower curves are wider, so that all curves are visible where they coincide.
        look = {**look, "linewidth": style.LINE + 0.9 * below, "markersize": 2.5 + 1.2 * below}
        steps = [result.initial, *result.history]
        seconds = np.cumsum([s.time for s in steps])
        x = seconds if against == "seconds" else np.array([s.iteration for s in steps])
        y = np.array([s.energy for s in steps])
        y = y if gap_to is None else (y - gap_to) / gap_to
        mark = "o" if len(x) <= 40 else ""
        shown = np.where(y > 0, y, np.nan)
        axes.plot(x, shown, label=name, marker=mark, **look)
        ring = {"fillstyle": "none", "markeredgewidth": 1.4, "zorder": 3}
        axes.plot(x[-1:], shown[-1:], "o", color=look["color"], markersize=6 + 2.2 * below, **ring)
    axes.set_yscale("log")
    _named(axes, against, "energy" if gap_to is None else "(E − E*) / E*", "")
    axes.legend(**style.LEGEND)
    return figure


def _by_name(results: Any) -> Mapping[str, Result]:
    """Results by name. Results without names get their methods' names, numbered if need be."""
    given = [results] if isinstance(results, Result) else results
    if not isinstance(given, Mapping):
        if not isinstance(given, list | tuple) or not all(isinstance(r, Result) for r in given):
            wanted = "results must be a Result, a list of them, or a dict of them by names"
            raise TypeError(f"{wanted}, not {results!r:.60}")
        labels = [result.method.label for result in given]
        given = {
            label if labels.count(label) == 1 else f"{label} ({i})": result
            for i, (label, result) in enumerate(zip(labels, given, strict=True), 1)
        }
    for name, result in given.items():
        if not isinstance(result, Result):
            raise TypeError(f"results[{name!r}] must be a Result, not {type(result).__name__}")
    return given


def function(
    x: ArrayLike,
    curves: Mapping[str, ArrayLike],
    x_name: str = "",
    y_name: str = "",
    *,
    title: str = "",
    log: Literal["", "x", "y", "xy"] = "",
    dots: bool = False,
    vertical: Mapping[str, float] | None = None,
    horizontal: Mapping[str, float] | None = None,
) -> NotebookFigure:
    """A labelled line plot of functions: for each name (n,) values at the (n,) places ``x``.

    ``log`` names the logarithmic axes. ``dots`` marks the points. Each named value of ``vertical``
    and ``horizontal`` becomes a straight line across the plot.
    """
    figure = NotebookFigure(_PLOT_WIDTH, 3.0)
    axes = figure.add_subplot()
    for (name, y), look in zip(curves.items(), _LOOKS * len(curves), strict=False):
        axes.plot(x, y, linewidth=style.LINE, label=name, marker="o" * dots, markersize=3, **look)
    lines = [(axes.axvline, *line) for line in (vertical or {}).items()]
    lines += [(axes.axhline, *line) for line in (horizontal or {}).items()]
    for (draw, name, at), dash in zip(lines, (":", "--", "-.") * len(lines), strict=False):
        draw(at, color=GREY, linewidth=1.0, linestyle=dash, label=name)
    for axis in log:
        getattr(axes, f"set_{axis}scale")("log")
        low, high = getattr(axes, f"get_{axis}lim")()
        if high < 1000 * low:  # powers of ten would be too few
            ticks = log_ticks(low, high)
            getattr(axes, f"set_{axis}ticks")(ticks, [f"{tick:g}" for tick in ticks])
            getattr(axes, f"{axis}axis").set_minor_formatter(NullFormatter())
    _named(axes, x_name, y_name, title)
    if len(curves) + len(lines) > 1:
        axes.legend(**style.LEGEND)
    return figure


def planes(*panels: Mapping[str, ArrayLike], titles: Sequence[str] = ()) -> NotebookFigure:
    """Curves in complex planes, side by side: each panel has (n,) complex points by name.

    The points of a name are joined by lines; a single number is a dot. Two thin lines cross at 0.
    ``titles`` has one for each panel.
    """
    rows = max((1 + len(curves)) // 2 for curves in panels)  # of the longest legend
    figure = NotebookFigure(2.9 * len(panels), 3.2 + 0.2 * rows)
    grid = figure.subplots(1, len(panels), squeeze=False)[0]
    for axes, curves, title in zip(grid, panels, titles or [""] * len(panels), strict=True):
        axes.axhline(0, color=FAINT, linewidth=0.6)
        axes.axvline(0, color=FAINT, linewidth=0.6)
        for (name, given), look in zip(curves.items(), _LOOKS * len(curves), strict=False):
            points = as_points(np.atleast_1d(np.asarray(given))).T
            is_dot = points.shape[1] == 1
            kind = {"marker": "o", "markersize": 6, "linestyle": ""} if is_dot else {}
            axes.plot(*points, label=name, zorder=3, **{"linewidth": style.LINE, **look, **kind})
        axes.set_aspect("equal")
        axes.locator_params(nbins=5)
        _named(axes, "", "", title)
        if len(curves) > 1:
            below = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.09)}
            axes.legend(ncols=2, **{**style.LEGEND, **below})
    return figure


def _round_nearby(value: float, most: float) -> float:
    rounded = (float(f"{value:.{digits}g}") for digits in range(1, 18))
    return next(number for number in rounded if abs(number - value) <= most)


def _named(axes: Axes, x: str, y: str, title: str) -> None:
    style.tidy(axes)
    axes.set_xlabel(x, fontsize=style.FONT_SIZE, color=INK)
    axes.set_ylabel(y, fontsize=style.FONT_SIZE, color=INK)
    axes.set_title(title, fontsize=style.FONT_SIZE, color=INK, wrap=True)
