"""Draw a textured triangle mesh into a picture, on the CPU and without OpenGL.

Triangles are cut into horizontal spans. The crossing of an edge with a row of samples is computed
from the edge's end points alone, in the order of y. So two triangles that share an edge get exactly
the same number, and every sample belongs to exactly one of them.
"""

import functools
import os
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glid_nb._arrays import Array, Floats
from glid_nb.imaging.mesh import unique_edges
from glid_nb.imaging.progress import Progress, report
from glid_nb.imaging.texture import Sampler, Texture, affine, gradients, placed

TILE = 1 << 17  # pixels drawn at a time, to bound the memory
TILE_WIDTH = 512  # pixels; a compact tile needs only a small part of the picture
_MOST_THREADS = 8  # each thread needs some 50 MB
SUBSAMPLES = 8  # rows and columns of the samples in an outline pixel

Ints = NDArray[np.integer]
Colours = NDArray[np.float32]


class Tile(NamedTuple):
    """A rectangle of the output's pixels. Its pixels are numbered row by row."""

    left: int
    top: int
    width: int
    rows: int

    @property
    def size(self) -> int:
        return self.width * self.rows

    @property
    def part(self) -> tuple[slice, slice]:
        """The slices of the tile in the output."""
        return slice(self.top, self.top + self.rows), slice(self.left, self.left + self.width)


def render_mesh(
    texture: ArrayLike | Texture,
    places: Floats,
    positions: Floats,
    triangles: Ints,
    size: tuple[int, int],
    heights: Floats | None = None,
    progress: Progress | None = None,
) -> NDArray[np.uint8]:
    """Warp a picture with a triangle mesh; (h, w, 4) RGBA with straight alpha.

    The vertices lie at ``places`` (v, 2) in the picture and go to ``positions`` (v, 2) in the
    output, which has the ``size`` (w, h). Both are continuous pixels, x right, y down, with (0, 0)
    at the top left corner. Parts beyond the picture are transparent. Pass a :class:`Texture` to
    draw it many times.

    ``heights`` (v,) order overlapping triangles: the higher one is drawn over the lower one. Of
    equally high ones, the later one is drawn over the other. Intersecting sheets meet along a line.
    Triangles that share an edge leave no seam and share no pixel. Outlines are anti-aliased with 64
    samples per pixel. The picture is filtered with premultiplied alpha: by cubic interpolation
    where it is magnified, anisotropically on an image pyramid where it is minified. ``progress`` is
    called with the numbers of finished and of all tiles. If it returns True, `Stopped` is raised.
    """
    picture = np.zeros((size[1], size[0], 4), np.uint8)
    outline = ScanConverter(_strips(positions[outline_edges(triangles, positions[triangles])]))
    scan, triangles, height = _seen(positions, triangles, size, heights)
    if scan is None:
        return picture
    sampler = Sampler(Texture.from_image(texture), positions[triangles], places[triangles])
    draw = functools.partial(_draw_tile, picture, outline, _Surface(scan, sampler, *height))
    _for_all(draw, tiles(size), progress)
    return picture


def render_nearest(
    values: NDArray[Any],
    places: Floats,
    positions: Floats,
    triangles: Ints,
    size: tuple[int, int],
    heights: Floats | None = None,
    fill: float = 0,
    progress: Progress | None = None,
) -> NDArray[Any]:
    """Move the values of a picture (h, w, c) of any type with a triangle mesh; (h, w, c).

    Like `render_mesh`, but each pixel of the output takes the value of one pixel of the picture:
    the source of its centre. Where triangles overlap, the highest one counts whose value is not
    ``fill``. For uint8 and uint16 with four channels, it is the highest whose alpha is not 0. If
    there is no such triangle, the output is ``fill``.
    """
    result = np.full((size[1], size[0], values.shape[2]), fill, values.dtype)
    scan, triangles, height = _seen(positions, triangles, size, heights)
    if scan is None:
        return result
    corners, at = positions[triangles], places[triangles]
    maps = affine(corners, at, gradients(corners, at))
    draw = functools.partial(_draw_nearest, result, values, scan, maps, height, fill)
    _for_all(draw, tiles(size), progress)
    return result


