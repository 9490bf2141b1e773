"""Cauchy coordinates and their derivatives (paper Section 5, Appendices D and H)."""

from __future__ import annotations

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb._features import enable_x64
from glid_nb.harmonic import basis_of, cauchy

from ..support.domains import NAMES, domain
from ..support.reference_map import (
    cauchy as c_reference,
)
from ..support.reference_map import (
    cauchy_first,
    cauchy_second,
    holomorphic_derivative,
    points_inside,
)

Array = np.ndarray

# For fewer points, programs differ only by their padding.
COUNT = 50


def parts(name: str) -> tuple[Any, Any, Array]:
    """Offset loops, hole points and points of the domain, some near its boundary."""
    d = domain(name)
    inside = points_inside(d.cage.loops_complex, COUNT, seed=1)
    corners = np.concatenate([loop[:4] for loop in d.cage.loops_complex])[:8]
    z = np.concatenate([inside, corners, inside])[:COUNT]
    return d.offset_cage.loops_complex, d.hole_points @ np.array([1, 1j]), z


def own_columns(kernel: Any, name: str, z: Array) -> Array:
    """A basis matrix of the package without its padding columns."""
    basis = basis_of(domain(name))
    with enable_x64():
        return np.asarray(jax.jit(kernel)(z, basis.singularities))[:, basis.columns]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["ell", "triple"])
def test_the_yardstick_is_cauchys_integral(name: str) -> None:
    """(D.1) against Gauss-Legendre quadrature of the hat functions over the polygon."""
    loops, rho, z = parts(name)
    nodes, weights = np.polynomial.legendre.leggauss(250)
    t, weights = (nodes + 1) / 2, weights / 2
    expected = []
    for loop in loops:
        columns = np.zeros((len(z), len(loop)), dtype=complex)
        for j, (a, b) in enumerate(zip(loop, np.roll(loop, -1), strict=True)):
            kernel = weights * (b - a) / (a + t * (b - a) - z[:, None]) / (2j * np.pi)
            columns[:, j] += kernel @ (1 - t)
            columns[:, (j + 1) % len(loop)] += kernel @ t
        expected.append(columns)
    got = c_reference(z, loops, rho)
    n_vertices = sum(map(len, loops))
    np.testing.assert_allclose(got[:, :n_vertices], np.concatenate(expected, axis=1), atol=1e-9)
    np.testing.assert_array_equal(got[:, n_vertices:].imag, 0)


@pytest.mark.parametrize("name", NAMES)
def test_coordinates_are_those_of_the_paper(name: str) -> None:
    loops, rho, z = parts(name)
    got = own_columns(cauchy.cauchy_coordinates, name, z)
    np.testing.assert_allclose(got, c_reference(z, loops, rho), rtol=0, atol=1e-13)


@pytest.mark.parametrize("name", NAMES)
def test_they_reproduce_constants_and_the_identity(name: str) -> None:
    loops, _, z = parts(name)
    c = own_columns(cauchy.cauchy_coordinates, name, z)
    # Over all loops Cauchy's integral of a holomorphic function gives the function itself, and
    # the holes' loops alone give 0.
    for power in (0, 1):
        values = np.concatenate(loops) ** power
        np.testing.assert_allclose(c[:, : len(values)] @ values, z**power, atol=1e-12)
        exterior = len(loops[0])
        np.testing.assert_allclose(c[:, :exterior] @ values[:exterior], z**power, atol=1e-12)


@pytest.mark.parametrize("name", [n for n in NAMES if n != "ell"])
def test_similarities_of_a_hole_are_the_null_space(name: str) -> None:
    loops, _, z = parts(name)
    c = own_columns(cauchy.cauchy_coordinates, name, z)
    first = len(loops[0])
    for loop in loops[1:]:
        of_hole = c[:, first : first + len(loop)]
        np.testing.assert_allclose(of_hole @ ((2 - 3j) * loop + 5j), 0, atol=1e-12)
        # Nothing else is lost: a triangle has the similarities and one more dimension.
        assert np.linalg.matrix_rank(of_hole, tol=1e-8) == len(loop) - 2
        first += len(loop)


@pytest.mark.parametrize("name", NAMES)
def test_first_and_second_derivatives_are_those_of_the_paper(name: str) -> None:
    loops, rho, z = parts(name)
    first = own_columns(cauchy.first_derivatives, name, z)
    second = own_columns(cauchy.second_derivatives, name, z)
    np.testing.assert_allclose(first, cauchy_first(z, loops, rho), rtol=1e-12, atol=1e-13)
    np.testing.assert_allclose(second, cauchy_second(z, loops, rho), rtol=1e-12, atol=1e-13)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["ell", "twin"])
