"""Draw a textured triangle mesh into a picture, on the CPU and without OpenGL."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glid_nb.imaging import scanline
from glid_nb.imaging.texture import Sampler, Texture

# Pixels that are drawn at a time; bounds the memory beyond the picture itself.
_BAND = 1 << 19

# Pixels on outlines that are resolved at a time.
_OUTLINE = 1 << 16


def render_mesh(
    texture: ArrayLike | Texture,
    texture_xy: ArrayLike,
    positions_xy: ArrayLike,
    triangles: ArrayLike,
    size: tuple[int, int],
    heights: ArrayLike | None = None,
) -> NDArray[np.uint8]:
    """Warp a picture with a triangle mesh.

    Triangles may overlap: the higher one, or without heights the one later in the list, lies over
    the other, which shows where the upper one is transparent. Triangles that share an edge leave
    no seam and share no pixel. Outlines are anti-aliased with 64 samples per pixel, the picture
    inside with cubic interpolation where it is magnified and an anisotropic walk over an image
    pyramid where it is minified, on premultiplied alpha throughout.

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
    heights : (v,) array, optional
        Heights of the vertices, which only their order matters of. Where two sheets cut through
        one another they do so along a line, while an order of triangles gives a ragged edge.

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
    levels = None if heights is None else _checked_heights(heights, len(target))
    if not isinstance(texture, Texture):
        texture = Texture.from_image(texture)
    picture = np.zeros((height, width, 4), np.uint8)

    corners = target[faces]
    low, high = scanline.bounding_boxes(corners)
    visible = np.flatnonzero(((high > 0) & (low < [width, height])).all(axis=1))
    outline = target[scanline.outline_edges(faces, corners)]
    corners, low, high = corners[visible], low[visible], high[visible]
    if not len(corners):
        return picture
    sampler = Sampler(texture, corners, source[faces[visible]])
    planes = None
    if levels is not None:
        planes = scanline.Heights.over(corners, levels[faces[visible]])
    coarse = scanline.ScanConverter(corners)
    fine = scanline.ScanConverter(corners, scanline.SUBSAMPLES)

    rows = max(1, _BAND // width)
    for top in range(0, height, rows):
        bottom = min(top + rows, height)
        touched = scanline.pixels_on(outline, top, bottom, width)
        band = np.zeros(((bottom - top) * width, 4), np.float32)
        layers = scanline.layers(coarse.spans(top, bottom, width), top, bottom, width, planes)
        for depth, layer in enumerate(layers):
            inside = ~touched.ravel()[layer.sample]
            place, triangle = layer.sample[inside], layer.triangle[inside]
            x, y = place % width + np.float32(0.5), place // width + np.float32(top + 0.5)
            _lay(sampler(triangle, x, y), band, place, first=depth == 0)

        close = scanline.near(low, high, touched, top)
        for start, stop in _portions(touched):
            pixels = start * width + np.flatnonzero(touched[start:stop])
            n, first, last = scanline.SUBSAMPLES, top + start, top + stop
            spans = fine.spans(first * n, last * n, width * n, close)
            layers = scanline.subsample_layers(spans, touched[start:stop], first, planes)
            corner = np.stack([pixels % width, pixels // width + top], axis=1)
            band[pixels] = _resolved(layers, corner.astype(np.float32), sampler)
        picture[top:bottom] = _straight(band).reshape(-1, width, 4)
    return picture


def _lay(
    colours: NDArray[np.float32], canvas: NDArray[np.float32], place: NDArray[Any], first: bool
) -> None:
    """Lay premultiplied colours (k, 4) over those of the canvas (n, 4) at distinct places."""
    if first:  # there is nothing below, and this layer is the largest
        canvas[place] = colours
    else:
        canvas[place] = canvas[place] * (1 - colours[:, 3:]) + colours


def _portions(touched: NDArray[np.bool_]) -> Iterator[tuple[int, int]]:
    """Consecutive (start, stop) rows with few enough touched pixels to be resolved at once."""
    count = np.cumsum(touched.sum(axis=1))
    start = 0
    while start < len(count) and count[-1] > (done := count[start - 1] if start else 0):
        stop = max(int(np.searchsorted(count, done + _OUTLINE, side="right")), start + 1)
        yield start, stop
        start = stop


def _resolved(
    layers: list[scanline.Layer], corner: NDArray[np.float32], sampler: Sampler
) -> NDArray[np.float32]:
    """(p, 4) premultiplied colours of pixels that an outline touches.

    ``corner`` (p, 2) holds the pixels' upper left corners.
    """
    n_samples = scanline.SUBSAMPLES**2
    result = np.zeros((len(corner), 4), np.float32)
    if not layers:
        return result
    parts = [scanline.fragments(layer) for layer in layers]
    colours = [_shaded(part, corner, sampler) for part in parts]
    # Most pixels have one layer, whose fragments just add up.
    stacked = np.zeros(len(corner), dtype=bool)
    for part in parts[1:]:
        stacked[part.pixel] = True
    share = (parts[0].count / n_samples)[:, None]
    for channel, values in enumerate((colours[0] * share).T):
        result[:, channel] = np.bincount(parts[0].pixel, values, len(corner))
    if not stacked.any():
        return result
    number = np.cumsum(stacked) - 1
    canvas = np.zeros((int(stacked.sum()) * n_samples, 4), np.float32)
    for depth, (part, colour) in enumerate(zip(parts, colours, strict=True)):
        pixel, place = np.divmod(part.sample, n_samples)
        chosen = np.flatnonzero(stacked[pixel])
        slots = number[pixel[chosen]] * n_samples + place[chosen]
        _lay(colour[part.fragment[chosen]], canvas, slots, first=depth == 0)
    result[stacked] = canvas.reshape(-1, n_samples, 4).mean(axis=1)
    return result


def _shaded(
    parts: scanline.Fragments, corner: NDArray[np.float32], sampler: Sampler
) -> NDArray[np.float32]:
    """(f, 4) premultiplied colours of fragments.

    Where all fragments of a pixel show the same part of the picture it is looked up at the centre
    of what they cover together, so a pixel that an outline only grazes is drawn like any other.
    Where sheets overlap each is looked up where it is visible.
    """
    middle = corner[parts.pixel] + parts.pixel_centre
    seen, reach = sampler.footprint(parts.triangle, middle)
    new = np.diff(parts.pixel, prepend=-1) > 0
    starts = np.flatnonzero(new)
    low = np.minimum.reduceat(seen - reach, starts)
    high = np.maximum.reduceat(seen + reach, starts)
    least = np.minimum.reduceat(reach, starts)
    one_sheet = np.all(high - low <= 4 * least, axis=1)[np.cumsum(new) - 1]
    points = np.where(one_sheet[:, None], middle, corner[parts.pixel] + parts.centre)
    return sampler(parts.triangle, points[:, 0], points[:, 1])


def _straight(premultiplied: NDArray[Any]) -> NDArray[np.uint8]:
    """(n, 4) 8-bit colours with straight alpha."""
    result = np.zeros(premultiplied.shape, np.uint8)
    seen = np.flatnonzero(premultiplied[:, 3] >= 0.5 / 255)
    colours = premultiplied[seen]
    colours[:, :3] *= np.float32(255) / colours[:, 3:]
    colours[:, 3] *= 255
    result[seen] = np.minimum(colours + np.float32(0.5), np.float32(255))
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


def _checked_heights(heights: ArrayLike, n_vertices: int) -> NDArray[np.float64]:
    array = np.asarray(heights, dtype=np.float64)
    if array.shape != (n_vertices,):
        raise ValueError(f"heights has shape {array.shape}; expected ({n_vertices},)")
    bad = np.flatnonzero(np.logical_not(np.isfinite(array)))
    if bad.size:
        raise ValueError(f"heights[{bad[0]}] is {array[bad[0]]}; it must be finite")
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
