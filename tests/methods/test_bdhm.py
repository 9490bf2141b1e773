"""Bounded distortion harmonic maps keep their bounds, measured independently."""

from __future__ import annotations

import functools
import itertools

import numpy as np
import pytest
from scipy.optimize import minimize

from glid_nb._runtime import single_blas_thread
from glid_nb.energies import ARAP
from glid_nb.geometry import Cage, Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods import BDHM
from glid_nb.methods.bdhm.program import MARGIN, BoundedProblem, DistortionBounds
from glid_nb.pose import Pose
from glid_nb.solvers import MethodError, Progress, Result, Status

from ..support.problems import problem, run_method
from ..support.reference_map import DenseCheck, Measured

pytestmark = pytest.mark.slow  # most of the time is compiling

pytest.importorskip("clarabel")

LOOSE, TIGHT = (0.8, 5.0, 0.3), (0.16, 1.42, 0.72)


@functools.cache
def run(name: str, bounds: tuple[float, float, float]) -> Result:
    k, sigma1, sigma2 = bounds
    return run_method("bdhm", *problem(name), k=k, sigma1=sigma1, sigma2=sigma2)


def measured(map: HarmonicMap) -> Measured:
    domain = map.domain
    rho = domain.hole_points @ np.array([1, 1j])
    loops = domain.cage.loops_complex
    return DenseCheck.on(loops, domain.offset_cage.loops_complex, rho, 100_000).measure(
        map.phi, map.psi
    )


@pytest.mark.parametrize("bounds", [LOOSE, TIGHT], ids=["loose", "tight"])
@pytest.mark.parametrize("name", ["ell", "ring", "bent"])
def test_the_bounds_hold_densely_and_are_certified(
    name: str, bounds: tuple[float, float, float]
) -> None:
    result = run(name, bounds)
    k, sigma1, sigma2 = bounds
    assert isinstance(result.map, HarmonicMap)
    dense = measured(result.map)
    certificate = result.certificate
    assert certificate is not None
    assert certificate.certified
    assert dense.k <= certificate.k_upper <= k
    assert dense.sigma1 <= certificate.sigma1_upper <= sigma1
    assert dense.sigma2 >= certificate.sigma2_lower >= sigma2
    assert sum(dense.windings) == 0


@pytest.mark.parametrize("name", ["ell", "ring"])
def test_bounds_that_do_not_bind_leave_the_arap_minimum(name: str) -> None:
    """Within wide bounds, alternating frames and programs is ARAP's local/global method."""
    result = run_method("bdhm", *problem(name), tolerance=1e-8, max_iterations=100)
    assert result.status is Status.CONVERGED
    newton = run_method("newton", *problem(name), ARAP())
    # Midpoints against Simpson's rule.
    assert result.energy == pytest.approx(newton.energy, rel=2e-3)


def test_bounds_that_bind_cost_energy() -> None:
    loose, tight = run("ring", LOOSE), run("ring", TIGHT)
    certificate = tight.certificate
    assert certificate is not None
    assert certificate.sigma1_upper > 0.97 * TIGHT[1]
    assert tight.energy > loose.energy


def test_every_iterate_keeps_the_bounds() -> None:
    domain, pose = problem("ring")
    seen = []

    def look(progress: Progress) -> None:
        seen.append(measured(progress.map))

    k, sigma1, sigma2 = TIGHT
    run_method(
        "bdhm", domain, pose, k=k, sigma1=sigma1, sigma2=sigma2, max_iterations=3, callback=look
    )
    assert len(seen) == 4
    for dense in seen:
        assert dense.k <= k
        assert dense.sigma1 <= sigma1
        assert dense.sigma2 >= sigma2


@pytest.mark.parametrize(
    ("name", "value"),
    [("k", 1.0), ("k", 0.0), ("sigma1", 1.0), ("sigma2", 1.0), ("sigma2", -0.1), ("k", "no")],
)
def test_bounds_out_of_range_are_refused(name: str, value: object) -> None:
    with pytest.raises(MethodError, match=f"'{name}' .* must be a finite number"):
        BDHM(**{name: value})


def test_it_goes_on_from_a_map_within_its_bounds() -> None:
    tight = run("ring", TIGHT)
    assert isinstance(tight.map, HarmonicMap)
    bounds = dict(zip(("k", "sigma1", "sigma2"), LOOSE, strict=True))
    settings = {"align": False, "max_iterations": 0, **bounds}
    again = run_method("bdhm", *problem("ring"), start=tight.map, **settings)
    assert again.energy == pytest.approx(tight.energy, rel=1e-9)
    # A map beyond the bounds is replaced by the identity.
    beyond = {**settings, "sigma1": 1.2}
    anew = run_method("bdhm", *problem("ring"), start=tight.map, **beyond)
    assert anew.energy_distortion == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(("name", "bounds"), [("ring", TIGHT), ("bent", LOOSE), ("bent", TIGHT)])
