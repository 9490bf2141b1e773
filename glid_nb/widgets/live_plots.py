"""The three plots of a solve as a PNG that is quick to draw again."""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image

from glid_nb.certificate import Certificate
from glid_nb.geometry import Cage
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.plots import CertificatePlot, EnergyPlot, IterationRecord, StepPlot

Array = NDArray[Any]

_DPI = 100


class LivePlots:
    """Energy and iterations side by side, the certificate below them.

    What moves is drawn onto a kept background, which is only drawn again when an axis changes: a
    few milliseconds instead of a hundred. Not for several threads at once.

    Parameters
    ----------
    cage : Cage
        The boundary along which the certificate is shown.
    width, height : int
        CSS pixels.
    scale : float
        Pixels of the picture per CSS pixel, for screens of high density.
    """

    def __init__(self, cage: Cage, width: int, height: int, scale: float = 1.5) -> None:
        self.cage = cage
        figure = Figure(figsize=(width / _DPI, height / _DPI), dpi=_DPI * scale)
        self._canvas = FigureCanvasAgg(figure)
        upper, lower = figure.add_gridspec(
            2,
            1,
            left=44 / width,
            right=1 - 8 / width,
            top=1 - 20 / height,
            bottom=32 / height,
            hspace=56 / (height / 2 - 54),
        )
        left, right = upper.subgridspec(1, 2, wspace=0.24)
        self._energy = EnergyPlot(figure.add_subplot(left), animated=True)
        self._step = StepPlot(figure.add_subplot(right), animated=True)
        self._certificate = CertificatePlot(figure.add_subplot(lower), cage, animated=True)
        self._background: Any = None

    @property
    def _plots(self) -> tuple[Any, ...]:
        return self._energy, self._step, self._certificate

    def draw(
        self,
        history: Sequence[IterationRecord],
        certificate: Certificate | None,
        map: HarmonicMap | None = None,
    ) -> bytes:
        """The plots of these iterations and this certificate as PNG; without one nothing is proved.

        With the map its sampled sigma_2 is drawn over the certified bound.
        """
        changed = [self._energy.update(history), self._step.update(history)]
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
