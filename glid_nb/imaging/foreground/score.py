"""The foreground score, the result of every method."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from glid_nb._arrays import read_only
from glid_nb.imaging.errors import TraceError

_SMOOTHING = 0.001  # of the longer side
_LEAST_SMOOTHING = 0.5  # pixels; less is not worth the time

# What a method measures where its name does not tell; the first word is the editor's control.
_MEASURES = {"threshold": "brightness", "color": "colour distance"}


@dataclass(frozen=True, eq=False)
class Foreground:
    """A field over the picture that is high in the foreground.

    Unlike a mask, it has a level set with sub-pixel accuracy and serves all thresholds.
    """

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
        empty, measure = not mask.any(), _MEASURES.get(self.method, self.method)
        problem, seen = "the image has no foreground", "finds no shape in the picture"
        if not empty:
            problem = "the foreground covers the whole image"
            seen = "takes the whole picture for the shape"
        change = "raise" if empty == self.inverted else "lower"
        remedy = f"{change} the threshold, or use another method"
        plain = f"{change} the Threshold, or paint over the shape with Scribbles"
        if self.method == "scribbles":
            remedy = "draw foreground strokes over more of the shape, background strokes around it"
            plain = "paint over more of the shape, and over the background around it"
        count, value = "no" if empty else "every", self.threshold(threshold)
        raise TraceError(
            f"{problem} by {measure}: {count} pixel passes the threshold {value:.3g}; {remedy}",
            f"{measure.split()[0].capitalize()} {seen}; {plain}",
        )


def smoothed(foreground: Foreground, sigma: float | None) -> Foreground:
    """The field after a Gaussian filter of standard deviation ``sigma`` in pixels.

    None: 0.1 % of the longer side, or 0 for alpha and scribbles.
    """
    score = foreground.score
    if sigma is None:
        own = 0.0 if foreground.method in ("alpha", "scribbles") else _SMOOTHING * max(score.shape)
        sigma = own if own >= _LEAST_SMOOTHING else 0.0
    if sigma == 0:
        return foreground
    score = np.asarray(gaussian_filter(score, sigma, mode="nearest", truncate=3.0), np.float32)
    return replace(foreground, score=read_only(score))
