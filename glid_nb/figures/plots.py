"""The plots of a solve: energy, Newton steps, time per iteration, certificate.

Each plot is drawn once and then updated. So the same code serves a printed figure and the editor's
live plots. ``update`` returns whether the axes' limits changed. If not, only ``artists`` must be
drawn again.
"""

import itertools
from collections.abc import Collection, Sequence
from typing import Any, ClassVar

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.ticker import LogFormatterSciNotation, LogLocator, MaxNLocator, NullLocator
from numpy.typing import NDArray

from glid_nb._arrays import Floats
from glid_nb.certificate import Certificate
from glid_nb.certificate.rounding import rounded_down
from glid_nb.figures import style
from glid_nb.figures.style import BLUE, FAINT, GREEN, INK, ORANGE, SKY, SMALL, VERMILION
from glid_nb.geometry import Cage, loop_name
from glid_nb.harmonic import HarmonicMap
from glid_nb.solvers import Iteration

_AXIS_NAME = 13.0  # points from the axis down to its name
_WIDE = 4.0  # inches; on narrower axes a line of text does not fit beside the legend
_LEGEND_HEIGHT = 12.0  # points
_NARROW = 1.3  # inches; above narrower axes the legend does not fit
_DECADES = 12  # most decades of a logarithmic axis
_BELOW_LAST = 1e-3  # the lowest start of an energy's axis, in multiples of the last energy
_AT_MINIMUM = 1e-9  # the smallest distance of an energy from its minimum that is drawn
_DOTTED = 12  # most iterations drawn with dots; a single iteration is visible only as a dot

# Round limits change rarely, and only a change of limits needs a full redraw.
_ROUND = MaxNLocator(1, steps=[1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10], min_n_ticks=1)
_LOG_ENDS = np.outer(10.0 ** np.arange(-16, 300), [1.0, 2.0, 5.0]).ravel()
_ROUND_ITERATIONS = MaxNLocator(3, steps=[1, 2, 5, 10], integer=True)

_CHARACTER = 0.62  # mean width of a character, relative to the font's size
_PEAK = 1.5  # the certificate's axis ends at this multiple of the 90th percentile
_SAMPLES = np.array([0.0, 0.25, 0.5, 0.75, 1.0])  # where sigma_2 is sampled within a panel


class Plot:
    """Axes with a common look, and artists that are updated. Animated artists are blitted."""

    artists: tuple[Artist, ...]  # the artists that ``update`` changes
    _show: Any

    def __init__(self, axes: Axes, animated: bool = False) -> None:
        style.tidy(axes)
        self.axes = axes
        self._animated = animated

    def update(self, *arguments: Any, **named: Any) -> bool:
        """Pass the arguments to ``_show``. Returns whether limits or scale of the axes changed."""
        axes = self.axes
        before = axes.get_xlim(), axes.get_ylim(), axes.get_yscale()
        self._show(*arguments, **named)
        return before != (axes.get_xlim(), axes.get_ylim(), axes.get_yscale())

    def entitle(self, name: str, above: float = _LEGEND_HEIGHT) -> None:
        """Write the plot's name ``above`` points over the axes, by default above its legend."""
        self._beside(name, (0, 1), above, va="bottom", fontweight="bold", in_layout=False)

    def _line(self, color: str, linewidth: float = style.LINE, **look: Any) -> Line2D:
        look = {"color": color, "linewidth": linewidth, "markersize": 2.4, **look}
        return self.axes.plot([], [], animated=self._animated, **look)[0]

    def _area(self, color: str, **look: Any) -> Any:
        look = {"facecolor": color, "linewidth": 0, "animated": self._animated, **look}
        return self.axes.fill([0.0], [0.0], **look)[0]

    def _beside(self, text: str, place: tuple[float, float], above: float, **look: Any) -> Text:
        """Text ``above`` points over a place given in fractions of the axes."""
        offset = {"xytext": (0.0, above), "textcoords": "offset points"}
        look = {"color": INK, "fontsize": SMALL, **offset, **look}
        return self.axes.annotate(text, place, xycoords="axes fraction", **look)

    def _note(self, legend: bool = True) -> Text:
        """Text above the axes at the right: beside the legend on wide axes, else above it."""
        above = _LEGEND_HEIGHT if legend and self._inches < _WIDE else 2.0
        look = {"ha": "right", "va": "bottom", "annotation_clip": False, "in_layout": False}
        return self._beside("", (1, 1), above, animated=self._animated, **look)

    def _legend(self, *lines: Line2D) -> None:
        """Place the legend above the axes; inside a narrow plot that is not animated."""
        place: dict[str, Any] = {"loc": "upper right", "borderaxespad": 0.0}
        if self._animated or self._inches > _NARROW:
            place = {"loc": "lower left", "bbox_to_anchor": (-0.03, 1.0), "borderaxespad": 0.3}
            place |= {"ncols": len(lines), "columnspacing": 0.7}
        self.axes.legend(handles=lines, **place, **style.LEGEND).set_in_layout(False)

    @property
    def _inches(self) -> float:
        return self.axes.get_window_extent().width / self.axes.figure.dpi


