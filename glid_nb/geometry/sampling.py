"""Uniform samples of the boundary, as the paper takes them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from glid_nb.geometry._loops import GeometryError, edge_lengths
from glid_nb.geometry.cage import Cage


@dataclass(frozen=True, eq=False)
class BoundarySamples:
    """Points on the boundary of a cage, in order along each loop.

    Attributes
    ----------
    points
        (S,) complex128 positions.
    loop
        (S,) index of the loop, 0 for the exterior.
    next
        (S,) index of the sample that follows on the same loop, cyclic; the S segments from each
        sample to the next make up the whole boundary.
    """

    points: NDArray[np.complex128]
    loop: NDArray[np.intp]
    next: NDArray[np.intp]

    def __post_init__(self) -> None:
        for array in (self.points, self.loop, self.next):
            array.setflags(write=False)

    @property
    def n_samples(self) -> int:
        """Number of samples S, also the number of segments."""
        return len(self.points)


def uniform_boundary_samples(cage: Cage, n: int = 10_000) -> BoundarySamples:
    """About `n` evenly spaced samples of the boundary (the set G of Chen & Weber 2017, section 9).

    A loop of length P_l gets n_l = ceil(P_l / P * n) samples, P the whole perimeter; an edge of it
    gets c = ceil(length / P_l * n_l), at a + (b - a) k / c for k = 0, ..., c - 1. Rounding up makes
    the total slightly larger than `n`.

    Parameters
    ----------
    cage
        The polygon to sample.
    n
        Wanted number of samples, at least 1.

    Raises
    ------
    GeometryError
        `n` is less than 1.
    """
    if n < 1:
        raise GeometryError(f"the number of boundary samples must be at least 1, not {n}")
    lengths = [edge_lengths(loop) for loop in cage.loops]
    per_loop = [float(edges.sum()) for edges in lengths]
    perimeter = sum(per_loop)
    points: list[NDArray[np.complex128]] = []
    for loop, edges, length in zip(cage.loops_complex, lengths, per_loop, strict=True):
        n_loop = np.ceil(length / perimeter * n)
        points.append(subdivided(loop, np.ceil(edges / length * n_loop).astype(int)))
    sizes = np.array([len(part) for part in points])
    ends = np.cumsum(sizes)
    following = np.arange(1, ends[-1] + 1)
    following[ends - 1] = ends - sizes
    return BoundarySamples(
        np.concatenate(points), np.repeat(np.arange(len(sizes)), sizes), following
    )


def subdivided(loop: NDArray[np.complex128], counts: NDArray[np.integer]) -> NDArray[np.complex128]:
    """Cut edge i of a complex loop into `counts[i]` equal parts; the parts' start points."""
    edge = np.repeat(np.arange(len(loop)), counts)
    first = np.cumsum(counts) - counts
    share = (np.arange(len(edge)) - first[edge]) / counts[edge]
    start, end = loop[edge], np.roll(loop, -1)[edge]
    return start + (end - start) * share
