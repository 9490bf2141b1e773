"""Likely reasons for handles outside a shape: pixels, swapped axes, rows and columns."""

import numpy as np
import shapely

from glid_nb._arrays import Array
from glid_nb.geometry import Cage, places

# _PIXELS: coordinates more than this many times as large as the shape's may be pixels.
# _NEAR: handles within this share of the shape's longer side are in its coordinates.
_PIXELS, _NEAR = 1.5, 0.1


def beside(cage: Cage, point: Array) -> tuple[str, float]:
    """An outside point as text, with enough digits to tell it from the cage, and its distance."""
    way = shapely.shortest_line(cage.polygon, shapely.Point(point))
    nearest = shapely.get_coordinates(way)[0]
    return places([point, nearest]).split(" and ")[0], float(way.length)


def misplaced(cage: Cage, points: Array) -> str:
    """Why handles may lie outside, and how to convert them to world coordinates.

    Empty for handles near the cage, unless a simple conversion would bring all inside.
    """
    xmin, ymin, xmax, ymax = cage.bounds
    far = max(map(abs, cage.bounds)) / cage.longer_side
    digits = 4 + max(int(np.log10(far)), 0)
    left, bottom, right, top = (f"{bound:.{digits}g}" for bound in cage.bounds)
    spans = f"the shape spans x from {left} to {right} and y from {bottom} to {top}"
    world = f"Handles are in world coordinates, x right and y up: {spans}"
    if (points >= 0).all() and points.max() > _PIXELS * max(abs(xmin), xmax, abs(ymin), ymax):
        call = "PixelFrame(width, height).to_world"
        pixels = f"convert pixels (x, y) of a picture by {call}(handles)"
        return f"{world}; {pixels}, (row, column) by {call}(handles[:, ::-1])"
    for seen, code, others in (
        ("x and y look swapped", "handles[:, ::-1]", points[:, ::-1]),
        ("y looks upside down", "handles * [1, -1]", points * [1, -1]),
        ("they look like rows and columns", "handles[:, ::-1] * [1, -1]",
         points[:, ::-1] * [1, -1]),
    ):  # fmt: skip
        if len(points) > 1 and cage.contains(others).all():
            return f"{world}; {seen}, because all handles would lie inside as {code}"
    near = cage.contains(points, _NEAR * cage.longer_side).all()
    return "" if near else world
