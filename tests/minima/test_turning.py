"""Paths of targets along which the parts of a shape turn, either way round."""

import functools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from glid_nb.geometry import Cage, Domain, meshes
from glid_nb.harmonic import HarmonicMap
from glid_nb.minima import solve
from glid_nb.minima.handle_turns import handle_turns
from glid_nb.minima.reversals import cost, reversals
from glid_nb.minima.waypoints import waypoints
from glid_nb.minima.ways import FAR
from glid_nb.pose import Pose
from glid_nb.solvers import Options, Result
from glid_nb.solvers.problem import aligned

DOMAIN = Domain.from_cage(Cage([[-10, -1], [10, -1], [10, 1], [-10, 1]]))
BAR = np.array([[-9, -0.5], [-9, 0.5], [0, -0.5], [0, 0.5], [9, -0.5], [9, 0.5]])


def turned(points: np.ndarray, degrees: float, centre: complex = 0) -> np.ndarray:
    z = (points @ np.array([1, 1j]) - centre) * np.exp(1j * np.deg2rad(degrees)) + centre
    return np.stack([z.real, z.imag], axis=1)


@given(degrees=st.floats(-179, 179), x=st.floats(-20, 20))
def test_a_rigid_motion_turns_no_line_and_stays_rigid(degrees: float, x: float) -> None:
    pose = Pose(BAR, turned(BAR, degrees) + np.array([x, 0]))
    turning = handle_turns(aligned(HarmonicMap.identity(DOMAIN), pose), pose)
    np.testing.assert_allclose([line.turn for line in turning.lines], 0, atol=1e-9)
    assert not reversals(turning, FAR[0])
    assert not any(line.squeezed for line in turning.lines)
    distances = [np.linalg.norm(BAR - BAR[i], axis=1) for i in range(len(BAR))]
    for _, waypoint in waypoints(turning):
        for i, expected in enumerate(distances):
            there = np.linalg.norm(waypoint.targets - waypoint.targets[i], axis=1)
            np.testing.assert_allclose(there, expected, atol=1e-9)


@functools.cache
def half_turned() -> tuple[Pose, HarmonicMap]:
    """The bar's right half turns by 170 degrees."""
    targets = BAR.copy()
    targets[4:] = turned(BAR[4:], 170)
    pose = Pose(BAR, targets)
    map = solve(DOMAIN, pose, options=Options(restarts=0)).map
    assert isinstance(map, HarmonicMap)
    return pose, map


@pytest.mark.slow
@pytest.mark.parametrize("back", [0, 90, -150])
def test_a_line_turns_by_as_much_as_the_map_turns_it(back: float) -> None:
    """However the whole shape is turned, the reversed way leads to the same targets."""
    pose, map = half_turned()
    pose = pose.with_targets(turned(pose.targets, back))
    turning = handle_turns(aligned(map, pose), pose)
    turns = {line.child: np.rad2deg(line.turn) for line in turning.lines}
    far = max(turns, key=lambda child: abs(turns[child]))
    assert abs(turns.pop(far)) == pytest.approx(170, abs=10)
    assert all(abs(turn) < 20 for turn in turns.values())
    (reversed,) = reversals(turning, FAR[0])
    assert reversed == (far,)
    z, w = BAR @ np.array([1, 1j]), pose.targets @ np.array([1, 1j])
    for lines in ((), reversed):
        way = [BAR, *(waypoint.targets for _, waypoint in waypoints(turning, lines)), pose.targets]
        # The turning line, compared with a line at the end that does not turn.
        line, body = (
            np.array([points[i] - points[j] for points in way]) @ np.array([1, 1j])
            for i, j in ((4, 2), (2, 0))
        )
        whole = np.angle((line / body)[1:] / (line / body)[:-1]).sum()
        assert (whole < 0) == bool(lines)
        wanted = (w[4] - w[2]) / (w[2] - w[0]) / ((z[4] - z[2]) / (z[2] - z[0]))
        assert np.exp(1j * whole) == pytest.approx(wanted / abs(wanted))


