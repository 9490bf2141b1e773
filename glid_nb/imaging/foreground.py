"""Separate the foreground of a picture from its background: choose a method and run it."""

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

_SPECKS = 0.02  # of the visible pixels; a smaller share of opaque ones is not the shape
_LEAST_SHARE = 0.001  # of transparent or opaque pixels; a smaller share is a speck
_SMOOTHING = 0.001  # automatic smoothing, relative to the longer side
_LEAST_SMOOTHING = 0.5  # pixels; less smoothing is not worth the time

# The quantity that a method measures, if its name differs. The first word names the editor's
# control.
_MEASURES = {"threshold": "brightness", "color": "colour distance"}


@dataclass(frozen=True, eq=False)
class Foreground:
    """A field that is high in the foreground. Its level sets are outlines of sub-pixel accuracy."""

    score: NDArray[np.float32]  # (h, w) read-only, in [0, 1], sampled at the pixels' centres
    method: str  # never "auto"
    automatic_threshold: float  # as in `TraceOptions.threshold`
    inverted: bool  # whether score is 1 minus the measured quantity
    notes: tuple[str, ...]
    alpha: tuple[float, float] = (1.0, 1.0)
    """The least and the greatest alpha of the picture, in [0, 1]."""

    def threshold(self, threshold: float | None = None) -> float:
        """The given `threshold`, or the automatic one for None."""
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
        raise self._refusal(self.threshold(threshold), empty=not mask.any())

    def _refusal(self, threshold: float, empty: bool) -> TraceError:
        """An error that gives the measured values and a threshold or method that would work."""
        measured = _MEASURES.get(self.method, self.method)
        problem = "the image has no foreground"
        problem = problem if empty else "the foreground covers the whole image"
        problem += f" by {measured} at the threshold {threshold:.3g}"
        low, high = float(self.score.min()), float(self.score.max())
        if self.inverted:
            low, high = 1 - high, 1 - low
        if self.method == "scribbles":
            remedy = "paint over more of the shape, and over the background around it"
            return TraceError(f"{problem}; {remedy}")
        if (working := self._working_threshold(low, high)) is None:
            problem += f": {measured} is {low:.2%} everywhere"
            if self.method != "alpha" and self.alpha[0] < self.alpha[1]:
                middle = f"{sum(self.alpha) / 2:.3g}"
                varies = f"alpha runs from {self.alpha[0]:.0%} to {self.alpha[1]:.0%}"
                remedy = f"{varies}, so take method='alpha' and threshold={middle}"
                plain = f"{varies}, so choose Alpha and the threshold {middle}"
                return TraceError(f"{problem}, but {remedy}", f"{problem}, but {plain}")
            return TraceError(f"{problem}; choose another method, or paint over the shape")
        above = threshold >= high
        seen = f"{measured} is {high:.2g} at most" if above else f"{measured} is {low:.2g} at least"
        told = f"{measured} is {high:.0%} at most" if above else f"{measured} is {low:.0%} at least"
        if self.method == "alpha" and threshold >= high:
            percent = f"{100 * high:.0f}" if round(high, 2) < threshold else f"{100 * high:.3g}"
            seen = told = f"the picture has alpha up to {percent} %"
        change = "lower" if threshold > working else "raise"
        remedy = f"{change} the threshold, to {working:.9g} for example"
        paint = "or paint over the shape with Scribbles"
        return TraceError(
            f"{problem}: {seen}; {remedy}, {paint}",
            plain=f"{problem}: {told}; {change} the threshold, {paint}",
        )

    def _working_threshold(self, low: float, high: float) -> float | None:
        """A threshold of few digits that gives both foreground and background; None if the measured
        quantity, which runs from ``low`` to ``high``, does not vary."""
        measured = 1 - self.score if self.inverted else self.score
        middle = (low + high) / 2
        for value in (self.automatic_threshold, measure.otsu(measure.histogram(measured)), middle):
            for digits in (2, 3, 9):
                rounded = float(f"{value:.{digits}g}")
                above = self.score > self.level(rounded)
                if above.any() and not above.all():
                    return rounded
        return None


