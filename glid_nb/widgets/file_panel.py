"""The panels that open, save and export."""

import contextlib
import time
from collections.abc import Callable, Mapping
from datetime import datetime
from pathlib import Path
from typing import Any

import ipywidgets
import traitlets

from glid_nb._errors import InputError, plainly
from glid_nb._files import zipped
from glid_nb.export.formats import FORMATS, MOTION_FORMATS
from glid_nb.imaging.read import MAX_SIDE, png
from glid_nb.page import bundle
from glid_nb.session.animation import Animation
from glid_nb.session.document import DocumentError
from glid_nb.session.editor_model import EditorModel, open_document
from glid_nb.session.script import python_code
from glid_nb.widgets import exporting
from glid_nb.widgets.controls import REFUSED, button, heading, paragraph
from glid_nb.widgets.page_widget import PageWidget

_SUFFIX = ".glid"
DOUBLE_CLICK = 0.5  # seconds
_MOTION = "motion"  # prefix of the suffixes of motions in the menu
_MOVING = {".html": ".motion", ".glb": ".motion", ".zip": ".frames"}  # inserted before these
_WIDE = {"width": "auto", "min_width": "0", "flex": "1 1 auto"}
_VIEWS = (("Whole shape", "fit"), ("Original frame", "source"))
_NO_AUTOSAVE = (
    "Your work is kept for the next editor of this picture. Save writes the session to a file."
)
_UNSAVED = (
    "This session is not saved in a file yet. Click again to open the other one without saving, or "
    "save this one under another name first."
)
_KEPT = "Your earlier work on this picture is kept. You last changed it on {:%d %B at %H:%M}."

_Action = Callable[[bool], str | None]  # action(sure) of a button; returns what was done


class _UnsavedError(InputError):
    """Opening a session would discard unsaved work."""


def session_path(text: str) -> Path:
    """The session file that the user named, with its suffix. Raises a DocumentError for a wrong
    name."""
    name = text.strip()
    path = Path(name).expanduser()
    if not path.name or name.endswith(("/", "\\")):
        raise DocumentError("Give the session file a name, such as session.glid")
    if not path.suffix:
        return path.with_suffix(_SUFFIX)
    if path.suffix.lower() != _SUFFIX:
        ending = f"its name must end in {_SUFFIX}, as in {path.stem}{_SUFFIX}"
        raise DocumentError(f"{path.name} cannot be a session file: {ending}")
    return path


def existing_path(text: str) -> Path:
    """The file that the user wants to open: any existing file, else as in `session_path`."""
    path = Path(text.strip()).expanduser()
    return path if path.is_file() else session_path(text)


class Asking:
    """Buttons that may ask for a second click to confirm. ``message`` says why."""

    model: EditorModel
    message: ipywidgets.HTML
    # The button that asks, its label, and the time of the first click.
    _asked: tuple[ipywidgets.Button | None, str, float] = None, "", 0.0

    def _button(
        self, label: str, icon: str, tooltip: str, action: _Action, question: str = "Replace?"
    ) -> ipywidgets.Button:
        """A button whose ``action(sure)`` returns what was done."""

        def click() -> None:
            asked, _, at = self._asked
            # The second click of a double click is no confirmation.
            sure = asked is made and time.monotonic() - at >= DOUBLE_CLICK
            self._show()
            try:
                self._say(action(sure) or "")
            except (exporting.OccupiedError, _UnsavedError) as error:
                self._asked = made, label, time.monotonic()
                made.description, made.button_style = question, "warning"
                self._say(error.plain, REFUSED)
            except (OSError, ValueError) as error:  # messages for the user; other errors are bugs
                self._say(plainly(error), REFUSED)

        made = button(label, icon, tooltip, click)
        return made

    def _check_saved(self, path: Path, sure: bool) -> None:
        if self.model.unsaved and not sure:
            open_document(path)  # a file that cannot be opened needs no confirmation
            raise _UnsavedError(_UNSAVED)

    def _say(self, text: str, style: str = "") -> None:
        self.message.value = paragraph(text, style)

    def _show(self, _: Any = None) -> None:
        """Stop asking for a confirmation."""
        (asked, label, _), self._asked = self._asked, (None, "", 0.0)
        if asked is not None:
            asked.description, asked.button_style = label, ""


class KeptOffer(Asking, ipywidgets.HBox):
    """Offers the kept work of an earlier editor of the picture; hidden if there is none."""

    def __init__(self, model: EditorModel) -> None:
        self.model = model
        look = {"display": "none", "align_items": "center", "flex_flow": "row wrap"}
        super().__init__(layout=look)
        if (path := model.kept) is None:
            return
        try:
            changed = datetime.fromtimestamp(path.stat().st_mtime)
        except OSError:  # the file no longer exists
            return

        def end(act: Callable[[], None], sure: bool = True) -> None:
            self._check_saved(path, sure)
            act()
            self.layout.display = "none"

        self.message = ipywidgets.HTML(layout={"flex": "1 1 240px"})
        self._say(_KEPT.format(changed))
        look = "Restore it", "history", "Continue with it"
        back = self._button(*look, lambda sure: end(model.recover, sure))
        discard = self._button("Discard", "trash", "Delete it", lambda _: end(model.discard_kept))
        self.children, self.layout.display = [self.message, back, discard], "flex"


