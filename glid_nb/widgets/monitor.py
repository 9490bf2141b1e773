"""The solver's state, live: a status line and plots."""

from __future__ import annotations

import html
import time
from collections import deque
from typing import TYPE_CHECKING, Any

import ipywidgets
import numpy as np

from glid_nb.certificate import Certificate
from glid_nb.certificate.certify import PanelCertificate
from glid_nb.geometry.panels import Panels
from glid_nb.session.deformation import Deformation
from glid_nb.session.document import certificate_of
from glid_nb.session.edit_state import Frame, Moment
from glid_nb.session.status_line import StatusLine, describe
from glid_nb.session.worker import LatestWins, weakly
from glid_nb.widgets.arguments import check_keywords
from glid_nb.widgets.plots_frame import placeholder

if TYPE_CHECKING:
    from glid_nb.widgets.live_plots import LivePlots

INTERVAL = 0.1
"""Least number of seconds between two drawings of the plots."""

_TONES = {
    "idle": "#7f7f7f",
    "working": "#0072b2",
    "good": "#009e73",
    "blocked": "#e69f00",
    "error": "#d55e00",
}
_RATE_WINDOW = 1.0  # seconds over which frames are counted


class SolverMonitor(ipywidgets.VBox):
    """A status line, and plots of the energy, the iterations and the certificate.

    Parameters
    ----------
    deformation : Deformation
        The model to watch.
    width, height : int
        Size of the plots in CSS pixels.
    plots : bool
        Whether there are plots.
    """

    _complete = False  # ipywidgets also closes a widget whose constructor raised

    def __init__(
        self,
        deformation: Deformation,
        width: int = 500,
        height: int = 340,
        plots: bool = True,
        **kwargs: Any,
    ) -> None:
        check_keywords(type(self), kwargs)
        self.deformation = deformation
        """The model that this is a view of."""
        self.line = ipywidgets.HTML()
        """The status line."""
        self.image = ipywidgets.Image(
            value=placeholder(width, height), format="svg+xml", width=width, height=height
        )
        """The plots; empty axes until the solver has begun."""
        self._size = (width, height)
        self._plots: LivePlots | None = None
        self._frames: deque[float] = deque()
        self._worker: LatestWins[None] = LatestWins(
            weakly(self._update), self, "monitor", interval=INTERVAL
        )
        self._drawn: Any = None
        self._with_plots = plots
        super().__init__([self.line, self.image] if plots else [self.line], **kwargs)
        self.add_class("glid-monitor")
        self.image.add_class("glid-plots")
        self.image.layout.width, self.image.layout.height = f"{width}px", f"{height}px"
        self._stop = deformation.observe(self._on_model)
        self._complete = True
        self._worker.submit(None)

    @property
    def text(self) -> str:
        """The status line as plain text."""
        moment = self.deformation.moment
        return self._words(moment, self._status(moment))

    def refresh(self, timeout: float | None = None) -> bool:
        """Draw what has changed; whether that was done within ``timeout`` seconds."""
        self._worker.submit(None)
        return self._worker.wait(timeout)

    def close(self) -> None:
        """Stop watching; the model lives on."""
        if not self._complete:
            return
        self._stop()
        self._worker.close()
        super().close()

    def _on_model(self, what: str) -> None:
        if what == "frame":
            self._frames.append(time.monotonic())
        if what != "selection":
            self._worker.submit(None)

    def _update(self, *_: Any) -> None:
        moment = self.deformation.moment
        status = self._status(moment)
        self.line.value = (
            f'<div style="display:flex;align-items:center;gap:8px;line-height:1.4">'
            f'<span style="flex:none;width:10px;height:10px;border-radius:5px;'
            f'background:{_TONES[status.level]}"></span>'
            f"<span>{html.escape(self._words(moment, status))}</span></div>"
        )
        # The solver comes to rest after its last frame was announced.
        if moment.busy:
            self._worker.submit(None)
        # The first canvas does not wait for matplotlib.
        if self._with_plots and self.deformation.begun:
            self._draw(moment)

    def _words(self, moment: Moment, status: StatusLine) -> str:
        solution = moment.solution
        solved = solution is not None and solution.ended
        rate = self._rate() if moment.busy and not solved else 0
        return status.text + (f" · {rate} {'frame' if rate == 1 else 'frames'}/s" if rate else "")

    def _status(self, moment: Moment) -> StatusLine:
        return describe(moment)

    def _rate(self) -> int:
        now = time.monotonic()
        while self._frames and self._frames[0] < now - _RATE_WINDOW:
            self._frames.popleft()
        return len(self._frames)

    def _draw(self, moment: Moment) -> None:
        frame, solution = moment.frame, moment.solution
        new = (moment.map, frame, solution, moment.busy)
        if new == self._drawn:
            return
        cage = moment.state.domain.cage
        if self._plots is None or self._plots.cage is not cage:
            from glid_nb.widgets.live_plots import LivePlots  # noqa: PLC0415

            self._plots = LivePlots(cage, *self._size)
        latest = frame if frame is not None else solution
        history, starts = (latest.history, latest.starts) if latest is not None else ((), ())
        if moment.comparison is not None:
            proof, map_ = None, None
        elif moment.busy and frame and frame.panels is not None and len(frame.sigma2_lower):
            proof, map_ = _live_certificate(frame, frame.panels), None
        else:
            proof, map_ = certificate_of(moment.map), moment.map
        picture = self._plots.draw(history, proof, map_, starts, moment.busy)
        with self.image.hold_sync():  # format and value in one message
            self.image.format, self.image.value = "png", picture
        self._drawn = new


def _live_certificate(frame: Frame, panels: Panels) -> Certificate:
    """What the solver has proved of a frame, for the plots."""
    unknown = np.full(len(panels), np.nan)
    proof = PanelCertificate(
        *(panels.start, panels.end, panels.loop, panels.depth, panels.next),
        *(frame.sigma2_lower, unknown, unknown),
    )
    least = float(frame.sigma2_lower.min())
    return Certificate(
        True, least, np.nan, np.nan, (), proof, "hermite", "Certified step by step by the solver."
    )
