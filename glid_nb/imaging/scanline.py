"""Which triangle is seen at which sample of the output: scan conversion without seams.

Triangles are cut into horizontal spans. Where an edge crosses a row of samples is computed from
the edge's end points alone, the lower one first, so two triangles that share an edge get the same
number to the last bit: every sample on either side belongs to exactly one of them.
"""

from __future__ import annotations

from collections.abc import Callable
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

# Where the samples lie in their pixel: (2, SUBSAMPLES^2), x and y.
_ROW, _COLUMN = np.divmod(np.arange(SUBSAMPLES**2), SUBSAMPLES)
_OFFSETS = np.stack([_COLUMN + 0.5 + _SHIFT[_ROW], _ROW + 0.5]) / SUBSAMPLES

# Row numbers are clipped to this before they become integers.
_FAR = 1 << 30

Ints = NDArray[np.int32]


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


@dataclass(frozen=True, eq=False)
class Layer:
    """At most one triangle per sample.

    Attributes
    ----------
    sample : (k,) int32 array
        Distinct indices of samples.
    triangle : (k,) int32 array
    """

    sample: Ints
    triangle: Ints


@dataclass(frozen=True, eq=False)
class Heights:
    """Planes over the triangles that say which of two lies over the other.

    Attributes
    ----------
    planes : (t, 3) array
        Height a + b x + c y of each triangle at the continuous pixel (x, y).
    """

    planes: NDArray[np.float64]

    @classmethod
    def over(cls, corners: NDArray[np.float64], heights: NDArray[np.float64]) -> Heights:
        """The planes through heights (t, 3) at corners (t, 3, 2)."""
        e, rise = corners[:, 1:] - corners[:, :1], heights[:, 1:] - heights[:, :1]
        det = e[:, 0, 0] * e[:, 1, 1] - e[:, 0, 1] * e[:, 1, 0]
        slope = np.stack(
            [
                rise[:, 0] * e[:, 1, 1] - rise[:, 1] * e[:, 0, 1],
                rise[:, 1] * e[:, 0, 0] - rise[:, 0] * e[:, 1, 0],
            ],
            axis=1,
        )
        covers = np.abs(det)[:, None] > 1e-300  # others show at no sample
        slope = np.divide(slope, det[:, None], out=np.zeros_like(slope), where=covers)
        level = heights[:, 0] - (slope * corners[:, 0]).sum(axis=1)
        return cls(np.column_stack([level, slope]))

    def at(self, triangle: Ints, x: NDArray[Any], y: NDArray[Any]) -> NDArray[np.float64]:
        """Height of each of the triangles (k,) at its own point."""
        level, right, down = self.planes[triangle].T
        return level + right * x + down * y


