"""A solve from end to end on small domains: it converges, is certified, and reports how it went."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from glid_nb._runtime import compilation_clock
from glid_nb.certificate import certify
from glid_nb.energies import (
    AMIPS,
    ARAP,
    CustomEnergy,
    Energy,
    EnergyError,
    ExponentialSymmetricDirichlet,
    SymmetricDirichlet,
)
from glid_nb.geometry import Cage, Domain
from glid_nb.harmonic import HarmonicMap, MapError
from glid_nb.minima import solve
from glid_nb.pose import Pose, PoseError
from glid_nb.solvers import (
    Iteration,
    OptionError,
    Options,
    Progress,
    Result,
    StartError,
    Status,
    newton,
)

from ..support.checks import check_certified
from ..support.domains import domain
from ..support.problems import problem, run_method

pytestmark = pytest.mark.slow  # most of the time is compiling

ELL_HANDLES = np.array([[-2.5, 2.5], [2.5, -2.5], [-2.0, -2.0]])
ELL_TARGETS = np.array([[-4.0, 1.5], [2.0, -0.5], [-2.0, -2.0]])
RING_HANDLES = np.array([[2.2, 0.1], [-2.2, 0.0], [0.0, 2.1]])
RING_TARGETS = np.array([[3.4, 0.8], [-2.2, -0.6], [0.3, 1.7]])


@functools.cache
def ell(energy: Energy | None = None, options: Options | None = None) -> Result:
    return solve(domain("ell"), Pose(ELL_HANDLES, ELL_TARGETS), energy, options)


@functools.cache
def ring(options: Options | None = None) -> Result:
    return solve(domain("ring"), Pose(RING_HANDLES, RING_TARGETS), None, options)


@pytest.mark.parametrize("solved", [ell, ring], ids=["no hole", "one hole"])
def test_converges_to_a_certified_map_on_its_targets(solved: Callable[[], Result]) -> None:
    result = solved()
    assert result.status is Status.CONVERGED
    check_certified(result)
    reached = result.map(result.pose.handles)
    np.testing.assert_allclose(reached, result.pose.targets, atol=1e-4)
    assert result.energy == pytest.approx(result.energy_distortion + result.energy_p2p)
    assert 2 < result.energy_distortion < 4


def test_energy_of_the_history_decreases() -> None:
    result = ell(None, Options(corrections=0))
    energies = [entry.energy for entry in result.history]
    assert len(energies) > 2
    assert all(b < a for a, b in itertools.pairwise(energies))
    assert energies[-1] == result.energy
    assert [entry.iteration for entry in result.history] == list(range(1, len(energies) + 1))
    assert all(entry.corrections == 0 for entry in result.history)


def test_corrections_take_the_place_of_iterations() -> None:
    with_, without = ell(), ell(None, Options(corrections=0))
    assert with_.iterations < without.iterations
    assert sum(entry.corrections or 0 for entry in with_.history) > 0
    assert with_.energy == pytest.approx(without.energy, rel=1e-9)
    check_certified(with_)


def test_paper_settings_find_the_same_minimum() -> None:
    result = ring(Options.paper())
    assert result.status.ok
    check_certified(result)
    assert result.energy == pytest.approx(ring().energy, rel=1e-3)
    assert result.n_panels >= 10_000
    assert result.panels_split == 0


@pytest.mark.parametrize("hessian", ["projected", "exact"])
def test_other_hessians_find_the_same_minimum(hessian: str) -> None:
    result = ell(None, Options(hessian=hessian, max_iterations=400))  # type: ignore[arg-type]
    assert result.status.ok
    assert result.energy == pytest.approx(ell().energy, rel=1e-6)


@pytest.mark.parametrize(
    "energy", [ExponentialSymmetricDirichlet(0.5), AMIPS(0.5)], ids=lambda e: e.name
)
def test_other_energies_converge(energy: Energy) -> None:
    result = ell(energy)
    assert result.status is Status.CONVERGED
    check_certified(result)


def test_arap_stays_certified_though_it_is_no_barrier() -> None:
    collapse = Pose(ELL_HANDLES, np.zeros_like(ELL_HANDLES))
    result = solve(domain("ell"), collapse, ARAP(), Options(max_iterations=30, restarts=0))
    check_certified(result)
    lam = result.options.lambda_on(domain("ell").cage)
    assert result.energy < lam / 2 * (ELL_HANDLES**2).sum()


def test_custom_energy_is_the_closed_form() -> None:
    custom = CustomEnergy(lambda x, y: (x + y) * (1 + 1 / (x - y) ** 2))
    result = ell(custom)
    assert result.energy == pytest.approx(ell().energy, rel=1e-9)
    assert result.iterations == ell().iterations


def test_conformal_maps_have_no_antiholomorphic_part() -> None:
    result = ring(Options(conformal=True))
    assert np.array_equal(result.map.psi, np.zeros_like(result.map.psi))
    assert result.map.k([[2.0, 0.3]])[0] == 0
    assert result.energy_distortion > ring().energy_distortion
    check_certified(result)


def test_the_optimum_is_stationary_for_an_independent_gradient() -> None:
    """Central differences of the energy, evaluated from the map alone, vanish at the result."""
    result = ell(None, Options(p2p_weight=1e5 * domain("ell").cage.unit ** 2))
    panels = result.discretisation.panels
    length = panels.length / panels.length.sum()
    ends = length / 6 + np.bincount(panels.next, length / 6)
    points = np.concatenate([panels.start, panels.middle])
    weights = np.concatenate([ends, length * 2 / 3])
    xy = np.stack([np.real(points), np.imag(points)], axis=-1)

    def total(map: HarmonicMap) -> float:
        fz, fzb = map.wirtinger(xy)
        x, y = np.abs(fz) ** 2, np.abs(fzb) ** 2
        misses = map(result.pose.handles) - result.pose.targets
        return weights @ ((x + y) * (1 + (x - y) ** -2)) + 0.5e5 * (misses**2).sum()

    assert total(result.map) == pytest.approx(result.energy, rel=1e-10)
    rng = np.random.default_rng(0)
    n = result.map.domain.n_coefficients
    for _ in range(4):
        d_phi, d_psi = (rng.normal(size=n) + 1j * rng.normal(size=n) for _ in range(2))

        def moved(t: float, d_phi: np.ndarray = d_phi, d_psi: np.ndarray = d_psi) -> float:
            map = result.map
            return total(HarmonicMap(map.domain, map.phi + t * d_phi, map.psi + t * d_psi))

        h = 1e-6
        slope = (moved(h) - moved(-h)) / (2 * h)
        curvature = (moved(h) - 2 * moved(0) + moved(-h)) / h**2
        assert curvature > 0
        # What a step along this direction could still gain.
        assert slope**2 / (2 * curvature) < 1e-8 * result.energy


def test_a_rigid_motion_of_the_targets_is_found_at_once() -> None:
    turn = np.array([[-1, 0], [0, -1]])
    result = solve(domain("ell"), Pose(ELL_HANDLES, ELL_HANDLES @ turn + [3, 1]))
    assert result.status is Status.CONVERGED
    assert result.energy == pytest.approx(2.0, abs=1e-9)
    np.testing.assert_allclose(result.map([[0.0, -1.0]]), [[3.0, 2.0]], atol=1e-9)


@pytest.mark.parametrize("count", [0, 1])
def test_too_few_handles_leave_the_shape_rigid(count: int) -> None:
    pose = Pose(ELL_HANDLES[:count], ELL_HANDLES[:count] + np.array([1.0, 2.0]))
    result = solve(domain("ell"), pose)
    assert result.status.ok
    assert result.energy == pytest.approx(2.0, abs=1e-9)
    np.testing.assert_allclose(result.map(pose.handles), pose.targets, atol=1e-9)


def test_warm_start_from_a_map_and_from_a_result() -> None:
    cold = ring()
    moved = cold.pose.with_targets(RING_TARGETS + np.array([[0.05, 0.0], [0, 0], [0, 0]]))
    for start in (cold, cold.map):
        warm = solve(domain("ring"), moved, start=start)
        assert warm.status is Status.CONVERGED
        assert 0 < warm.iterations <= cold.iterations
        again = solve(domain("ring"), moved)
        assert warm.energy == pytest.approx(again.energy, rel=1e-8)


def test_start_in_another_gauge_is_the_same_start() -> None:
    """Redundant coefficients (Section 5) of a given map change nothing."""
    cold = ring()
    map = cold.map
    phi, psi = map.phi.copy(), map.psi.copy()
    exterior, hole = map.domain.offset_cage.loops_complex
    phi[: len(exterior)] += 0.7 - 0.2j
    psi[: len(exterior)] -= np.conj(0.7 - 0.2j)
    inner = slice(len(exterior), len(exterior) + len(hole))
    phi[inner] += 0.3 * hole + 1j
    psi[inner] += (0.1 - 2j) * hole - 4
    other = solve(domain("ring"), cold.pose, start=HarmonicMap(map.domain, phi, psi))
    assert other.iterations <= 1
    assert other.energy == pytest.approx(cold.energy, rel=1e-9)


def test_refuses_starts_that_cannot_be_used() -> None:
    pose = Pose(ELL_HANDLES, ELL_TARGETS)
    with pytest.raises(StartError, match="another domain"):
        solve(domain("ell"), pose, start=HarmonicMap.identity(domain("ring")))
    identity = HarmonicMap.identity(domain("ell"))
    folded = HarmonicMap(domain("ell"), np.zeros_like(identity.phi), identity.phi.conj())
    with pytest.raises(StartError, match=r"not certified.*not locally injective"):
        solve(domain("ell"), pose, start=folded)
    with pytest.raises(StartError, match="not conformal"):
        solve(domain("ell"), pose, options=Options(conformal=True), start=ell())


def test_refuses_handles_outside() -> None:
    pose = Pose([[-2.0, -2.0], [2.0, 2.0]], [[0, 0], [1, 1]])
    with pytest.raises(PoseError, match=r"handle 1 at \(2, 2\) lies outside the domain"):
        solve(domain("ell"), pose)
    in_the_hole = Pose([[0.0, 0.0]], [[0, 0]])
    with pytest.raises(PoseError, match=r"handle 0 .* out of its holes"):
        solve(domain("ring"), in_the_hole)


def test_iteration_limit_is_kept_and_said() -> None:
    for limit in (0, 1):
        result = solve(
            domain("ell"), Pose(ELL_HANDLES, ELL_TARGETS), options=Options(max_iterations=limit)
        )
        assert result.status is Status.MAX_ITERATIONS
        assert result.iterations == limit
        assert np.isfinite(result.energy)
        check_certified(result)


def test_callback_sees_certified_maps_and_stops_the_solve() -> None:
    seen: list[Progress] = []

    def stop_at_third(progress: Progress) -> bool:
        seen.append(progress)
        return len(progress.history) >= 3

    result = solve(
        domain("ell"),
        Pose(ELL_HANDLES, ELL_TARGETS),
        options=Options(iterations_per_call=1, corrections=0),
        callback=stop_at_third,
    )
    assert result.status is Status.STOPPED
    assert result.iterations == 3
    assert [len(p.history) for p in seen] == [1, 2, 3]
    for progress in seen:
        assert (progress.sigma2_lower > 0).all()
        assert certify(progress.map).certified
    assert np.array_equal(seen[-1].map.phi, result.map.phi)


def test_a_slow_problem_lets_a_callback_in_after_each_iteration(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    pose = Pose(ELL_HANDLES, ELL_TARGETS)
    fast = solve(domain("ell"), pose)
    monkeypatch.setattr(newton, "WORK_PER_CALL", 1)
    seen: list[int] = []
    slow = solve(domain("ell"), pose, callback=lambda p: bool(seen.append(len(p.history))))
    assert seen == list(range(1, slow.iterations + 1))
    assert slow.energy == pytest.approx(fast.energy, rel=1e-9)


def test_exact_hessian_halts_where_it_is_indefinite() -> None:
    far = Pose(ELL_HANDLES, ELL_HANDLES * [[1, -1]] * 1.5)
    result = solve(domain("ell"), far, options=Options(hessian="exact", align=False, restarts=0))
    assert result.status is Status.INDEFINITE
    assert "not positive definite" in result.message
    check_certified(result)


def test_nothing_compiles_again_inside_a_bucket() -> None:
    """Targets, handles up to the bucket, parameters of energies and weights are only data."""
    shape = domain("ell")
    pose = Pose(ELL_HANDLES, ELL_TARGETS)
    options = Options(restarts=0)
    solve(shape, pose, AMIPS(0.5), options)
    clock = compilation_clock()
    before = clock.programs
    solve(shape, pose.with_targets(ELL_TARGETS + 0.1), AMIPS(0.8), options)
    more = np.vstack([ELL_HANDLES, [[-1.0, -2.0], [1.0, -1.0]]])
    solve(shape, Pose(more, more + 0.05), AMIPS(0.5), options)
    solve(shape, Pose(more[1:], more[1:]), AMIPS(2), Options(p2p_weight=10.0, restarts=0))
    assert clock.programs == before


def test_a_float32_program_beside_it_is_unchanged() -> None:
    program = jax.jit(lambda x: x * 2.5)
    before = program(jnp.ones(3))
    ell()
    after = program(jnp.ones(3))
    assert before.dtype == after.dtype == jnp.float32
    assert jnp.zeros(1).dtype == jnp.float32


def test_option_ranges() -> None:
    for changes, name in [
        ({"p2p_weight": 0.0}, "p2p_weight"),
        ({"p2p_weight": -1.0}, "p2p_weight"),
        ({"sampling": "random"}, "sampling"),
        ({"iterations_per_call": 8}, "iterations_per_call"),
        ({"max_iterations": -1}, "max_iterations"),
    ]:
        with pytest.raises(OptionError, match=name):
            Options(**changes)


def test_unknown_counts() -> None:
    n = domain("ring").n_coefficients
    assert ring().n_unknowns == 4 * n - 10 - 2
    assert ell().n_unknowns == 4 * domain("ell").n_coefficients - 2


def test_narrow_bridge_and_many_holes() -> None:
    """A plate with five holes, its ends pulled and turned."""
    plate = np.array([[-6, -2], [6, -2], [6, 2], [-6, 2]], dtype=float)
    square = 0.6 * np.array([[-1, -1], [-1, 1], [1, 1], [1, -1]])
    holes = [
        square + np.array([x, 0.2 * (-1) ** i]) for i, x in enumerate((-4.4, -2.2, 0, 2.2, 4.4))
    ]
    shape = Domain.from_cage(Cage(plate, holes))
    handles = np.array([[-5.6, 0], [5.6, 0], [0, 1.6]])
    result = solve(shape, Pose(handles, handles + np.array([[0, 1.5], [-0.8, 1.0], [0.2, -0.6]])))
    assert result.status.ok
    check_certified(result)
    assert result.certificate.windings == (0,) * 6


def test_default_energy_is_symmetric_dirichlet() -> None:
    assert ell().energy_measure == SymmetricDirichlet()


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"domain": [[0, 0], [1, 0], [0, 1]]}, "domain must be Domain, not list"),
        ({"pose": [(0, 0)]}, "pose must be Pose, not list; make one with Pose"),
        ({"options": {"align": False}}, "options must be Options or None, not dict"),
        ({"start": np.zeros(3)}, "start must be HarmonicMap, MeshMap, Result or None, not ndarray"),
        ({"callback": 3}, "callback must be Callable or None, not int"),
    ],
)
def test_an_argument_of_the_wrong_type_is_named(given: dict[str, Any], message: str) -> None:
    arguments = {"domain": domain("ring"), "pose": Pose([(2, 0)], [(2, 0)]), **given}
    with pytest.raises(TypeError, match=message):
        solve(**arguments)


def test_an_energy_may_be_named() -> None:
    pose = Pose(ELL_HANDLES, ELL_TARGETS)
    assert solve(domain("ell"), pose, "iso").energy == ell().energy
    with pytest.raises(EnergyError, match="unknown energy 'isometric'; choose one of iso, exp"):
        solve(domain("ell"), pose, "isometric")
    with pytest.raises(EnergyError, match="pass an energy"):
        solve(domain("ell"), pose, 3.0)  # pyright: ignore[reportArgumentType]


def test_times_leave_compilation_out_and_the_start_is_known() -> None:
    # A new class of energy, so this solve surely compiles.
    energy = CustomEnergy(lambda x, y: (x + y) * (1 + 1 / (x - y) ** 2) + 0.5 * y)
    result = solve(domain("ell"), Pose(ELL_HANDLES, ELL_TARGETS), energy)
    times = np.array([entry.time for entry in result.history])
    assert np.isfinite(times).all()
    assert result.compile_time > times.sum() > 0
    assert result.start_energy > result.history[0].energy


def test_the_last_hessian_of_a_result_serves_the_next_solve() -> None:
    """A drag's first step reuses the Hessian, and ends at the same minimum."""
    before = ring()
    assert before.factor is not None
    moved = before.pose.with_targets(RING_TARGETS + np.array([[0.02, 0.0], [0, 0], [0, 0]]))
    by_result, by_map = (solve(domain("ring"), moved, start=s) for s in (before, before.map))
    assert by_result.status is Status.CONVERGED
    assert by_result.energy == pytest.approx(by_map.energy, rel=1e-8)
    check_certified(by_result)
    # The Hessian of a minimum is positive definite. That of a later place need not be.
    assert not by_result.history[0].hessian_modified