def test_the_energy_never_rises_and_the_map_is_the_best(
    name: str, bounds: tuple[float, float, float]
) -> None:
    result = run(name, bounds)
    assert result.status is Status.CONVERGED
    energies = np.array([step.energy for step in (result.initial, *result.history)])
    assert (np.diff(energies) <= 0).all()
    assert result.energy == energies.min()


def test_within_binding_bounds_it_finds_the_least_energy_up_to_the_margin() -> None:
    """An unconstrained optimiser with a penalty, which stays below the constrained minimum."""
    result = run("ring", TIGHT)
    assert result.status is Status.CONVERGED
    start = run("ring", LOOSE).map
    assert isinstance(start, HarmonicMap)
    full, tightened = penalised(start, 1.0), penalised(start, 1 - MARGIN)
    assert full < tightened < 1.003 * full
    # The penalty's own error, and the rest at the tolerance.
    assert full < result.energy < (1 + 3e-4) * tightened


def penalised(start: HarmonicMap, share: float, weight: float = 1e4, count: int = 80) -> float:
    """The least energy within a share of each bound's range at dense samples, from below."""
    domain, pose = problem("ring")
    problem_ = BoundedProblem(HarmonicMap.identity(domain), pose, 1e5)
    k, sigma1, sigma2 = TIGHT
    along = (np.arange(count) + 0.5) / count
    loops = domain.cage.loops_complex
    edges = np.concatenate([np.stack([loop, np.roll(loop, -1)], axis=1) for loop in loops])
    points = (edges[:, :1] + (edges[:, 1:] - edges[:, :1]) * along).ravel()
    samples = problem_.samples_at(points)
    weight /= len(points)

    def cost(v: np.ndarray) -> tuple[float, np.ndarray]:
        f, g = samples.values(v)
        r, s = np.abs(f), np.abs(g)
        over_k = np.maximum(s - share * k * r, 0)
        over_1 = np.maximum(r + s - 1 - share * (sigma1 - 1), 0)
        over_2 = np.maximum(1 - share * (1 - sigma2) - r + s, 0)
        penalty = weight / 2 * (over_k**2 + over_1**2 + over_2**2).sum()
        by_f = weight * (over_1 - over_2 - share * k * over_k) * f / r
        by_g = weight * (over_k + over_1 + over_2) * g / np.maximum(s, 1e-12)
        slope = np.real(samples.a.conj().T @ by_f + samples.b.conj().T @ by_g)
        return sum(problem_.energies(v)) + penalty, problem_.gradient(v) + slope

    with single_blas_thread():
        options = {"maxiter": 1000, "ftol": 1e-12, "gtol": 1e-8, "maxcor": 40}
        v = problem_.unknowns(start, align=False)
        return float(minimize(cost, v, jac=True, method="L-BFGS-B", options=options).fun)


def test_a_run_that_is_not_stationary_does_not_claim_to_have_converged(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Without a proof, the start is returned, with what stopped the method."""
    started = DistortionBounds.hold
    calls = iter([True])
    monkeypatch.setattr(
        DistortionBounds, "hold", lambda self, c: next(calls, False) and started(self, c)
    )
    result = run_method("bdhm", *problem("ring"))
    assert result.status is Status.BLOCKED
    assert "did not converge: no step toward the cone program's solution" in result.message
    assert result.iterations == 0


def test_an_unmoved_pose_is_stationary_at_once() -> None:
    domain, pose = problem("ring")
    result = run_method("bdhm", domain, Pose(pose.handles, pose.handles))
    assert result.status is Status.CONVERGED
    assert result.iterations == 0


def test_a_map_that_has_used_up_the_margin_goes_on() -> None:
    """sigma_1 is active along a whole side here, and no program that admits the map proves a
    step."""
    domain = Domain.from_cage(Cage([[0, 0], [4, 0], [4, 2], [0, 2]]))
    pose = Pose([[0.5, 1], [2, 1], [3.5, 1]], [[0.5, 1], [2, 1.3], [3.4, 0.8]])
    result = run_method("bdhm", domain, pose, k=0.4, sigma1=2.0, sigma2=0.6)
    assert result.status is Status.CONVERGED, result.message
    energies = [step.energy for step in (result.initial, *result.history)]
    assert all(b <= a for a, b in itertools.pairwise(energies))
    # The place where it was blocked without them.
    assert result.energy < 0.99 * 50.98
    assert result.certificate is not None
    assert result.certificate.sigma1_upper <= 2.0
