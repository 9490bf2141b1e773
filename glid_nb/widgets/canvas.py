"""The deformation canvas: a picture that follows its handles."""

import functools
import time
from collections.abc import Callable, Sequence
from typing import Any

import ipywidgets
import numpy as np
import traitlets

from glid_nb._arguments import check_count
from glid_nb._arrays import Array
from glid_nb.certificate import certificate_of
from glid_nb.certificate.certify import PanelCertificate
from glid_nb.figures.style import BLUE, ORANGE
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import ImageSource, Order, as_rgba8, deformed_loops, read_image
from glid_nb.imaging.backdrop import Background, check_background
from glid_nb.imaging.order import Sheets
from glid_nb.session.actions import turned_now
from glid_nb.session.deformation import Deformation
from glid_nb.session.edit_state import EditState, Moment
from glid_nb.session.scenery import Scenery, pressed
from glid_nb.widgets.brush import BrushGestures, painted_areas
from glid_nb.widgets.closing import ClosingWidget
from glid_nb.widgets.gestures import LEFT, Event, place, within_reach
from glid_nb.widgets.layers import EvaluatedIn
from glid_nb.widgets.overlays import OVERLAYS
from glid_nb.widgets.page_solver import PageSolver
from glid_nb.widgets.pane import Pane
from glid_nb.widgets.scene import Drawing, Range
from glid_nb.widgets.tracer import displayed

_GOING_ON = "move", "up"  # events of a gesture that has begun
_INTERVAL = 0.2  # least seconds between updates of panels, colours and hidden pins in a drag
_SOURCE_SHARE = 0.4  # share of the width for the undeformed shape
_LEAST_SIZE, _USUAL_SIZE = 100, (600, 500)  # CSS pixels
_NARROW = 480  # CSS pixels; a canvas with less room, as on a phone, is as high as it is wide

Seen = tuple[Sheets, Sequence[Scenery]]
"""The edited shape as it is seen, and the shapes around it."""


