"""The plots of a solve as a PNG, redrawn quickly."""

from __future__ import annotations

import io
from collections.abc import Collection, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image

from glid_nb.certificate import Certificate
from glid_nb.figures.plots import CertificatePlot, EnergyPlot, StepPlot, TimePlot
from glid_nb.geometry import Cage
from glid_nb.harmonic import HarmonicMap
from glid_nb.solvers import Iteration
from glid_nb.widgets.plots_frame import plot_boxes

Array = NDArray[Any]

_DPI = 100


class LivePlots:
    """Energy beside steps and times of the iterations, the certificate below them.

    Artists are drawn onto a stored background, which is redrawn only when an axis changes: a few
    milliseconds instead of a hundred. Not for several threads at once. The picture has ``width``
    times ``height`` CSS pixels, with ``scale`` pixels for each.
    """

    def __init__(self, cage: Cage, width: int, height: int, scale: float = 1.5) -> None:
        self.cage = cage
        figure = Figure(figsize=(width / _DPI, height / _DPI), dpi=_DPI * scale)
        self._canvas = FigureCanvasAgg(figure)
        energy, steps, times, certificate = (
            figure.add_axes(
                (
                    box.x / width,
                    1 - (box.y + box.height) / height,
                    box.width / width,
                    box.height / height,
                )
            )
            for box in plot_boxes(width, height)
        )
        self._energy = EnergyPlot(energy, animated=True)
        self._step = StepPlot(steps, animated=True)
        # They share the axis below them.
        steps.set_xlabel("")
        steps.tick_params(labelbottom=False)
        self._time = TimePlot(times, animated=True)
        self._certificate = CertificatePlot(certificate, cage, animated=True)
        self._background: Any = None

    @property
    def _plots(self) -> tuple[Any, ...]:
        return self._energy, self._step, self._time, self._certificate

    def draw(
        self,
        history: Sequence[Iteration],
        certificate: Certificate | None,
        map: HarmonicMap | None = None,
        starts: Collection[int] = (),
        solving: bool = False,
    ) -> bytes:
        """The plots of these iterations and of this certificate, if there is one, as PNG.

        With a map its sampled sigma_2 is drawn over the certified bound. ``starts`` are the first
        iterations after targets moved, ``solving`` tells whether the last solve goes on.
        """
        changed = [
            self._energy.update(history, starts=starts, solving=solving),
            self._step.update(history, starts, solving),
            self._time.update(history),
        ]
        if certificate is None:
            self._certificate.clear()
        else:
            changed.append(self._certificate.update(certificate, map))
        if self._background is None or any(changed):
            self._canvas.draw()
            self._background = self._canvas.copy_from_bbox(self._canvas.figure.bbox)
        else:
            self._canvas.restore_region(self._background)
        for plot in self._plots:
            axes: Axes = plot.axes
            for artist in plot.artists:
                axes.draw_artist(artist)
        pixels = np.asarray(self._canvas.buffer_rgba())
        buffer = io.BytesIO()
        Image.fromarray(pixels).convert("RGB").save(buffer, format="PNG", compress_level=1)
        return buffer.getvalue()
