"""The connected components of a foreground, and the outline of one with sub-pixel accuracy."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.ndimage import find_objects, label
from skimage.measure import block_reduce, find_contours

from glid_nb._arrays import Array, read_only
from glid_nb.geometry._loops import signed_area
from glid_nb.imaging.foreground import Foreground
from glid_nb.imaging.frame import PixelFrame, TraceError
from glid_nb.imaging.options import Point

_LISTED = 50  # components that are described
_PRECISION = 0.05  # pixels; vertices that change the outline by less are dropped
_SPECK_SHARE, _SPECK = 1e-5, 4  # smaller holes, relative to the component and in pixels, are noise
_MOST_HOLES = 100
# Limits on `_steps`. A drawing of 8,000 px has some 30,000 steps.
# _NOISY: from this number on, small holes are filled before tracing.
# ROUGH: above this number, the outline is traced at a lower resolution.
_NOISY, ROUGH = 20_000, 100_000
_LEAST_DIFFERENCE = 0.02  # between a pixel and the level, relative to the level


@dataclass(frozen=True)
class Component:
    """A connected part of the foreground."""

    rank: int
    """Rank by area; 0 is the largest."""
    area: int
    """Number of pixels."""
    bounds: tuple[int, int, int, int]
    """Bounding box (xmin, ymin, xmax, ymax) in pixel coordinates."""
    pixel: Point
    """Centre (x, y) of one of its pixels."""


@dataclass(frozen=True, eq=False)
class Components:
    """All components of a foreground, the largest first. Pixels also connect at corners."""

    found: NDArray[np.int32]  # (h, w) labels, 0 in the background
    labels: NDArray[np.intp]  # (n,) the label of each component
    areas: NDArray[np.intp]  # (n,) in pixels, descending
    boxes: list[tuple[slice, slice]]  # (n,) rows and columns, by label

    @cached_property
    def largest(self) -> tuple[Component, ...]:
        """The largest components, at most fifty."""
        return tuple(map(self._described, range(min(len(self.areas), _LISTED))))

    def component(self, rank: int) -> Component:
        """The component of a rank. Raises a TraceError if it does not exist."""
        if not 0 <= rank < (count := len(self.areas)):
            has = f"the foreground has {count} component{'' if count == 1 else 's'}"
            counted = "counted from 0, the largest; choose another"
            raise TraceError(f"component {rank} does not exist: {has}, {counted}")
        return self.largest[rank] if rank < _LISTED else self._described(rank)

    def _described(self, rank: int) -> Component:
        rows, columns = self.boxes[self.labels[rank] - 1]
        left = columns.start + int(np.argmax(self.found[rows.start, columns] == self.labels[rank]))
        bounds = columns.start, rows.start, columns.stop, rows.stop
        return Component(rank, int(self.areas[rank]), bounds, (left + 0.5, rows.start + 0.5))

    def rank_at(self, point: Point) -> int:
        """Rank of the component at a point (x, y) in pixel coordinates. Raises a TraceError if the
        point is background."""
        found = self.found[PixelFrame(*self.found.shape[::-1]).index_at(point, "component_at")]
        if found == 0:
            where = f"component_at: the pixel ({point[0]:g}, {point[1]:g})"
            raise TraceError(
                f"{where} is background; pick a pixel of the shape",
                "There is only background at the place that was picked; pick a place on the shape",
            )
        return int(np.flatnonzero(self.labels == found)[0])


def find_components(foreground: Foreground, threshold: float | None = None) -> Components:
    """Label the components of a foreground. Raises a TraceError if the foreground is empty or
    covers the whole image."""
    mask = foreground.mask(threshold)
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    box = slice(int(rows[0]), int(rows[-1]) + 1), slice(int(columns[0]), int(columns[-1]) + 1)
    found = np.zeros(mask.shape, dtype=np.int32)
    count = label(mask[box], np.ones((3, 3)), output=found[box])
    areas = np.bincount(found[box].ravel())[1:]
    order = np.argsort(-areas, kind="stable")
    boxes = [box] if count == 1 else find_objects(found)
    return Components(found, order + 1, areas[order], boxes)


@dataclass(frozen=True, eq=False)
class Outline:
    """Read-only loops in pixel coordinates that neither cross nor touch. Where the component meets
    the border of the image, its loop runs along the border."""

    component: Component
    exterior: NDArray[np.float64]
    holes: tuple[NDArray[np.float64], ...]  # the largest first
    n_specks: int  # holes filled because they are noise or not among the hundred largest
    speck: float  # square pixels; smaller holes are noise
    notes: tuple[str, ...]
    inside: NDArray[np.bool_]  # (h, w) the pixels in the component or in a speck


def find_outline(
    foreground: Foreground, components: Components, threshold: float | None, rank: int
) -> Outline:
    """Trace the outline of one component by marching squares."""
    component = components.component(rank)
    xmin, ymin, xmax, ymax = component.bounds
    top, left = max(ymin - 1, 0), max(xmin - 1, 0)
    crop = np.s_[top : ymax + 1, left : xmax + 1]
    framed = np.pad(components.found[crop] == components.labels[rank], 1)
    least = max(_SPECK, _SPECK_SHARE * component.area)
    specks = _fill_specks(framed, least)
    part = framed[1:-1, 1:-1]
    block, coarse = 1, part
    while _steps(coarse) > ROUGH:
        block, coarse = 2 * block, block_reduce(coarse, 2, np.max)  # stays connected
    if block == 1:
        field = _field(foreground.score[crop], foreground.level(threshold), framed)
    else:
        field = np.pad(coarse, 1).astype(np.float32) - np.float32(0.5)
        part = coarse.repeat(block, axis=0).repeat(block, axis=1)[: part.shape[0], : part.shape[1]]
    loops = [
        # Undo frame, blocks and crop; pixel centres are at half integers.
        (contour[:-1, ::-1] - 0.5) * block + [left, top]
        for contour in find_contours(field, 0.0, fully_connected="high")
    ]
    # The component is connected. So one loop goes around it, and all others go around its holes.
    areas = [abs(signed_area(loop)) for loop in loops]
    order = sorted(range(len(loops)), key=lambda i: -areas[i])
    chosen = [i for i in order[: _MOST_HOLES + 1] if areas[i] >= least or i == order[0]]
    polygon = shapely.Polygon(loops[chosen[0]], [loops[i] for i in chosen[1:]])
    polygon = thinned(polygon, _PRECISION)
    exterior, *holes = map(ring_loop, (polygon.exterior, *polygon.interiors))
    inside = np.zeros(components.found.shape, dtype=bool)
    inside[crop] = part
    n_specks = specks + len(loops) - len(chosen)
    rough = f"the outline is very rough: it was traced in blocks of {block} x {block} pixels"
    help = "more smoothing, or another way to find the foreground, may help"
    notes = (f"{rough}; {help}",) if block > 1 else ()
    return Outline(component, exterior, tuple(holes), n_specks, least, notes, inside)


def _steps(inside: NDArray[np.bool_]) -> int:
    """Number of changes along the columns, about half the number of pixel sides in the outline."""
    return int(np.count_nonzero(inside[1:] != inside[:-1]))


def _fill_specks(inside: NDArray[np.bool_], least: float) -> int:
    """If the mask is noisy, fill its holes below `least` pixels in place. Returns how many."""
    if _steps(inside) < _NOISY:  # few holes: dropping them after tracing is faster
        return 0
    background = np.zeros(inside.shape, dtype=np.int32)
    label(~inside, output=background)
    fill = np.bincount(background.ravel()) < least
    fill[0] = False
    inside |= fill[background]
    return int(np.count_nonzero(fill))


def _field(score: NDArray[np.float32], level: float, inside: Array) -> NDArray[np.float32]:
    """Score minus level, with a frame of one pixel; positive exactly in the component."""
    # Move values away from 0: a level set through the centre of a pixel could touch itself.
    field = np.pad(score - np.float32(level), 1, mode="edge")
    np.abs(field, out=field)
    least = np.float32(_LEAST_DIFFERENCE * max(min(level, 1 - level), 0.05))
    np.maximum(field, least, out=field)
    np.negative(field, out=field, where=~inside)
    return field


def thinned(polygon: shapely.Polygon, tolerance: float) -> shapely.Polygon:
    """Simplify `polygon` by `tolerance`, if it stays a valid polygon with all its holes."""
    # Ignoring the topology is ten times as fast and nearly always right.
    for preserve_topology in (False, True):
        thin = polygon.simplify(tolerance, preserve_topology=preserve_topology)
        if not isinstance(thin, shapely.Polygon) or thin.is_empty:
            continue
        if len(thin.interiors) == len(polygon.interiors) and thin.is_valid:
            return thin
    return polygon


def ring_loop(ring: shapely.LinearRing) -> NDArray[np.float64]:
    """(n, 2) read-only vertices of a ring, without the repeated last one."""
    return read_only(shapely.get_coordinates(ring)[:-1])
