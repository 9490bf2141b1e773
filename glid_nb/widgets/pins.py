"""The pins of a deformation as numbers to read and type."""

from functools import partial
from typing import Any

import ipywidgets
import numpy as np

from glid_nb.session.actions import wrapped
from glid_nb.session.deformation import Deformation
from glid_nb.session.edit_state import EditError
from glid_nb.solvers.pose import DEEPEST
from glid_nb.widgets.controls import EditControls, button


class PinBar(EditControls):
    """The list of pins; the numbers of the one selected last; what to do with all selected.

    Target, angle (degrees), scale, weight and depth; an empty angle or scale is free.

    Parameters
    ----------
    deformation : Deformation
        The model that the bar shows and changes.
    """

    def __init__(self, deformation: Deformation, **kwargs: Any) -> None:
        self._add_fields()
        self._add_buttons(deformation)
        turned = self.angle, self.scale, self.weight
        self._numbers = [self.x, self.y, *turned, self.depth, self.back, self.front, self.release]
        row = [self.list, *self._numbers, self.mirror]
        wrapping = ipywidgets.HBox(row, layout={"flex_flow": "row wrap"})
        super().__init__(deformation, [wrapping], **kwargs)

    def _add_fields(self) -> None:
        tooltip = "The selected pin"
        self.list = ipywidgets.Dropdown(
            options=[("No pin", -1)], tooltip=tooltip, layout={"width": "92px"}
        )
        self.list.observe(self._select, ["value"])
        style = {"description_width": "initial"}
        look: dict[str, Any] = {"layout": ipywidgets.Layout(width="92px"), "style": style}
        self.x = ipywidgets.FloatText(description="x", step=0.1, tooltip="Target", **look)
        self.y = ipywidgets.FloatText(description="y", step=0.1, tooltip="Target", **look)
        self.angle, self.scale = (
            ipywidgets.Text(
                description=name,
                placeholder="free",
                continuous_update=False,
                tooltip=f"By how much the shape is {what} at the pin; empty: free ({keys})",
                layout={"width": "112px"},
                style=style,
            )
            for name, what, keys in (
                ("Angle °", "turned", "< and >, X"),
                ("Scale", "scaled", "+ and -, X"),
            )
        )
        self.weight = ipywidgets.FloatLogSlider(
            1,
            description="Weight",
            tooltip="How firmly the pin is held: soft to the left, firm to the right",
            min=-6,
            max=2,
            step=0.25,
            readout_format=".2g",
            continuous_update=False,
            layout={"width": "186px"},
            style=style,
        )
        tooltip = "Where parts overlap, those near pins of greater depth are in front"
        self.depth = ipywidgets.BoundedFloatText(
            description="Depth", tooltip=tooltip, min=-DEEPEST, max=DEEPEST, **look
        )
        for fields, act in (
            ((self.x, self.y), self._move),
            ((self.angle,), self._set_angle),
            ((self.scale,), self._set_scale),
            ((self.weight,), self._set_weight),
            ((self.depth,), self._set_depth),
        ):
            for field in fields:
                field.observe(lambda _, act=act: self._act(act), ["value"])

    def _add_buttons(self, model: Deformation) -> None:
        narrow = ipywidgets.Layout(width="38px")

        def acting(icon: str, tooltip: str, act: Any) -> ipywidgets.Button:
            return button("", icon, tooltip, lambda: self._act(act), narrow)

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
        self.mirror = acting("exchange", "Swap left and right of the pose (M)", model.mirror_pose)

    def _on_model(self, what: str) -> None:
        super()._on_model("state" if what == "selection" else what)

    def _show(self) -> None:
        with self.deformation.locked():
            pose, selection = self.deformation.pose, self.deformation.selection
        names = (("No pin", -1), *((f"Pin {i + 1}", i) for i in range(len(pose))))
        if self.list.options != names:
            self.list.options = names
        self.list.value = selection[-1] if selection else -1
        for control in self._numbers:
            control.disabled = not selection
        self.mirror.disabled = not len(pose)
        if selection:
            last = selection[-1]
            self.x.value, self.y.value = pose.targets[last].round(4).tolist()
            self.angle.value = _free_or(np.degrees(pose.angles[last]))
            self.scale.value = _free_or(pose.scales[last])
            self.weight.value = float(pose.weights[last])
            self.depth.value = float(pose.depths[last])

    def _select(self, change: Any) -> None:
        chosen = [] if change["new"] == -1 else [change["new"]]
        self._act(partial(self.deformation.select, chosen))

    def _move(self) -> None:
        self.deformation.move_target(self.deformation.selection[-1], (self.x.value, self.y.value))

    def _set_angle(self) -> None:
        degrees = _number(self.angle.value, "an angle in degrees, such as 30")
        angle = None if degrees is None else float(wrapped(np.radians(degrees)))
        self.deformation.set_pins(self.deformation.selection, angles=angle)

    def _set_scale(self) -> None:
        scale = _number(self.scale.value, "a scale, such as 1.5")
        self.deformation.set_pins(self.deformation.selection, scales=scale)

    def _set_weight(self) -> None:
        self.deformation.set_pins(self.deformation.selection, weights=self.weight.value)

    def _set_depth(self) -> None:
        self.deformation.set_depths(self.deformation.selection, self.depth.value)


def _free_or(number: float) -> str:
    return "" if np.isnan(number) else f"{number:.4g}"


def _number(text: str, wanted: str) -> float | None:
    """The number in a field; None for an empty one or the word "free"."""
    text = text.strip().rstrip("°").replace(",", ".")
    if text in ("", "free"):
        return None
    try:
        number = float(text)
    except ValueError:
        number = np.nan
    if not np.isfinite(number):
        raise EditError(f"{text!r:.40} is no number; type {wanted}, or nothing to leave it free")
    return number
