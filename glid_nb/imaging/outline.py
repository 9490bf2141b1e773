"""The outline of one component, with sub-pixel accuracy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from skimage.measure import find_contours

from glid_nb.geometry._loops import signed_area
from glid_nb.imaging.components import Component, labelled

_PRECISION = 0.05  # pixels; vertices that change the outline by less are dropped
_SPECK_SHARE, _SPECK = 1e-5, 4  # smaller holes, relative to the component and in pixels, are noise
_MOST_HOLES = 100
# Steps (see `_steps`) of an outline whose holes are mostly noise, and of one that is itself so
# rough that it is traced at a lower resolution. A drawing of 8,000 px has some 30,000.
_NOISY, _ROUGH = 20_000, 100_000
_LEAST_DIFFERENCE = 0.02  # of a pixel's way between background and foreground


@dataclass(frozen=True, eq=False)
class Outline:
    """Level set of the score around a component.

    Attributes
    ----------
    component
        The component.
    exterior
        (n, 2) read-only vertices in pixel coordinates.
    holes
        Likewise, (k, 2) each, the largest hole first.
    n_specks
        Number of holes that are filled because they are too small to be more than noise, or beyond
        the hundred largest.
    speck
        Area in square pixels below which a hole is noise.
    block
        Side in pixels of the blocks that were traced as one; 1 but for very rough outlines.
    inside
        Which pixels are in the component or in a speck; the part of the image that starts at
        `corner`.
    corner
        (row, column) in the image of the first pixel of `inside`.
    """

    component: Component
    exterior: NDArray[np.float64]
    holes: tuple[NDArray[np.float64], ...]
    n_specks: int
    speck: float
    block: int
    inside: NDArray[np.bool_]
    corner: tuple[int, int]


def find_outline(
    score: NDArray[np.float32], level: float, labels: NDArray[np.uint16], component: Component
) -> Outline:
    """Trace the outline of a component by marching squares.

    Parameters
    ----------
    score
        (h, w) field that exceeds `level` in the foreground.
    level
        The value on the outline.
    labels
        (h, w) labels of the components, 1 + rank.
    component
        The one to trace.

    Returns
    -------
    Loops that neither cross nor touch. Where the component meets the border of the image, the
    outline runs along the border.
    """
    xmin, ymin, xmax, ymax = component.bounds
    rows, columns = slice(max(ymin - 1, 0), ymax + 1), slice(max(xmin - 1, 0), xmax + 1)
    inside = np.pad(labels[rows, columns] == component.rank + 1, 1)
    least = max(_SPECK, _SPECK_SHARE * component.area)
    specks = _fill_specks(inside, least)
    block = _block_size(inside)
    if block == 1:
        field = _field(score[rows, columns], level, inside)
        inside = inside[1:-1, 1:-1]
    else:
        coarse = _coarse(inside[1:-1, 1:-1], block)
        inside = coarse.repeat(block, axis=0).repeat(block, axis=1)
        inside = inside[: rows.stop - rows.start, : columns.stop - columns.start]
        field = np.pad(coarse, 1).astype(np.float32) - np.float32(0.5)
    loops = [
        # Pixel centres are at half integers; the padding, the blocks and the crop are undone.
        (contour[:-1, ::-1] - 0.5) * block + [columns.start, rows.start]
        for contour in find_contours(field, 0.0, fully_connected="high")
    ]
    # The component is connected, so one loop goes around it and all others around its holes.
    areas = [abs(signed_area(loop)) for loop in loops]
    order = sorted(range(len(loops)), key=lambda i: -areas[i])
    chosen = [i for i in order[: _MOST_HOLES + 1] if areas[i] >= least or i == order[0]]
    exterior, *holes = _thinned([loops[i] for i in chosen])
    inside.setflags(write=False)
    return Outline(
        component,
        exterior,
        tuple(holes),
        specks + len(loops) - len(chosen),
        least,
        block,
        inside,
        (rows.start, columns.start),
    )


def _block_size(inside: NDArray[np.bool_]) -> int:
    """The side of the blocks of pixels that make the outline as short as it can be handled."""
    block = 1
    coarse = inside
    while _steps(coarse) > _ROUGH:
        block *= 2
        coarse = _coarse(coarse, 2)
    return block


def _coarse(inside: NDArray[np.bool_], block: int) -> NDArray[np.bool_]:
    """Which blocks hold a pixel of the mask; what was connected stays so."""
    height, width = inside.shape
    padded = np.pad(inside, ((0, -height % block), (0, -width % block)))
    blocks = padded.reshape(padded.shape[0] // block, block, padded.shape[1] // block, block)
    return np.any(blocks, axis=(1, 3))


def _steps(inside: NDArray[np.bool_]) -> int:
    """Number of changes down the columns, about half the number of pixel sides in the outline."""
    return int(np.count_nonzero(inside[1:] != inside[:-1]))


def _field(
    score: NDArray[np.float32], level: float, inside: NDArray[np.bool_]
) -> NDArray[np.float32]:
    """The score less the level, positive exactly in the component, with a frame of one pixel.

    Values next to 0 are moved away from it, so that the level set stays clear of the pixels'
    centres, where it would touch itself. The frame mirrors the values along the image's border: the
    outline then runs along the border itself.
    """
    field = np.pad(score - np.float32(level), 1, mode="edge")
    least = np.float32(_LEAST_DIFFERENCE * max(min(level, 1 - level), 0.05))
    np.abs(field, out=field)
    np.maximum(field, least, out=field)
    np.negative(field, out=field, where=~inside)
    return field


def _fill_specks(inside: NDArray[np.bool_], least: float) -> int:
    """Fill, in place, the holes of less than `least` pixels if the mask is noisy; their number.

    Otherwise there are few, and it is faster to trace them first and drop them then.
    """
    if _steps(inside) < _NOISY:
        return 0
    background, count = labelled(~inside, corners=False)
    sizes = np.bincount(background.ravel(), minlength=count + 1)
    fill = sizes < least
    fill[0] = False
    inside |= fill[background]
    return int(np.count_nonzero(fill))


def _thinned(loops: list[NDArray[np.float64]]) -> list[NDArray[np.float64]]:
    """The loops with fewer vertices, none of them crossing."""
    thin = thinned(shapely.Polygon(loops[0], loops[1:]), _PRECISION)
    result = [shapely.get_coordinates(ring)[:-1] for ring in (thin.exterior, *thin.interiors)]
    for loop in result:
        loop.setflags(write=False)
    return result


def thinned(polygon: shapely.Polygon, tolerance: float) -> shapely.Polygon:
    """`polygon` without the vertices that matter less than `tolerance`, if it stays a polygon."""
    # Without regard for topology it is ten times as fast, and nearly always right.
    for preserve_topology in (False, True):
        thin = polygon.simplify(tolerance, preserve_topology=preserve_topology)
        if not isinstance(thin, shapely.Polygon) or thin.is_empty:
            continue
        if len(thin.interiors) == len(polygon.interiors) and thin.is_valid:
            return thin
    return polygon
