"""Conversion between pixel and world coordinates."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Integral

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glid_nb.imaging.errors import TraceError

LONGER_SIDE = 20.0
"""Length of a picture's longer side in world units."""


@dataclass(frozen=True)
class PixelFrame:
    """The similarity transform between the pixels of a picture and world coordinates.

    Pixel coordinates are continuous, (x right, y down), with (0, 0) at the top left *corner* of the
    picture: the pixel in row i and column j covers [j, j + 1] x [i, i + 1] and has its centre at
    (j + 0.5, i + 0.5). World coordinates are (x right, y up), with the origin at the centre of the
    picture, whose longer side is 20 units long.

    Parameters
    ----------
    width, height
        Size of the picture in pixels, at least 1.

    Examples
    --------
    >>> frame = PixelFrame(width=200, height=100)
    >>> frame.to_world([[0, 0], [100, 50]])
    array([[-10.,   5.],
           [  0.,   0.]])
    """

    width: int
    height: int

    def __post_init__(self) -> None:
        for name in ("width", "height"):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, Integral) or value < 1:
                raise TraceError(
                    f"{name} must be a whole number of pixels, at least 1, not {value!r}"
                )
            object.__setattr__(self, name, int(value))

    @property
    def units_per_pixel(self) -> float:
        """Side of a pixel in world units."""
        return LONGER_SIDE / max(self.width, self.height)

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """The picture's rectangle in world units, (xmin, ymin, xmax, ymax)."""
        x, y = 0.5 * self.width * self.units_per_pixel, 0.5 * self.height * self.units_per_pixel
        return -x, -y, x, y

    def to_world(self, pixels: ArrayLike) -> NDArray[np.float64]:
        """World coordinates of pixel coordinates; shape (..., 2) in and out."""
        points = _points(pixels)
        x = (points[..., 0] - 0.5 * self.width) * self.units_per_pixel
        y = (0.5 * self.height - points[..., 1]) * self.units_per_pixel
        return np.stack([x, y], axis=-1)

    def to_pixel(self, world: ArrayLike) -> NDArray[np.float64]:
        """Pixel coordinates of world coordinates; shape (..., 2) in and out."""
        points = _points(world)
        x = points[..., 0] / self.units_per_pixel + 0.5 * self.width
        y = 0.5 * self.height - points[..., 1] / self.units_per_pixel
        return np.stack([x, y], axis=-1)

    def index_at(self, point: tuple[float, float], name: str = "point") -> tuple[int, int]:
        """(row, column) of the pixel at a point (x, y) in pixel coordinates.

        Raises
        ------
        TraceError
            The point, called `name` in the message, lies outside the picture.
        """
        x, y = point
        if not (0 <= x < self.width and 0 <= y < self.height):
            raise TraceError(
                f"{name}: the pixel ({x:g}, {y:g}) lies outside the image of {self.width} x "
                f"{self.height} pixels",
                "That place lies outside the picture",
            )
        return int(y), int(x)


def _points(values: ArrayLike) -> NDArray[np.float64]:
    points = np.asarray(values, dtype=np.float64)
    if points.shape[-1:] != (2,):
        raise TraceError(f"points must have the shape (..., 2), not {points.shape}")
    return points
