"""Coordinates in which the basis is orthonormal along the boundary."""

from typing import Any

import jax
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from glid_nb._features import enable_x64
from glid_nb.geometry import Cage, Domain
from glid_nb.harmonic import basis_of
from glid_nb.harmonic.cauchy import cauchy_coordinates
from glid_nb.minima import solve
from glid_nb.pose import Pose
from glid_nb.solvers import Options, Status, step, whitening
from glid_nb.solvers.discretisation import complex_basis, discretise
from glid_nb.solvers.evaluation import products
from glid_nb.solvers.line_search import INDEFINITE
from glid_nb.solvers.problem import expand, unknowns_of
from glid_nb.solvers.whitening import coefficients, pulled_back, whitened

from ..support.domains import divided, domain

pytestmark = pytest.mark.slow  # most of the time is compiling

SHAPES = ("ell", "ring")


def _complex(rows: np.ndarray) -> np.ndarray:
    re, minus_im = np.split(np.asarray(rows, dtype=float), 2)
    return (re - 1j * minus_im).T


@pytest.mark.parametrize("sampling", ["graded", "uniform"])
@pytest.mark.parametrize("name", SHAPES)
def test_derivatives_of_the_new_basis_are_orthonormal(name: str, sampling: str) -> None:
    disc = discretise(domain(name), sampling)  # type: ignore[arg-type]
    basis, t = basis_of(domain(name)), np.asarray(disc.matrices.whitening)
    if sampling == "graded":
        nodes = _complex(disc.matrices.nodes)[len(disc.matrices.real) :][: len(disc.panels)]
        weights = disc.panels.length / disc.panels.length.sum()
    else:
        weights = np.asarray(disc.matrices.hessian_weights)
        nodes = _complex(disc.matrices.nodes)[np.asarray(disc.matrices.hessian_index)]
    d = nodes @ (t[0] + 1j * t[1])
    unknown, first_hole = np.flatnonzero(t.any(axis=(0, 1)))[1:], t.shape[2] - basis.n_hole_columns
    single_valued, logarithms = unknown[unknown < first_hole], unknown[unknown >= first_hole]
    gram = d.conj().T @ (weights[:, None] * d)
    expected = np.eye(len(single_valued))
    np.testing.assert_allclose(gram[np.ix_(single_valued, single_valued)], expected, atol=1e-6)
    # Logarithms have unit length and are orthogonal to the others, not to one another.
    np.testing.assert_allclose(gram[logarithms, logarithms], 1, atol=1e-6)
    np.testing.assert_allclose(gram[np.ix_(single_valued, logarithms)], 0, atol=1e-6)
    # Derivatives do not depend on a translation.
    np.testing.assert_allclose(d[:, 0], 0, atol=1e-9)


@pytest.mark.parametrize("sampling", ["graded", "uniform"])
@pytest.mark.parametrize("name", SHAPES)
def test_the_stored_basis_is_the_whitened_one_to_its_precision(name: str, sampling: str) -> None:
    disc = discretise(domain(name), sampling)  # type: ignore[arg-type]
    m = disc.matrices
    with enable_x64():
        exact = np.asarray(whitened(m.nodes, m.hessian_index, m.whitening, np.float64))
    assert m.whitened.dtype == np.float32
    np.testing.assert_allclose(np.asarray(m.whitened), exact, atol=1e-6 * np.abs(exact).max())
    full = disc.full(disc.matrices)
    assert full.whitened.dtype == np.float64
    with enable_x64():
        exact = np.asarray(whitened(full.nodes, full.hessian_index, full.whitening, np.float64))
    np.testing.assert_array_equal(np.asarray(full.whitened), exact)
    if sampling == "uniform":
        assert full.hessian_index is m.hessian_index


