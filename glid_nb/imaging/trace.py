"""Trace a cage from a picture."""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Any, TypeVar

import numpy as np
import shapely
from numpy.typing import NDArray

from glid_nb._arguments import check_keywords
from glid_nb.geometry import Cage
from glid_nb.imaging.foreground import Foreground, find_foreground, smoothed
from glid_nb.imaging.frame import PixelFrame, TraceError
from glid_nb.imaging.holes import Dilation, Hole, choose_holes, dilate, filled_mask
from glid_nb.imaging.options import TraceOptions
from glid_nb.imaging.outline import Component, Components, Outline, find_components, find_outline
from glid_nb.imaging.read import RGBA, ImageSource, read_image
from glid_nb.imaging.scribbles import scaled_picture
from glid_nb.imaging.simplify import Simplified, simplify

_CUT_OFF = 0.002  # a larger share of the shape's area outside the cage is worth a note
_LEFT_OUT = 0.01  # a larger share of the foreground in other components is worth a note
# A foreground that was found automatically may be only a guess.
# _NEAR: pixels are doubtful if their score is this close to the threshold.
# _UNSURE: it is a guess if the doubtful share of the picture is larger.
# _UNSURE_BY_BRIGHTNESS: the same limit for the method "threshold".
# _CLUTTER: it is a guess if it has more components.
# Cut-outs on one colour, noisy or compressed, have a doubtful share of at most 0.04 and some 30
# components. Photographs have more.
_NEAR, _UNSURE, _UNSURE_BY_BRIGHTNESS, _CLUTTER = 0.05, 0.05, 0.01, 50

T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class Tracing:
    """A traced cage and how it was made."""

    cage: Cage
    """The boundary P, in world coordinates."""
    mask: NDArray[np.bool_]
    """(h, w) read-only mask of the shape's pixels; dropped holes are filled."""
    frame: PixelFrame
    """Conversion between pixel and world coordinates."""
    notes: tuple[str, ...]
    """Sentences about automatic choices, filled holes, moved vertices and repairs."""
    doubt: str
    """Why the foreground is a guess; empty if it is clear or the options define it."""
    method: str
    """How the foreground was found; never ``"auto"``."""
    threshold: float
    offset: float
    simplify: float
    """The values used, given or automatic; threshold, offset and simplify as in `TraceOptions`."""
    component: Component
    """The component that was traced."""
    components: tuple[Component, ...]
    """The largest components of the foreground, at most fifty."""
    n_components: int
    """Number of all components of the foreground."""
    outline: NDArray[np.float64]
    """(n, 2) read-only, the shape's exterior outline in pixel coordinates before the offset."""
    holes: tuple[Hole, ...]
    """The shape's holes, kept or not, the largest first; then the holes that the offset made."""
    n_filled: int
    """Number of filled holes, including the many small ones that are not in `holes`."""


def trace(image: ImageSource, options: TraceOptions | None = None, **changes: Any) -> Tracing:
    """Trace a cage around the shape in a picture. `read_image` lists the accepted kinds of image.

    The default options suit most drawings and many photographs. ``changes`` sets fields of
    `TraceOptions` by keyword. Raises a TraceError for a wrong option or a picture without a shape.

    >>> import numpy as np
    >>> y, x = np.mgrid[:100, :100] + 0.5
    >>> disc = np.hypot(x - 50, y - 50) < 40
    >>> tracing = trace(disc, offset=0, simplify=0.2)
    >>> round(tracing.cage.area / (np.pi * 8**2), 2)
    1.0
    """
    return Tracer(image).trace(with_changes(options, changes))


def with_changes(options: TraceOptions | None, changes: dict[str, Any]) -> TraceOptions:
    """Replace fields of `options`. Raises a TraceError with a suggestion for an unknown name."""
    known = (field.name for field in fields(TraceOptions))
    check_keywords("trace", changes, known, TraceError)
    return replace(options if options is not None else TraceOptions(), **changes)


