"""Methods in the harmonic subspace reach one minimum, each in its own way."""

from __future__ import annotations

import functools
import itertools

import numpy as np
import pytest

from glid_nb._runtime import double_precision
from glid_nb.certificate import certify
from glid_nb.energies import ARAP, Energy, SymmetricDirichlet
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods.subspace.descent import DirectedDescent, SubspaceMethod
from glid_nb.methods.subspace.methods import FLOOR, LBFGS, NewtonEigen, NewtonStaged
from glid_nb.pose import Pose
from glid_nb.solvers import Options, Result, Status
from glid_nb.solvers.method import Inputs

from ..support.problems import problem, run_method
from ..support.reference_map import DenseCheck

pytestmark = pytest.mark.slow

PAPER = {"sampling": "uniform", "certificate": "lipschitz"}


@functools.cache
def run(method: str, name: str, energy: Energy | None = None, **settings: object) -> Result:
    domain, pose = problem(name)
    return run_method(method, domain, pose, energy, **settings)


def started(method: SubspaceMethod, name: str, p2p_weight: float = 1e5) -> DirectedDescent:
    """``p2p_weight`` is lambda in the shape's own units."""
    domain, pose = problem(name)
    given = Options(align=False, p2p_weight=p2p_weight * domain.cage.unit**2)
    return method.started(
        Inputs(domain=domain, pose=pose, energy=SymmetricDirichlet(), options=given)
    )


@pytest.mark.parametrize("name", ["ell", "ring"])
@pytest.mark.parametrize("method", ["newton-eigen", "newton-shift", "lbfgs", "newton-unmodified"])
def test_one_minimum(method: str, name: str) -> None:
    result, ours = run(method, name), run("newton", name)
    assert result.status.ok, result.message
    assert result.energy == pytest.approx(ours.energy, rel=1e-6)
    assert isinstance(result.map, HarmonicMap)
    assert isinstance(ours.map, HarmonicMap)
    assert result.map.distance(ours.map) < 1e-2
    assert result.certificate is not None
    assert result.certificate.certified


@pytest.mark.parametrize("method", ["gradient-descent", "lbfgs"])
def test_first_order_methods_reach_the_minimum_where_targets_are_soft(method: str) -> None:
    """With a heavy weight, the energy is too stiff for the negative gradient."""
    settings = {"p2p_weight": 1.0, "max_iterations": 2000}
    result, ours = run(method, "ell", **settings), run("newton", "ell", **settings)
    # L-BFGS may end before its tolerance, if double precision shows no lower energy.
    assert result.status.ok, result.message
    closeness = 1e-6 if result.status is Status.CONVERGED else 1e-11
    assert result.energy == pytest.approx(ours.energy, rel=closeness)


@pytest.mark.parametrize("method", ["newton-eigen", "newton-shift"])
def test_modified_hessians_pass_where_the_exact_one_is_indefinite(method: str) -> None:
    ours = run("newton", "bent", align=False)
    assert run(method, "bent", align=False).energy == pytest.approx(ours.energy, rel=1e-6)


@double_precision
def test_newton_eigen_raises_or_mirrors_negative_eigenvalues() -> None:
    """``-V f(L) V^T g`` with the exact Hessian ``V L V^T``, indefinite after one step."""
    at = started(NewtonStaged(), "bent")
    assert at.advance(False).iterations == 1
    h = at.hessian("exact") + at.p2p_hessian
    values, vectors = np.linalg.eigh(h)
    assert values[0] < -1e-3
    # Along each eigenvector, the gradient over the eigenvalue's replacement.
    for absolute, least in ((False, FLOOR / at.unit**2), (True, -values[0])):
        moved = NewtonEigen(absolute=absolute).direction(at)
        along = vectors.T @ moved
        slope = vectors.T @ at.gradient
        assert along[0] == pytest.approx(-slope[0] / least, rel=1e-6)
        assert along[-1] == pytest.approx(-slope[-1] / values[-1], rel=1e-3)


def test_newton_eigen_by_modulus_reaches_the_minimum() -> None:
    result = run("newton-eigen", "bent", align=False, absolute=True)
    assert result.status.ok
    ours = run("newton", "bent", align=False)
    assert result.energy == pytest.approx(ours.energy, rel=1e-6)


def test_unmodified_newton_halts_and_says_so() -> None:
    result = run("newton-unmodified", "bent", align=False)
    assert result.status is Status.INDEFINITE
    assert "not positive definite" in result.message
    assert result.energy > 100 * run("newton", "bent", align=False).energy
    assert result.certificate is not None
    assert result.certificate.certified


@pytest.mark.parametrize("method", ["gauss-newton", "levenberg-marquardt"])
def test_least_squares_reaches_newtons_arap(method: str) -> None:
    result, ours = run(method, "ring", ARAP()), run("newton", "ring", ARAP())
    assert result.status.ok
    assert result.energy == pytest.approx(ours.energy, rel=1e-6)


@pytest.mark.parametrize("method", ["gauss-newton", "levenberg-marquardt"])
@pytest.mark.parametrize("handles", [0, 1, 4])
def test_least_squares_knows_a_perfect_map(method: str, handles: int) -> None:
    """ARAP's least energy is 0, so a relative comparison makes no sense."""
    domain, pose = problem("ell")
    still = Pose(pose.handles[:handles], pose.handles[:handles])
    result = run_method(method, domain, still)
    assert result.status is Status.CONVERGED
    assert result.iterations == 0


