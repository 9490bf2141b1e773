"""Panels: straight pieces of the cage, on which maps are integrated and certified."""

import functools
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from glid_nb._arrays import Array, Rebuilt, frozen
from glid_nb.geometry._loops import GeometryError, Loops, next_index, subdivided
from glid_nb.geometry.cage import Cage
from glid_nb.geometry.domain import Domain

_MAX_BISECTIONS = 48  # bisecting an edge this often brings it below rounding
_MAX_SPLITS = 40  # of a panel after that
_EVEN = 1e-9  # relative difference by rounding between the halves of one piece


@dataclass(frozen=True, eq=False)
class Panels(Rebuilt):
    """Consecutive pieces of the cage's edges, loop by loop; every field is a (p,) array."""

    start: Array
    end: Array  # complex end points; end[i] == start[next[i]]
    loop: Array  # of the cage: 0 exterior, then the holes
    depth: Array  # how often the panel was split since the first grading
    next: Array  # the panel that follows on the same closed loop

    def __post_init__(self) -> None:
        vars(self).update({name: frozen(array) for name, array in vars(self).items()})

    @classmethod
    def along(cls, loops: Sequence[Array]) -> "Panels":
        """Panels from each vertex of closed complex loops to the next."""
        start = np.concatenate(loops)
        loop = np.repeat(np.arange(len(loops)), [len(points) for points in loops])
        following = next_index(loop)
        return Panels(start, start[following], loop, np.zeros(len(start), dtype=int), following)

    def __len__(self) -> int:
        return len(self.start)

    @property
    def length(self) -> Array:
        """(p,) lengths, world units."""
        return np.abs(self.end - self.start)

    @property
    def middle(self) -> Array:
        """(p,) complex midpoints."""
        return (self.start + self.end) / 2

    @property
    def divisible(self) -> Array:
        """(p,) bool: False after 40 splits, or where the midpoint is an end in floating point."""
        inside = (self.middle != self.start) & (self.middle != self.end)
        return inside & (self.depth < _MAX_SPLITS)

    def split(self, chosen: Array) -> tuple["Panels", Array]:
        """Halve ``chosen`` (p,) bool if :attr:`divisible`; also (q,) the parent of each panel."""
        chosen = chosen & self.divisible
        parent = np.repeat(np.arange(len(self)), np.where(chosen, 2, 1))
        second = np.flatnonzero(np.diff(parent, prepend=-1) == 0)
        start, end = self.start[parent], self.end[parent]
        start[second] = end[second - 1] = self.middle[chosen]
        loop, depth = self.loop[parent], (self.depth + chosen)[parent]
        return Panels(start, end, loop, depth, next_index(loop)), parent


@functools.lru_cache(maxsize=8)
def graded_panels(domain: Domain, ratio: float = 1.0) -> Panels:
    """Panels no longer than ``ratio`` times their distance to the nearest singularity of ``f_z``.

    Singularities are the offset cage's vertices and the hole points. The cage's edges are bisected
    until that holds. The last few results are kept.
    """
    if not ratio > 0:
        raise ValueError(f"ratio is {ratio}; it must be positive")
    panels = Panels.along(domain.cage.loops_complex)
    panels = replace(panels, depth=panels.depth - _MAX_BISECTIONS)
    for _ in range(_MAX_BISECTIONS):
        too_long = panels.length > ratio * _clearance(domain, panels.start, panels.end)
        if not too_long.any():
            break
        panels, _ = panels.split(too_long)
    return replace(panels, depth=np.zeros(len(panels), dtype=int))


def paired(panels: Panels, domain: Domain, ratio: float) -> Array:
    """(p,) bool: the first panel of each pair; pairs do not overlap.

    A pair is two consecutive panels of equal length on one straight piece. Together they are at
    most ``ratio`` times as long as their distance to a singularity.
    """
    after = np.roll(np.arange(len(panels)), -1)
    chord, following = panels.end - panels.start, panels.end[after] - panels.start[after]
    even = np.abs(chord - following) <= _EVEN * np.abs(chord)
    candidates = np.flatnonzero(even & (panels.next == after))
    start, end = panels.start[candidates], panels.end[after[candidates]]
    fits = np.zeros(len(panels), dtype=bool)
    fits[candidates] = np.abs(end - start) <= ratio * _clearance(domain, start, end)
    # In a run of panels that fit, every other one begins a pair.
    index = np.arange(len(panels))
    last_unfit = np.maximum.accumulate(np.where(fits, -1, index))
    return fits & ((index - last_unfit) % 2 == 1)


def uniform_panels(cage: Cage, n: int = 10_000) -> Panels:
    """The segments between about `n` even samples of the boundary (the set G of (31)).

    A loop of length P_l gets n_l = ceil(P_l / P * n) samples, P the whole perimeter; an edge of it
    gets c = ceil(length / P_l * n_l), at a + (b - a) k / c for k = 0, ..., c - 1. Rounding up makes
    the total slightly larger than `n`.
    """
    if n < 1:
        raise GeometryError(f"the number of boundary samples must be at least 1, not {n}")
    points, whole = [], Loops.of(cage.loops)
    for loop, edges in zip(cage.loops_complex, whole.split(whole.lengths), strict=True):
        n_loop = np.ceil(edges.sum() / cage.perimeter * n)
        points.append(subdivided(loop, np.ceil(edges / edges.sum() * n_loop).astype(int)))
    return Panels.along(points)


def _clearance(domain: Domain, start: Array, end: Array) -> Array:
    """(p,) distances of segments to the nearest singularity of ``f_z``."""
    singular = np.concatenate([*domain.offset_cage.loops_complex, domain.hole_points_complex])
    return point_distance(singular, start[:, None], end[:, None]).min(axis=1, initial=np.inf)


def cross(a: Array, b: Array) -> Array:
    """``a_x b_y - a_y b_x``."""
    return np.imag(np.conj(a) * b)


def point_distance(point: Array, start: Array, end: Array) -> Array:
    """Distances from points to the segments of the same index; shapes broadcast."""
    along = end - start
    square = np.real(along * np.conj(along))
    position = np.real((point - start) * np.conj(along)) / np.where(square > 0, square, 1)
    return np.abs(point - start - np.clip(position, 0, 1) * along)


def segments_cross(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Whether the segments from ``a`` to ``b`` and from ``c`` to ``d`` cross, no end on either."""
    ab, cd = b - a, d - c
    return (cross(ab, c - a) * cross(ab, d - a) < 0) & (cross(cd, a - c) * cross(cd, b - c) < 0)


def segment_distance(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Distances between the segments from ``a`` to ``b`` and those from ``c`` to ``d``."""
    of_one = np.minimum(point_distance(a, c, d), point_distance(b, c, d))
    of_other = np.minimum(point_distance(c, a, b), point_distance(d, a, b))
    return np.where(segments_cross(a, b, c, d), 0.0, np.minimum(of_one, of_other))
