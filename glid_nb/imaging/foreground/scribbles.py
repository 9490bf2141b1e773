"""Foreground by a user's scribbles: the random walker of Grady (2006)."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from skimage.draw import line as draw_line
from skimage.segmentation import random_walker

from glid_nb.imaging.errors import TraceError
from glid_nb.imaging.options import Scribbles
from glid_nb.imaging.read import as_rgba8

_PIXELS = 40_000  # solved directly in a third of a second; the outline is smooth in between
# How much an edge in the picture hinders the walker. scikit-image's default of 130 is for noisy
# pictures; with it the outline of a photograph runs midway between the strokes, off the edges.
_BETA = 1000.0
_FOREGROUND, _BACKGROUND = 1, 2


def scribble_score(
    image: NDArray[np.unsignedinteger], scribbles: Scribbles
) -> tuple[NDArray[np.float32], tuple[str, ...]]:
    """(h, w) probability that a random walker from the pixel meets the foreground strokes first.

    Computed on a picture scaled down to 40,000 pixels and interpolated. Also notes.
    """
    height, width = image.shape[:2]
    scale = min(1.0, np.sqrt(_PIXELS / (height * width)))
    size = max(1, round(width * scale)), max(1, round(height * scale))
    small = Image.fromarray(as_rgba8(image))
    if scale < 1:
        small = small.resize(size, Image.Resampling.BOX)
    labels, notes = _labels(scribbles, (height, width), (size[1], size[0]))
    if (labels > 0).all():
        probability = (labels == _FOREGROUND).astype(np.float64)
    else:
        data = np.asarray(small, dtype=np.float64) / 255
        data[..., :3] *= data[..., 3:]
        if data[..., 3].min() == data[..., 3].max():  # it would only weaken the colours' weight
            data = data[..., :3]
        probability = random_walker(
            data, labels, beta=_BETA, mode="bf", channel_axis=-1, return_full_prob=True
        )[0]
    field = np.clip(probability, 0, 1).astype(np.float32)
    if scale < 1:
        large = Image.fromarray(field).resize((width, height), Image.Resampling.BILINEAR)
        field = np.asarray(large)
    return field, notes


def _labels(
    scribbles: Scribbles, shape: tuple[int, int], small: tuple[int, int]
) -> tuple[NDArray[np.int32], tuple[str, ...]]:
    foreground = _drawn(scribbles.foreground, shape, small, "foreground")
    background = _drawn(scribbles.background, shape, small, "background")
    if not foreground.any():
        raise TraceError("scribbles: there are no foreground strokes; draw some over the shape")
    notes: tuple[str, ...] = ()
    if not background.any():
        background[[0, -1], :] = background[:, [0, -1]] = True
        background &= ~foreground
        notes = ("no background was scribbled: the picture's border was taken for it",)
        if not background.any():
            raise TraceError(
                "scribbles: the foreground strokes cover the whole border; draw background strokes"
            )
    elif (foreground & background).any():
        notes = ("foreground and background strokes overlap: they count for nothing there",)
    labels = np.zeros(small, dtype=np.int32)
    labels[foreground & ~background] = _FOREGROUND
    labels[background & ~foreground] = _BACKGROUND
    for label, name in ((_FOREGROUND, "foreground"), (_BACKGROUND, "background")):
        if not (labels == label).any():
            raise TraceError(
                f"scribbles: all {name} strokes are covered by the other ones; erase some of these"
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
