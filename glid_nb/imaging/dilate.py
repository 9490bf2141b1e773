"""Moving an outline away from its shape."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from glid_nb.imaging.holes import Hole, HoleRule
from glid_nb.imaging.outline import Outline, ring_loop, thinned

_SHARE = 0.01  # automatic offset, relative to the square root of the shape's area
_LEAST, _LEAST_SHARE = 2.0, 0.05  # pixels; at least that, but on tiny shapes at most this share
_SLIT = 0.5  # slits narrower than this times the offset on each side are closed
_ROUGH, _FINE = 0.05, 0.03  # tolerances of simplification before and after, times the offset
_SHRUNK = 0.2  # a hole that would keep less than this share of its area gets a smaller offset


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
    outline: Outline,
    holes: tuple[Hole, ...],
    rule: HoleRule,
    offset: float | None = None,
) -> Dilation:
    """Move the outline's exterior outwards and the kept holes inwards by `offset` pixels.

    None: about 1 % of the shape's size, less if that would close a bay.
    """
    shape = shapely.Polygon(outline.exterior)
    if offset is None:
        size = float(np.sqrt(shape.area))
        largest = max(_SHARE * size, min(_LEAST, _LEAST_SHARE * size))
        offsets = [largest, 0.5 * largest, 0.25 * largest]
    else:
        offsets = [offset]
    tried = []
    for chosen in offsets:
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
            notes.append(
                f"the hole at {_place(hole)} is too narrow for an offset of {chosen:.3g} px; it "
                f"got {used:.3g} px"
            )
        if len(parts) > 1:
            notes.append(f"the offset divided the hole at {_place(hole)} into {len(parts)}")
    for bay in (bay for bay in bays if bay.kept):
        loops.append(bay.loop)
        notes.append(
            f"the offset of {chosen:.3g} px closed a bay at {_place(bay)}, which became a hole; a "
            "smaller offset leaves it open"
        )
    listed = (*holes, *bays)
    return Dilation(ring_loop(grown.exterior), tuple(loops), chosen, least, listed, tuple(notes))


def _place(hole: Hole) -> str:
    return f"({hole.pixel[0]:.0f}, {hole.pixel[1]:.0f})"


def _moved(region: shapely.Polygon, offset: float, sign: int) -> list[shapely.Polygon]:
    """Parts of the region grown (sign 1) or shrunk (-1) by `offset`, the largest first.

    Very narrow slits of the grown region and tongues of the shrunk one are removed.
    """
    slit = _SLIT * offset
    region = thinned(region, _ROUGH * offset)
    moved = region.buffer(sign * (offset + slit)).buffer(-sign * slit)
    parts = [part for part in shapely.get_parts(moved) if not part.is_empty]
    return sorted(parts, key=lambda part: -part.area)


def _shrunk(
    loop: NDArray[np.float64], offset: float, min_area: float
) -> tuple[list[NDArray[np.float64]], float]:
    """The parts that a hole shrinks to, and the offset used: less for a hole that would vanish."""
    region = shapely.Polygon(loop)
    for used in (offset, 0.5 * offset, 0.25 * offset):
        if used == 0:
            break
        parts = _moved(region, used, -1)
        parts = parts[:1] + [part for part in parts[1:] if part.area >= min_area]
        if parts and sum(part.area for part in parts) >= _SHRUNK * region.area:
            return [ring_loop(thinned(part, _FINE * used).exterior) for part in parts], used
    return [loop], 0.0
