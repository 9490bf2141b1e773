"""The plots of a solve: energy, Newton steps, time per iteration, certificate.

Each is drawn once and then updated, so the same code serves a printed figure and the editor's live
plots. ``update`` says whether the axes' limits changed; if not, only ``artists`` need drawing.
"""

from __future__ import annotations

import itertools
from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.ticker import LogLocator, MaxNLocator, NullLocator
from numpy.typing import NDArray

from glid_nb.certificate import Certificate
from glid_nb.certificate.rounding import rounded_down
from glid_nb.figures.style import (
    BLUE,
    FAINT,
    GREEN,
    HAIRLINE,
    INK,
    LEGEND,
    LINE,
    SKY,
    SMALL,
    VERMILION,
    tidy,
)
from glid_nb.geometry import Cage, loop_name
from glid_nb.harmonic import HarmonicMap

if TYPE_CHECKING:
    from glid_nb.solvers import Iteration

_AXIS_NAME = 12.0  # points from the axis down to its name
_WIDE = 3.0  # inches; above narrower axes a line of text does not fit beside the legend
_LEGEND_HEIGHT = 12.0  # points
_NARROW = 1.3  # inches; above narrower axes the legend does not fit
_LOG_FROM = 20.0  # an energy that falls by this factor gets a logarithmic axis
_DECADES = 12  # most decades that a logarithmic axis shows
_DOTTED = 12  # most iterations that are drawn with dots; a single one needs its dot to be seen

# Round limits change seldom, and only a change of limits needs a full redraw.
_ROUND = MaxNLocator(1, steps=[1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10], min_n_ticks=1)
_ROUND_ITERATIONS = MaxNLocator(3, steps=[1, 2, 5, 10], integer=True)

_CHARACTER = 0.62  # mean width of a character over the font's size
_PEAK = 1.5  # the certificate's axis ends at this multiple of the 90th percentile
_SAMPLES = np.array([0.0, 0.25, 0.5, 0.75, 1.0])  # where sigma_2 is sampled within a panel

Floats = NDArray[np.float64]


class Plot:
    """Axes, and artists in them that are updated.

    Parameters
    ----------
    axes : Axes
        Axes to draw into; their look is set here.
    animated : bool
        Whether the artists are left out of a normal draw, to be blitted.
    """

    def __init__(self, axes: Axes, animated: bool = False) -> None:
        tidy(axes)
        self.axes = axes
        self._animated = animated

    artists: tuple[Artist, ...]
    """What ``update`` changes."""

    def _line(self, color: str, linewidth: float = LINE, **style: Any) -> Line2D:
        style = {"color": color, "linewidth": linewidth, "animated": self._animated, **style}
        return self.axes.plot([], [], **style)[0]

    def _area(self, color: str, **style: Any) -> Any:
        style = {"facecolor": color, "linewidth": 0, "animated": self._animated, **style}
        return self.axes.fill([0.0], [0.0], **style)[0]

    def _note(self, legend: bool = True) -> Text:
        """Text above the axes at the right: beside the legend if they are wide, else above it."""
        above = _LEGEND_HEIGHT if legend and self._inches < _WIDE else 2.0
        style = {"ha": "right", "va": "bottom", "annotation_clip": False, "in_layout": False}
        return _beside(self.axes, "", (1, 1), above, animated=self._animated, **style)

    def _legend(self, *lines: Line2D) -> None:
        """Above the axes, or inside those of a narrow plot that is not animated."""
        place: dict[str, Any] = {"loc": "upper right", "borderaxespad": 0.0}
        if self._animated or self._inches > _NARROW:
            place = {"loc": "lower left", "bbox_to_anchor": (-0.03, 1.0), "borderaxespad": 0.3}
            place |= {"ncols": len(lines), "columnspacing": 0.7}
        self.axes.legend(handles=lines, **place, **LEGEND).set_in_layout(False)

    @property
    def _inches(self) -> float:
        return self.axes.get_window_extent().width / self.axes.figure.dpi

    def _view(self) -> tuple[Any, ...]:
        return self.axes.get_xlim(), self.axes.get_ylim(), self.axes.get_yscale()


