"""The list of poses."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import ipywidgets

from glid_nb.session.deformation import Deformation
from glid_nb.widgets.controls import EditControls, button


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
