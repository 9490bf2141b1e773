"""Extend the colours of a picture into its transparent parts.

A viewer that interpolates a texture with straight alpha mixes the colours of transparent texels
into the rim of the shape. For example, white transparent texels make a white fringe. So in exported
textures, transparent texels get the colours of the nearest visible part.
"""

import numpy as np
from numpy.typing import NDArray

_RINGS = 4  # rings of texels around the visible ones that get the exact mean of their neighbours
_AROUND = [(0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1)]


def bled(rgba: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Extend the visible colours of an (h, w, 4) picture with straight alpha.

    Alpha stays the same, and so do the colours of all pixels with alpha above 0. Transparent pixels
    near these get the mean of their neighbours. Farther away they get the mean of larger and larger
    blocks, so that mipmaps also have the right colours.
    """
    seen = rgba[..., 3] > 0
    if seen.all() or not seen.any():
        return rgba
    result = rgba.copy()
    known = _grown(result, seen)
    if not known.all():
        result[..., :3][~known] = _spread(result[..., :3], known)[~known]
    return result


def _grown(rgba: NDArray[np.uint8], seen: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Give colours to the texels around the seen ones, in place. Returns which have one then."""
    height, width = seen.shape
    known = np.pad(seen, 1)
    for _ in range(_RINGS):
        near = np.zeros_like(seen)
        for y, x in _AROUND:
            near |= known[1 + y : 1 + y + height, 1 + x : 1 + x + width]
        row, column = np.nonzero(near & ~known[1:-1, 1:-1])
        if not len(row):
            break
        total, count = np.zeros((len(row), 3), np.int32), np.zeros((len(row), 1), np.int32)
        for y, x in _AROUND:
            there = known[row + 1 + y, column + 1 + x]
            total[there] += rgba[row[there] + y, column[there] + x, :3]
            count += there[:, None]
        rgba[row, column, :3] = (total + count // 2) // count
        known[row + 1, column + 1] = True
    return known[1:-1, 1:-1]


def _spread(colours: NDArray[np.uint8], known: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """Fill unknown colours with the mean of the smallest block around that has known ones."""
    height, width = known.shape
    if known.all() or max(height, width) == 1:
        return colours
    rest = ((0, height % 2), (0, width % 2))
    weight = np.pad(known, rest)
    padded = np.pad(colours, (*rest, (0, 0)))
    total = np.zeros((weight.shape[0] // 2, weight.shape[1] // 2, 3), np.uint16)
    count = np.zeros(total.shape[:2], np.uint16)
    for y, x in np.ndindex(2, 2):
        part = weight[y::2, x::2]
        total += padded[y::2, x::2] * part[..., None].astype(np.uint8)
        count += part
    half = (total // np.maximum(count, 1)[..., None]).astype(np.uint8)
    larger = _spread(half, count > 0).repeat(2, axis=0).repeat(2, axis=1)[:height, :width]
    return np.where(known[..., None], colours, larger)
