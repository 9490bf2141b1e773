"""Domains of any size, far from the origin, with tiny offsets: certified or refused, never wrong.

The reference is f_z, summed by Arb at points of the exact edges.
"""

from __future__ import annotations

from typing import Any

import flint
import numpy as np
import pytest
from flint import acb, arb
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb.certificate import PROOFS, certify
from glid_nb.geometry import Cage, Domain, GeometryError
from glid_nb.harmonic import HarmonicMap

from ..support.domains import circle

pytestmark = pytest.mark.slow

_ELL = np.array([[-3.0, -3], [3, -3], [3, 0], [0, 0], [0, 3], [-3, 3]])


def exact(z: complex) -> acb:
    return acb(float(z.real), float(z.imag))


def derivatives(map: HarmonicMap, z: acb) -> tuple[arb, arb]:
    """|f_z| and |f_zbar|, enclosed."""
    sums = [acb(0), acb(0)]
    first = 0
    for loop in map.domain.offset_cage.loops_complex:
        b = [exact(v) - z for v in loop]
        for j in range(len(loop)):
            k = (j + 1) % len(loop)
            log = (b[k] / b[j]).log() / (b[k] - b[j])
            for i, c in enumerate((map.phi, map.psi)):
                sums[i] += (exact(c[first + k]) - exact(c[first + j])) * log
        first += len(loop)
    sums = [s / (2 * acb.pi() * acb(0, 1)) for s in sums]
    for rho, phi, psi in zip(
        map.domain.hole_points_complex, map.phi[first:], map.psi[first:], strict=True
    ):
        sums[0] += exact(phi) / (z - exact(rho))
        sums[1] += exact(psi) / (z - exact(rho))
    return abs(sums[0]), abs(sums[1])


@settings(max_examples=40)
@given(
    st.integers(-8, 8),
    st.sampled_from([0.0, 0.0, 1.0, 1e3, 1e6, -1e6]),
    st.sampled_from([None, 0.1, 1e-3, 1e-6, 1e-9]),
    st.floats(-4, 0.3),
    st.booleans(),
    st.sampled_from(list(PROOFS)),
    st.integers(0, 10**6),
)
def test_what_is_certified_is_true(
    exponent: int,
    shift: float,
    offset: float | None,
    rough: float,
    hole: bool,
    kind: Any,
    seed: int,
) -> None:
    rng = np.random.default_rng(seed)
    scale, turn = 10.0**exponent, np.exp(1j * rng.uniform(0, 7))
    turned = (_ELL @ [1, 1j]) * turn * scale + shift
    corners = np.stack([turned.real, turned.imag], axis=1)
    centre = -1.5 * (1 + 1j) * turn * scale + shift
    holes = [circle(4, 0.7 * scale, centre)] if hole else []
    try:
        domain = Domain.from_cage(Cage(corners, holes), offset and offset * scale)
    except GeometryError:
        return  # rounding of the coordinates leaves no such shape
    identity, n = HarmonicMap.identity(domain), domain.n_coefficients
    noise = (rng.normal(size=(2, n)) + 1j * rng.normal(size=(2, n))) * scale * 10.0**rough
    phi, psi = identity.phi + noise[0], noise[1]
    if hole:
        psi[-1] = phi[-1].conj()
    map = HarmonicMap(domain, phi, psi)
    c = certify(map, kind)
    assert not np.isnan([c.sigma2_lower, c.sigma1_upper, c.k_upper]).any()
    assert not c.certified or (sum(c.windings) == 0 and c.k_upper <= 1)
    flint.ctx.prec = 200
    for loop in domain.cage.loops_complex:
        for a, b in zip(loop, np.roll(loop, -1), strict=True):
            for t in rng.uniform(0, 1, 2):
                f, g = derivatives(map, exact(a) + arb(t) * (exact(b) - exact(a)))
                assert not c.sigma2_lower > f - g
                assert not c.sigma1_upper < f + g
                if c.certified:
                    assert f > g
                    assert not c.k_upper < g / f


@pytest.mark.parametrize("scale", [1e-8, 1.0, 1e8])
@pytest.mark.parametrize("shift", [0.0, 1e6])
def test_size_and_place_cost_nothing_where_coordinates_resolve_them(
    scale: float, shift: float
) -> None:
    """Coordinates of a shape of the size 6 s at 10^6 s have an ulp of 2e-11 of its size."""
    cage = Cage((_ELL + shift) * scale)
    c = certify(HarmonicMap.identity(Domain.from_cage(cage, 0.3 * scale)))
    assert c.certified
    assert c.sigma2_lower > 1 - 1e-12 - 1e-6 * (shift > 0)
