"""Measurements for the foreground: brightness, colour distance, border colour, thresholds."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

RGBA = NDArray[np.unsignedinteger]
Field = NDArray[np.float32]

_WEIGHTS = (0.2125, 0.7154, 0.0721)  # of red, green and blue, as in skimage.color.rgb2gray

_FRAME = 0.01  # width of the border relative to the shorter side
_LEVELS = 16  # per channel, to find the most frequent colour
_SAME = 0.1  # colours closer than this (black to white is 1) count as one
_UNIFORM = 0.6  # share of the border with one colour
_BINS = 256
_SAMPLES = 2_000_000  # most samples of a histogram
_INCLUSIVE = 0.12  # a colour threshold that keeps parts similar to the background
_BETWEEN = 0.1  # share of the shape's pixels between the background and Otsu's threshold


def full(image: RGBA) -> int:
    """The largest value of a channel."""
    return int(np.iinfo(image.dtype).max)


def brightness(image: RGBA) -> Field:
    """(h, w) brightness in [0, 1]."""
    weights = np.array(_WEIGHTS, np.float32) / np.float32(full(image))
    return np.minimum(sum(image[..., c] * weights[c] for c in range(3)), 1)


def color_distance(image: RGBA, color: tuple[float, float, float]) -> Field:
    """(h, w) Euclidean distance from a colour in sRGB, where black and white are 1 apart.

    It is linear along an anti-aliased edge, and sixty times as fast as a distance in CIELAB.
    """
    scale = np.float32(1 / (full(image) * np.sqrt(3)))
    centre = np.array(color, dtype=np.float32) * np.float32(1 / np.sqrt(3))
    total = np.zeros(image.shape[:2], dtype=np.float32)
    for channel in range(3):
        total += (image[..., channel] * scale - centre[channel]) ** 2
    return np.minimum(np.sqrt(total), 1)


class BorderColor(NamedTuple):
    """The most frequent colour of the border, which mostly shows the background."""

    color: tuple[float, float, float]  # (red, green, blue) in [0, 1]
    share: float  # share of the border with nearly this colour
    spread: float  # 99th percentile of the distances of these pixels from `color`

    @property
    def is_uniform(self) -> bool:
        """Whether `color` may be assumed to be the background's."""
        return self.share >= _UNIFORM


def border_color(image: RGBA) -> BorderColor | None:
    """Estimate the background's colour; None if the whole border is transparent."""
    pixels, most = _border(image), full(image)
    scaled = pixels[pixels[:, 3] > most // 2, :3] / most
    if not len(scaled):
        return None
    bins = np.minimum((scaled * _LEVELS).astype(np.intp), _LEVELS - 1)
    codes = np.ravel_multi_index(tuple(bins.T), (_LEVELS,) * 3)
    color = scaled[codes == np.bincount(codes).argmax()].mean(axis=0)
    for _ in range(3):  # a few steps towards the mode, which may lie at a bin's boundary
        color = np.median(scaled[_distances(scaled, color) <= _SAME], axis=0)
    distance = _distances(scaled, color)
    near = distance <= _SAME
    red, green, blue = map(float, color)
    spread = float(np.percentile(distance[near], 99)) if near.any() else 0.0
    return BorderColor((red, green, blue), float(near.mean()), spread)


def border_is_bright(image: RGBA, values: Field, threshold: float) -> bool:
    """Whether at least half of the border's pixels that are not fully transparent are above the
    threshold."""
    border = _border(values)[_border(image[..., 3]) > 0]
    # A picture with a transparent border probably shows dark ink.
    return not border.size or float(np.mean(border > threshold)) >= 0.5


def _border(array: NDArray) -> NDArray:
    """(k, ...) pixels of a border 1 % wide, at least one pixel; a wide border is sampled."""
    frame = max(1, round(_FRAME * min(array.shape[:2])))
    step, (top, left) = max(1, frame // 4), np.minimum(array.shape[:2], frame)
    middle = array[top:-frame]
    sides = array[:top], array[top:][-frame:], middle[:, :left], middle[:, left:][:, -frame:]
    return np.concatenate([side[::step, ::step].reshape(-1, *array.shape[2:]) for side in sides])


def _distances(colors: NDArray[np.float64], color: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.linalg.norm(colors - color, axis=1) / np.sqrt(3)


def histogram(score: NDArray[np.float32]) -> NDArray[np.float64]:
    """(256,) relative frequencies of a field in [0, 1]. A large field is sampled regularly."""
    step = int(np.ceil(np.sqrt(score.size / _SAMPLES)))
    sample = score[::step, ::step]
    bins = np.minimum((sample * _BINS).astype(np.intp), _BINS - 1)
    counts = np.bincount(bins.ravel(), minlength=_BINS)
    return counts / counts.sum()


def otsu(shares: NDArray[np.float64]) -> float:
    """Otsu's threshold in [0, 1].

    If a range of thresholds separates equally well, this is the middle of the range. scikit-image
    takes its low end, which lies at anti-aliased pixels.
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
    # Use the first plateau only.
    run = best[: 1 + int(np.argmax(np.append(np.diff(best) > 1, True)))]
    return float((run[0] + run[-1] + 2) / 2 / _BINS)


def color_threshold(distance: NDArray[np.float32], spread: float) -> float:
    """A threshold for the distance from the background's colour.

    It is Otsu's threshold. If parts of the shape resemble the background, it is as low as the
    background's own spread allows.
    """
    shares = histogram(distance)
    middle, floor = otsu(shares), min(1.5 * spread + 0.02, 0.9)
    if middle <= floor:
        return middle if middle > spread else floor
    edges = np.arange(len(shares)) / len(shares)
    between = shares[(edges >= floor) & (edges < middle)].sum()
    above = shares[edges >= middle].sum()
    return middle if between <= _BETWEEN * above else max(floor, min(0.5 * middle, _INCLUSIVE))
