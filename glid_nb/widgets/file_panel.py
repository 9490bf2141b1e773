"""Open, save, export."""

from __future__ import annotations

import html
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, cast

import anywidget
import ipywidgets

from glid_nb.imaging.read import MAX_SIDE
from glid_nb.imaging.render import View
from glid_nb.session.editor_model import EditorModel
from glid_nb.session.script import python_code
from glid_nb.widgets.asking_button import AskingButton
from glid_nb.widgets.bundle import bundle
from glid_nb.widgets.exporting import FORMATS, OccupiedError, export, export_source, files_of
from glid_nb.widgets.open_panel import existing_path, session_path

_LABEL = {"width": "58px", "flex": "0 0 auto"}
_WIDE = {"width": "auto", "min_width": "0", "flex": "1 1 auto"}
_VIEWS = (("Whole shape", "fit"), ("Original frame", "source"))
_NO_AUTOSAVE = "Changes are kept only when you save. Editor(…, path=…) saves by itself."
_UNSAVED = (
    "This session is in no file yet. Click again to open the other one without saving, or save it "
    "under another name first."
)
_REFUSED = "#d55e00"


class _UnsavedError(Exception):
    """A question: opening a session would discard what is in no file."""


class Clipboard(anywidget.AnyWidget):
    """An invisible widget through which the page copies text.

    Browsers allow that only soon after a click or a key.
    """

    _esm = bundle("clipboard/main.js")

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(layout=ipywidgets.Layout(display="none"), **kwargs)
        self._number = 0
        self._done: Callable[[bool], None] | None = None
        self.on_msg(self._receive)

    def copy(self, text: str, done: Callable[[bool], None]) -> None:
        """Put text into the clipboard, then call ``done`` with whether the browser allowed it.

        It may be called again if several pages show this, and not at all if none does or another
        copy is asked for in between.
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


class FilePanel(ipywidgets.VBox):
    """Files of an editor: sessions to open and save, and exports.

    Before a file that the editor neither wrote nor opened is replaced, the button asks "Replace?"
    and waits for a second click.
    """

    def __init__(self, model: EditorModel, **kwargs: Any) -> None:
        self.model = model
        """The model that is saved and replaced."""
        session = model.own_files.session or Path("session.glid")
        self.path = ipywidgets.Text(str(session), placeholder="Name.glid", layout=_WIDE)
        """Where to save, and what to open; relative to the notebook."""
        self.save_button = AskingButton("Save", "save", "Write the session file", self._save)
        self.open_button = AskingButton(
            "Open", "folder-open", "Go on with the session file", self._open, "Discard?"
        )
        self.autosave = ipywidgets.HTML()
        """Where changes are saved automatically."""
        self.format = ipywidgets.Dropdown(
            options=[(label, suffix) for suffix, label in FORMATS.items()],
            tooltip="What to export",
            layout=_WIDE,
        )
        """What to export, by suffix."""
        self.export_button = AskingButton(
            "Export", "download", "Write it beside the session file", self._export
        )
        height, width = model.document.image.shape[:2]
        self._aspect = height / width
        self.width = ipywidgets.BoundedIntText(
            width,
            min=1,
            max=MAX_SIDE * width // max(width, height),
            tooltip="Width of the picture in pixels",
            layout=ipywidgets.Layout(width="76px", flex="0 0 auto"),
        )
        """Width of an exported picture in pixels, at first the original's."""
        self._height = ipywidgets.Label(layout=ipywidgets.Layout(flex="0 0 auto"))
        self.view = ipywidgets.Dropdown(
            options=_VIEWS, tooltip="What the picture shows", layout=_WIDE
        )
        """What an exported picture shows, as in `glid_nb.render`."""
        self.code_button = AskingButton(
            "Copy as Python", "code", "Copy the lines that make this map", self._copy
        )
        self.code = ipywidgets.Textarea(
            rows=9, layout=ipywidgets.Layout(width="auto", display="none")
        )
        """The lines of "Copy as Python"."""
        self.clipboard = Clipboard()
        """Where they are copied to."""
        self.message = ipywidgets.HTML()
        """What was done, or why it was not."""
        self._buttons = (self.save_button, self.open_button, self.export_button, self.code_button)
        self._picture = _row("Picture", self.width, self._height, self.view)
        super().__init__(
            [
                _row("Session", self.path, self.save_button, self.open_button),
                _row("", self.autosave),
                _row("Export", self.format, self.export_button),
                self._picture,
                _row("", self.code_button, self.clipboard),
                self.message,
                self.code,
            ],
            **kwargs,
        )
        self.add_class("glid-files")
        for button in self._buttons:
            button.on_click(self._on_click)
        for control in (self.path, self.format):
            control.observe(self._forget_question, ["value"])
        for control in (self.format, self.width):
            control.observe(self._show, ["value"])
        self._show()

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of an exported picture, of the original's proportions."""
        return self.width.value, max(1, round(self.width.value * self._aspect))

    def follow_autosave(self) -> None:
        """Show the file that is saved automatically, after it has changed."""
        self.path.value = str(self.model.autosave_path or self.path.value)
        self._show()

    def _save(self, sure: bool) -> str:
        path = session_path(self.path.value)
        strangers = self.model.own_files.strangers([path], path)
        if strangers and not sure:
            raise OccupiedError(strangers)
        self.model.save(path)
        self.path.value = str(path)
        return f"Saved {path.absolute()}"

    def _open(self, sure: bool) -> str:
        path = existing_path(self.path.value)
        if self.model.unsaved and not sure:
            raise _UnsavedError(_UNSAVED)
        self.model.load(path)
        return f"Opened {path.absolute()}"

    def _export(self, sure: bool) -> str:
        path = session_path(self.path.value).with_suffix(str(self.format.value))
        strangers = self.model.own_files.strangers(files_of(path), path)
        if strangers and not sure:
            raise OccupiedError(strangers)
        view = cast(View, self.view.value)
        files = export(self.model, path, self.size, view, replace=True)
        return f"Wrote {_listed([file.name for file in files])} to {path.absolute().parent}"

    def _copy(self, sure: bool) -> str:
        script = session_path(self.path.value).with_suffix(".py")
        picture = files_of(script)[1]
        lines = python_code(self.model.document, str(picture))
        reads = "glid.read_image" in lines  # not where the cage was edited by hand
        if reads:
            export_source(self.model, script, replace=sure)
        self.code.value = lines
        self.code.layout.display = "flex"
        needed = f" They read {picture}, which was written for them." if reads else ""

        def done(copied: bool) -> None:
            if copied:
                self._say("The lines are in the clipboard." + needed)
            else:
                self._say("The browser did not allow copying: select the lines." + needed, _REFUSED)

        self.clipboard.copy(lines, done)
        return "These lines make the map." + needed

    def _on_click(self, button: AskingButton) -> None:
        sure = button.answered
        self._forget_question()
        try:
            self._say(button.action(sure))
        except OccupiedError as question:
            button.ask()
            names = _listed([path.name for path in question.paths])
            verb = "is" if len(question.paths) == 1 else "are"
            folder = question.paths[0].absolute().parent
            self._say(
                f"{names} {verb} in {folder} already, not written by this editor. "
                "Click again to replace, or choose another name.",
                _REFUSED,
            )
        except _UnsavedError as question:
            button.ask()
            self._say(str(question), _REFUSED)
        except (OSError, ValueError) as error:  # refusals for the user; anything else is a bug
            self._say(str(error), _REFUSED)
        self._show()

    def _forget_question(self, _: Any = None) -> None:
        for button in self._buttons:
            button.ask(False)

    def _say(self, text: str, color: str = "inherit") -> None:
        self.message.value = (
            f"<div style='line-height:1.4;overflow-wrap:anywhere;color:{color}'>"
            f"{html.escape(text)}</div>"
        )

    def _show(self, _: Any = None) -> None:
        """Update what depends on the model and on other controls."""
        self._picture.layout.display = "flex" if self.format.value == ".png" else "none"
        self._height.value = f"× {self.size[1]} px"
        path = self.model.autosave_path
        text = _NO_AUTOSAVE if path is None else f"Saved by itself to {path.absolute()}"
        self.autosave.value = (
            "<div style='line-height:1.4;overflow-wrap:anywhere;"
            f"color:var(--jp-ui-font-color2,inherit)'>{html.escape(text)}</div>"
        )


def _row(label: str, *controls: ipywidgets.Widget) -> ipywidgets.HBox:
    return ipywidgets.HBox([ipywidgets.Label(label, layout=_LABEL), *controls])


def _listed(names: Sequence[str]) -> str:
    return " and ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)
