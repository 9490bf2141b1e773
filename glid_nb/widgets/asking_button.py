"""A button that asks before it does harm."""

from __future__ import annotations

import time
from collections.abc import Callable

import ipywidgets

_DOUBLE_CLICK = 0.5  # seconds


class AskingButton(ipywidgets.Button):
    """A button that can ask "Replace?", or another question, and is answered by another click.

    Parameters
    ----------
    label, icon, tooltip : str
    action : callable
        What it is for: is told whether the answer was yes, and says what was done.
    question : str
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
        """As given."""
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
        """Whether a click now is the answer yes, and not the second half of a double click."""
        return self._asked is not None and time.monotonic() - self._asked >= _DOUBLE_CLICK

    def ask(self, asking: bool = True) -> None:
        """Ask, or be the button that it was."""
        self._asked = time.monotonic() if asking else None
        self.description = self._question if asking else self._label
        self.button_style = "warning" if asking else ""