def test_another_problem_does_not_take_the_hessian_of_a_result() -> None:
    before = ring()
    for pose, options in (
        (Pose(RING_HANDLES[:2], RING_TARGETS[:2]), Options()),
        (before.pose, Options(p2p_weight=10.0)),
    ):
        warm = solve(domain("ring"), pose, None, options, before)
        cold = solve(domain("ring"), pose, None, options, before.map)
        assert warm.energy == pytest.approx(cold.energy, rel=1e-8)
        assert [e.step for e in warm.history] == [e.step for e in cold.history]


@pytest.mark.parametrize(
    ("step", "gain", "ends"), [(1e-7, 0.1, True), (1, 0.1, False), (1e-7, 1e3, False)]
)
def test_steps_that_creep_to_a_fold_end_a_solve(step: float, gain: float, ends: bool) -> None:
    """Each would be proved on twice as many panels as the one before."""
    energies = 1e6 - gain * np.arange(5)
    entries = [
        Iteration(iteration=i, energy_distortion=float(e), energy_p2p=0.0, time=0.0, step=step)
        for i, e in enumerate(energies)
    ]
    assert newton.has_stalled(entries) is ends
    assert not newton.has_stalled(entries[:4])


@pytest.mark.parametrize(("size", "weight"), [(1, 1e11), (1, 1e16), (1, 1e300), (1e6, 1e5)])
def test_a_weight_beside_which_distortion_is_rounded_off(size: float, weight: float) -> None:
    """However large the weight, in any unit, the minimum is that of a moderate weight."""
    bar = Domain.from_cage(Cage(size * np.array([[-10, -1], [10, -1], [10, 1], [-10, 1]])))
    handles, targets = [[-9, 0], [0, 0], [9, 0]], [[-6, 2], [0, 0], [4, 6]]
    pose = Pose(size * np.array(handles), size * np.array(targets))
    options = Options(p2p_weight=weight * bar.cage.unit**2, restarts=0)
    result = solve(bar, pose, options=options)
    assert result.status is Status.CONVERGED
    assert result.energy == pytest.approx(2.14681, abs=1e-4)
    np.testing.assert_allclose(result.map(pose.handles), pose.targets, atol=1e-11 * size)


def test_a_results_inverse_is_that_of_its_map() -> None:
    result = run_method("newton", *problem("ell"))
    z = np.array([[-2.0, -2.0], [2.0, -1.0], [-1.0, 2.5]])
    assert result.inverse is result.map.inverse
    np.testing.assert_allclose(result.inverse(result.map(z)), z, atol=1e-9)
    with pytest.raises(MapError, match="a map of a mesh has no inverse"):
        run_method("arap-mesh", *problem("ell")).inverse  # noqa: B018