class _OverIterations(Plot):
    """Fields of iterations as lines that join the last iterations of solves. Faint dots show the
    other iterations of one field."""

    _looks: ClassVar[dict[str, dict[str, Any]]] = {}
    """The look of each line by the field that it shows, the lowest line first."""
    _dotted: ClassVar[int]  # index of the line with faint dots for the iterations left out

    def __init__(self, axes: Axes, animated: bool = False) -> None:
        super().__init__(axes, animated)
        axes.set_xlabel("iteration", fontsize=SMALL, labelpad=2)
        axes.xaxis.set_major_locator(MaxNLocator(5, integer=True))
        self._lines = [self._line(**look) for look in self._looks.values()]
        if self._lines:
            dots = {"linestyle": "none", "marker": "o", "markersize": 1.6, "markeredgewidth": 0.0}
            color: Any = self._lines[self._dotted].get_color()
            self._within = self._line(color, alpha=0.35, zorder=1.5, **dots)
            self._legend(*reversed(self._lines))
            self.artists = *self._lines, self._within

    def _join(self, x: Floats, values: Floats, starts: Collection[int], solving: bool) -> Floats:
        """Show the lines' (l, n) values over the numbers of iterations. Returns the joined values.

        They are the last values of each finished solve, or all values of a single solve. Solves
        begin at ``starts``.
        """
        begins = np.isin(x[1:], np.fromiter(starts, dtype=float))
        ends = np.append(begins, not solving)[: len(x)]
        ends |= not begins.any()
        for line, joined in zip(self._lines, values[:, ends], strict=True):
            line.set_data(x[ends], joined)
            line.set_marker("o" if len(joined) <= _DOTTED else "")
        self._within.set_data(x[~ends], values[self._dotted, ~ends])
        self._limit_iterations(x)
        return values[:, ends]

    def _limit_iterations(self, x: Floats) -> None:
        first, last = (float(x[0]), float(x[-1])) if len(x) else (0.0, 1.0)
        ticks = _ROUND_ITERATIONS.tick_values(first, last)
        low, high = first if first <= 1 else ticks[0], ticks[-1]
        if first == last:  # centre a single iteration
            low, high = first - 1, first + 1
        room = 0.03 * (high - low)
        self.axes.set_xlim(low - room, high + room)


class EnergyPlot(_OverIterations):
    """Energy after each iteration, on a logarithmic axis: the total and the distortion above
    their minimum, and the targets' part."""

    _looks: ClassVar = {
        "energy_p2p": {"color": ORANGE, "label": "targets", "linewidth": 2.4},
        "energy_distortion": {"color": SKY, "label": "distortion", "linewidth": 2.4},
        "energy": {"color": INK, "label": "total", "linewidth": 0.8},
    }
    _dotted = -1

    def __init__(self, axes: Axes, animated: bool = False) -> None:
        super().__init__(axes, animated)
        axes.set_yscale("log")
        axes.yaxis.set_minor_locator(NullLocator())
        self._text = self._note()
        self.artists = *self.artists, self._text

    def _show(
        self,
        history: Sequence[Iteration],
        starts: Collection[int] = (),
        solving: bool = False,
        minimum: float = 0.0,
    ) -> None:
        """Show iterations. ``minimum`` is the energy of the undeformed shape."""
        rows = _rows(history, *self._looks)
        above, least = rows[1:], _AT_MINIMUM * max(1.0, minimum)
        above[1:] = np.maximum(above[1:] - minimum, least)
        # Use only the lines for the limits. The peaks after moved targets would flatten the lines.
        _, distortion, total = self._join(rows[0], above, starts, solving)
        finite, total = (v[v < _LOG_ENDS[-9]] for v in (np.append(distortion, total), total))
        low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.11, 0.9)
        low = max(low, least, *(_BELOW_LAST * total[-1:]))
        high = max(high, low)
        low, high = _LOG_ENDS[0.97 * low > _LOG_ENDS][-1], _LOG_ENDS[1.03 * high < _LOG_ENDS][0]
        narrow = high < 40 * low
        subs = (1.0, 2.0, 5.0) if narrow else (1.0,)
        self.axes.yaxis.set_major_locator(LogLocator(subs=subs, numticks=6))
        self.axes.yaxis.set_major_formatter("{x:g}" if narrow else LogFormatterSciNotation())
        self.axes.set_ylim(low, high)
        name = f"E = {minimum:.4g} +" if minimum else "E ="
        text = f"{name} {above[-1, -1]:.3g}" if len(history) else "no iterations"
        self._text.set_text(text)


