"""The padded basis: its columns, its unknowns, and that padding changes nothing."""

from __future__ import annotations

import jax
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb._features import enable_x64
from glid_nb.geometry import Cage, Domain
from glid_nb.harmonic import basis_of, cauchy

from ..support.domains import NAMES, circle, domain


def many_holes(n_exterior: int, n_holes: int) -> Domain:
    columns = int(np.ceil(np.sqrt(n_holes))) if n_holes else 1
    holes = [circle(3, 0.1, complex(*divmod(i, columns))) for i in range(n_holes)]
    centre = (columns - 1) / 2 * (1 + 1j)
    exterior = circle(n_exterior, 3 * columns, centre)
    return Domain.from_cage(Cage(exterior, holes), 0.01)


@pytest.mark.parametrize("name", [*NAMES, "annulus"])
def test_the_number_of_unknowns(name: str) -> None:
    """4 n real numbers less the null space of dimension 10 N + 2 (Section 5)."""
    d = domain(name)
    assert basis_of(d).n_unknowns == 4 * d.n_coefficients - 10 * d.n_holes - 2


@pytest.mark.parametrize("name", [*NAMES, "annulus"])
def test_which_coefficients_are_fixed(name: str) -> None:
    d = domain(name)
    basis = basis_of(d)
    phi, psi = basis.phi_free[basis.columns], basis.psi_free[basis.columns]
    first, fixed = len(d.offset_cage.loops_complex[0]), []
    for loop in d.offset_cage.loops_complex[1:]:
        fixed += [first, first + 1]
        first += len(loop)
    holes = list(range(first, d.n_coefficients))
    assert np.flatnonzero(~phi).tolist() == fixed
    assert np.flatnonzero(~psi).tolist() == [0, *fixed, *holes]
    padding = np.setdiff1d(np.arange(basis.n_columns), basis.columns)
    assert not basis.phi_free[padding].any()
    assert not basis.psi_free[padding].any()


@pytest.mark.parametrize(
    ("n_exterior", "n_holes"),
    [(3, 0), (30, 0), (31, 0), (32, 0), (33, 0), (9, 1), (13, 3), (12, 5), (9, 65), (70, 0)],
)
def test_sizes_fall_into_buckets(n_exterior: int, n_holes: int) -> None:
    d = many_holes(n_exterior, n_holes)
    basis = basis_of(d)
    m = sum(len(loop) for loop in d.offset_cage.loops_complex)
    vertices, following, preceding, rho = basis.singularities
    assert basis.n_columns % 8 == 0
    assert basis.n_columns >= 32
    assert m <= len(vertices) <= max(m + (10 if m > 64 else 18), 32)
    assert n_holes <= len(rho) <= max(2 * n_holes, 4 if n_holes and m <= 60 else 0)
    assert basis.n_columns == len(vertices) + len(rho)
    np.testing.assert_array_equal(following[preceding], np.arange(len(vertices)))
    # No two singularities coincide, and padding is far from the domain.
    singular = np.concatenate([vertices, rho])
    assert len(np.unique(singular)) == len(singular)
    real = singular[basis.columns]
    centre = real.mean()
    padding = np.delete(singular, basis.columns)
    assert (np.abs(padding - centre) > 100 * np.abs(real - centre).max()).all()
    # An edge of the padding must not pass through the domain either.
    ring = vertices[m:]
    middles = (ring + np.roll(ring, -1)) / 2
    assert (np.abs(middles - centre) > 100 * np.abs(real - centre).max()).all()


@given(n_exterior=st.integers(3, 40), n_holes=st.integers(0, 4))
@settings(max_examples=10)
def test_pad_puts_every_coefficient_in_its_column(n_exterior: int, n_holes: int) -> None:
    d = many_holes(n_exterior, n_holes)
    basis = basis_of(d)
    coefficients = 1 + np.arange(d.n_coefficients) * (1 + 2j)
    padded = basis.pad(coefficients)
    assert padded.shape == (basis.n_columns,)
    np.testing.assert_array_equal(padded[basis.columns], coefficients)
    assert np.count_nonzero(padded) == d.n_coefficients
    singular = np.concatenate([basis.singularities.vertices, basis.singularities.hole_points])
    expected = np.concatenate([*d.offset_cage.loops_complex, d.hole_points @ np.array([1, 1j])])
    np.testing.assert_array_equal(singular[basis.columns], expected)


def test_padding_columns_are_finite_everywhere_in_the_domain() -> None:
    """Zero times infinity would spoil a map, so no padding column may be infinite or NaN."""
    d = domain("triple")
    basis = basis_of(d)
    z = np.concatenate([*d.cage.loops_complex, [1e-3j]])
    with enable_x64():
        for kernel in (
            cauchy.cauchy_coordinates,
            cauchy.first_derivatives,
            cauchy.second_derivatives,
        ):
            assert np.isfinite(np.asarray(jax.jit(kernel)(z, basis.singularities))).all()
