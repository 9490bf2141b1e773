"""The pins of a deformation as numbers to read and type."""

from collections.abc import Sequence
from typing import Any

import ipywidgets
import numpy as np

from glid_nb.pose import DEEPEST, SCALES, Pose
from glid_nb.session.actions import wrapped
from glid_nb.session.deformation import Deformation
from glid_nb.session.edit_state import EditError
from glid_nb.session.pin_marks import PinMark, switched
from glid_nb.widgets.controls import EditControls, button, toggle
from glid_nb.widgets.row_list import Row, RowList, Switch
from glid_nb.widgets.shared import show_powers, show_texts

_NOTHING = Pose([(0, 0)], [(0, 0)])  # shown in the fields while nothing is selected
# For each field: what to type, the limits, and whether an empty field means free.
_PLACE = "a coordinate, such as 7.5", -1e9, 1e9, False
_DEPTH = f"a depth from {-DEEPEST:g} to {DEEPEST:g}", -DEEPEST, DEEPEST, False
_ANGLE = "an angle in degrees, such as 30", -1e9, 1e9, True
_SCALE = "a scale from {:g} to {:g}, such as 1.5".format(*SCALES), *SCALES, True
_NAME, _FREE = "name", "free"  # what empty fields say
_WEIGHT = "How firmly the pin is held: soft to the left, firm to the right"