class StepPlot(_OverIterations):
    """Length of each step and the Newton decrement, on a logarithmic axis."""

    _looks: ClassVar = {
        "decrement": {"color": BLUE, "label": "decrement"},
        "step": {"color": ORANGE, "label": "step length"},
    }
    _dotted = 0

    def _show(self, history: Any, starts: Collection[int] = (), solving: bool = False) -> None:
        x, *series = _rows(history, *self._looks)
        values = np.where(np.array(series) > 0, series, np.nan)
        self._join(x, values, starts, solving)
        self.axes.set_yscale("log")
        self.axes.yaxis.set_major_locator(LogLocator(numticks=5))
        self.axes.yaxis.set_minor_locator(NullLocator())
        positive = values[np.isfinite(values)]
        least, most = (positive.min(), positive.max()) if len(positive) else (0.3, 0.3)
        # Show whole decades around the values. If there are too many, leave out the lowest.
        low, high = np.floor(np.log10(least) - 0.1), np.ceil(np.log10(most) + 0.1)
        self.axes.set_ylim(10.0 ** max(low, high - _DECADES), 10.0**high)


class TimePlot(_OverIterations):
    """The time of each iteration, as bars in milliseconds."""

    def __init__(self, axes: Axes, animated: bool = False) -> None:
        super().__init__(axes, animated)
        axes.yaxis.set_major_locator(MaxNLocator(2, min_n_ticks=2))
        axes.set_ylabel("ms", fontsize=SMALL, labelpad=2)
        self._bars = self._area(GREEN, alpha=0.6)
        self._text = self._note(legend=False)
        self.artists = self._bars, self._text

    def _show(self, history: Sequence[Iteration]) -> None:
        x, times = _rows(history, "time")
        times = np.where(np.isfinite(times) & (times > 0), 1e3 * times, 0.0)
        sides, ends = x[:, None] + [-0.4, -0.4, 0.4, 0.4], times[:, None] * [0.0, 1.0, 1.0, 0.0]
        corners = np.stack([sides.ravel(), ends.ravel()], axis=1)
        self._bars.set_xy(corners if len(corners) else [[0.0, 0.0]])
        usual = float(np.median(times)) if len(times) else 0.0
        self._text.set_text(f"{usual:.3g} ms each" if usual else "")
        # A single slow iteration must not make the other bars invisibly low.
        most = min(float(times.max()), 3 * usual) if usual else 1.0
        self.axes.set_ylim(0.0, _rounded_up(1.1 * most))
        self._limit_iterations(x)


