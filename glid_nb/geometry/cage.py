"""The cage: a checked, immutable polygon with holes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from glid_nb._arrays import read_only
from glid_nb.geometry._checks import RESOLUTION, check_loops, checked_vertices
from glid_nb.geometry._loops import GeometryError, edge_lengths, loop_list, loop_name, signed_area


@dataclass(frozen=True, eq=False, init=False)
class Cage:
    """A bounded polygon with any number of holes; the boundary P of the certified domain.

    Loops have their vertices in order, either way round; the first is not repeated at the end. The
    constructor checks what the package relies on: finite coordinates, at least three distinct
    vertices per loop, loops that neither cross nor touch themselves or each other, every hole
    inside the exterior and outside every other hole. If not, a GeometryError names the loop, the
    vertex and its place. Loops are reversed where needed, keeping vertex 0 first, so that the
    domain lies to the left of the boundary.
    """

    exterior: NDArray[np.float64]
    """(n, 2) read-only, counter-clockwise."""
    holes: tuple[NDArray[np.float64], ...]
    """Each (k, 2) read-only, clockwise."""

    def __init__(self, exterior: ArrayLike, holes: Iterable[ArrayLike] = ()) -> None:
        loops = [checked_vertices(exterior, loop_name(0))]
        loops += [checked_vertices(hole, loop_name(i + 1)) for i, hole in enumerate(holes)]
        check_loops(loops)
        for i, loop in enumerate(loops):
            if (signed_area(loop) > 0) != (i == 0):
                loop[1:] = loop[:0:-1].copy()
        oriented = map(read_only, loops)
        vars(self).update(exterior=next(oriented), holes=tuple(oriented))

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Cage:
        """The cage of a mapping with the keys ``cage`` and, optionally, ``holes``."""
        if "cage" not in data:
            raise GeometryError("the key 'cage' is missing: give the exterior loop there")
        return cls(data["cage"], loop_list(data.get("holes"), "holes"))

    def to_dict(self) -> dict[str, Any]:
        """The loops as nested lists under the keys ``cage`` and ``holes``, ready for JSON."""
        return {"cage": self.exterior.tolist(), "holes": [hole.tolist() for hole in self.holes]}

    @property
    def loops(self) -> tuple[NDArray[np.float64], ...]:
        """The exterior loop, then the holes."""
        return (self.exterior, *self.holes)

    @cached_property
    def loops_complex(self) -> tuple[NDArray[np.complex128], ...]:
        """The loops as read-only complex128 arrays x + iy."""
        return tuple(read_only(loop[:, 0] + 1j * loop[:, 1]) for loop in self.loops)

    def equals(self, other: Cage) -> bool:
        """Whether all loops have the same vertices in the same order."""
        pairs = zip(self.loops, other.loops, strict=False)
        return self.n_holes == other.n_holes and all(np.array_equal(a, b) for a, b in pairs)

    @property
    def n_holes(self) -> int:
        """Number of hole loops."""
        return len(self.holes)

    @property
    def n_vertices(self) -> int:
        """Number of vertices over all loops."""
        return sum(len(loop) for loop in self.loops)

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Bounding box (xmin, ymin, xmax, ymax)."""
        (xmin, ymin), (xmax, ymax) = self.exterior.min(axis=0), self.exterior.max(axis=0)
        return float(xmin), float(ymin), float(xmax), float(ymax)

    @property
    def longer_side(self) -> float:
        """Longer side of the bounding box."""
        xmin, ymin, xmax, ymax = self.bounds
        return max(xmax - xmin, ymax - ymin)

    @cached_property
    def area(self) -> float:
        """Area of the domain without its holes."""
        return float(sum(signed_area(loop) for loop in self.loops))

    @cached_property
    def perimeter(self) -> float:
        """Length of the boundary over all loops."""
        return float(sum(edge_lengths(loop).sum() for loop in self.loops))

    @cached_property
    def polygon(self) -> shapely.Polygon:
        """The domain as a prepared shapely polygon."""
        polygon = shapely.Polygon(self.exterior, self.holes)
        shapely.prepare(polygon)
        return polygon

    def contains(self, points: ArrayLike, tolerance: float = 0.0) -> NDArray[np.bool_]:
        """Which of the (..., 2) points lie in the closed domain; not those with NaN.

        Points outside by at most the tolerance count as inside; it is at least 1e-12 of the cage's
        size, so that rounded boundary points count too.
        """
        xy = np.asarray(points, dtype=np.float64)
        if xy.shape[-1:] != (2,):
            raise GeometryError(f"points must have the shape (..., 2), not {xy.shape}")
        if not tolerance >= 0:
            raise GeometryError(f"tolerance must be at least 0, not {tolerance}")
        flat = xy.reshape(-1, 2)
        rounding = RESOLUTION * max(self.longer_side, float(np.abs(self.bounds).max()))
        reach = max(tolerance, rounding)
        inside = shapely.intersects_xy(self.polygon, flat[:, 0], flat[:, 1])
        rest = np.flatnonzero(~inside)
        if rest.size:
            # Distances are slow; a wider polygon rules out most points.
            wider = shapely.buffer(self.polygon, 2 * max(reach, 1e-4 * self.longer_side))
            shapely.prepare(wider)
            rest = rest[shapely.intersects_xy(wider, flat[rest, 0], flat[rest, 1])]
            inside[rest] = shapely.dwithin(self.polygon, shapely.points(flat[rest]), reach)
        return inside.reshape(xy.shape[:-1])
