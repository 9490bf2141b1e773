"""The plots of a solve as a PNG, redrawn quickly."""

from collections.abc import Collection, Sequence
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from glid_nb.certificate import Certificate
from glid_nb.figures.plots import CertificatePlot, EnergyPlot, Plot, StepPlot, TimePlot
from glid_nb.geometry import Cage
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.read import png
from glid_nb.solvers import Iteration
from glid_nb.widgets.monitor import PLOTS

_DPI, _SCALE = 100, 1.5  # pixels of the picture for each of CSS
# CSS pixels. A plot's legend is above it; ticks and the axis's name are below.
_LEFT, _RIGHT, _ABOVE, _BELOW = 44, 8, 31, 32
_BETWEEN_COLUMNS, _BETWEEN_ROWS, _ABOVE_TIMES = 46, 64, 17
_ROWS, _STEPS_AND_TIMES = (0.56, 0.44), (0.68, 0.32)  # shares of the height


class LivePlots:
    """Energy beside steps and times of the iterations, the certificate below them.

    Artists are drawn onto a stored background, which is redrawn only when an axis changes: a few
    milliseconds instead of a hundred. Not for several threads at once. The picture has ``width``
    times ``height`` CSS pixels.
    """

    def __init__(self, cage: Cage, width: int, height: int) -> None:
        self.cage = cage
        figure = Figure(figsize=(width / _DPI, height / _DPI), dpi=_DPI * _SCALE)
        self._canvas = FigureCanvasAgg(figure)
        room = height - _ABOVE - _BELOW - _BETWEEN_ROWS
        rows = figure.add_gridspec(2, 1, height_ratios=_ROWS, hspace=2 * _BETWEEN_ROWS / room)
        rows.update(
            left=_LEFT / width,
            right=1 - _RIGHT / width,
            bottom=_BELOW / height,
            top=1 - _ABOVE / height,
        )
        column = (width - _LEFT - _RIGHT - _BETWEEN_COLUMNS) / 2
        columns = rows[0].subgridspec(1, 2, wspace=_BETWEEN_COLUMNS / column)
        upper = _ROWS[0] * room - _ABOVE_TIMES
        right = columns[1].subgridspec(
            2, 1, height_ratios=_STEPS_AND_TIMES, hspace=2 * _ABOVE_TIMES / upper
        )
        self._energy = EnergyPlot(figure.add_subplot(columns[0]), animated=True)
        self._step = StepPlot(figure.add_subplot(right[0]), animated=True)
        self._time = TimePlot(figure.add_subplot(right[1]), animated=True)
        self._certificate = CertificatePlot(figure.add_subplot(rows[1]), cage, animated=True)
        self._plots: tuple[Plot, ...] = self._energy, self._step, self._time, self._certificate
        for plot, name in zip(self._plots, PLOTS, strict=True):
            plot.entitle(name, *((2.0,) if plot is self._time else ()))
        # Steps and times share the axis below them.
        self._step.axes.set_xlabel("")
        self._step.axes.tick_params(labelbottom=False)
        self._background: Any = None

    def draw(
        self,
        history: Sequence[Iteration],
        certificate: Certificate | None,
        map: HarmonicMap | None = None,
        starts: Collection[int] = (),
        solving: bool = False,
        minimum: float = 0.0,
    ) -> bytes:
        """The plots of these iterations and of this certificate, if there is one, as PNG.

        With a map its sampled sigma_2 is drawn over the certified bound. ``starts`` are the first
        iterations after targets moved, ``solving`` tells whether the last solve goes on,
        ``minimum`` is the least isometric energy there is.
        """
        changed = [
            self._energy.update(history, starts=starts, solving=solving, minimum=minimum),
            self._step.update(history, starts, solving),
            self._time.update(history),
            self._certificate.update(certificate, map),
        ]
        if self._background is None or any(changed):
            self._canvas.draw()
            self._background = self._canvas.copy_from_bbox(self._canvas.figure.bbox)
        else:
            self._canvas.restore_region(self._background)
        for plot in self._plots:
            for artist in plot.artists:
                plot.axes.draw_artist(artist)
        return png(np.asarray(self._canvas.buffer_rgba())[..., :3], compress_level=1)
