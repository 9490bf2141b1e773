"""The list of a session's parts: their order, their names, and which one is edited."""

import base64
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
from glid_nb.widgets.controls import EditControls, button, heading
from glid_nb.widgets.row_list import Row, RowList, Switch

_THUMBNAIL = 48  # pixels of the longer side


class PartsPanel(EditControls):
    """The parts of a session, the foremost first; hidden if there is only one shape."""

    def __init__(self, model: EditorModel, **kwargs: Any) -> None:
        deformation = model.deformation
        self.model = model
        self._pictures: dict[int, tuple[Domain, str]] = {}  # by the keys of parts
        self.rows = self._made_rows(deformation)
        """All parts. A click edits one."""

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

    def _made_rows(self, model: Deformation) -> RowList:
        def at(key: int, act: Callable[[int], None]) -> None:
            if key in model.state.keys:  # it may have been removed meanwhile
                self._act(lambda: act(model.state.keys.index(key)))

        def set_hidden(key: int, _: Switch, hidden: bool) -> None:
            at(key, lambda i: model.show_part(i, not hidden))

        return RowList(
            "Parts, the foremost first (N: edit the next one)",
            on_choose=lambda keys: at(keys[-1], model.select_part),
            on_set=set_hidden,
            on_rename=lambda key, name: at(key, lambda i: model.rename_part(i, name)),
        )

    def _row(self, part: Part) -> Row:
        known = self._pictures.get(part.key)
        if known is None or known[0] is not part.domain:
            data = base64.b64encode(thumbnail(part)).decode()
            self._pictures[part.key] = known = part.domain, f"data:image/png;base64,{data}"
        switches: dict[Switch, bool] = {"hidden": not part.visible}
        return Row(part.key, part.name, picture=known[1], switches=switches)

    def _add(self, files: Any) -> None:
        if files:
            one, self.add.value = files[0], ()
            self.model.add_picture(Path(one["name"]).stem, bytes(one["content"]))

    def _show(self) -> None:
        state = self.deformation.state
        self.layout.display = None if state.parts else "none"
        chosen = [] if state.edited_part is None else [state.edited_part.key]
        self.rows.show([self._row(part) for part in reversed(state.parts)], chosen)
        self._pictures = {part.key: self._pictures[part.key] for part in state.parts}
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
