"""The border of a picture, which mostly shows the background."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_SHARE = 0.01  # width of the frame relative to the shorter side
_LEVELS = 16  # per channel, to find the most frequent colour
_SAME = 0.1  # colours closer than this (black to white is 1) count as one
_UNIFORM = 0.6  # share of the border with one colour


@dataclass(frozen=True)
class BorderColor:
    """The most frequent colour of the border."""

    color: tuple[float, float, float]  # (red, green, blue) in [0, 1]
    share: float  # the part of the border that has it, nearly
    spread: float  # 99th percentile of the distances of that part from `color`

    @property
    def is_uniform(self) -> bool:
        """Whether `color` can be taken for the background's."""
        return self.share >= _UNIFORM


def border_pixels(array: NDArray) -> NDArray:
    """(k, ...) pixels of a frame 1 % wide, at least one pixel; a regular sample of a wide one."""
    height, width = array.shape[:2]
    frame = max(1, round(_SHARE * min(height, width)))
    if 2 * frame >= min(height, width):
        return array.reshape(-1, *array.shape[2:])
    sides = (
        array[:frame],
        array[-frame:],
        array[frame:-frame, :frame],
        array[frame:-frame, -frame:],
    )
    step = max(1, frame // 4)
    return np.concatenate([side[::step, ::step].reshape(-1, *array.shape[2:]) for side in sides])


def border_color(image: NDArray[np.unsignedinteger]) -> BorderColor | None:
    """Estimate the background's colour; None if the whole border is transparent."""
    pixels = border_pixels(image)
    scaled = pixels[pixels[:, 3] > np.iinfo(image.dtype).max // 2, :3] / np.iinfo(image.dtype).max
    if not len(scaled):
        return None
    bins = np.minimum((scaled * _LEVELS).astype(np.intp), _LEVELS - 1)
    codes = np.ravel_multi_index(tuple(bins.T), (_LEVELS,) * 3)
    most = np.bincount(codes).argmax()
    color = scaled[codes == most].mean(axis=0)
    for _ in range(3):  # a few steps towards the mode, which may lie at the bin's boundary
        color = np.median(scaled[_distances(scaled, color) <= _SAME], axis=0)
    distance = _distances(scaled, color)
    near = distance <= _SAME
    red, green, blue = (float(c) for c in color)
    spread = float(np.percentile(distance[near], 99)) if near.any() else 0.0
    return BorderColor((red, green, blue), float(near.mean()), spread)


def _distances(colors: NDArray[np.float64], color: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.linalg.norm(colors - color, axis=1) / np.sqrt(3)


def border_is_bright(
    image: NDArray[np.unsignedinteger], values: NDArray[np.float32], threshold: float
) -> bool:
    """Whether most of the border's pixels that are not transparent are above the threshold.

    True for a transparent border, as the picture is then likely dark ink on nothing.
    """
    border = border_pixels(values)[border_pixels(image[..., 3]) > 0]
    return not border.size or float(np.mean(border > threshold)) >= 0.5
