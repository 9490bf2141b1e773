"""The Hessian of the isometric energy and its projection (paper Sections 6 and 7, Appendix E)."""

from __future__ import annotations

import functools
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from glid_nb._features import enable_x64
from glid_nb.energies import (
    AMIPS,
    ARAP,
    CustomEnergy,
    Differentials,
    Energy,
    ExponentialSymmetricDirichlet,
    SymmetricDirichlet,
)
from glid_nb.geometry import Domain
from glid_nb.harmonic import basis_of
from glid_nb.solvers import evaluation, hessian
from glid_nb.solvers.discretisation import Matrices, discretise
from glid_nb.solvers.hessian import (
    LocalHessian,
    assemble,
    assemble_across_f,
    local_hessian,
    positive_part,
)
from glid_nb.solvers.problem import restrict_gradient, restrict_hessian, unknowns_of

from ..support.domains import domain, random_map
from ..support.reference_map import cauchy_first
from .dense import dense_expansion

Array = NDArray[Any]

COUNT = 12
ENERGIES: list[Energy] = [
    SymmetricDirichlet(),
    ExponentialSymmetricDirichlet(0.2),
    AMIPS(0.5),
    ARAP(),
]
IDS = [energy.name for energy in ENERGIES]


def dense_k(d: Differentials, fz: Array, fzb_conj: Array) -> Array:
    """(h, 4, 4) matrices of Equation (19), entry by entry."""
    a1, a2, b1, b2, b3 = (np.asarray(v)[:, None, None] for v in d)
    f = np.stack([fz.real, fz.imag], axis=-1)
    g = np.stack([fzb_conj.real, fzb_conj.imag], axis=-1)
    eye = np.eye(2)

    def outer(u: Array, v: Array) -> Array:
        return u[:, :, None] * v[:, None, :]

    k = np.zeros((len(f), 4, 4))
    k[:, :2, :2] = 2 * a1 * eye + 4 * b1 * outer(f, f)
    k[:, :2, 2:] = 4 * b3 * outer(f, g)
    k[:, 2:, :2] = 4 * b3 * outer(g, f)
    k[:, 2:, 2:] = 2 * a2 * eye + 4 * b2 * outer(g, g)
    return k


def unit(z: Array) -> Array:
    return np.where(z == 0, 1, z / np.where(z == 0, 1, np.abs(z)))


def dense_of_local(k: LocalHessian, fz: Array, fzb_conj: Array) -> Array:
    """The matrices that a `LocalHessian` stands for."""
    frames = []
    for z in (unit(fz), unit(fzb_conj)):
        frames.append(np.stack([np.stack([z.real, z.imag], -1), np.stack([-z.imag, z.real], -1)]))
    zero = np.zeros((len(fz), 2))
    along_f, across_f = (np.concatenate([v, zero], axis=1) for v in frames[0])
    along_g, across_g = (np.concatenate([zero, v], axis=1) for v in frames[1])

    def outer(u: Array, v: Array, factor: Any) -> Array:
        return np.asarray(factor)[:, None, None] * u[:, :, None] * v[:, None, :]

    return (
        outer(along_f, along_f, k.along_ff)
        + outer(across_f, across_f, k.across_f)
        + outer(along_g, along_g, k.along_gg)
        + outer(across_g, across_g, k.across_g)
        + outer(along_f, along_g, k.along_fg)
        + outer(along_g, along_f, k.along_fg)
    )


def projected(k: Array) -> Array:
    """The closest positive semidefinite matrices, by eigen-decomposition."""
    values, vectors = np.linalg.eigh(k)
    return (vectors * np.maximum(values, 0)[:, None, :]) @ vectors.swapaxes(1, 2)


@functools.cache
def compiled_local() -> Any:
    @jax.jit
    def run(d: Differentials, fz: Any, fzb_conj: Any) -> tuple[LocalHessian, LocalHessian]:
        k = local_hessian(d, jnp.abs(fz) ** 2, jnp.abs(fzb_conj) ** 2)
        return k, positive_part(k)

    return run


