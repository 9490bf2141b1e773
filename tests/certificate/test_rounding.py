"""The allowance for rounding is large enough, and not far too large."""

from __future__ import annotations

import jax
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb._features import enable_x64
from glid_nb.certificate import certify, rounding
from glid_nb.energies import as_energy
from glid_nb.geometry import graded_panels, uniform_panels
from glid_nb.harmonic import HarmonicMap, basis_of, cauchy
from glid_nb.pose import Pose
from glid_nb.solvers import evaluation
from glid_nb.solvers.discretisation import discretise
from glid_nb.solvers.positional import positional_energy
from glid_nb.solvers.problem import (
    SubspaceProblem,
    anchor_of,
    real_coefficients,
    unknowns_of,
)

from ..support.domains import domain, random_map
from ..support.reference_map import cauchy_first, cauchy_second

scale_of = jax.jit(rounding.term_scale)
panel_scale = jax.jit(rounding.panel_scale)


@jax.jit
def derivatives(z, coefficients, singularities):
    edges = cauchy.edge_coefficients(coefficients, singularities)
    return rounding.derivatives(z, edges, singularities)


def translated(map: HarmonicMap, shift: complex) -> HarmonicMap:
    phi = map.phi.copy()
    phi[: len(map.domain.offset_cage.loops_complex[0])] += shift
    return HarmonicMap(map.domain, phi, map.psi)


def extended_loops(name: str) -> tuple[list[np.ndarray], np.ndarray]:
    d = domain(name)
    return list(d.offset_cage.loops_complex), d.hole_points @ np.array([1, 1j])


def extended(name: str) -> tuple[list[np.ndarray], np.ndarray]:
    d = domain(name)
    loops = [loop.astype(np.clongdouble) for loop in d.offset_cage.loops_complex]
    rho = (d.hole_points @ np.array([1, 1j])).astype(np.clongdouble)
    return loops, rho


@pytest.mark.parametrize("name", ["ell", "ring", "twin"])
def test_the_scale_bounds_the_sum_of_all_terms(name: str) -> None:
    d = domain(name)
    z = graded_panels(d).start
    with enable_x64():
        first, second = map(np.asarray, scale_of(z, basis_of(d).singularities))
    rho = d.hole_points @ np.array([1, 1j])
    for scale, matrix in ((first, cauchy_first), (second, cauchy_second)):
        terms = np.abs(matrix(z, d.offset_cage.loops_complex, rho)).sum(axis=1)
        assert (terms <= scale * (1 + 1e-12)).all()
        assert (scale <= 10 * terms).all()


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
    """Against extended precision: sums over edges as `certify` does, over D as a solver does."""
    map = translated(random_map(name, size, seed), shift)
    panels = graded_panels(map.domain)
    basis = basis_of(map.domain)
    padded = np.stack([basis.pad(map.phi), basis.pad(map.psi)])
    first = len(map.domain.offset_cage.loops_complex[0])
    local = map.phi - np.where(np.arange(len(map.phi)) < first, map.phi[:first].mean(), 0)
    with enable_x64():
        singular = basis.singularities
        by_edges = [np.asarray(a)[0] for a in derivatives(panels.start, padded, singular)]
        scale = np.asarray(panel_scale(panels.start, panels.end, singular))
        d = np.asarray(jax.jit(cauchy.first_derivatives)(panels.start, singular))
    by_d = d @ basis.pad(local)

    loops, rho = extended(name)
    z = panels.start.astype(np.clongdouble)
    # Without this translation, the sums in extended precision would cancel, too.
    phi = map.phi.astype(np.clongdouble)
    phi[:first] -= phi[0]
    exact = cauchy_first(z, loops, rho) @ phi
    slope = cauchy_second(z, loops, rho) @ phi
    value, derivative, off, derivative_off = by_edges
    assert (np.abs(value - exact) <= off).all()
    assert (np.abs(derivative - slope) <= derivative_off).all()
    rounded = 8 * rounding.UNIT_ROUNDOFF * scale * np.abs(map.phi).max()
    slack = rounding.slack_factor(basis.n_columns) * scale * np.abs(local).max()
    assert (np.abs(by_d - exact) <= slack + rounded).all()
    assert off.max() < 1e-11 * (1 + np.abs(local).max())


