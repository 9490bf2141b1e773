"""The allowance for rounding: large enough, and not wildly larger."""

from __future__ import annotations

import jax
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb.certificate import certify, rounding
from glid_nb.geometry import graded_panels
from glid_nb.harmonic import HarmonicMap, basis_of
from glid_nb.harmonic.cauchy import rounding_scale

from ..domains import domain, random_map
from ..reference_map import cauchy_first, cauchy_second

scale_of = jax.jit(rounding_scale)
panel_scale = jax.jit(rounding.panel_scale)


def translated(map: HarmonicMap, shift: complex) -> HarmonicMap:
    phi = map.phi.copy()
    phi[: len(map.domain.offset_cage.loops_complex[0])] += shift
    return HarmonicMap(map.domain, phi, map.psi)


def extended(name: str) -> tuple[list[np.ndarray], np.ndarray]:
    d = domain(name)
    loops = [loop.astype(np.clongdouble) for loop in d.offset_cage.loops_complex]
    rho = (d.hole_points @ np.array([1, 1j])).astype(np.clongdouble)
    return loops, rho


@pytest.mark.parametrize("name", ["ell", "ring", "twin"])
def test_the_scale_bounds_the_sum_of_all_terms(name: str) -> None:
    d = domain(name)
    z = graded_panels(d).start
    with jax.enable_x64(True):
        first, second = map(np.asarray, scale_of(z, basis_of(d).singularities))
    rho = d.hole_points @ np.array([1, 1j])
    for scale, matrix in ((first, cauchy_first), (second, cauchy_second)):
        terms = np.abs(matrix(z, d.offset_cage.loops_complex, rho)).sum(axis=1)
        assert (terms <= scale * (1 + 1e-12)).all()
        assert (scale <= 100 * terms).all()


@pytest.mark.slow
@pytest.mark.skipif(
    np.finfo(np.longdouble).nmant <= 52, reason="extended precision is no wider than double here"
)
@given(
    name=st.sampled_from(["ell", "ring"]),
    size=st.floats(0, 1),
    shift=st.sampled_from([0, 1e3, 1e6j, -1e9]),
    seed=st.integers(0, 10**6),
)
@settings(max_examples=8)
def test_the_slack_bounds_the_actual_rounding(
    name: str, size: float, shift: complex, seed: int
) -> None:
    """f_z and f_z' as computed against extended precision."""
    map = translated(random_map(name, size, seed), shift)
    panels = graded_panels(map.domain)
    basis = basis_of(map.domain)
    largest = max(np.abs(map.phi).max(), np.abs(map.psi).max())
    with jax.enable_x64(True):
        scale = np.asarray(panel_scale(panels.start, panels.end, basis.singularities))
    slack = rounding.slack_factor(basis.n_columns) * scale * largest

    loops, rho = extended(name)
    z = panels.start.astype(np.clongdouble)
    exact = cauchy_first(z, loops, rho) @ map.phi.astype(np.clongdouble)
    slope = panels.length * (cauchy_second(z, loops, rho) @ map.phi.astype(np.clongdouble))
    value, _ = map.wirtinger(panels.start)
    computed_slope = panels.length * map.wirtinger_derivatives(panels.start, 1)[0]
    assert (np.abs(value - exact) <= slack).all()
    assert (np.abs(computed_slope - slope) <= slack).all()


def test_the_slack_is_positive_and_grows_with_the_coefficients() -> None:
    identity = HarmonicMap.identity(domain("ring"))
    previous = 0.0
    for shift in (0, 1e2, 1e4, 1e6):
        c = certify(translated(identity, shift))
        assert c.certified
        loss = c.sigma1_upper - c.sigma2_lower
        # The true singular values are exactly 1, and k is 0.
        assert c.sigma2_lower < 1 < c.sigma1_upper
        assert c.k_upper > 0
        assert loss > 3 * previous
        previous = loss
    assert previous < 1e-4


def test_more_columns_need_more_slack() -> None:
    assert rounding.slack_factor(10) > 10 * 2.0**-53
    assert rounding.slack_factor(1000) > 2 * rounding.slack_factor(100)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["hermite", "lipschitz"])
def test_a_map_moved_far_away_is_decided_quickly(kind: str) -> None:
    """Rounding alone keeps the bounds from the tightness asked; splitting cannot help it."""
    map = translated(HarmonicMap.identity(domain("ring")), 1e8)
    c = certify(map, kind)
    assert c.certified
    assert c.sigma2_lower < 1 < c.sigma1_upper
    assert len(c.panels) < 10_000


def test_rounding_never_makes_a_claim() -> None:
    """So far away that f_z is noise, neither injective nor folded is proved."""
    map = translated(HarmonicMap.identity(domain("ring")), 1e17)
    c = certify(map, refine=False)
    assert not c.certified
    assert "Undecided" in c.reason
    assert c.sigma2_lower <= 1 <= c.sigma1_upper
