"""The Hermite-Bernstein certificate on single panels."""

from __future__ import annotations

from math import comb
from typing import Any

import jax
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb._features import enable_x64
from glid_nb.certificate import Hermite, PanelBounds, hermite
from glid_nb.certificate.paper import derivative_bound_weights, distances
from glid_nb.geometry import graded_panels
from glid_nb.harmonic import basis_of, cauchy
from glid_nb.harmonic.cauchy import Singularities

from ..support.domains import random_map, reference
from ..support.reference_map import cauchy_first, holomorphic_derivative
from .panel_values import PANELS, T, change_of_argument, end_values, polynomials, seeds, values

bounds_of = jax.jit(Hermite.bounds)


def bounds(f: np.ndarray, g: np.ndarray, e_f: Any, e_g: Any) -> PanelBounds:
    with enable_x64():
        remainder = np.stack([np.full(PANELS, e_f), np.full(PANELS, e_g)])
        got = bounds_of(end_values(f), end_values(g), remainder)
        return PanelBounds(*map(np.asarray, got))


@pytest.mark.slow
@given(drawn=seeds, errors=st.tuples(*[st.one_of(st.just(0.0), st.floats(1e-6, 0.3))] * 2))
@settings(max_examples=50)
def test_bounds_hold_for_everything_within_the_remainder(
    drawn: tuple[int, float, float], errors: tuple[float, float]
) -> None:
    """The worst functions within e_f of a cubic p and within e_g of a cubic q."""
    f, g = polynomials(drawn, 3)
    e_f, e_g = errors
    got = bounds(f, g, e_f, e_g)
    p, q = np.abs(values(f)), np.abs(values(g))
    thin = np.maximum(p - e_f, 0)
    assert (got.sigma1_upper >= (p + e_f + q + e_g).max(axis=1) - 1e-12).all()
    with np.errstate(divide="ignore", invalid="ignore"):
        worst = np.where(thin > 0, (q + e_g) / thin, np.inf).max(axis=1)
    assert (got.k_upper >= worst * (1 - 1e-12)).all()
    positive = got.sigma2_lower > 0
    true = (p - e_f - q - e_g).min(axis=1)
    assert (got.sigma2_lower <= true + 1e-12)[positive].all()
    assert (true > 0)[positive].all()


@given(drawn=seeds)
@settings(max_examples=40)
def test_the_bound_on_sigma2_holds_on_folded_panels(drawn: tuple[int, float, float]) -> None:
    """`PanelBounds` are proved on the whole panel, also those that are negative."""
    f, g = polynomials(drawn, 3)
    got = bounds(f, 3 * g, 0.0, 0.0)
    true = (np.abs(values(f)) - np.abs(values(3 * g))).min(axis=1)
    assert (got.sigma2_lower <= true + 1e-12).all()


@given(drawn=seeds, e_f=st.one_of(st.just(0.0), st.floats(1e-4, 0.5)))
@settings(max_examples=50)
def test_a_known_turning_is_the_change_of_the_argument(
    drawn: tuple[int, float, float], e_f: float
) -> None:
    f, g = polynomials(drawn, 3)
    got = bounds(f, g, e_f, 0.0)
    path = values(f)
    known = np.asarray(got.turning_known)
    np.testing.assert_allclose(got.turning[known], change_of_argument(path)[known], atol=1e-9)
    assert (np.abs(path).min(axis=1) > e_f)[known].all()


def test_turning_is_known_where_little_turns() -> None:
    """The winding is unknown if f_z runs around 0, even if its ends agree."""
    t = np.array([[1, 0.5j, 0, 0]] * PANELS)
    assert bounds(t, 0 * t, 0.1, 0.0).turning_known.all()
    loop = np.array([[1, -6 + 3j, 6 - 9j, 6j]] * PANELS)  # from 1 to 1 past -0.5
    path = values(loop)
    assert abs(change_of_argument(path)[0]) > 6
    assert not bounds(loop, 0 * loop, 0.0, 0.0).turning_known.any()