class CertificatePlot(Plot):
    """The certified lower bound on sigma_2 along the boundary of a cage, and the sampled sigma_2.

    The loops lie side by side. The final size of the axes decides once which names fit.
    """

    def __init__(self, axes: Axes, cage: Cage, animated: bool = False) -> None:
        super().__init__(axes, animated)
        lengths = [float(np.linalg.norm(np.roll(p, -1, 0) - p, axis=1).sum()) for p in cage.loops]
        self._name_loops(np.concatenate([[0.0], np.cumsum(lengths)]))
        axes.axhline(0.0, color=VERMILION, linewidth=style.LINE, zorder=1)
        self._beside("threshold 0", (0, 0), -_AXIS_NAME, va="top", color=VERMILION)
        self._bound = self._line(BLUE, 0.9, label="certified", zorder=3)
        self._truth = self._line(INK, 0.45, label="σ₂, sampled", zorder=4)
        self._fill = self._area(SKY, alpha=0.35, zorder=2)
        ring = {"marker": "o", "markersize": 3.5, "markerfacecolor": "white"}
        self._least = self._line(VERMILION, linestyle="none", zorder=5, **ring)
        self._text = self._note()
        self._legend(self._truth, self._bound)
        self.artists = self._fill, self._bound, self._truth, self._least, self._text

    def _name_loops(self, starts: Floats) -> None:
        """Name the loops. ``starts`` are the places where they begin, and the boundary's end."""
        axes, end = self.axes, float(starts[-1])
        axes.set_xlim(0.0, end)
        if len(starts) == 2:
            axes.set_xlabel("arc length", fontsize=SMALL, labelpad=2, loc="right")
            axes.xaxis.set_major_locator(MaxNLocator(5))
            return
        for loop, (left, right) in enumerate(itertools.pairwise(starts)):
            if loop % 2:
                axes.axvspan(left, right, color=FAINT, alpha=0.25, linewidth=0, zorder=0)
            if loop:
                axes.axvline(left, color=FAINT, linewidth=style.HAIRLINE, zorder=0)
        character = _CHARACTER * SMALL / 72 / self._inches * end
        places, names = zip(*_loop_names(starts, character), strict=True)
        axes.set_xticks(places, names)
        if any(name[0].isdigit() for name in names):
            middle = (float(starts[1]) / end + 1.0) / 2
            name = "hole" if len(starts) == 3 else "holes"
            self._beside(name, (middle, 0), -_AXIS_NAME, va="top", ha="center")
        axes.tick_params(axis="x", length=0, pad=3)

    def _show(self, certificate: Certificate | None, map: HarmonicMap | None = None) -> None:
        """Show the proved bound. With the map, also its sigma_2, sampled five times per panel."""
        for line in (self._bound, self._truth, self._least):
            line.set_data([], [])
        certified = certificate is not None and certificate.certified
        self._text.set_color(INK if certified else VERMILION)
        if certificate is None:
            self._fill.set_xy([[0.0, 0.0]])
            self._text.set_text("not certified")
            return
        proof = f"σ₂ ≥ {rounded_down(certificate.sigma2_lower)}" if certified else "not certified"
        self._text.set_text(f"{proof}, {_winding(certificate)}")
        panels = certificate.panels
        length, bound = panels.length, np.nan_to_num(panels.sigma2_lower, nan=-1.0)
        # The panels are in order, loop by loop. These are the first panels of the loops.
        first = np.flatnonzero(np.diff(panels.loop, prepend=-1))
        ends = np.cumsum(length)[:, None] - length[:, None] * [1.0, 0.0]
        levels = np.stack([bound, bound], axis=1)
        self._bound.set_data(_with_gaps(ends, first), _with_gaps(levels, first))
        upper = np.stack([ends.ravel(), np.maximum(levels.ravel(), 0.0)], axis=1)
        self._fill.set_xy(np.concatenate([[[0.0, 0.0]], upper, [[ends[-1, 1], 0.0]]]))
        least = int(np.argmin(bound))
        self._least.set_data([ends[least].mean()], [bound[least]])
        seen = levels
        if map is not None:
            points = panels.start[:, None] + (panels.end - panels.start)[:, None] * _SAMPLES
            seen = np.asarray(map.sigma2(points)).reshape(len(bound), -1)
            places = ends[:, :1] + length[:, None] * _SAMPLES
            self._truth.set_data(_with_gaps(places, first), _with_gaps(seen, first))
        # Cut off high peaks, because the distance from 0 matters.
        top = max(0.1, min(float(seen.max()), _PEAK * float(np.quantile(seen, 0.9))))
        bottom, high = min(float(seen.min()), float(bound.min())), _rounded_up(1.2 * top)
        low = max(min(-0.04 * high, -_rounded_up(-1.05 * bottom)), -max(high, 1.0))
        self.axes.set_ylim(low, high)


def _rows(history: Sequence[Iteration], *fields: str) -> Floats:
    """(1 + fields, n) array of the iterations' numbers and of their values of some fields."""
    records = [[getattr(i, field) for field in ("iteration", *fields)] for i in history]
    return np.array(records, dtype=float).reshape(-1, 1 + len(fields)).T


def _rounded_up(value: float) -> float:
    return float(_ROUND.tick_values(0.0, value)[-1]) if value > 0 else 0.0


def _loop_names(starts: Floats, character: float) -> list[tuple[float, str]]:
    """(place along the boundary, name) of the loops between ``starts``.

    Neighbours that are too short for their names share a name. ``character`` is a character's
    width.
    """

    def fits(name: str, loop: int) -> bool:
        return (len(name) + 1) * character <= starts[loop + 1] - starts[loop]

    def group(loop: int) -> int:
        return loop if not loop or fits(str(loop), loop) else -1

    names: list[tuple[float, str]] = []
    for _, loops in itertools.groupby(range(len(starts) - 1), group):
        together = list(loops)
        first, last = together[0], together[-1]
        name = loop_name(first).removesuffix(" loop")
        if first and not (first == last and fits(name, first)):
            name = str(first) if first == last else f"{first}–{last}"
        names.append((float(starts[first] + starts[last + 1]) / 2, name))
    return names


def _winding(certificate: Certificate) -> str:
    each = enumerate(certificate.windings)
    loops = (f"{loop_name(i).removesuffix(' loop')} {turns}" for i, turns in each)
    text = f"winding number {certificate.winding}"
    text += f" ({', '.join(loops)})" if any(certificate.windings) else ""
    return text.replace("-", "\N{MINUS SIGN}")


def _with_gaps(rows: Floats, starts: NDArray[np.intp]) -> Floats:
    """The rows in one array, with a NaN before each row that starts a loop."""
    return np.insert(rows.ravel(), starts[1:] * rows.shape[1], np.nan)
