"""The edited pose and the motion through all poses, as controls."""

from collections.abc import Callable
from typing import Any

import ipywidgets

from glid_nb.session.deformation import Deformation
from glid_nb.session.edit_state import EditError
from glid_nb.widgets.controls import EditControls, FieldRows, button, heading

_EASINGS = (
    ("Even", "linear"),
    ("Ease in", "in"),
    ("Ease out", "out"),
    ("Ease in, out", "in-out"),
    ("Hold", "hold"),
)
_REPEATS = (("Once", "once"), ("Loop", "loop"), ("There and back", "ping-pong"))
_FULL = {"width": "auto"}


class MotionPanel(EditControls):
    """Name, time and easing of the edited pose, how the motion repeats, and its export."""

    def __init__(
        self, deformation: Deformation, on_export: Callable[[], None], **kwargs: Any
    ) -> None:
        model = deformation
        late: dict[str, Any] = {"continuous_update": False, "layout": _FULL}
        self.pose = ipywidgets.Dropdown(tooltip="The edited pose", layout=_FULL)
        self.name = ipywidgets.Text(tooltip="Its name", **late)
        self.time = ipywidgets.Text(tooltip="When the motion reaches it, in seconds", **late)
        tip = "How the motion leaves it"
        self.easing = ipywidgets.Dropdown(options=_EASINGS, tooltip=tip, layout=_FULL)
        tip = "Whether the motion plays once, in a loop, or there and back"
        self.repeat = ipywidgets.Dropdown(options=_REPEATS, tooltip=tip, layout=_FULL)
        self._bind(self.pose, model.go_to_pose)
        self._bind(self.name, lambda name: model.rename_pose(model.state.active, name))
        self._bind(self.time, lambda text: model.move_pose(model.state.active, _seconds(text)))
        self._bind(self.easing, lambda easing: model.set_easing(model.state.active, easing))
        self._bind(self.repeat, model.set_repeat)
        of_a_pose = {
            "pose": ("Pose", self.pose),
            "name": ("Name", self.name),
            "time": ("Time, s", self.time),
            "easing": ("Leaves it", self.easing),
        }
        self.export = button("Export the motion", "download", "Choose a file", on_export)
        super().__init__(
            deformation,
            [
                heading("Pose"),
                FieldRows(of_a_pose),
                heading("Motion"),
                FieldRows({"repeat": ("Plays", self.repeat)}),
                self.export,
            ],
            **kwargs,
        )
        self.add_class("glid-motion-panel")

    def _show(self) -> None:
        state = self.deformation.state
        poses = tuple((pose.name, i) for i, pose in enumerate(state.poses))
        if self.pose.options != poses:
            self.pose.options = poses
        self.pose.value = state.active
        self.name.value = state.current.name
        self.time.value = f"{state.timeline.times[state.active]:.2f}"
        easing = state.timeline.easing[state.active]
        # A curve is drawn on the timeline; here it only has a name.
        curve = () if isinstance(easing, str) else (("Curve", easing),)
        if self.easing.options != (*_EASINGS, *curve):
            self.easing.options = (*_EASINGS, *curve)
        self.easing.value = easing
        self.repeat.value = state.timeline.repeat
        for control in (self.time, self.easing, self.repeat, self.export):
            control.disabled = len(poses) < 2


def _seconds(text: str) -> float:
    try:
        return float(text.strip().rstrip("s").replace(",", "."))
    except ValueError:
        raise EditError(f"{text!r:.40} is not a number; type a time, such as 1.5") from None