def check_projection(d: Differentials, fz: Array, fzb_conj: Array) -> None:
    with enable_x64():
        local, positive = compiled_local()(d, fz, fzb_conj)
    k = dense_k(d, fz, fzb_conj)
    size = np.abs(k).max(axis=(1, 2), keepdims=True) + 1e-290
    np.testing.assert_allclose(dense_of_local(local, fz, fzb_conj) / size, k / size, atol=1e-13)
    expected = projected(k / size)
    np.testing.assert_allclose(
        dense_of_local(positive, fz, fzb_conj) / size, expected, rtol=0, atol=1e-12
    )


# |f_z|, its argument, |f_zbar| / |f_z| (0 and tiny ones included) and the argument of f_zbar.
states = st.lists(
    st.tuples(
        st.floats(-2, 1).map(lambda e: 10.0**e),
        st.floats(0, 6.3),
        st.one_of(st.just(0.0), st.floats(-12, -0.1).map(lambda e: 10.0**e)),
        st.floats(0, 6.3),
    ),
    min_size=COUNT,
    max_size=COUNT,
)


def state(drawn: list[tuple[float, float, float, float]]) -> tuple[Array, Array]:
    r, angle, ratio, turn = np.array(drawn).T
    fz = r * np.exp(1j * angle)
    return fz, r * ratio * np.exp(1j * turn)


@functools.cache
def compiled_differentials() -> Any:
    return jax.jit(lambda energy, x, y: energy.differentials(x, y))


@pytest.mark.slow
@pytest.mark.parametrize("energy", ENERGIES, ids=IDS)
@given(drawn=states)
@settings(max_examples=25)
def test_the_projection_is_that_of_the_eigenvalues(
    energy: Energy, drawn: list[tuple[float, float, float, float]]
) -> None:
    fz, fzb_conj = state(drawn)
    if energy.name == "exp":  # keeps exp(s E) within floating point
        fz, fzb_conj = fz / np.abs(fz) * np.clip(np.abs(fz), 0.3, 3), fzb_conj
        fzb_conj = fzb_conj * np.minimum(1, 0.7 * np.abs(fz) / (np.abs(fzb_conj) + 1e-300))
    if energy.name == "amips":
        fz = fz / np.abs(fz) * np.clip(np.abs(fz), 0.2, 3)
        fzb_conj = fzb_conj * np.minimum(1, 0.7 * np.abs(fz) / (np.abs(fzb_conj) + 1e-300))
    x, y = np.abs(fz) ** 2, np.abs(fzb_conj) ** 2
    with enable_x64():
        d = compiled_differentials()(energy, x, y)
    check_projection(Differentials(*map(np.asarray, d)), fz, fzb_conj)


@pytest.mark.slow
@given(
    drawn=states,
    scalars=st.lists(
        st.tuples(*[st.integers(-(10**6), 10**6).map(lambda i: i / 10**4) for _ in range(5)]),
        min_size=COUNT,
        max_size=COUNT,
    ),
)
@settings(max_examples=50)
def test_the_projection_holds_for_any_energy(
    drawn: list[tuple[float, float, float, float]], scalars: list[tuple[float, ...]]
) -> None:
    """Alphas and betas of every sign pattern, as a user's energy may have them."""
    fz, fzb_conj = state(drawn)
    check_projection(Differentials(*np.array(scalars).T), fz, fzb_conj)


def test_a_multiple_of_the_identity_projects_to_itself_or_to_zero() -> None:
    """Equal eigenvalues, where (23) has no gap and (24) divides 0 by 0."""
    a = np.tile([1.5, -2.0, 0.0], 4)
    zero = np.zeros(COUNT)
    fz, fzb_conj = np.full(COUNT, 1 + 1j), np.full(COUNT, 0j)
    check_projection(Differentials(a, a, zero, zero, zero), fz, fzb_conj)


@pytest.mark.parametrize("size", [1e-100, 1e100, 1e200, 1e300])
def test_the_projection_does_not_overflow(size: float) -> None:
    """exp(s E) reaches such values if a certified map is only thin."""
    block = np.array([[3.0, -2.5], [-2.5, 1.0]])
    k = LocalHessian(*(np.full(COUNT, v * size) for v in (-1.0, 2.0, 3.0, 1.0, -2.5)))
    with enable_x64():
        positive = jax.jit(positive_part)(k)
    values, vectors = np.linalg.eigh(block)
    expected = (vectors * np.maximum(values, 0)) @ vectors.T
    got = [np.asarray(v)[0] / size for v in positive]
    np.testing.assert_allclose(
        got, [0, 2, expected[0, 0], expected[1, 1], expected[0, 1]], rtol=1e-12
    )


