"""The meaning of pointers and keys on a canvas, without a browser."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from glid_nb._arrays import Array
from glid_nb._errors import InputError
from glid_nb.session.actions import turned_now, wrapped
from glid_nb.session.deformation import Deformation
from glid_nb.session.edit_state import EditError
from glid_nb.session.model import Observed
from glid_nb.session.pin_marks import switched, with_groups
from glid_nb.session.pose_text import pose_text

Event = Mapping[str, Any]
Action = Callable[[Event], Any]

OF_A_HAND = ("down", "move", "up", "cancel", "key")  # the types of pointer and key events
LEFT, RIGHT = 0, 2
_SLOP, _SLOP_ON_SHAPE = 2.0, 5.0  # a pressed pointer that moves fewer pixels does not drag
_NUDGE, _NUDGE_SHIFT = 0.1, 0.5  # world units
_CURSOR, _CURSOR_SHIFT = 6.0, 30.0  # pixels
ARROWS = {"ArrowLeft": (-1, 0), "ArrowRight": (1, 0), "ArrowUp": (0, 1), "ArrowDown": (0, -1)}
_DEPTHS = {"PageUp": 1, "]": 1, "PageDown": -1, "[": -1}
_TURNS = {"<": (np.radians(5), 1.0), ">": (np.radians(-5), 1.0)}  # angle and scale
_TURNS |= {"+": (0.0, 1.05), "=": (0.0, 1.05), "-": (0.0, 1 / 1.05)}
_LEAST_SCALE, _LARGEST_SCALE = 0.05, 20.0  # limits of scales set by dragging
_TURN = np.radians(15)  # to multiples of this, Shift turns
_LOCKED = "pin {} is locked; unlock it first (L)"
_LEVER = 12.0  # pixels from a pin: nearer to it, the pointer gives no direction
# A knob's drag turns, or scales, only beyond these: an angle, and the logarithm of a ratio.
_LEAST_TURN, _LEAST_SCALING = 0.06, 0.12


class Gestures:
    """Turns events of the page into actions on a model.

    An event is a mapping. Its ``type`` is a key of ``actions``. Pointer and key events have the
    place ``x``, ``y``, the radius ``reach`` around the pointer that counts as a hit, and the size
    ``unit`` of a CSS pixel, all in the canvas's units. They also have ``button``, ``shift``,
    ``key`` and ``time`` in ms.
    """

    def __init__(self, model: Observed, actions: Mapping[str, Action]) -> None:
        self._model, self._actions = model, actions
        self._press: Any = None

    def handle(self, events: Iterable[Event]) -> str | None:
        """Act on events in order. Returns why an action was refused, or None."""
        refusal: str | None = None
        with self._model.locked():  # all events together are drawn once
            for event in events:
                kind = event["type"]
                if (act := self._actions.get(kind)) is None:
                    return f"the page asked for {kind!r}, which this canvas cannot do"
                try:
                    act(event)
                    if kind not in ("move", "up", "cancel"):
                        refusal = None
                except InputError as error:
                    refusal = error.plain
                    self._press = None
        return refusal


@dataclass
class _PinPress:
    start: Array
    source: Array | None
    """The point of the undeformed shape below the pointer; None over a handle or outside the shape.
    """
    targets: Array | None
    """The dragged targets when the pointer was at ``start``; None without a handle."""
    dragging: bool = False
    part: str = ""
    """The pressed part of the ring around a handle: "turn", or "knob", which scales too."""
    turned: tuple[Array, Array] | None = None
    """Angles and scales of the selected handles when the pointer was at ``start``."""
    turns: bool = False
    scales: bool = False
    hit: int | None = None
    """The pressed handle, which a click without a key selects alone."""
    toggled: int | None = None
    """The handle that a click with Shift adds to the selection, or takes from it."""
    locked: int | None = None
    """The pressed handle if it is locked, so that nothing can be dragged."""
    pulls: bool = False
    """Whether the hand pulls at that one. When it lets go, it is told why nothing moves."""


class PinGestures(Gestures):
    """Gestures that pin and drag points, also below transparent parts of the picture. ``fit()``
    shows everything."""

    def __init__(
        self, deformation: Deformation, fit: Callable[[], None], image: Array | None = None
    ) -> None:
        actions = {kind: getattr(self, f"_{kind}") for kind in (*OF_A_HAND, "pin")}
        actions["down"] = self._down_at
        actions["paste_pose"] = asked(deformation.paste_pose, "text")
        super().__init__(deformation, actions)
        self.deformation, self._image = deformation, image
        self._fit = fit
        self._press: _PinPress | None = None
        self.copy: Callable[[str], None] = lambda _: None  # copies text to the clipboard
        self.go_to: Callable[[float, Array, float], bool] = lambda _time, _point, _reach: True
        """Edits the pose that the timeline shows at a time, if it is drawn at a point (2,) or has a
        pin within reach. Returns whether it is. The timeline sets this."""
        self._waiting: Event | None = None  # a press into a motion, until it is a drag
        self.cursor: list[float] | None = None  # the place of the keyboard's cursor

    def set_image(self, image: Array) -> None:
        """Take another picture, whose transparent parts hide nothing."""
        self._image = image

    def _shown(self) -> list[int]:
        """The handles that are not hidden by the user."""
        return [i for i, mark in enumerate(self.deformation.state.marks) if not mark.hidden]

    def _movable(self, chosen: Sequence[int] | None = None) -> list[int]:
        """Those of some handles, by default of the selected ones, that are not locked. Refused if
        all of them are."""
        model = self.deformation
        chosen = model.selection if chosen is None else chosen
        free = [i for i in chosen if not model.state.marks[i].locked]
        if chosen and not free:
            raise EditError(_LOCKED.format(chosen[-1] + 1))
        return free

    def hit(self, point: Array, reach: float) -> int | None:
        """The handle with the nearest target within reach, else with the nearest image.
        ``canvas/marks.js`` uses the same rule. Those that the user has hidden are not hit."""
        pose = self.deformation.pose
        if not len(pose):
            return None
        hidden = self.deformation.sheets(self._image).hidden(pose.handles)
        away = np.array([mark.hidden for mark in self.deformation.state.marks])
        for places in (pose.targets, self.deformation.moment.shown(pose.handles)):
            gap = np.linalg.norm(places - point, axis=1)
            # Hidden handles count as farther away.
            seen = np.where((gap <= reach) & ~away, gap + hidden * reach / 3, np.inf)
            nearest = int(np.argmin(seen))
            if seen[nearest] < np.inf:
                return nearest
        return None

    def _down_at(self, event: Event) -> None:
        """Press. While a motion is shown, a press tells its time, and waits for a drag."""
        self._waiting = None if event.get("at") is None else event
        if self._waiting is None:
            self._down(event)

    def _enter_motion(self) -> None:
        """Edit the pose that was shown when a waiting press came, and press there."""
        event, self._waiting = self._waiting, None
        if event is None:
            return
        if self.go_to(float(event["at"]), place(event), float(event["reach"])):
            self._down(event)

    def _source(self, point: Array) -> Array | None:
        return self.deformation.sheets(self._image).source(point)

    def _down(self, event: Event) -> None:
        model, point = self.deformation, place(event)
        if self._press is not None and self._press.dragging:
            model.end_drag()
        self._press, self.cursor = None, None
        hit = self.hit(point, event["reach"])
        if event["button"] == RIGHT and hit is not None and hit not in model.selection:
            model.select([hit])  # the menu acts on the selection
        if event["button"] != LEFT:
            return
        if hit is not None:
            self._down_on(hit, event)
        elif (part := event.get("part")) and model.selection:
            # A click on the ring's line without a turn pins the point below it.
            source = self._source(point) if part == "turn" else None
            self._press = self._turning(point, source, part)
        else:
            source = None if event["shift"] else self._source(point)
            self._press = _PinPress(point, source, None)

    def _down_on(self, hit: int, event: Event) -> None:
        """Press a handle with the left button."""
        model, point = self.deformation, place(event)
        toggles = event["shift"] and not event.get("alt")
        if not toggles and hit not in model.selection:
            model.select([hit])
        if model.state.marks[hit].locked:
            self._press = _PinPress(
                point, None, None, hit=hit, locked=hit, toggled=hit if toggles else None
            )
        elif toggles:
            # A click selects several; a drag moves along an axis.
            chosen = hit in model.selection
            moved = self._movable(None if chosen else with_groups(model.state.marks, [hit]))
            self._press = _PinPress(point, None, model.pose.targets[moved], toggled=hit)
        elif event.get("alt"):
            self._press = self._turning(point, None, "turn")
        else:
            self._press = _PinPress(point, None, model.pose.targets[self._movable()], hit=hit)

    def _turning(self, point: Array, source: Array | None, part: str) -> _PinPress:
        turned = turned_now(self.deformation.state, self._movable())
        return _PinPress(point, source, None, part=part, turned=turned, turns=part == "turn")

    def _move(self, event: Event) -> None:
        model, point = self.deformation, place(event)
        if self._waiting is not None:
            far = np.linalg.norm(point - place(self._waiting))
            if far > _SLOP_ON_SHAPE * event["unit"]:
                self._enter_motion()
        press = self._press
        if press is None:
            return
        slop = _SLOP if press.part or press.targets is not None else _SLOP_ON_SHAPE
        if not press.dragging and np.linalg.norm(point - press.start) <= slop * event["unit"]:
            return
        if press.locked is not None:
            press.pulls = True
            return
        if press.part:
            self._turn(press, point, _LEVER * event["unit"], event["shift"])
            return
        if press.targets is None and press.source is not None:
            # Dragging the shape itself pins the point below the pointer.
            press.targets = self._pin_at(press.source)
        if press.targets is None or not self._drags(press):
            return
        held = list(model.dragged)
        if len(held) != len(press.targets):
            press.start, press.targets = point, model.pose.targets[held]
        model.drag_to(press.targets + (point - press.start))

    def _drags(self, press: _PinPress) -> bool:
        """Begin or continue the drag of the selected handles. False if it cannot continue."""
        model = self.deformation
        if press.toggled is not None:
            if press.toggled not in model.selection:
                model.select([press.toggled])
            press.toggled = None
        if not press.dragging and model.selection:
            model.begin_drag(self._movable())
            press.dragging = True
        elif not model.dragged:
            self._press = None
        return self._press is not None

    def _turn(self, press: _PinPress, point: Array, lever: float, whole: bool) -> None:
        """Turn and scale the selected handles when the pointer moves around the last of them.
        ``whole`` turns that one to a multiple of 15 degrees."""
        model = self.deformation
        if not self._drags(press):
            return
        assert press.turned is not None
        centre, (angles, scales) = model.pose.targets[model.dragged[-1]], press.turned
        before, now = ((place - centre) @ [1, 1j] for place in (press.start, point))
        if abs(before) < lever:  # pressed on the pin itself: the drag begins beside it
            press.start = point
            return
        if abs(now) == 0 or len(angles) != len(model.dragged):
            return
        angle, ratio = np.angle(now / before), abs(now / before)
        if press.part == "knob":
            press.turns |= abs(angle) > _LEAST_TURN
            press.scales |= abs(np.log(ratio)) > _LEAST_SCALING
        if whole:
            angle = np.round((angles[-1] + angle) / _TURN) * _TURN - angles[-1]
        wanted = {"angles": wrapped(angles + angle)} if press.turns else {}
        if press.scales:
            wanted["scales"] = (scales * ratio).clip(_LEAST_SCALE, _LARGEST_SCALE)
        if not wanted:
            return
        try:
            model.drag_pins(**wanted)
        except InputError:  # the method cannot
            model.end_drag()
            raise

    def _up(self, event: Event) -> None:
        press, self._press, self._waiting = self._press, None, None
        path = event.get("path") or ()
        if event.get("encloses") and len(path) > 2:
            self._enclose(path)
            return
        if press is None:
            return
        if press.pulls and press.locked is not None:
            raise EditError(_LOCKED.format(press.locked + 1))
        if press.dragging:
            self.deformation.end_drag()
        elif press.toggled is not None:
            model = self.deformation
            model.select(switched(model.state.marks, model.selection, press.toggled))
        elif press.hit is not None:
            self.deformation.select([press.hit])
        elif press.targets is None:
            if press.source is not None:
                self._pin_at(press.source)
            elif not event["shift"] and not press.part:
                self.deformation.select([])

    def _enclose(self, path: Sequence[Any]) -> None:
        """Select the shown handles in a box or a lasso too."""
        model, inside = self.deformation, shapely.make_valid(shapely.Polygon(path))
        chosen = np.flatnonzero(shapely.contains_xy(inside, *model.pose.targets.T))
        model.select([*model.selection, *(i for i in chosen.tolist() if i in self._shown())])

    def _cancel(self, _: Event) -> None:
        self._press = self._waiting = None
        self.deformation.cancel_drag()

    def _pin(self, event: Event) -> None:
        self._pin_at(self._source(place(event)))

    def _pin_at(self, source: Array | None) -> Array:
        """Pin and select a point of the undeformed shape. Returns its target, (1, 2)."""
        if source is None:
            raise EditError("there is no shape here; choose a place on the shape")
        model = self.deformation
        index = model.add_handle(source)
        model.select([index])
        return model.pose.targets[[index]]

    def _key(self, event: Event) -> None:
        key, model = event["key"], self.deformation
        plain: dict[str, Callable[[], Any]] = {"undo": model.undo, "redo": model.redo}
        plain |= {"0": model.reset, "m": model.mirror_pose, "f": self._fit}
        plain |= {"x": lambda: model.set_pins(self._movable(), angles=None, scales=None)}
        plain |= {"a": lambda: model.select(self._shown())}
        plain |= {"l": lambda: self.toggle("locked"), "h": lambda: self._hide(event["shift"])}
        plain |= {"g": lambda: self._group(event["shift"])}
        parts = model.select_next_part
        plain |= {"n": lambda: parts(-1 if event["shift"] else 1)}
        plain |= {",": lambda: self._next(-1), ".": lambda: self._next(1)}
        if key in ARROWS:
            self._arrow(event)
        elif key == "Enter":
            self._enter(event)
        elif key in ("Delete", "Backspace"):
            if model.selection:
                model.remove_handles(*self._movable(), keep_shape=event["shift"])
        elif key == "Escape":
            if model.dragged:
                self._cancel(event)
            else:
                model.select([])
                self.cursor = None
        elif act := plain.get(key.lower()):
            act()
        elif key in _DEPTHS:
            model.bring_forward(model.selection, _DEPTHS[key])
        elif key in _TURNS:
            model.turn(self._movable(), *_TURNS[key])
        elif key == "copy":
            self.copy(pose_text(model.state))

    def _arrow(self, event: Event) -> None:
        direction, model = np.array(ARROWS[event["key"]], dtype=float), self.deformation
        if model.selection and self.cursor is None:
            model.nudge(self._movable(), direction * (_NUDGE_SHIFT if event["shift"] else _NUDGE))
            return
        step = (_CURSOR_SHIFT if event["shift"] else _CURSOR) * event["unit"]
        self.cursor = (np.array(self.cursor or place(event)) + step * direction).tolist()

    def _enter(self, event: Event) -> None:
        if self.cursor is None:
            self.cursor = place(event).tolist()
            return
        model, point = self.deformation, np.array(self.cursor)
        hit = self.hit(point, event["reach"])
        if hit is None:
            self._pin_at(self._source(point))
        else:
            model.select([hit])
        self.cursor = None

    def _next(self, step: int) -> None:
        model, shown = self.deformation, self._shown()
        if shown:
            last = model.selection[-1] if model.selection else (-1 if step > 0 else len(model.pose))
            beyond = [i for i in shown if (i - last) * step > 0] or shown
            model.select([beyond[0 if step > 0 else -1]])
            self.cursor = None

    def toggle(self, mark: str) -> None:
        """Lock or hide the selected handles, or undo that if all of them are."""
        model = self.deformation
        marks = [model.state.marks[i] for i in model.selection]
        model.mark_pins(model.selection, **{mark: not all(getattr(one, mark) for one in marks)})

    def _hide(self, shows: bool) -> None:
        """Hide the selected handles, or show all hidden ones."""
        if shows:
            self.deformation.show_all_pins()
        else:
            self.toggle("hidden")

    def _group(self, dissolves: bool) -> None:
        """Make a group of the selected handles, or dissolve their groups."""
        model = self.deformation
        (model.ungroup_pins if dissolves else model.group_pins)(model.selection)


def asked(act: Callable[..., Any], *items: str) -> Action:
    """An action that calls ``act`` with these items of an event."""
    return lambda event: act(*(event[item] for item in items))


def place(event: Event) -> Array:
    """The place of an event, (2,)."""
    return np.array([event["x"], event["y"]], dtype=float)


def within_reach(places: Array, point: Array, reach: float) -> bool:
    """Whether one of some places (k, 2), which may be NaN, is within reach of a point (2,)."""
    return bool((np.linalg.norm(places - point, axis=-1) <= reach).any())
