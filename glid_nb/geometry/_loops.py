"""Loops of vertices: their measures, their names in messages, and the error they raise."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from glid_nb._arrays import Array
from glid_nb._errors import InputError


class GeometryError(InputError):
    """A polygon, offset or domain that cannot be used; the message says where and what to do.

    ``point`` is the place of the problem, to mark in a picture, or None. ``details`` are the
    coordinates and vertex numbers, in parentheses. ``plain``, shown beside the picture, leaves them
    out.
    """

    def __init__(self, message: str, point: Any = None, details: str = "") -> None:
        if details:
            message = message[0].upper() + message[1:]
        super().__init__(f"{message} ({details})" if details else message, message)
        self.point = None if point is None else tuple(map(float, np.asarray(point)))


def loop_name(index: int) -> str:
    """The name of a cage's loop in messages: "exterior loop", "hole 1", ..."""
    return "exterior loop" if index == 0 else f"hole {index}"


def plain_name(index: int) -> str:
    return "the outline" if index == 0 else f"hole {index}"


def place(point: ArrayLike, digits: int = 6) -> str:
    """Coordinates of an (x, y) or complex point for a message, e.g. "(1.5, -0.25)"."""
    x, y = as_points(point) if np.iscomplexobj(point) else np.asarray(point, dtype=np.float64)
    return f"({x:.{digits}g}, {y:.{digits}g})"


def places(points: ArrayLike) -> str:
    """Two points for a message, joined by "and", with enough digits to tell them apart."""
    for digits in (6, 9, 12, 17):
        one, other = (place(point, digits) for point in np.asarray(points))
        if one != other:
            break
    return f"{one} and {other}"


def as_points(z: ArrayLike) -> NDArray[np.float64]:
    """(...) complex points as (..., 2) real ones; read-only if the input is."""
    return np.ascontiguousarray(z, dtype=np.complex128).view(np.float64).reshape(*np.shape(z), 2)


def signed_area(loop: Array) -> float:
    """Signed area of an (n, 2) loop, positive if counter-clockwise."""
    x, y = (loop - loop[0]).T  # keeps the digits of a loop far from the origin
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def subdivided(loop: Array, counts: Array) -> Array:
    """Cut edge i of a complex loop into `counts[i]` equal parts; the parts' start points."""
    edge = np.repeat(np.arange(len(loop)), counts)
    first = np.cumsum(counts) - counts
    share = (np.arange(len(edge)) - first[edge]) / counts[edge]
    start, end = loop[edge], np.roll(loop, -1)[edge]
    return start + (end - start) * share


def next_index(loop: Array) -> Array:
    """Index of the next element, cyclic within each run of equal ``loop`` numbers."""
    following = np.arange(1, len(loop) + 1)
    first = np.flatnonzero(np.diff(loop, prepend=-1))
    following[np.append(first[1:], len(loop)) - 1] = first
    return following


@dataclass(frozen=True, eq=False)
class Loops:
    """Closed loops, concatenated, the exterior first; edge i is from vertex i to ``after[i]``."""

    points: NDArray[np.float64]  # (n, 2)
    number: NDArray[np.intp]  # (n,) the loop of each vertex, ascending from 0

    @classmethod
    def of(cls, loops: Sequence[Array]) -> Self:
        return cls(np.concatenate(loops), np.repeat(np.arange(len(loops)), list(map(len, loops))))

    def __getitem__(self, chosen: Array) -> "Loops":
        return Loops(self.points[chosen], self.number[chosen])

    @property
    def starts(self) -> NDArray[np.intp]:
        """(l + 1,) index of the first vertex of each loop, and after the last one."""
        return np.cumsum([0, *np.bincount(self.number)])

    def split(self, values: Array) -> list[Array]:
        """Split (n, ...) values of the vertices or edges by loop."""
        return np.split(values, self.starts[1:-1])

    @cached_property
    def after(self) -> NDArray[np.intp]:
        """(n,) index of the next vertex of the loop."""
        return next_index(self.number)

    @cached_property
    def before(self) -> NDArray[np.intp]:
        """(n,) index of the previous vertex of the loop."""
        return np.argsort(self.after)

    @cached_property
    def edges(self) -> NDArray[np.float64]:
        """(n, 2) vectors."""
        return self.points[self.after] - self.points

    @cached_property
    def lengths(self) -> NDArray[np.float64]:
        """(n,) of the edges."""
        return np.hypot(*self.edges.T)

    @property
    def perimeters(self) -> Array:
        """(l,) lengths of the loops."""
        return np.bincount(self.number, self.lengths)

    @property
    def areas(self) -> NDArray[np.float64]:
        """(l,) signed areas of the loops."""
        return np.array([signed_area(loop) for loop in self.split(self.points)])

    @cached_property
    def segments(self) -> NDArray[np.object_]:
        """(n,) the edges as shapely line strings."""
        ends = np.stack([self.points, self.points[self.after]], axis=1)
        return np.asarray(shapely.linestrings(ends), dtype=object)

    def way_between(self, e: Array, f: Array) -> NDArray[np.float64]:
        """Lengths of the loops between edges of one loop each, on the shorter side."""
        first, last, travelled = np.minimum(e, f), np.maximum(e, f), np.cumsum(self.lengths)
        forth = travelled[last] - self.lengths[last] - travelled[first]
        back = self.perimeters[self.number[e]] - forth - self.lengths[e] - self.lengths[f]
        return np.minimum(forth, back)


def loop_list(value: Any, key: str) -> list[Any]:
    """The value of an optional key that holds a list of loops."""
    if value is None:
        return []
    if isinstance(value, (str, bytes, Mapping)) or not isinstance(value, Iterable):
        raise GeometryError(f"'{key}' must be a list of loops, not {type(value).__name__}")
    return list(value)
