"""The deformation canvas: the picture under the hand."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

import ipywidgets
import numpy as np
import traitlets
from numpy.typing import NDArray

from glid_nb._arguments import check_count
from glid_nb.certificate.certify import PanelCertificate
from glid_nb.geometry import Domain
from glid_nb.geometry.panels import Panels
from glid_nb.imaging.read import ImageSource, read_image
from glid_nb.session.deformation import Deformation
from glid_nb.widgets.arguments import LEAST_CANVAS, check_vertices
from glid_nb.widgets.gestures import Gestures
from glid_nb.widgets.overlays import OVERLAYS
from glid_nb.widgets.pane import Pane
from glid_nb.widgets.scene import EvaluatedIn
from glid_nb.widgets.subshells import answer_during_cells

Array = NDArray[Any]

_PANELS_INTERVAL = 0.2  # seconds: panels and ranges are made anew no more often
_SOURCE_SHARE = 0.4  # of the width


class DeformCanvas(ipywidgets.HBox):
    """A picture that follows its handles.

    A click on the shape adds a handle, a drag moves its target (cyan), whose handle (black) follows
    as far as a certified map allows; right click or Delete removes it. Shift-click selects several.
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
        Vertices of the mesh that the picture is drawn on. By default 10,000, or fewer where the
        page needs longer than 40 ms to draw them. At least 3.
    evaluated_in : "shader" or "kernel", optional
        Who computes the vertices. By default the shader, where it can hold the cage; a frame then
        costs a few kB on the wire whatever the number of vertices.

    Raises
    ------
    TraceError
        The picture cannot be read.
    TypeError, ValueError
        A size or a number of vertices cannot be used.
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

    # ipywidgets closes also what was refused while it was made.
    _complete = False

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
        size = (
            check_count("width", width, LEAST_CANVAS, "pixels"),
            check_count("height", height, LEAST_CANVAS, "pixels"),
        )
        self._n_vertices = check_vertices(n_vertices)
        self.image = read_image(image)
        """The picture, (h, w, 4) uint8."""
        self._owns_model = isinstance(deformation, Domain)
        self.deformation = (
            Deformation(deformation) if isinstance(deformation, Domain) else deformation
        )
        """The model that this is a view of."""
        self._evaluated_in: EvaluatedIn | None = evaluated_in
        self.pane = self._pane(size, interactive=True)
        self.source: Pane | None = None
        self.gestures = Gestures(self.deformation, self.fit)
        # The page's events that wait for the frame they led to; guarded by their own lock, in
        # which nothing else is locked.
        self._waiting: dict[str, int] = {}
        self._waiting_lock = threading.Lock()
        # Frames come from the solver's thread, selections and the like from the page's. The model
        # may be locked when this is taken, and is not locked while it is held.
        self._drawing = threading.RLock()
        self._closed = False  # guarded by the lock: a frame may arrive while the canvas closes
        self._receiving = threading.Lock()
        self._when_drawn: list[Callable[[], None]] = []
        self._panels_at = self._range_at = 0.0
        super().__init__([self.pane], **kwargs)
        # A box that may scroll would shrink to nothing inside another one.
        self.layout.overflow, self.layout.flex = "visible", "0 0 auto"
        self.layout.align_items = "flex-start"
        self._resize()
        self.pane.stage.observe(self._resize, ["height"])
        self._stop = self.deformation.observe(self._on_model)
        self.pane.stage.on_msg(self._receive)
        answer_during_cells(self.pane.stage)
        self.observe(self._show_overlay, ["overlay"])
        self.observe(self._show_lines, ["show_cage", "show_offset_cage"])
        self.observe(self._on_show_panels, ["show_panels"])
        self.observe(self._show_source, ["show_source"])
        self._draw()
        if len(self.deformation.pose):
            self.fit()
        self._complete = True
        # Overlays that were given as arguments.
        self._show_overlay()
        self._show_lines()
        self._show_panels()
        self._show_source()

    def fit(self) -> None:
        """Make the whole shape and all targets visible."""
        self.pane.fit(self.deformation.shown, self.deformation.pose.targets)

    def when_drawn(self, callback: Callable[[], None]) -> None:
        """Call ``callback`` once, when the page says that it has drawn the canvas."""
        self._when_drawn.append(callback)

    def close(self) -> None:
        """Remove the canvas from the page and free its renderers; a model of its own ends too."""
        if not self._complete:
            return
        self._stop()
        with self._drawing:
            self._closed = True
            for pane in (self.pane, self.source):
                if pane is not None:
                    pane.close()
        if self._owns_model:
            self.deformation.close()
        self.layout.close()
        super().close()

    def _pane(self, size: tuple[int, int], interactive: bool) -> Pane:
        model = self.deformation
        map_ = model.map if interactive else model.state.identity
        pane = Pane(
            self.image,
            map_,
            model.state.current.energy,
            size,
            interactive=interactive,
            n_vertices=self._n_vertices,
            evaluated_in=self._evaluated_in,
        )
        pane.stage.observe(lambda _: self._adapt(pane), ["uniform_vectors", "drawing_time"])
        return pane

    def _adapt(self, pane: Pane) -> None:
        with self._drawing:
            if not self._closed and pane.adapt():
                self._draw()
                self._show_panels()

    def _resize(self, _: Any = None) -> None:
        self.layout.height = f"{self.pane.stage.height}px"

    # From the model

    def _on_model(self, what: str) -> None:
        """A change of the model, told in whichever thread made it."""
        if what in ("state", "frame", "selection"):
            self._draw()
        if what == "frame":
            self._show_panels()
            if self.deformation.solved:
                with self._drawing:
                    if not self._closed:
                        self.pane.fit_range(widen_only=bool(self.deformation.dragged))
                        self._place_legend()
        if what in ("frame", "status"):
            self._release()

    def _draw(self) -> None:
        with self._drawing:
            if self._closed:
                return
            state = self.deformation.state
            comparison = self.deformation.comparison
            pose, map_ = state.pose, state.map
            shown = map_ if comparison is None else comparison
            images = shown(pose.handles) if len(pose) else np.empty((0, 2))
            self.pane.show(map_, pose.targets, images, self.deformation.selection)
            self.pane.show_comparison(comparison)
            self._fit_range()
            if self.overlay == "energy":
                self.pane.show_overlay(self.overlay, state.current.energy)
            if self.source is not None:
                empty = np.empty((0, 2))
                self.source.show(state.identity, empty, pose.handles, ())

    def _fit_range(self) -> None:
        """Colours stay comparable during a drag: a range then only grows."""
        moving, now = self.deformation.busy or bool(self.deformation.dragged), time.monotonic()
        if not moving or now - self._range_at > _PANELS_INTERVAL:
            self._range_at = now
            self.pane.fit_range(widen_only=moving)

    def _release(self) -> None:
        """Acknowledge: the frame that the events led to is on its way, or none will come."""
        with self._waiting_lock:
            waiting, self._waiting = self._waiting, {}
        for view, number in waiting.items():
            self.pane.stage.acknowledge(view, number)

    # From the page

    def _receive(self, _: Any, message: dict[str, Any], __: Any) -> None:
        if "drawn" in message:
            self.deformation.begin()
            waiting, self._when_drawn = self._when_drawn, []
            for callback in waiting:
                callback()
            return
        events = message["events"]
        stage = self.pane.stage
        try:
            with self._receiving:
                notice = self.gestures.handle(events)
        except Exception as error:
            stage.notice = f"{type(error).__name__}: {error}"  # shown, and logged by the kernel
            raise
        else:
            stage.notice = notice
            stage.set_trait("cursor", self.gestures.cursor)
        finally:
            with self._waiting_lock:
                self._waiting[message["view"]] = events[-1]["seq"]
            # The solver paces the hand: while it works, its next frame acknowledges.
            if not self.deformation.busy:
                self._release()

    # From code and menus

    def _show_overlay(self, _: Any = None) -> None:
        with self._drawing:
            self.pane.show_overlay(self.overlay, self.deformation.state.current.energy)
            self._place_legend()

    def _place_legend(self) -> None:
        """Not during a drag, where it would jump."""
        stage = self.pane.stage
        if (stage.legend or stage.panel_legend) and not self.deformation.dragged:
            self.pane.place_legend(self.deformation.shown, self.deformation.pose.targets)

    def _show_lines(self, _: Any = None) -> None:
        with self._drawing:
            for pane in (self.pane, self.source):
                if pane is not None:
                    pane.show_lines(self.show_cage, self.show_offset_cage)

    def _on_show_panels(self, _: Any) -> None:
        with self._drawing:
            self._show_panels()
            self._place_legend()

    def _show_panels(self) -> None:
        with self._drawing:
            if self._closed:
                return
            frame = self.deformation.frame
            if not self.show_panels:
                self.pane.show_panels(None, np.empty(0))
                return
            now = time.monotonic()
            if frame is None or frame.panels is None or not len(frame.sigma2_lower):
                panels = self.deformation.certificate.panels
                self.pane.show_panels(_as_panels(panels), panels.sigma2_lower)
            elif frame.solution is not None or now - self._panels_at > _PANELS_INTERVAL:
                self._panels_at = now
                self.pane.show_panels(frame.panels, frame.sigma2_lower)

    def _show_source(self, _: Any = None) -> None:
        with self._drawing:
            if self.show_source and self.source is None:
                self._open_source()
            elif not self.show_source and self.source is not None:
                self._close_source(self.source)

    def _open_source(self) -> None:
        # The two share the room that the result had.
        stage, width = self.pane.stage, round(_SOURCE_SHARE * self.pane.stage.width)
        stage.width -= width
        self.source = self._pane((width, stage.height), interactive=False)
        self.source.show_lines(self.show_cage, self.show_offset_cage)
        self.children = [self.source, self.pane]
        self._draw()
        self.fit()

    def _close_source(self, closing: Pane) -> None:
        self.source = None
        self.children = [self.pane]
        self.pane.stage.width += closing.stage.width
        closing.close()
        self.fit()


def _as_panels(proof: PanelCertificate) -> Panels:
    start, end = (points @ np.array([1, 1j]) for points in (proof.start, proof.end))
    return Panels(start, end, proof.loop, proof.depth, np.empty(0, dtype=int))
