"""Which triangle is seen at which sample of the output: scan conversion without seams.

Triangles are cut into horizontal spans. Where an edge crosses a row of samples is computed from
the edge's end points alone, the lower one first, so two triangles that share an edge get the same
number to the last bit: every sample on either side belongs to exactly one of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

# A pixel on an outline is resolved with this many rows of this many samples; a power of two, so
# that scaling coordinates by it is exact.
SUBSAMPLES = 8

# The samples of one sub-row are shifted against those of the next, as a vertical edge would
# otherwise know 8 degrees of coverage instead of 64.
_SHIFT = ((np.arange(SUBSAMPLES) * 3) % SUBSAMPLES + 0.5) / SUBSAMPLES - 0.5

# Row numbers are clipped to this before they become integers.
_FAR = 1 << 30

Ints = NDArray[np.int32]

_EMPTY = np.zeros(0, np.float32), np.zeros((0, 2), np.float32), np.zeros((0, 2), np.float32)


@dataclass(frozen=True, eq=False)
class Spans:
    """Runs of samples in one row, in the order of the triangles.

    Attributes
    ----------
    triangle, row, start, stop : (s,) int32 arrays
        The samples ``start <= column < stop`` of ``row`` lie in ``triangle``.
    """

    triangle: Ints
    row: Ints
    start: Ints
    stop: Ints


class ScanConverter:
    """Triangles prepared for conversion at one resolution.

    Sample (row r, column c) lies at (c + 1/2, r + 1/2) after scaling; with ``scale`` above 1,
    columns are shifted by a pattern that repeats every ``scale`` rows.

    Parameters
    ----------
    corners : (t, 3, 2) array
        Corners in continuous pixels, either orientation.
    scale : int
        Samples per pixel along each axis: 1 or ``SUBSAMPLES``.
    """

    def __init__(self, corners: NDArray[np.float64], scale: int = 1) -> None:
        order = np.argsort(corners[:, :, 1], axis=1)[:, :, None]
        ascending = np.take_along_axis(corners, order, axis=1) * scale
        self._x, self._y = ascending[:, :, 0], ascending[:, :, 1]
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            self._slope = np.stack(
                [
                    (self._x[:, b] - self._x[:, a]) / (self._y[:, b] - self._y[:, a])
                    for a, b in ((0, 1), (1, 2), (0, 2))
                ],
                axis=1,
            )
        self._rows = _first_sample(self._y, -_FAR, _FAR)
        self._shift = _SHIFT if scale == SUBSAMPLES else np.zeros(1)

    def spans(self, row_start: int, row_stop: int, width: int, chosen: Any = None) -> Spans:
        """Spans within ``row_start <= row < row_stop`` and ``0 <= column < width``.

        ``chosen`` (k,) holds the triangles to convert, ascending; all of them when left out.
        """
        if chosen is None:
            chosen = np.arange(len(self._rows), dtype=np.int32)
        first = np.maximum(self._rows[chosen, 0], row_start)
        count = np.maximum(np.minimum(self._rows[chosen, 2], row_stop) - first, 0)
        triangle = np.repeat(chosen, count)
        row = _runs(first, count)
        y = row + 0.5
        lower = row < self._rows[triangle, 1]
        short = np.where(lower, 0, 1)
        x, corner_y, slope = self._x, self._y, self._slope
        one = x[triangle, 0] + (y - corner_y[triangle, 0]) * slope[triangle, 2]
        other = x[triangle, short] + (y - corner_y[triangle, short]) * slope[triangle, short]
        shift = self._shift[row % len(self._shift)]
        start = _first_sample(np.minimum(one, other) - shift, 0, width)
        stop = _first_sample(np.maximum(one, other) - shift, 0, width)
        some = np.flatnonzero(stop > start)
        return Spans(triangle[some].astype(np.int32), row[some], start[some], stop[some])


def paint(spans: Spans, row_start: int, row_stop: int, width: int) -> Ints:
    """(rows * width,) index of the triangle seen at each sample, the last one drawn; else -1."""
    seen = np.full((row_stop - row_start) * width, -1, np.int32)
    length = spans.stop - spans.start
    samples = _runs((spans.row - row_start) * width + spans.start, length)
    seen[samples] = np.repeat(spans.triangle, length)
    return seen


def outline_edges(triangles: NDArray[np.integer], corners: NDArray[np.float64]) -> NDArray[Any]:
    """(e, 2) vertex pairs where a sheet of the mesh ends or folds over.

    These are the edges of one triangle only, and those between triangles of opposite
    orientation: along all others the picture goes on.
    """
    a, b = np.roll(triangles, 1, axis=1).ravel().astype(np.int64), triangles.ravel()
    e = corners[:, 1:] - corners[:, :1]
    flipped = np.repeat(e[:, 0, 0] * e[:, 1, 1] < e[:, 0, 1] * e[:, 1, 0], 3)
    key = np.minimum(a, b) * (int(triangles.max(initial=0)) + 1) + np.maximum(a, b)
    order = np.argsort(key, kind="stable")
    key, flipped = key[order], flipped[order]
    same = key[1:] == key[:-1]
    inner = np.zeros(len(key), dtype=bool)
    smooth = same & (flipped[1:] == flipped[:-1])
    inner[1:] |= smooth
    inner[:-1] |= smooth
    chosen = order[~inner]
    return np.stack([a[chosen], b[chosen]], axis=1)


def pixels_on(segments: NDArray[np.float64], row_start: int, row_stop: int, width: int) -> Any:
    """(rows, width) bool, the pixels that any of the segments (e, 2, 2) touches."""
    touched = np.zeros((row_stop - row_start, width), dtype=bool)
    upper = segments[:, 0, 1] <= segments[:, 1, 1]
    a = np.where(upper[:, None], segments[:, 0], segments[:, 1])
    b = np.where(upper[:, None], segments[:, 1], segments[:, 0])
    first = np.floor(a[:, 1]).clip(row_start, _FAR).astype(np.int32)
    last = np.floor(b[:, 1]).clip(-_FAR, row_stop - 1).astype(np.int32)
    count = np.maximum(last - first + 1, 0)
    edge = np.repeat(np.arange(len(segments)), count)
    row = _runs(first, count)
    a, b = a[edge], b[edge]
    rise = b[:, 1] - a[:, 1]
    # Where the segment enters and leaves the row of pixels.
    slope = np.divide(b[:, 0] - a[:, 0], rise, out=np.zeros_like(rise), where=rise > 0)
    enter = np.where(a[:, 1] >= row, a[:, 0], a[:, 0] + (row - a[:, 1]) * slope)
    leave = np.where(b[:, 1] <= row + 1, b[:, 0], a[:, 0] + (row + 1 - a[:, 1]) * slope)
    margin = 1e-6 * (1 + np.abs(enter) + np.abs(leave))
    left = np.floor(np.minimum(enter, leave) - margin).clip(0, width).astype(np.int32)
    right = np.floor(np.maximum(enter, leave) + margin).clip(-1, width - 1).astype(np.int32)
    length = np.maximum(right - left + 1, 0)
    touched.ravel()[_runs((row - row_start) * width + left, length)] = True
    return touched


def near(corners: NDArray[np.float64], touched: NDArray[np.bool_], row_start: int) -> Ints:
    """Ascending indices of triangles whose bounding box meets a touched pixel."""
    rows, width = touched.shape
    table = np.zeros((rows + 1, width + 1), np.int32)
    np.cumsum(np.cumsum(touched, axis=0, dtype=np.int32), axis=1, out=table[1:, 1:])
    low, high = np.floor(corners.min(axis=1)), np.floor(corners.max(axis=1)) + 1
    left, right = (v[:, 0].clip(0, width).astype(np.int32) for v in (low, high))
    top, bottom = ((v[:, 1] - row_start).clip(0, rows).astype(np.int32) for v in (low, high))
    count = table[bottom, right] - table[top, right] - table[bottom, left] + table[top, left]
    return np.flatnonzero(count > 0).astype(np.int32)


def paint_subsamples(spans: Spans, touched: NDArray[np.bool_], row_start: int) -> NDArray[np.int32]:
    """(p, SUBSAMPLES^2) triangle seen at each sample of the p touched pixels, row by row; else -1.

    ``spans`` are those of a converter with ``scale=SUBSAMPLES``.
    """
    width = touched.shape[1]
    pixels = np.flatnonzero(touched)
    before = np.zeros(touched.size + 1, np.int32)
    np.cumsum(touched.ravel(), out=before[1:])
    seen = np.full((len(pixels), SUBSAMPLES * SUBSAMPLES), -1, np.int32)
    line = (spans.row // SUBSAMPLES - row_start) * width
    first = before[line + spans.start // SUBSAMPLES]
    count = before[line + (spans.stop - 1) // SUBSAMPLES + 1] - first
    span = np.repeat(np.arange(len(count)), count)
    pixel = _runs(first, count)
    column = (pixels[pixel] % width * SUBSAMPLES).astype(np.int32)
    start = np.maximum(spans.start[span], column)
    stop = np.minimum(spans.stop[span], column + SUBSAMPLES)
    slot = pixel * SUBSAMPLES**2 + spans.row[span] % SUBSAMPLES * SUBSAMPLES + start - column
    seen.ravel()[_runs(slot, stop - start)] = np.repeat(spans.triangle[span], stop - start)
    return seen


@dataclass(frozen=True, eq=False)
class Fragments:
    """Parts of pixels that show one triangle each.

    Attributes
    ----------
    pixel : (f,) int array
        Row of the array of subsamples, ascending.
    triangle : (f,) int32 array
    share : (f,) float32 array
        Part of the pixel's area.
    centre : (f, 2) float32 array
        Centroid of the fragment's samples, (x, y) from the pixel's corner. It lies in the triangle.
    pixel_centre : (f, 2) float32 array
        Centroid of all samples of the pixel that show some triangle.
    """

    pixel: NDArray[np.int64]
    triangle: Ints
    share: NDArray[np.float32]
    centre: NDArray[np.float32]
    pixel_centre: NDArray[np.float32]


def fragments(seen: NDArray[np.int32]) -> Fragments:
    """Group the subsamples (p, SUBSAMPLES^2) of every pixel by triangle."""
    n_samples = SUBSAMPLES * SUBSAMPLES
    key = np.sort(seen.astype(np.int64) * n_samples + np.arange(n_samples), axis=1).ravel()
    triangle = key // n_samples
    starts = np.ones(len(key), dtype=bool)
    starts[1:] = triangle[1:] != triangle[:-1]
    starts[::n_samples] = True
    first = np.flatnonzero(starts)
    count = np.diff(first, append=len(key))
    row, column = np.divmod(np.arange(n_samples), SUBSAMPLES)
    places = np.stack([column + 0.5 + _SHIFT[row], row + 0.5]) / SUBSAMPLES
    if not len(key):
        return Fragments(first, first.astype(np.int32), *_EMPTY)
    sums = np.stack([np.add.reduceat(place[key % n_samples], first) for place in places], axis=1)
    shown = triangle[first] >= 0
    pixel, count, sums = first[shown] // n_samples, count[shown], sums[shown]
    _, group = np.unique(pixel, return_inverse=True)
    whole = np.stack([np.bincount(group, column) for column in (count, *sums.T)], axis=1)[group]
    return Fragments(
        pixel=pixel,
        triangle=triangle[first[shown]].astype(np.int32),
        share=(count / n_samples).astype(np.float32),
        centre=(sums / count[:, None]).astype(np.float32),
        pixel_centre=(whole[:, 1:] / whole[:, :1]).astype(np.float32),
    )


def _first_sample(x: NDArray[np.float64], low: int, high: int) -> Ints:
    """Index of the first sample at or after the coordinate, clipped to [low, high]."""
    return np.ceil(x - 0.5).clip(low, high).astype(np.int32)


def _runs(first: NDArray[Any], count: NDArray[Any]) -> Ints:
    """The integers first[0], first[0] + 1, ... (count[0] of them), first[1], ..., as int32."""
    ends = np.cumsum(count)
    total = int(ends[-1]) if len(ends) else 0
    offset = (first - (ends - count)).astype(np.int32)
    return np.repeat(offset, count) + np.arange(total, dtype=np.int32)