class _OverIterations(Plot):
    def __init__(self, axes: Axes, animated: bool = False) -> None:
        super().__init__(axes, animated)
        axes.set_xlabel("iteration", fontsize=SMALL, labelpad=2)
        axes.xaxis.set_major_locator(MaxNLocator(5, integer=True))

    def _dots(self, color: str) -> Line2D:
        """Faint dots for the iterations that a line leaves out."""
        style = {"linestyle": "none", "marker": "o", "markersize": 1.6, "markeredgewidth": 0.0}
        return self._line(color, alpha=0.35, zorder=1.5, **style)

    def _limit_iterations(self, x: Floats) -> None:
        first, last = (float(x[0]), float(x[-1])) if len(x) else (0.0, 1.0)
        if first == last:  # centre a single iteration
            low, high = first - 1, first + 1
        else:
            ticks = _ROUND_ITERATIONS.tick_values(first, last)
            low, high = first if first <= 1 else ticks[0], ticks[-1]
        room = 0.03 * (high - low)
        self.axes.set_xlim(low - room, high + room)

    def _limit_decades(self, positive: Floats) -> None:
        """Show whole decades around the values, without the lowest if they span too many."""
        axes = self.axes
        axes.set_yscale("log")
        axes.yaxis.set_major_locator(LogLocator(numticks=6))
        axes.yaxis.set_minor_locator(NullLocator())
        if not len(positive):
            axes.set_ylim(0.1, 1.0)
            return
        high = np.ceil(np.log10(positive.max()) + 0.1)
        low = np.floor(np.log10(positive.min()) - 0.1)
        axes.set_ylim(10.0 ** max(low, high - _DECADES), 10.0**high)


class EnergyPlot(_OverIterations):
    """Energy after each iteration: the total, the isometric part and the targets' part."""

    def __init__(self, axes: Axes, animated: bool = False) -> None:
        super().__init__(axes, animated)
        self._p2p = self._line(VERMILION, label="targets")
        self._iso = self._line(BLUE, label="isometric")
        self._total = self._line(INK, label="total", linestyle=(0, (4, 1.5)))
        self._within = self._dots(INK)
        self._text = self._note()
        self._legend(self._total, self._iso, self._p2p)
        self.artists = self._p2p, self._iso, self._total, self._within, self._text

    def update(
        self,
        history: Sequence[Iteration],
        start_energy: float | None = None,
        starts: Collection[int] = (),
        solving: bool = False,
    ) -> bool:
        """Show these iterations; True when the limits or the scale of the axes changed.

        ``start_energy`` is the total before the first of them, drawn at iteration 0. ``starts`` are
        the iterations that began with moved targets, ``solving`` says whether the solver still
        runs: the lines join the last iterations of the finished solves.
        """
        before = self._view()
        records = [(r.iteration, r.energy_p2p, r.energy_iso, r.energy) for r in history]
        if start_energy is not None:
            records.insert(0, (0, np.nan, np.nan, start_energy))
        x, *series = np.array(records, dtype=float).reshape(-1, 4).T
        ends = _ends(x, starts, solving)
        for line, values in zip((self._p2p, self._iso, self._total), series, strict=True):
            _show(line, x[ends], values[ends])
        total = series[-1]
        self._within.set_data(x[~ends], total[~ends])
        self._text.set_text(f"E = {history[-1].energy:.4g}" if len(history) else "no iterations")
        # Only the lines count for the limits: the peaks after moved targets would flatten them.
        total = total[ends]
        values = np.concatenate([y[ends] for y in series])
        values = values[np.isfinite(values)]
        if len(total) and total[0] > _LOG_FROM * total[-1] > 0:
            # The targets' part may fall to 0; the axis need not follow it.
            lowest = 0.1 * float(total[total > 0].min())
            self._limit_decades(values[values > lowest])
        else:
            self.axes.set_yscale("linear")
            self.axes.set_ylim(0.0, _rounded_up(1.2 * float(values.max(initial=1.0))))
        self._limit_iterations(x)
        return self._view() != before


class StepPlot(_OverIterations):
    """Length of each step and the Newton decrement, on a logarithmic axis."""

    def __init__(self, axes: Axes, animated: bool = False) -> None:
        super().__init__(axes, animated)
        self._decrement = self._line(BLUE, label="Newton decrement")
        self._step = self._line(VERMILION, label="step length")
        self._within = self._dots(BLUE)
        self._legend(self._step, self._decrement)
        self.artists = self._decrement, self._step, self._within

    def update(
        self,
        history: Sequence[Iteration],
        starts: Collection[int] = (),
        solving: bool = False,
    ) -> bool:
        """Show these iterations; True when the limits of the axes changed.

        ``starts`` and ``solving`` as in :meth:`EnergyPlot.update`.
        """
        before = self._view()
        records = [(r.iteration, r.step, r.decrement) for r in history]
        x, steps, decrements = np.array(records, dtype=float).reshape(-1, 3).T
        steps, decrements = (np.where(y > 0, y, np.nan) for y in (steps, decrements))
        ends = _ends(x, starts, solving)
        _show(self._step, x[ends], steps[ends])
        _show(self._decrement, x[ends], decrements[ends])
        self._within.set_data(x[~ends], decrements[~ends])
        values = np.concatenate([steps, decrements])
        self._limit_decades(values[np.isfinite(values)])
        self._limit_iterations(x)
        return self._view() != before


