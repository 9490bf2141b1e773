"""Cut the shape out of an opaque picture: soft alpha, and colours without the background's.

A traced mask says which pixels belong to the shape, but not by how much. Pixels on its border, such
as hair, mix the colours of the shape and of the background. In a band around the border, alpha is
the closed-form solution of Levin, Lischinski and Weiss (2008). The shape's own colours in the band
are estimated as by Forte (2021), "Approximate Fast Foreground Colour Estimation".
"""

import math
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse
import scipy.sparse.linalg
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray
from PIL import Image, ImageDraw
from scipy.ndimage import maximum_filter, minimum_filter, uniform_filter

from glid_nb._arguments import check_type
from glid_nb._arrays import Array, read_only
from glid_nb.geometry import Cage
from glid_nb.imaging.frame import PixelFrame, TraceError
from glid_nb.imaging.read import RGBA, ImageSource, as_rgba8, read_image
from glid_nb.imaging.scribbles import WALKED_PIXELS
from glid_nb.imaging.trace import Tracing

# Half the width of the band, in pixels.
# _HALF_BAND: relative to the longer side of the shape's box.
# _LEAST_HALF_BAND: the least.
# _PER_WALKED: the least in pixels of the smaller picture on which scribbles are evaluated.
_HALF_BAND, _LEAST_HALF_BAND, _PER_WALKED = 0.006, 3.0, 2.0
_MOST_PIXELS = 1_000_000  # a larger part of a picture is scaled down to find its alpha
_MOST_UNKNOWNS = 60_000  # pixels of the band after scaling
_SMOOTHNESS = 1e-5  # epsilon of the closed form; smaller variances of colours are noise
_TRUST = 0.01  # weight of the blurred mask in the band, where the colours leave alpha open
_BLURS = 0.04, 0.008  # of the two passes that estimate colours, relative to the longer side
_SURE = 0.02  # alpha this close to 0 or 1 is rounded

Mask = NDArray[np.bool_]


def cut_out(image: ImageSource, tracing: Tracing, cage: Cage | None = None) -> RGBA:
    """The traced shape of an opaque picture, (h, w, 4) RGBA with straight alpha and soft edges.

    Alpha is 1 inside the shape and 0 outside. On its border, alpha follows the picture, so hair
    stays, and the colours there are those of the shape alone, without the background's. So the room
    between the outline and the cage shows no halo of the old background. A picture with
    transparency of its own is returned as it is.

    If the cage was edited by hand, ``cage`` is the edited one. What it has more than the traced
    cage belongs to the shape. Raises a TraceError if the tracing is of a picture of another size.

    >>> import numpy as np
    >>> from glid_nb.imaging import trace
    >>> y, x = np.mgrid[:100, :100] + 0.5
    >>> picture = np.where(np.hypot(x - 50, y - 50)[..., None] < 30, [200, 30, 30], 240)
    >>> cut = cut_out(picture.astype(np.uint8), trace(picture.astype(np.uint8)))
    >>> cut[50, 50].tolist(), cut[5, 5].tolist()
    ([200, 30, 30, 255], [0, 0, 0, 0])
    """
    check_type("tracing", tracing, Tracing, "for example glid.trace(image)", TraceError)
    given = read_image(image)
    pixels = as_rgba8(given)
    if pixels.shape[:2] != tracing.mask.shape:
        height, width = tracing.mask.shape
        here = f"{pixels.shape[1]} x {pixels.shape[0]}"
        raise TraceError(
            f"the picture has {here} pixels, but the tracing is of {width} x {height}; "
            "take the picture that was traced"
        )
    if (pixels[..., 3] < 255).any():
        return given
    mask = tracing.mask
    half = _half_band(tracing, mask)
    ys, xs = _box(mask, math.ceil(3 * half))
    result = np.zeros_like(pixels)
    result[ys, xs] = _cut(pixels[ys, xs, :3], mask[ys, xs], half)
    if cage is not None and not cage.equals(tracing.cage):
        added = _added(tracing, cage)
        result[added] = pixels[added]
    return read_only(result)


def _half_band(tracing: Tracing, mask: Mask) -> float:
    ys, xs = _box(mask, 0)
    sides = ys.stop - ys.start, xs.stop - xs.start
    half = max(_HALF_BAND * max(sides), _LEAST_HALF_BAND)
    if tracing.method == "scribbles":
        half = max(half, _PER_WALKED * math.sqrt(mask.size / WALKED_PIXELS))
    return half


def _box(mask: Mask, room: int) -> tuple[slice, slice]:
    """The rows and columns of a mask, with room around it."""
    sides = []
    for axis, length in ((1, mask.shape[0]), (0, mask.shape[1])):
        at = np.flatnonzero(mask.any(axis=axis))
        sides.append(slice(max(int(at[0]) - room, 0), min(int(at[-1]) + 1 + room, length)))
    return sides[0], sides[1]


