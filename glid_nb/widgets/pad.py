"""The kernel's side of a pad: it receives the page's events and acknowledges them."""

from collections.abc import Callable, Sequence
from typing import Any

import ipywidgets
import traitlets

from glid_nb.session.model import Observed
from glid_nb.widgets.closing import ClosingWidget
from glid_nb.widgets.page_widget import PageWidget


class Pad(ClosingWidget, PageWidget):
    """A picture on the page that receives pointers and keys: the base class of the two canvases.

    The page (``page/js/pad``) sends ``{"view": v, "events": [...]}``, one batch at a time. It waits
    for ``{"view": v, "ack": n, "refusal": text or None}`` with the number of the last event, so the
    kernel sets the pace; of the moves in between only the latest is sent. An event has a ``type``,
    a number ``seq``, what :class:`~glid_nb.widgets.gestures.Gestures` reads, and, if it is
    ``buffered``, its ``data``.
    """

    picture_size = traitlets.List(traitlets.Int(), []).tag(sync=True)
    """Width and height of the picture in its pixels; empty if nobody asks for pixels."""

    def serve(
        self,
        model: Observed,
        handle: Callable[[Sequence[dict[str, Any]]], str | None],
        busy: Callable[[], bool] = lambda: False,
    ) -> None:
        """Let ``handle`` act on events. If ``busy()`` then, the caller acknowledges them later."""
        self._model, self._handle, self._busy = model, handle, busy
        self._waiting: dict[str, tuple[int, str | None]] = {}
        answer_during_cells(self)
        self.on_msg(self._receive)

    def follow(self, model: Observed) -> None:
        """Act on another model from now on, with the same functions as in `serve`."""
        self._model = model

    def acknowledge(self) -> None:
        """Acknowledge the handled events to the page's views."""
        with self._model.locked():
            waiting, self._waiting = self._waiting, {}
        for view, (number, refusal) in waiting.items():
            self.send({"view": view, "ack": number, "refusal": refusal})

    def _receive(self, _: Any, message: dict[str, Any], buffers: Sequence[Any]) -> None:
        events, refusal = message["events"], None
        rest = iter(buffers)
        for event in events:
            if event.get("buffered"):
                event["data"] = next(rest)
        try:
            refusal = self._handle(events)
        except Exception as error:
            refusal = f"{type(error).__name__}: {error}"  # shown, and logged by the kernel
            raise
        finally:
            with self._model.locked():
                self._waiting[message["view"]] = (events[-1]["seq"], refusal)
                at_rest = not self._busy()
            if at_rest:
                self.acknowledge()


def answer_during_cells(widget: ipywidgets.Widget) -> None:
    """Handle a widget's messages while a cell runs, in the subshell that JupyterLab addresses.

    Since version 7.4, ipykernel redirects them to the main loop, where they would wait for the
    cell.
    """
    comm: Any = widget.comm
    if hasattr(comm, "_reply_subshell_for"):
        comm._reply_subshell_for = lambda _data, addressed: addressed
