"""Moving an outline away from its shape."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from glid_nb.imaging.holes import Hole, HoleRule, as_hole
from glid_nb.imaging.outline import Outline, thinned

_SHARE = 0.01  # of the square root of the shape's area
_LEAST, _LEAST_SHARE = 2.0, 0.05  # pixels, but on tiny shapes no more than this share
_SLIT = 0.5  # slits narrower than this times the offset on each side are closed
_ROUGH, _FINE = 0.05, 0.03  # how far vertices may be dropped before and after, times the offset
_SHRUNK = 0.2  # a hole that would keep less than this share of its area is moved less


@dataclass(frozen=True, eq=False)
class Dilation:
    """An outline after the offset.

    Attributes
    ----------
    exterior
        (n, 2) vertices in pixel coordinates.
    holes
        (k, 2) each.
    offset
        The distance in pixels.
    least_offset
        The smallest distance that a narrow hole got instead.
    listed
        All holes, with those that the offset closed off at the end.
    notes
        Sentences about what the offset changed.
    """

    exterior: NDArray[np.float64]
    holes: tuple[NDArray[np.float64], ...]
    offset: float
    least_offset: float
    listed: tuple[Hole, ...]
    notes: tuple[str, ...]


def dilate(
    outline: Outline,
    holes: tuple[Hole, ...],
    rule: HoleRule,
    offset: float | None = None,
) -> Dilation:
    """Move the outline's exterior outwards and the kept holes inwards by `offset` pixels.

    With an offset of None it is about 1 % of the shape's size; less if that closed a bay.
    """
    shape = shapely.Polygon(outline.exterior)
    if offset is not None:
        chosen = offset
        grown = _grown(shape, chosen)
    else:
        size = float(np.sqrt(shape.area))
        largest = max(_SHARE * size, min(_LEAST, _LEAST_SHARE * size))
        chosen, grown = largest, _grown(shape, largest)
        for factor in (0.5, 0.25):
            if not _kept(_bays(grown, rule)):
                break
            smaller = _grown(shape, factor * largest)
            if not _kept(_bays(smaller, rule)):
                chosen, grown = factor * largest, smaller
    notes: list[str] = []
    loops: list[NDArray[np.float64]] = []
    least = chosen
    for hole in _kept(holes):
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
    bays = _bays(grown, rule)
    for bay in _kept(bays):
        loops.append(bay.loop)
        notes.append(
            f"the offset of {chosen:.3g} px closed a bay at {_place(bay)}, which became a hole; a "
            "smaller offset leaves it open"
        )
    listed = (*holes, *bays)
    return Dilation(_loop(grown.exterior), tuple(loops), chosen, least, listed, tuple(notes))


def _kept(holes: Iterable[Hole]) -> list[Hole]:
    return [hole for hole in holes if hole.kept]


def _place(hole: Hole) -> str:
    return f"({hole.pixel[0]:.0f}, {hole.pixel[1]:.0f})"


def _grown(shape: shapely.Polygon, offset: float) -> shapely.Polygon:
    """Everything within `offset` of the shape, with the narrow slits closed."""
    if offset == 0:
        return shape
    slit = _SLIT * offset
    shape = thinned(shape, _ROUGH * offset)
    return thinned(_largest(shape.buffer(offset + slit).buffer(-slit)), _FINE * offset)


def _bays(grown: shapely.Polygon, rule: HoleRule) -> list[Hole]:
    """What the offset closed off."""
    return [as_hole(_loop(ring), rule, by_offset=True) for ring in grown.interiors]


def _shrunk(
    loop: NDArray[np.float64], offset: float, min_area: float
) -> tuple[list[NDArray[np.float64]], float]:
    """The parts of a hole farther than `offset` from its boundary, and the offset it could have.

    A narrow hole gets a smaller offset rather than vanish.
    """
    region = shapely.Polygon(loop)
    for used in (offset, 0.5 * offset, 0.25 * offset):
        if used == 0:
            break
        slit = _SLIT * used
        core = thinned(region, _ROUGH * used).buffer(-used - slit).buffer(slit)
        parts = sorted(shapely.get_parts(core), key=lambda part: -part.area)
        if not parts or parts[0].is_empty:
            continue
        parts = [part for part in parts if part is parts[0] or part.area >= min_area]
        if sum(part.area for part in parts) >= _SHRUNK * region.area:
            return [_loop(thinned(part, _FINE * used).exterior) for part in parts], used
    return [loop], 0.0


def _largest(region: BaseGeometry) -> shapely.Polygon:
    return max(shapely.get_parts(region), key=lambda part: part.area)


def _loop(ring: shapely.LinearRing) -> NDArray[np.float64]:
    loop = shapely.get_coordinates(ring)[:-1]
    loop.setflags(write=False)
    return loop
