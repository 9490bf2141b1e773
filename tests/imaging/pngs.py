"""PNG files written by hand: any bit depth, colour type and chunks, filters, interlacing."""

from __future__ import annotations

import struct
import zlib

import numpy as np
from numpy.typing import NDArray

GREY, RGB, PALETTE, GREY_ALPHA, RGBA = 0, 2, 3, 4, 6
CHANNELS = {GREY: 1, RGB: 3, PALETTE: 1, GREY_ALPHA: 2, RGBA: 4}
_ADAM7 = ((0, 0, 8, 8), (0, 4, 8, 8), (4, 0, 8, 4), (0, 2, 4, 4), (2, 0, 4, 2), (0, 1, 2, 2))
_PASSES = (*_ADAM7, (1, 0, 2, 1))  # first row, first column, steps


def chunk(kind: bytes, body: bytes) -> bytes:
    checksum = zlib.crc32(kind + body)
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", checksum)


def png_file(
    values: NDArray[np.integer],
    depth: int,
    color_type: int,
    chunks: bytes = b"",
    interlaced: bool = False,
) -> bytes:
    """A PNG of samples (h, w, c) below 2^depth, with ``chunks`` before the pixels."""
    height, width, channels = values.shape
    assert channels == CHANNELS[color_type]
    assert values.max() < 1 << depth
    parts = [values]
    if interlaced:
        parts = [values[y::down, x::across] for y, x, down, across in _PASSES]
    data = b"".join(_rows(part, depth) for part in parts if part.size)
    header = struct.pack(">IIBBBBB", width, height, depth, color_type, 0, 0, interlaced)
    body = chunk(b"IHDR", header) + chunks + chunk(b"IDAT", zlib.compress(data))
    return b"\x89PNG\r\n\x1a\n" + body + chunk(b"IEND", b"")


def _rows(values: NDArray[np.integer], depth: int) -> bytes:
    """Rows under the filters None, Sub and Up in turns."""
    height, _, channels = values.shape
    if depth < 8:
        bits = (values.reshape(height, -1, 1) >> np.arange(depth)[::-1]) & 1
        rows = np.packbits(bits.reshape(height, -1).astype(np.uint8), axis=1)
    else:
        kind = ">u2" if depth == 16 else "u1"
        rows = values.astype(kind).reshape(height, -1).view(np.uint8)
    step, filtered = max(1, depth * channels // 8), b""
    for i, row in enumerate(rows):
        before = np.concatenate([np.zeros(step, np.uint8), row[:-step]])
        above = rows[i - 1] if i else np.zeros_like(row)
        taken = (np.zeros_like(row), before, above)[i % 3]
        filtered += bytes([i % 3]) + (row - taken).tobytes()
    return filtered
