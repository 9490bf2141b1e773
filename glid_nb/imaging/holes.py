"""Which holes of a shape stay holes of its cage."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from glid_nb.imaging.options import Point
from glid_nb.imaging.outline import Outline

# Least area of a hole, relative to the component and in square pixels. Holes in the alpha channel
# are intended; those found by colour may be eyes or highlights.
_LEAST_SHARE, _LEAST_SHARE_BY_COLOR, _LEAST_AREA = 0.002, 0.0075, 9.0


@dataclass(frozen=True, eq=False)
class Hole:
    """A hole, kept or filled.

    Attributes
    ----------
    loop
        (k, 2) read-only vertices in pixel coordinates, before the offset.
    area
        In square pixels.
    bounds
        Bounding box (xmin, ymin, xmax, ymax) in pixel coordinates.
    pixel
        A point (x, y) in the hole, for `TraceOptions.keep_holes` and `drop_holes`.
    kept
        Whether the cage has it.
    by_offset
        Whether the offset made it, by closing a bay.
    """

    loop: NDArray[np.float64]
    area: float
    bounds: tuple[float, float, float, float]
    pixel: Point
    kept: bool
    by_offset: bool = False


class HoleRule(NamedTuple):
    """Which holes are kept: those of a least area in square pixels, with exceptions by pixels."""

    min_area: float
    min_bay_area: float  # for holes that the offset makes, which cannot be eyes or highlights
    keep: Sequence[Point]
    drop: Sequence[Point]

    def hole(self, loop: NDArray[np.float64], by_offset: bool = False) -> Hole:
        region = shapely.Polygon(loop)
        pixel = shapely.point_on_surface(region)
        large = region.area >= (self.min_bay_area if by_offset else self.min_area)
        kept = (large or _holds_any(loop, self.keep)) and not _holds_any(loop, self.drop)
        return Hole(loop, region.area, region.bounds, (pixel.x, pixel.y), kept, by_offset)


def choose_holes(
    outline: Outline,
    method: str,
    min_hole_area: float | None = None,
    keep: Sequence[Point] = (),
    drop: Sequence[Point] = (),
) -> tuple[tuple[Hole, ...], HoleRule, tuple[str, ...]]:
    """The holes of an outline, the rule for those that the offset makes later, and notes.

    `method` is the one that found the foreground; the other parameters are those of `TraceOptions`.
    """
    least = least_bay = min_hole_area
    if least is None or least_bay is None:
        share = _LEAST_SHARE_BY_COLOR if method in ("color", "threshold") else _LEAST_SHARE
        least = max(share * outline.component.area, _LEAST_AREA)
        least_bay = max(_LEAST_SHARE * outline.component.area, _LEAST_AREA)
    least = max(least, outline.speck)
    rule = HoleRule(least, least_bay, keep, drop)
    holes = tuple(map(rule.hole, outline.holes))
    filled = [h for h in holes if not h.kept and not _holds_any(h.loop, drop)]
    notes = []
    if filled or outline.n_specks:
        count = len(filled) + outline.n_specks
        notes.append(
            f"{count} small {'hole was' if count == 1 else 'holes were'} filled; the least area is "
            f"{least:.4g} square pixels"
        )
    for name, points in (("keep_holes", keep), ("drop_holes", drop)):
        notes += [
            f"{name}: there is no hole at the pixel ({x:g}, {y:g})"
            for x, y in points
            if not any(_holds_any(hole.loop, ((x, y),)) for hole in holes)
        ]
    return holes, rule, tuple(notes)


def filled_mask(outline: Outline, holes: tuple[Hole, ...]) -> NDArray[np.bool_]:
    """(h, w) read-only mask of the component with the holes that are not kept filled."""
    mask = outline.inside.copy()
    dropped = [hole for hole in holes if not hole.kept]
    if dropped:
        filling = Image.new("1", mask.shape[::-1])
        for hole in dropped:
            # This also fills the pixels on the hole's outline, which belong to the shape.
            ImageDraw.Draw(filling).polygon((hole.loop - 0.5).ravel().tolist(), fill=1, outline=1)
        mask |= np.asarray(filling)
    mask.setflags(write=False)
    return mask


def _holds_any(loop: NDArray[np.float64], points: Sequence[Point]) -> bool:
    """Whether a loop goes around one of the points."""
    return any(shapely.contains_xy(shapely.Polygon(loop), *point) for point in points)
