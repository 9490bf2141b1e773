"""The paper's certificate on single panels (Section 8, Appendix H)."""

from __future__ import annotations

import jax
import numpy as np
from hypothesis import given, settings

from glid_nb._features import enable_x64
from glid_nb.certificate import Lipschitz, PanelBounds
from glid_nb.harmonic.cauchy import Singularities

from .panel_values import (
    PANELS,
    change_of_argument,
    derivative,
    end_values,
    polynomials,
    seeds,
    values,
)

bounds_of = jax.jit(Lipschitz.bounds)


def curvature(coefficients: np.ndarray) -> np.ndarray:
    """The largest modulus of the second derivative on each panel."""
    return np.abs(values(derivative(derivative(coefficients)))).max(axis=1)


def bounds(f: np.ndarray, g: np.ndarray, share: float = 1.0) -> PanelBounds:
    """Bounds with l^2 / 2 times the exact bound on the second derivative, l = 1."""
    with enable_x64():
        remainder = np.stack([share * curvature(c) / 2 for c in (f, g)])
        return PanelBounds(*map(np.asarray, bounds_of(end_values(f), end_values(g), remainder)))


@given(drawn=seeds)
@settings(max_examples=50)
def test_bounds_hold_on_the_whole_panel(drawn: tuple[int, float, float]) -> None:
    f, g = polynomials(drawn, 4)
    got = bounds(f, g)
    p, q = np.abs(values(f)), np.abs(values(g))
    assert (got.sigma2_lower <= (p - q).min(axis=1) + 1e-12).all()
    assert (got.sigma1_upper >= (p + q).max(axis=1) - 1e-12).all()
    assert (got.k_upper >= (q / p).max(axis=1) * (1 - 1e-12)).all()


@given(drawn=seeds)
@settings(max_examples=50)
def test_a_known_turning_is_the_change_of_the_argument(drawn: tuple[int, float, float]) -> None:
    """Theorem 8.1."""
    f, g = polynomials(drawn, 4)
    got = bounds(f, g)
    known = got.turning_known
    path = values(f)
    np.testing.assert_allclose(got.turning[known], change_of_argument(path)[known], atol=1e-9)
    assert (np.abs(path).min(axis=1) > 0)[known].all()


def test_it_is_condition_27() -> None:
    """sigma_2(v_i) + sigma_2(v_{i+1}) >= (L_fz + L_fzbar) l, with the constants written out."""
    f, g = polynomials((5, 1.0, 0.5), 4)
    got = bounds(f, g)
    fz, fzb_conj = end_values(f), end_values(g)
    constants = [
        (np.abs(ends.slope_start) + np.abs(ends.slope_end)) / 2 + curvature(c) / 2
        for ends, c in ((fz, f), (fzb_conj, g))
    ]
    sigma2 = np.abs(fz.start) + np.abs(fz.end)
    sigma2 = sigma2 - np.abs(fzb_conj.start) - np.abs(fzb_conj.end)
    np.testing.assert_allclose(2 * got.sigma2_lower, sigma2 - sum(constants), rtol=1e-12)
    turning = np.abs(fz.start) + np.abs(fz.end) > constants[0]
    np.testing.assert_array_equal(got.turning_known, turning)
    assert 0 < turning.sum() < PANELS or turning.all()


def test_bounds_are_attained() -> None:
    """f_z = 1 - t, f_zbar = t / 2 on [0, 1]: nothing of L is given away for linear values."""
    f = np.array([[1, -0.5, 0, 0, 0]] * PANELS, dtype=complex)
    g = np.array([[0, 0.25, 0, 0, 0]] * PANELS, dtype=complex)
    got = bounds(f, g)
    np.testing.assert_allclose(got.sigma2_lower, 0.25, rtol=1e-14)
    np.testing.assert_allclose(got.sigma1_upper, 1.25, rtol=1e-14)
    np.testing.assert_allclose(got.k_upper, 0.5, rtol=1e-14)


def test_a_dip_between_flat_ends_is_not_missed() -> None:
    """Only the bound on the second derivative shows the dip."""
    dip = np.array([[1, 0, -12.8, 25.6, -12.8]] * PANELS, dtype=complex)
    true = np.abs(values(dip)).min()
    assert (bounds(dip, 0 * dip).sigma2_lower <= true).all()
    assert (bounds(dip, 0 * dip, share=0.0).sigma2_lower > true).all()


def test_the_remainder_grows_with_the_square_of_the_length() -> None:
    triangle, cycle = np.array([1e3j, 2e3j, 1e3 + 1e3j]), np.array([1, 2, 0])
    far = Singularities(triangle, cycle, np.argsort(cycle), np.array([]))
    lengths = np.array([0.1, 1, 3])
    with enable_x64():
        proof = jax.jit(Lipschitz.on)(np.zeros(3), lengths + 0j, far)
        remainder = np.asarray(proof.remainder(np.array([[1.0, 0, 0]]), far))[0]
    np.testing.assert_allclose(remainder / lengths**2, remainder[1], rtol=0.02)


def test_zeros_of_fz_are_never_injective() -> None:
    for row in ([-0.5, 1, 0], [0, 1, 0], [0, 0, 0], [0, 0, 1j]):
        f = np.array([row] * PANELS, dtype=complex)
        for g in (0 * f, 0.5 * f):
            got = bounds(f, g)
            assert not got.injective.any()
            assert (got.k_upper == np.inf).all()
