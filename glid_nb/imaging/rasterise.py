"""Draw a textured triangle mesh into a picture, on the CPU and without OpenGL.

Triangles are cut into horizontal spans. The crossing of an edge with a row of samples depends only
on the edge's end points, in the order of y, so triangles that share an edge get the same number to
the last bit and every sample belongs to exactly one of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glid_nb.imaging.mesh import unique_edges
from glid_nb.imaging.texture import Sampler, Texture, gradients

# Pixels drawn at a time, and outline pixels among them. This bounds the memory.
_BAND = 1 << 19
_OUTLINE = 1 << 16

# Rows and columns of the samples in an outline pixel. Each row is shifted against the next, so that
# a vertical edge has 64 levels of coverage instead of 8.
SUBSAMPLES = 8
_SHIFT = ((np.arange(SUBSAMPLES) * 3) % SUBSAMPLES + 0.5) / SUBSAMPLES
_COLUMNS = (np.arange(SUBSAMPLES) + _SHIFT[:, None]) / SUBSAMPLES

Ints = NDArray[np.int32]
Floats = NDArray[np.float64]


def render_mesh(
    texture: ArrayLike | Texture,
    texture_xy: ArrayLike,
    positions_xy: ArrayLike,
    triangles: ArrayLike,
    size: tuple[int, int],
    heights: ArrayLike | None = None,
) -> NDArray[np.uint8]:
    """Warp a picture with a triangle mesh.

    Where triangles overlap, the higher one, or without heights the later one, is composed over the
    other. Triangles that share an edge leave no seam and share no pixel. Outlines are anti-aliased
    with 64 samples per pixel. The picture is filtered with premultiplied alpha: by cubic
    interpolation where it is magnified, anisotropically on an image pyramid where it is minified.

    Parameters
    ----------
    texture : (h, w, 4) or (h, w, 3) or (h, w) array, or Texture
        The picture: uint8, uint16 or floating point in [0, 1], straight alpha. Pass a
        :class:`Texture` to draw one picture many times.
    texture_xy : (v, 2) array
        The vertices in the picture, continuous pixels: x right, y down, (0, 0) the top left
        corner. Parts of a triangle beyond the picture are transparent.
    positions_xy : (v, 2) array
        The vertices in the output, continuous pixels.
    triangles : (t, 3) int array
        Vertex indices, either orientation.
    size : (w, h)
        Size of the output, pixels.
    heights : (v,) array, optional
        Heights of the vertices; only their order matters. Intersecting sheets meet along a line
        then, while the order of triangles gives a ragged edge.

    Returns
    -------
    (h, w, 4) uint8 array
        RGBA with straight alpha; fully transparent pixels are (0, 0, 0, 0).

    Raises
    ------
    ValueError
        Shapes do not match, an index is out of range, a coordinate is not finite, or the size is
        not positive. The message names the argument.
    """
    width, height = _checked_size(size)
    source = _checked(texture_xy, "texture_xy", None, 2)
    target = _checked(positions_xy, "positions_xy", None, 2)
    if len(source) != len(target):
        raise ValueError(
            f"texture_xy has {len(source)} vertices and positions_xy {len(target)}; "
            "give both for every vertex"
        )
    faces = _checked_triangles(triangles, len(target))
    levels = None if heights is None else _checked(heights, "heights", len(target))
    if not isinstance(texture, Texture):
        texture = Texture.from_image(texture)
    picture = np.zeros((height, width, 4), np.uint8)

    corners = target[faces]
    low, high = corners.min(axis=1), corners.max(axis=1)
    visible = np.flatnonzero(((high > 0) & (low < [width, height])).all(axis=1))
    outline = target[outline_edges(faces, corners)]
    corners, faces = corners[visible], faces[visible]
    if not len(corners):
        return picture
    sampler = Sampler(texture, corners, source[faces])
    scan = ScanConverter(corners)
    height_at = _order_of_triangles if levels is None else _planes(corners, levels[faces])

    for top, bottom, touched in _bands(outline, width, height):
        n_pixels = (bottom - top) * width
        triangle, place = scan.pixels(top, bottom, width)
        x, y = place % width + 0.5, place // width + (top + 0.5)
        inside = Samples(triangle, place, x, y)
        band = _composed(inside, sampler(triangle, x, y), n_pixels, height_at)
        pixels = np.flatnonzero(touched)
        if len(pixels):
            samples = scan.subsamples(top, bottom, touched)
            colours = _composed(
                samples, _shaded(samples, sampler), len(pixels) * SUBSAMPLES**2, height_at
            ).reshape(-1, SUBSAMPLES**2, 4)
            # Pixels covered by one sheet keep their colour at the centre, which is sharper.
            count = np.bincount(samples.place, minlength=colours.shape[0] * SUBSAMPLES**2)
            partial = (count.reshape(-1, SUBSAMPLES**2) != 1).any(axis=1)
            band[pixels[partial]] = colours[partial].mean(axis=1)
        picture[top:bottom] = _straight(band).reshape(-1, width, 4)
    return picture


class Samples(NamedTuple):
    """Samples of the output inside triangles; a sample is listed for every triangle over it.

    Attributes
    ----------
    triangle : (k,) int32 array
    place : (k,) int array
        Index of the sample.
    x, y : (k,) arrays
        Continuous output pixels.
    """

    triangle: Ints
    place: NDArray[Any]
    x: NDArray[Any]
    y: NDArray[Any]


class ScanConverter:
    """Finds the samples inside triangles with corners (t, 3, 2), output pixels."""

    def __init__(self, corners: Floats) -> None:
        order = np.argsort(corners[:, :, 1], axis=1)[:, :, None]
        self._x, self._y = np.moveaxis(np.take_along_axis(corners, order, axis=1), 2, 0)
        lower, upper = [0, 1, 0], [1, 2, 2]
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            rise = self._y[:, upper] - self._y[:, lower]
            self._slope = (self._x[:, upper] - self._x[:, lower]) / rise

    def spans(self, top: int, bottom: int, n: int) -> tuple[Ints, Ints, Floats, Floats]:
        """Spans of triangles on the rows of samples y = (row + 1/2) / n from top to bottom.

        Returns triangle, row, and the ends of the half-open interval, all of shape (s,).
        """
        rows = np.ceil(self._y * n - 0.5).clip(top * n, bottom * n).astype(np.int32)
        count = rows[:, 2] - rows[:, 0]
        triangle = np.repeat(np.arange(len(rows), dtype=np.int32), count)
        row = _runs(rows[:, 0], count)
        y = (row + 0.5) / n
        short = (row >= rows[triangle, 1]).astype(np.int8)
        one = self._x[triangle, 0] + (y - self._y[triangle, 0]) * self._slope[triangle, 2]
        other = self._x[triangle, short] + (
            (y - self._y[triangle, short]) * self._slope[triangle, short]
        )
        return triangle, row, np.minimum(one, other), np.maximum(one, other)

    def pixels(self, top: int, bottom: int, width: int) -> tuple[Ints, Ints]:
        """(triangle, place) of the pixels whose centres lie in triangles; place 0 is at top."""
        triangle, row, left, right = self.spans(top, bottom, 1)
        start, stop = (np.ceil(x - 0.5).clip(0, width).astype(np.int32) for x in (left, right))
        return np.repeat(triangle, stop - start), _runs((row - top) * width + start, stop - start)

    def subsamples(self, top: int, bottom: int, touched: NDArray[np.bool_]) -> Samples:
        """The samples of the touched pixels; those of the p-th are numbered from 64 p."""
        width = touched.shape[1]
        before = np.zeros(touched.size + 1, np.int32)
        np.cumsum(touched, out=before[1:])
        triangle, row, left, right = self.spans(top, bottom, SUBSAMPLES)
        line = (row // SUBSAMPLES - top) * width
        first = before[line + np.floor(left).clip(0, width).astype(np.int32)]
        count = before[line + np.ceil(right).clip(0, width).astype(np.int32)] - first
        span = np.repeat(np.arange(len(row), dtype=np.int32), count)
        triangle, row, left, right = triangle[span], row[span], left[span], right[span]
        pixel = _runs(first, count)
        x = (np.flatnonzero(touched) % width)[pixel, None] + _COLUMNS[row % SUBSAMPLES]
        hit, column = np.nonzero((x >= left[:, None]) & (x < right[:, None]))
        place = pixel[hit].astype(np.int64) * SUBSAMPLES**2
        place += row[hit] % SUBSAMPLES * SUBSAMPLES + column
        return Samples(triangle[hit], place, x[hit, column], (row[hit] + 0.5) / SUBSAMPLES)


def outline_edges(triangles: Ints, corners: Floats) -> NDArray[Any]:
    """(e, 2) edges where the mesh ends or folds: not between two triangles of one orientation."""
    edges, edge_of = unique_edges(triangles)
    e = corners[:, 1:] - corners[:, :1]
    turn = np.where(e[:, 0, 0] * e[:, 1, 1] < e[:, 0, 1] * e[:, 1, 0], -1, 1)
    return edges[np.abs(np.bincount(edge_of.ravel(), np.repeat(turn, 3), len(edges))) != 2]


def _bands(
    outline: Floats, width: int, height: int
) -> Iterator[tuple[int, int, NDArray[np.bool_]]]:
    """(top, bottom, touched) of bands of rows, each with few outline pixels."""
    rows = max(1, _BAND // width)
    ahead = [(top, min(top + rows, height)) for top in range(0, height, rows)][::-1]
    while ahead:
        top, bottom = ahead.pop()
        touched = _touched(outline, top, bottom, width)
        if bottom - top > 1 and touched.sum() > _OUTLINE:
            middle = (top + bottom) // 2
            ahead += [(middle, bottom), (top, middle)]
        else:
            yield top, bottom, touched


def _touched(segments: Floats, top: int, bottom: int, width: int) -> NDArray[np.bool_]:
    """(rows, width) mask of the pixels that segments (e, 2, 2) touch."""
    touched = np.zeros((bottom - top, width), dtype=bool)
    order = np.argsort(segments[:, :, 1], axis=1)[:, :, None]
    a, b = np.moveaxis(np.take_along_axis(segments, order, axis=1), 1, 0)
    first = np.floor(a[:, 1]).clip(top, bottom).astype(np.int32)
    last = np.floor(b[:, 1]).clip(top - 1, bottom - 1).astype(np.int32)
    count = np.maximum(last - first + 1, 0)
    row = _runs(first, count)
    a, b = np.repeat(a, count, axis=0), np.repeat(b, count, axis=0)
    rise = b[:, 1] - a[:, 1]
    slope = np.divide(b[:, 0] - a[:, 0], rise, out=np.zeros_like(rise), where=rise > 0)
    # The x at which the segment enters and leaves the row of pixels.
    enter = np.where(a[:, 1] >= row, a[:, 0], a[:, 0] + (row - a[:, 1]) * slope)
    leave = np.where(b[:, 1] <= row + 1, b[:, 0], a[:, 0] + (row + 1 - a[:, 1]) * slope)
    margin = 1e-6 * (1 + np.abs(enter) + np.abs(leave))
    left = np.floor(np.minimum(enter, leave) - margin).clip(0, width).astype(np.int32)
    right = np.floor(np.maximum(enter, leave) + margin).clip(-1, width - 1).astype(np.int32)
    touched.ravel()[_runs((row - top) * width + left, np.maximum(right - left + 1, 0))] = True
    return touched


def _planes(corners: Floats, heights: Floats) -> Callable[[Samples], Floats]:
    """Heights of samples on the planes through heights (t, 3) at corners (t, 3, 2)."""
    right, down = gradients(corners, heights[:, :, None])[:, 0].T
    level = heights[:, 0] - right * corners[:, 0, 0] - down * corners[:, 0, 1]

    def at(samples: Samples) -> Floats:
        triangle = samples.triangle
        return level[triangle] + right[triangle] * samples.x + down[triangle] * samples.y

    return at


def _order_of_triangles(samples: Samples) -> Floats:
    return samples.triangle.astype(np.float64)


def _shaded(samples: Samples, sampler: Sampler) -> NDArray[np.float32]:
    """(k, 4) colours of subsamples: one look-up for those of a triangle in a pixel.

    It is made at their centroid: a look-up filters over a whole pixel, so one at each sample would
    blur the outline.
    """
    n_triangles = int(samples.triangle.max(initial=0)) + 1
    pixel = samples.place // SUBSAMPLES**2
    _, first, fragment, count = np.unique(
        pixel * n_triangles + samples.triangle,
        return_index=True,
        return_inverse=True,
        return_counts=True,
    )
    x, y = (np.bincount(fragment, values) / count for values in (samples.x, samples.y))
    return sampler(samples.triangle[first], x, y)[fragment]


def _composed(
    samples: Samples,
    colours: NDArray[np.float32],
    n_places: int,
    height_at: Callable[[Samples], Floats],
) -> NDArray[np.float32]:
    """(n_places, 4) premultiplied colours of samples (k, 4), the higher ones over the lower."""
    canvas = np.zeros((n_places, 4), np.float32)
    place = samples.place
    canvas[place] = colours
    count = np.bincount(place, minlength=n_places)
    if count.max() <= 1:
        return canvas
    rest = np.flatnonzero(count[place] > 1)
    canvas[place[rest]] = 0
    height = height_at(Samples(*(values[rest] for values in samples)))
    rest = rest[np.lexsort((height, place[rest]))]
    first = np.flatnonzero(np.diff(place[rest], prepend=-1))
    rank = np.arange(len(rest)) - np.repeat(first, np.diff(first, append=len(rest)))
    for k in range(int(rank.max(initial=-1)) + 1):
        chosen = rest[rank == k]
        below, above = canvas[place[chosen]], colours[chosen]
        canvas[place[chosen]] = below * (1 - above[:, 3:]) + above
    return canvas


def _straight(premultiplied: NDArray[np.float32]) -> NDArray[np.uint8]:
    """(n, 4) 8-bit colours with straight alpha."""
    result = np.zeros(premultiplied.shape, np.uint8)
    seen = np.flatnonzero(premultiplied[:, 3] >= 0.5 / 255)
    colours = premultiplied[seen]
    colours[:, :3] *= np.float32(255) / colours[:, 3:]
    colours[:, 3] *= 255
    result[seen] = np.minimum(colours + np.float32(0.5), np.float32(255))
    return result


def _runs(first: NDArray[Any], count: NDArray[Any]) -> Ints:
    """The integers first[0], first[0] + 1, ... (count[0] of them), first[1], ..., as int32."""
    ends = np.cumsum(count)
    total = int(ends[-1]) if len(ends) else 0
    offset = (first - (ends - count)).astype(np.int32)
    return np.repeat(offset, count) + np.arange(total, dtype=np.int32)


def _checked_size(size: tuple[int, int]) -> tuple[int, int]:
    width, height = (int(side) for side in size)
    if width < 1 or height < 1:
        raise ValueError(f"size is {width} x {height} pixels; both sides must be at least 1")
    if width * height >= 1 << 30:
        raise ValueError(f"size is {width} x {height} pixels; at most 2^30 pixels can be drawn")
    return width, height


def _checked(values: ArrayLike, name: str, n: int | None, *shape: int) -> Floats:
    """Finite values of this shape for each of n vertices, or of any number of them."""
    array = np.asarray(values, dtype=np.float64)
    if array.ndim != 1 + len(shape) or array.shape[1:] != shape or n not in (None, len(array)):
        expected = ", ".join(map(str, (n or "v", *shape)))
        raise ValueError(f"{name} has shape {array.shape}; expected ({expected})")
    bad = np.argwhere(~np.isfinite(array))
    if len(bad):
        raise ValueError(f"{name}[{bad[0, 0]}] is {array[bad[0, 0]]}; it must be finite")
    return array


def _checked_triangles(triangles: ArrayLike, n_vertices: int) -> Ints:
    array = np.asarray(triangles)
    if array.size == 0:
        return np.zeros((0, 3), np.int32)
    if array.ndim != 2 or array.shape[1] != 3 or not np.issubdtype(array.dtype, np.integer):
        raise ValueError(
            f"triangles has shape {array.shape} and type {array.dtype}; expected integers (t, 3)"
        )
    bad = np.flatnonzero(((array < 0) | (array >= n_vertices)).any(axis=1))
    if bad.size:
        raise ValueError(
            f"triangle {bad[0]} is {array[bad[0]].tolist()}, but there are {n_vertices} vertices"
        )
    return array.astype(np.int32)