class TimePlot(_OverIterations):
    """How long each iteration took, as bars in milliseconds."""

    def __init__(self, axes: Axes, animated: bool = False) -> None:
        super().__init__(axes, animated)
        axes.yaxis.set_major_locator(MaxNLocator(2, min_n_ticks=2))
        axes.set_ylabel("ms", fontsize=SMALL, labelpad=2)
        self._bars = self._area(GREEN, alpha=0.6)
        self._text = self._note(legend=False)
        self.artists = self._bars, self._text

    def update(self, history: Sequence[Iteration]) -> bool:
        """Show these iterations; True when the limits of the axes changed."""
        before = self._view()
        records = [(r.iteration, 1e3 * r.time) for r in history]
        x, times = np.array(records, dtype=float).reshape(-1, 2).T
        times = np.where(np.isfinite(times) & (times > 0), times, 0.0)
        sides = x[:, None] + [-0.4, -0.4, 0.4, 0.4]
        heights = times[:, None] * [0.0, 1.0, 1.0, 0.0]
        corners = np.stack([sides.ravel(), heights.ravel()], axis=1)
        self._bars.set_xy(corners if len(corners) else [[0.0, 0.0]])
        usual = float(np.median(times)) if len(times) else 0.0
        self._text.set_text(f"{usual:.3g} ms per iteration" if usual else "")
        # A single slow iteration must not make the other bars too low to see.
        most = min(float(times.max()), 3 * usual) if usual else 1.0
        self.axes.set_ylim(0.0, _rounded_up(1.1 * most))
        self._limit_iterations(x)
        return self._view() != before


class CertificatePlot(Plot):
    """The certified lower bound on sigma_2 along the boundary, and the sampled sigma_2.

    Parameters
    ----------
    axes : Axes
    cage : Cage
        The domain's boundary. Its loops are drawn side by side, with their names below, or their
        numbers where names do not fit; so the axes must have about their final size.
    animated : bool
        As in `Plot`.
    """

    def __init__(self, axes: Axes, cage: Cage, animated: bool = False) -> None:
        super().__init__(axes, animated)
        lengths = [float(np.linalg.norm(np.roll(p, -1, 0) - p, axis=1).sum()) for p in cage.loops]
        self._loop_starts = np.concatenate([[0.0], np.cumsum(lengths)])
        axes.set_xlim(0.0, float(self._loop_starts[-1]))
        self._name_loops(cage)
        axes.axhline(0.0, color=VERMILION, linewidth=LINE, zorder=1)
        _beside(axes, "threshold 0", (0, 0), -_AXIS_NAME, va="top", color=VERMILION)
        self._bound = self._line(BLUE, 0.9, label="certified bound", zorder=3)
        self._truth = self._line(INK, 0.45, label="σ₂, sampled", zorder=4)
        self._fill = self._area(SKY, alpha=0.35, zorder=2)
        ring = {"marker": "o", "markersize": 3.5, "markerfacecolor": "white"}
        self._least = self._line(VERMILION, linestyle="none", zorder=5, **ring)
        self._text = self._note()
        self._legend(self._truth, self._bound)
        self.artists = self._fill, self._bound, self._truth, self._least, self._text

    def _name_loops(self, cage: Cage) -> None:
        axes = self.axes
        if not cage.n_holes:
            axes.set_xlabel("arc length", fontsize=SMALL, labelpad=2)
            axes.xaxis.set_major_locator(MaxNLocator(5))
            return
        for loop, (start, end) in enumerate(itertools.pairwise(self._loop_starts)):
            if loop % 2:
                axes.axvspan(start, end, color=FAINT, alpha=0.25, linewidth=0, zorder=0)
            if loop:
                axes.axvline(start, color=FAINT, linewidth=HAIRLINE, zorder=0)
        pixels = axes.get_window_extent().width / self._loop_starts[-1]
        character = _CHARACTER * SMALL * axes.figure.dpi / 72
        places, names = zip(*_loop_names(self._loop_starts, character / pixels), strict=True)
        axes.set_xticks(places, names)
        if any(name[0].isdigit() for name in names):
            middle = float(self._loop_starts[1] / self._loop_starts[-1] + 1.0) / 2
            name = "hole" if cage.n_holes == 1 else "holes"
            _beside(axes, name, (middle, 0), -_AXIS_NAME, va="top", ha="center")
        axes.tick_params(axis="x", length=0, pad=3)

    def clear(self) -> None:
        """Show that nothing is certified."""
        for line in (self._bound, self._truth, self._least):
            line.set_data([], [])
        self._fill.set_xy([[0.0, 0.0]])
        self._text.set_text("not certified")
        self._text.set_color(VERMILION)

    def update(self, certificate: Certificate, map: HarmonicMap | None = None) -> bool:
        """Show a certificate; with the map also its sigma_2, sampled five times per panel.

        Returns
        -------
        bool
            Whether the limits of the axes changed.
        """
        before = self._view()
        panels = certificate.panels
        length, bound = panels.length, np.nan_to_num(panels.sigma2_lower, nan=-1.0)
        # The panels of a loop come in order, the first one at the loop's start.
        first = np.flatnonzero(np.diff(panels.loop, prepend=-1))
        left = np.cumsum(length) - length
        shift = self._loop_starts[panels.loop[first]] - left[first]
        left = left + np.repeat(shift, np.diff(first, append=len(length)))
        ends = np.stack([left, left + length], axis=1)
        levels = np.stack([bound, bound], axis=1)
        self._bound.set_data(_with_gaps(ends, first), _with_gaps(levels, first))
        upper = np.stack([ends.ravel(), np.maximum(levels.ravel(), 0.0)], axis=1)
        self._fill.set_xy(np.concatenate([[[ends[0, 0], 0]], upper, [[ends[-1, 1], 0]]]))
        least = int(np.argmin(bound))
        self._least.set_data([ends[least].mean()], [bound[least]])
        certified = certificate.certified
        lower = rounded_down(certificate.sigma2_lower) if certified else ""
        proof = f"σ₂ ≥ {lower}" if certified else "not certified"
        self._text.set_text(f"{proof}, {_winding(certificate)}")
        self._text.set_color(INK if certified else VERMILION)

        seen = levels
        self._truth.set_data([], [])
        if map is not None:
            points = panels.start[:, None] + (panels.end - panels.start)[:, None] * _SAMPLES
            seen = np.asarray(map.sigma2(points)).reshape(len(bound), -1)
            places = left[:, None] + length[:, None] * _SAMPLES
            self._truth.set_data(_with_gaps(places, first), _with_gaps(seen, first))
        # High peaks are cut off: what matters is the distance from 0.
        top = max(0.1, min(float(seen.max()), _PEAK * float(np.quantile(seen, 0.9))))
        bottom = min(float(seen.min()), float(bound.min()))
        high = _rounded_up(1.2 * top)
        low = max(min(-0.04 * high, -_rounded_up(-1.05 * bottom)), -max(high, 1.0))
        self.axes.set_ylim(low, high)
        return self._view() != before


