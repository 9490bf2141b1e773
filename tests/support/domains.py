"""A few small domains that the numeric tests share, so that few programs are compiled."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb.geometry import Cage, Domain
from glid_nb.geometry._loops import subdivided
from glid_nb.harmonic import HarmonicMap

from .reference_map import DenseCheck, ReferenceMap

Array = NDArray[Any]

NAMES = ("ell", "ring", "twin", "triple")
"""Domains with 0, 1, 2 and 3 holes."""
MANY_HOLES = {"quadruple": 4, "quintuple": 5, "sextuple": 6}
"""Domains with more holes."""

_ELL = [[-3, -3], [3, -3], [3, 0], [0, 0], [0, 3], [-3, 3]]


def circle(n: int, radius: float, centre: complex = 0, turn: float = 0) -> Array:
    """(n, 2) vertices of a regular polygon."""
    z = centre + radius * np.exp(1j * (2 * np.pi * np.arange(n) / n + turn))
    return np.stack([z.real, z.imag], axis=-1)


@functools.cache
def domain(name: str) -> Domain:
    """A domain by its name. The `annulus` has many vertices."""
    if name == "ell":
        return Domain.from_cage(Cage(_ELL), 0.3)
    if name == "ring":
        exterior, hole = circle(8, 3.0, turn=0.1), circle(8, 1.2, turn=0.3)
        return Domain(Cage(exterior, [hole]), Cage(exterior * 1.1, [hole * 0.8]), [[0.05, -0.03]])
    if name == "twin":
        exterior = np.array(
            [[-4, -2], [0, -2.2], [4, -2], [4.2, 0], [4, 2], [0, 1.7], [-4, 2], [-4.1, 0.1]]
        )
        centres, turns = (-2, 2.1), (0.2, 0.7)
        large, small = (
            [circle(4, r, c, t) for c, t in zip(centres, turns, strict=True)] for r in (0.9, 0.6)
        )
        return Domain(
            Cage(exterior, large), Cage(exterior * 1.1, small), [[-2, 0.05], [2.1, -0.04]]
        )
    if name == "triple":
        holes = [circle(3, 0.7, 2 * np.exp(2j * k), 0.4 * k) for k in range(3)]
        return Domain.from_cage(Cage(circle(9, 4.0), holes), 0.15)
    if name in MANY_HOLES:
        count = MANY_HOLES[name]
        holes = [circle(3, 0.45, 2.4 * np.exp(2j * np.pi * k / count)) for k in range(count)]
        return Domain.from_cage(Cage(circle(9, 4.0), holes), 0.15)
    if name == "annulus":
        exterior, hole = circle(24, 3.0), circle(24, 1.2)
        return Domain(Cage(exterior, [hole]), Cage(exterior * 1.15, [hole * 0.7]), [[0.1, 0]])
    raise KeyError(name)


def reference(map: HarmonicMap) -> ReferenceMap:
    """The same map in plain NumPy."""
    return ReferenceMap(
        map.domain.offset_cage.loops_complex,
        map.domain.hole_points @ np.array([1, 1j]),
        map.phi,
        map.psi,
    )


@functools.cache
def dense_check(name: str, count: int = 200_000) -> DenseCheck:
    """2 x 10^5 points on the boundary and inside."""
    d = domain(name)
    return DenseCheck.on(
        d.cage.loops_complex, d.offset_cage.loops_complex, d.hole_points @ np.array([1, 1j]), count
    )


def random_map(name: str, size: float, seed: int) -> HarmonicMap:
    """The identity with random coefficients of about the given size added to all of its own."""
    d = domain(name)
    rng = np.random.default_rng(seed)
    n, n_holes = d.n_coefficients, d.n_holes
    change = rng.normal(size=(2, n)) + 1j * rng.normal(size=(2, n))
    phi, psi = HarmonicMap.identity(d).phi + size * change[0], size * change[1]
    psi[n - n_holes :] = phi[n - n_holes :].conj()
    return HarmonicMap(d, phi, psi)


def turned(map: HarmonicMap, angle: float, by: complex = 0) -> HarmonicMap:
    """The map, then a rotation and a translation."""
    turn, phi = np.exp(1j * angle), map.phi.copy()
    phi *= turn
    phi[: len(map.domain.offset_cage.exterior)] += by
    return HarmonicMap(map.domain, phi, map.psi / turn)


def divided(domain: Domain, pieces: Callable[[int], Array]) -> Domain:
    """The same domain, with each edge of both cages cut into pieces. ``pieces(n)`` gives their
    numbers for the n edges of a loop."""
    counts = [pieces(len(loop)) for loop in domain.cage.loops]

    def finer(cage: Cage) -> Cage:
        ends = zip(cage.loops_complex, counts, strict=True)
        exterior, *holes = (real(subdivided(loop, count)) for loop, count in ends)
        return Cage(exterior, holes)

    return Domain(finer(domain.cage), finer(domain.offset_cage), domain.hole_points)


def real(z: Array) -> Array:
    """(k, 2) points from complex numbers."""
    return np.stack([np.real(z), np.imag(z)], axis=-1)
