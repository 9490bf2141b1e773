"""More vertices for an offset cage than the cage has, where its edges are long.

Along an edge of the offset cage a map's boundary values are linear. Where a shape is much longer
than wide between two vertices, as a bar of four is, that is too stiff to bend.
"""

from __future__ import annotations

import numpy as np

from glid_nb._arrays import Array
from glid_nb.geometry.cage import Cage

# Edges are divided that are longer than so many widths, and than this share of the cage's longer
# side or than so many times the greatest width. Traced cages follow their limbs with shorter ones.
_LONG, _LONG_SHARE, _VERY_LONG = 3.0, 0.3, 10.0
# The pieces' length in widths, and their least length as a share of the cage's longer side.
_PIECE, _LEAST_PIECE = 0.5, 0.02
# At so many points of an edge the width is taken.
_SAMPLES = 32


def divided(offset_cage: Cage, cage: Cage) -> Cage:
    """The offset cage, which has a vertex for each of the cage, with more on the long edges.

    Pieces are about half as long as the shape is wide there, and no shorter than 1/50 of its longer
    side.
    """
    least = _LEAST_PIECE * cage.longer_side
    start, end = (
        np.concatenate([np.roll(loop, shift) for loop in cage.loops_complex]) for shift in (0, -1)
    )
    length = np.abs(end - start)
    shares = [np.zeros(1)] * len(start)
    for i in np.flatnonzero(length > 2 * least):
        widths = _widths(start[i], end[i], start, end)
        long = length[i] > max(_LONG * np.median(widths), _LONG_SHARE * cage.longer_side)
        if not (long or length[i] > _VERY_LONG * widths.max()):
            continue
        wanted = np.cumsum(1 / np.maximum(_PIECE * widths, least)) * length[i] / _SAMPLES
        pieces = np.arange(np.ceil(wanted[-1])) * (wanted[-1] / np.ceil(wanted[-1]))
        shares[i] = np.interp(pieces, [0, *wanted], np.arange(_SAMPLES + 1) / _SAMPLES)
    if all(len(share) == 1 for share in shares):
        return offset_cage
    loops, first = [], 0
    for loop in offset_cage.loops:
        along = np.roll(loop, -1, axis=0) - loop
        own = shares[first : first + len(loop)]
        pieces = zip(loop, along, own, strict=True)
        loops.append(np.concatenate([a + share[:, None] * b for a, b, share in pieces]))
        first += len(loop)
    return Cage(loops[0], loops[1:])


def _widths(a: complex, b: complex, start: Array, end: Array) -> Array:
    """(k,) distances from points of the edge ``a b`` straight across the domain to an edge."""
    inward = 1j * (b - a) / abs(b - a)
    points = a + (b - a) * (np.arange(_SAMPLES)[:, None] + 0.5) / _SAMPLES
    # In the frame in which the edge lies on the real axis and the domain above it.
    p, q = ((z - points) / inward * 1j for z in (start, end))
    rise = np.where(p.real == q.real, 1, q.real - p.real)
    height = p.imag - p.real * (q.imag - p.imag) / rise
    meets = (p.real * q.real <= 0) & (p.real != q.real) & (height > 1e-9 * abs(b - a))
    return np.where(meets, height, np.inf).min(axis=1)
