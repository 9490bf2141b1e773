"""The model of the cage tracer: the user's choices, the resulting cage, and undo."""

import functools
import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal, Self

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from glid_nb._arrays import Array, number_pairs, read_only
from glid_nb.geometry import Cage, Domain, GeometryError, cut
from glid_nb.geometry.cage import check_distinct
from glid_nb.imaging import Hole, PixelFrame, Scribbles, TraceError, TraceOptions, Tracer, Tracing
from glid_nb.imaging.options import Point
from glid_nb.imaging.read import ImageSource, as_rgba8, read_image
from glid_nb.imaging.trace import with_changes
from glid_nb.session import loop_edits
from glid_nb.session.document import Document, DocumentPart
from glid_nb.session.look import Layers
from glid_nb.session.loop_edits import AnyLoops
from glid_nb.session.model import History, Undoable
from glid_nb.session.worker import weakly

Brush = Literal["foreground", "background"]

_SPECK = 0.005  # a smaller share of the traced component's area is no piece to keep
_KEPT_OUTCOMES = 12  # each holds a mask of the picture's size


@dataclass(frozen=True)
class TracingFault:
    """Why the shown loops are not a valid cage."""

    message: str  # what is wrong and what to do
    plain: str  # the same for display beside the picture, without code words and coordinates
    point: Point | None = None  # the place, (x, y) in pixels; None if there is no particular place


@dataclass(frozen=True, eq=False)
class TracingState:
    """The user's choices. Everything else follows from them, and undo restores them."""

    image: NDArray[np.uint8] | None = None
    """(h, w, 4) read-only uint8, or None before there is a picture."""
    options: TraceOptions = field(default_factory=TraceOptions)
    """How to trace. They contain scribbles only if the method uses them."""
    scribbles: Scribbles | None = None  # the painted strokes, used or not
    loops: AnyLoops | None = None
    """The loops as edited by hand, in world coordinates; None if they are as traced."""
    fallback: Domain | None = None
    """The last valid domain before this state. It is used if this state's loops are not valid."""
    name: str = ""  # the stem of the picture's file name; empty if the picture came from no file
    accepts_guess: bool = False  # whether an outline that is only a guess is the outline

    def __post_init__(self) -> None:
        used = self.options.method == "scribbles"
        strokes = (self.scribbles or _NO_SCRIBBLES) if used else None
        if strokes is not self.options.scribbles:
            vars(self).update(options=replace(self.options, scribbles=strokes))


@dataclass(frozen=True, eq=False)
class TracingOutcome:
    """The loops and the domain that result from a state."""

    tracing: Tracing | None
    """The result of automatic tracing; None if it failed, or the loops were drawn by hand."""
    loops: AnyLoops  # the loops to show, in world coordinates, valid or not
    domain: Domain | None  # from the loops if they are valid, else the state's fallback
    problems: tuple[TracingFault, ...]  # why the loops are not valid; empty if they are


_NO_SCRIBBLES = Scribbles([], [])


