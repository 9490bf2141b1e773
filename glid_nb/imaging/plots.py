"""The three plots of a solve: energy, Newton steps, certificate.

Each is drawn once and then updated, so the same code makes a page of a paper and a display that
moves while the solver works: ``update`` says whether the axes' limits changed, and ``artists`` are
what has to be drawn anew when they did not.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter
from numpy.typing import NDArray

from glid_nb.certificate import PanelCertificate
from glid_nb.geometry import Cage
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.style import (
    BLUE,
    FAINT,
    HAIRLINE,
    INK,
    LINE,
    SKY,
    SMALL,
    VERMILION,
    tidy,
)

# An energy is drawn on a logarithmic axis when it falls by this factor or more.
_LOG_FROM = 20.0

# Decades that a logarithmic axis shows at most below the largest value.
_DECADES = 12

# Where the true sigma_2 is sampled within each panel.
_SAMPLES = np.array([0.0, 0.25, 0.5, 0.75, 1.0])


class IterationRecord(Protocol):
    """What the plots read of one iteration; `glid_nb.solvers` has more."""

    @property
    def iteration(self) -> int: ...
    @property
    def energy(self) -> float: ...
    @property
    def energy_iso(self) -> float: ...
    @property
    def energy_p2p(self) -> float: ...
    @property
    def step(self) -> float: ...
    @property
    def decrement(self) -> float: ...


class EnergyPlot:
    """Energy after each iteration: the total, the isometric part and the targets' part.

    Parameters
    ----------
    axes : Axes
        Axes to draw into; its look is set here.
    animated : bool
        Whether the lines are left out of a normal draw, to be blitted.
    """

    def __init__(self, axes: Axes, animated: bool = False) -> None:
        self.axes = axes
        tidy(axes)
        axes.set_xlabel("iteration", fontsize=SMALL, labelpad=2)
        axes.xaxis.set_major_locator(MaxNLocator(5, integer=True))
        self._p2p = _line(axes, animated, color=VERMILION, label="targets")
        self._iso = _line(axes, animated, color=BLUE, label="isometric")
        self._total = _line(axes, animated, color=INK, label="total", linestyle=(0, (4, 1.5)))
        _legend(axes, [self._total, self._iso, self._p2p])

    @property
    def artists(self) -> tuple[Artist, ...]:
        """The lines."""
        return self._p2p, self._iso, self._total

    def update(self, history: Sequence[IterationRecord]) -> bool:
        """Show these iterations; True when the limits or the scale of the axes changed."""
        before = _view(self.axes)
        x = np.array([record.iteration for record in history], dtype=float)
        series = {
            self._p2p: np.array([record.energy_p2p for record in history]),
            self._iso: np.array([record.energy_iso for record in history]),
            self._total: np.array([record.energy for record in history]),
        }
        for line, values in series.items():
            line.set_data(x, values)
        values = np.concatenate([*series.values()])
        values = values[np.isfinite(values)]
        total = series[self._total]
        falls = len(total) > 0 and total[0] > _LOG_FROM * total[-1] > 0
        if falls:
            _log_limits(self.axes, values[values > 0])
        else:
            self.axes.set_yscale("linear")
            top = float(values.max(initial=1.0))
            self.axes.set_ylim(0.0, 1.08 * top)
        _iteration_limits(self.axes, x)
        return _view(self.axes) != before


class StepPlot:
    """Length of each step and the Newton decrement, on a logarithmic axis."""

    def __init__(self, axes: Axes, animated: bool = False) -> None:
        self.axes = axes
        tidy(axes)
        axes.set_xlabel("iteration", fontsize=SMALL, labelpad=2)
        axes.xaxis.set_major_locator(MaxNLocator(5, integer=True))
        style: dict[str, Any] = {"marker": "o", "markersize": 2.4}
        self._decrement = _line(axes, animated, color=BLUE, label="Newton decrement", **style)
        self._step = _line(axes, animated, color=VERMILION, label="step length", **style)
        _legend(axes, [self._step, self._decrement])

    @property
    def artists(self) -> tuple[Artist, ...]:
        """The lines."""
        return self._decrement, self._step

    def update(self, history: Sequence[IterationRecord]) -> bool:
        """Show these iterations; True when the limits of the axes changed."""
        before = _view(self.axes)
        x = np.array([record.iteration for record in history], dtype=float)
        values = []
        for line, name in ((self._step, "step"), (self._decrement, "decrement")):
            y = np.array([getattr(record, name) for record in history], dtype=float)
            line.set_data(x, np.where(y > 0, y, np.nan))
            values.append(y[np.isfinite(y) & (y > 0)])
        _log_limits(self.axes, np.concatenate(values))
        _iteration_limits(self.axes, x)
        return _view(self.axes) != before


class CertificatePlot:
    """The certified lower bound on sigma_2 along the boundary, over the sampled truth.

    Parameters
    ----------
    axes : Axes
    cage : Cage
        The domain's boundary; its loops stand side by side.
    animated : bool
        Whether what changes is left out of a normal draw, to be blitted.
    """

    def __init__(self, axes: Axes, cage: Cage, animated: bool = False) -> None:
        self.axes = axes
        tidy(axes)
        lengths = [float(np.linalg.norm(np.roll(p, -1, 0) - p, axis=1).sum()) for p in cage.loops]
        self._starts = np.concatenate([[0.0], np.cumsum(lengths)])
        axes.set_xlim(0.0, float(self._starts[-1]))
        axes.set_xlabel("arc length along the boundary", fontsize=SMALL, labelpad=2)
        axes.xaxis.set_major_locator(MaxNLocator(5))
        for start in self._starts[1:-1]:
            axes.axvline(start, color=FAINT, linewidth=HAIRLINE, zorder=0)
        axes.axhline(0.0, color=VERMILION, linewidth=LINE, zorder=1)
        self._bound = _line(
            axes, animated, color=BLUE, label="certified bound", linewidth=0.9, zorder=3
        )
        self._truth = _line(
            axes, animated, color=INK, label="sampled", linewidth=0.45, zorder=4
        )
        (self._fill,) = axes.fill(
            [0.0], [0.0], facecolor=SKY, alpha=0.35, linewidth=0, animated=animated, zorder=2
        )
        self._least = _line(
            axes, animated, color=VERMILION, linestyle="none", marker="v", markersize=3.5, zorder=5
        )
        _legend(axes, [self._truth, self._bound])

    @property
    def artists(self) -> tuple[Artist, ...]:
        """What ``update`` changes."""
        return self._fill, self._bound, self._truth, self._least

    def update(self, panels: PanelCertificate, map: HarmonicMap | None = None) -> bool:
        """Show these panels; with a map also its sigma_2, sampled five times per panel.

        Returns
        -------
        bool
            Whether the limits of the axes changed.
        """
        before = _view(self.axes)
        length = panels.length
        first = np.flatnonzero(np.diff(panels.loop, prepend=-1))
        begin = np.cumsum(length) - length
        begin = begin - np.repeat(begin[first] - self._starts[panels.loop[first]], _run_lengths(first, len(length)))
        left, right = begin, begin + length
        bound = np.asarray(panels.sigma2_lower, dtype=float)
        gaps = first[1:]
        x = _with_gaps(np.stack([left, right], axis=1), gaps)
        y = _with_gaps(np.stack([bound, bound], axis=1), gaps)
        self._bound.set_data(x, y)
        solid = np.stack([left, right], axis=1).ravel()
        heights = np.repeat(np.maximum(bound, 0.0), 2)
        outline = np.concatenate(
            [[[solid[0], 0.0]], np.stack([solid, heights], axis=1), [[solid[-1], 0.0]]]
        )
        self._fill.set_xy(outline)
        least = int(np.argmin(bound))
        self._least.set_data([(left[least] + right[least]) / 2], [bound[least]])
        top, bottom = float(bound.max()), float(bound.min())
        if map is None:
            self._truth.set_data([], [])
        else:
            along = (panels.end - panels.start)[:, None] * _SAMPLES[:, None]
            points = panels.start[:, None] + along
            sigma2 = map.sigma2(points.reshape(-1, 2)).reshape(len(bound), -1)
            self._truth.set_data(
                _with_gaps(left[:, None] + length[:, None] * _SAMPLES, gaps),
                _with_gaps(sigma2, gaps),
            )
            top, bottom = max(top, float(sigma2.max())), min(bottom, float(sigma2.min()))
        top = max(top, 0.1)
        self.axes.set_ylim(min(-0.04 * top, 1.05 * bottom), 1.05 * top)
        return _view(self.axes) != before


def _line(axes: Axes, animated: bool, **style: Any) -> Line2D:
    (line,) = axes.plot([], [], animated=animated, **({"linewidth": LINE} | style))
    return line


def _legend(axes: Axes, lines: Sequence[Line2D]) -> None:
    axes.legend(
        handles=lines,
        fontsize=SMALL,
        frameon=False,
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0),
        ncols=len(lines),
        handlelength=1.3,
        handletextpad=0.4,
        columnspacing=0.9,
        borderpad=0.1,
        labelcolor=INK,
    )


def _view(axes: Axes) -> tuple[Any, ...]:
    return axes.get_xlim(), axes.get_ylim(), axes.get_yscale()


def _iteration_limits(axes: Axes, x: NDArray[np.float64]) -> None:
    first, last = (float(x[0]), float(x[-1])) if len(x) else (0.0, 1.0)
    room = 0.03 * max(last - first, 1.0)
    axes.set_xlim(first - room, max(last, first + 1) + room)


def _log_limits(axes: Axes, positive: NDArray[np.float64]) -> None:
    """Whole decades around the values, the lowest left out where they span too many."""
    axes.set_yscale("log")
    axes.yaxis.set_major_locator(LogLocator(numticks=6))
    axes.yaxis.set_minor_formatter(NullFormatter())
    if not len(positive):
        axes.set_ylim(0.1, 1.0)
        return
    high = np.ceil(np.log10(positive.max()) + 0.05)
    low = np.floor(np.log10(positive.min()))
    axes.set_ylim(10.0 ** max(low, high - _DECADES), 10.0**high)


def _run_lengths(first: NDArray[np.intp], total: int) -> NDArray[np.intp]:
    return np.diff(first, append=total)


def _with_gaps(rows: NDArray[np.float64], gaps: NDArray[np.intp]) -> NDArray[np.float64]:
    """The rows one after the other, with a NaN before each row in ``gaps``."""
    return np.insert(rows.ravel(), gaps * rows.shape[1], np.nan)