@given(
    sigma2=st.floats(0.1, 3),
    ratio=st.floats(1, 5),
    turns=st.tuples(st.floats(0, 6.3), st.floats(0, 6.3)),
)
@settings(max_examples=40)
def test_eigenvalues_of_the_symmetric_dirichlet_energy(
    sigma2: float, ratio: float, turns: tuple[float, float]
) -> None:
    """2 alpha_1, 2 alpha_2, 2 (1 + 3 sigma_1^-4), 2 (1 + 3 sigma_2^-4), the largest last."""
    sigma1 = sigma2 * ratio
    fz = np.full(COUNT, (sigma1 + sigma2) / 2 * np.exp(1j * turns[0]))
    fzb_conj = np.full(COUNT, (sigma1 - sigma2) / 2 * np.exp(1j * turns[1]))
    x, y = np.abs(fz) ** 2, np.abs(fzb_conj) ** 2
    with enable_x64():
        d = compiled_differentials()(SymmetricDirichlet(), x, y)
        k, positive = compiled_local()(d, fz, fzb_conj)
    expected = [
        2 * float(d.alpha1[0]),
        2 * float(d.alpha2[0]),
        2 * (1 + 3 * sigma1**-4),
        2 * (1 + 3 * sigma2**-4),
    ]
    got = np.linalg.eigvalsh(dense_of_local(k, fz, fzb_conj)[0])
    np.testing.assert_allclose(got, np.sort(expected), rtol=1e-8, atol=1e-8 * max(expected))
    assert expected[0] <= expected[2] * (1 + 1e-9)
    assert expected[1] <= expected[3] * (1 + 1e-9)
    # Only the first may be negative (25).
    np.testing.assert_allclose(positive.along_ff, k.along_ff, rtol=1e-9)
    np.testing.assert_allclose(positive.along_fg, k.along_fg, rtol=1e-9, atol=1e-9 * max(expected))
    np.testing.assert_allclose(positive.across_g, k.across_g, rtol=1e-9)
    np.testing.assert_allclose(positive.across_f, np.maximum(k.across_f, 0), rtol=1e-12)


def test_assemble_is_the_sum_over_the_samples() -> None:
    """sum_i w_i B_i^T K_i B_i with B = [D 0; 0 D], D as in (15), formed densely."""
    rng = np.random.default_rng(0)
    h, c = 7, 3
    d = rng.normal(size=(h, c)) + 1j * rng.normal(size=(h, c))
    fz = rng.normal(size=h) + 1j * rng.normal(size=h)
    fzb_conj = rng.normal(size=h) + 1j * rng.normal(size=h)
    k = LocalHessian(*rng.normal(size=(5, h)))
    weights = rng.uniform(size=h)
    f, g = ((z.real / np.abs(z), z.imag / np.abs(z)) for z in (fz, fzb_conj))
    with enable_x64():
        nodes = np.concatenate([d.real, -d.imag], axis=1).T
        got = np.asarray(jax.jit(assemble)(nodes, weights, f, g, k))
        only_across_f = LocalHessian(k.across_f, *np.zeros((4, h)))
        block = np.asarray(jax.jit(assemble_across_f)(nodes, weights, f, k.across_f))
        same = np.asarray(jax.jit(assemble)(nodes, weights, f, g, only_across_f))
    dense, expected = dense_of_local(k, fz, fzb_conj), np.zeros((4 * c, 4 * c))
    for i in range(h):
        small = np.block([[d[i].real, -d[i].imag], [d[i].imag, d[i].real]])
        b = np.block([[small, np.zeros_like(small)], [np.zeros_like(small), small]])
        expected += weights[i] * b.T @ dense[i] @ b
    np.testing.assert_allclose(np.triu(got), np.triu(expected), rtol=1e-12, atol=1e-12)
    np.testing.assert_array_equal(got[2 * c :, : 2 * c], 0)
    np.testing.assert_allclose(block, same[: 2 * c, : 2 * c], rtol=1e-12, atol=1e-12)


