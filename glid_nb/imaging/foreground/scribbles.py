"""Foreground by a user's scribbles: a random walker's, which ends on them."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from skimage.draw import line as draw_line

from glid_nb.imaging.errors import TraceError
from glid_nb.imaging.foreground.walker import BACKGROUND, FOREGROUND, Walker
from glid_nb.imaging.options import Scribbles


def scribble_score(
    walker: Walker, scribbles: Scribbles, shape: tuple[int, int]
) -> tuple[NDArray[np.float32], tuple[str, ...]]:
    """(h, w) probability that a random walker from the pixel meets the foreground strokes first.

    Computed on the walker's picture and interpolated to ``shape``, that of the picture. Also notes.
    """
    labels, notes = _labels(scribbles, shape, walker.shape)
    field = walker.probability(labels).astype(np.float32)
    if shape != walker.shape:
        field = enlarged(field, shape)
    return field, notes


def enlarged(field: NDArray[np.float32], shape: tuple[int, int]) -> NDArray[np.float32]:
    """A field on a finer grid over the same picture, interpolated linearly; constant at its rim.

    In less than half of Pillow's time, from which an array is only had by copies.
    """
    for axis in range(2):
        if field.shape[axis] == 1:
            field = field.repeat(2, axis)
    left, share = _between(shape[1], field.shape[1])
    wide = field[:, left] + share * (field[:, left + 1] - field[:, left])
    above, share = _between(shape[0], field.shape[0])
    change = np.diff(wide, axis=0)
    result = np.empty(shape, dtype=np.float32)
    starts = np.searchsorted(above, np.arange(field.shape[0]))  # the rows between two of the field
    for k, (start, end) in enumerate(pairwise(starts)):
        np.multiply(share[start:end, None], change[k], out=result[start:end])
        result[start:end] += wide[k]
    return result


def _between(fine: int, coarse: int) -> tuple[NDArray[np.intp], NDArray[np.float32]]:
    """For each fine cell's centre the coarse one's before it, and how far it is on to the next."""
    places = np.clip((np.arange(fine) + 0.5) * (coarse / fine) - 0.5, 0, coarse - 1)
    before = np.minimum(places.astype(np.intp), coarse - 2)
    return before, (places - before).astype(np.float32)


def _labels(
    scribbles: Scribbles, shape: tuple[int, int], small: tuple[int, int]
) -> tuple[NDArray[np.int32], tuple[str, ...]]:
    foreground = _drawn(scribbles.foreground, shape, small, "foreground")
    background = _drawn(scribbles.background, shape, small, "background")
    if not foreground.any():
        raise TraceError(
            "scribbles: there are no foreground strokes; draw some over the shape",
            "Nothing is painted over the shape yet; press Shape and paint over it",
        )
    notes: tuple[str, ...] = ()
    if not background.any():
        background[[0, -1], :] = background[:, [0, -1]] = True
        background &= ~foreground
        notes = ("no background was scribbled: the picture's border was taken for it",)
        if not background.any():
            raise TraceError(
                "scribbles: the foreground strokes cover the whole border; draw background strokes",
                "What is painted over the shape covers the whole border; press Background and "
                "paint over that",
            )
    elif (foreground & background).any():
        notes = ("foreground and background strokes overlap: they count for nothing there",)
    labels = np.zeros(small, dtype=np.int32)
    labels[foreground & ~background] = FOREGROUND
    labels[background & ~foreground] = BACKGROUND
    for label, name in ((FOREGROUND, "foreground"), (BACKGROUND, "background")):
        if not (labels == label).any():
            raise TraceError(
                f"scribbles: all {name} strokes are covered by the other ones; erase some of these",
                "One of the colours is painted over the other altogether; undo the last strokes",
            )
    return labels, notes


def _drawn(
    strokes: tuple[NDArray[np.float64], ...] | NDArray[np.bool_],
    shape: tuple[int, int],
    small: tuple[int, int],
    name: str,
) -> NDArray[np.bool_]:
    """The strokes as a mask of the scaled picture."""
    drawn = np.zeros(small, dtype=bool)
    factor = np.array(small) / np.array(shape)
    if isinstance(strokes, np.ndarray):
        if strokes.shape != shape:
            raise TraceError(
                f"scribbles: the {name} mask has the shape {strokes.shape} and the image {shape}; "
                "they must be equal"
            )
        rows, columns = ((np.argwhere(strokes) + 0.5) * factor).astype(np.intp).T
        drawn[rows, columns] = True
        return drawn
    for stroke in strokes:
        # A stroke may leave the picture, but not by so much that drawing it would take forever.
        ends = np.clip(np.floor(stroke[:, ::-1] * factor), -max(small), 2 * max(small))
        ends = ends.astype(np.intp)
        for a, b in pairwise(ends if len(ends) > 1 else np.repeat(ends, 2, axis=0)):
            rows, columns = draw_line(*a, *b)
            inside = (rows >= 0) & (rows < small[0]) & (columns >= 0) & (columns < small[1])
            drawn[rows[inside], columns[inside]] = True
    if strokes and not drawn.any():
        raise TraceError(
            f"scribbles: the {name} strokes lie outside the image of {shape[1]} x {shape[0]} pixels"
        )
    return drawn