class TracingModel(Undoable[TracingState]):
    """Traces a cage from a picture, interactively, with undo; the model behind `CageTracer`.

    Every action makes a new immutable state. An action that is refused, by a TraceError or
    GeometryError, changes nothing. If the loops are not a valid cage (for example after a vertex
    was dragged across an edge, or with a threshold that leaves nothing), `problems` says where and
    why, and `cage` is the last valid one. Any thread may call the methods.

    Points are in pixels, x right and y down from the picture's top left corner. Consecutive actions
    with the same `gesture` (any value), such as the moves of one drag, are one step for undo.

    The image is as in `read_image`, or None to begin without one. The options are the initial ones.
    Raises a TraceError for a picture that cannot be read. A picture without a shape is no error but
    one of the `problems`.
    """

    def __init__(
        self, image: ImageSource | None = None, options: TraceOptions | None = None
    ) -> None:
        pixels, options = None if image is None else _pixels(image), options or TraceOptions()
        super().__init__(TracingState(pixels, options, options.scribbles, name=_name_of(image)))
        self._tracer: Tracer | None = None
        self._outcome_of = functools.lru_cache(_KEPT_OUTCOMES)(weakly(self._evaluate))

    @classmethod
    def from_document(cls, document: Document | DocumentPart, name: str = "") -> Self:
        """A model with the document's picture, options, scribbles and cage."""
        model = cls()
        options, loops = document.trace_options, document.cage.loops
        strokes = document.scribbles or options.scribbles
        state = TracingState(document.image, options, strokes, loops, document.domain, name)
        model.history = History(state)
        # If tracing reproduces the cage, it was not edited by hand. A guess was accepted then.
        tracing = model.outcome.tracing
        if tracing is not None and tracing.cage.equals(document.cage):
            model.history = History(replace(state, loops=None, accepts_guess=True))
        return model

    # State

    @property
    def image(self) -> NDArray[np.uint8] | None:
        """The picture, (h, w, 4) read-only uint8."""
        return self.state.image

    @property
    def frame(self) -> PixelFrame | None:
        """The conversion between pixels and world coordinates; None without a picture."""
        return None if self.image is None else PixelFrame(*self.image.shape[1::-1])

    @property
    def options(self) -> TraceOptions:
        """How to trace. They contain scribbles only if the method uses them."""
        return self.state.options

    @property
    def outcome(self) -> TracingOutcome:
        """The outcome of the state; computed on first use."""
        return self.outcome_of(self.state)

    def outcome_of(self, state: TracingState) -> TracingOutcome:
        """The outcome of another state of this model."""
        with self._lock:
            return self._outcome_of(state)

    @property
    def loops(self) -> tuple[NDArray[np.float64], ...]:
        """The shown loops, (n, 2) in pixels, valid or not; the exterior first. A guess is not
        shown."""
        frame = self.frame
        if frame is None or self.doubt:
            return ()
        return tuple(frame.to_pixel(p) for p in self.outcome.loops)

    @property
    def holes(self) -> tuple[Hole, ...]:
        """The holes of the shown shape, kept or not."""
        tracing = self.outcome.tracing
        return () if tracing is None or self.doubt else tracing.holes

    @property
    def cage(self) -> Cage | None:
        """The last valid cage, if any."""
        return None if self.domain is None else self.domain.cage

    @property
    def domain(self) -> Domain | None:
        """The domain of the last valid cage, if any."""
        return self.outcome.domain

    @property
    def problems(self) -> tuple[TracingFault, ...]:
        """Why the shown loops are not a valid cage; empty if they are."""
        return self.outcome.problems

    @property
    def doubt(self) -> str:
        """Why the outline is only a guess, as in `Tracing`; empty if it is clear or accepted.

        Such an outline is not shown: painting over the shape takes less time than correcting it.
        """
        tracing = self.outcome.tracing
        if tracing is None or self.edited or self.state.accepts_guess:
            return ""
        return tracing.doubt

    @property
    def edited(self) -> bool:
        """Whether vertices were edited by hand since the last tracing."""
        return self.state.loops is not None

    @property
    def has_discarded_edits(self) -> bool:
        """Whether the last step, such as another option, discarded edits by hand."""
        before = self.history.past[-1] if self.history.past else self.state
        return before.loops is not None and not self.edited and before.image is self.image

    # Actions

    def open(self, image: ImageSource, name: str | None = None) -> None:
        """Open another picture, with the default options. ``name`` defaults to its file's name."""
        self._step(TracingState(image=_pixels(image), name=_name_of(name or image)))

    def set_options(self, gesture: Any = None, **changes: Any) -> None:
        """Trace with other options (fields of `TraceOptions`). This discards edits by hand, and
        shows the outline even if it is a guess."""
        with self.locked():
            before = self.state
            if "scribbles" in changes:
                raise TraceError("scribbles are painted: use paint(...) and clear_scribbles()")
            if changes.get("method") == "scribbles":
                changes = {**changes, "scribbles": before.scribbles or _NO_SCRIBBLES}
            options = with_changes(before.options, changes)
            if options == before.options and before.loops is None:
                return
            new = replace(before, options=options, loops=None, accepts_guess=True)
            self._step(new, gesture)

    def pick_background(self, point: Point) -> None:
        """Use the colour of a pixel as background colour, and trace by colour distance."""
        self._check_inside(point)
        self.set_options(method="color", background=None, background_at=point, invert=None)

    def pick_component(self, point: Point) -> None:
        """Trace the component around a pixel."""
        self._check_inside(point)
        self.set_options(component=0, component_at=point)

    def paint(self, brush: Brush, stroke: ArrayLike) -> None:
        """Add a stroke, (k, 2) pixels, on the shape or on the background. Trace by scribbles."""
        with self.locked():
            old = self.state.scribbles or _NO_SCRIBBLES
            strokes = {"foreground": old.foreground, "background": old.background}
            if brush not in strokes:
                raise TraceError(f"there is no brush {brush!r}; use foreground or background")
            if isinstance(strokes[brush], np.ndarray):
                raise TraceError(f"the {brush} was given as a mask, which cannot be painted over")
            line = number_pairs(stroke, "a stroke must be a list of pixels (x, y)", TraceError)
            scribbles = Scribbles(**{**strokes, brush: (*strokes[brush], line)})
            options = replace(self.options, method="scribbles", scribbles=scribbles)
            self._step(replace(self.state, options=options, scribbles=scribbles, loops=None))

    def clear_scribbles(self) -> None:
        """Remove all strokes."""
        with self.locked():
            state = self.state
            if state.scribbles is not None:
                loops = None if state.options.method == "scribbles" else state.loops
                self._step(replace(state, scribbles=None, loops=loops))

    def accept_guess(self) -> None:
        """Show the guess, and use it as the outline."""
        with self.locked():
            if self.doubt:
                self._step(replace(self.state, accepts_guess=True))

    def toggle_hole(self, number: int) -> None:
        """Drop a kept hole, or keep a dropped one. Other loops keep their edits."""
        with self.locked():
            state, holes = self.state, self.holes
            if not 0 <= number < len(holes):
                raise TraceError(f"there is no hole {number}; there are {len(holes)}")
            hole = holes[number]
            region = shapely.Polygon(hole.loop)
            keep, drop = (
                [p for p in points if not shapely.contains_xy(region, *p)]
                for points in (state.options.keep_holes, state.options.drop_holes)
            )
            (drop if hole.kept else keep).append(hole.pixel)
            new = replace(state, options=replace(state.options, keep_holes=keep, drop_holes=drop))
            if state.loops is not None:
                new = replace(new, loops=self._loops_with(new, state.loops, hole))
            self._step(new)

    def move_vertex(self, loop: int, index: int, to: Point, gesture: Any = None) -> None:
        """Move a vertex of a shown loop."""
        at = self._world(to)
        self._edit(lambda loops: loop_edits.move_vertex(loops, loop, index, at), gesture)

    def insert_vertex(self, at: Point) -> tuple[int, int]:
        """Add a vertex on the edge nearest to a point. Returns its (loop, index)."""
        with self.locked():
            loops = self._shown_loops()
            loop, edge, foot = loop_edits.nearest_edge(loops, self._world(at))
            self._edit(lambda loops: loop_edits.insert_vertex(loops, loop, edge, foot))
        return loop, edge + 1

    def delete_vertices(self, vertices: Iterable[tuple[int, int]]) -> None:
        """Delete vertices (loop, index). Holes with fewer than three left are removed."""
        chosen = list(vertices)
        if chosen:
            self._edit(lambda loops: loop_edits.delete_vertices(loops, chosen))

    def discard_edits(self) -> None:
        """Go back to the loops as traced."""
        with self.locked():
            if self.edited:
                self._step(replace(self.state, loops=None))

    def set_loops(self, loops: AnyLoops, gesture: Any = None) -> None:
        """Replace the loops (world coordinates, exterior first) as an edit by hand."""
        self._edit(lambda _: loops, gesture)

    def draw(self, outline: ArrayLike | None = None) -> None:
        """Use an outline drawn by hand, (k, 2) pixels, as the cage; None: the whole picture."""
        if outline is None:
            frame = self._frame_of_picture()
            outline = shapely.get_coordinates(shapely.box(0, 0, frame.width, frame.height))
        self.set_loops((self._drawn(outline),))

    def draw_hole(self, outline: ArrayLike) -> None:
        """Cut a hole drawn by hand, (k, 2) pixels, out of the shown shape."""
        hole = self._drawn(outline)
        self._edit(lambda loops: (*loops, hole))

    def cut(
        self, line: ArrayLike, width: float | None = None, gesture: Any = None
    ) -> tuple[Cage, ...]:
        """Cut the shown shape along a line drawn by hand, (k, 2) pixels, as `glid_nb.cut` does.

        The largest piece becomes the cage. Returns all pieces, the largest first: `set_loops` with
        another one's loops keeps that one instead. ``width`` is in pixels.
        """
        with self.locked():
            frame, cage = self._frame_of_picture(), _cage_of(self._shown_loops())
            path = frame.to_world(loop_edits.drawn_line(line, (frame.width, frame.height)))
            world = None if width is None else width * frame.units_per_pixel
            pieces = cut(cage, path, world)
            self.set_loops(pieces[0].loops, gesture)
        return pieces

    def holds(self, outline: ArrayLike) -> bool:
        """Whether an outline drawn by hand, (k, 2) pixels, lies inside the shape, which is no
        guess."""
        exterior, *holes = self.outcome.loops or ((),)
        if not len(exterior) or self.doubt or self.outcome.problems:
            return False
        whole = shapely.Polygon(exterior, holes)
        return bool(shapely.contains_properly(whole, shapely.Polygon(self._drawn(outline))))

    def return_to(self, state: TracingState) -> None:
        """Restore an earlier state, with its fallback, as a new step."""
        with self.locked():
            if state is not self.state:
                self._go_to(self.history.step(state))

    def show(self, history: History[TracingState]) -> None:
        """Continue with another history, that of another part of the session."""
        with self.locked():
            self._go_to(history)

    def pieces(self, cages: Iterable[Cage] = ()) -> list[TracingState]:
        """The states that trace the other pieces of the picture, the largest first.

        They are those of some cages, or else the other components of the foreground, without
        specks.
        """
        with self.locked():
            state, tracing = self.state, self.outcome.tracing
            if cages := list(cages):
                return [replace(state, loops=cage.loops, fallback=None) for cage in cages]
            if tracing is None:
                return []
            least = _SPECK * tracing.component.area
            others = (c for c in tracing.components if c.rank != tracing.component.rank)
            changes = (
                {"component": c.rank, "component_at": None} for c in others if c.area > least
            )
            options = (with_changes(state.options, change) for change in changes)
            return [replace(state, options=o, loops=None, fallback=None) for o in options]

    def cancel(self, gesture: Any) -> bool:
        """Go back to the state before a gesture, without redo. Returns False if the gesture was
        not the last action."""
        with self.locked():
            under_way = gesture is not None and self.history.gesture == gesture
            return under_way and self._go_to(self.history.cancelled())

    # Internals

    def _step(self, state: TracingState, gesture: Any = None) -> None:
        with self.locked():
            before, history = self.state, self.history
            if gesture is not None and gesture == history.gesture:
                fallback = before.fallback  # valid cages within a gesture do not count
            else:
                fallback = self.outcome.domain if state.image is before.image else None
            new = replace(state, fallback=fallback)
            self.outcome_of(new)  # kept; if tracing raises, as without memory, nothing has changed
            self._go_to(history.step(new, gesture))

    def _edit(self, change: Callable[[AnyLoops], AnyLoops], gesture: Any = None) -> None:
        with self.locked():
            self._step(replace(self.state, loops=change(self.outcome.loops)), gesture)

    def _evaluate(self, state: TracingState) -> TracingOutcome:
        if state.image is None:
            return TracingOutcome(None, (), None, ())
        if self._tracer is None or self._tracer.image is not state.image:
            self._tracer = Tracer(state.image)
        frame, domain = self._tracer.frame, state.fallback
        loops, cage, problems = state.loops, None, ()
        try:
            tracing = self._tracer.trace(state.options)
        except (TraceError, GeometryError) as error:
            if loops is None:
                shown = () if domain is None else domain.cage.loops
                return TracingOutcome(None, shown, domain, (_problem(error, frame),))
            tracing = None  # loops drawn by hand need no tracing
        else:
            if loops is None:
                loops, cage = tracing.cage.loops, tracing.cage
            # Loops that were drawn by hand share no vertex with the traced ones.
            elif _vertices(loops).isdisjoint(_vertices(tracing.cage.loops)):
                tracing = None
        try:
            cage = _cage_of(loops) if cage is None else cage
            if domain is None or not cage.equals(domain.cage):
                domain = Domain.from_cage(cage)
        except GeometryError as error:
            problems = (_problem(error, frame),)
        return TracingOutcome(tracing, loops, domain, problems)

    def _loops_with(self, state: TracingState, loops: AnyLoops, hole: Hole) -> AnyLoops:
        inside = self._world(hole.pixel)
        if hole.kept:
            index = loop_edits.around(loops, inside)
            return loops if index is None else (*loops[:index], *loops[index + 1 :])
        tracing = self._evaluate(replace(state, loops=None)).tracing
        traced = () if tracing is None else tracing.cage.loops
        index = loop_edits.around(traced, inside)
        return loops if index is None else (*loops, traced[index])

    def _world(self, point: Point) -> NDArray[np.float64]:
        return self._frame_of_picture().to_world(loop_edits.checked_point(point))

    def _check_inside(self, point: Point) -> None:
        x, y = loop_edits.checked_point(point)
        self._frame_of_picture().index_at((float(x), float(y)))

    def _drawn(self, outline: ArrayLike) -> Array:
        """The loop, in world coordinates, of an outline drawn by hand, (k, 2) pixels."""
        frame = self._frame_of_picture()
        size = frame.width, frame.height
        return read_only(frame.to_world(loop_edits.drawn(outline, size)))

    def _shown_loops(self) -> AnyLoops:
        if not (loops := self.outcome.loops) or self.doubt:
            raise GeometryError("there is no outline yet; trace or draw one first")
        return loops

    def _frame_of_picture(self) -> PixelFrame:
        if (frame := self.frame) is None:
            raise TraceError("there is no picture yet; open one first")
        return frame


