"""Buttons, messages, and the base of boxes of controls over a deformation."""

from __future__ import annotations

import html
import threading
from collections.abc import Callable, Sequence
from typing import Any

import ipywidgets

from glid_nb._errors import InputError
from glid_nb.session.deformation import Deformation
from glid_nb.widgets.closing import ClosingWidget

REFUSED = "color:#d55e00"
"""The style of why something was refused."""


def paragraph(text: str, style: str = "") -> str:
    """Text as HTML."""
    return f"<div style='line-height:1.4;overflow-wrap:anywhere;{style}'>{html.escape(text)}</div>"


def button(
    label: str, icon: str, tooltip: str, act: Callable[[], None], layout: Any = "auto"
) -> ipywidgets.Button:
    """A button whose click calls ``act``; ``layout`` is its width or a layout that it shares."""
    layout = {"width": layout} if isinstance(layout, str) else layout
    look: dict[str, Any] = {"icon": icon, "tooltip": tooltip, "layout": layout}
    made = ipywidgets.Button(description=label, **look)
    made.on_click(lambda _: act())
    return made


class EditControls(ClosingWidget, ipywidgets.VBox):
    """Controls that show a deformation, change it, and say why a change was refused.

    A subclass makes its controls, then calls this constructor.
    """

    def __init__(
        self, deformation: Deformation, children: Sequence[ipywidgets.Widget], **kwargs: Any
    ) -> None:
        self.deformation = deformation
        """The model that this is a view of."""
        self.refusal = ipywidgets.HTML()
        """Why the last change was refused."""
        # Whether controls follow the model; per thread, as they may be used in another meanwhile.
        self._following = threading.local()
        super().__init__([*children, self.refusal], **kwargs)
        self._follow()
        self._endings = (deformation.observe(self._on_model),)

    def _show(self) -> None:
        """Update the controls."""
        raise NotImplementedError

    def _on_model(self, what: str) -> None:
        if what == "state" and not self.deformation.dragged:
            self._follow()

    def _follow(self) -> None:
        self._following.now = True
        try:
            self._show()
        finally:
            self._following.now = False

    def _act(self, act: Callable[[], None]) -> None:
        """Change the model, unless the control follows it."""
        if getattr(self._following, "now", False):
            return
        try:
            act()
            self.refusal.value = ""
        except InputError as error:
            self.refusal.value = paragraph(str(error), REFUSED)
            self._follow()


class PoseList(EditControls):
    """The poses of a deformation: jump to one, name it, keep, copy and delete.

    Edits belong to the pose that is selected; "Keep pose" keeps it and goes on with a copy.

    Parameters
    ----------
    deformation : Deformation
        The model that the list shows and changes.
    """

    def __init__(self, deformation: Deformation, rows: int = 3, **kwargs: Any) -> None:
        model = deformation

        def acting(label: str, icon: str, tooltip: str, act: Callable[[], None]) -> Any:
            width = "auto" if label else "36px"
            return button(label, icon, tooltip, lambda: self._act(act), width)

        self.list = ipywidgets.Select(rows=rows, layout={"width": "auto", "flex": "1"})
        self.name = ipywidgets.Text(
            placeholder="Name of the pose",
            continuous_update=False,
            layout={"width": "auto", "flex": "1 1 90px"},
        )
        kept = "Keep this pose, go on with a copy"
        self.save = acting("Keep pose", "bookmark", kept, model.save_pose)
        self.duplicate = acting(
            "", "copy", "Duplicate", lambda: model.duplicate_pose(model.state.active)
        )
        self.delete = acting("", "trash", "Delete", lambda: model.delete_pose(model.state.active))
        self.list.observe(self._go, ["index"])
        self.name.observe(self._rename, ["value"])
        bar = ipywidgets.HBox([self.name, self.save, self.duplicate, self.delete])
        super().__init__(deformation, [self.list, bar], **kwargs)
        self.add_class("glid-pose-list")

    def _show(self) -> None:
        state = self.deformation.state
        names = tuple((pose.name, i) for i, pose in enumerate(state.poses))
        if self.list.options != names:
            self.list.options = names
        self.list.index = state.active
        self.name.value = state.current.name
        self.delete.disabled = len(names) == 1

    def _go(self, change: Any) -> None:
        if change["new"] is not None:
            self._act(lambda: self.deformation.go_to_pose(change["new"]))

    def _rename(self, change: Any) -> None:
        model = self.deformation
        if change["new"] != model.state.current.name:
            self._act(lambda: model.rename_pose(model.state.active, change["new"]))