class OpenPanel(Asking, ipywidgets.VBox):
    """Opens a session file by its name, if there is no picture yet."""

    def __init__(self, model: EditorModel) -> None:
        self.path = ipywidgets.Text(placeholder="session.glid", layout={"width": "280px"})
        """The file, relative to the notebook."""
        look = "Open session", "folder-open", "Continue with a session file"
        self.button = self._button(*look, lambda _: model.load(existing_path(self.path.value)))
        self.message = ipywidgets.HTML()
        row = ipywidgets.HBox([self.path, self.button])
        super().__init__([row, self.message], layout={"padding": "0 0 2em 2em"})


class Clipboard(PageWidget):
    """An invisible widget through which the page copies text and downloads files."""

    _script = traitlets.Unicode(bundle("clipboard")).tag(sync=True)

    def __init__(self) -> None:
        super().__init__(layout={"display": "none"})
        self._number = 0
        self._done: Callable[[bool], None] | None = None
        self.on_msg(self._receive)

    def copy(self, text: str, done: Callable[[bool], None]) -> None:
        """Copy text to the clipboard. Each page calls ``done`` with whether that was allowed."""
        self._number += 1
        self._done = done
        self.send({"number": self._number, "text": text})

    def download(self, name: str, data: bytes) -> None:
        """Let the browser save a file."""
        self._number += 1
        self.send({"number": self._number, "name": name}, [data])

    def _receive(self, _: Any, message: dict[str, Any], _buffers: Any) -> None:
        if (done := self._done) is None or message.get("number") != self._number:
            return
        if copied := bool(message.get("copied")):
            self._done = None  # ignore other pages of this widget, which may have refused
        done(copied)


