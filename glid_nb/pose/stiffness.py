"""Stiff areas: parts of a shape that should keep their form."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import shapely
from numpy.typing import ArrayLike

from glid_nb._arguments import check_type, unmet
from glid_nb._arrays import Array, number_pairs
from glid_nb._errors import InputError, about
from glid_nb.geometry import Cage

FARTHEST = 1e10  # the largest coordinate of a point, in units
FULL_WEIGHT = 1000.0  # weight of a sample of the energy where the strength is 1
_MOST_POINTS, _MOST_STROKES = 10_000, 2_000  # points of one stroke; strokes in all
_ROUND = 8  # segments of a quarter circle of the brush

Areas = dict[float, shapely.Geometry]  # the area of each strength above 0; they do not overlap


class StiffnessError(InputError):
    """A stroke is not valid."""


class Stroke(NamedTuple):
    """A line drawn by a round brush; strength 0 erases."""

    points: tuple[tuple[float, float], ...]
    radius: float
    strength: float

    def over(self, areas: Areas) -> Areas:
        line = shapely.LineString if len(self.points) > 1 else shapely.Point
        new = line(self.points).buffer(self.radius, quad_segs=_ROUND)
        left = {s: shapely.difference(area, new) for s, area in areas.items()}
        left[self.strength] = left.get(self.strength, shapely.Point()).union(new)
        return {s: area for s, area in left.items() if s and not area.is_empty}


@dataclass(frozen=True)
class Stiffness:
    """How stiff a shape is, from 0 to 1 at each point of the undeformed shape.

    Strokes cover each other like paint: the last one counts. Samples of the isometric energy have
    the weight ``FULL_WEIGHT**strength``. Stiff areas also have samples inside. The energy of an
    isometry stays the same, and no proof depends on the stiffness.
    """

    strokes: tuple[Stroke, ...] = ()

    @classmethod
    def of(cls, strokes: Any) -> Stiffness:
        """From the list that `to_list` writes, or from None.

        Raises a StiffnessError that names the invalid stroke.
        """
        if strokes is None or isinstance(strokes, Stiffness):
            return strokes or cls()
        check_type("stiffness", strokes, list | tuple, "a list of strokes", StiffnessError)
        new = cls()
        for i, stroke in enumerate(strokes):
            with about(f"stiffness[{i}]", StiffnessError):
                if not isinstance(stroke, Mapping) or set(stroke) != set(Stroke._fields):
                    raise StiffnessError(
                        f"a stroke has exactly the keys {', '.join(Stroke._fields)}"
                    )
                new = new.painted(**stroke)
        return new

    def to_list(self) -> list[dict[str, Any]]:
        """Plain JSON values: ``points``, ``radius`` and ``strength`` of each stroke."""
        return [{**s._asdict(), "points": [list(p) for p in s.points]} for s in self.strokes]

    def painted(self, points: ArrayLike, radius: float, strength: float = 1.0) -> Stiffness:
        """Add a stroke through points (n, 2) of the undeformed shape."""
        line = number_pairs(points, "points must be a list of [x, y] pairs", StiffnessError)
        if not 0 < len(line) <= _MOST_POINTS or not (np.abs(line) <= FARTHEST).all():
            raise StiffnessError(f"points must be 1 to {_MOST_POINTS:,} within {FARTHEST:g} units")
        if expected := unmet(float, radius, {"above": 0, "most": FARTHEST}):
            raise StiffnessError(f"radius must be {expected}, got {radius!r:.40}")
        if expected := unmet(float, strength, {"least": 0, "most": 1}):
            raise StiffnessError(f"strength must be {expected}, got {strength!r:.40}")
        if len(self.strokes) >= _MOST_STROKES:
            raise StiffnessError(f"there are {_MOST_STROKES:,} strokes; clear some stiff areas")
        stroke = Stroke(tuple(map(tuple, line.tolist())), float(radius), float(strength))
        areas = stroke.over(self.areas)
        new = Stiffness((*self.strokes, stroke) if areas else ())
        vars(new)["areas"] = areas
        return new

    def moved(self, place: Callable[[Array], Array], scale: float) -> Stiffness:
        """Move all points with ``place``, (n, 2) to (n, 2), and enlarge the brushes by
        ``scale``."""
        new = Stiffness()
        for points, radius, strength in self.strokes:
            new = new.painted(place(np.array(points)), scale * radius, strength)
        return new

    @functools.cached_property
    def areas(self) -> Areas:
        return functools.reduce(lambda areas, stroke: stroke.over(areas), self.strokes, Areas())

    def within(self, cage: Cage) -> Areas:
        parts = {s: shapely.intersection(area, cage.polygon) for s, area in self.areas.items()}
        return {s: part for s, part in parts.items() if part.area > 0}

    def __bool__(self) -> bool:
        return bool(self.strokes)

    def __call__(self, points: ArrayLike) -> Array:
        """The strengths (k,) at points (k, 2)."""
        x, y = np.reshape(np.asarray(points, dtype=float), (-1, 2)).T
        strengths = np.zeros(len(x))
        for strength, area in self.areas.items():
            shapely.prepare(area)
            strengths[shapely.intersects_xy(area, x, y)] = strength
        return strengths