def test_bounds_are_sharp_for_slowly_varying_values() -> None:
    f = np.array([[2, 0.1, 0.05j, 0.02]] * PANELS)
    g = np.array([[0.5j, 0.1j, 0.02, 0]] * PANELS)
    got = bounds(f, g, 0.0, 0.0)
    p, q = np.abs(values(f)), np.abs(values(g))
    np.testing.assert_allclose(got.sigma2_lower, (p - q).min(axis=1), rtol=0.06)
    np.testing.assert_allclose(got.sigma1_upper, (p + q).max(axis=1), rtol=0.01)
    np.testing.assert_allclose(got.k_upper, (q / p).max(axis=1), rtol=0.05)


@pytest.mark.parametrize("where", ["start", "inside", "everywhere"])
def test_zeros_of_fz_are_never_injective(where: str) -> None:
    zero = {"start": 0.0, "inside": 0.5, "everywhere": None}[where]
    row = [0, 0, 0, 0] if zero is None else [-zero, 1, 0, 0]
    f = np.array([row] * PANELS, dtype=complex)
    for g in (0 * f, 0.5 * f):
        got = bounds(f, g, 0.0, 0.0)
        assert not got.injective.any()
        assert not (got.sigma2_lower > 0).any()
        assert (got.k_upper == np.inf).all()


def test_bernstein_coefficients_are_those_of_the_squared_modulus() -> None:
    """B-form of |cubic|^2: sum_i b_i C(6, i) t^i (1 - t)^(6 - i)."""
    rng = np.random.default_rng(0)
    control = [rng.normal(size=PANELS) + 1j * rng.normal(size=PANELS) for _ in range(4)]

    def bernstein(points: list[Any]) -> Any:
        n = len(points) - 1
        return sum(
            np.asarray(b)[:, None] * comb(n, i) * T**i * (1 - T) ** (n - i)
            for i, b in enumerate(points)
        )

    with enable_x64():
        square = hermite.squared_modulus(control)
        halves = hermite.halved(control)
    np.testing.assert_allclose(bernstein(square), np.abs(bernstein(control)) ** 2, rtol=1e-12)
    left, right = (bernstein(half) for half in halves)
    whole = [np.asarray(c) for c in control]
    exact = np.concatenate([left[:, ::2], right[:, 2::2]], axis=1)
    np.testing.assert_allclose(exact, bernstein(whole), rtol=1e-12, atol=1e-14)


def panel_remainders(name: str, size: float, seed: int) -> tuple[np.ndarray, ...]:
    """Panels of a domain, |f_z - p| on them, and what the certificate allows for."""
    map = random_map(name, size, seed)
    panels = graded_panels(map.domain)
    basis = basis_of(map.domain)
    coefficients = np.stack([basis.pad(map.phi), basis.pad(map.psi)])

    @jax.jit
    def allowed(start: Any, end: Any) -> Any:
        proof = Hermite.on(start, end, basis.singularities)
        return proof.remainder(coefficients, basis.singularities).T

    with enable_x64():
        remainder = np.asarray(allowed(panels.start, panels.end))
    yardstick = reference(map)
    loops, rho = yardstick.loops, yardstick.rho
    t = np.linspace(0, 1, 9)
    chord = panels.end - panels.start
    z = panels.start[:, None] + chord[:, None] * t
    d = cauchy_first(z.ravel(), loops, rho)
    radius = 0.1
    errors = []
    for c in (map.phi, map.psi):
        dense = (d @ c).reshape(z.shape)
        slopes = [
            chord * holomorphic_derivative(lambda w, c=c: cauchy_first(w, loops, rho) @ c, end, 1,
                                           radius, 32)
            for end in (panels.start, panels.end)
        ]  # fmt: skip
        h = [2 * t**3 - 3 * t**2 + 1, -2 * t**3 + 3 * t**2, t**3 - 2 * t**2 + t, t**3 - t**2]
        ends = [dense[:, 0], dense[:, -1], *slopes]
        p = sum(e[:, None] * basis_function for e, basis_function in zip(ends, h, strict=True))
        errors.append(np.abs(dense - p).max(axis=1))
    return np.stack(errors, axis=1), remainder


