"""Within the safe radius every map is locally injective: against dense evaluation."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb.certificate import safe_radius
from glid_nb.certificate.certify import CertificateError
from glid_nb.harmonic import HarmonicMap

from ..support.domains import NAMES, dense_check, domain, random_map


def field(name: str, size: float, seed: int) -> HarmonicMap:
    moved, rest = random_map(name, size, seed), HarmonicMap.identity(domain(name))
    return HarmonicMap(moved.domain, moved.phi - rest.phi, moved.psi - rest.psi)


@pytest.mark.slow
@given(st.sampled_from(NAMES), st.floats(1e-3, 1e3), st.integers(0, 10**6))
@settings(max_examples=10)
def test_maps_within_it_do_not_fold(name: str, size: float, seed: int) -> None:
    map, along = random_map(name, 0.003, seed), field(name, size, seed + 1)
    radius, dense = safe_radius(map, along), dense_check(name, 4000)
    assert radius > 0
    for t in radius * np.linspace(-0.999, 0.999, 9):
        assert dense.measure(map.phi + t * along.phi, map.psi + t * along.psi).sigma2 > 0
    far = [
        dense.measure(map.phi + t * along.phi, map.psi + t * along.psi).sigma2
        for t in (-1.5 * radius, 1.5 * radius)
    ]
    assert min(far) < 0.5  # it is not much too small


def test_it_has_the_unit_of_the_field() -> None:
    map, along = random_map("ring", 0.003, 5), field("ring", 1.0, 6)
    twice = HarmonicMap(along.domain, 2 * along.phi, 2 * along.psi)
    assert safe_radius(map, twice) == pytest.approx(safe_radius(map, along) / 2, rel=1e-3)


def test_its_limits() -> None:
    rest = HarmonicMap.identity(domain("ring"))
    nothing = HarmonicMap(rest.domain, 0 * rest.phi, 0 * rest.psi)
    assert safe_radius(rest, nothing) == np.inf
    assert safe_radius(nothing, rest) == 0
    assert safe_radius(rest, rest) == pytest.approx(1, rel=0.01)  # at -1 all is one point
    with pytest.raises(CertificateError, match="different domains"):
        safe_radius(rest, HarmonicMap.identity(domain("twin")))
