"""Moving edges outwards where simplification would cut off a part of the shape."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from glid_nb.geometry._loops import signed_area
from glid_nb.imaging.simplify.conflicts import edges_in_conflict
from glid_nb.imaging.simplify.significance import Loop, dropped_between


def enclosing(
    loops: tuple[Loop, ...], kept: list[NDArray[np.bool_]], margin: float, gap: float
) -> list[Loop]:
    """The simplified loops, with edges moved outwards that cut off more than `margin`.

    A chord of a convex arc cuts off a part of the shape. The edge is moved in parallel by that
    much; where this would make loops meet, it stays.
    """
    simplified = [loop[keep] for loop, keep in zip(loops, kept, strict=True)]
    shifts = []
    for number, (loop, keep) in enumerate(zip(loops, kept, strict=True)):
        outwards = 1.0 if (signed_area(simplified[number]) > 0) == (number == 0) else -1.0
        shifts.append(_shifts(loop, np.flatnonzero(keep), outwards, margin))
    while True:
        moved = [loop + shift for loop, shift in zip(simplified, shifts, strict=True)]
        changed = False
        for number, (before, after) in enumerate(zip(simplified, moved, strict=True)):
            # A hole may neither vanish nor turn inside out.
            low, high = (0.3, 1.2) if number > 0 else (0.5, np.inf)
            ratio = signed_area(after) / signed_area(before)
            if not low < ratio < high and shifts[number].any():
                shifts[number][:] = 0
                changed = True
        for number, edge in [] if changed else edges_in_conflict(moved, gap):
            ends = [edge, (edge + 1) % len(moved[number])]
            if shifts[number][ends].any():
                shifts[number][ends] = 0
                changed = True
        if not changed:
            return moved


def _shifts(
    loop: Loop, index: NDArray[np.intp], outwards: float, margin: float
) -> NDArray[np.float64]:
    """(k, 2) how to move the vertices `index` so that no edge cuts off more than `margin`."""
    corners = loop[index]
    edge = np.roll(corners, -1, axis=0) - corners
    normal = outwards * np.stack([edge[:, 1], -edge[:, 0]], axis=1)
    normal /= np.hypot(*edge.T)[:, np.newaxis]
    cut = np.zeros(len(index))
    for k in range(len(index)):
        between = dropped_between(index, k, len(loop))
        if len(between):
            cut[k] = max(0.0, float(((loop[between] - corners[k]) @ normal[k]).max()) - margin)
    before, cut_before = np.roll(normal, 1, axis=0), np.roll(cut, 1)
    # A vertex moves to where the two moved edges meet, but not farther than twice their moves.
    middle = before + normal
    square = np.maximum(np.sum(middle**2, axis=1), 1e-12)
    sine = before[:, 0] * normal[:, 1] - before[:, 1] * normal[:, 0]
    flat = np.abs(sine) < 0.2
    sine = np.where(flat, 1.0, sine)
    meet = np.stack(
        [
            (cut_before * normal[:, 1] - cut * before[:, 1]) / sine,
            (cut * before[:, 0] - cut_before * normal[:, 0]) / sine,
        ],
        axis=1,
    )
    most = np.maximum(cut, cut_before)
    straight = middle * (2 * most / square)[:, np.newaxis]
    shift = np.where(flat[:, np.newaxis], straight, meet)
    length = np.hypot(*shift.T)
    return shift * np.minimum(1.0, 2 * most / np.maximum(length, 1e-12))[:, np.newaxis]
