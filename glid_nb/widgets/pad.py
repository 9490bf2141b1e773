"""The kernel's end of a pad: events of the page come in, acknowledged once they have been seen."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol

import anywidget
import ipywidgets

from glid_nb.session.observed import Observed

Event = dict[str, Any]


class Hand(Protocol):
    """What events mean."""

    def handle(self, events: Sequence[Event]) -> str | None:
        """Act on events in order; returns why something was refused, None for nothing."""


class Pad(anywidget.AnyWidget):
    """A picture on the page that takes pointers and keys: the base of the two canvases.

    The page (``js/pad``) sends ``{"view": v, "events": [...]}``, one batch at a time, and waits for
    ``{"view": v, "ack": n, "refusal": text or None}`` with the number of the last event. So the
    kernel sets the pace, and of moves that came meanwhile only the latest is sent. Each event has a
    ``type``, its number ``seq``, and of a pointer the place ``x``, ``y`` and further what
    :class:`~glid_nb.widgets.gestures.Gestures` reads; where it is ``buffered``, its ``data``.
    """

    def serve(self, model: Observed, hand: Hand, busy: Callable[[], bool] = lambda: False) -> None:
        """Have a hand act on what the page sends.

        Parameters
        ----------
        model : Observed
            Locked while something is done for the page.
        hand : Hand
            What acts.
        busy : callable
            Whether the answer is not yet there when the events have been handled: then
            :meth:`acknowledge` is to be called when it is.
        """
        self._model, self._hand, self._busy = model, hand, busy
        self._waiting: dict[str, tuple[int, str | None]] = {}
        answer_during_cells(self)
        self.on_msg(self._receive)

    def acknowledge(self) -> None:
        """Tell the page's views that what they sent was dealt with."""
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
            refusal = self._hand.handle(events)
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
    """Have a widget's messages handled where its page sends them: in a thread beside the cells.

    JupyterLab addresses a widget's messages to a subshell, a thread of the kernel that runs no
    cells. ipykernel from 7.4 on redirects them to the loop that last sent something to the page,
    which for a widget that a cell made is the main one, and there they wait until the cell that
    runs has ended. A widget that calls this must be ready for handlers in another thread. Where the
    kernel has no such redirection, or the page no subshell, nothing changes.
    """
    comm: Any = widget.comm
    if hasattr(comm, "_reply_subshell_for"):
        comm._reply_subshell_for = _as_addressed


def _as_addressed(_data: Any, addressed: str | None) -> str | None:
    return addressed
