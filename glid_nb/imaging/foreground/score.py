"""The result of every method: how much each pixel is foreground."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from glid_nb.imaging.errors import TraceError

_EMPTY = {
    "alpha": "lower the threshold, or use another method",
    "threshold": "change the threshold, or set invert",
    "color": "lower the threshold, or pick another background colour",
    "scribbles": "draw foreground strokes over more of the shape",
}
_EMPTY_PLAIN = {
    "alpha": "lower the Threshold, or paint over the shape with Scribbles",
    "threshold": "change the Threshold, or paint over the shape with Scribbles",
    "color": "lower the Threshold, or paint over the shape with Scribbles",
    "scribbles": "paint over more of the shape",
}
_FULL = {
    "alpha": "use method='color', 'threshold' or 'scribbles'",
    "threshold": "change the threshold, or set invert",
    "color": "raise the threshold, or pick another background colour",
    "scribbles": "draw background strokes around the shape",
}
_FULL_PLAIN = {
    "alpha": "choose Colour or Brightness, or paint over the shape with Scribbles",
    "threshold": "change the Threshold, or paint over the shape with Scribbles",
    "color": "raise the Threshold, or paint over the shape with Scribbles",
    "scribbles": "paint over the background around the shape",
}
_CONTROLS = {
    "alpha": "Alpha",
    "threshold": "Brightness",
    "color": "Colour",
    "scribbles": "Scribbles",
}


@dataclass(frozen=True, eq=False)
class Foreground:
    """A field over the picture that is high in the foreground.

    It is kept, rather than a mask, for two reasons: its level set has sub-pixel accuracy, and
    another threshold needs no new field.

    Attributes
    ----------
    score
        (h, w) read-only float32, in [0, 1], sampled at the pixels' centres.
    method
        The method used, never ``"auto"``.
    automatic_threshold
        The threshold that was found, in the terms of `TraceOptions.threshold`.
    inverted
        Whether low values of what the method measures are foreground. The score is 1 minus them.
    notes
        Sentences about what was chosen.
    """

    score: NDArray[np.float32]
    method: str
    automatic_threshold: float
    inverted: bool
    notes: tuple[str, ...]

    def threshold(self, threshold: float | None = None) -> float:
        """`threshold`, or the automatic one."""
        return self.automatic_threshold if threshold is None else threshold

    def level(self, threshold: float | None = None) -> float:
        """The score above which a pixel is foreground."""
        value = self.threshold(threshold)
        return 1 - value if self.inverted else value

    def mask(self, threshold: float | None = None) -> NDArray[np.bool_]:
        """(h, w) which pixels are foreground.

        Raises
        ------
        TraceError
            None is, or all are.
        """
        level = self.level(threshold)
        mask = self.score > level
        if not mask.any():
            raise TraceError(
                f"the image has no foreground by {describe(self)}: no pixel passes the threshold "
                f"{self.threshold(threshold):.3g}; {_EMPTY[self.method]}",
                f"{_CONTROLS[self.method]} finds no shape in the picture; "
                f"{_EMPTY_PLAIN[self.method]}",
            )
        if mask.all():
            raise TraceError(
                f"the foreground covers the whole image by {describe(self)}: every pixel passes "
                f"the threshold {self.threshold(threshold):.3g}; {_FULL[self.method]}",
                f"{_CONTROLS[self.method]} takes the whole picture for the shape; "
                f"{_FULL_PLAIN[self.method]}",
            )
        return mask


def describe(foreground: Foreground) -> str:
    """The method in words."""
    return {
        "alpha": "alpha",
        "threshold": "brightness",
        "color": "colour distance",
        "scribbles": "scribbles",
    }[foreground.method]