def layers(
    spans: Spans, row_start: int, row_stop: int, width: int, heights: Heights | None = None
) -> list[Layer]:
    """What each sample of the rows shows, the lowest layer first.

    Samples are numbered row by row from ``row_start``. A sample that n triangles cover is in the
    first n layers, by height, or in the triangles' order when no heights are given.
    """

    def height(sample: Ints, triangle: Ints) -> NDArray[np.float64]:
        assert heights is not None
        return heights.at(triangle, sample % width + 0.5, sample // width + row_start + 0.5)

    length = spans.stop - spans.start
    sample = _runs((spans.row - row_start) * width + spans.start, length)
    triangle = np.repeat(spans.triangle, length)
    n_samples = (row_stop - row_start) * width
    return _layers(sample, triangle, n_samples, None if heights is None else height)


def _layers(
    sample: Ints,
    triangle: Ints,
    n_samples: int,
    height: Callable[[Ints, Ints], NDArray[np.float64]] | None,
) -> list[Layer]:
    if not len(sample):
        return []
    several = np.bincount(sample, minlength=n_samples)[sample] > 1
    once = ~several
    if not several.any():
        return [Layer(sample, triangle)]
    rest = np.flatnonzero(several)
    if height is None:
        rest = rest[np.argsort(sample[rest], kind="stable")]
    else:
        rest = rest[np.lexsort((height(sample[rest], triangle[rest]), sample[rest]))]
    first = np.flatnonzero(np.diff(sample[rest], prepend=-1))
    rank = np.arange(len(rest)) - np.repeat(first, np.diff(first, append=len(rest)))
    result = []
    for k in range(int(rank.max()) + 1):
        chosen = rest[rank == k]
        if k == 0:
            chosen = np.concatenate([np.flatnonzero(once), chosen])
        result.append(Layer(sample[chosen], triangle[chosen]))
    return result


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


def bounding_boxes(
    corners: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Lower and upper corners, each (t, 2), of the boxes around triangles (t, 3, 2)."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    return np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)


def near(
    low: NDArray[np.float64], high: NDArray[np.float64], touched: NDArray[np.bool_], row_start: int
) -> Ints:
    """Ascending indices of triangles whose bounding box meets a touched pixel."""
    rows, width = touched.shape
    table = np.zeros((rows + 1, width + 1), np.int32)
    np.cumsum(np.cumsum(touched, axis=0, dtype=np.int32), axis=1, out=table[1:, 1:])
    here = np.flatnonzero((low[:, 1] < row_start + rows) & (high[:, 1] >= row_start))
    left, top = np.floor(low[here]).T
    right, bottom = np.floor(high[here]).T + 1
    left, right = (x.clip(0, width).astype(np.int32) for x in (left, right))
    top, bottom = ((y - row_start).clip(0, rows).astype(np.int32) for y in (top, bottom))
    count = table[bottom, right] - table[top, right] - table[bottom, left] + table[top, left]
    return here[count > 0].astype(np.int32)


def subsample_layers(
    spans: Spans, touched: NDArray[np.bool_], row_start: int, heights: Heights | None = None
) -> list[Layer]:
    """What each sample of the touched pixels shows, the lowest layer first.

    ``spans`` are those of a converter with ``scale=SUBSAMPLES``. Sample s of the p-th touched
    pixel, row by row, has the number ``SUBSAMPLES^2 p + s``.
    """
    width = touched.shape[1]
    pixels = np.flatnonzero(touched)
    before = np.zeros(touched.size + 1, np.int32)
    np.cumsum(touched.ravel(), out=before[1:])
    line = (spans.row // SUBSAMPLES - row_start) * width
    first = before[line + spans.start // SUBSAMPLES]
    count = before[line + (spans.stop - 1) // SUBSAMPLES + 1] - first
    span = np.repeat(np.arange(len(count)), count)
    pixel = _runs(first, count)
    column = (pixels[pixel] % width * SUBSAMPLES).astype(np.int32)
    start = np.maximum(spans.start[span], column)
    stop = np.minimum(spans.stop[span], column + SUBSAMPLES)
    slot = pixel * SUBSAMPLES**2 + spans.row[span] % SUBSAMPLES * SUBSAMPLES + start - column
    # Shifted rows let a span end before the pixel that its neighbour in the row still reaches.
    length = np.maximum(stop - start, 0)
    triangle = np.repeat(spans.triangle[span], length)

    def height(sample: Ints, triangle: Ints) -> NDArray[np.float64]:
        assert heights is not None
        pixel, place = np.divmod(sample, SUBSAMPLES**2)
        down, right = np.divmod(pixels[pixel], width)
        x, y = right + _OFFSETS[0, place], down + row_start + _OFFSETS[1, place]
        return heights.at(triangle, x, y)

    n_samples = len(pixels) * SUBSAMPLES**2
    return _layers(_runs(slot, length), triangle, n_samples, None if heights is None else height)


@dataclass(frozen=True, eq=False)
class Fragments:
    """Parts of pixels that show one triangle each, within one layer.

    Attributes
    ----------
    pixel : (f,) int array
        The touched pixel, ascending.
    triangle : (f,) int32 array
    count : (f,) int array
        How many of the pixel's samples.
    centre : (f, 2) float32 array
        Centroid of the fragment's samples, (x, y) from the pixel's corner. It lies in the triangle.
    pixel_centre : (f, 2) float32 array
        Centroid of all samples of the pixel in this layer.
    sample, fragment : (k,) int arrays
        Every sample of the layer, and the fragment that it belongs to.
    """

    pixel: NDArray[np.int64]
    triangle: Ints
    count: NDArray[np.int64]
    centre: NDArray[np.float32]
    pixel_centre: NDArray[np.float32]
    sample: NDArray[np.int64]
    fragment: NDArray[np.int64]


def fragments(layer: Layer) -> Fragments:
    """Group the samples of a layer, as `subsample_layers` numbers them, by pixel and triangle."""
    n = SUBSAMPLES * SUBSAMPLES
    pixel, place = np.divmod(layer.sample.astype(np.int64), n)
    n_triangles = int(layer.triangle.max(initial=0)) + 1
    key = np.sort((pixel * n_triangles + layer.triangle) * n + place)
    group, place = np.divmod(key, n)
    first = np.flatnonzero(np.diff(group, prepend=-1))
    count = np.diff(first, append=len(group))
    pixel, triangle = np.divmod(group[first], n_triangles)
    sums = np.stack([np.add.reduceat(offset[place], first) for offset in _OFFSETS], axis=1)
    start = np.flatnonzero(np.diff(pixel, prepend=-1))
    of_pixel = np.repeat(np.arange(len(start)), np.diff(start, append=len(pixel)))
    whole = np.add.reduceat(sums, start) / np.add.reduceat(count, start)[:, None]
    fragment = np.repeat(np.arange(len(first)), count)
    return Fragments(
        pixel=pixel,
        triangle=triangle.astype(np.int32),
        count=count,
        centre=(sums / count[:, None]).astype(np.float32),
        pixel_centre=whole[of_pixel].astype(np.float32),
        sample=pixel[fragment] * n + place,
        fragment=fragment,
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
