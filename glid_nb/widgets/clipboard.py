"""The clipboard of who looks at the page."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import anywidget
import ipywidgets

from glid_nb.widgets.bundle import bundle


class Clipboard(anywidget.AnyWidget):
    """Has no look of its own; where it is displayed, the page can be asked to copy text.

    Browsers allow that only soon after a click or a key, so it is to answer one.
    """

    _esm = bundle("clipboard/main.js")

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(layout=ipywidgets.Layout(display="none"), **kwargs)
        self._number = 0
        self._done: Callable[[bool], None] | None = None
        self.on_msg(self._receive)

    def copy(self, text: str, done: Callable[[bool], None]) -> None:
        """Put text into the clipboard; then ``done`` is told whether the browser let it.

        It is called once, or twice where a page that refused is followed by one that did not, and
        not at all where no page shows this, or when another copy was asked for meanwhile.
        """
        self._number += 1
        self._done = done
        self.send({"number": self._number, "text": text})

    def _receive(self, _: Any, message: dict[str, Any], _buffers: Any) -> None:
        done = self._done
        if done is None or message.get("number") != self._number:
            return
        copied = bool(message.get("copied"))
        if copied:
            self._done = None  # other pages that show this may have refused
        done(copied)
