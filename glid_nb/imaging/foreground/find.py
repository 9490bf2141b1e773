"""Find the foreground: choose a method and run it."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from glid_nb._arrays import read_only
from glid_nb.imaging.errors import TraceError
from glid_nb.imaging.foreground import measure
from glid_nb.imaging.foreground.measure import RGBA, full
from glid_nb.imaging.foreground.score import Foreground
from glid_nb.imaging.foreground.scribbles import scaled_picture, scribble_score
from glid_nb.imaging.frame import PixelFrame
from glid_nb.imaging.options import Method, Point, Scribbles

_LEAST_SHARE = 0.001  # of transparent or opaque pixels; fewer are a speck


def find_foreground(
    image: RGBA,
    method: Method = "auto",
    invert: bool | None = None,
    background: tuple[float, float, float] | None = None,
    background_at: Point | None = None,
    scribbles: Scribbles | None = None,
    scaled: Callable[[], NDArray[np.float64]] | None = None,
) -> Foreground:
    """Score the pixels of an (h, w, 4) RGBA image, without smoothing.

    The parameters are those of `TraceOptions`; ``scaled`` returns the image's `scaled_picture`, so
    that callers can keep it between scribbles. Raises a TraceError when the image has one colour
    only, or nothing that the method could use.
    """
    _check_not_uniform(image)
    notes: tuple[str, ...] = ()
    more: tuple[str, ...] = ()
    if method == "auto":
        method, why = _choose_method(image, background, background_at, scribbles)
        notes = (f"foreground by {why}",)
    inverted, threshold, spread = bool(invert), 0.5, 0.0
    alpha = image[..., 3] * np.float32(1 / full(image))
    if method == "alpha":
        _check_alpha(alpha)
        score = alpha
    elif method == "scribbles":
        if scribbles is None:
            raise TraceError("the method 'scribbles' needs scribbles")
        small = scaled_picture(image) if scaled is None else scaled()
        score, more = scribble_score(small, scribbles, (image.shape[0], image.shape[1]))
    elif method == "threshold":
        score = measure.brightness(image)
        seen = score if alpha.all() else score[alpha > 0][np.newaxis]
        threshold = measure.otsu(measure.histogram(seen))
        if invert is None:
            inverted = measure.border_is_bright(image, score, threshold)
            side = "darker" if inverted else "brighter"
            more = (f"everything {side} than the border counts as foreground",)
    else:
        color, spread, more = _background(image, background, background_at)
        score = measure.color_distance(image, color)
    if inverted:
        score = 1 - score
    if method in ("threshold", "color") and alpha.min() < 1:
        score = score * alpha  # transparent pixels are background in any case
    if method == "color":
        # Inverted, the colour is the shape's, so the spread of the border's colours is irrelevant.
        threshold = measure.otsu(measure.histogram(1 - score)) if inverted else None
        threshold = measure.color_threshold(score, spread) if threshold is None else threshold
    return Foreground(read_only(score.view()), method, threshold, inverted, (*notes, *more))


def _check_not_uniform(image: RGBA) -> None:
    first = image[0, 0]
    # A coarse sample suffices for nearly every picture.
    if (image[::37, ::37] != first).any() or (image != first).any():
        return
    red, green, blue, opacity = (f"{value * (255 / full(image)):.4g}" for value in first)
    color = f"red {red}, green {green}, blue {blue}, alpha {opacity} (of 255) everywhere"
    raise TraceError(f"the image has one colour only: {color}; there is nothing to trace")


def _check_alpha(alpha: NDArray[np.float32]) -> None:
    low, high = alpha.min(), alpha.max()
    if low == high == 0:
        raise TraceError("the image has no foreground: it is fully transparent")
    if low == high:
        raise TraceError(
            f"the foreground covers the whole image: its alpha channel is {low:.3g} everywhere; "
            "use method='color', 'threshold' or 'scribbles'",
            "The picture is equally transparent everywhere; choose Colour or Brightness, or paint "
            "over the shape with Scribbles",
        )


def _choose_method(
    image: RGBA,
    background: tuple[float, float, float] | None,
    background_at: Point | None,
    scribbles: Scribbles | None,
) -> tuple[Method, str]:
    """A method and the reason for it, as a note."""
    if scribbles is not None:
        return "scribbles", "scribbles, which were given"
    if background is not None or background_at is not None:
        return "color", "colour distance, as a background colour was given"
    if _LEAST_SHARE < np.mean(image[..., 3] < full(image) / 2) < 1 - _LEAST_SHARE:
        return "alpha", "alpha, as part of the image is transparent"
    border = measure.border_color(image)
    if border is not None and border.is_uniform:
        return "color", f"colour distance, as {border.share:.0%} of the border has one colour"
    return "threshold", (
        "brightness, as the border has no single colour; if this guess is wrong, choose another "
        "method, mark the background's colour, or scribble on foreground and background"
    )


def _background(
    image: RGBA, background: tuple[float, float, float] | None, background_at: Point | None
) -> tuple[tuple[float, float, float], float, tuple[str, ...]]:
    """The background's colour, the spread of the border's colours about it, and notes."""
    if background is not None:
        return background, 0.03, ()
    if background_at is not None:
        frame = PixelFrame(width=image.shape[1], height=image.shape[0])
        pixel = image[frame.index_at(background_at, "background_at")]
        red, green, blue = map(float, pixel[:3] / full(image))
        return (red, green, blue), 0.03, ()
    border = measure.border_color(image)
    if border is None:
        raise TraceError(
            "the border of the image is transparent, so it shows no background colour; use "
            "method='alpha', or give background or background_at",
            "The picture's border is transparent, so it shows no background colour; choose "
            "Alpha, or pick the background's colour",
        )
    red, green, blue = (f"{c:.0%}" for c in border.color)
    note = f"background colour estimated from the border: red {red}, green {green}, blue {blue}"
    if not border.is_uniform:
        note += f", though only {border.share:.0%} of the border has it"
    return border.color, border.spread, (note,)
