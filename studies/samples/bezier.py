"""Shapes from a few points: smooth loops, limbs of varying thickness, blends.

Every function takes world coordinates (y up, longer image side 20 units). Shapes are shapely
geometries, so they can be united, cut and inset before they are inked.
"""

from collections.abc import Iterable
from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from shapely import affinity
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

Shape: TypeAlias = BaseGeometry
Floats: TypeAlias = NDArray[np.float64]
Points: TypeAlias = list[tuple[float, float]]
Limb: TypeAlias = list[tuple[float, float, float]]  # centre line and half thickness

ROUND = 24  # segments in a quarter circle: smooth at 2,000 px


def spline(points: ArrayLike, *, closed: bool = False, steps: int = 16) -> Floats:
    """(k, d) samples, ``steps`` per segment, of a smooth curve through (n, d) points.

    A centripetal Catmull-Rom spline. Columns after x and y, for example a radius, are interpolated
    too. A closed curve does not repeat its first point.
    """
    knots = np.asarray(points, dtype=float)
    if closed:
        around = np.concatenate([knots[-1:], knots, knots[:2]])
    else:
        around = np.concatenate([2 * knots[:1] - knots[1:2], knots, 2 * knots[-1:] - knots[-2:-1]])
    gaps = np.sqrt(np.linalg.norm(np.diff(around[:, :2], axis=0), axis=1))[:, None]
    before, here, after = gaps[:-2], gaps[1:-1], gaps[2:]
    p0, p1, p2, p3 = around[:-3], around[1:-2], around[2:-1], around[3:]
    leave = here * ((p1 - p0) / before - (p2 - p0) / (before + here) + (p2 - p1) / here)
    arrive = here * ((p2 - p1) / here - (p3 - p1) / (here + after) + (p3 - p2) / after)
    control = np.stack([p1, p1 + leave / 3, p2 - arrive / 3, p2])
    t = np.arange(steps) / steps
    weights = np.stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3])
    curve = np.einsum("bt,bsd->std", weights, control).reshape(-1, knots.shape[1])
    return curve if closed else np.concatenate([curve, knots[-1:]])


def loop(points: ArrayLike) -> Polygon:
    """Smooth closed shape through (n, 2) points."""
    return Polygon(spline(points, closed=True))


def symmetric(right: Points) -> Polygon:
    """Smooth mirror-symmetric shape; `right` runs from the y axis to the y axis."""
    return loop([*right, *((-x, y) for x, y in right[-2:0:-1])])


def disc(x: float, y: float, radius: float) -> Polygon:
    """Disc about (x, y)."""
    return shapely.Point(x, y).buffer(radius, quad_segs=ROUND)


def ellipse(x: float, y: float, rx: float, ry: float, angle: float = 0.0) -> Shape:
    """Ellipse with half axes rx and ry, turned by `angle` degrees."""
    round_ = affinity.scale(disc(0, 0, 1), rx, ry, origin=(0, 0))
    return affinity.translate(affinity.rotate(round_, angle, origin=(0, 0)), x, y)


def tube(points: ArrayLike) -> Shape:
    """Limb along a smooth centre line: (n, 3) rows of x, y and half thickness; round ends."""
    samples = spline(points, steps=14)
    samples[:, 2] = np.maximum(samples[:, 2], 1e-3)
    discs = shapely.buffer(shapely.points(samples[:, :2]), samples[:, 2], quad_segs=ROUND)
    joints = shapely.convex_hull(shapely.union(discs[:-1], discs[1:]))
    return shapely.union_all(joints)


def brush(points: ArrayLike, width: float, *, tip: float = 0.12) -> Shape:
    """Brush stroke through (n, 2) points: `width` in the middle, `tip` times that at both ends."""
    line = spline(points, steps=12)
    lengths = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    t = lengths / lengths[-1]
    pressure = tip + (1 - tip) * np.sin(np.pi * t) ** 0.7
    step = max(1, len(line) // 40)
    keep = np.unique(np.append(np.arange(0, len(line), step), len(line) - 1))
    return tube(np.column_stack([line, width / 2 * pressure])[keep])


def along(points: ArrayLike, at: ArrayLike) -> tuple[Floats, Floats, Floats]:
    """Points, unit tangents, and unit normals to the left, (k, 2) each, of a smooth curve.

    ``at`` holds (k,) shares of the curve's length, from 0 to 1.
    """
    line = spline(np.asarray(points, dtype=float)[:, :2], steps=32)
    lengths = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    where = np.asarray(at, dtype=float) * lengths[-1]
    slopes = np.gradient(line, axis=0)
    slopes /= np.linalg.norm(slopes, axis=1, keepdims=True)
    place = np.column_stack([np.interp(where, lengths, c) for c in line.T])
    tangent = np.column_stack([np.interp(where, lengths, c) for c in slopes.T])
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    return place, tangent, np.column_stack([-tangent[:, 1], tangent[:, 0]])


def blend(shapes: Iterable[Shape], fillet: float) -> Shape:
    """Union of shapes whose inner corners are filled with an arc of radius `fillet`."""
    united = shapely.union_all(list(shapes))
    grown = united.buffer(fillet, quad_segs=ROUND)
    return grown.buffer(-fillet, quad_segs=ROUND)


def rounded(shape: Shape, radius: float) -> Shape:
    """The shape with outer corners rounded to `radius`; parts thinner than 2 `radius` vanish."""
    return shape.buffer(-radius, quad_segs=ROUND).buffer(radius, quad_segs=ROUND)


def moved(shape: Shape, dx: float, dy: float) -> Shape:
    """The shape translated by (dx, dy)."""
    return affinity.translate(shape, dx, dy)


def turned(shape: Shape, degrees: float, about: tuple[float, float]) -> Shape:
    """The shape turned counter-clockwise about a point."""
    return affinity.rotate(shape, degrees, origin=about)


def mirrored(shape: Shape, x: float = 0.0) -> Shape:
    """The shape reflected in the vertical line through x."""
    return affinity.scale(shape, -1, 1, origin=(x, 0))