@pytest.mark.parametrize("name", SHAPES)
@given(seed=st.integers(0, 2**32 - 1))
def test_a_gradient_pulls_back_as_coefficients_push_forward(name: str, seed: int) -> None:
    t = discretise(domain(name)).matrices.whitening
    rng = np.random.default_rng(seed)
    x, gradient = rng.normal(size=4 * t.shape[2]), rng.normal(size=4 * t.shape[1])
    with enable_x64():
        pushed, pulled = np.asarray(coefficients(x, t)), np.asarray(pulled_back(gradient, t))
    scale = np.abs(gradient) @ np.abs(pushed)
    assert gradient @ pushed == pytest.approx(pulled @ x, abs=1e-12 * scale)


@pytest.mark.parametrize("name", SHAPES)
def test_unknowns_stay_where_they_are(name: str) -> None:
    """Fixed coefficients stay zero, and logarithms stay tied, whatever the coordinates."""
    basis = basis_of(domain(name))
    t = discretise(domain(name)).matrices.whitening
    unknowns = unknowns_of(basis, False, t)
    rng = np.random.default_rng(1)
    with enable_x64():
        x = expand(jax.numpy.asarray(rng.normal(size=len(unknowns.free))), unknowns)
        y = np.asarray(coefficients(x, t)).reshape(4, -1)
    phi, psi = y[0] + 1j * y[1], y[2] + 1j * y[3]
    logarithms = basis.phi_free & ~basis.psi_free
    logarithms[0] = False
    np.testing.assert_array_equal(phi[~basis.phi_free], 0)
    others = ~basis.psi_free & ~logarithms
    others[0] = False  # a translation, which phi has as well
    np.testing.assert_array_equal(psi[others], 0)
    np.testing.assert_allclose(psi[logarithms], phi[logarithms].conj(), rtol=1e-13)
    with enable_x64():
        moved = np.asarray(products(discretise(domain(name)).matrices, y.ravel()).values)
    assert np.abs(moved).max() > 0


@pytest.mark.parametrize("sampling", ["graded", "uniform"])
@pytest.mark.parametrize("name", SHAPES)
def test_only_the_translation_moves_the_anchor(name: str, sampling: str) -> None:
    """So no new function of unit slope is far from zero anywhere in the shape."""
    disc = discretise(domain(name), sampling)  # type: ignore[arg-type]
    t = np.asarray(disc.matrices.whitening)
    points = np.array([disc.panels.start[0], *disc.panels.middle[::7]])
    with enable_x64():
        rows = np.asarray(complex_basis(cauchy_coordinates, points, disc.basis))
    values = rows @ (t[0] + 1j * t[1])
    np.testing.assert_allclose(values[:, 0], 1, atol=1e-9)
    np.testing.assert_allclose(values[0, 1:], 0, atol=1e-8)
    # |f(z) - f(anchor)| <= integral of |f'| <= sqrt(length) * length of f' (Cauchy-Schwarz), where
    # slopes of unit mean square have length sqrt(perimeter).
    assert np.abs(values[:, 1:]).max() <= 1.1 * disc.panels.length.sum()


