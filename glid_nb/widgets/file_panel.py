"""Open, save, export."""

from __future__ import annotations

import html
from collections.abc import Callable
from pathlib import Path
from typing import Any

import ipywidgets

from glid_nb.session.editor_model import EditorModel
from glid_nb.session.script import python_code
from glid_nb.widgets.exporting import FORMATS, export

_WIDE = {"width": "auto", "flex": "1 1 auto"}


class FilePanel(ipywidgets.VBox):
    """Files of an editor: sessions to open and save, and exports.

    Parameters
    ----------
    model : EditorModel
    """

    def __init__(self, model: EditorModel, **kwargs: Any) -> None:
        self.model = model
        """The model that is saved and replaced."""
        self.path = ipywidgets.Text("session.glid", placeholder="File name", layout=_WIDE)
        """Where to save, and what to open; relative to the notebook."""
        self.save_button = _button("Save", "save", "Write the session file", self._save)
        self.open_button = _button("Open", "folder-open", "Go on with the session file", self._open)
        self.message = ipywidgets.HTML()
        """What was done, or why it was not."""
        self.format = ipywidgets.Dropdown(
            options=[(label, suffix) for suffix, label in FORMATS.items()],
            tooltip="What to export",
            layout=_WIDE,
        )
        self.export_button = _button(
            "Export", "download", "Write it beside the session", self._export
        )
        self.code_button = _button(
            "Copy as Python", "code", "The lines that make this map", self._code
        )
        self.code = ipywidgets.Textarea(
            rows=9, layout=ipywidgets.Layout(width="auto", display="none")
        )
        """The lines of "Copy as Python", to be selected and copied."""
        rows = [
            [ipywidgets.Label("Session"), self.path, self.save_button, self.open_button],
            [ipywidgets.Label("Export"), self.format, self.export_button],
            [self.code_button],
        ]
        for row in rows[:2]:
            row[0].layout.width = "58px"
        super().__init__([*map(ipywidgets.HBox, rows), self.code, self.message], **kwargs)
        self.add_class("glid-files")

    def _save(self) -> str:
        path = Path(self.path.value)
        self.model.save(path)
        return f"Saved {path.resolve()}"

    def _open(self) -> str:
        path = Path(self.path.value)
        self.model.load(path)
        return f"Opened {path.resolve()}"

    def _export(self) -> str:
        path = Path(self.path.value).with_suffix(str(self.format.value))
        files = export(self.model, path)
        return "Wrote " + ", ".join(str(file.resolve()) for file in files)

    def _code(self) -> str:
        self.code.value = python_code(self.model.document)
        self.code.layout.display = "flex"
        return "Select the lines and copy them."

    def _act(self, action: Callable[[], str]) -> None:
        try:
            text, color = action(), "inherit"
        except (OSError, ValueError) as error:  # refusals for the user; anything else is a bug
            text, color = str(error), "#d55e00"
        self.message.value = f"<span style='color:{color}'>{html.escape(text)}</span>"


def _button(label: str, icon: str, tooltip: str, action: Callable[[], str]) -> ipywidgets.Button:
    button = ipywidgets.Button(
        description=label, icon=icon, tooltip=tooltip, layout=ipywidgets.Layout(width="auto")
    )
    panel = action.__self__  # type: ignore[attr-defined]
    button.on_click(lambda _: panel._act(action))
    return button
