"""The list of poses."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import ipywidgets

from glid_nb.session.deformation import Deformation
from glid_nb.session.edit_state import EditError
from glid_nb.widgets.arguments import check_keywords
from glid_nb.widgets.asking_button import button
from glid_nb.widgets.edit_controls import EditControls


class PoseList(EditControls):
    """The poses of a deformation: jump to one, name it, keep, copy and delete.

    Edits belong to the pose that is selected; "Keep pose" keeps it and goes on with a copy.

    Parameters
    ----------
    deformation : Deformation
        The model that the list shows and changes.
    """

    _refusals = EditError

    def __init__(self, deformation: Deformation, rows: int = 3, **kwargs: Any) -> None:
        check_keywords(type(self), kwargs)
        self.list = ipywidgets.Select(rows=rows, layout=ipywidgets.Layout(width="auto", flex="1"))
        self.name = ipywidgets.Text(
            placeholder="Name of the pose",
            continuous_update=False,
            layout=ipywidgets.Layout(width="auto", flex="1 1 90px"),
        )
        model = deformation
        self.save = self._button(
            "Keep pose", "bookmark", "Keep this pose, go on with a copy", model.save_pose
        )
        self.duplicate = self._button(
            "", "copy", "Duplicate", lambda: model.duplicate_pose(model.state.active)
        )
        self.delete = self._button(
            "", "trash", "Delete", lambda: model.delete_pose(model.state.active)
        )
        bar = ipywidgets.HBox([self.name, self.save, self.duplicate, self.delete])
        super().__init__(deformation, [self.list, bar], **kwargs)
        self.add_class("glid-pose-list")
        self._show()
        self.list.observe(self._go, ["index"])
        self.name.observe(self._rename, ["value"])
        self._watch()

    def _button(
        self, label: str, icon: str, tooltip: str, act: Callable[[], None]
    ) -> ipywidgets.Button:
        width = "auto" if label else "36px"
        return button(label, icon, tooltip, lambda: self._act(act), width)

    def _show(self) -> None:
        state = self.deformation.state
        names = tuple((pose.name, i) for i, pose in enumerate(state.poses))
        with self._while_showing():
            if self.list.options != names:
                self.list.options = names
            self.list.index = state.active
            self.name.value = state.current.name
            self.delete.disabled = len(names) == 1

    def _go(self, change: Any) -> None:
        if not self._showing and change["new"] is not None:
            self._act(lambda: self.deformation.go_to_pose(change["new"]))

    def _rename(self, change: Any) -> None:
        model = self.deformation
        if not self._showing and change["new"] != model.state.current.name:
            self._act(lambda: model.rename_pose(model.state.active, change["new"]))