class DeformCanvas(ClosingWidget, ipywidgets.HBox):
    """A picture that follows its pins.

    A click on the shape adds a pin, and a drag moves its target (cyan). The pinned point (black)
    follows as far as a certified map allows. Right click, long touch, the Menu key and Shift+F10
    show more actions. The ``?`` on the canvas shows a table of all keys and gestures. The keyboard
    alone is enough: arrow keys move a cursor, and Enter adds or selects a pin there.

    The image is as in `glid_nb.read_image`. ``deformation`` is the model to show, or the domain of
    a new model. The canvas is ``width`` by ``height`` CSS pixels, at least 100 each; by default 600
    by 500. In an editor it is narrower if there is less room, and by default as large as there is
    room. The picture is drawn on a mesh of ``n_vertices``, at least 3; by default 10,000, or fewer
    if the page needs more than 40 ms to draw them. Who computes their images, ``evaluated_in``
    sets: the "shader", the "page" by its script, or the "kernel", which has to send them. By
    default it is the shader, or the page if that draws faster there, as without a graphics
    processor; for a cage that a shader cannot hold it is the kernel.
    The background is as in `glid_nb.render`.

    While pins are dragged, the page's own solver goes ahead of the kernel. It proves every map that
    it shows. When the kernel is at rest, its map is shown.

    Raises a TraceError for an unreadable picture, a TypeError or ValueError for another size.
    """

    overlay = traitlets.Enum(tuple(OVERLAYS), "texture")
    """The display on the shape: "texture", "mesh" (with a grid), "sigma1", "sigma2", "k" or
    "energy"."""
    show_cage = traitlets.Bool(False)
    """Whether the cage is drawn."""
    show_offset_cage = traitlets.Bool(False)
    """Whether the offset cage is drawn."""
    show_panels = traitlets.Bool(False)
    """Whether the boundary's panels are drawn, coloured by their certified sigma_2."""
    show_source = traitlets.Bool(False)
    """Whether the undeformed shape with the handles is drawn beside the result."""
    show_onion = traitlets.Bool(False)
    """Whether the outlines of the previous and the next pose are drawn."""

    # What was measured last: the domain, the time, the pins that the shape covers, the panels.
    _measured: tuple[Domain | None, float] = None, 0.0
    _hidden: Any = ()
    _panels: PanelCertificate | None = None

    def __init__(
        self,
        image: ImageSource,
        deformation: Deformation | Domain,
        width: int | None = None,
        height: int | None = None,
        *,
        n_vertices: int | None = None,
        evaluated_in: EvaluatedIn | None = None,
        background: Background = None,
        **kwargs: Any,
    ) -> None:
        size = check_size(_LEAST_SIZE, n_vertices, width=width, height=height)
        self.image = read_image(image)
        """The picture, (h, w, 4) uint8."""
        self.background = check_background(background)
        """What lies behind the shape, as in `glid_nb.render`."""
        owned = isinstance(deformation, Domain)
        self.deformation = model = Deformation(deformation) if owned else deformation
        """The model of this view."""
        self.scenery: tuple[Scenery, ...] = ()  # the shapes around, the backmost first
        self.on_other_part: Callable[[str, Event], None] = lambda _key, _event: None
        """Called with the key of another shape when it is pressed, before the press acts."""
        self.scenery_at: Callable[[float], Seen | None] = lambda _time: None
        """The edited shape and those around it at a time of the motion. The timeline sets this."""
        self.pins_at: Callable[[float], Array] = lambda _time: np.empty((0, 2))
        """The places of the edited shape's pins at a time of the motion; it sets this too."""
        self._mesh: dict[str, Any] = {"n_vertices": n_vertices, "evaluated_in": evaluated_in}
        self.pane = self._pane(size, interactive=True)
        self.pane.stage.picture_size = self.image.shape[1::-1]
        self._page_solver = PageSolver(self.pane.stage)
        self.source: Pane | None = None
        self.gestures = BrushGestures(model, self.fit, self.image)
        self.gestures.copy = lambda text: self.pane.stage.send({"copy": text})
        self.brush = self.gestures.brush
        """The brush for stiff areas."""
        super().__init__([self.pane], **kwargs)
        self.add_class("glid-deform")
        self._asked: tuple[int | None, int | None] = width, height
        self._given = size
        self._resize()
        self._follow_model(owned)
        self._follow_traits()

    def _follow_model(self, owned: bool) -> None:
        """Draw the model, now and whenever it changes, and hear the page's events.

        Frames come from the solver's thread, events from the page's thread. Both hold the model's
        lock. The solver's next frame acknowledges events and so sets the pace, except during the
        preparation of the solver.
        """
        model = self.deformation
        with model.locked():
            self.pane.stage.serve(model, self.handle, self._will_draw)
            self._unfollow = model.observe(self._on_model)
            closing = (model.close,) if owned else ()
            self._endings = (lambda: self._unfollow(), *closing)
            self._draw("state")
            if len(model.state.pose):
                self.fit()
            self._show_source()
            self._draw("legend")

    def _follow_traits(self) -> None:
        """Draw what changes of the stage, of this widget and of the brush."""
        stage = self.pane.stage
        stage.observe(self._resize, ["width", "height"])
        stage.observe(self._take_room, ["room"])
        stage.observe(self._on_view, ["view"])
        stage.observe(self._on_drawn, ["drawn"])
        self.observe(lambda _: self._draw("state"), ["show_cage", "show_offset_cage", "show_onion"])
        self.observe(lambda _: self._draw("legend"), ["overlay", "show_panels"])
        self.observe(self._show_source, ["show_source"])
        # By name, so that the page hears of a tool before the editor shows the brush's section.
        names = list(self.brush.trait_names())
        self.brush.observe(lambda _: self._draw("state"), names)

    @property
    def drawn(self) -> bool:
        """Whether a page has drawn the canvas."""
        return self.pane.stage.drawn

    def set_picture(self, image: Array, background: Background = None) -> None:
        """Draw another picture (h, w, 4) of the same size, and what lies behind it."""
        with self.deformation.locked():
            if self._closed:
                return
            self.image, self.background = image, check_background(background)
            self.gestures.set_image(image)
            self.pane.set_picture(image, self.background)
            if self.source is not None:
                self.source.set_picture(image, None)

    def show_scenery(self, scenery: Sequence[Scenery]) -> None:
        """Draw other shapes behind and in front of the edited one, the backmost first. Their
        pictures have the size of this canvas's picture."""
        with self.deformation.locked():
            if not self._closed:
                self.scenery = tuple(scenery)
                self.pane.show_scenery(self.scenery)

    def edit(self, deformation: Deformation, image: Array, scenery: Sequence[Scenery] = ()) -> None:
        """Edit another shape, with its picture (h, w, 4), and draw others around it.

        What the page has of a shape is used again if the picture is the same object as before.
        """
        with self.deformation.locked(), deformation.locked():
            if self._closed:
                return
            self._unfollow()
            self.deformation, self.image, self.scenery = deformation, image, tuple(scenery)
            self._unfollow = deformation.observe(self._on_model)
            self.pane.stage.follow(deformation)
            self.gestures = self.gestures.on(deformation, image)
            self.pane.edit(image, self.scenery)
            if self.source is not None:
                self.source.edit(image, ())
            self._draw("state")
            self.pane.stage.prepared = deformation.moment.prepared
        self.pane.stage.acknowledge()  # what the model before has been asked
        if self.drawn:
            self._on_drawn()

    def set_reference(self, picture: ImageSource | None) -> None:
        """Show a picture dimmed behind the shape, to draw poses after, or None for no picture.

        It is as large as the canvas's own picture allows. Exports and session files do not have it.
        """
        shown = None if picture is None else as_rgba8(read_image(picture))
        self.pane.stage.reference = displayed(shown)

    def fit(self) -> None:
        """Make the whole shape and all targets visible."""
        self.pane.fit()

    def _pane(self, size: tuple[int, int], interactive: bool) -> Pane:
        state = self.deformation.state
        map_ = state.map if interactive else state.identity
        behind = self.background if interactive else None
        look = {"interactive": interactive, "background": behind, **self._mesh}
        pane = Pane(self.image, map_, size, **look)
        pane.stage.observe(lambda _: self._adapt(pane), ["uniform_vectors", "drawing_time"])
        return pane

    def _adapt(self, pane: Pane) -> None:
        with self.deformation.locked():
            if not self._closed:
                pane.adapt()

    def _resize(self, _: Any = None) -> None:
        stage, (asked, tall), (width, height) = self.pane.stage, self._asked, self._given
        self.layout.height = f"{stage.height}px"
        # Dragging the corner fixes the dimension that it changes.
        if stage.width != width:
            asked = stage.width + (0 if self.source is None else self.source.stage.width)
        if stage.height != height:
            tall = stage.height
        self._asked, self._given = (asked, tall), (stage.width, stage.height)

    def _take_room(self, _: Any = None) -> None:
        with self.deformation.locked():
            width, height, fills = self.pane.stage.room
            if self._closed:
                return
            if not fills:
                asked, tall = self._asked
                width = min(width, asked or width)
                usual = width * _USUAL_SIZE[1] // _USUAL_SIZE[0]
                height = tall or min(height, width if width < _NARROW else usual)
            self._set_size(max(width, _LEAST_SIZE), max(height, _LEAST_SIZE))
            self.pane.place_legend()

    def _on_view(self, _: Any = None) -> None:
        with self.deformation.locked():
            moment = self.deformation.moment
            if not (self._closed or moment.busy or moment.dragged):
                self.pane.place_legend()

    def _set_size(self, width: int, height: int) -> None:
        beside = 0 if self.source is None else round(_SOURCE_SHARE * width)
        self._given = width - beside, height
        if self.source is not None:
            self.source.resize(beside, height)
        self.pane.resize(width - beside, height)

    # Drawing

    def _on_model(self, what: str) -> None:
        if what in ("state", "frame", "selection"):
            self._draw(what)
        if what in ("frame", "status"):
            with self.deformation.locked():
                self.pane.stage.prepared = self.deformation.moment.prepared
            self.pane.stage.acknowledge()

        self._tell_page()

    def _will_draw(self) -> bool:
        """Whether a frame of the solver will acknowledge what the page has asked."""
        now = self.deformation.moment
        return now.busy and now.prepared == 1

    def _on_drawn(self, _: Any = None) -> None:
        self.deformation.begin()
        self._tell_page()

    def _tell_page(self) -> None:
        with self.deformation.locked():
            if not self._closed:
                self._page_solver.follow(self.deformation.moment)

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        self.deformation.begin()  # even before the page draws
        return super()._repr_mimebundle_(**kwargs)

    def _draw(self, what: str) -> None:
        """Draw the model after a change of ``what``. Legends move only if the shape is at rest."""
        with self.deformation.locked():
            if self._closed:
                return
            moment = self.deformation.moment
            state, pose = moment.state, moment.state.pose
            color_range = self._measure(moment)
            drawing = Drawing(
                moment.map,
                comparison=moment.comparison,
                targets=pose.targets,
                images=moment.shown(pose.handles) if len(pose) else (),
                selected=moment.selection,
                ring=_ring(moment),
                hidden=self._hidden,
                order=state.order,
                **self._look(state, color_range),
            )
            self.pane.show(drawing)
            self.pane.stage.names = pose.names.tolist()
            self.pane.stage.pins = _marked(state)
            self.pane.stage.onion = self._onion(state) if self.show_onion else []
            self.pane.stage.brush = self.brush.shown
            self.pane.stage.stiff = painted_areas(moment)
            if self.source is not None:
                cages: Any = {"cage": drawing.cage, "offset_cage": drawing.offset_cage}
                seen = np.array([not mark.hidden for mark in state.marks], dtype=bool)
                self.source.show(Drawing(state.identity, images=pose.handles[seen], **cages))
            if (what == "legend" or (what == "frame" and moment.solved)) and not moment.dragged:
                self.pane.place_legend()

    def _look(self, state: EditState, color_range: Range) -> dict[str, Any]:
        return {
            "overlay": self.overlay,
            "energy": state.current.energy,
            "color_range": color_range,
            "cage": self.show_cage,
            "offset_cage": self.show_offset_cage,
            "panels": self._panels,
        }

    def show_between(
        self,
        map: HarmonicMap | None,
        order: Order | None = None,
        scenery: Sequence[Scenery] | None = None,
    ) -> None:
        """Draw a map of the motion instead of the edited pose, and the shapes around it as in
        ``scenery``. None shows the pose again. What the page evaluates, it draws by itself."""
        with self.deformation.locked():
            if self._closed:
                return
            if map is None:
                self._draw("state")
            elif self.pane.scene.evaluated_in == "kernel":
                look = self._look(self.deformation.state, "keep")
                self.pane.show(Drawing(map, order=order, **look))
            if self.scenery:
                self.pane.show_part_maps(scenery or self.scenery)

    def _onion(self, state: EditState) -> list[Any]:
        """Colours and outlines of the poses before and after the edited one."""
        beside = (state.active - 1, BLUE), (state.active + 1, ORANGE)
        count = len(state.poses)
        around = state.timeline.repeat == "loop" and count > 1
        maps = {i: state.poses[i % count].map for i, _ in beside if around or 0 <= i < count}
        return [[color, _boundary(maps[i])] for i, color in beside if i in maps]

    def _measure(self, moment: Moment) -> Range:
        """Update panels and hidden pins if it is time. Returns how to update the colours' range,
        which only grows during a drag."""
        (domain, then), now = self._measured, time.monotonic()
        state, frame, pose = moment.state, moment.frame, moment.state.pose
        moving = moment.busy or bool(moment.dragged)
        due = moment.solved or not moving or now - then > _INTERVAL or domain is not state.domain
        if due:
            self._measured = state.domain, now
        if not self.show_panels:
            self._panels = None
        elif due or frame is None or self._panels is None:
            known = None if frame is None else frame.certificate
            self._panels = (known or certificate_of(moment.map)).panels
        if not len(pose):
            self._hidden = ()
        elif due or len(pose) != len(self._hidden):
            self._hidden = self.deformation.sheets(self.image).hidden(pose.handles)
        if not due:
            return "keep"
        return "widen" if (moment.dragged if moment.solved else moving) else "fit"

    # From the page

    def handle(self, events: Sequence[Event]) -> str | None:
        """Act on pointers and keys. Show why an action was refused, until the next gesture: what
        remains of a refused drag does not hide the reason."""
        stage, refusal = self.pane.stage, None
        for run in self._runs(events):
            key = self._other_part(run[0])
            if key is not None:
                self.on_other_part(key, run[0])  # without a lock; it may edit another shape
            refusal = self.gestures.handle(run)
        if refusal or not all(event["type"] in _GOING_ON for event in events):
            stage.notice = refusal or ""
        stage.set_trait("cursor", self.gestures.cursor)
        if events[-1]["type"] not in ("down", "move"):  # no button is pressed
            self.deformation.tell("hand")
        return refusal

    def _runs(self, events: Sequence[Event]) -> list[Sequence[Event]]:
        """The events, divided before each press if there are several shapes to press."""
        starts = [i for i, event in enumerate(events) if i and self.scenery and _presses(event)]
        ends = [*starts, len(events)]
        return [events[start:end] for start, end in zip([0, *starts], ends, strict=True)]

    def _other_part(self, event: Event) -> str | None:
        """The key of the shape that an event presses; None for the edited one, its pins and its
        ring, and where there is none."""
        if not self.scenery or not _presses(event) or event["shift"]:
            return None
        with self.deformation.locked():
            point, gestures = place(event), self.gestures
            time, edited = event.get("at"), self.deformation.sheets(self.image)
            seen = (edited, self.scenery) if time is None else self.scenery_at(float(time))
            if seen is None or (gestures.brush.tool and event.get("button") == LEFT):
                return None
            if time is not None:
                if within_reach(self.pins_at(float(time)), point, event["reach"]):
                    return None
            else:
                ring = event.get("part") and self.deformation.selection
                if ring or gestures.hit(point, event["reach"]) is not None:
                    return None
            found = pressed(point, *seen)
        return None if found is None else found.key

    def _show_source(self, _: Any = None) -> None:
        with self.deformation.locked():
            stage, old = self.pane.stage, self.source
            if self.show_source == (old is not None):
                return
            width = stage.width + (0 if old is None else old.stage.width)
            if old is None:
                self.source = self._pane((width, stage.height), interactive=False)
            else:
                self.source = None
                old.close()
            self._set_size(width, stage.height)
            self.children = [pane for pane in (self.source, self.pane) if pane is not None]
            self._draw("state")
            self.fit()


