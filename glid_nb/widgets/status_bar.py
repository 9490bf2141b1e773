"""The line of the solver's state, and beside it what to try next."""

import html

import ipywidgets

from glid_nb.figures.style import BLUE, GREEN, GREY, ORANGE, VERMILION
from glid_nb.session.status_line import StatusLine

_TONES = {"idle": GREY, "working": BLUE, "good": GREEN, "blocked": ORANGE, "error": VERMILION}


class StatusBar(ipywidgets.HBox):
    """A coloured dot with the status in one line, and a hint.

    The hint is a widget of its own: its elements stay in the page while the status changes, many
    times a second during a solve. So a screen reader says a hint once, and its tooltip stays open.
    """

    def __init__(self) -> None:
        self.said = ipywidgets.HTML()
        """The status. What is proved comes first, if all is well."""
        self.next = ipywidgets.HTML()
        """What to try next, or nothing."""
        super().__init__([self.said, self.next])
        self.add_class("glid-foot")

    def show(self, status: StatusLine, hint: str) -> None:
        """Say this. The page hears only of what has changed."""
        self.said.value = _said(status)
        self.next.value = _next(hint)


def _said(status: StatusLine) -> str:
    text = html.escape(status.text)
    if status.level == "good" and status.proved:
        detail = f'<span class="glid-detail">{text}</span>'
        sentence = f"<b>{html.escape(status.proved)}</b> {detail}"
    else:
        sentence = f"<span>{text}</span>"
    dot = (
        f'<span class="glid-state glid-{status.level}" style="display:inline-block;flex:none;'
        f'width:10px;height:10px;border-radius:5px;background:{_TONES[status.level]}"></span>'
    )
    return f'{dot} <span class="glid-said" title="{text}">{sentence}</span>'


def _next(hint: str) -> str:
    text = html.escape(hint)
    return f'<span class="glid-next" role="status" title="{text}">{text}</span>' if hint else ""
