"""The foreground score, the result of every method."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from glid_nb.imaging.errors import TraceError

_SMOOTHING = 0.001  # of the longer side
_LEAST_SMOOTHING = 0.5  # pixels; less is not worth the time


class _Words(NamedTuple):
    """A method in messages, in terms of options and, ``plain``, of the editor's controls."""

    measure: str
    control: str
    if_empty: str
    if_empty_plain: str
    if_full: str
    if_full_plain: str


_OR_PAINT = "change the Threshold, or paint over the shape with Scribbles"
_LOWER_OR_PAINT = "lower the Threshold, or paint over the shape with Scribbles"
_WORDS = {
    "alpha": _Words(
        "alpha",
        "Alpha",
        "lower the threshold, or use another method",
        _LOWER_OR_PAINT,
        "use method='color', 'threshold' or 'scribbles'",
        "choose Colour or Brightness, or paint over the shape with Scribbles",
    ),
    "threshold": _Words(
        "brightness",
        "Brightness",
        "change the threshold, or set invert",
        _OR_PAINT,
        "change the threshold, or set invert",
        _OR_PAINT,
    ),
    "color": _Words(
        "colour distance",
        "Colour",
        "lower the threshold, or pick another background colour",
        _LOWER_OR_PAINT,
        "raise the threshold, or pick another background colour",
        "raise the Threshold, or paint over the shape with Scribbles",
    ),
    "scribbles": _Words(
        "scribbles",
        "Scribbles",
        "draw foreground strokes over more of the shape",
        "paint over more of the shape",
        "draw background strokes around the shape",
        "paint over the background around the shape",
    ),
}


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
        words, value = _WORDS[self.method], self.threshold(threshold)
        if not mask.any():
            raise TraceError(
                f"the image has no foreground by {words.measure}: no pixel passes the threshold "
                f"{value:.3g}; {words.if_empty}",
                f"{words.control} finds no shape in the picture; {words.if_empty_plain}",
            )
        if mask.all():
            raise TraceError(
                f"the foreground covers the whole image by {words.measure}: every pixel passes "
                f"the threshold {value:.3g}; {words.if_full}",
                f"{words.control} takes the whole picture for the shape; {words.if_full_plain}",
            )
        return mask


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
    score.setflags(write=False)
    return replace(foreground, score=score)
