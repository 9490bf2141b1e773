"""Conversion between pixel and world coordinates."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glid_nb._arguments import unmet
from glid_nb._errors import InputError

LONGER_SIDE = 20.0  # length of a picture's longer side in world units


class TraceError(InputError):
    """No cage can be traced from a picture with these options; the message says why."""


@dataclass(frozen=True)
class PixelFrame:
    """The similarity transform between the pixels of a picture and world coordinates.

    Pixel coordinates are continuous, (x right, y down), with (0, 0) at the top left *corner* of the
    picture. The pixel in row i and column j covers [j, j + 1] x [i, i + 1] and has its centre at
    (j + 0.5, i + 0.5). World coordinates are (x right, y up). The world's origin is at the centre
    of a traced picture, whose longer side is 20 units long. The longer side of a drawn picture
    shows 20 / zoom units, and its middle shows the world point ``centre``.

    Raises a TraceError if width or height is not a whole number of pixels, at least 1.

    >>> frame = PixelFrame(width=200, height=100)
    >>> frame.to_world([[0, 0], [100, 50]])
    array([[-10.,   5.],
           [  0.,   0.]])
    """

    width: int
    height: int
    zoom: float = 1.0
    centre: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        for name in ("width", "height"):
            if expected := unmet(int, value := getattr(self, name), {"least": 1}):
                raise TraceError(f"{name} must be {expected} pixels, not {value!r}")
            object.__setattr__(self, name, int(value))

    @property
    def units_per_pixel(self) -> float:
        """Side of a pixel in world units."""
        return LONGER_SIDE / max(self.width, self.height) / self.zoom

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """The picture's rectangle in world units, (xmin, ymin, xmax, ymax)."""
        (x, y), unit = self.centre, 0.5 * self.units_per_pixel
        w, h = unit * self.width, unit * self.height
        return x - w, y - h, x + w, y + h

    def showing(self, bounds: ArrayLike, margin: float = 0.0) -> Self:
        """The frame, of the same size, that shows a rectangle as large as possible.

        ``margin`` is the free room on each side, as a share of the picture's sides.
        """
        low, high = np.reshape(bounds, (2, 2))
        pixels_per_unit = (2 * self._middle / (high - low)).min() * (1 - 2 * margin)
        zoom = float(pixels_per_unit * LONGER_SIDE / max(self.width, self.height))
        x, y = (low + high) / 2
        return replace(self, zoom=zoom, centre=(float(x), float(y)))

    def to_world(self, pixels: ArrayLike) -> NDArray[np.float64]:
        """World coordinates of pixel coordinates; shape (..., 2) in and out."""
        unit = self.units_per_pixel
        return (_points(pixels) - self._middle) * [unit, -unit] + self.centre

    def to_pixel(self, world: ArrayLike) -> NDArray[np.float64]:
        """Pixel coordinates of world coordinates; shape (..., 2) in and out."""
        unit = self.units_per_pixel
        return (_points(world) - self.centre) / [unit, -unit] + self._middle

    def index_at(self, point: tuple[float, float], name: str = "point") -> tuple[int, int]:
        """(row, column) of the pixel at a point (x, y). Raises a TraceError with ``name`` if the
        point lies outside."""
        x, y = point
        if not (0 <= x < self.width and 0 <= y < self.height):
            size = f"{self.width} x {self.height} pixels"
            problem = f"{name}: the pixel ({x:g}, {y:g}) lies outside the image of {size}"
            raise TraceError(problem, "That place lies outside the picture")
        return int(y), int(x)

    @property
    def _middle(self) -> NDArray[np.float64]:
        return np.array([self.width, self.height]) / 2


def _points(values: ArrayLike) -> NDArray[np.float64]:
    points = np.asarray(values, dtype=np.float64)
    if points.shape[-1:] != (2,):
        raise TraceError(f"points must have the shape (..., 2), not {points.shape}")
    return points