class PinBar(EditControls):
    """The list of pins, and numbers and buttons for all selected pins.

    The list says which pins are locked, hidden or grouped, and has an eye and a padlock for each.
    The buttons below it lock, hide, group and remove all selected pins. The numbers are target,
    angle (degrees), scale, weight and depth. An empty angle or scale is free. Where several pins
    are selected, a field shows what all of them have, else "mixed". What is typed holds for all;
    locked pins keep their numbers, except for the depth.
    """

    def __init__(self, deformation: Deformation, **kwargs: Any) -> None:
        self.list = self._made_list(deformation)
        """All pins."""
        self._add_fields()
        self._bind_fields(deformation)
        self._add_buttons(deformation)
        self._add_marks(deformation)
        numbers = [self.x, self.y, self.angle, self.scale, self.depth]
        order = ipywidgets.HBox([self.back, self.front])
        self._of_a_pin: list[Any] = [self.name, *numbers, self.back, self.front, self.weight]
        self._of_a_pin += [self.lock, self.hide, self.remove, self.release]
        # What would move a pin that is locked.
        self._moving = [*numbers[:-1], self.weight, self.remove, self.release]
        marks = _in_words(self.lock, self.hide, self.group, self.ungroup)
        buttons = _in_words(self.remove, self.release, self.mirror, self.reset)
        self.count = ipywidgets.Label().add_class("glid-wide")
        """How many pins are selected; hidden if there are fewer than two."""
        controls = [marks, self.count, self.name, *numbers, order, self.weight, buttons]
        numbers_box = ipywidgets.GridBox(controls).add_class("glid-pin")
        super().__init__(deformation, [self.list, numbers_box], **kwargs)
        self.name.add_class("glid-wide")

    def _made_list(self, model: Deformation) -> RowList:
        def choose(pins: list[int]) -> None:
            self._act(lambda: model.select(pins))

        def switch(pin: int) -> None:
            marks = model.state.marks
            if pin < len(marks):
                self._act(lambda: model.select(switched(marks, model.selection, pin)))

        def set_mark(pin: int, mark: Switch, on: bool) -> None:
            self._act(lambda: model.mark_pins([pin], **{mark: on}))

        return RowList(
            "Pins",
            "No pins yet",
            several=True,
            on_choose=choose,
            on_switch=switch,
            on_set=set_mark,
            on_rename=lambda pin, name: self._act(lambda: model.name_pin(pin, name)),
        )

    def _add_fields(self) -> None:
        full = ipywidgets.Layout(width="auto")
        late: dict[str, Any] = {"continuous_update": False, "layout": full}
        tip = "The name of the selected pins"
        self.name = ipywidgets.Text(placeholder=_NAME, tooltip=tip, **late)
        late["style"] = {"description_width": "50px"}

        def field(name: str, tip: str, **more: Any) -> ipywidgets.Text:
            # A text field with a description shows no tooltip, except that of a span inside it.
            said: Any = {"description": f"<span title='{tip}'>{name}</span>", **more, **late}
            return ipywidgets.Text(description_allow_html=True, **said)

        self.x, self.y = (field(name, "Target") for name in "xy")
        tip = "Where parts overlap, those near pins of greater depth are in front"
        self.depth = field("Depth", tip)
        free: Any = {"placeholder": _FREE}
        tip = "By how much the shape is {} at the pin; empty: free ({}, X)".format
        self.angle = field("Angle °", tip("turned", "&lt; and &gt;"), **free)
        self.scale = field("Scale", tip("scaled", "+ and -"), **free)
        # The page writes these while a pin is dragged (page/js/canvas/followed.js).
        for name in ("x", "y", "angle", "scale"):
            getattr(self, name).add_class(f"glid-number-{name}")
        scale: Any = {"min": -6, "max": 2, "step": 0.25, "value": 1, "readout_format": ".2g"}
        scale |= {"tooltip": _WEIGHT, "layout": full, "continuous_update": False}
        scale["style"] = {"description_width": "50px"}
        self.weight = ipywidgets.FloatLogSlider(description="Weight", base=10, **scale)

    def _bind_fields(self, model: Deformation) -> None:
        def set_pins(**numbers: Any) -> None:
            model.set_pins(self._unlocked(), **numbers)

        def move(axis: int, text: str) -> None:
            moved = self._unlocked()
            targets = model.pose.targets[moved]
            targets[:, axis] = _number(text, *_PLACE)
            model.move_targets(moved, targets)

        self._bind(self.name, lambda name: model.name_pins(model.selection, name))
        self._bind(self.x, lambda text: move(0, text))
        self._bind(self.y, lambda text: move(1, text))
        self._bind(self.angle, lambda a: set_pins(angles=wrapped(np.radians(_number(a, *_ANGLE)))))
        self._bind(self.scale, lambda text: set_pins(scales=_number(text, *_SCALE)))
        self._bind(self.weight, lambda weight: set_pins(weights=weight))
        self._bind(self.depth, lambda d: model.set_depths(model.selection, _number(d, *_DEPTH)))

    def _add_buttons(self, model: Deformation) -> None:

        def acting(label: str, icon: str, tooltip: str, act: Any) -> ipywidgets.Button:
            return button(label, icon, tooltip, lambda: self._act(act))

        def moving(label: str, tooltip: str, steps: int) -> ipywidgets.Button:
            return acting(label, "", tooltip, lambda: model.bring_forward(model.selection, steps))

        def remove(keep_shape: bool) -> None:
            model.remove_handles(*self._unlocked(), keep_shape=keep_shape)

        tooltip = "Send selected pins, and what is around them, back (Page Down)"
        self.back = moving("Back", tooltip, -1)
        self.front = moving("Front", "Bring selected pins forward (Page Up)", 1)
        tooltip = "Remove selected pins (Delete)"
        self.remove = acting("Remove", "trash", tooltip, lambda: remove(False))
        tooltip = "Remove selected pins and keep the shape until the next change (Shift+Delete)"
        self.release = acting("Keep shape", "unlink", tooltip, lambda: remove(True))
        self.reset = acting("Rest pose", "home", "The undeformed shape (0)", model.reset)
        tooltip = "Swap left and right of the pose (M)"
        self.mirror = acting("Mirror", "exchange", tooltip, model.mirror_pose)

    def _add_marks(self, model: Deformation) -> None:
        """The buttons that lock, hide and group the selected pins."""
        look: Any = {"width": "auto"}
        tip = "Lock selected pins: the hand cannot move them (L)"
        self.lock = toggle("Lock", "lock", tip, look)
        tip = "Hide selected pins; they still hold (H)"
        self.hide = toggle("Hide", "eye-slash", tip, look)
        self._bind(self.lock, lambda on: model.mark_pins(model.selection, locked=on))
        self._bind(self.hide, lambda on: model.mark_pins(model.selection, hidden=on))

        def acting(label: str, icon: str, tooltip: str, act: Any) -> ipywidgets.Button:
            return button(label, icon, tooltip, lambda: self._act(lambda: act(model.selection)))

        tip = "Group selected pins: they are selected and moved together (G)"
        self.group = acting("Group", "object-group", tip, model.group_pins)
        tip = "Dissolve the groups of selected pins (Shift+G)"
        self.ungroup = acting("Ungroup", "object-ungroup", tip, model.ungroup_pins)

    def _unlocked(self) -> list[int]:
        model = self.deformation
        return [i for i in model.selection if not model.state.marks[i].locked]

    def _on_model(self, what: str) -> None:
        if what == "selection":  # also at the beginning of a drag; its numbers are the page's
            self.refusal.value = ""
            self._follow()
        else:
            super()._on_model(what)

    def _show(self) -> None:
        pose, selection = self.deformation.pose, self.deformation.selection
        marks = self.deformation.state.marks
        self.list.show(rows_of(pose, marks), list(selection))
        for control in self._of_a_pin:
            control.disabled = not selection
        chosen = [marks[i] for i in selection]
        self._show_marks(chosen)
        self.mirror.disabled = not len(pose)
        self._show_numbers(pose, selection)

    def _show_marks(self, chosen: Sequence[PinMark]) -> None:
        """Show which marks all chosen pins have, and what can be done with them."""
        self.lock.value = bool(chosen) and all(mark.locked for mark in chosen)
        self.hide.value = bool(chosen) and all(mark.hidden for mark in chosen)
        self.group.disabled = len(chosen) < 2
        self.count.value = _counted(chosen)
        self.count.layout.display = None if len(chosen) > 1 else "none"
        self.ungroup.disabled = not any(mark.group for mark in chosen)
        if chosen and all(mark.locked for mark in chosen):
            for control in self._moving:
                control.disabled = True

    def _show_numbers(self, pose: Pose, selection: Sequence[int]) -> None:
        shown = pose.only(list(selection)) if selection else _NOTHING
        places = (*shown.targets.T, shown.depths)
        for field, numbers in zip((self.x, self.y, self.depth), places, strict=True):
            show_texts(field, [f"{number.round(3) + 0.0:.8g}" for number in numbers])
        show_texts(self.name, shown.names.tolist(), _NAME)
        show_texts(self.angle, [_free_or(number) for number in np.degrees(shown.angles)], _FREE)
        show_texts(self.scale, [_free_or(number) for number in shown.scales], _FREE)
        show_powers(self.weight, shown.weights, _WEIGHT)