def test_a_fine_cage_keeps_the_hessian_definite_in_single_precision(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """More vertices than the panels have nodes for: no second Hessian is tried."""
    run, outcomes = step.run, []

    def noted(*arguments: Any, **options: Any) -> step.State:
        state = run(*arguments, **options)
        outcomes.append(int(state.outcome))
        return state

    monkeypatch.setattr(step, "run", noted)
    angles = np.linspace(0, 2 * np.pi, 360, endpoint=False)
    cage = Cage(6 * np.stack([np.cos(angles), np.sin(angles)], axis=1))
    pose = Pose([[-3, 0], [3, 0]], [[-3, 0], [4, 1]])
    result = solve(Domain.from_cage(cage), pose, options=Options(restarts=0))
    assert result.status is Status.CONVERGED
    assert outcomes
    assert INDEFINITE not in outcomes
    matrices = discretise(result.map.domain).matrices
    assert matrices.whitened.shape[1] >= 2.25 * matrices.whitening.shape[2]


def test_a_finely_divided_cage_does_not_stop_the_solver() -> None:
    """Functions that oscillate along it are no coordinates. The rest reaches the same energy or a
    lower one."""
    pose = Pose([[-2, -2], [2, -2], [-2, 2]], [[-2, -2], [2, -1.5], [-1.5, 2]])
    coarse, fine = domain("ell"), divided(domain("ell"), lambda n: np.full(n, 24))
    t = np.asarray(discretise(fine).matrices.whitening)
    assert np.count_nonzero(t.any(axis=(0, 1))) < 0.9 * fine.n_coefficients
    assert discretise(coarse).matrices.whitening.any(axis=(0, 1)).sum() == 6
    result, least = (solve(d, pose, options=Options(restarts=0)) for d in (fine, coarse))
    assert result.status is Status.CONVERGED
    assert result.energy < 1.01 * least.energy
    assert result.iterations <= least.iterations + 3
    # The coefficients are so small that the map keeps its digits.
    rounding = np.finfo(float).eps * np.abs(result.map.phi).max()
    assert rounding < 1e-13 * np.abs(fine.cage.exterior).max()


# One edge is divided so finely that some coordinates are steep. The others are not divided.
UNEVEN = (1, 18, 1, 1, 1, 1)
UNEVEN_POSE = Pose([[2.8, -2.5], [2.8, -0.5], [-2, 2]], [[2.2, -2.5], [3.2, -1.2], [-1.5, 2]])


def uneven() -> Domain:
    return divided(domain("ell"), lambda n: np.array(UNEVEN[:n]))


def test_a_solve_puts_steep_coordinates_back_that_lower_the_minimum(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    options = Options(restarts=0)
    begun = discretise(uneven()).whitening
    assert begun.steep.shape[1] > 3
    result = solve(uneven(), UNEVEN_POSE, options=options)
    assert result.discretisation is not None
    assert result.discretisation.whitening.steep.shape[1] < begun.steep.shape[1]
    monkeypatch.setattr(whitening, "STEEP", 1e-12)
    discretise.cache_clear()
    whole = solve(uneven(), UNEVEN_POSE, options=options)
    discretise.cache_clear()
    assert whole.status is result.status is Status.CONVERGED
    assert result.energy <= (1 + 1e-6) * whole.energy
    assert result.certificate.certified


def test_coordinates_put_back_are_orthonormal_to_the_others() -> None:
    disc = discretise(uneven())
    count = disc.whitening.steep.shape[1]
    more = disc.with_steep(np.arange(0, count, 2))
    assert more.whitening.steep.shape[1] == count // 2
    t = np.asarray(more.matrices.whitening)
    np.testing.assert_array_equal(t, more.whitening.t)
    middles = _complex(disc.matrices.nodes)[len(disc.matrices.real) :][: len(disc.panels)]
    d = middles @ (t[0] + 1j * t[1])[:, 1:]
    gram = d.conj().T @ (disc.panels.length[:, None] * d) / disc.panels.length.sum()
    known = t[:, :, 1:].any(axis=(0, 1))
    assert known.sum() == discretise(uneven()).matrices.whitening.any(axis=(0, 1)).sum() - 1 + (
        count - count // 2
    )
    # The Gram matrix's ridge shortens the steepest ones a little.
    np.testing.assert_allclose(gram, np.diag(known.astype(float)), atol=1e-5)


def test_the_papers_settings_keep_the_whole_subspace() -> None:
    fine = divided(domain("ell"), lambda n: np.full(n, 24))
    disc = discretise(fine, "uniform", "lipschitz")
    assert disc.whitening.steep.shape[1] == 0
    assert np.asarray(disc.matrices.whitening).any(axis=(0, 1)).sum() == disc.basis.phi_free.sum()


def test_what_gains_nothing_is_not_put_back() -> None:
    """Rigid targets: all steep coordinates stay out."""
    moved = Pose(UNEVEN_POSE.handles, UNEVEN_POSE.handles + np.array([0.5, 0.2]))
    fine = uneven()
    result = solve(fine, moved, options=Options(restarts=0))
    assert result.status is Status.CONVERGED
    # Called with the names that a solve uses, because the cache goes by the arguments.
    assert result.discretisation is discretise(fine, "graded", "hermite")
