"""The timeline below the canvas: keyframes, proofs between them, playing, recording."""

import base64
import io
import weakref
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import traitlets
from PIL import Image

from glid_nb._arrays import Array
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.order import Sheets
from glid_nb.imaging.render import render
from glid_nb.imaging.texture import Texture
from glid_nb.page import bundle, stylesheet
from glid_nb.session.animation import Animation, Span
from glid_nb.session.document import NamedPose
from glid_nb.session.edit_state import EditState
from glid_nb.session.worker import LatestWins, weakly
from glid_nb.widgets.canvas import DeformCanvas
from glid_nb.widgets.gestures import Event, Gestures, asked
from glid_nb.widgets.pad import Pad

_THUMBNAIL, _SMALL = (104, 80), 512  # pixels of a thumbnail, and of the picture it is drawn from
_COLORS, _VERTICES = 64, 300
_OF_A_POSE = ("duplicate_pose", "delete_pose", "go_to_pose")


class TimelinePanel(Pad):
    """The poses of a canvas as keyframes in time, and the motion between them.

    The user can save, name, move, duplicate and delete poses. The motion is proved in the
    background. The page plays the proved part by itself, from the maps at which the motion bends.
    The strip's height is the certified bound on sigma_2. The export button calls ``on_export()``.
    Without it there is no button.
    """

    _script = traitlets.Unicode(bundle("timeline")).tag(sync=True)
    _css = stylesheet("timeline")

    stage = traitlets.Unicode("").tag(sync=True)
    """The identity of the canvas's stage, to which the page gives coefficients."""
    rate = traitlets.Float(25.0).tag(sync=True)
    """Frames in a second of an export, which the ruler counts."""
    shown = traitlets.Dict({}).tag(sync=True)
    """``keyframes`` (``name``, ``time``, ``easing``, ``thumbnail``), the index ``active``, the
    timeline's ``repeat`` and ``back``, and the states of the switches."""
    motion = traitlets.Dict({"spans": []}).tag(sync=True)
    """``spans`` from keyframe to keyframe: ``start``, ``end``, ``status``, ``reason``. For the
    proved part: ``times`` of the knots, ``floats`` (their coefficients), and ``sigma2`` between
    them."""
    heights = traitlets.Dict({"times": []}).tag(sync=True)
    """``times`` of the keyframes, and ``floats``, the picture's heights at these times, if the
    depths of poses differ. If the kernel evaluates, it sends the heights with its frames."""
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
            "set_repeat": asked(model.set_repeat, "repeat"),
        }
        actions |= {k: asked(getattr(model, k), "index") for k in _OF_A_POSE}
        actions |= {"undo": asked(model.undo), "redo": asked(model.redo)}
        self._gestures = Gestures(model, actions)
        canvas.gestures.go_to = self._go_to
        self.serve(model, self._on_events)
        canvas.observe(lambda _: self._show("state"), ["show_onion"])
        canvas.pane.stage.observe(lambda _: self._show("motion"), ["materials"])
        canvas.pane.stage.observe(lambda _: self._show("state"), ["drawn"])
        self._endings = (
            model.observe(self._show),
            self.animation.observe(self._show),
            self.animation.close,
            self.worker.close,
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
        seen = None if time is None else self.animation.seen(time)
        map_, order = seen or (None, None)
        self.canvas.show_between(map_, order)

    def _go_to(self, time: float, point: Array) -> bool:
        """Edit the pose at a time, if it is drawn at a point (2,). Returns whether it is."""
        if (seen := self.animation.seen(time)) is None:
            return True
        if Sheets(*seen, self.canvas.image).source(point) is None:
            return False  # a press beside the shape makes no keyframe
        self.animation.go_to(time)
        return True

    def _show(self, what: str) -> None:
        with self.canvas.deformation.locked():
            if self._closed:
                return
            if what == "motion":
                # Spans of a new cage are shown later, with its scene, whose materials are new.
                domain = self.canvas.pane.scene.domain
                spans = [span for span in self.animation.spans if span.map.domain is domain]
                self.motion = {"spans": [self._span(span) for span in spans]}
            if what in ("state", "recording", "motion"):
                self._show_state()
            moment = self.canvas.deformation.moment
            # Drawing needs JAX and the processor, and the first solve has priority.
            at_rest = moment.solved and not moment.dragged and self.canvas.drawn
            if what in ("state", "frame") and at_rest:
                self.worker.submit(moment.state.poses)
            if not moment.dragged:
                self._show_heights(moment.state)

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
            "recording": self.animation.recording,
            "onion": self.canvas.show_onion,
            "kernel": self.canvas.pane.scene.evaluated_in == "kernel",
            "exports": self.on_export is not None,
        }

    def _show_heights(self, state: EditState) -> None:
        scene, times = self.canvas.pane.scene, state.timeline.closed_times
        if scene.domain is not state.domain:
            return  # the canvas has not drawn the new cage yet
        orders = [state.orders[i % len(state.orders)] for i in range(len(times))]
        moves = scene.evaluated_in != "kernel" and any(o is not orders[0] for o in orders)
        stacked = (scene, times, *orders) if moves else ()
        if stacked != self._stacked:
            self._stacked = stacked
            floats = {"floats": scene.heights(orders)} if moves else {}
            self.heights = {"times": times if moves else [], **floats}

    def _span(self, span: Span) -> dict[str, Any]:
        """A span as data for the page. If nothing is proved, the shape stays at its keyframe."""
        scene, pieces = self.canvas.pane.scene, span.pieces
        start = span.start, pieces[0].start_map if pieces else span.map
        ends = [(piece.end, piece.end_map) for piece in pieces] or [(span.end, span.map)]
        times, maps = zip(start, *ends, strict=True)
        in_page = scene.evaluated_in != "kernel"
        return {
            **{key: getattr(span, key) for key in ("start", "end", "status", "reason")},
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