def _presses(event: Event) -> bool:
    return event["type"] in ("down", "pin")


@functools.lru_cache(maxsize=4)  # by identity
def _boundary(map: HarmonicMap) -> list[Any]:
    """The deformed boundary, rounded to the precision of a screen."""
    return [np.round(loop, 3).tolist() for loop in deformed_loops(map)]


def _marked(state: EditState) -> dict[str, list[int]]:
    """What the page has to know of pins that are locked, hidden or grouped."""
    marks = list(enumerate(state.marks))
    return {
        "locked": [i for i, mark in marks if mark.locked],
        "away": [i for i, mark in marks if mark.hidden],
        "groups": [mark.group for _, mark in marks],
    }


def _ring(moment: Moment) -> tuple[float, ...]:
    if not moment.selection or moment.comparison is not None:
        return ()
    last, pose = moment.selection[-1], moment.state.pose
    if moment.state.marks[last].locked or moment.state.marks[last].hidden:
        return ()
    angle, scale = (float(values[0]) for values in turned_now(moment.state, [last]))
    wanted = (float(not np.isnan(values[last])) for values in (pose.angles, pose.scales))
    return round(angle, 4), round(scale, 4), *wanted


def check_size(least: int, n_vertices: Any, **sides: Any) -> tuple[int, int]:
    """Check width, height and vertices of a canvas. Returns the size, with defaults for None."""
    if n_vertices is not None:
        check_count("n_vertices", n_vertices, 3, "vertices")
    width, height = (
        usual if side is None else check_count(name, side, least, "pixels")
        for (name, side), usual in zip(sides.items(), _USUAL_SIZE, strict=True)
    )
    return width, height
