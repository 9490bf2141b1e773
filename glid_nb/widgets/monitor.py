"""The solver's state, live: a status line and plots."""

import html
import time
from collections import deque
from typing import Any

import ipywidgets
import traitlets

from glid_nb.certificate import certificate_of
from glid_nb.energies import isometry_energy
from glid_nb.figures.style import FAINT, GREY
from glid_nb.session.deformation import Deformation
from glid_nb.session.edit_state import Moment
from glid_nb.session.first_minute import FirstMinute
from glid_nb.session.status_line import StatusLine, describe
from glid_nb.session.worker import LatestWins, weakly
from glid_nb.widgets.closing import ClosingWidget
from glid_nb.widgets.status_bar import StatusBar

INTERVAL = 0.1  # least number of seconds between two drawings of the plots
REST = 1.0  # seconds without a change before work of low priority is done
_RATE_WINDOW = 1.0  # seconds over which frames are counted
PLOTS = {  # for each plot: what it shows, and the section of the paper
    "Energy": (
        "How far the shape is from undeformed, on a logarithmic axis. Blue: the energy's mean "
        "along the boundary, above its least value, which is 2 for the symmetric Dirichlet energy "
        "(Section 6). Orange: the penalty for pins away from their targets. Dark: the sum (20). "
        "Lines connect the ends of solves."
    ),
    "Steps": (
        "The Newton decrement, which falls to 0 near a minimum, and the share of each Newton step "
        "that was taken; 1 is the whole step. The Hessian is projected if necessary (Section 7). "
        "The line search shortens a step until the energy falls and the map is certified (Section "
        "9.2, Algorithm 1)."
    ),
    "Time": (
        "How long each iteration took: energy, gradient, Hessian, factor, line search and "
        "certificate together. Section 10 compares such times (Figure 9, Table 2)."
    ),
    "Certificate": (
        "The certified lower bound on σ₂ along the boundary (blue), loop by loop, and σ₂ itself at "
        "samples (dark). If the bound is above 0 and the winding number is 0, the map folds "
        "nowhere, also inside (Theorem 4.2). Section 8 derives such bounds; ours are sharper."
    ),
}

# CSS pixels. A plot's legend is above it; ticks and the axis's name are below.
_LEFT, _RIGHT, _ABOVE, _BELOW = 50, 8, 31, 32
_BETWEEN_COLUMNS, _BETWEEN_ROWS, _ABOVE_TIMES = 46, 64, 24
_UPPER_ROW, _STEPS = 0.56, 0.68  # shares of the height


def places(width: int, height: int) -> dict[str, tuple[float, float, float, float]]:
    """Left, top, width and height of each of the `PLOTS` in a picture of this size, CSS pixels."""
    across, room = width - _LEFT - _RIGHT, height - _ABOVE - _BELOW - _BETWEEN_ROWS
    column, upper = (across - _BETWEEN_COLUMNS) / 2, _UPPER_ROW * room
    right, steps = _LEFT + column + _BETWEEN_COLUMNS, _STEPS * (upper - _ABOVE_TIMES)
    return {
        "Energy": (_LEFT, _ABOVE, column, upper),
        "Steps": (right, _ABOVE, column, steps),
        "Time": (right, _ABOVE + steps + _ABOVE_TIMES, column, upper - steps - _ABOVE_TIMES),
        "Certificate": (_LEFT, _ABOVE + upper + _BETWEEN_ROWS, across, room - upper),
    }