def _added(tracing: Tracing, cage: Cage) -> Mask:
    """(h, w) mask of what an edited cage has more than the traced one, up to the shape."""
    edited, traced = (filled_loops(one, tracing.frame) for one in (cage, tracing.cage))
    room = 2 * math.ceil(tracing.offset + 1) + 1
    more = np.asarray(
        minimum_filter(edited & ~traced, 3), bool
    )  # without the pixels that are cut by both
    return grown(more, room) & edited


def grown(mask: Mask, side: int) -> Mask:
    """A mask with a square of ``side`` pixels around each of its pixels."""
    return np.asarray(maximum_filter(mask, side), bool)


def filled_loops(cage: Cage, frame: PixelFrame) -> Mask:
    """(h, w) mask of the pixels inside a cage."""
    picture = Image.new("1", (frame.width, frame.height))
    for i, loop in enumerate(cage.loops):
        points = (frame.to_pixel(loop) - 0.5).ravel().tolist()
        ImageDraw.Draw(picture).polygon(points, fill=int(i == 0))
    return np.array(picture)


class _Colours(NamedTuple):
    """What the colours of a picture's part look like, at the scale of the solve."""

    alpha: Array  # (h, w)
    shape: Array  # (h, w, 3) the shape's colours
    behind: Array  # (h, w, 3) the background's


def _cut(rgb: NDArray[np.uint8], mask: Mask, half: float) -> NDArray[np.uint8]:
    """(h, w, 4) the shape of a mask, whose border is known up to ``half`` pixels."""
    band = _band(mask, half)
    scale = min(1.0, math.sqrt(_MOST_PIXELS / mask.size), math.sqrt(_MOST_UNKNOWNS / band.sum()))
    size = max(1, round(mask.shape[1] * scale)), max(1, round(mask.shape[0] * scale))
    small = np.asarray(Image.fromarray(rgb).resize(size, Image.Resampling.BOX), np.float32) / 255
    share = Image.fromarray(mask.astype(np.uint8) * 255).resize(size, Image.Resampling.BOX)
    small_mask = np.asarray(share) > 127
    found = _found(small, small_mask, max(half * scale, 1.5))
    result = np.zeros((*mask.shape, 4), np.uint8)
    inside = mask & ~band
    result[inside, :3], result[inside, 3] = rgb[inside], 255
    at: Any = np.nonzero(band)
    colours = rgb[at] / np.float32(255)
    if scale < 1:
        slope, level = _linear(small, found.alpha)
        seen = np.sum(_enlarged(slope, at, mask.shape) * colours, axis=1)
        alpha = (seen + _enlarged(level[..., None], at, mask.shape)[:, 0]).clip(0, 1)
        shape, behind = (_enlarged(one, at, mask.shape) for one in (found.shape, found.behind))
    else:
        alpha, shape, behind = found.alpha[at], found.shape[at], found.behind[at]
    alpha = _rounded(alpha)[:, None]
    own = (shape + alpha * (colours - alpha * shape - (1 - alpha) * behind)).clip(0, 1)
    own = np.where(alpha == 1, colours, np.where(alpha == 0, 0, own))
    result[at] = np.rint(255 * np.concatenate([own, alpha], axis=1)).astype(np.uint8)
    return result


def _band(mask: Mask, half: float) -> Mask:
    """The pixels of which the mask does not say whether they belong to the shape."""
    side = 2 * max(1, round(half)) + 1
    # At the picture's sides the shape goes on.
    largest = maximum_filter(mask, side, mode="nearest")
    return np.asarray(largest != minimum_filter(mask, side, mode="nearest"))


def _rounded(alpha: Array) -> Array:
    return ((alpha - _SURE) / (1 - 2 * _SURE)).clip(0, 1)


def _found(rgb: Array, mask: Mask, half: float) -> _Colours:
    """Alpha, and the colours of both sides, of a picture (h, w, 3) with values up to 1."""
    band = _band(mask, half)
    alpha = _closed_form(rgb, mask, band, 2 * round(half) + 1)
    kept, other = mask & ~band, ~mask & ~band
    shape = behind = rgb
    # Colours spread from the sure pixels first, then from all by their alpha.
    weights = kept.astype(np.float32), other.astype(np.float32)
    for share in _BLURS:
        radius = max(3, round(share * max(mask.shape)))
        shape, behind = (
            _spread(one, weight, radius)
            for one, weight in zip((shape, behind), weights, strict=True)
        )
        a = alpha[..., None]
        rest = rgb - a * shape - (1 - a) * behind
        shape, behind = (shape + a * rest).clip(0, 1), (behind + (1 - a) * rest).clip(0, 1)
        weights = alpha, 1 - alpha
    return _Colours(alpha, shape, behind)