@functools.cache
def discretised() -> tuple[Domain, Matrices, Array, Array, Array]:
    """A domain with a hole; its matrices; D at all samples by the paper; the map and its unknowns.

    Returned coefficients are [Re phi, Im phi, Re psi, Im psi] of the domain's own columns.
    """
    d = domain("ring")
    matrices = discretise(d).matrices
    panels = discretise(d).panels
    p = len(matrices.real)
    z = np.concatenate([panels.start, panels.middle])
    rows = np.concatenate([np.arange(len(panels)), p + np.arange(len(panels))])
    dense = cauchy_first(z, d.offset_cage.loops_complex, d.hole_points @ np.array([1, 1j]))
    map = random_map("ring", 0.05, 4)
    y = np.concatenate([map.phi.real, map.phi.imag, map.psi.real, map.psi.imag])
    return d, matrices, rows, dense, y


@functools.cache
def automatic(kind: str) -> Any:
    """Derivatives of the discretised energy in the unknowns, by automatic differentiation.

    A program of its own: complex arithmetic, the tie and the fixed coefficients from a matrix.
    """
    d = domain("ring")
    t = dense_expansion(d)
    n = d.n_coefficients

    def energy_of(u: Any, energy: Energy, dense: Any, weights: Any, y: Any) -> Any:
        a, b, c, e = jnp.split(y + t @ u, 4)
        fz, fzb_conj = dense @ (a + 1j * b), dense @ (c + 1j * e)
        x, yy = (jnp.real(v) ** 2 + jnp.imag(v) ** 2 for v in (fz, fzb_conj))
        return jnp.sum(weights * jax.vmap(energy.density)(x, yy))

    assert t.shape == (4 * n, 4 * n - 10 - 2)
    derivative = {"gradient": jax.grad, "hessian": jax.hessian}[kind]
    return jax.jit(lambda *args: derivative(energy_of)(jnp.zeros(t.shape[1]), *args))


@pytest.mark.slow
def test_a_large_basis_is_assembled_in_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    matrices = discretise(domain("ring")).matrices
    y = np.random.default_rng(5).normal(size=2 * len(matrices.nodes))
    with enable_x64():
        samples = evaluation.products(matrices, y)
        x, yy = evaluation.squares(samples.values)
        k = local_hessian(SymmetricDirichlet().differentials(x, yy), x, yy)
        given = matrices.nodes, matrices.weights, *evaluation.directions(samples.values), k
        at_once = np.asarray(assemble(*given))
        for share in (2.0, 2.7, 7.3):  # pieces that divide the nodes and pieces that do not
            monkeypatch.setattr(hessian, "PIECE", int(matrices.nodes.size / 2 / share))
            difference = abs(np.asarray(assemble(*given)) - at_once)
            assert difference.max() < 1e-12 * abs(at_once).max()


CUSTOM = CustomEnergy(lambda x, y: (x - 1) ** 2 - 3 * y + x * y**2)


@pytest.mark.slow
@pytest.mark.parametrize("energy", [ENERGIES[0], CUSTOM], ids=lambda e: e.name)
def test_gradient_and_hessian_are_those_of_the_discretised_energy(energy: Energy) -> None:
    d, _, rows, dense, y = discretised()
    disc = discretise(d)
    matrices = disc.full(disc.matrices)
    basis = basis_of(d)
    unknowns = unknowns_of(basis, conformal=False)
    n, c = d.n_coefficients, basis.n_columns
    padded = np.zeros(4 * c)
    own = np.concatenate([k * c + basis.columns for k in range(4)])
    padded[own] = y
    weights = np.asarray(matrices.weights)

    @jax.jit
    def of_the_package(energy: Energy, y: Any) -> tuple[Any, Any]:
        samples = evaluation.products(matrices, y)
        x, yy = evaluation.squares(samples.values)
        differentials = energy.differentials(x, yy)
        gradient = evaluation.energy_gradient(matrices, samples.values, differentials)
        k = local_hessian(differentials, x, yy)
        f, g = evaluation.directions(samples.values)
        hessian = assemble(matrices.nodes, matrices.weights, f, g, k)
        return restrict_gradient(gradient, unknowns), restrict_hessian(hessian, unknowns)

    with enable_x64():
        gradient, hessian = map(np.asarray, of_the_package(energy, padded))
        expected_gradient = automatic("gradient")(energy, dense, weights[rows], y)
        expected_hessian = automatic("hessian")(energy, dense, weights[rows], y)
    hessian = np.triu(hessian) + np.triu(hessian, 1).T

    # The package's unknowns in the order of the dense construction.
    free = np.flatnonzero(np.asarray(unknowns.free))
    assert len(free) == 4 * n - 12
    scale = np.abs(expected_gradient).max()
    np.testing.assert_allclose(gradient[free], expected_gradient, rtol=0, atol=1e-10 * scale)
    scale = np.abs(expected_hessian).max()
    np.testing.assert_allclose(
        hessian[np.ix_(free, free)], expected_hessian, rtol=0, atol=1e-10 * scale
    )
    fixed = np.setdiff1d(np.arange(4 * c), free)
    np.testing.assert_array_equal(gradient[fixed], 0)
    np.testing.assert_array_equal(hessian[np.ix_(fixed, fixed)], np.eye(len(fixed)))
    np.testing.assert_array_equal(hessian[np.ix_(free, fixed)], 0)


