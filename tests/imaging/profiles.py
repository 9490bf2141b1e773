"""ICC profiles, written by hand: matrices with curves, grey curves, a small table for CMYK."""

from __future__ import annotations

import itertools
import struct
from collections.abc import Sequence

import numpy as np

D50 = (0.9642, 1.0, 0.8249)
# Display P3 (Apple) and Adobe RGB (1998), adapted to D50, red, green and blue.
DISPLAY_P3 = ((0.5151, 0.2412, -0.0011), (0.2920, 0.6922, 0.0419), (0.1571, 0.0666, 0.7841))
ADOBE_RGB = ((0.6097, 0.3111, 0.0195), (0.2053, 0.6257, 0.0609), (0.1492, 0.0632, 0.7446))
_SRGB_CURVE = (2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045)


def matrix_profile(primaries: Sequence[Sequence[float]], gamma: float | None = None) -> bytes:
    """An RGB profile with sRGB's curve, or a power."""
    curve = _curve(gamma)
    tags = {name: _xyz(xyz) for name, xyz in zip(("rXYZ", "gXYZ", "bXYZ"), primaries, strict=True)}
    return _profile(b"mntr", b"RGB ", {**tags, **dict.fromkeys(("rTRC", "gTRC", "bTRC"), curve)})


def grey_profile(gamma: float | None = None) -> bytes:
    return _profile(b"mntr", b"GRAY", {"kTRC": _curve(gamma)})


def cmyk_profile() -> bytes:
    """Lightness falls with the sum of the inks. Cyan lowers a*, which no naive conversion does."""
    head = struct.pack(">4s4xBBBx9i", b"mft1", 4, 3, 2, *(65536 * np.eye(3).ravel().astype(int)))
    straight, table = bytes(range(256)), b""
    for c, m, y, k in itertools.product((0, 1), repeat=4):
        table += bytes([max(0, 255 - 60 * (c + m + y) - 200 * k), 128 - 30 * c, 128])
    return _profile(b"prtr", b"CMYK", {"A2B0": head + 4 * straight + table + 3 * straight}, b"Lab ")


def _curve(gamma: float | None) -> bytes:
    kind, values = (0, [gamma]) if gamma else (3, _SRGB_CURVE)
    fixed = [round(65536 * value) for value in values]
    return struct.pack(f">4s4xHxx{len(fixed)}i", b"para", kind, *fixed)


def _xyz(values: Sequence[float]) -> bytes:
    return struct.pack(">4s4x3i", b"XYZ ", *(round(65536 * value) for value in values))


def _profile(device: bytes, space: bytes, tags: dict[str, bytes], pcs: bytes = b"XYZ ") -> bytes:
    text = "made for a test".encode("utf-16-be")
    words = struct.pack(">4s4xII2s2sII", b"mluc", 1, 12, b"en", b"US", len(text), 28) + text
    tags = {"desc": words, "cprt": words, "wtpt": _xyz(D50), **tags}
    table, body = b"", b""
    start = 128 + 4 + 12 * len(tags)
    for name, data in tags.items():
        table += struct.pack(">4sII", name.encode(), start + len(body), len(data))
        body += data + bytes(-len(data) % 4)
    white = struct.pack(">3i", *(round(65536 * value) for value in D50))
    head = struct.pack(">I4sI4s4s4s", start + len(body), b"\0" * 4, 0x04200000, device, space, pcs)
    head += bytes(12) + b"acsp" + bytes(28) + white
    return head + bytes(128 - len(head)) + struct.pack(">I", len(tags)) + table + body