def test_a_translation_costs_nothing_but_the_rounding_of_coefficients() -> None:
    identity = HarmonicMap.identity(domain("ring"))
    for shift in (0, 1e2, 1e4, 1e6):
        c = certify(translated(identity, shift))
        assert c.certified
        assert c.k_upper > 0
        assert 0 < c.sigma1_upper - c.sigma2_lower < 1e-12 + 16 * np.spacing(shift)


@pytest.mark.parametrize("shift", [0, 1e3, 1e6])
def test_the_loop_counts_differences_too(shift: float) -> None:
    """The largest coefficient that a solver's slack is relative to, translated far away."""
    disc = discretise(domain("ring"))
    map = translated(random_map("ring", 0.1, 1), shift)
    pose = Pose([(2.2, 0.5)], [(2.2, 0.5)])
    problem = SubspaceProblem(
        disc.matrices,
        disc.basis.singularities,
        unknowns_of(disc.basis, False),
        positional_energy(map, pose, 1.0),
        as_energy(None),
    )
    with enable_x64():
        y = real_coefficients(map)
        problem = problem._replace(anchor=anchor_of(disc.basis, y))
        reach = float(evaluation.reach(problem, y))
        samples = evaluation.products(disc.matrices, y - problem.anchor)
    assert reach < 5 + 0.1 * shift
    panels = disc.panels
    fz, _ = map.wirtinger(panels.start)
    computed = np.asarray(samples.values)[:2, : len(panels)]
    slack = np.asarray(disc.matrices.rounding)[: len(panels)] * reach
    assert (np.abs(computed[0] + 1j * computed[1] - fz) < slack).all()


def test_more_columns_need_more_slack() -> None:
    assert rounding.slack_factor(10) > 10 * 2.0**-53
    assert rounding.slack_factor(1000) > 2 * rounding.slack_factor(100)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["hermite", "lipschitz"])
def test_a_map_moved_far_away_is_decided_quickly(kind: str) -> None:
    """Rounding alone prevents the requested tightness. Splitting panels cannot help."""
    map = translated(HarmonicMap.identity(domain("ring")), 1e8)
    c = certify(map, kind)
    assert c.certified
    assert c.sigma2_lower < 1 < c.sigma1_upper
    assert len(c.panels) < 10_000


def test_bounds_are_those_of_the_rounded_coefficients() -> None:
    """So far from the origin, the coefficients are inaccurate, and the bounds show it."""
    map = translated(HarmonicMap.identity(domain("ring")), 1e15)
    c = certify(map)
    local = map.phi.copy()
    local[:8] -= map.phi[0]  # exact
    d = cauchy_first(uniform_panels(map.domain.cage, 2000).start, *extended_loops("ring"))
    f, g = np.abs(d @ local), np.abs(d @ map.psi)
    assert (f - g).max() > 1.01
    assert c.sigma2_lower <= (f - g).min()
    assert (f + g).max() <= c.sigma1_upper


@pytest.mark.parametrize("size", [1e-300, 1e-160, 1e-8, 1e8, 1e90, 1e119])
def test_a_map_of_any_size_is_certified_or_refused(size: float) -> None:
    identity = HarmonicMap.identity(domain("ring"))
    c = certify(HarmonicMap(identity.domain, size * identity.phi, identity.psi))
    assert c.certified == (size > 1e-100)
    assert not np.isnan([c.sigma2_lower, c.sigma1_upper, c.k_upper]).any()
    assert c.sigma2_lower <= size <= c.sigma1_upper


def test_fast_math_proves_nothing() -> None:
    """The allowed errors do not hold for sums in another order."""
    exact = jax.jit(rounding.allowance)
    options = {"xla_cpu_enable_fast_math": True}
    fast = jax.jit(rounding.allowance, compiler_options=options)
    with enable_x64():
        for probe in (1.0, 1.7, 3e-200, 5e200):
            assert np.isfinite(exact(np.ones(4), np.float64(probe))).all()
            assert np.isinf(fast(np.ones(4), np.float64(probe))).all()
