"""Tell the foreground of a picture from its background: choose a method and run it."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from glid_nb._arrays import read_only
from glid_nb.imaging import measure
from glid_nb.imaging.frame import PixelFrame, TraceError
from glid_nb.imaging.measure import RGBA, full
from glid_nb.imaging.options import Color, ForegroundMethod, Point, Scribbles
from glid_nb.imaging.scribbles import scaled_picture, scribble_score

_LEAST_SHARE = 0.001  # of transparent or opaque pixels; fewer are a speck
_SMOOTHING = 0.001  # of the longer side
_LEAST_SMOOTHING = 0.5  # pixels; less is not worth the time

# What a method measures where its name does not tell; the first word is the editor's control.
_MEASURES = {"threshold": "brightness", "color": "colour distance"}


@dataclass(frozen=True, eq=False)
class Foreground:
    """A field, high in the foreground; its level sets are the outlines, to parts of a pixel."""

    score: NDArray[np.float32]  # (h, w) read-only, in [0, 1], sampled at the pixels' centres
    method: str  # never "auto"
    automatic_threshold: float  # as in `TraceOptions.threshold`
    inverted: bool  # score is 1 minus what the method measures
    notes: tuple[str, ...]

    def threshold(self, threshold: float | None = None) -> float:
        """`threshold`, or by default the automatic one."""
        return self.automatic_threshold if threshold is None else threshold

    def level(self, threshold: float | None = None) -> float:
        """The score above which a pixel is foreground."""
        value = self.threshold(threshold)
        return 1 - value if self.inverted else value

    def mask(self, threshold: float | None = None) -> NDArray[np.bool_]:
        """(h, w) mask of the foreground; a TraceError if it would be empty or full."""
        mask = self.score > self.level(threshold)
        if mask.any() and not mask.all():
            return mask
        empty, measured = not mask.any(), _MEASURES.get(self.method, self.method)
        problem = "the image has no foreground"
        problem = problem if empty else "the foreground covers the whole image"
        change = "raise" if empty == self.inverted else "lower"
        remedy = f"{change} the threshold, or paint over the shape with Scribbles"
        if self.method == "scribbles":
            remedy = "paint over more of the shape, and over the background around it"
        at = f"by {measured} at the threshold {self.threshold(threshold):.3g}"
        raise TraceError(f"{problem} {at}; {remedy}")


def find_foreground(
    image: RGBA,
    method: ForegroundMethod = "auto",
    invert: bool | None = None,
    background: Color | None = None,
    background_at: Point | None = None,
    scribbles: Scribbles | None = None,
    scaled: Callable[[RGBA], NDArray[np.float64]] = scaled_picture,
) -> Foreground:
    """The foreground of an (h, w, 4) image by options of `TraceOptions`, without smoothing."""
    _check_not_uniform(image)
    notes: list[str] = []
    if method == "auto":
        method, why = _choose_method(image, background, background_at, scribbles)
        notes.append(f"foreground by {why}")
    inverted, threshold, spread = bool(invert), 0.5, 0.0
    alpha = image[..., 3] * np.float32(1 / full(image))
    if method == "alpha":
        _check_alpha(alpha)
        score = alpha
    elif method == "scribbles":
        if scribbles is None:
            raise TraceError("the method 'scribbles' needs scribbles")
        score, more = scribble_score(scaled(image), scribbles, (image.shape[0], image.shape[1]))
        notes += more
    elif method == "threshold":
        score = measure.brightness(image)
        seen = score if alpha.all() else score[alpha > 0][np.newaxis]
        threshold = measure.otsu(measure.histogram(seen))
        if invert is None:
            inverted = measure.border_is_bright(image, score, threshold)
            side = "darker" if inverted else "brighter"
            notes.append(f"everything {side} than the border counts as foreground")
    else:
        color, spread, more = _background(image, background, background_at)
        score = measure.color_distance(image, color)
        notes += more
    if inverted:
        score = 1 - score
    if method in ("threshold", "color") and alpha.min() < 1:
        score = score * alpha  # transparent pixels are background in any case
    if method == "color" and not inverted:
        threshold = measure.color_threshold(score, spread)
    elif method == "color":  # the shape's; the spread of the border's colours is irrelevant
        threshold = measure.otsu(measure.histogram(1 - score))
    return Foreground(read_only(score.view()), method, threshold, inverted, tuple(notes))


def smoothed(foreground: Foreground, sigma: float | None) -> Foreground:
    """The field after a Gaussian filter of `TraceOptions.smoothing`."""
    score, automatic = foreground.score, sigma is None
    if sigma is None:
        own = 0.0 if foreground.method in ("alpha", "scribbles") else _SMOOTHING * max(score.shape)
        sigma = own if own >= _LEAST_SMOOTHING else 0.0
    if sigma == 0:
        return foreground
    score = np.asarray(gaussian_filter(score, sigma, mode="nearest", truncate=3.0), np.float32)
    if automatic and not (score > foreground.level()).any():
        return foreground  # of a thin shape nothing would be left
    return replace(foreground, score=read_only(score))


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
        what = f"the foreground covers the whole image: its alpha channel is {low:.3g} everywhere"
        raise TraceError(f"{what}; choose Colour or Brightness, or scribble over the shape")


def _choose_method(
    image: RGBA, background: Color | None, background_at: Point | None, scribbles: Scribbles | None
) -> tuple[ForegroundMethod, str]:
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
    image: RGBA, background: Color | None, background_at: Point | None
) -> tuple[Color, float, tuple[str, ...]]:
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
        what = "the border of the image is transparent, so it shows no background colour"
        raise TraceError(f"{what}; choose Alpha, or pick the background's colour")
    red, green, blue = (f"{c:.0%}" for c in border.color)
    note = f"background colour estimated from the border: red {red}, green {green}, blue {blue}"
    if not border.is_uniform:
        note += f", though only {border.share:.0%} of the border has it"
    return border.color, border.spread, (note,)