@pytest.mark.slow
def test_the_hessian_is_integrated_in_the_middle_of_panels_and_of_pairs() -> None:
    d, matrices, _, _, _ = discretised()
    panels, size = discretise(d).panels, len(matrices.real)
    weights = np.asarray(matrices.hessian_weights)
    nodes = np.asarray(matrices.hessian_index)[weights > 0]
    weights = weights[weights > 0]
    assert weights.sum() == pytest.approx(1)
    covered = np.zeros(len(panels), dtype=int)
    share = panels.length / panels.length.sum()
    for node, weight in zip(nodes, weights, strict=True):
        if node >= size:
            mine = [node - size]
        else:  # The common end of two halves of one straight piece.
            mine = [node - 1, node]
            chord = panels.end[mine] - panels.start[mine]
            assert chord[0] == pytest.approx(chord[1])
            assert panels.next[mine[0]] == mine[1]
        covered[mine] += 1
        assert weight == pytest.approx(share[mine].sum())
    np.testing.assert_array_equal(covered, 1)
    assert (nodes < size).any()
    assert (nodes >= size).any()


@pytest.mark.slow
@pytest.mark.parametrize(
    "energy", [e for e in ENERGIES if e.indefinite_across_f_only], ids=lambda e: e.name
)
@settings(max_examples=30)
@given(seed=st.integers(0, 2**32 - 1))
def test_the_cheap_projection_is_the_whole_one(energy: Energy, seed: int) -> None:
    """Energies that promise it: only the eigenvalue across f_z is ever negative."""
    rng = np.random.default_rng(seed)
    # Not so close to folding that the exponential energy overflows.
    x = rng.uniform(0.3, 4, COUNT)
    y = x * rng.uniform(0, 0.7, COUNT)
    with enable_x64():
        k = local_hessian(energy.differentials(jnp.asarray(x), jnp.asarray(y)), x, y)
        projected = positive_part(k)
    scale = max(float(np.abs(v).max()) for v in k)
    for name in ("across_g", "along_ff", "along_gg", "along_fg"):
        np.testing.assert_allclose(
            getattr(projected, name), getattr(k, name), rtol=1e-9, atol=1e-12 * scale
        )


def test_quadrature_weights_integrate_over_the_boundary() -> None:
    """Both sets of weights give a mean over arc length: exact for 1, nearly so for smooth
    values."""
    d, matrices, _, _, _ = discretised()
    panels = discretise(d).panels
    p = len(matrices.real)
    z = np.zeros(2 * p, dtype=complex)
    z[: len(panels)], z[p : p + len(panels)] = panels.start, panels.middle
    weights = np.asarray(matrices.weights)
    assert weights.sum() == pytest.approx(1, rel=1e-13)
    assert np.asarray(matrices.hessian_weights).sum() == pytest.approx(1, rel=1e-13)
    edges = [
        (a, b)
        for loop in d.cage.loops_complex
        for a, b in zip(loop, np.roll(loop, -1), strict=True)
    ]
    nodes, gauss = np.polynomial.legendre.leggauss(20)
    lengths = np.array([abs(b - a) for a, b in edges])
    for values in (lambda w: w.real**3, lambda w: 1 / (10 + w.real + 2 * w.imag)):
        means = [gauss @ values(a + (b - a) * (nodes + 1) / 2) / 2 for a, b in edges]
        exact = lengths @ np.array(means) / lengths.sum()
        assert weights @ values(z) == pytest.approx(exact, rel=1e-5, abs=1e-8)
