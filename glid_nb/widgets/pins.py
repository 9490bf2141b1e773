"""The pins of a deformation as numbers to read and type."""

from functools import partial
from typing import Any

import ipywidgets

from glid_nb.session.deformation import Deformation
from glid_nb.solvers.pose import DEEPEST
from glid_nb.widgets.controls import EditControls, button


class PinBar(EditControls):
    """The list of pins; target and depth of the one selected last; what to do with all selected.

    Parameters
    ----------
    deformation : Deformation
        The model that the bar shows and changes.
    """

    def __init__(self, deformation: Deformation, **kwargs: Any) -> None:
        model = deformation
        self.list = ipywidgets.Dropdown(
            options=[("No pin", -1)], tooltip="The selected pin", layout={"width": "92px"}
        )
        look: dict[str, Any] = {
            "layout": ipywidgets.Layout(width="100px"),
            "style": {"description_width": "initial"},
        }
        self.x = ipywidgets.FloatText(description="x", step=0.1, tooltip="Target", **look)
        self.y = ipywidgets.FloatText(description="y", step=0.1, tooltip="Target", **look)
        self.depth = ipywidgets.BoundedFloatText(
            description="Depth",
            tooltip="Where parts overlap, those near pins of greater depth are in front",
            min=-DEEPEST,
            max=DEEPEST,
            **look,
        )

        def acting(icon: str, tooltip: str, act: Any) -> ipywidgets.Button:
            return button("", icon, tooltip, lambda: self._act(act), narrow)

        narrow = ipywidgets.Layout(width="38px")
        self.back, self.front = (
            acting(icon, tip, lambda steps=steps: model.bring_forward(model.selection, steps))
            for icon, tip, steps in (
                ("level-down", "Send selected pins, and what is around them, back (Page Down)", -1),
                ("level-up", "Bring selected pins forward (Page Up)", 1),
            )
        )
        self.release = acting(
            "unlink",
            "Remove selected pins and keep the shape until the next change",
            lambda: model.remove_handles(*model.selection, keep_shape=True),
        )
        self.list.observe(self._select, ["value"])
        for field in (self.x, self.y):
            field.observe(lambda _: self._act(self._move), ["value"])
        self.depth.observe(lambda _: self._act(self._set_depth), ["value"])
        shown = [self.list, self.x, self.y, self.depth, self.back, self.front, self.release]
        super().__init__(deformation, [ipywidgets.HBox(shown)], **kwargs)

    def _on_model(self, what: str) -> None:
        super()._on_model("state" if what == "selection" else what)

    def _show(self) -> None:
        with self.deformation.locked():
            pose, selection = self.deformation.pose, self.deformation.selection
        names = (("No pin", -1), *((f"Pin {i + 1}", i) for i in range(len(pose))))
        if self.list.options != names:
            self.list.options = names
        self.list.value = selection[-1] if selection else -1
        for control in (self.x, self.y, self.depth, self.back, self.front, self.release):
            control.disabled = not selection
        if selection:
            self.x.value, self.y.value = pose.targets[selection[-1]].round(4).tolist()
            self.depth.value = float(pose.depths[selection[-1]])

    def _select(self, change: Any) -> None:
        chosen = [] if change["new"] == -1 else [change["new"]]
        self._act(partial(self.deformation.select, chosen))

    def _move(self) -> None:
        self.deformation.move_target(self.deformation.selection[-1], (self.x.value, self.y.value))

    def _set_depth(self) -> None:
        self.deformation.set_depths(self.deformation.selection, self.depth.value)