@pytest.mark.slow
@pytest.mark.parametrize(("name", "size"), [("ell", 0.5), ("ring", 0.2), ("twin", 0.05)])
def test_the_interpolants_lie_within_the_remainder(name: str, size: float) -> None:
    errors, remainder = panel_remainders(name, size, 9)
    assert (errors <= remainder + 1e-11).all()
    # On some panel most of the remainder is used, so a much smaller one would be wrong.
    assert (errors / remainder).max() > 0.1


def singularities(vertices: Any, rho: Any) -> Singularities:
    n = len(vertices)
    index = np.arange(n)
    return Singularities(
        np.array(vertices, dtype=complex),
        np.roll(index, -1),
        np.roll(index, 1),
        np.array(rho, dtype=complex),
    )


FAR = [1e6, 1e6j, -1e6]


@pytest.mark.slow
@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize(
    ("vertices", "rho", "coefficients", "gap"),
    [
        (FAR, [0.0], [0, 0, 0, 1.0], 0.3),  # a hole alone
        ([0, 5, 5j], [], [1.0, 0, 0], 0.01),  # a vertex that is much nearer than the others
    ],
    ids=["hole", "vertex"],
)
def test_the_bound_on_derivatives_is_attained(
    order: int, vertices: list[complex], rho: list[complex], coefficients: list[float], gap: float
) -> None:
    """Next to one singularity the constants are tight: any smaller one is wrong."""
    s = singularities(vertices, rho)
    near = -gap if rho == [] else gap
    start, end = np.full(4, near + 0j), np.full(4, near * 1.5 + 0j)
    phi = np.array(coefficients, dtype=complex)
    with enable_x64():
        jumps = abs(np.asarray(cauchy.slope_jumps(phi, s)))
        bound = np.asarray(jax.jit(derivative_bound_weights, static_argnums=3)(
            start, end, s, order)) @ jumps  # fmt: skip

    def f(z: np.ndarray) -> np.ndarray:
        return cauchy_first(z, [np.array(vertices, dtype=complex)], np.array(rho)) @ phi

    true = np.abs(holomorphic_derivative(f, start[:1], order, gap / 3))[0] * (gap / 2) ** order
    assert true <= bound[0] * (1 + 1e-9)
    assert true >= bound[0] * 0.95


@pytest.mark.slow
@pytest.mark.parametrize("order", [2, 4])
def test_the_bound_on_derivatives_holds_along_whole_panels(order: int) -> None:
    map = random_map("twin", 0.3, 2)
    panels = graded_panels(map.domain)
    basis = basis_of(map.domain)
    with enable_x64():
        weights = jax.jit(derivative_bound_weights, static_argnums=3)(
            panels.start, panels.end, basis.singularities, order
        )
        jumps = abs(np.asarray(cauchy.slope_jumps(basis.pad(map.phi), basis.singularities)))
    bound = np.asarray(weights) @ jumps
    t = np.linspace(0, 1, 7)
    z = panels.start[:, None] + (panels.end - panels.start)[:, None] * t
    yardstick = reference(map)
    true = np.abs(holomorphic_derivative(yardstick.fz, z.ravel(), order, 0.06)).reshape(z.shape)
    true *= panels.length[:, None] ** order
    assert (true.max(axis=1) <= bound * (1 + 1e-6) + 1e-6).all()


def test_distances_are_those_to_the_segment() -> None:
    rng = np.random.default_rng(1)
    start, end = (rng.normal(size=6) + 1j * rng.normal(size=6) for _ in range(2))
    end[0] = start[0]
    s = singularities(rng.normal(size=4) + 1j * rng.normal(size=4), [0.3])
    with enable_x64():
        got = np.asarray(jax.jit(distances)(start, end, s))
    t = np.linspace(0, 1, 20001)
    on = start[:, None] + (end - start)[:, None] * t
    points = np.concatenate([s.vertices, s.hole_points])
    for j, point in enumerate(points):
        np.testing.assert_allclose(got[:, j], np.abs(on - point).min(axis=1), rtol=1e-3, atol=1e-4)
        assert (got[:, j] <= np.abs(on - point).min(axis=1) * (1 + 1e-14)).all()
