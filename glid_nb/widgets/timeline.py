"""The timeline below the canvas: keyframes, proofs between them, playing, recording."""

import base64
import io
import operator
import weakref
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import traitlets
from PIL import Image

from glid_nb._arrays import Array
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.order import Order, Sheets
from glid_nb.imaging.render import render
from glid_nb.imaging.texture import Texture
from glid_nb.page import bundle, stylesheet
from glid_nb.session.animation import Animation, PartAnimation, Span, proved_by_all
from glid_nb.session.document import NamedPose
from glid_nb.session.edit_state import EditState
from glid_nb.session.scenery import Scenery
from glid_nb.session.worker import LatestWins, weakly
from glid_nb.widgets.canvas import DeformCanvas, Seen
from glid_nb.widgets.gestures import Event, Gestures, asked, within_reach
from glid_nb.widgets.moving_pins import moving_pins
from glid_nb.widgets.pad import Pad
from glid_nb.widgets.scene import Scene

_THUMBNAIL, _SMALL = (104, 80), 512  # pixels of a thumbnail, and of the picture it is drawn from
_COLORS, _VERTICES = 64, 300
_OF_A_POSE = ("duplicate_pose", "delete_pose", "go_to_pose")


class TimelinePanel(Pad):
    """The poses of a canvas as keyframes in time, and the motion between them.

    The user can save, name, move, duplicate and delete poses. The motion is proved in the
    background. The page plays the proved part by itself, from the maps at which the motion bends.
    The strip is the thicker the larger is the certified bound on sigma_2. The export button calls
    ``on_export()``. Without it there is no button.
    """

    _script = traitlets.Unicode(bundle("timeline")).tag(sync=True)
    _css = stylesheet("timeline")

    stage = traitlets.Unicode("").tag(sync=True)
    """The identity of the canvas's stage, to which the page gives coefficients."""
    rate = traitlets.Float(25.0).tag(sync=True)
    """Frames in a second of an export, which the ruler counts."""
    shown = traitlets.Dict({}).tag(sync=True)
    """``keyframes`` (``name``, ``time``, ``easing`` to the next, ``thumbnail``), the index
    ``active``, the timeline's ``repeat`` and ``back``, its ``range`` (the times between which it
    plays, None for all), the states of the switches, and the name of the edited ``part`` if there
    are several."""
    motion = traitlets.Dict({"spans": []}).tag(sync=True)
    """``spans`` from keyframe to keyframe: ``start``, ``end``, ``status``, ``reason``. For the
    proved part, which ends at ``until``: ``times`` of the knots, ``floats`` (their coefficients),
    and ``sigma2`` between them."""
    heights = traitlets.Dict({"times": []}).tag(sync=True)
    """``times`` of the keyframes, and ``floats``, the picture's heights at these times, if the
    depths of poses differ. If the kernel evaluates, it sends the heights with its frames."""
    part_motions = traitlets.List([]).tag(sync=True)
    """The motions of the shapes around the edited one: for each its ``key``, its ``name``, its
    ``spans`` as in `motion`, and its ``heights``."""
    pins = traitlets.Dict({"spans": [], "poses": [], "keyframes": []}).tag(sync=True)
    """Where the pins are that a drag takes at any time: see `moving_pins`."""
    thumbnails = traitlets.Dict({}).tag(sync=True)  # pictures as data URIs, by their keys

    def __init__(
        self, canvas: DeformCanvas, on_export: Callable[[], None] | None = None, **kwargs: Any
    ) -> None:
        self.canvas, self.on_export = canvas, on_export
        self.on_play: Callable[[], None] = lambda: None  # called when the page plays, once a page
        self.animation = Animation(canvas.deformation)  # proves the motion between the poses
        self._pictures = weakref.WeakKeyDictionary[HarmonicMap, tuple[str, str]]()
        self._latest: dict[str, tuple[str, str]] = {}  # by the poses' names
        self._texture: Texture | None = None
        self._stacked: tuple[Any, ...] = ()
        self._pinned: tuple[Any, ...] = ()
        self._others: dict[
            str, Animation | PartAnimation
        ] = {}  # of the shapes around, by their keys
        self._others_end: list[Callable[[], None]] = []
        draw = weakly(self._draw_thumbnails)
        self.worker = LatestWins[tuple[NamedPose, ...]](draw, self, "thumbnails")
        super().__init__(stage=canvas.pane.stage.model_id, **kwargs)
        model = canvas.deformation
        actions = {
            "keep": asked(self.animation.keep, "time"),
            "record": asked(self.animation.record, "on"),
            "played": lambda _: self.on_play(),
            "onion": lambda event: canvas.set_trait("show_onion", event["on"]),
            "frame": asked(self._show_between, "time"),
            "rename_pose": asked(model.rename_pose, "index", "name"),
            "move_pose": asked(model.move_pose, "index", "time"),
            "set_easing": asked(model.set_easing, "index", "easing"),
            "play_all": asked(model.play_all, "repeat"),
            "set_loop_range": asked(model.set_loop_range, "range"),
        }
        actions |= {k: asked(getattr(model, k), "index") for k in _OF_A_POSE}
        actions |= {"undo": asked(model.undo), "redo": asked(model.redo)}
        self._gestures = Gestures(model, actions)
        canvas.gestures.go_to = self._go_to
        canvas.scenery_at = self._scenery_at
        canvas.pins_at = self.animation.pins
        self.serve(model, self._on_events)
        canvas.observe(lambda _: self._show("state"), ["show_onion"])
        canvas.pane.stage.observe(lambda _: self._show("motion"), ["materials"])
        canvas.pane.stage.observe(lambda _: self._show_others(), ["part_shapes"])
        canvas.pane.stage.observe(lambda _: self._show("state"), ["drawn"])
        self._endings = (
            model.observe(self._show),
            self.animation.observe(self._show),
            self.animation.close,
            self.worker.close,
            lambda: self.accompany({}),
        )
        for what in ("state", "motion"):
            self._show(what)

    def _on_events(self, events: Sequence[Event]) -> str | None:
        rest = [event for event in events if event["type"] != "export"]
        refusal = self._gestures.handle(rest)
        if self.on_export is not None and len(rest) < len(events):
            self.on_export()  # without the model's lock
        return refusal

    def _show_between(self, time: float | None) -> None:
        """Let the canvas draw the motion at a time. Without a time, or without a motion at that
        time, it draws the edited pose."""
        seen = None if time is None else self._seen(time)
        if seen is None:
            self.canvas.show_between(None)
        else:
            self.canvas.show_between(*seen)

    def _seen(self, time: float) -> tuple[HarmonicMap, Order, tuple[Scenery, ...]] | None:
        """Map and order of the edited shape at a time, and the shapes around it."""
        at = proved_by_all(time, [self.animation, *self._others.values()])
        seen = self.animation.seen(at)
        return None if seen is None else (*seen, tuple(self._moved(at)))

    def _moved(self, time: float) -> Iterator[Scenery]:
        """The shapes around the edited one at a time of their motions."""
        for shape in self.canvas.scenery:
            animation = self._others.get(shape.key)
            seen = None if animation is None else animation.seen(time)
            yield shape if seen is None else replace(shape, map=seen[0], order=seen[1])

    def _scenery_at(self, time: float) -> Seen | None:
        """As `DeformCanvas.scenery_at`."""
        if (seen := self._seen(time)) is None:
            return None
        return Sheets(*seen[:2], self.canvas.image), seen[2]

    def accompany(self, animations: Mapping[str, Animation | PartAnimation]) -> None:
        """Play the motions of the shapes around the edited one too, by their keys. They have the
        same keyframes. A motion that is not proved stops all of them."""
        for end in self._others_end:
            end()
        self._others = dict(animations)
        self._others_end = [a.observe(lambda _: self._show_others()) for a in animations.values()]
        self._show_others()

    def _show_others(self) -> None:
        # One lock after the other: the models of two shapes never wait for each other.
        motions = {key: (a.spans, a.state) for key, a in self._others.items()}
        with self.canvas.deformation.locked():
            if self._closed:
                return
            scenes = self.canvas.pane.part_scenes
            names = {shape.key: shape.name for shape in self.canvas.scenery}
            known = {key: motion for key, motion in motions.items() if key in scenes}
            self.part_motions = [
                {
                    "key": key,
                    "name": names.get(key, ""),
                    "spans": self._spans_of(scenes[key], spans),
                    "heights": _heights(scenes[key], state),
                }
                for key, (spans, state) in known.items()
            ]

    def _go_to(self, time: float, point: Array, reach: float) -> bool:
        """As `PinGestures.go_to`."""
        if (seen := self.animation.seen(time)) is None:
            return True
        drawn = Sheets(*seen, self.canvas.image).source(point) is not None
        if not drawn and not within_reach(self.animation.pins(time), point, reach):
            return False  # a press beside the shape makes no keyframe
        self.animation.go_to(time)
        return True

    def _show(self, what: str) -> None:
        with self.canvas.deformation.locked():
            if self._closed:
                return
            if what == "motion":
                scene, spans = self.canvas.pane.scene, self.animation.spans
                self.motion = {"spans": self._spans_of(scene, spans)}
            if what in ("state", "recording", "motion"):
                self._show_state()
            moment = self.canvas.deformation.moment
            # Drawing needs JAX and the processor, and the first solve has priority.
            at_rest = moment.solved and not moment.dragged and self.canvas.drawn
            if what in ("state", "frame") and at_rest:
                self.worker.submit(moment.state.poses)
            if not moment.dragged:
                self._show_heights(moment.state)
                self._show_pins(moment.state)

    def _show_state(self) -> None:
        state = self.canvas.deformation.state
        timeline = state.timeline
        # A pose that is being solved keeps its last thumbnail.
        latest = {p.name: self._pictures.get(p.map, self._latest.get(p.name)) for p in state.poses}
        self._latest = {name: picture for name, picture in latest.items() if picture}
        self.thumbnails = dict(self._latest.values())
        names = [pose.name for pose in state.poses]
        pictures = [self._latest.get(name, ("", ""))[0] for name in names]
        rows = zip(names, timeline.times, timeline.easing, pictures, strict=True)
        keyframes = [{"name": n, "time": t, "easing": e, "thumbnail": p} for n, t, e, p in rows]
        self.shown = {
            "keyframes": keyframes,
            "active": state.active,
            "repeat": timeline.repeat,
            "back": timeline.back,
            "range": timeline.played_range,
            "recording": self.animation.recording,
            "onion": self.canvas.show_onion,
            "kernel": any(s.evaluated_in == "kernel" for s in self._scenes),
            "exports": self.on_export is not None,
            "part": "" if state.edited_part is None else state.edited_part.name,
        }

    @property
    def _scenes(self) -> list[Scene]:
        pane = self.canvas.pane
        return [pane.scene, *pane.part_scenes.values()]

    def _show_heights(self, state: EditState) -> None:
        scene = self.canvas.pane.scene
        if scene.domain is not state.domain:
            return  # the canvas has not drawn the new cage yet
        stacked = (scene, state.timeline.closed_times, *state.orders)
        if stacked != self._stacked:
            self._stacked = stacked
            self.heights = _heights(scene, state)

    def _show_pins(self, state: EditState) -> None:
        poses, spans = [named.pose for named in state.poses], self.animation.spans
        pinned = (*poses, state.pins, state.timeline, *spans)
        known = self._pinned
        if len(pinned) != len(known) or not all(map(operator.is_, pinned, known)):
            self._pinned = pinned
            self.pins = moving_pins(state, spans)

    def _spans_of(self, scene: Scene, spans: Sequence[Span]) -> list[dict[str, Any]]:
        """The spans of a scene's shape. Those of a new cage are shown later, with its scene, whose
        materials are new."""
        return [self._span(scene, span) for span in spans if span.map.domain is scene.domain]

    def _span(self, scene: Scene, span: Span) -> dict[str, Any]:
        """A span as data for the page."""
        times, maps = span.knots
        in_page = scene.evaluated_in != "kernel"
        return {
            **{key: getattr(span, key) for key in ("start", "end", "until", "status", "reason")},
            "sigma2": list(span.sigma2),
            "times": list(times),
            "floats": b"".join(map(scene.shader_map.wire, maps)) if in_page else b"",
        }

    def set_picture(self) -> None:
        """Draw the thumbnails again, because the canvas has another picture."""
        with self.canvas.deformation.locked():
            self._texture = None
            self._pictures.clear()
            self._show("state")

    def _draw_thumbnails(self, poses: tuple[NamedPose, ...], worker: Any) -> None:
        pictures, done = self._pictures, False
        for pose in poses:
            if pose.map in pictures or worker.overtaken:
                continue
            if self._texture is None:
                picture = Image.fromarray(self.canvas.image)
                picture.thumbnail((_SMALL, _SMALL))
                self._texture = Texture.from_image(np.asarray(picture))
            drawn = render(self._texture, pose.map, _THUMBNAIL, _VERTICES, "fit", pose.pose)
            buffer = io.BytesIO()
            Image.fromarray(drawn).quantize(_COLORS).save(buffer, "PNG")
            data = base64.b64encode(buffer.getvalue()).decode()
            pictures[pose.map] = f"{id(pose.map):x}", f"data:image/png;base64,{data}"
            done = True
        if done:
            with self.canvas.deformation.locked():
                if not self._closed:
                    self._show_state()


def _heights(scene: Scene, state: EditState) -> dict[str, Any]:
    """The heights of a scene's picture at the keyframes: `TimelinePanel.heights`."""
    times, orders = state.timeline.closed_times, state.orders
    moves = scene.evaluated_in != "kernel" and any(o is not orders[0] for o in orders)
    if not moves or scene.domain is not state.domain:
        return {"times": []}
    return {
        "times": times,
        "floats": scene.heights([orders[i % len(orders)] for i in range(len(times))]),
    }