@given(seed=st.integers(0, 10**6), count=st.integers(1, 9))
def test_waypoints_lead_evenly_to_the_targets(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    handles = rng.uniform([-9, -0.9], [9, 0.9], size=(count, 2))
    pose = Pose(handles, rng.normal(size=(count, 2)))
    turning = handle_turns(HarmonicMap.identity(DOMAIN), pose)
    for lines in ((), *reversals(turning, 0.1)):
        # They begin turned as a whole.
        along = [one.pose.targets for one in waypoints(turning, lines)]
        line = np.array([*along, pose.targets])
        assert np.isfinite(line).all()
        for each in turning.lines:
            z = (line[:, each.child] - line[:, each.parent]) @ np.array([1, 1j])
            assert np.abs(np.angle(z[1:] / z[:-1])).max() < np.deg2rad(60.1)


@pytest.mark.slow
def test_turns_cost_what_the_solver_finds_while_they_are_small() -> None:
    """Two ends of a bar, turned by these degrees. Reversed, they would turn by nearly 360."""
    energies, costs = list[float](), list[float]()
    for degrees in (1, 2):
        targets = BAR.copy()
        targets[4:], targets[:2] = turned(BAR[4:], degrees), turned(BAR[:2], -2 * degrees)
        pose = Pose(BAR, targets)
        result = solve(DOMAIN, pose, options=Options(restarts=0))
        assert isinstance(result.map, HarmonicMap)
        turning = handle_turns(result.map, pose)
        energies.append(result.energy - 2)
        costs.append(cost(turning))
        around = cost(turning, (max(turning.lines, key=lambda line: abs(line.turn)).child,))
        assert around > 1e3 * costs[-1]
    np.testing.assert_allclose(energies, 4 * np.array(costs), rtol=0.02)


def test_targets_that_coincide_are_no_division_by_zero() -> None:
    pose = Pose([[0, 0], [1, 0], [2, 0]], [[0, 0], [0, 0], [0, 0]])
    turning = handle_turns(HarmonicMap.identity(DOMAIN), pose)
    assert all(np.isfinite(waypoint.targets).all() for _, waypoint in waypoints(turning))


def test_the_ways_of_handles_that_nearly_coincide_are_finite() -> None:
    handles = np.array([[0, 0], [1e-9, 0], [5, 0.5]])
    pose = Pose(handles, handles + np.array([[0, 1e-12], [0, 0], [0, -1e-12]]))
    turning = handle_turns(HarmonicMap.identity(DOMAIN), pose)
    costs = np.array([cost(turning, (line.child,)) for line in turning.lines])
    assert np.isfinite(costs).all()
    assert costs.min() > 0
    assert cost(turning) > 0


def test_a_line_is_squeezed_where_its_targets_are_closer_and_it_stays_straight() -> None:
    handles = np.array([[-9, 0], [0, 0], [9, 0.0]])
    identity = HarmonicMap.identity(DOMAIN)
    for factor, expected in ((0.8, True), (1.0, False), (1.2, False)):
        turning = handle_turns(identity, Pose(handles, factor * handles))
        assert [line.squeezed for line in turning.lines] == [expected] * 2


def test_other_handles_of_a_shape_need_no_other_mesh(monkeypatch: pytest.MonkeyPatch) -> None:
    made, delaunay = list[int](), meshes.constrained_delaunay

    def counted(vertices: np.ndarray, loops: list[np.ndarray]) -> np.ndarray:
        made.append(len(vertices))
        return delaunay(vertices, loops)

    monkeypatch.setattr(meshes, "constrained_delaunay", counted)
    identity = HarmonicMap.identity(Domain.from_cage(Cage([[0, 0], [3, 0], [3, 1], [0, 1]])))
    for handles in ([[1, 0.5]], [[1, 0.5], [2, 0.5]], [[2, 0.5], [2.5, 0.4]]):
        handle_turns(identity, Pose(handles, handles))
    assert len(made) == 1


@pytest.mark.slow
def test_the_map_of_lines_led_the_other_way_round_is_known_by_its_key() -> None:
    pose, first = half_turned()
    turning = handle_turns(first, pose)
    (lines,) = [lines for lines in reversals(turning, np.deg2rad(80)) if len(lines) == 1]
    start: Result | None = None
    for _, waypoint in waypoints(turning, lines):
        start = solve(first.domain, waypoint, start=start)
    other = solve(first.domain, pose, start=start)
    assert handle_turns(other.map, pose).key() == turning.key(lines) != turning.key()