@pytest.mark.parametrize("method", ["gauss-newton", "levenberg-marquardt"])
def test_least_squares_ends_where_it_creeps(method: str) -> None:
    """No barrier keeps ARAP from folding: steps shrink, and each is proved on more panels."""
    domain, pose = problem("ell")
    far = pose.with_targets(pose.handles * [8.0, -5.0])
    result = run_method(method, domain, far, align=False)
    assert result.status is Status.BLOCKED
    assert result.iterations < 30
    assert result.certificate is not None
    assert result.certificate.certified


def test_the_staged_solver_is_the_papers() -> None:
    staged, paper = run("newton-staged", "ring", **PAPER), run("newton-paper", "ring")
    assert staged.iterations == paper.iterations
    for a, b in zip(staged.history, paper.history, strict=True):
        assert a.energy == pytest.approx(b.energy, rel=1e-6)


def test_fewer_hessian_samples_reach_the_same_minimum() -> None:
    few = run("newton-staged", "ring", hessian_samples=400, **PAPER)
    assert few.status.ok
    assert few.energy == pytest.approx(run("newton-staged", "ring", **PAPER).energy, rel=1e-8)


@pytest.mark.parametrize(
    "method", ["newton", "newton-eigen", "newton-shift", "lbfgs", "gradient-descent"]
)
def test_energy_decreases(method: str) -> None:
    settings = {"corrections": 0} if method == "newton" else {}
    result = run(method, "ell", **settings)
    history = result.history
    energies = [result.initial.energy, *(step.energy for step in history)]
    assert len(energies) > 3
    assert all(b <= a * (1 + 1e-9) for a, b in itertools.pairwise(energies))
    assert energies[-1] < 0.01 * energies[0]
    assert [step.iteration for step in history] == list(range(1, len(energies)))
    assert np.isfinite([step.time for step in history]).all()


@double_precision
def test_lbfgs_direction_is_that_of_dense_bfgs() -> None:
    """While its memory holds every pair, L-BFGS is BFGS with the textbook's matrix update.

    With a heavy weight, the textbook's inverse loses digits, so this weight is light.
    """
    at = started(LBFGS(memory=5), "ring", p2p_weight=1e3)
    inverse = np.linalg.inv(at.p2p_hessian + np.diag(np.where(at.free > 0, 2e-4 / at.unit**2, 1.0)))
    last = None
    for _ in range(5):
        x, gradient = np.asarray(at.point.coefficients) * at.free, at.gradient
        if last is not None:
            s, y = x - last[0], gradient - last[1]
            assert s @ y > 0
            left = np.eye(len(s)) - np.outer(s, y) / (s @ y)
            inverse = left @ inverse @ left.T + np.outer(s, s) / (s @ y)
        last = (x, gradient)
        direction = at.method.direction(at)
        assert isinstance(direction, np.ndarray)
        expected = -inverse @ gradient
        assert np.linalg.norm(direction - expected) < 1e-6 * np.linalg.norm(expected)
        assert at.advance(False).iterations == 1
        assert at.step is not None
        assert at.step > 0
    assert len(at.memory.pairs) == 4


def test_the_problem_is_set_up_in_double_precision() -> None:
    """Also if JAX's default precision is single: the handles' images agree with the map's."""
    domain, pose = problem("ring")
    at = started(NewtonStaged(), "ring")
    phi = at.discretisation.basis.pad(HarmonicMap.identity(domain).phi)
    rows = at.problem.positional.matrix[: len(pose), : 2 * len(phi)]
    images = rows @ np.concatenate([phi.real, phi.imag])
    np.testing.assert_allclose(images, pose.handles[:, 0], atol=1e-13)


def test_rigid_targets_need_no_step() -> None:
    domain, pose = problem("ell")
    moved = Pose(pose.handles, -pose.handles + [1.0, 2.0])
    for method in ("newton-eigen", "newton-shift", "lbfgs", "gradient-descent"):
        result = run_method(method, domain, moved)
        assert result.status.ok, (method, result.message)
        assert result.energy == pytest.approx(2.0, abs=1e-9)


def test_bdhm_constants_bound_the_derivative_and_are_looser() -> None:
    result = run("newton", "ring")
    map = result.map
    assert isinstance(map, HarmonicMap)
    ours, theirs = certify(map, "lipschitz"), certify(map, "bdhm")
    assert theirs.certified
    assert len(theirs.panels) > len(ours.panels)
    domain = map.domain
    rho = domain.hole_points @ np.array([1, 1j])
    dense = DenseCheck.on(domain.cage.loops_complex, domain.offset_cage.loops_complex, rho, 100_000)
    measured = dense.measure(map.phi, map.psi)
    assert measured.sigma2 >= theirs.sigma2_lower > 0
    assert measured.sigma1 <= theirs.sigma1_upper


@pytest.mark.parametrize("method", ["newton", "newton-eigen", "newton-staged"])
def test_bdhm_constants_certify_as_well(method: str) -> None:
    result = run(method, "ring", certificate="bdhm")
    assert result.certificate is not None
    assert result.certificate.certified
    assert result.energy >= run(method, "ring").energy * (1 - 1e-5)
