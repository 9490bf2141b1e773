"""Thresholds from histograms."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_BINS = 256
_SAMPLES = 2_000_000  # a histogram of more tells nothing new
_INCLUSIVE = 0.12  # a colour threshold that keeps parts similar to the background
_BETWEEN = 0.1  # share of the shape's pixels between the background and Otsu's threshold


def histogram(score: NDArray[np.float32]) -> NDArray[np.float64]:
    """(256,) relative frequencies of a field in [0, 1]; from a regular sample if it is large."""
    step = int(np.ceil(np.sqrt(score.size / _SAMPLES)))
    sample = score[::step, ::step]
    bins = np.minimum((sample * _BINS).astype(np.intp), _BINS - 1)
    counts = np.bincount(bins.ravel(), minlength=_BINS)
    return counts / counts.sum()


def otsu(shares: NDArray[np.float64]) -> float:
    """Otsu's threshold in [0, 1], which maximises the variance between the two classes.

    If a range of thresholds separates equally well, as in drawings with few colours, its middle:
    scikit-image's `threshold_otsu` returns the low end, where anti-aliased pixels are.
    """
    centres = (np.arange(_BINS) + 0.5) / _BINS
    low = np.cumsum(shares)[:-1]
    high = 1 - low
    low_sum = np.cumsum(shares * centres)[:-1]
    high_sum = np.sum(shares * centres) - low_sum
    with np.errstate(divide="ignore", invalid="ignore"):
        between = low * high * (low_sum / low - high_sum / high) ** 2
    between = np.where((low > 1e-12) & (high > 1e-12), between, 0.0)
    best = np.flatnonzero(between >= between.max() * (1 - 1e-3))
    # The first plateau only.
    run = best[: 1 + int(np.argmax(np.append(np.diff(best) > 1, True)))]
    return float((run[0] + run[-1] + 2) / 2 / _BINS)


def color_threshold(distance: NDArray[np.float32], spread: float) -> float:
    """A threshold for the distance from the background's colour.

    Otsu's, which gives the best edges, if few pixels lie between the background and it. Otherwise
    parts of the shape resemble the background, and the threshold is as low as the background's own
    spread allows.
    """
    shares = histogram(distance)
    middle = otsu(shares)
    floor = min(1.5 * spread + 0.02, 0.9)
    if middle <= floor:
        return middle if middle > spread else floor
    edges = np.arange(len(shares)) / len(shares)
    between = shares[(edges >= floor) & (edges < middle)].sum()
    above = shares[edges >= middle].sum()
    if between <= _BETWEEN * above:
        return middle
    return max(floor, min(0.5 * middle, _INCLUSIVE))