def _ends(x: Floats, starts: Collection[int], solving: bool) -> NDArray[np.bool_]:
    """Which iterations ``x`` end a solve; all of them if they belong to one solve only.

    While the solver runs, the last iteration ends nothing.
    """
    begins = np.isin(x[1:], np.fromiter(starts, dtype=float))
    return np.append(begins, not solving)[: len(x)] if begins.any() else np.ones(len(x), dtype=bool)


def _show(line: Line2D, x: Floats, values: Floats) -> None:
    line.set_data(x, values)
    line.set_marker("o" if len(x) <= _DOTTED else "")
    line.set_markersize(2.4)


def _beside(axes: Axes, text: str, place: tuple[float, float], above: float, **style: Any) -> Text:
    """Text ``above`` points over a place given in fractions of the axes."""
    return axes.annotate(
        text,
        place,
        xycoords="axes fraction",
        xytext=(0.0, above),
        textcoords="offset points",
        fontsize=SMALL,
        **{"color": INK, **style},
    )


def _rounded_up(value: float) -> float:
    return float(_ROUND.tick_values(0.0, value)[-1]) if value > 0 else 0.0


def _loop_names(starts: Floats, character: float) -> list[tuple[float, str]]:
    """(place along the boundary, name) of the loops; neighbours too short for theirs share one.

    ``starts`` are the loops' starts and the boundary's end, ``character`` is a character's width.
    """
    width = np.diff(starts)

    def fits(name: str, loop: int) -> bool:
        return (len(name) + 1) * character <= width[loop]

    names: list[tuple[float, str]] = []
    first = 0
    while first < len(width):
        last = first
        name = loop_name(first).removesuffix(" loop")
        if not fits(name, first) and first:
            name = str(first)
            while not fits(name, first) and last + 1 < len(width):
                if fits(str(last + 1), last + 1):
                    break
                last += 1
            name = name if last == first else f"{first}–{last}"
        names.append((float(starts[first] + starts[last + 1]) / 2, name))
        first = last + 1
    return names


def _winding(certificate: Certificate) -> str:
    """The winding number of ``f_z``, and each loop's own where they are not all 0."""
    text = f"winding number {certificate.winding}"
    if any(certificate.windings):
        each = enumerate(certificate.windings)
        loops = (f"{loop_name(i).removesuffix(' loop')} {turns}" for i, turns in each)
        text += f" ({', '.join(loops)})"
    return text.replace("-", "\N{MINUS SIGN}")


def _with_gaps(rows: Floats, starts: NDArray[np.intp]) -> Floats:
    """The rows in one array, with a NaN before each row that starts a loop."""
    return np.insert(rows.ravel(), starts[1:] * rows.shape[1], np.nan)
