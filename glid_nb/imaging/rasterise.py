"""Draw a textured triangle mesh into a picture, on the CPU and without OpenGL.

Triangles are cut into horizontal spans. The crossing of an edge with a row of samples depends only
on the edge's end points, in the order of y, so triangles that share an edge get the same number to
the last bit and every sample belongs to exactly one of them.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glid_nb._arrays import Floats
from glid_nb.imaging.mesh import unique_edges
from glid_nb.imaging.texture import Sampler, Texture, gradients

_BAND = 1 << 17  # pixels drawn at a time, to bound the memory
SUBSAMPLES = 8  # rows and columns of the samples in an outline pixel

Ints = NDArray[np.integer]
Colours = NDArray[np.float32]


def render_mesh(
    texture: ArrayLike | Texture,
    places: Floats,
    positions: Floats,
    triangles: Ints,
    size: tuple[int, int],
    heights: Floats | None = None,
) -> NDArray[np.uint8]:
    """Warp a picture with a triangle mesh; (h, w, 4) RGBA with straight alpha.

    The vertices lie at ``places`` (v, 2) in the picture and go to ``positions`` (v, 2) in the
    output, which has the ``size`` (w, h): continuous pixels, x right, y down, (0, 0) the top left
    corner. Parts beyond the picture are transparent. Pass a :class:`Texture` to draw it many times.

    Where triangles overlap, the higher one by the ``heights`` (v,) of the vertices, or of equally
    high ones the later, is composed over the other; intersecting sheets meet along a line.
    Triangles that share an edge leave no seam and share no pixel. Outlines are anti-aliased with 64
    samples per pixel. The picture is filtered with premultiplied alpha: by cubic interpolation
    where it is magnified, anisotropically on an image pyramid where it is minified.
    """
    width, height = size
    picture = np.zeros((height, width, 4), np.uint8)
    corners = positions[triangles]
    outline = ScanConverter(_strips(positions[outline_edges(triangles, corners)]))
    low, high = corners.min(axis=1), corners.max(axis=1)
    visible = ((high > 0) & (low < size)).all(axis=1)
    triangles, corners = triangles[visible], corners[visible]
    if not len(triangles):
        return picture
    levels = (np.zeros(len(positions)) if heights is None else heights)[triangles]
    slope = gradients(corners, levels[:, :, None])[:, 0]
    level = levels[:, 0] - (slope * corners[:, 0]).sum(axis=1)
    sampler = Sampler(Texture.from_image(texture), corners, places[triangles])
    surface = _Surface(ScanConverter(corners), sampler, level, slope)
    rows = max(1, _BAND // width)
    for top in range(0, height, rows):
        band = picture[top : top + rows]
        everywhere = np.ones(band.shape[:2], dtype=bool)
        colours = surface.draw(top, everywhere, 1)[0][:, 0]
        touched = np.zeros(everywhere.size, dtype=bool)
        touched[outline.samples(top, everywhere, 1).place] = True
        fine, count = surface.draw(top, touched.reshape(everywhere.shape), SUBSAMPLES)
        # Pixels covered by one sheet keep their colour at the centre, which is sharper.
        partial = (count != 1).any(axis=1)
        colours[np.flatnonzero(touched)[partial]] = fine[partial].mean(axis=1)
        band[:] = _straight(colours).reshape(band.shape)
    return picture


class Hits(NamedTuple):
    """Samples of the output inside triangles, (k,) each; one for every triangle over a sample."""

    triangle: Ints
    place: Ints  # number of the sample
    x: Floats  # continuous output pixels
    y: Floats


class ScanConverter:
    """Finds the samples inside triangles with corners (t, 3, 2), output pixels."""

    def __init__(self, corners: Floats) -> None:
        order = np.argsort(corners[:, :, 1], axis=1)[:, :, None]
        self._x, self._y = np.moveaxis(np.take_along_axis(corners, order, axis=1), 2, 0)
        lower, upper = [0, 1, 0], [1, 2, 2]
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            rise = self._y[:, upper] - self._y[:, lower]
            self._slope = (self._x[:, upper] - self._x[:, lower]) / rise

    def samples(self, top: int, chosen: NDArray[np.bool_], n: int) -> Hits:
        """Samples in the chosen pixels (rows, width) of a band that begins at the row ``top``.

        A pixel has n rows of n, shifted, so that a vertical edge has n^2 levels of coverage. The
        p-th chosen pixel's are numbered from p n^2, row by row.
        """
        rows, width = chosen.shape
        shift = ((np.arange(n) * 3) % n + 0.5) / n
        columns = (np.arange(n) + shift[:, None]) / n
        before = np.concatenate([[0], np.cumsum(chosen)])
        triangle, row, left, right = self._spans(top * n, (top + rows) * n, n)
        line = (row // n - top) * width
        first = before[line + np.floor(left).clip(0, width).astype(np.intp)]
        count = before[line + np.ceil(right).clip(0, width).astype(np.intp)] - first
        pixel, span = _runs(first, count), np.repeat(np.arange(len(row)), count)
        x = (np.flatnonzero(chosen) % width)[pixel, None] + columns[row % n][span]
        hit, column = np.nonzero((x >= left[span, None]) & (x < right[span, None]))
        span, x = span[hit], x[hit, column]
        place = pixel[hit] * n**2 + row[span] % n * n + column
        return Hits(triangle[span], place, x, (row[span] + 0.5) / n)

    def _spans(self, low: int, high: int, n: int) -> tuple[Ints, Ints, Floats, Floats]:
        """(s,) triangle, row of samples y = (row + 1/2) / n, half-open interval of each span."""
        rows = np.ceil(self._y * n - 0.5).clip(low, high).astype(np.intp)
        count = rows[:, 2] - rows[:, 0]
        triangle, row = np.repeat(np.arange(len(rows)), count), _runs(rows[:, 0], count)
        y = (row + 0.5) / n
        short = (row >= rows[triangle, 1]).astype(np.intp)
        one, other = (
            self._x[triangle, start] + (y - self._y[triangle, start]) * self._slope[triangle, edge]
            for start, edge in ((0, 2), (short, short))
        )
        return triangle, row, np.minimum(one, other), np.maximum(one, other)


class _Surface(NamedTuple):
    """Triangles with a texture and heights: ``level`` + ``slope`` (x, y)."""

    scan: ScanConverter
    sampler: Sampler
    level: Floats
    slope: Floats

    def draw(self, top: int, chosen: NDArray[np.bool_], n: int) -> tuple[Colours, Ints]:
        """(p, n^2, 4) premultiplied colours of `samples`, and how many triangles are over each."""
        triangle, place, x, y = samples = self.scan.samples(top, chosen, n)
        colours = self.sampler(triangle, x, y) if n == 1 else self._shaded(samples, n)
        rise_x, rise_y = self.slope[triangle].T
        height = self.level[triangle] + rise_x * x + rise_y * y
        canvas = np.zeros((np.count_nonzero(chosen) * n**2, 4), np.float32)
        count = np.bincount(place, minlength=len(canvas))
        # Below the samples of rank k of a place there are k others.
        order = np.lexsort((height, place))
        rank = np.arange(len(order)) - (np.cumsum(count) - count)[place[order]]
        for k in range(count.max(initial=0)):
            above = order[rank == k]
            below = canvas[place[above]] * (1 - colours[above, 3:])
            canvas[place[above]] = below + colours[above]
        return canvas.reshape(-1, n**2, 4), count.reshape(-1, n**2)

    def _shaded(self, samples: Hits, n: int) -> Colours:
        """(k, 4) colours: look-ups filter a whole pixel, so one for a triangle's samples in it."""
        pixel, n_triangles = samples.place // n**2, len(self.level)
        keys = pixel * n_triangles + samples.triangle
        _, first, fragment, count = np.unique(
            keys, return_index=True, return_inverse=True, return_counts=True
        )
        x, y = (np.bincount(fragment, values) / count for values in (samples.x, samples.y))
        return self.sampler(samples.triangle[first], x, y)[fragment]


def outline_edges(triangles: Ints, corners: Floats) -> Ints:
    """(e, 2) edges where the mesh ends or folds: not between two triangles of one orientation."""
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
    result = np.zeros(premultiplied.shape, np.uint8)
    seen = premultiplied[:, 3] >= 0.5 / 255
    colours = premultiplied[seen]
    colours[:, :3] *= np.float32(255) / colours[:, 3:]
    colours[:, 3] *= 255
    result[seen] = np.minimum(colours + np.float32(0.5), np.float32(255))
    return result