def test_derivatives_are_those_of_the_coordinates(name: str) -> None:
    loops, rho, z = parts(name)
    n_vertices = sum(map(len, loops))
    radius = 0.08  # less than the offset

    first = own_columns(cauchy.first_derivatives, name, z)
    second = own_columns(cauchy.second_derivatives, name, z)
    for j in range(n_vertices):
        slope = holomorphic_derivative(
            lambda w, j=j: c_reference(w, loops, rho)[:, j], z, 1, radius
        )
        curvature = holomorphic_derivative(
            lambda w, j=j: cauchy_first(w, loops, rho)[:, j], z, 1, radius
        )
        np.testing.assert_allclose(first[:, j], slope, rtol=1e-9, atol=1e-11)
        np.testing.assert_allclose(second[:, j], curvature, rtol=1e-9, atol=1e-10)
    # ln|z - rho| is not holomorphic; its Wirtinger derivative is half of 1 / (z - rho), the other
    # half being the tie phi_j = conj(psi_j) (Section 5).
    for j, point in enumerate(rho):
        np.testing.assert_allclose(first[:, n_vertices + j], 1 / (z - point), rtol=1e-13)
        np.testing.assert_allclose(second[:, n_vertices + j], -1 / (z - point) ** 2, rtol=1e-13)


def test_first_derivatives_are_the_jacobian_of_the_coordinates() -> None:
    """Automatic differentiation through real pairs obeys the Cauchy-Riemann equations and (9)."""
    _, _, z = parts("ring")
    basis = basis_of(domain("ring"))
    m = len(basis.singularities.vertices)

    def value(pair: jax.Array) -> tuple[jax.Array, jax.Array]:
        c = cauchy.cauchy_coordinates(jax.lax.complex(pair[:1], pair[1:]), basis.singularities)
        return jnp.real(c)[0], jnp.imag(c)[0]

    with enable_x64():
        jacobian = jax.jit(jax.vmap(jax.jacfwd(value)))(np.stack([z.real, z.imag], axis=-1))
        d = jax.jit(cauchy.first_derivatives)(z, basis.singularities)
    u, v = (np.asarray(a) for a in jacobian)
    wirtinger = (u[..., 0] + v[..., 1] + 1j * (v[..., 0] - u[..., 1])) / 2
    conjugate = (u[..., 0] - v[..., 1] + 1j * (v[..., 0] + u[..., 1])) / 2
    np.testing.assert_allclose(conjugate[:, :m], 0, atol=1e-12)
    np.testing.assert_allclose(wirtinger[:, :m], np.asarray(d)[:, :m], rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(2 * wirtinger[:, m:], np.asarray(d)[:, m:], rtol=1e-10)


@pytest.mark.parametrize("name", ["ell", "triple"])
@pytest.mark.parametrize("order", [1, 2, 4])
def test_higher_derivatives(name: str, order: int) -> None:
    loops, rho, z = parts(name)
    basis = basis_of(domain(name))
    rng = np.random.default_rng(order)
    phi = rng.normal(size=len(basis.columns)) + 1j * rng.normal(size=len(basis.columns))
    with enable_x64():
        got = jax.jit(cauchy.higher_derivative, static_argnums=3)(
            z, basis.pad(phi), basis.singularities, order
        )
    expected = holomorphic_derivative(
        lambda w: cauchy_first(w, loops, rho) @ phi, z, order, radius=0.08, nodes=64
    )
    np.testing.assert_allclose(np.asarray(got), expected, rtol=1e-7, atol=1e-7)


@given(
    scale=st.floats(-3, 3).map(lambda e: 10.0**e),
    turn=st.floats(0, 6.3),
    shift=st.complex_numbers(max_magnitude=100),
)
@settings(max_examples=10)
def test_coordinates_move_with_the_plane(scale: float, turn: float, shift: complex) -> None:
    """C of a similar domain at the similar point is the same; D scales inversely."""
    loops, _, z = parts("ell")
    basis = basis_of(domain("ell"))
    a = scale * np.exp(1j * turn)
    moved = basis.singularities._replace(vertices=a * basis.singularities.vertices + shift)
    first = len(loops[0])
    with enable_x64():
        c = jax.jit(cauchy.cauchy_coordinates)(a * z + shift, moved)
        d = jax.jit(cauchy.first_derivatives)(a * z + shift, moved)
    c_expected = c_reference(z, loops, np.empty(0))
    d_expected = cauchy_first(z, loops, np.empty(0))
    loss = 1e-13 * (1 + abs(shift) / scale)
    np.testing.assert_allclose(np.asarray(c)[:, :first], c_expected, atol=10 * loss)
    np.testing.assert_allclose(a * np.asarray(d)[:, :first], d_expected, atol=100 * loss)


def test_slope_jumps_run_around_each_loop() -> None:
    """s_j = (phi_j - phi_{j-1}) / (z_j - z_{j-1}), cyclic within a loop (Section 8)."""
    loops, rho, _ = parts("twin")
    basis = basis_of(domain("twin"))
    rng = np.random.default_rng(3)
    n = len(basis.columns)
    phi = rng.normal(size=(2, n)) + 1j * rng.normal(size=(2, n))
    with enable_x64():
        padded = np.stack([basis.pad(row) for row in phi])
        got = np.asarray(cauchy.slope_jumps(padded, basis.singularities))[:, basis.columns]
    for row, jumps in zip(phi, got, strict=True):
        first, expected = 0, []
        for loop in loops:
            size = len(loop)
            values = row[first : first + size]
            slopes = [(values[j] - values[j - 1]) / (loop[j] - loop[j - 1]) for j in range(size)]
            expected += [slopes[j] - slopes[(j + 1) % size] for j in range(size)]
            first += size
        np.testing.assert_allclose(jumps, [*expected, *row[n - len(rho) :]], rtol=1e-12)
