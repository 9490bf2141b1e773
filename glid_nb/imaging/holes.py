"""Choose the holes that a cage keeps, and offset the outline."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from glid_nb._arrays import Array, read_only
from glid_nb.imaging.options import Point
from glid_nb.imaging.outline import Outline, ring_loop, thinned

# The least area of a kept hole.
# _LEAST_SHARE: relative to the component. Holes in the alpha channel are intended.
# _LEAST_SHARE_BY_COLOR: the same for holes found by colour, which may be eyes or highlights.
# _LEAST_AREA: in square pixels.
_LEAST_SHARE, _LEAST_SHARE_BY_COLOR, _LEAST_AREA = 0.002, 0.0075, 9.0
# The automatic offset.
# _OFFSET: relative to the square root of the shape's area.
# _LEAST_OFFSET: the least, in pixels.
# _MOST_OFFSET: the largest share of the square root of the area that this least may be.
_OFFSET, _LEAST_OFFSET, _MOST_OFFSET = 0.01, 2.0, 0.05
_SLIT = 0.5  # slits up to twice this many offsets wide are closed
_ROUGH, _FINE = 0.05, 0.03  # tolerances of simplification before and after, times the offset
_SHRUNK = 0.2  # a hole that would keep less than this share of its area gets a smaller offset


@dataclass(frozen=True, eq=False)
class Hole:
    """A hole of the shape. The cage keeps it or fills it."""

    loop: NDArray[np.float64]
    """(k, 2) read-only vertices in pixel coordinates, before the offset."""
    area: float
    """Area in square pixels."""
    bounds: tuple[float, float, float, float]
    """Bounding box (xmin, ymin, xmax, ymax) in pixel coordinates."""
    pixel: Point
    """A point (x, y) in the hole, for `TraceOptions.keep_holes` and `drop_holes`."""
    kept: bool
    """Whether the cage has this hole."""
    by_offset: bool = False
    """Whether the offset made this hole by closing a bay."""

    @property
    def place(self) -> str:
        """`pixel` for messages."""
        return f"({self.pixel[0]:.0f}, {self.pixel[1]:.0f})"


class HoleRule(NamedTuple):
    """The rule for keeping holes: a least area in square pixels, with exceptions by pixels."""

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
    """The holes of an outline found by `method`, the rule for holes that the offset makes, and
    notes."""
    by_color = _LEAST_SHARE_BY_COLOR if method in ("color", "threshold") else _LEAST_SHARE
    least, least_bay = (
        max(share * outline.component.area, _LEAST_AREA) if min_hole_area is None else min_hole_area
        for share in (by_color, _LEAST_SHARE)
    )
    rule = HoleRule(max(least, outline.speck), least_bay, keep, drop)
    holes = tuple(map(rule.hole, outline.holes))
    notes = []
    filled = sum(not hole.kept and not _holds_any(hole.loop, drop) for hole in holes)
    if count := filled + outline.n_specks:
        what = "hole was" if count == 1 else "holes were"
        least_area = f"the least area is {rule.min_area:.4g} square pixels"
        notes.append(f"{count} small {what} filled; {least_area}")
    for name, points in (("keep_holes", keep), ("drop_holes", drop)):
        missed = (p for p in points if not any(_holds_any(hole.loop, [p]) for hole in holes))
        notes += [f"{name}: there is no hole at the pixel ({x:g}, {y:g})" for x, y in missed]
    return holes, rule, tuple(notes)


def filled_mask(outline: Outline, holes: tuple[Hole, ...]) -> NDArray[np.bool_]:
    """(h, w) read-only mask of the component, where all holes that are not kept are filled."""
    filling = Image.new("1", outline.inside.shape[::-1])
    for hole in holes:
        if not hole.kept:
            # This also fills the pixels on the hole's outline, which belong to the shape.
            ImageDraw.Draw(filling).polygon((hole.loop - 0.5).ravel().tolist(), fill=1, outline=1)
    return read_only(outline.inside | np.asarray(filling))


def _holds_any(loop: NDArray[np.float64], points: Sequence[Point]) -> bool:
    return any(shapely.contains_xy(shapely.Polygon(loop), *point) for point in points)


@dataclass(frozen=True, eq=False)
class Dilation:
    """An outline after the offset, in pixel coordinates."""

    exterior: NDArray[np.float64]
    holes: tuple[NDArray[np.float64], ...]
    offset: float
    least_offset: float  # the smallest that a narrow hole got
    listed: tuple[Hole, ...]  # all holes; those made by the offset come last
    notes: tuple[str, ...]


def dilate(
    outline: Outline, holes: tuple[Hole, ...], rule: HoleRule, offset: float | None = None
) -> Dilation:
    """Move the exterior outwards and the kept holes inwards by `TraceOptions.offset`."""
    shape = shapely.Polygon(outline.exterior)
    size = float(np.sqrt(shape.area))
    largest = max(_OFFSET * size, min(_LEAST_OFFSET, _MOST_OFFSET * size))
    tried = []
    for chosen in (largest, 0.5 * largest, 0.25 * largest) if offset is None else (offset,):
        grown = thinned(_moved(shape, chosen, 1)[0], _FINE * chosen) if chosen > 0 else shape
        bays = [rule.hole(ring_loop(ring), by_offset=True) for ring in grown.interiors]
        tried.append((chosen, grown, bays))
        if not any(bay.kept for bay in bays):
            break
    else:
        tried.append(tried[0])
    chosen, grown, bays = tried[-1]
    notes: list[str] = []
    loops: list[NDArray[np.float64]] = []
    least = chosen
    for hole in (hole for hole in holes if hole.kept):
        parts, used = _shrunk(hole.loop, chosen, rule.min_area)
        loops += parts
        least = min(least, used)
        if used < chosen:
            narrow = f"the hole at {hole.place} is too narrow for an offset of {chosen:.3g} px"
            notes.append(f"{narrow}; it got {used:.3g} px")
        if len(parts) > 1:
            notes.append(f"the offset divided the hole at {hole.place} into {len(parts)}")
    for bay in (bay for bay in bays if bay.kept):
        loops.append(bay.loop)
        closed = f"the offset of {chosen:.3g} px closed a bay at {bay.place}, which became a hole"
        notes.append(f"{closed}; a smaller offset leaves it open")
    exterior = ring_loop(grown.exterior)
    return Dilation(exterior, tuple(loops), chosen, least, (*holes, *bays), tuple(notes))


def _moved(region: shapely.Polygon, offset: float, sign: int) -> list[shapely.Polygon]:
    """Parts of the region grown (sign 1) or shrunk (-1) by `offset`, the largest first."""
    slit = _SLIT * offset  # narrower slits are closed, narrower tongues cut off
    region = thinned(region, _ROUGH * offset)
    moved = region.buffer(sign * (offset + slit)).buffer(-sign * slit)
    parts = [part for part in shapely.get_parts(moved) if not part.is_empty]
    return sorted(parts, key=lambda part: -part.area)


def _shrunk(loop: Array, offset: float, min_area: float) -> tuple[list[Array], float]:
    region = shapely.Polygon(loop)
    for used in (offset, 0.5 * offset, 0.25 * offset):
        if used == 0:
            break
        parts = _moved(region, used, -1)
        parts = parts[:1] + [part for part in parts[1:] if part.area >= min_area]
        if parts and sum(part.area for part in parts) >= _SHRUNK * region.area:
            return [ring_loop(thinned(part, _FINE * used).exterior) for part in parts], used
    return [loop], 0.0
