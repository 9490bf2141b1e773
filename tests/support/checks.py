"""Checking a solve's result independently of the code under test."""

from __future__ import annotations

import functools
from collections.abc import Sequence

import numpy as np

from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.solvers import Result

from .reference_map import DenseCheck, Measured


@functools.lru_cache(maxsize=4)
def _points(domain: Domain, count: int) -> DenseCheck:
    return DenseCheck.on(
        domain.cage.loops_complex,
        domain.offset_cage.loops_complex,
        domain.hole_points @ np.array([1, 1j]),
        count,
    )


def measured(map: HarmonicMap, count: int = 200_000) -> Measured:
    """Extremes of the distortion over about ``count`` points, in plain NumPy."""
    return _points(map.domain, count).measure(map.phi, map.psi)


def check_certified(result: Result, count: int = 50_000) -> None:
    """The energies are finite, the map is proved injective, and the proof holds densely."""
    for value in (result.energy, result.energy_distortion, result.energy_p2p):
        assert np.isfinite(value)
    certificate = result.certificate
    assert certificate.certified, certificate.reason
    dense = measured(result.map, count)
    assert dense.sigma2 >= certificate.sigma2_lower > 0
    assert dense.sigma1 <= certificate.sigma1_upper
    assert dense.k <= certificate.k_upper < 1
    assert dense.windings == certificate.windings
    assert certificate.winding == 0


Turn = tuple[list[int], complex, float]


def turned(points: np.ndarray, turns: Sequence[Turn]) -> np.ndarray:
    """Points of which some turn about a pivot by degrees, then others."""
    z = points @ np.array([1, 1j])
    for who, pivot, degrees in turns:
        z[who] = pivot + np.exp(1j * np.deg2rad(degrees)) * (z[who] - pivot)
    return np.stack([z.real, z.imag], axis=1)
