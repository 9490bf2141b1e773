"""The foreground score, the result of every method."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from glid_nb._arrays import read_only
from glid_nb.imaging.errors import TraceError

_SMOOTHING = 0.001  # of the longer side
_LEAST_SMOOTHING = 0.5  # pixels; less is not worth the time

# By method: its name in messages, in terms of options and as the editor's control, and what helps
# against an empty and against a full foreground, in both terms.
_OR = "or paint over the shape with Scribbles"
_TRY_INVERT = "change the threshold, or set invert", f"change the Threshold, {_OR}"
_WORDS = {
    "alpha": (
        ("alpha", "Alpha"),
        ("lower the threshold, or use another method", f"lower the Threshold, {_OR}"),
        (
            "use method='color', 'threshold' or 'scribbles'",
            f"choose Colour or Brightness, {_OR}",
        ),
    ),
    "threshold": (("brightness", "Brightness"), _TRY_INVERT, _TRY_INVERT),
    "color": (
        ("colour distance", "Colour"),
        (
            "lower the threshold, or pick another background colour",
            f"lower the Threshold, {_OR}",
        ),
        (
            "raise the threshold, or pick another background colour",
            f"raise the Threshold, {_OR}",
        ),
    ),
    "scribbles": (
        ("scribbles", "Scribbles"),
        ("draw foreground strokes over more of the shape", "paint over more of the shape"),
        (
            "draw background strokes around the shape",
            "paint over the background around the shape",
        ),
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
        (measure, control), if_empty, if_full = _WORDS[self.method]
        value = f"passes the threshold {self.threshold(threshold):.3g}"
        if not mask.any():
            raise TraceError(
                f"the image has no foreground by {measure}: no pixel {value}; {if_empty[0]}",
                f"{control} finds no shape in the picture; {if_empty[1]}",
            )
        if mask.all():
            raise TraceError(
                f"the foreground covers the whole image by {measure}: every pixel {value}; "
                f"{if_full[0]}",
                f"{control} takes the whole picture for the shape; {if_full[1]}",
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
    return replace(foreground, score=read_only(score))
