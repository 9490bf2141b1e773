"""Choosing a method and running it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from glid_nb.imaging.errors import TraceError
from glid_nb.imaging.foreground.alpha import alpha_score, check_alpha, is_informative, is_opaque
from glid_nb.imaging.foreground.border import border_color
from glid_nb.imaging.foreground.brightness import border_is_bright, brightness, brightness_score
from glid_nb.imaging.foreground.color import color_score, color_threshold
from glid_nb.imaging.foreground.levels import histogram, otsu
from glid_nb.imaging.foreground.score import Foreground
from glid_nb.imaging.foreground.walker import Walker
from glid_nb.imaging.frame import PixelFrame
from glid_nb.imaging.options import Method, Point, Scribbles

_SMOOTHING = 0.001  # of the longer side
_LEAST_SMOOTHING = 0.5  # less is not worth the time


def find_foreground(
    image: NDArray[np.unsignedinteger],
    method: Method = "auto",
    *,
    invert: bool | None = None,
    background: tuple[float, float, float] | None = None,
    background_at: Point | None = None,
    scribbles: Scribbles | None = None,
    walker: Walker | None = None,
) -> Foreground:
    """Rate every pixel of an (h, w, 4) RGBA image; the parameters are those of `TraceOptions`.

    The field is not smoothed yet: see `smoothed`. ``walker``, the image's, saves making it anew
    for every scribble.

    Raises
    ------
    TraceError
        The image has one colour only, or nothing that the method could use.
    """
    _check_not_uniform(image)
    notes: list[str] = []
    if method == "auto":
        method, why = _choose_method(image, background, background_at, scribbles)
        notes.append(f"foreground by {why}")
    inverted = bool(invert)
    if method == "alpha":
        check_alpha(image)
        score, threshold = alpha_score(image), 0.5
        if inverted:
            score = 1 - score
    elif method == "scribbles":
        if scribbles is None:
            raise TraceError("the method 'scribbles' needs scribbles")
        # Nobody waits for what it imports before there are scribbles.
        from glid_nb.imaging.foreground.scribbles import scribble_score  # noqa: PLC0415

        walker = walker if walker is not None else Walker.of(image)
        score, more = scribble_score(walker, scribbles, (image.shape[0], image.shape[1]))
        threshold = 0.5
        notes += more
        if inverted:
            score = 1 - score
    elif method == "threshold":
        values = brightness(image)
        visible = values if is_opaque(image) else values[image[..., 3] > 0][np.newaxis]
        threshold = otsu(histogram(visible))
        if invert is None:
            inverted = border_is_bright(image, values, threshold)
            side = "darker" if inverted else "brighter"
            notes.append(f"what is {side} than the border counts as foreground")
        score = brightness_score(image, values, inverted)
    else:
        color, spread, more = _background(image, background, background_at)
        notes += more
        score = color_score(image, color, inverted)
        if inverted:  # the colour is the shape's own, and tells nothing of the background's
            threshold = otsu(histogram(1 - score))
        else:
            threshold = color_threshold(score, spread)
    score = score.view()
    score.setflags(write=False)
    return Foreground(score, method, threshold, inverted, tuple(notes))


def smoothed(foreground: Foreground, sigma: float | None) -> Foreground:
    """The field after a Gaussian filter of standard deviation ``sigma`` in pixels, 0 for none.

    By default a thousandth of the longer side, and none for fields that are smooth as they are.
    """
    score = foreground.score
    if sigma is None:
        own = 0.0 if foreground.method in ("alpha", "scribbles") else _SMOOTHING * max(score.shape)
        sigma = own if own >= _LEAST_SMOOTHING else 0.0
    if sigma == 0:
        return foreground
    score = np.asarray(gaussian_filter(score, sigma, mode="nearest", truncate=3.0), np.float32)
    score.setflags(write=False)
    return replace(foreground, score=score)


def _check_not_uniform(image: NDArray[np.unsignedinteger]) -> None:
    first = image[0, 0]
    # A coarse sample decides for nearly every picture.
    if (image[::37, ::37] != first).any() or (image != first).any():
        return
    scale = 255 / np.iinfo(image.dtype).max
    red, green, blue, alpha = (f"{value * scale:.4g}" for value in first)
    raise TraceError(
        f"the image has one colour only: red {red}, green {green}, blue {blue}, alpha {alpha} (of "
        "255) everywhere; there is nothing to trace"
    )


def _choose_method(
    image: NDArray[np.unsignedinteger],
    background: tuple[float, float, float] | None,
    background_at: Point | None,
    scribbles: Scribbles | None,
) -> tuple[Method, str]:
    """A method and the reason in words."""
    if scribbles is not None:
        return "scribbles", "scribbles, which were given"
    if background is not None or background_at is not None:
        return "color", "colour distance, for a background colour was given"
    if is_informative(image):
        return "alpha", "alpha, for part of the image is transparent"
    border = border_color(image)
    if border is not None and border.is_uniform:
        return "color", f"colour distance, for {border.share:.0%} of the border has one colour"
    return "threshold", (
        "brightness, for the border has no single colour: a guess; if it is wrong, choose another "
        "method, mark the background's colour, or scribble on foreground and background"
    )


def _background(
    image: NDArray[np.unsignedinteger],
    background: tuple[float, float, float] | None,
    background_at: Point | None,
) -> tuple[tuple[float, float, float], float, list[str]]:
    """The background's colour, the spread of the border's colours about it, and notes."""
    border = border_color(image)
    if background is None and background_at is None:
        if border is None:
            raise TraceError(
                "the border of the image is transparent, so it shows no background colour; use "
                "method='alpha', or give background or background_at",
                "The picture's border is transparent, so it shows no background colour; choose "
                "Alpha, or pick the background's colour",
            )
        note = f"background colour estimated from the border: {_percent(border.color)}"
        if not border.is_uniform:
            note += f", though only {border.share:.0%} of the border has it"
        return border.color, border.spread, [note]
    if background is None:
        assert background_at is not None
        frame = PixelFrame(width=image.shape[1], height=image.shape[0])
        row, column = frame.index_at(background_at, "background_at")
        red, green, blue = image[row, column, :3] / np.iinfo(image.dtype).max
        background = float(red), float(green), float(blue)
    return background, 0.03, []


def _percent(color: tuple[float, float, float]) -> str:
    red, green, blue = (f"{c:.0%}" for c in color)
    return f"red {red}, green {green}, blue {blue}"
