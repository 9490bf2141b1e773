"""The meaning of pointers and keys on the tracer, without a browser."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from glid_nb._arrays import Array
from glid_nb.geometry import Cage
from glid_nb.imaging import TraceError, read_image
from glid_nb.session import loop_edits
from glid_nb.session.tracing import TracingModel, TracingState
from glid_nb.widgets.gestures import ARROWS, LEFT, OF_A_HAND, RIGHT, Event, Gestures, asked, place

Vertex = tuple[int, int]  # index of the loop, and index of the vertex in it

_CLICK = 4.0  # CSS pixels that the pointer may move during a click
_DOUBLE, _DOUBLE_SLACK = 380.0, 12.0  # of a double click: most ms and CSS pixels between clicks
_BURST = 900.0  # a pause of this many ms between keys ends a burst of nudges
_NUDGE, _NUDGE_SHIFT = 1.0, 10.0  # pixels of the picture
REACH_SHARES = {"in_hole": 0.6, "edge": 0.8}  # the page gets them from here
"""Shares of the reach. It is smaller in a hole, so that the middle of a small hole can be clicked.
"""
_TOOLS = ("edit", "foreground", "background", "color", "component", "polygon", "rectangle", "knife")
_FREEHAND = 30.0  # CSS pixels; a longer path is drawn freehand, not a click
_LARGEST_UPLOAD = 64 << 20


@dataclass(frozen=True)
class Found:
    """The objects at a place: a vertex, otherwise whether there is an edge, and the hole around."""

    vertex: Vertex | None = None
    edge: bool = False
    hole: int | None = None


@dataclass(eq=False)
class _TracerPress:
    """A pressed pointer. The object also identifies its gesture for the model."""

    tool: str
    start: Array
    found: Found
    offset: Array = field(default_factory=lambda: np.zeros(2))  # from pointer to the vertex
    moved: bool = False


@dataclass(frozen=True, eq=False)
class Cut:
    """What the knife did last."""

    pieces: tuple[Cage, ...]  # the largest first
    kept: int  # which of them is the cage now
    in_middle: bool  # whether the slit is a hole
    state: TracingState  # of the model after it, to see whether something else has happened since
    gesture: object  # cutting and choosing a piece are one step for undo


class TraceGestures(Gestures):
    """Gestures that edit and paint a tracing, also for the panel. Places are in picture pixels."""

    def __init__(self, model: TracingModel) -> None:
        own = (*OF_A_HAND, "tool", "upload", "undo")
        plain = ("accept_guess", "clear_scribbles", "discard_edits", "redo", "draw")
        actions = {kind: getattr(self, f"_{kind}") for kind in own}
        actions |= {kind: asked(getattr(model, kind)) for kind in plain}
        actions["knife"] = asked(self._set_knife, "width")
        actions["drawn_as"] = self._drawn_as
        actions["keep_piece"] = asked(self._keep_piece, "number")
        actions["toggle_hole"] = asked(model.toggle_hole, "number")
        actions["set_options"] = lambda e: model.set_options(e.get("gesture"), **e["changes"])
        super().__init__(model, actions)
        self.model = model
        self.tool = "edit"  # the tool of the left button, one of _TOOLS
        self.corners: tuple[tuple[float, float], ...] = ()  # of an unfinished polygon
        self.inside: list[Any] = []
        """An outline that was drawn inside the shape; the page asks what it should be."""
        self.knife_width: float | None = None
        """Of the knife's slit, in pixels; None: as `TracingModel.cut` chooses."""
        self._cut: Cut | None = None
        self._selected: tuple[Vertex, ...] = ()
        self._press: _TracerPress | None = None
        self._last_click = (-np.inf, np.zeros(2))
        self._last_nudge = -np.inf
        self._burst: object = None
        self._incoming = "", bytearray()

    @property
    def selected(self) -> tuple[Vertex, ...]:
        """The vertices that keys act on."""
        sizes = [len(loop) for loop in self.model.loops]
        return tuple((i, j) for i, j in self._selected if i < len(sizes) and j < sizes[i])

    @property
    def cut(self) -> Cut | None:
        """What the knife did last, if nothing else has happened since."""
        return self._cut if self._cut and self._cut.state is self.model.state else None

    def begin(self) -> None:
        """Choose the tool for a picture that was just opened: its shape is painted if the outline
        is only a guess."""
        self.tool = "foreground" if self.model.doubt else "edit"
        self.corners, self.inside = (), []

    def find(self, point: Array, reach: float) -> Found:
        """The objects at a point."""
        holes = self.model.holes
        around = [i for i, hole in enumerate(holes) if loop_edits.contains(hole.loop, point)]
        hole = min(around, key=lambda i: holes[i].area) if around else None
        reach = reach if hole is None else REACH_SHARES["in_hole"] * reach
        loops = self.model.loops
        gaps = [np.hypot(*(loop - point).T) for loop in loops]
        nearest = [(float(gap.min()), (i, int(gap.argmin()))) for i, gap in enumerate(gaps)]
        least, vertex = min(nearest, default=(np.inf, None))
        if vertex is not None and least <= reach:
            return Found(vertex, hole=hole)
        foot = loop_edits.nearest_edge(loops, point)[2] if loops else point + np.inf
        near = np.hypot(*(foot - point)) <= REACH_SHARES["edge"] * reach
        return Found(edge=bool(near), hole=hole)

    # Pointers

    def _down(self, event: Event) -> None:
        if self.model.image is None:
            return
        self.inside = []
        point = place(event)
        found = self.find(point, event["reach"]) if self.tool == "edit" else Found()
        vertex = found.vertex
        if event["button"] == RIGHT:
            if vertex is not None:
                self._delete(vertex)
        elif event["button"] == LEFT:
            if vertex is None:
                self._press = _TracerPress(self.tool, point, found)
            elif event["shift"] and vertex in self.selected:
                self._selected = tuple(v for v in self.selected if v != vertex)
            else:
                self._selected = (*self.selected, vertex) if event["shift"] else (vertex,)
                offset = self.model.loops[vertex[0]][vertex[1]] - point
                self._press = _TracerPress(self.tool, point, found, offset)

    def _move(self, event: Event) -> None:
        press, point = self._press, place(event)
        if press is None or press.found.vertex is None:
            return  # the page itself moves the view or paints a path
        press.moved |= np.hypot(*(point - press.start)) > _CLICK * event["unit"]
        if press.moved:
            x, y = point + press.offset
            self.model.move_vertex(*press.found.vertex, (x, y), press)

    def _up(self, event: Event) -> None:
        press, self._press = self._press, None
        if press is None or press.found.vertex is not None:
            return
        if press.tool in ("foreground", "background"):
            self.model.paint(press.tool, event.get("path") or [place(event)])
        elif press.tool in ("color", "component"):
            what = "background" if press.tool == "color" else "component"
            getattr(self.model, f"pick_{what}")(tuple(place(event)))
            self.tool = "edit"
        elif press.tool == "rectangle":
            (left, top), (right, bottom) = press.start, place(event)
            self._draw([(left, top), (right, top), (right, bottom), (left, bottom)])
        elif press.tool == "polygon":
            self._corner(event)
        elif press.tool == "knife":
            self._slit(event.get("path") or [place(event)])
        else:
            self._click(press.found, event)

    def _corner(self, event: Event) -> None:
        """Add a corner, or close the polygon. A click on its first corner, a double click or a line
        drawn freehand closes it."""
        path = np.array(event.get("path") or [place(event)])
        far = np.hypot(*(path - path[0]).T).max() > _FREEHAND * event["unit"]
        closed = len(self.corners) > 2 and self._is_near(self.corners[0], path[-1], event)
        if far or closed:
            self._draw([*self.corners, *(path if far else ())])
        elif not self.corners or not self._is_near(self.corners[-1], path[-1], event):
            self.corners = (*self.corners, tuple(path[-1].tolist()))
        elif len(self.corners) > 2:  # a double click
            self._draw(self.corners)

    def _is_near(self, corner: tuple[float, float], point: Array, event: Event) -> bool:
        return bool(np.hypot(*(corner - point)) <= event["reach"])

    def _draw(self, outline: Sequence[Any]) -> None:
        self.corners = ()
        if self.model.holds(outline):
            self.inside = np.asarray(outline, dtype=float).tolist()
        else:
            self.model.draw(outline)
        self.tool = "edit"

    def _drawn_as(self, event: Event) -> None:
        """The outline inside the shape is a "hole", or the new "outline"; else it is dropped."""
        outline, self.inside = self.inside, []
        if outline and event["what"] == "hole":
            self.model.draw_hole(outline)
        elif outline and event["what"] == "outline":
            self.model.draw(outline)

    def _slit(self, line: Sequence[Any]) -> None:
        """Cut along a line. If the shape falls apart, the page offers the other pieces."""
        gesture, before = object(), len(self.model.outcome.loops)
        pieces = self.model.cut(line, self.knife_width, gesture)
        in_middle = len(pieces) == 1 and len(pieces[0].loops) > before
        self._cut = Cut(pieces, 0, in_middle, self.model.state, gesture)

    def pieces(self) -> list[TracingState]:
        """The other pieces: those of the last cut, or else of the picture."""
        cut = self.cut
        others = [] if cut is None else [p for i, p in enumerate(cut.pieces) if i != cut.kept]
        return self.model.pieces(others)

    def _set_knife(self, width: float | None) -> None:
        if width is not None and not 0 < width < np.inf:
            raise TraceError(f"the knife's width must be above 0 pixels, not {width:g}")
        self.knife_width = width

    def _keep_piece(self, number: int) -> None:
        """Keep another piece of the last cut."""
        if (cut := self.cut) is None or not 0 <= number < len(cut.pieces):
            raise TraceError("there is no such piece; cut again")
        self.model.set_loops(cut.pieces[number].loops, cut.gesture)
        self._cut = replace(cut, kept=number, state=self.model.state)

    def _click(self, found: Found, event: Event) -> None:
        point, (before, at) = place(event), self._last_click
        near = np.hypot(*(point - at)) < _DOUBLE_SLACK * event["unit"]
        double = near and event["time"] - before < _DOUBLE
        self._last_click = (-np.inf if double else event["time"], point)
        if found.edge:
            if double:
                self.model.insert_vertex(tuple(point))
        elif found.hole is not None:
            self.model.toggle_hole(found.hole)
        else:
            self._selected = ()

    def _cancel(self, _: Event) -> None:
        press, self._press = self._press, None
        self.model.cancel(press)

    def _delete(self, *vertices: Vertex) -> None:
        self._selected = ()
        self.model.delete_vertices(vertices)

    # Keys

    def _key(self, event: Event) -> None:
        key = event["key"]
        if key == "Escape":
            if self._press is not None:
                self._cancel(event)
            elif self.inside:
                self.inside = []
            elif self.corners:
                self.corners = ()
            elif self.tool != "edit":
                self.tool = "edit"
            else:
                self._selected = ()
        elif key in ("Delete", "Backspace"):
            self._delete(*self.selected)
        elif key == "Enter" and self.corners:
            self._draw(self.corners)
        elif key in ARROWS:
            self._nudge(event)
        elif key in ("[", "]"):
            self._select_next(1 if key == "]" else -1)
        elif key == "undo":
            self._undo(event)
        elif key == "redo":
            self.model.redo()

    def _nudge(self, event: Event) -> None:
        """Move the selected vertex. Keys in quick succession are one step for undo."""
        if len(self.selected) != 1:
            return
        if event["time"] - self._last_nudge >= _BURST:
            self._burst = object()
        self._last_nudge = event["time"]
        ((loop, index),) = self.selected
        right, up = ARROWS[event["key"]]
        step = np.array([right, -up]) * (_NUDGE_SHIFT if event["shift"] else _NUDGE)
        self.model.move_vertex(loop, index, self.model.loops[loop][index] + step, self._burst)

    def _select_next(self, step: int) -> None:
        every = [(i, j) for i, loop in enumerate(self.model.loops) for j in range(len(loop))]
        if every:
            now = every.index(self.selected[-1]) if self.selected else min(-step, 0)
            self._selected = (every[(now + step) % len(every)],)

    # The toolbar and the panel

    def _tool(self, event: Event) -> None:
        if event["name"] not in _TOOLS:
            raise TraceError(f"there is no tool {event['name']!r}")
        self.tool, self.corners, self.inside = event["name"], (), []

    def _undo(self, event: Event) -> None:
        if self._press is not None:
            self._cancel(event)
        elif self.inside:
            self.inside = []
        elif self.corners:
            self.corners = self.corners[:-1]
        else:
            self.model.undo()

    def _upload(self, event: Event) -> None:
        """Receive a part of a file, because websocket messages have a size limit."""
        name, size, start = event["name"], event["size"], event["start"]
        if start == 0:
            self._incoming = name, bytearray()
        known, data = self._incoming
        if (name, start) != (known, len(data)):
            raise TraceError(f"{name}: the upload was interrupted; try again")
        if size > _LARGEST_UPLOAD:
            raise TraceError(f"{name} has {size:,} bytes; only {_LARGEST_UPLOAD:,} can be uploaded")
        data += bytes(event["data"])
        if len(data) >= size:
            self._incoming = "", bytearray()
            self.model.open(read_image(bytes(data), name), name)