def _spread(colours: Array, weight: Array, radius: int) -> Array:
    """The weighted mean of (h, w, 3) colours around each pixel; farther ones count a little."""
    total, count = np.zeros_like(colours), np.zeros_like(weight)
    for size, share in ((radius, 1.0), (4 * radius, 1e-3), (16 * radius, 1e-6)):
        side = 2 * size + 1
        near = share * uniform_filter(weight, side, mode="constant") + 1e-12
        count += near
        for c in range(3):
            total[..., c] += share * uniform_filter(weight * colours[..., c], side, mode="constant")
    return total / count[..., None]


def _closed_form(rgb: Array, mask: Mask, band: Mask, width: int) -> Array:
    """Alpha that is 0 or 1 outside the band, which is ``width`` pixels wide.

    In each 3 x 3 window it is nearly a linear function of the colours: equations (12) and (13) of
    the paper.
    """
    alpha = mask.astype(np.float32)
    if min(mask.shape) < 3 or not band.any():
        return alpha
    near = grown(band, 3)
    used = grown(near, 3)
    number = np.full(mask.shape, -1, np.intp)
    number[used] = np.arange(np.count_nonzero(used))
    windows = near[1:-1, 1:-1]
    index = sliding_window_view(number, (3, 3))[windows].reshape(-1, 9)
    colours = np.moveaxis(sliding_window_view(rgb, (3, 3), axis=(0, 1))[windows], 1, -1)
    colours = colours.reshape(len(index), 9, 3).astype(np.float64)
    away = colours - colours.mean(axis=1, keepdims=True)
    spread = away.transpose(0, 2, 1) @ away / 9 + _SMOOTHNESS / 9 * np.eye(3)
    local = (1 + away @ np.linalg.solve(spread, away.transpose(0, 2, 1))) / 9
    n = np.count_nonzero(used)
    rows, columns = np.repeat(index, 9, axis=1).ravel(), np.tile(index, (1, 9)).ravel()
    entries = (np.eye(9) - local).ravel()
    laplacian = scipy.sparse.coo_array((entries, (rows, columns)), (n, n)).tocsr()
    free, known = band[used], mask[used].astype(np.float64)
    ramp = uniform_filter(alpha, width, mode="nearest")[band]
    inner = laplacian[free]
    matrix, right = inner[:, free], -(inner[:, ~free] @ known[~free])
    matrix = (matrix + _TRUST * scipy.sparse.eye_array(len(right))).tocsc()
    solved: Any = scipy.sparse.linalg.spsolve(matrix, right + _TRUST * ramp)
    alpha[band] = solved.clip(0, 1)
    return alpha


def _linear(rgb: Array, alpha: Array) -> tuple[Array, Array]:
    """Slopes (h, w, 3) and levels (h, w) of alpha as a local linear function of the colours."""

    def mean(values: Array) -> Array:
        return np.asarray(uniform_filter(values, 3, mode="nearest"))

    centre = np.stack([mean(rgb[..., c]) for c in range(3)], axis=-1)
    middle = mean(alpha)
    spread = np.empty((*alpha.shape, 3, 3), np.float32)
    along = np.empty((*alpha.shape, 3), np.float32)
    for i in range(3):
        along[..., i] = mean(rgb[..., i] * alpha) - centre[..., i] * middle
        for j in range(i + 1):
            pair = mean(rgb[..., i] * rgb[..., j]) - centre[..., i] * centre[..., j]
            spread[..., i, j] = spread[..., j, i] = pair
    spread += np.float32(1e-4) * np.eye(3, dtype=np.float32)
    slope = np.linalg.solve(spread, along[..., None])[..., 0]
    level = middle - np.sum(slope * centre, axis=-1)
    smooth = np.stack([mean(slope[..., c]) for c in range(3)], axis=-1)
    return smooth, mean(level)


def _enlarged(values: Array, at: Any, shape: tuple[int, ...]) -> Array:
    """Values (h, w, c) of a scaled picture at pixels ``at`` of one of the shape (H, W)."""
    parts = []
    for k, (place, whole) in enumerate(zip(at, shape, strict=True)):
        length = values.shape[k]
        t = ((place + 0.5) * (length / whole) - 0.5).clip(0, length - 1)
        low = np.minimum(t.astype(np.intp), max(length - 2, 0))
        parts.append((low, np.minimum(low + 1, length - 1), (t - low).astype(np.float32)))
    (y0, y1, v), (x0, x1, u) = parts
    result = np.zeros((len(v), values.shape[2]), np.float32)
    for y, wy in ((y0, 1 - v), (y1, v)):
        for x, wx in ((x0, 1 - u), (x1, u)):
            result += values[y, x] * (wy * wx)[:, None]
    return result
