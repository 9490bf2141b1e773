"""Which coefficients are unknowns (paper Section 5)."""

from __future__ import annotations

import jax
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb._features import enable_x64
from glid_nb.harmonic import HarmonicMap, basis_of
from glid_nb.solvers.discretisation import discretise
from glid_nb.solvers.problem import (
    canonical,
    expand,
    restrict_gradient,
    restrict_hessian,
    unknowns_of,
)

from ..support.domains import NAMES, domain, random_map, reference
from ..support.reference_map import cauchy, points_inside
from .dense import dense_expansion


def padded_expansion(name: str, conformal: bool) -> np.ndarray:
    """The dense T on padded columns."""
    d = domain(name)
    basis = basis_of(d)
    t = dense_expansion(d, conformal)
    own = np.concatenate([k * basis.n_columns + basis.columns for k in range(4)])
    padded = np.zeros((4 * basis.n_columns, t.shape[1]))
    padded[own] = t
    return padded


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("conformal", [False, True])
def test_restriction_and_expansion_are_those_of_the_dense_matrix(
    name: str, conformal: bool
) -> None:
    basis = basis_of(domain(name))
    unknowns = unknowns_of(basis, conformal)
    t = padded_expansion(name, conformal)
    free = np.flatnonzero(unknowns.free)
    assert len(free) == t.shape[1]
    rng = np.random.default_rng(0)
    size = 4 * basis.n_columns
    gradient, step = rng.normal(size=(2, size))
    hessian = rng.normal(size=(size, size))
    hessian += hessian.T

    with enable_x64():
        expanded = np.asarray(expand(jax.numpy.asarray(step), unknowns))
        g = np.asarray(restrict_gradient(jax.numpy.asarray(gradient), unknowns))
        h = np.asarray(restrict_hessian(jax.numpy.asarray(hessian), unknowns))
    np.testing.assert_array_equal(expanded, t @ step[free])
    np.testing.assert_allclose(g[free], t.T @ gradient, rtol=1e-14, atol=1e-14)
    np.testing.assert_allclose(h[np.ix_(free, free)], t.T @ hessian @ t, rtol=1e-13, atol=1e-13)
    rest = np.delete(np.eye(size), free, axis=0)
    np.testing.assert_array_equal(np.delete(h, free, axis=0), rest)
    np.testing.assert_array_equal(np.delete(g, free), 0)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("conformal", [False, True])
def test_whitened_coordinates_are_as_many_as_the_unknowns(name: str, conformal: bool) -> None:
    basis, t = basis_of(domain(name)), np.asarray(discretise(domain(name)).matrices.whitening)
    every, whitened = (unknowns_of(basis, conformal, part) for part in (None, t))
    assert t.shape[2] <= basis.n_columns
    assert t.shape[2] % 8 == 0
    each = [unknowns.free.reshape(4, -1).sum(axis=1) for unknowns in (every, whitened)]
    np.testing.assert_array_equal(*each)
    # The tie of the logarithms counts from the end.
    last = slice(t.shape[2] - basis.n_hole_columns, None)
    expected = basis.phi_free[basis.n_columns - basis.n_hole_columns :] & (not conformal)
    np.testing.assert_array_equal(whitened.free.reshape(4, -1)[:2, last], [expected, expected])


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_the_unknowns_span_all_maps_once(name: str) -> None:
    """T has full rank as maps: no unknown is redundant, and none is missing."""
    d = domain(name)
    z = points_inside(d.cage.loops_complex, 150)
    c = cauchy(z, d.offset_cage.loops_complex, d.hole_points @ np.array([1, 1j]))
    # f is real linear in the coefficients.
    f = np.concatenate([c, 1j * c, c.conj(), -1j * c.conj()], axis=1)
    everything = np.concatenate([f.real, f.imag])
    n, n_holes = d.n_coefficients, d.n_holes
    tied = np.eye(4 * n)
    tied = np.delete(tied, [k * n + n - 1 - h for k in (2, 3) for h in range(n_holes)], axis=1)
    for h in range(n_holes):
        j = n - n_holes + h
        tied[2 * n + j] = tied[j]
        tied[3 * n + j] = -tied[n + j]
    chosen = everything @ dense_expansion(d)
    rank = np.linalg.matrix_rank(everything @ tied, tol=1e-9)
    assert rank == chosen.shape[1] == 4 * n - 10 * n_holes - 2
    assert np.linalg.matrix_rank(chosen, tol=1e-9) == rank


@given(name=st.sampled_from(NAMES), size=st.floats(0, 10), seed=st.integers(0, 10**6))
@settings(max_examples=25)
def test_canonical_is_the_same_map(name: str, size: float, seed: int) -> None:
    map = random_map(name, size, seed)
    same = canonical(map)
    assert same.domain is map.domain
    z = points_inside(map.domain.cage.loops_complex, 40)
    np.testing.assert_allclose(
        reference(same).f(z), reference(map).f(z), rtol=1e-10, atol=1e-10 * (1 + size)
    )
    # The rest is a combination of the unknowns, so a solve can move it anywhere.
    t = dense_expansion(map.domain)
    y = np.concatenate([same.phi.real, same.phi.imag, same.psi.real, same.psi.imag])
    u = np.linalg.lstsq(t, y, rcond=None)[0]
    np.testing.assert_allclose(t @ u, y, atol=1e-12 * (1 + size))
    first = len(map.domain.offset_cage.loops_complex[0])
    assert same.psi[0] == 0
    for loop in map.domain.offset_cage.loops_complex[1:]:
        for values in (same.phi, same.psi):
            np.testing.assert_array_equal(values[first : first + 2], 0)
        first += len(loop)


@pytest.mark.parametrize("name", NAMES)
def test_the_identity_is_canonical(name: str) -> None:
    map = HarmonicMap.identity(domain(name))
    same = canonical(map)
    np.testing.assert_array_equal(same.phi, map.phi)
    np.testing.assert_array_equal(same.psi, map.psi)


def test_canonical_leaves_its_argument_alone() -> None:
    map = random_map("twin", 1.0, 3)
    before = map.phi.copy(), map.psi.copy()
    canonical(map)
    np.testing.assert_array_equal(map.phi, before[0])
    np.testing.assert_array_equal(map.psi, before[1])
