"""Draw a textured triangle mesh into a picture, on the CPU and without OpenGL."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glid_nb.imaging import scanline
from glid_nb.imaging.texture import Sampler, Texture

# Pixels that are drawn at a time; bounds the memory beyond the picture itself.
_BAND = 1 << 20

# Pixels on outlines that are resolved at a time.
_OUTLINE = 1 << 16


def render_mesh(
    texture: ArrayLike | Texture,
    texture_xy: ArrayLike,
    positions_xy: ArrayLike,
    triangles: ArrayLike,
    size: tuple[int, int],
) -> NDArray[np.uint8]:
    """Warp a picture with a triangle mesh.

    Triangles may overlap: one later in the list covers one earlier. Triangles that share an edge
    leave no seam and share no pixel. Outlines are anti-aliased with 64 samples per pixel, the
    picture inside with cubic interpolation where it is magnified and an anisotropic walk over an
    image pyramid where it is minified, on premultiplied alpha throughout.

    Parameters
    ----------
    texture : (h, w, 4) or (h, w, 3) or (h, w) array, or Texture
        The picture: uint8, uint16 or floating point in [0, 1], straight alpha. A
        :class:`Texture` saves the preparation when one picture is drawn many times.
    texture_xy : (v, 2) array
        Where the vertices lie in the picture, continuous pixels: x right, y down, (0, 0) the
        top-left corner. Parts of a triangle beyond the picture are transparent.
    positions_xy : (v, 2) array
        Where they lie in the output, continuous pixels.
    triangles : (t, 3) int array
        Vertex indices, either orientation.
    size : (w, h)
        Size of the output, pixels.

    Returns
    -------
    (h, w, 4) uint8 array
        RGBA with straight alpha; fully transparent pixels are (0, 0, 0, 0).

    Raises
    ------
    ValueError
        When shapes do not match, an index is out of range, a coordinate is not finite, or the
        size is not positive. The message names the culprit.
    """
    width, height = _checked_size(size)
    source = _checked_points(texture_xy, "texture_xy")
    target = _checked_points(positions_xy, "positions_xy")
    if len(source) != len(target):
        raise ValueError(
            f"texture_xy has {len(source)} vertices and positions_xy {len(target)}; "
            "give both for every vertex"
        )
    faces = _checked_triangles(triangles, len(target))
    if not isinstance(texture, Texture):
        texture = Texture.from_image(texture)
    picture = np.zeros((height, width, 4), np.uint8)

    corners = target[faces]
    low, high = corners.min(axis=1), corners.max(axis=1)
    visible = ((high > 0) & (low < [width, height])).all(axis=1)
    outline = target[scanline.outline_edges(faces, corners)]
    corners = corners[visible]
    if not len(corners):
        return picture
    sampler = Sampler(texture, corners, source[faces[visible]])
    coarse = scanline.ScanConverter(corners)
    fine = scanline.ScanConverter(corners, scanline.SUBSAMPLES)

    rows = max(1, _BAND // width)
    for top in range(0, height, rows):
        bottom = min(top + rows, height)
        touched = scanline.pixels_on(outline, top, bottom, width)
        seen = scanline.paint(coarse.spans(top, bottom, width), top, bottom, width)
        band = picture[top:bottom].reshape(-1, 4)

        inside = np.flatnonzero((seen >= 0) & ~touched.ravel())
        x, y = inside % width + np.float32(0.5), inside // width + np.float32(top + 0.5)
        band[inside] = _straight(sampler(seen[inside], x, y))

        close = scanline.near(corners, touched, top)
        for start, stop in _portions(touched):
            pixels = start * width + np.flatnonzero(touched[start:stop])
            n, first, last = scanline.SUBSAMPLES, top + start, top + stop
            spans = fine.spans(first * n, last * n, width * n, close)
            parts = scanline.fragments(scanline.paint_subsamples(spans, touched[start:stop], first))
            band[pixels] = _straight(_resolved(parts, pixels, width, top, sampler))
    return picture


def _portions(touched: NDArray[np.bool_]) -> Iterator[tuple[int, int]]:
    """Consecutive (start, stop) rows with few enough touched pixels to be resolved at once."""
    count = np.cumsum(touched.sum(axis=1))
    start = 0
    while start < len(count) and count[-1] > (done := count[start - 1] if start else 0):
        stop = max(int(np.searchsorted(count, done + _OUTLINE, side="right")), start + 1)
        yield start, stop
        start = stop


def _resolved(
    parts: scanline.Fragments, pixels: NDArray[np.int64], width: int, top: int, sampler: Sampler
) -> NDArray[np.float32]:
    """(p, 4) premultiplied colours of the pixels that an outline touches.

    Where all fragments of a pixel show the same part of the picture it is looked up at the centre
    of what they cover together, so a pixel that an outline only grazes is drawn like any other.
    Where sheets overlap each is looked up where it is visible.
    """
    place = pixels[parts.pixel]
    corner = np.stack([place % width, place // width + top], axis=1).astype(np.float32)
    middle = corner + parts.pixel_centre
    seen, reach = sampler.footprint(parts.triangle, middle)
    starts = np.flatnonzero(np.diff(parts.pixel, prepend=-1))
    if not len(starts):
        return np.zeros((len(pixels), 4), np.float32)
    group = np.cumsum(np.diff(parts.pixel, prepend=-1) > 0) - 1
    low = np.minimum.reduceat(seen - reach, starts)
    high = np.maximum.reduceat(seen + reach, starts)
    least = np.minimum.reduceat(reach, starts)
    one_sheet = (high - low <= 2 * 2 * least).all(axis=1)[group]
    points = np.where(one_sheet[:, None], middle, corner + parts.centre)
    colours = sampler(parts.triangle, points[:, 0], points[:, 1]) * parts.share[:, None]
    columns = [np.bincount(parts.pixel, column, len(pixels)) for column in colours.T]
    return np.stack(columns, axis=1).astype(np.float32)


def _straight(premultiplied: NDArray[np.float32]) -> NDArray[np.uint8]:
    """(k, 4) 8-bit colours with straight alpha."""
    alpha = premultiplied[:, 3:]
    scale = np.divide(255, alpha, out=np.zeros_like(alpha), where=alpha > 0)
    result = np.empty(premultiplied.shape, np.uint8)
    result[:, :3] = np.minimum(premultiplied[:, :3] * scale + np.float32(0.5), 255)
    result[:, 3:] = alpha * 255 + np.float32(0.5)
    result[result[:, 3] == 0] = 0
    return result


def _checked_size(size: tuple[int, int]) -> tuple[int, int]:
    width, height = (int(side) for side in size)
    if width < 1 or height < 1:
        raise ValueError(f"size is {width} x {height} pixels; both sides must be at least 1")
    if width * height >= 1 << 30:
        raise ValueError(f"size is {width} x {height} pixels; at most 2^30 pixels can be drawn")
    return width, height


def _checked_points(points: ArrayLike, name: str) -> NDArray[np.float64]:
    array = np.asarray(points, dtype=np.float64)
    if array.ndim != 2 or array.shape[1] != 2:
        raise ValueError(f"{name} has shape {array.shape}; expected (v, 2)")
    bad = np.flatnonzero(~np.isfinite(array).all(axis=1))
    if bad.size:
        raise ValueError(f"{name}: vertex {bad[0]} is {tuple(array[bad[0]])}; it must be finite")
    return array


def _checked_triangles(triangles: ArrayLike, n_vertices: int) -> NDArray[np.int32]:
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
