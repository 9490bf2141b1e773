"""The list of a session's parts: their order, their names, and which one is edited."""

import io
from collections.abc import Callable
from pathlib import Path
from typing import Any

import ipywidgets
import numpy as np
from PIL import Image

from glid_nb.geometry import Domain
from glid_nb.imaging import PixelFrame
from glid_nb.session.deformation import Deformation
from glid_nb.session.edit_state import Part
from glid_nb.session.editor_model import EditorModel
from glid_nb.widgets.closing import close_with_parts
from glid_nb.widgets.controls import EditControls, button, heading

_THUMBNAIL = 48  # pixels of the longer side
_SHOWN, _HIDDEN = "eye", "eye-slash"


class _Row(ipywidgets.HBox):
    """A part in the list. ``act(action)`` runs an action of the user."""

    def __init__(
        self, model: Deformation, key: int, act: Callable[[Callable[[], None]], None]
    ) -> None:
        def index() -> int:
            return model.state.keys.index(key)

        def show(shown: bool) -> None:
            act(lambda: model.show_part(index(), shown))

        self._domain: Domain | None = None
        # Without the padding, which would cut the icon off.
        narrow = {"width": "34px", "padding": "0"}
        self.eye = ipywidgets.ToggleButton(value=True, icon=_SHOWN, layout=narrow)
        """Whether the part is shown."""
        self.eye.observe(lambda change: show(change["new"]), ["value"])
        self.picture = ipywidgets.Image(layout={"width": "30px", "height": "30px"})
        self.picture.add_class("glid-thumbnail")
        self.name = button(
            "",
            "",
            "Edit this part (N: the next one)",
            lambda: act(lambda: model.select_part(index())),
            {"flex": "1 1 auto", "width": "auto", "min_width": "0"},
        )
        """A click edits the part."""
        super().__init__([self.eye, self.picture, self.name])

    def show(self, part: Part, edited: bool) -> None:
        """Show the present state of the part."""
        self.eye.value = part.visible
        self.eye.icon = _SHOWN if part.visible else _HIDDEN
        self.eye.tooltip = f"{'Hide' if part.visible else 'Show'} {part.name}"
        self.name.description = part.name
        self.name.button_style = "primary" if edited else ""
        if part.domain is not self._domain:
            self._domain = part.domain
            self.picture.value = thumbnail(part)


class PartsPanel(EditControls):
    """The parts of a session, the foremost first; hidden if there is only one shape."""

    def __init__(self, model: EditorModel, **kwargs: Any) -> None:
        deformation = model.deformation
        self.model = model
        self._rows: dict[int, _Row] = {}
        self.rows = ipywidgets.VBox()

        def acting(icon: str, tooltip: str, act: Callable[[int], None]) -> ipywidgets.Button:
            def run() -> None:
                self._act(lambda: act(deformation.state.part))

            return button("", icon, tooltip, run, "34px")

        self.front = acting(
            "arrow-up", "Bring the part forward", lambda i: deformation.move_part(i, i + 1)
        )
        self.back = acting(
            "arrow-down", "Send the part back", lambda i: deformation.move_part(i, i - 1)
        )
        self.remove = acting("trash", "Remove the part", deformation.remove_part)
        self.name = ipywidgets.Text(
            placeholder="name",
            tooltip="Name of the edited part",
            continuous_update=False,
            layout={"width": "auto"},
        )
        """The name of the edited part."""
        self.add = ipywidgets.FileUpload(
            accept="image/*",
            description="Add",
            tooltip="Add a picture as a part in front",
            layout={"width": "auto", "flex": "0 0 auto"},
        )
        buttons = ipywidgets.HBox([self.front, self.back, self.remove, self.add])
        children = [heading("Parts"), self.rows, self.name, buttons]
        super().__init__(deformation, children, **kwargs)
        self.add_class("glid-parts")
        self._bind(self.name, lambda name: deformation.rename_part(deformation.state.part, name))
        self._bind(self.add, self._add)

    def _add(self, files: Any) -> None:
        if files:
            one, self.add.value = files[0], ()
            self.model.add_picture(Path(one["name"]).stem, bytes(one["content"]))

    def _show(self) -> None:
        state = self.deformation.state
        self.layout.display = None if state.parts else "none"
        present = {part.key for part in state.parts}
        gone = [self._rows.pop(key) for key in self._rows.keys() - present]
        for part in state.parts:
            if part.key not in self._rows:
                self._rows[part.key] = _Row(self.deformation, part.key, self._act)
            self._rows[part.key].show(part, part is state.edited_part)
        rows = tuple(self._rows[part.key] for part in reversed(state.parts))
        if self.rows.children != rows:
            self.rows.children = rows
        close_with_parts(*gone)
        if state.edited_part is not None:
            self.name.value = state.edited_part.name
        count = len(state.parts)
        self.front.disabled = state.part >= count - 1
        self.back.disabled = state.part == 0
        self.remove.disabled = count < 2


def thumbnail(part: Part) -> bytes:
    """The undeformed part as a small PNG."""
    height, width = part.image.shape[:2]
    pixels = PixelFrame(width, height).to_pixel(part.domain.cage.exterior)
    low = np.clip(np.floor(pixels.min(axis=0)), 0, (width - 1, height - 1)).astype(int)
    high = np.clip(np.ceil(pixels.max(axis=0)), low + 1, (width, height)).astype(int)
    picture = Image.fromarray(part.image[low[1] : high[1], low[0] : high[0]])
    picture.thumbnail((_THUMBNAIL, _THUMBNAIL))
    buffer = io.BytesIO()
    picture.save(buffer, "PNG")
    return buffer.getvalue()
