"""Buttons above the canvas."""

from __future__ import annotations

from typing import Any

import ipywidgets

from glid_nb.widgets.canvas import DeformCanvas
from glid_nb.widgets.closing import ClosingWidget
from glid_nb.widgets.controls import button
from glid_nb.widgets.overlays import OVERLAYS

_TOGGLES = (
    ("show_cage", "Cage", "Draw the cage"),
    ("show_offset_cage", "Offset", "Draw the offset cage, which carries the basis"),
    ("show_panels", "Certificate", "Colour the boundary by its certified margin"),
    ("show_source", "Source", "Show the undeformed shape beside the result"),
)


class Toolbar(ClosingWidget, ipywidgets.HBox):
    """Undo, redo, reset, fit, and what the canvas shows."""

    def __init__(self, canvas: DeformCanvas, **kwargs: Any) -> None:
        model = canvas.deformation
        self.canvas = canvas
        """The canvas that the buttons belong to."""
        self.undo = button("", "undo", "Undo (Ctrl+Z)", model.undo, "38px")
        self.redo = button("", "repeat", "Redo (Ctrl+Shift+Z)", model.redo, "38px")
        self.reset = button("", "home", "The undeformed shape (0)", model.reset, "38px")
        self.fit = button("", "expand", "Make everything visible (F)", canvas.fit, "38px")
        self.overlay = ipywidgets.Dropdown(
            options=[(overlay.label, name) for name, overlay in OVERLAYS.items()],
            tooltip="What the shape shows",
            layout={"width": "136px"},
        )
        self.toggles: dict[str, ipywidgets.ToggleButton] = {}
        ipywidgets.link((canvas, "overlay"), (self.overlay, "value"))
        for name, label, tooltip in _TOGGLES:
            self.toggles[name] = toggle = ipywidgets.ToggleButton(
                description=label, tooltip=tooltip, layout={"width": "auto"}
            )
            ipywidgets.link((canvas, name), (toggle, "value"))
        buttons = self.undo, self.redo, self.reset, self.fit
        super().__init__([*buttons, self.overlay, *self.toggles.values()], **kwargs)
        self.add_class("glid-tools")
        self._show("state")
        self._endings = (model.observe(self._show),)

    def _show(self, what: str) -> None:
        if what == "state":
            model = self.canvas.deformation
            self.undo.disabled, self.redo.disabled = not model.can_undo, not model.can_redo