class Tracer:
    """Traces one picture repeatedly and reuses results that changed options do not affect.

    The stages are foreground, components, outline, holes, dilation and simplification. A stage runs
    again if one of its options, or a result that it depends on, has changed. Not thread-safe.
    `read_image` lists the accepted kinds of image. An array is not copied and must not be changed
    afterwards.
    """

    def __init__(self, image: ImageSource) -> None:
        self.image = read_image(image)  # the picture, (h, w, 4)
        self.frame = PixelFrame(*self.image.shape[1::-1])
        """Conversion between pixel and world coordinates."""
        self._stages: dict[str, tuple[tuple[Any, ...], Any]] = {}

    def trace(self, options: TraceOptions | None = None) -> Tracing:
        """Trace a cage, as `trace` does."""
        o = options if options is not None else TraceOptions()
        foreground = self.foreground(o)
        components = self._stage("components", find_components, foreground, o.threshold)
        rank = o.component if o.component_at is None else components.rank_at(o.component_at)
        outline = self._stage("outline", find_outline, foreground, components, o.threshold, rank)
        hole_options = (foreground.method, o.min_hole_area, o.keep_holes, o.drop_holes)
        holes, rule, hole_notes = self._stage("holes", choose_holes, outline, *hole_options)
        mask = self._stage("mask", filled_mask, outline, holes)
        dilation = self._stage("dilation", dilate, outline, holes, rule, o.offset)
        sizes = o.max_vertices, o.min_edge, o.max_edge
        simplified, cage = self._stage("cage", self._cage, dilation, o.simplify, *sizes)
        notes = (
            *foreground.notes,
            *_component_notes(components, rank, o),
            *outline.notes,
            *hole_notes,
            *dilation.notes,
            *simplified.notes,
            *self._stage("coverage", _coverage_notes, outline, holes, simplified),
        )
        return Tracing(
            cage=cage,
            mask=mask,
            frame=self.frame,
            notes=notes,
            doubt=self._stage("doubt", _doubt, foreground, len(components.areas), o),
            method=foreground.method,
            threshold=foreground.threshold(o.threshold),
            offset=dilation.offset,
            simplify=simplified.tolerance,
            component=outline.component,
            components=components.largest,
            n_components=len(components.areas),
            outline=outline.exterior,
            holes=dilation.listed,
            n_filled=outline.n_specks + sum(not hole.kept for hole in holes),
        )

    def foreground(self, options: TraceOptions) -> Foreground:
        """The smoothed foreground score, the first two stages."""
        o = options
        how = (o.method, o.invert, o.background, o.background_at, o.scribbles, self._scaled)
        rated = self._stage("rated", find_foreground, self.image, *how)
        return self._stage("foreground", smoothed, rated, o.smoothing)

    def _scaled(self, image: RGBA) -> NDArray[np.float64]:
        return self._stage("scaled", scaled_picture, image)

    def _cage(self, dilation: Dilation, *how: Any) -> tuple[Simplified, Cage]:
        loops, room = (dilation.exterior, *dilation.holes), dilation.least_offset
        simplified = simplify(loops, *how, offset=dilation.offset, room=room)
        to_world = self.frame.to_world
        return simplified, Cage(to_world(simplified.exterior), map(to_world, simplified.holes))

    def _stage(self, name: str, function: Callable[..., T], *inputs: Any) -> T:
        # Options are compared by value, arrays and results of stages by identity.
        if name not in self._stages or self._stages[name][0] != inputs:
            self._stages[name] = (inputs, function(*inputs))
        return self._stages[name][1]


def _doubt(foreground: Foreground, n_components: int, options: TraceOptions) -> str:
    told = (options.threshold, options.background, options.background_at) != (None, None, None)
    if told or options.method != "auto" or foreground.method not in ("color", "threshold"):
        return ""
    step = 1 + max(foreground.score.shape) // 1500  # a sample of a large picture is enough
    near = np.mean(np.abs(foreground.score[::step, ::step] - foreground.level()) < _NEAR)
    if foreground.method == "threshold" and near > _UNSURE_BY_BRIGHTNESS:
        return "the background has no single colour"
    if near > _UNSURE:
        return "much of the picture has nearly the background's colour"
    return f"the foreground falls into {n_components} pieces" if n_components > _CLUTTER else ""


def _component_notes(components: Components, rank: int, options: TraceOptions) -> list[str]:
    share = 1 - components.areas[rank] / components.areas.sum()
    if options.component_at is not None or options.component or share < _LEFT_OUT:
        return []
    count = len(components.areas) - 1
    what, were = ("component", "was") if count == 1 else ("components", "were")
    return [f"{count} smaller {what}, {share:.0%} of the foreground, {were} left out"]


def _coverage_notes(outline: Outline, holes: tuple[Hole, ...], simplified: Simplified) -> list[str]:
    shape = shapely.Polygon(outline.exterior, [hole.loop for hole in holes if hole.kept])
    cage = shapely.Polygon(simplified.exterior, simplified.holes)
    share = shape.difference(cage).area / shape.area
    cut = f"{share:.1%} of the shape lies outside the cage and is cut off"
    keeps = "a larger offset or a smaller simplify keeps more"
    return [f"{cut}; {keeps}"] if share >= _CUT_OFF else []