class SolverMonitor(ClosingWidget, ipywidgets.VBox):
    """A status line, and plots of a deformation's energy, iterations and certificate.

    The plots are ``width`` by ``height`` CSS pixels. Without ``plots``, there is only the line.
    With ``first_minute``, the line ends with its hint.
    """

    shown = traitlets.Bool(True)  # whether the plots are shown; hidden ones are not drawn
    rested = traitlets.Bool(False)  # whether the model has begun and has been at rest for a while

    def __init__(
        self,
        deformation: Deformation,
        width: int = 500,
        height: int = 340,
        plots: bool = True,
        first_minute: FirstMinute | None = None,
        **kwargs: Any,
    ) -> None:
        self.deformation = deformation  # the model of this view
        self._first_minute = first_minute
        self.line = StatusBar()
        self.verdict = ipywidgets.HTML().add_class("glid-verdict")
        """What is proved, in plain words, then the status line."""
        empty, size = _placeholder(width, height), {"width": width, "height": height}
        self.image = ipywidgets.Image(value=empty, format="svg+xml", **size)
        """The plots; empty axes until the solver has begun."""
        self.plots = ipywidgets.VBox([guide(width, height), self.image])
        """The plots and their explanations."""
        self._size = width, height
        self._plots = None  # `LivePlots`, once they are drawn
        self._frames: deque[float] = deque()
        self._changed = time.monotonic()
        how: Any = {"interval": INTERVAL, "waits": False}  # the thread may be importing matplotlib
        self._worker = LatestWins[None](weakly(self._update), self, "monitor", **how)
        self._drawn: Any = None
        super().__init__([self.line, self.plots] if plots else [self.line], **kwargs)
        self.shown = plots
        self.add_class("glid-monitor")
        self.image.add_class("glid-plots")
        self.image.layout.width, self.image.layout.height = f"{width}px", f"{height}px"
        self.observe(lambda _: self._worker.submit(None), ["shown"])
        self._endings = (deformation.observe(self._on_model), self._worker.close)
        self._worker.submit(None)

    @property
    def text(self) -> str:
        """The status line as plain text."""
        return self._status(self.deformation.moment).text

    def refresh(self, timeout: float | None = None) -> bool:
        """Draw all changes. Returns False if that takes longer than ``timeout`` seconds."""
        self._worker.submit(None)
        return self._worker.wait(timeout)

    def _on_model(self, what: str) -> None:
        self._changed = time.monotonic()
        if what == "frame":
            self._frames.append(self._changed)
        if what not in ("selection", "hand"):
            self._worker.submit(None)

    def _update(self, *_: Any) -> None:
        with self.deformation.locked():
            if self._closed:
                return
            moment = self.deformation.moment
            status = self._status(moment)
            self.line.show(status, self._hint(moment, status))
            self.verdict.value = _verdict(status)
        begun, moves = self.deformation.begun, moment.busy or moment.dragged
        now_rests = begun and not moves and time.monotonic() - self._changed > REST
        self.rested = self.rested or now_rests
        # The solver reports its last frame before it is at rest, so check again later.
        if moment.busy or (begun and not self.rested):
            self._worker.submit(None)
        # The first canvas and the first drag must not wait for matplotlib.
        pulled = moment.frame is not None and moment.frame.history and not moment.dragged
        if self.shown and (self._plots or self.rested or pulled):
            self._draw(moment)

    def _hint(self, moment: Moment, status: StatusLine) -> str:
        """What to try next; empty while something is wrong, which the status says."""
        first_minute = None if status.level in ("blocked", "error") else self._first_minute
        return "" if first_minute is None else first_minute.hint(moment.state)

    def _status(self, moment: Moment) -> StatusLine:
        """The model's status, during a solve with the number of frames per second."""
        status = describe(moment)
        while self._frames and self._frames[0] < time.monotonic() - _RATE_WINDOW:
            self._frames.popleft()
        rate = len(self._frames)
        if not rate or not moment.busy or moment.solved:
            return status
        text = f"{status.text} · {rate} frame{'s' * (rate > 1)}/s"
        return StatusLine(status.level, text, status.proved)

    def _draw(self, moment: Moment) -> None:
        frame, solution = moment.frame, moment.solution
        new = (moment.map, frame, solution, moment.busy)
        if new == self._drawn:
            return
        cage = moment.state.domain.cage
        if self._plots is None or self._plots.cage is not cage:
            from glid_nb.widgets.live_plots import LivePlots  # noqa: PLC0415

            self._plots = LivePlots(cage, *self._size, places(*self._size))
        latest = frame if frame is not None else solution
        history, starts = (latest.history, latest.starts) if latest is not None else ((), ())
        if moment.comparison is not None:
            certificate, map_ = None, None
        elif moment.busy and frame and frame.certificate is not None:
            certificate, map_ = frame.certificate, None
        else:
            certificate, map_ = certificate_of(moment.map), moment.map
        minimum = isometry_energy(moment.state.current.energy)
        picture = self._plots.draw(history, certificate, map_, starts, moment.busy, minimum)
        with self.deformation.locked(), self.image.hold_sync():  # format and value in one message
            if not self._closed:
                self.image.format, self.image.value = "png", picture
        self._drawn = new