def tiles(size: tuple[int, int]) -> list[Tile]:
    """The tiles of a picture of (w, h) pixels, row by row."""
    width, height = size
    across = min(width, TILE_WIDTH)
    down = max(1, TILE // across)
    return [
        Tile(left, top, min(across, width - left), min(down, height - top))
        for top in range(0, height, down)
        for left in range(0, width, across)
    ]


def _for_all(draw: Callable[[Tile], None], tiles: list[Tile], progress: Progress | None) -> None:
    """Draw all tiles, several at a time if there are many."""
    report(progress, 0, len(tiles))
    n_threads = min(os.cpu_count() or 1, _MOST_THREADS, len(tiles) // 4)
    if n_threads < 2:
        for done, tile in enumerate(tiles):
            draw(tile)
            report(progress, done + 1, len(tiles))
        return
    pool = ThreadPoolExecutor(n_threads, thread_name_prefix="glid-nb-render")
    try:
        for done, _ in enumerate(pool.map(draw, tiles)):
            report(progress, done + 1, len(tiles))
    finally:  # cancel tiles that have not begun, also after Ctrl-C
        pool.shutdown(cancel_futures=True)


def _seen(
    positions: Floats, triangles: Ints, size: tuple[int, int], heights: Floats | None
) -> "tuple[ScanConverter | None, Ints, tuple[Floats, Floats]]":
    """The triangles visible in the output, and their heights ``level + slope . (x, y)``."""
    corners = positions[triangles]
    low, high = corners.min(axis=1), corners.max(axis=1)
    visible = ((high > 0) & (low < size)).all(axis=1)
    triangles, corners = triangles[visible], corners[visible]
    levels = (np.zeros(len(positions)) if heights is None else heights)[triangles]
    slope = gradients(corners, levels[:, :, None])[:, 0]
    level = levels[:, 0] - (slope * corners[:, 0]).sum(axis=1)
    return ScanConverter(corners) if len(triangles) else None, triangles, (level, slope)


def _draw_tile(
    picture: NDArray[np.uint8], outline: "ScanConverter", surface: "_Surface", tile: Tile
) -> None:
    hits = surface.scan.centres(tile)
    touched = np.zeros(tile.size, dtype=bool)
    touched[outline.centres(tile).place] = True
    if not len(hits.place) and not touched.any():
        return
    band = np.zeros((tile.size, 4), np.uint8)
    count = np.bincount(hits.place, minlength=tile.size)
    if (layered := count > 1).any():
        band[layered] = _straight(surface.draw(tile, layered, 1)[0][:, 0])
        hits = hits.where(~layered[hits.place])
    band[hits.place] = _straight(surface.sampler(hits.triangle, hits.x, hits.y))
    if touched.any():
        fine, count = surface.draw(tile, touched, SUBSAMPLES)
        # Pixels covered by one sheet keep their colour at the centre, which is sharper.
        partial = (count != 1).any(axis=1)
        band[np.flatnonzero(touched)[partial]] = _straight(fine[partial].mean(axis=1))
    picture[tile.part] = band.reshape(tile.rows, tile.width, 4)


def _draw_nearest(
    result: NDArray[Any],
    values: NDArray[Any],
    scan: "ScanConverter",
    maps: Floats,
    height: tuple[Floats, Floats],
    fill: float,
    tile: Tile,
) -> None:
    hits = scan.centres(tile)
    if not len(hits.place):
        return
    h, w, channels = values.shape
    column, row = np.floor(placed(maps, hits.triangle, hits.x, hits.y)).astype(np.intp)
    inside = (column >= 0) & (column < w) & (row >= 0) & (row < h)
    hits = hits.where(inside)
    found = values[row[inside], column[inside]]
    if channels == 4 and values.dtype in (np.uint8, np.uint16):
        seen = found[:, 3] > 0
    else:
        seen = ((found != fill) & ~(np.isnan(found) & np.isnan(fill))).any(axis=1)
    band = np.full((tile.size, channels), fill, values.dtype)
    for above in _ranks(hits, *height):
        above = above[seen[above]]
        band[hits.place[above]] = found[above]
    result[tile.part] = band.reshape(tile.rows, tile.width, channels)


class Hits(NamedTuple):
    """Samples of the output inside triangles, (k,) arrays; one hit per sample and triangle."""

    triangle: Ints
    place: Ints  # number of the sample
    x: Array  # continuous output pixels
    y: Array

    def where(self, chosen: NDArray[np.bool_]) -> "Hits":
        return Hits(self.triangle[chosen], self.place[chosen], self.x[chosen], self.y[chosen])


class ScanConverter:
    """Finds the samples inside triangles with corners (t, 3, 2), output pixels."""

    def __init__(self, corners: Floats) -> None:
        order = np.argsort(corners[:, :, 1], axis=1)[:, :, None]
        self._x, self._y = np.moveaxis(np.take_along_axis(corners, order, axis=1), 2, 0)
        self._left, self._right = self._x.min(axis=1), self._x.max(axis=1)
        lower, upper = [0, 1, 0], [1, 2, 2]
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            rise = self._y[:, upper] - self._y[:, lower]
            self._slope = (self._x[:, upper] - self._x[:, lower]) / rise

    def centres(self, tile: Tile) -> Hits:
        """Hits of the centres of a tile's pixels. The ``place`` is the number of the pixel."""
        triangle, row, left, right = self._spans(tile, 1)
        first = np.ceil(left - 0.5 - tile.left).clip(0, tile.width).astype(np.intp)
        count = np.ceil(right - 0.5 - tile.left).clip(0, tile.width).astype(np.intp) - first
        place = _runs(first + (row - tile.top) * tile.width, count)
        x = _runs(first, count) + (tile.left + 0.5)
        return Hits(np.repeat(triangle, count), place, x, np.repeat(row + 0.5, count))

    def samples(self, tile: Tile, chosen: NDArray[np.bool_], n: int) -> Hits:
        """Hits of the samples in the chosen pixels (tile.size,) of a tile.

        A pixel has n rows of n samples. The rows are shifted, so that a vertical edge has n^2
        levels of coverage. The samples of the p-th chosen pixel are numbered from p n^2, row by
        row.
        """
        shift = ((np.arange(n) * 3) % n + 0.5) / n
        columns = (np.arange(n) + shift[:, None]) / n
        before = np.concatenate([[0], np.cumsum(chosen)])
        triangle, row, left, right = self._spans(tile, n)
        line = (row // n - tile.top) * tile.width
        starts, ends = np.floor(left) - tile.left, np.ceil(right) - tile.left
        first = before[line + starts.clip(0, tile.width).astype(np.intp)]
        count = before[line + ends.clip(0, tile.width).astype(np.intp)] - first
        pixel, span = _runs(first, count), np.repeat(np.arange(len(row)), count)
        x = (np.flatnonzero(chosen) % tile.width + tile.left)[pixel, None] + columns[row % n][span]
        hit, column = np.nonzero((x >= left[span, None]) & (x < right[span, None]))
        span, x = span[hit], x[hit, column]
        place = pixel[hit] * n**2 + row[span] % n * n + column
        return Hits(triangle[span], place, x, (row[span] + 0.5) / n)

    def _spans(self, tile: Tile, n: int) -> tuple[Ints, Ints, Floats, Floats]:
        """(s,) triangle, row and half-open interval of each span. Rows are at (row + 1/2) / n."""
        near = (self._y[:, 2] > tile.top) & (self._y[:, 0] < tile.top + tile.rows)
        near &= (self._right > tile.left) & (self._left < tile.left + tile.width)
        chosen = np.flatnonzero(near)
        x, y, slope = self._x[chosen], self._y[chosen], self._slope[chosen]
        low, high = tile.top * n, (tile.top + tile.rows) * n
        rows = np.ceil(y * n - 0.5).clip(low, high).astype(np.intp)
        count = rows[:, 2] - rows[:, 0]
        triangle, row = np.repeat(np.arange(len(rows)), count), _runs(rows[:, 0], count)
        level = (row + 0.5) / n
        short = (row >= rows[triangle, 1]).astype(np.intp)
        one, other = (
            x[triangle, start] + (level - y[triangle, start]) * slope[triangle, edge]
            for start, edge in ((0, 2), (short, short))
        )
        return chosen[triangle], row, np.minimum(one, other), np.maximum(one, other)


class _Surface(NamedTuple):
    """Triangles with a texture and heights ``level + slope . (x, y)``."""

    scan: ScanConverter
    sampler: Sampler
    level: Floats
    slope: Floats

    def draw(self, tile: Tile, chosen: NDArray[np.bool_], n: int) -> tuple[Colours, Ints]:
        """(p, n^2, 4) premultiplied colours of `samples`, and the number of triangles at each."""
        hits = self.scan.samples(tile, chosen, n)
        colours = self.sampler(hits.triangle, hits.x, hits.y) if n == 1 else self._shaded(hits, n)
        canvas = np.zeros((np.count_nonzero(chosen) * n**2, 4), np.float32)
        for above in _ranks(hits, self.level, self.slope):
            below = canvas[hits.place[above]] * (1 - colours[above, 3:])
            canvas[hits.place[above]] = below + colours[above]
        count = np.bincount(hits.place, minlength=len(canvas))
        return canvas.reshape(-1, n**2, 4), count.reshape(-1, n**2)

    def _shaded(self, samples: Hits, n: int) -> Colours:
        """(k, 4) colours. A look-up filters a whole pixel, so all samples of one triangle in one
        pixel share a look-up."""
        pixel, n_triangles = samples.place // n**2, len(self.level)
        keys = pixel * n_triangles + samples.triangle
        _, first, fragment, count = np.unique(
            keys, return_index=True, return_inverse=True, return_counts=True
        )
        x, y = (np.bincount(fragment, values) / count for values in (samples.x, samples.y))
        return self.sampler(samples.triangle[first], x, y)[fragment]


def _ranks(hits: Hits, level: Floats, slope: Floats) -> Iterable[Ints]:
    """Indices of the hits that are the lowest at their places, then of the second, and so on."""
    count = np.bincount(hits.place)
    if count.max(initial=0) <= 1:
        return [np.arange(len(hits.place))]
    rise_x, rise_y = slope[hits.triangle].T
    height = level[hits.triangle] + rise_x * hits.x + rise_y * hits.y
    # A hit of rank k has k other hits below it at its place.
    order = np.lexsort((height, hits.place))
    rank = np.arange(len(order)) - (np.cumsum(count) - count)[hits.place[order]]
    return (order[rank == k] for k in range(count.max()))


def outline_edges(triangles: Ints, corners: Floats) -> Ints:
    """(e, 2) edges where the mesh ends or folds: all but those between two triangles of the same
    orientation."""
    edges, edge_of = unique_edges(triangles)
    e = corners[:, 1:] - corners[:, :1]
    turn = np.where(e[:, 0, 0] * e[:, 1, 1] < e[:, 0, 1] * e[:, 1, 0], -1, 1)
    return edges[np.abs(np.bincount(edge_of.ravel(), np.repeat(turn, 3), len(edges))) != 2]


def _strips(segments: Floats) -> Floats:
    """Triangles over the centres of all pixels that segments (e, 2, 2) touch."""
    along = np.diff(segments, axis=1)
    # A pixel's corner is sqrt(1/2) from its centre.
    along *= 0.71 / np.maximum(np.linalg.norm(along, axis=2, keepdims=True), 1e-300)
    across = along[..., ::-1] * [1, -1]
    start, end = segments[:, :1] - along, segments[:, 1:] + along
    corners = np.concatenate([start - across, start + across, end + across, end - across], axis=1)
    return corners[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3, 2)


def _runs(first: Ints, count: Ints) -> Ints:
    """Concatenated ranges of ``count`` integers from ``first``."""
    return np.repeat(first - (np.cumsum(count) - count), count) + np.arange(count.sum())


def _straight(premultiplied: Colours) -> NDArray[np.uint8]:
    """(k, 4) pixels of 8 bit with straight alpha. Overwrites the given colours."""
    alpha = premultiplied[:, 3].copy()
    unseen = alpha < 0.5 / 255
    alpha[unseen] = 1
    premultiplied[:, :3] *= (np.float32(255) / alpha)[:, None]
    premultiplied[:, 3] *= 255
    premultiplied += np.float32(0.5)
    np.minimum(premultiplied, np.float32(255), out=premultiplied)
    result = premultiplied.astype(np.uint8)
    result[unseen] = 0
    return result