def layers_of(document: Document) -> Layers:
    """What is drawn of a document, as in an editor that opens it."""
    tracing = TracingModel.from_document(document).outcome.tracing
    return Layers(document.image, tracing, document.cage, document.look)


def _cage_of(loops: AnyLoops) -> Cage:
    """The cage of drawn loops. Here a last vertex equal to the first one is an error, like any
    other pair of equal vertices."""
    for number, loop in enumerate(loops):
        check_distinct(np.asarray(loop), number, 0.0)
    return Cage(loops[0], loops[1:])


def _vertices(loops: AnyLoops) -> set[tuple[float, ...]]:
    return {tuple(vertex) for loop in loops for vertex in loop.tolist()}


def _problem(error: TraceError | GeometryError, frame: PixelFrame) -> TracingFault:
    point = error.point if isinstance(error, GeometryError) else None
    if point is not None:
        x, y = frame.to_pixel(point)
        point = (float(x), float(y))
    return TracingFault(str(error), error.plain, point)


def _name_of(image: ImageSource | None) -> str:
    named = image if isinstance(image, (str, os.PathLike)) else getattr(image, "filename", "")
    return Path(named).stem


def _pixels(image: ImageSource) -> NDArray[np.uint8]:
    pixels = as_rgba8(read_image(image))
    return read_only(pixels.copy()) if pixels.flags.writeable else pixels  # not the caller's array