def find_foreground(
    image: RGBA,
    method: ForegroundMethod = "auto",
    invert: bool | None = None,
    background: Color | None = None,
    background_at: Point | None = None,
    scribbles: Scribbles | None = None,
    scaled: Callable[[RGBA], NDArray[np.float64]] = scaled_picture,
) -> Foreground:
    """Find the foreground of an (h, w, 4) image, without smoothing. For the options see
    `TraceOptions`."""
    _check_not_uniform(image)
    if not image[..., 3].any():
        what = "the image has no foreground: it is fully transparent"
        raise TraceError(f"{what}; remove its alpha channel if its colours show the shape")
    notes: list[str] = []
    most = full(image)
    if method == "auto":
        most = _usual_maximum(image[..., 3], most)
        method, why = _choose_method(image, most, background, background_at, scribbles)
        notes.append(f"foreground by {why}")
    inverted, threshold, spread = bool(invert), 0.5, 0.0
    alpha = image[..., 3] * np.float32(1 / full(image))
    if method == "alpha":
        _check_alpha(alpha)
        # A few opaque specks are not the shape of a picture that is otherwise faint.
        score = (
            alpha if most > full(image) / 2 else np.minimum(alpha, np.float32(most / full(image)))
        )
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
    seen = float(alpha.min()), float(alpha.max())
    if method in ("threshold", "color") and seen[0] < seen[1]:
        score = score * (alpha / alpha.max())  # transparent pixels are background in any case
    if method == "color" and not inverted:
        threshold = measure.color_threshold(score, spread)
    elif method == "color":  # the colour is the shape's, so the border's spread is irrelevant
        threshold = measure.otsu(measure.histogram(1 - score))
    return Foreground(read_only(score.view()), method, threshold, inverted, tuple(notes), seen)


def smoothed(foreground: Foreground, sigma: float | None) -> Foreground:
    """The field after a Gaussian filter of `TraceOptions.smoothing`."""
    score, automatic = foreground.score, sigma is None
    if sigma is None:
        own = 0.0 if foreground.method in ("alpha", "scribbles") else _SMOOTHING * max(score.shape)
        sigma = own if own >= _LEAST_SMOOTHING else 0.0
    if sigma == 0:
        return foreground
    if sigma > (most := max(score.shape)):
        what = f"smoothing is {sigma:g} pixels, but the picture's longer side has {most}"
        raise TraceError(f"{what}; give a few pixels, or 0 for none")
    score = np.asarray(gaussian_filter(score, sigma, mode="nearest", truncate=3.0), np.float32)
    if automatic and not (score > foreground.level()).any():
        return foreground  # smoothing would erase a thin shape
    return replace(foreground, score=read_only(score))


def _check_not_uniform(image: RGBA) -> None:
    first = image[0, 0]
    # A coarse sample is enough for nearly every picture.
    if (image[::37, ::37] != first).any() or (image != first).any():
        return
    red, green, blue, opacity = (f"{value * (255 / full(image)):.4g}" for value in first)
    color = f"red {red}, green {green}, blue {blue}, alpha {opacity} (of 255) everywhere"
    raise TraceError(f"the image has one colour only: {color}; there is nothing to trace")


def _check_alpha(alpha: NDArray[np.float32]) -> None:
    low, high = alpha.min(), alpha.max()
    if low == high:
        what = f"the foreground covers the whole image: its alpha channel is {low:.3g} everywhere"
        raise TraceError(f"{what}; choose Colour or Brightness, or scribble over the shape")


def _choose_method(
    image: RGBA,
    most: int,
    background: Color | None,
    background_at: Point | None,
    scribbles: Scribbles | None,
) -> tuple[ForegroundMethod, str]:
    if scribbles is not None:
        return "scribbles", "scribbles, as scribbles were given"
    if background is not None or background_at is not None:
        return "color", "colour distance, as a background colour was given"
    alpha = image[..., 3]
    # Half of what is usual: in a faint drawing hardly a pixel is half opaque.
    if _LEAST_SHARE < np.mean(alpha < most / 2) < 1 - _LEAST_SHARE:
        return "alpha", "alpha, as part of the image is transparent"
    border = measure.border_color(image)
    if border is not None and border.is_uniform:
        return "color", f"colour distance, as {border.share:.0%} of the border has one colour"
    return "threshold", (
        "brightness, as the border has no single colour; if this guess is wrong, choose another "
        "method, mark the background's colour, or scribble on foreground and background"
    )


def _usual_maximum(alpha: NDArray[np.unsignedinteger], opaque: int) -> int:
    """The largest alpha, without specks: at least `_SPECKS` of the visible pixels reach it. It is
    ``opaque`` if that many reach more than half of that, as in nearly every picture."""
    if np.count_nonzero(alpha > opaque / 2) >= _SPECKS * np.count_nonzero(alpha):
        return opaque
    reached = np.bincount(alpha.ravel(), minlength=2)[::-1].cumsum()[::-1]
    return int(np.flatnonzero(reached[1:] >= _SPECKS * reached[1]).max()) + 1


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