class FilePanel(Asking, ipywidgets.VBox):
    """Opens and saves sessions, and exports. A second click replaces files that the editor did not
    write."""

    def __init__(self, model: EditorModel, animation: Animation | None = None) -> None:
        self.model, export = model, exporting.MotionExport
        self.motion = None if animation is None else export(model, animation, self._say)
        """Exports the motion; None without a motion."""
        session = model.own_files.session or Path(f"{model.name}{_SUFFIX}")
        self.path = ipywidgets.Text(str(session), placeholder="Name.glid", layout=_WIDE)
        """The session file to save or open, relative to the notebook."""
        self.autosave = ipywidgets.HTML()  # says where changes are saved automatically
        formats = [(one.label, suffix) for suffix, one in FORMATS.items()]
        if self.motion is not None:
            moving = MOTION_FORMATS.items()
            formats += [(f"Motion: {one.label}", f"{_MOTION}{suffix}") for suffix, one in moving]
        self.format = ipywidgets.Dropdown(options=formats, tooltip="What to export", layout=_WIDE)
        height, width = model.document.image.shape[:2]
        self._aspect = height / width
        most, tooltip = MAX_SIDE * width // max(width, height), "Width of the picture in pixels"
        look: Any = {"tooltip": tooltip, "layout": {"width": "76px", "flex": "0 0 auto"}}
        self.width = ipywidgets.BoundedIntText(width, min=1, max=most, **look)
        """Width of an exported picture in pixels; initially that of the original."""
        self.height = ipywidgets.Label(layout={"flex": "0 0 auto"})
        self.view = ipywidgets.Dropdown(options=_VIEWS, tooltip="What it shows", layout=_WIDE)
        """The view of an exported picture, as in `glid_nb.render`."""
        self.picture = _row(_label("Width"), self.width, self.height, self.view)
        self.look = exporting.LookChoice(model, layout=_WIDE)
        """What lies behind the shape, on the canvas and in exports."""
        self.code = ipywidgets.Textarea(rows=9, layout={"width": "auto", "display": "none"})
        """The lines of "Copy as Python"."""
        self.clipboard = Clipboard()
        self.message = ipywidgets.HTML()  # what was done, or why it was refused
        self._add_buttons()
        self._moving = _row(*([] if self.motion is None else [self.motion]))
        super().__init__(
            [
                heading("Session"),
                self.path,
                _row(self.save_button, self.open_button),
                self.autosave,
                heading("Background"),
                self.look,
                heading("Export"),
                self.format,
                self.picture,
                self._moving,
                _row(self.download_button, self.export_button, self.code_button),
                self.clipboard,
                self.message,
                self.code,
            ]
        )
        self.add_class("glid-files")
        for control in (self.path, self.format, self.width):
            control.observe(self._show, ["value"])
        self._choose_last()
        self._show()

    def _choose_last(self) -> None:
        self._remembered: dict[str, Any] = {"format": self.format, "view": self.view}
        if self.motion is not None:
            self._remembered |= {"size": self.motion.size, "rate": self.motion.rate}
        for name, value in exporting.last_export().items():
            with contextlib.suppress(KeyError, traitlets.TraitError):  # unknown or no longer valid
                self._remembered[name].value = value

    def _add_buttons(self) -> None:
        made = self._button
        go_on, beside = "Continue with the session file", "Write the file beside the session file"
        browser, lines = "Save the file through the browser", "Copy the Python code of this map"
        self.save_button = made("Save", "save", "Write the session file", self._save)
        self.open_button = made("Open", "folder-open", go_on, self._open, "Discard?")
        self.export_button = made("Write here", "file-export", beside, self._export)
        self.download_button = made("Download", "download", browser, self._download)
        self.code_button = made("Copy as Python", "code", lines, self._copy)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of an exported picture, with the original's aspect ratio."""
        return self.width.value, max(1, round(self.width.value * self._aspect))

    def follow_autosave(self) -> None:
        """Show the autosave's file after it has changed."""
        self.path.value = str(self.model.autosave_path or self.path.value)
        self._show()

    def _save(self, sure: bool) -> str:
        path = session_path(self.path.value)
        if not sure:
            exporting.check_free(self.model, [path], path)
        self.model.save(path)
        self.path.value = str(path)
        return f"Saved {path.absolute()}"

    def _open(self, sure: bool) -> str:
        path = existing_path(self.path.value)
        self._check_saved(path, sure)
        self.model.load(path)
        return f"Opened {path.absolute()}"

    def show_motion(self) -> None:
        """Select an export of the motion, unless one is selected."""
        if not self._chosen[1] and self.motion is not None:
            self.format.index = len(FORMATS)

    @property
    def _chosen(self) -> tuple[Path, bool]:
        """The file to export, and whether it exports the motion."""
        chosen = str(self.format.value)
        moving, suffix = chosen.startswith(_MOTION), chosen.removeprefix(_MOTION)
        suffix = _MOVING.get(suffix, "") * moving + suffix
        return session_path(self.path.value).with_suffix(suffix), moving

    def _export(self, sure: bool) -> str:
        path, moving = self._chosen
        if not sure:
            names = exporting.written_names(self.model, path, moving=moving)
            exporting.check_free(self.model, tuple(map(path.with_name, names)), path)

        def deliver(files: Mapping[str, bytes]) -> str:
            written = exporting.write(self.model, path, files, replace=True)
            return f"Wrote {exporting.names_of(written)} to {written[0].parent.absolute()}"

        return self._made(deliver)

    def _download(self, _: bool) -> str:
        together = f"{self._chosen[0].name.removesuffix('.json')}.zip"

        def deliver(files: Mapping[str, bytes]) -> str:
            one = len(files) == 1
            name, data = next(iter(files.items())) if one else (together, zipped(files))
            self.clipboard.download(name, data)
            return f"Sent {name} to the browser's downloads"

        return self._made(deliver)

    def _made(self, deliver: Callable[[Mapping[str, bytes]], str]) -> str:
        """Make the chosen files and deliver them. Files of a motion are made in the background."""
        try:
            exporting.remember_export({name: one.value for name, one in self._remembered.items()})
        except OSError as error:  # the export itself does not need this folder
            self.model.not_kept(error)
        path, moving = self._chosen
        if moving and self.motion is not None:
            return self.motion.start(path.name, deliver)
        view: Any = self.view.value
        return deliver(exporting.exported(self.model, path, self.size, view))

    def _copy(self, sure: bool) -> str:
        script = session_path(self.path.value).with_suffix(".py")
        picture = exporting.files_of(script)[1]
        self.model.deformation.finish()
        lines = python_code(self.model.document, str(picture))
        needed, part = "", self.model.deformation.state.edited_part
        made = "These lines make the map" + ("." if part is None else f" of the part {part.name}.")
        if "glid.read_image" in lines:  # not where the cage was edited by hand
            source = {picture.name: png(self.model.document.image)}
            exporting.write(self.model, script, source, replace=sure)
            needed = f" They read {picture}, which was written for them."
        self.code.value = lines
        self.code.layout.display = "flex"

        def done(copied: bool) -> None:
            if copied:
                self._say("The lines are in the clipboard." + needed)
            else:
                self._say("The browser did not allow copying: select the lines." + needed, REFUSED)

        self.clipboard.copy(lines, done)
        return made + needed

    def _show(self, _: Any = None) -> None:
        """Update the controls from the model and each other. Stop asking for a confirmation."""
        super()._show()
        self.picture.layout.display = "flex" if self.format.value == ".png" else "none"
        moving = str(self.format.value).startswith(_MOTION)
        self._moving.layout.display = "flex" if moving else "none"
        self.height.value = f"× {self.size[1]} px"
        self.path.tooltip = self.path.value  # a long path is cut off in its field
        path = self.model.autosave_path
        text = _NO_AUTOSAVE if path is None else f"Saved automatically to {path.absolute()}"
        self.autosave.value = paragraph(text, "color:var(--jp-ui-font-color2,inherit)")


def _label(text: str) -> ipywidgets.Label:
    return ipywidgets.Label(text, layout={"flex": "0 0 auto"})


def _row(*controls: ipywidgets.Widget) -> ipywidgets.HBox:
    return ipywidgets.HBox(controls, layout={"flex_flow": "row wrap"})
