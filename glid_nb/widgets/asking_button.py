"""Buttons: those that act at once, and those that ask before they replace something."""

from __future__ import annotations

import time
from collections.abc import Callable

import ipywidgets

_DOUBLE_CLICK = 0.5  # seconds


def button(
    label: str, icon: str, tooltip: str, act: Callable[[], None], width: str = "auto"
) -> ipywidgets.Button:
    """A button whose click calls ``act``."""
    made = ipywidgets.Button(
        description=label, icon=icon, tooltip=tooltip, layout=ipywidgets.Layout(width=width)
    )
    made.on_click(lambda _: act())
    return made


class AskingButton(ipywidgets.Button):
    """A button that can ask a question, which a second click answers with yes.

    ``action`` gets whether the answer was yes, and returns what was done.
    """

    def __init__(
        self,
        label: str,
        icon: str,
        tooltip: str,
        action: Callable[[bool], str],
        question: str = "Replace?",
    ) -> None:
        self.action = action
        self._question = question
        self._label = label
        self._asked: float | None = None
        super().__init__(
            description=label,
            icon=icon,
            tooltip=tooltip,
            layout=ipywidgets.Layout(width="auto", flex="0 0 auto"),
        )

    @property
    def answered(self) -> bool:
        """Whether a click now answers yes; the second half of a double click does not."""
        return self._asked is not None and time.monotonic() - self._asked >= _DOUBLE_CLICK

    def ask(self, asking: bool = True) -> None:
        """Show the question, or the label again."""
        self._asked = time.monotonic() if asking else None
        self.description = self._question if asking else self._label
        self.button_style = "warning" if asking else ""
