"""The deformation canvas: a picture that follows its handles."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any

import ipywidgets
import traitlets

from glid_nb._arguments import check_count
from glid_nb.geometry import Domain
from glid_nb.imaging.read import ImageSource, read_image
from glid_nb.session.deformation import Deformation
from glid_nb.session.document import certificate_of
from glid_nb.session.edit_state import Moment
from glid_nb.widgets.closing import ClosingWidget
from glid_nb.widgets.gestures import Event, PinGestures
from glid_nb.widgets.layers import EvaluatedIn
from glid_nb.widgets.overlays import OVERLAYS
from glid_nb.widgets.pane import Pane
from glid_nb.widgets.scene import Drawing, Range

_PANELS_INTERVAL = 0.2  # least seconds between two updates of panels and ranges
_SOURCE_SHARE = 0.4  # of the width
_LEAST_SIZE = 100  # CSS pixels


class DeformCanvas(ClosingWidget, ipywidgets.HBox):
    """A picture that follows its handles.

    A click on the shape adds a handle, a drag moves its target (cyan); the handle (black) follows
    as far as a certified map allows. Right click or Delete removes it. Shift-click selects several.
    Arrow keys nudge, Ctrl+Z and Ctrl+Shift+Z undo and redo, Esc cancels a drag, 0 resets the shape,
    F makes everything visible. The wheel zooms about the pointer; the middle button, or the space
    bar and a drag, pan; so do two fingers. By keyboard alone: arrow keys move a cursor, Enter
    adds or selects a handle there, comma and full stop select the next one.

    Parameters
    ----------
    image
        A picture, as in `glid_nb.read_image`.
    deformation : Deformation or Domain
        The model to show, or the domain of a new one.
    width, height : int
        Size of the result in CSS pixels, at least 100 each.
    n_vertices : int, optional
        Vertices of the mesh that the picture is drawn on, at least 3. By default 10,000, or fewer
        if the page needs longer than 40 ms to draw them.
    evaluated_in : "shader" or "kernel", optional
        Where the vertices are computed. By default in the shader if it can hold the cage; a frame
        then sends a few kB whatever the number of vertices.

    Raises
    ------
    TraceError
        The picture cannot be read.
    TypeError, ValueError
        A size or number of vertices is invalid.
    """

    overlay = traitlets.Enum(tuple(OVERLAYS), "texture")
    """What the shape shows: "texture", "mesh" (with a grid), "sigma1", "sigma2", "k", "energy"."""

    show_cage = traitlets.Bool(False)
    """Whether the cage is drawn."""

    show_offset_cage = traitlets.Bool(False)
    """Whether the offset cage is drawn."""

    show_panels = traitlets.Bool(False)
    """Whether the boundary's panels are drawn, darker the smaller their certified sigma_2."""

    show_source = traitlets.Bool(False)
    """Whether the undeformed shape with the handles is drawn beside the result."""

    def __init__(
        self,
        image: ImageSource,
        deformation: Deformation | Domain,
        width: int = 600,
        height: int = 500,
        *,
        n_vertices: int | None = None,
        evaluated_in: EvaluatedIn | None = None,
        **kwargs: Any,
    ) -> None:
        size = check_size(width, height, _LEAST_SIZE)
        self._n_vertices = check_vertices(n_vertices)
        self.image = read_image(image)
        """The picture, (h, w, 4) uint8."""
        owned = isinstance(deformation, Domain)
        self.deformation = model = Deformation(deformation) if owned else deformation
        """The model that this is a view of."""
        self._evaluated_in: EvaluatedIn | None = evaluated_in
        self.pane = self._pane(size, interactive=True)
        self.source: Pane | None = None
        self.gestures = PinGestures(model, self.fit)
        self._closed = False  # a frame may arrive while the canvas closes
        self._when_drawn: list[Callable[[], None]] = []
        self._panels_at = self._range_at = 0.0
        # The drawn panels and their bounds, after the domain if a solve goes on.
        self._panels: tuple[Any, ...] = (None, None, None)
        super().__init__([self.pane], **kwargs)
        # A box that may scroll would shrink to nothing inside another.
        self.layout.overflow, self.layout.flex = "visible", "0 0 auto"
        self.layout.align_items = "flex-start"
        self._resize()
        self.pane.stage.observe(self._resize, ["height"])
        # Frames come from the solver's thread, events from the page's; both hold the model's lock.
        # While the solver works, its next frame acknowledges events, so it sets the pace.
        with model.locked():
            self.pane.stage.serve(model, self, busy=lambda: model.busy)
            stop = model.observe(self._on_model)
            self._draw(model.moment)
            if len(model.state.pose):
                self.fit()
            model_too = (model.close,) if owned else ()
            self._endings = (stop, self._close_panes, *model_too, self.layout.close)
            self._show_source()
            self._draw(model.moment, place_legend=True)
        self.pane.stage.observe(self._on_drawn, ["drawn"])
        self.observe(lambda _: self._redraw(), ["show_cage", "show_offset_cage"])
        self.observe(lambda _: self._redraw(place_legend=True), ["overlay", "show_panels"])
        self.observe(self._show_source, ["show_source"])

    def fit(self) -> None:
        """Make the whole shape and all targets visible."""
        moment = self.deformation.moment
        self.pane.fit(moment.shown, moment.state.pose.targets)

    def when_drawn(self, callback: Callable[[], None]) -> None:
        """Call ``callback`` once, when the page has drawn the canvas."""
        self._when_drawn.append(callback)

    def _close_panes(self) -> None:
        with self.deformation.locked():
            self._closed = True
            for pane in (self.pane, self.source):
                if pane is not None:
                    pane.close()

    def _pane(self, size: tuple[int, int], interactive: bool) -> Pane:
        state = self.deformation.state
        pane = Pane(
            self.image,
            state.map if interactive else state.identity,
            size,
            interactive=interactive,
            n_vertices=self._n_vertices,
            evaluated_in=self._evaluated_in,
        )
        pane.stage.observe(lambda _: self._adapt(pane), ["uniform_vectors", "drawing_time"])
        return pane

    def _adapt(self, pane: Pane) -> None:
        with self.deformation.locked():
            if not self._closed:
                pane.adapt()

    def _resize(self, _: Any = None) -> None:
        self.layout.height = f"{self.pane.stage.height}px"

    # Drawing; the model is locked

    def _on_model(self, what: str) -> None:
        with self.deformation.locked():
            if self._closed:
                return
            if what in ("state", "frame", "selection"):
                moment = self.deformation.moment
                self._draw(moment, place_legend=what == "frame" and moment.solved)
            if what in ("frame", "status"):
                self.pane.stage.acknowledge()

    def _redraw(self, *, place_legend: bool = False) -> None:
        with self.deformation.locked():
            if not self._closed:
                self._draw(self.deformation.moment, place_legend=place_legend)

    def _draw(self, moment: Moment, *, place_legend: bool = False) -> None:
        state, pose = moment.state, moment.state.pose
        cages = {"cage": self.show_cage, "offset_cage": self.show_offset_cage}
        drawing = Drawing(
            moment.map,
            moment.comparison,
            pose.targets,
            moment.shown(pose.handles) if len(pose) else (),
            moment.selection,
            self.overlay,
            state.current.energy,
            self._color_range(moment),
            panels=self._panels_of(moment) if self.show_panels else None,
            **cages,
        )
        self.pane.show(drawing)
        if self.source is not None:
            self.source.show(Drawing(state.identity, images=pose.handles, **cages))
        if place_legend and not moment.dragged:  # where it would jump
            self.pane.place_legend()

    def _color_range(self, moment: Moment) -> Range:
        """During a drag the range only grows, so that colours stay comparable."""
        moving, now = moment.busy or bool(moment.dragged), time.monotonic()
        if moving and not moment.solved and now - self._range_at <= _PANELS_INTERVAL:
            return "keep"
        self._range_at = now
        return "widen" if (moment.dragged if moment.solved else moving) else "fit"

    def _panels_of(self, moment: Moment) -> tuple[Any, ...]:
        """The boundary's panels; while the solver works at most `_PANELS_INTERVAL` old."""
        frame, now, domain = moment.frame, time.monotonic(), moment.state.domain
        if frame is None or frame.panels is None or not len(frame.sigma2_lower):
            proof = certificate_of(moment.map).panels
            self._panels = (None, proof, proof.sigma2_lower)
        elif (
            self._panels[0] is not domain
            or frame.solution is not None
            or now - self._panels_at > _PANELS_INTERVAL
        ):
            self._panels_at = now
            self._panels = (domain, frame.panels, frame.sigma2_lower)
        return self._panels[1:]

    # From the page

    def handle(self, events: Sequence[Event]) -> str | None:
        """Act on pointers and keys, and show why something was refused."""
        stage = self.pane.stage
        try:
            stage.notice = self.gestures.handle(events) or ""
            stage.set_trait("cursor", self.gestures.cursor)
        except Exception as error:
            stage.notice = f"{type(error).__name__}: {error}"
            raise
        return stage.notice or None

    def _on_drawn(self, _: Any) -> None:
        self.deformation.begin()
        waiting, self._when_drawn = self._when_drawn, []
        for callback in waiting:
            callback()

    def _show_source(self, _: Any = None) -> None:
        with self.deformation.locked():
            stage, old = self.pane.stage, self.source
            if self.show_source == (old is not None):
                return
            if old is None:  # both share the width that the result had
                width = round(_SOURCE_SHARE * stage.width)
                stage.width -= width
                self.source = self._pane((width, stage.height), interactive=False)
                self.children = [self.source, self.pane]
                self._draw(self.deformation.moment)
            else:
                self.source = None
                self.children = [self.pane]
                stage.width += old.stage.width
                old.close()
            self.fit()


def check_size(width: Any, height: Any, least: int) -> tuple[int, int]:
    """Width and height of a canvas in CSS pixels.

    Raises
    ------
    TypeError, ValueError
        As `check_count`.
    """
    return (
        check_count("width", width, least, "pixels"),
        check_count("height", height, least, "pixels"),
    )


def check_vertices(n_vertices: Any) -> int | None:
    """The number of vertices of a canvas's mesh, or None; raises as `check_size`."""
    return None if n_vertices is None else check_count("n_vertices", n_vertices, 3, "vertices")
