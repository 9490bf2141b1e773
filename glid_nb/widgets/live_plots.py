"""The plots of a solve as a PNG that is redrawn quickly."""

from collections.abc import Collection, Mapping, Sequence
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

_DPI, SCALE = 100, 1.5  # dots per inch; pixels of the picture per CSS pixel


class LivePlots:
    """Plots of the energy, of the steps and times of the iterations beside it, and of the
    certificate below.

    Artists are drawn onto a stored background. The background is redrawn only when an axis changes,
    so drawing takes a few milliseconds instead of a hundred. Not thread-safe.
    """

    def __init__(
        self, cage: Cage, width: int, height: int, places: Mapping[str, tuple[float, ...]]
    ) -> None:
        self.cage = cage
        figure = Figure(figsize=(width / _DPI, height / _DPI), dpi=_DPI * SCALE)
        self._canvas = FigureCanvasAgg(figure)
        energy, steps, times, certificate = (
            figure.add_axes((left / width, 1 - (top + high) / height, wide / width, high / height))
            for left, top, wide, high in places.values()
        )
        self.energy = EnergyPlot(energy, animated=True)
        self.step = StepPlot(steps, animated=True)
        self.time = TimePlot(times, animated=True)
        self.certificate = CertificatePlot(certificate, cage, animated=True)
        self.plots: tuple[Plot, ...] = self.energy, self.step, self.time, self.certificate
        for plot, name in zip(self.plots, places, strict=True):
            plot.entitle(name, *((2.0,) if plot is self.time else ()))
        # Steps and times share the horizontal axis below them.
        self.step.axes.set_xlabel("")
        self.step.axes.tick_params(labelbottom=False)
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
        """Draw these iterations and this certificate, if there is one. Returns a PNG.

        With a map, its sampled sigma_2 is drawn over the certified bound. ``starts`` are the first
        iterations after targets moved. ``solving`` says whether the last solve is still running.
        ``minimum`` is the least possible energy.
        """
        changed = [
            self.energy.update(history, starts=starts, solving=solving, minimum=minimum),
            self.step.update(history, starts, solving),
            self.time.update(history),
            self.certificate.update(certificate, map),
        ]
        if self._background is None or any(changed):
            self._canvas.draw()
            self._background = self._canvas.copy_from_bbox(self._canvas.figure.bbox)
        else:
            self._canvas.restore_region(self._background)
        for plot in self.plots:
            for artist in plot.artists:
                plot.axes.draw_artist(artist)
        return png(np.asarray(self._canvas.buffer_rgba())[..., :3], compress_level=1)