def _counted(chosen: Sequence[PinMark]) -> str:
    """How many pins are chosen, and how many of them are locked."""
    locked = sum(mark.locked for mark in chosen)
    return f"{len(chosen)} pins" + (f", {locked} of them locked" if locked else "")


def _in_words(*buttons: ipywidgets.Widget) -> ipywidgets.GridBox:
    """Buttons with words, two in a row."""
    return ipywidgets.GridBox(buttons).add_class("glid-words").add_class("glid-wide")


def rows_of(pose: Pose, marks: Sequence[PinMark]) -> list[Row]:
    """What the list says of pins."""
    named = zip(pose.names.tolist(), pose.targets.tolist(), marks, strict=True)
    return [_row(i, name, place, mark) for i, (name, place, mark) in enumerate(named)]


def _row(index: int, name: str, place: Sequence[float], mark: PinMark) -> Row:
    x, y = (f"{round(value, 2) + 0.0:.2f}" for value in place)  # avoids -0.00
    return Row(
        index,
        name,
        number=str(index + 1),
        unnamed=f"Pin {index + 1}",
        detail=f"{x}, {y}".replace("-", "\N{MINUS SIGN}"),
        said=f"at x {x}, y {y}",
        group=mark.group,
        switches={"hidden": mark.hidden, "locked": mark.locked},
    )


def _free_or(number: float) -> str:
    return "" if np.isnan(number) else f"{round(number, 4) + 0.0:.4g}"  # avoids -0 and 3e-14


def _number(text: str, wanted: str, least: float, most: float, free: bool) -> float:
    """The number in a field. With ``free``, NaN for an empty field or the word "free"."""
    text = text.strip().rstrip("°").replace(",", ".")
    if free and text in ("", "free"):
        return np.nan
    try:
        number = float(text)
    except ValueError:
        number = np.nan
    if not least <= number <= most:
        wrong = "not a number" if np.isnan(number) else "out of range"
        wanted += ", or nothing to leave it free" * free
        raise EditError(f"{text!r:.40} is {wrong}; type {wanted}")
    return number