def _verdict(status: StatusLine) -> str:
    text = html.escape(status.text)
    if not status.proved:
        return f"<p>{text}</p>"
    return f'<p><b>{html.escape(status.proved)}</b></p><p class="glid-detail">{text}</p>'


def _placeholder(width: int, height: int) -> bytes:
    """Empty axes with their names, as an SVG of this size in CSS pixels."""
    axes = "".join(
        f'<svg x="{left}" y="{top}" width="{wide}" height="{high}" stroke="{FAINT}">'
        '<line y2="100%"/><line y1="100%" x2="100%" y2="100%"/>'
        f'<text x="50%" y="50%" dy="4" fill="{GREY}" stroke="none">{name}</text></svg>'
        for name, (left, top, wide, high) in places(width, height).items()
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
        'font-family="sans-serif" font-size="11" text-anchor="middle">'
        f'<rect width="100%" height="100%" fill="#fff"/>{axes}</svg>'
    ).encode()


_GUIDE = """<style>
.glid-guide { position: relative; height: 0; z-index: 1; font: 12px/1.4 system-ui, sans-serif; }
.glid-guide > * { position: absolute; }
.glid-guide > [open] { z-index: 1; }
.glid-guide summary { width: 16px; border-radius: 8px; list-style: none; text-align: center;
  cursor: pointer; color: var(--jp-ui-font-color2, #616161); font-weight: 600; }
.glid-guide summary:is(:hover, :focus-visible) { color: #fff; background: #0072b2; outline: none; }
.glid-guide p { position: absolute; top: 18px; width: 250px; margin: 0; padding: 8px 10px;
  border-radius: 6px; color: var(--jp-ui-font-color1, #222);
  background: var(--jp-layout-color1, #fff); box-shadow: 0 2px 12px rgba(0, 0, 0, 0.3); }
</style>"""


def guide(width: int, height: int) -> ipywidgets.HTML:
    """An overlay for plots of this size in CSS pixels. It explains each on hover and by a "?"."""

    def about(name: str, left: float, top: float, wide: float, high: float) -> str:
        text, above = PLOTS[name], 15 if name == "Time" else 28
        beside, side = left + 11 + 6.1 * len(name), "left" if left < width / 2 else "right"
        return (
            f'<div title="{text}" style="left:{left:.0f}px;top:{top:.0f}px;width:{wide:.0f}px;'
            f'height:{high:.0f}px"></div>'
            f'<details name="glid-guide" style="left:{beside:.0f}px;top:{top - above:.0f}px">'
            f'<summary title="{text}" aria-label="About the plot: {name}">'
            f'?</summary><p style="{side}:0"><b>{name}.</b> {text}</p></details>'
        )

    parts = "".join(about(name, *place) for name, place in places(width, height).items())
    value = f'{_GUIDE}<div class="glid-guide" style="width:{width}px">{parts}</div>'
    return ipywidgets.HTML(value, layout={"height": "0", "margin": "0", "overflow": "visible"})
