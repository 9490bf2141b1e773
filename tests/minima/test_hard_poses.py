"""Extreme poses: the solver ends, the map is certified, and nothing is NaN."""

from __future__ import annotations

import dataclasses
import functools
import itertools
import json
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from glid_nb import samples
from glid_nb.geometry import Cage, Domain
from glid_nb.geometry._loops import subdivided
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.trace import trace
from glid_nb.minima import solve
from glid_nb.minima.known import SAME_ENERGY
from glid_nb.pose import Pose
from glid_nb.solvers import Options, Progress, Status

from ..support.cages import KINDS as CAGES
from ..support.cages import random_cage
from ..support.checks import Turn, check_certified, turned
from ..support.domains import NAMES, circle, domain, real

pytestmark = pytest.mark.slow  # most of the time is compiling

INSIDE = {
    "ell": [[-2.5, 2.5], [2.5, -2.5], [-2.0, -2.0], [-0.5, -0.5]],
    "ring": [[2.1, 0.1], [-2.1, 0.0], [0.0, 2.1], [0.1, -2.0]],
    "twin": [[-3.5, 1.5], [3.5, -1.5], [0.0, 0.0], [3.3, 1.3]],
    "triple": [[0.0, 0.0], [3.2, 1.6], [-3.0, -1.0], [0.3, -3.2]],
}


def absurd_targets(handles: np.ndarray, kind: str, rng: np.random.Generator) -> np.ndarray:
    return {
        "random": rng.normal(size=handles.shape) * 5,
        "far away": handles + rng.normal(size=2) * 1e3,
        "one far away": handles + np.eye(len(handles), 1) * [[200.0, 50.0]],
        "swapped": handles[rng.permutation(len(handles))],
        "all equal": np.tile(rng.normal(size=2), (len(handles), 1)),
        "mirrored": handles * [-1, 1],
        "turned": -handles,
    }[kind]


KINDS = ["random", "far away", "one far away", "swapped", "all equal", "mirrored", "turned"]


@given(st.sampled_from(NAMES), st.sampled_from(KINDS), st.integers(0, 2**32 - 1))
@settings(max_examples=12)
def test_absurd_targets_end_certified(name: str, kind: str, seed: int) -> None:
    handles = np.array(INSIDE[name])
    targets = absurd_targets(handles, kind, np.random.default_rng(seed))
    options = Options(max_iterations=40, restarts=0)
    check_certified(solve(domain(name), Pose(handles, targets), options=options))


@given(st.sampled_from(CAGES), st.integers(0, 2**32 - 1), st.integers(0, 6), st.sampled_from(KINDS))
@settings(max_examples=5)
def test_tangled_domains_end_certified(cage_kind: str, seed: int, holes: int, kind: str) -> None:
    cage = random_cage(cage_kind, seed, holes)
    shape = Domain.from_cage(cage)
    # Larger shapes share no compiled program, and compiling takes most of the time.
    assume(shape.n_coefficients <= 60)
    rng = np.random.default_rng(seed)
    low, high = np.reshape(cage.bounds, (2, 2))
    points = rng.uniform(low, high, size=(400, 2))
    points = points[cage.contains(points)][:4]
    options = Options(max_iterations=25, restarts=0)
    check_certified(solve(shape, Pose(points, absurd_targets(points, kind, rng)), options=options))


@functools.cache
def bar() -> Domain:
    xs = np.linspace(-8, 8, 17)
    lower, upper = np.stack([xs, 0 * xs - 1], 1), np.stack([xs[::-1], 0 * xs + 1], 1)
    return Domain.from_cage(Cage(np.vstack([lower, upper])))


@pytest.mark.parametrize("per_call", [1, 4, 7])
def test_a_bar_tied_into_a_loop_splits_panels_and_meets_its_targets(per_call: int) -> None:
    """The ends swap places: far from the identity, but a certified map exists.

    On the way, the Hessian is singular to rounding and needs an epsilon. This must not stay,
    because the minimum has soft directions.
    """
    handles = np.array([[-7.5, 0], [-3, 0], [3, 0], [7.5, 0]])
    targets = np.array([[5, 1], [-2, 3], [2, 3], [-5, 1]])
    options = Options(iterations_per_call=per_call)
    result = solve(bar(), Pose(handles, targets), options=options)
    assert result.status.ok
    assert len(result.history) < 100
    check_certified(result)
    np.testing.assert_allclose(result.map(handles), targets, atol=1e-3)


def test_a_coarse_certificate_does_not_end_a_solve() -> None:
    """Panels that refuse a step are split, and the solve continues to its minimum."""
    handles = np.array(INSIDE["ell"])
    targets = np.random.default_rng(0).normal(size=handles.shape) * 4
    iterations: list[int] = []
    result = solve(
        domain("ell"),
        Pose(handles, targets),
        options=Options(restarts=0, iterations_per_call=1),
        callback=lambda progress: iterations.append(len(progress.history)),
    )
    assert result.status.ok
    assert result.panels_split > 0
    check_certified(result)
    # The callback is also called after a call without a step, so splitting can be stopped.
    assert any(before == after for before, after in itertools.pairwise(iterations))


def test_restarts_keep_the_best_attempt() -> None:
    handles = np.array(INSIDE["ell"])
    pose = Pose(handles, handles[[1, 3, 0, 2]] * 1.5)
    alone = solve(domain("ell"), pose, options=Options(restarts=0))
    several = solve(domain("ell"), pose)
    assert several.energy < 0.7 * alone.energy
    assert several.attempts[0].name == "direct"
    assert several.attempts[0].energy == pytest.approx(alone.energy)
    ended = [a.energy for a in several.attempts if not a.given_up]
    assert several.energy == pytest.approx(min(ended))
    check_certified(several)


def test_ends_that_turn_over_do_so_in_opposite_directions_where_that_is_better() -> None:
    """Both ends are upside down. The direct way, and turning both alike, end 8 % higher."""
    domain = Domain.from_cage(Cage([[-10, -1], [10, -1], [10, 1], [-10, 1]]))
    handles = np.array([[-9, -0.5], [-9, 0.5], [9, -0.5], [9, 0.5]])
    energies: list[float] = []
    pose = Pose(handles, handles * [1, -1])
    result = solve(domain, pose, callback=lambda p: energies.append(p.energy) or False)
    reached = {a.name: a.energy for a in result.attempts if not a.given_up}
    assert result.energy * (1 - SAME_ENERGY) < min(reached.values())
    assert result.energy < 0.95 * reached["direct"]
    check_certified(result)
    # It can be stopped on another way. Then the first way's result is the best so far.
    starts: list[float] = []

    def stop(progress: Progress) -> bool:
        if progress.initial.energy not in starts:
            starts.append(progress.initial.energy)
        return len(starts) > 1

    stopped = solve(domain, pose, callback=stop)
    assert stopped.status is Status.STOPPED
    assert stopped.energy == pytest.approx(reached["direct"], rel=1e-6)
    check_certified(stopped)


def test_a_squeezed_bar_bends_instead() -> None:
    """Aligned with its targets, the bar stays straight, because no side is preferred."""
    domain = Domain.from_cage(Cage([[-10, -0.5], [10, -0.5], [10, 0.5], [-10, 0.5]]))
    end = np.array([2.851, 6.8829])
    pose = Pose([[-9.5, 0], [0, 0], [9.5, 0]], [-end, [0, 0], end])
    identity = solve(domain, pose, options=Options(restarts=0, align=False))
    result = solve(domain, pose)
    assert result.energy == pytest.approx(identity.energy, rel=1e-6)
    assert result.attempts[0].energy > 1.03 * result.energy
    check_certified(result)


def sample(name: str) -> tuple[Domain, np.ndarray]:
    pose = Pose.from_dict(json.loads(samples.pose_path(name, "extreme").read_text()))
    return Domain.from_cage(trace(samples.image(name)).cage), pose.handles


def test_a_limb_that_curls_is_led_along_an_arc() -> None:
    """The frog's arm turns by -122 degrees, and its hand by 66 degrees less, not as far again."""
    domain, _ = sample("frog")
    ends = [2.74 - 6.64j, -2.45 + 5.53j, 4.27 + 0.24j, -1.84 - 1.88j, 2.43 + 4.47j, -1.84 - 6.11j]
    handles = real(np.array([*ends, -0.01 + 1.3j]))
    turns = [([5], -1.84 - 3.29j, 101.25), ([2], -0.01 + 1.3j, -122.29)]
    result = solve(domain, Pose(handles, turned(handles, turns)))
    assert result.attempts[-1].name == "along an arc at 2"
    assert result.energy < 0.8 * result.attempts[0].energy


def test_a_limb_that_is_wound_up_is_led_along_no_arc() -> None:
    """The teapot's spout is turned by 120 degrees: its line turns by 92, its tip by -36."""
    domain, handles = sample("teapot")
    z = handles @ np.array([1, 1j])
    body = z[np.argmin(np.abs(z - z.mean()))]
    tip = int(np.argmax(np.abs(z - body)))
    pivot = body + 0.4 * (z[tip] - body)
    z[tip] = pivot + np.exp(2j * np.pi / 3) * (z[tip] - pivot)
    result = solve(domain, Pose(handles, real(z)))
    assert [attempt.name for attempt in result.attempts] == ["direct", "ends the other way round"]
    assert result.energy < 0.95 * result.attempts[0].energy


def bent_c() -> tuple[Domain, np.ndarray, list[Turn], float]:
    """Two lines that meet at the root turn by 129 and 145 degrees relative to each other."""
    out, handles = np.linspace(-2.6, 2.6, 25), 8.5 * np.exp(1j * np.linspace(-2.4, 2.4, 7))
    outline = np.concatenate([10 * np.exp(1j * out), 7 * np.exp(-1j * out)])
    ends = [
        ([5, 6], handles[4], 129.0),
        ([0], handles[:2].mean(), -130.0),
        ([0, 1, 2], handles[3], -145.0),
    ]
    return Domain.from_cage(Cage(real(outline))), real(handles), ends, 2.8104


def bent_ring() -> tuple[Domain, np.ndarray, list[Turn], float]:
    """The rigid start, turned by 143 degrees, misleads."""
    handles = circle(6, 8)
    z = handles @ np.array([1, 1j])
    turns: list[Turn] = [([4], z[3:5].mean(), 112.51), ([0, 1, 5], z[1:3].mean(), -117.32)]
    return Domain.from_cage(Cage(circle(40, 10), [circle(30, 6)])), handles, turns, 4.6354


def bent_frog() -> tuple[Domain, np.ndarray, list[Turn], float]:
    """Hands, legs and body: lines that turn alike are reversed together."""
    domain, handles = sample("frog")
    z = handles @ np.array([1, 1j])
    turns = [([0, 1], z[2], 133.85), ([6, 7], z[5], -113.33)]
    return domain, handles, [*turns, ([0, 1, 2], z[5], 125)], 10.4004


def bent_teapot() -> tuple[Domain, np.ndarray, list[Turn], float]:
    """The handle turns by 143 degrees. For such a short part, 217 degrees the other way cost
    less."""
    domain, handles = sample("teapot")
    return domain, handles, [([5], handles[1] @ np.array([1, 1j]), 142.5626)], 4.0723


def wound_frog() -> tuple[Domain, np.ndarray, list[Turn], float]:
    """The first way twists a hand. A better map exists with the same turns of the lines."""
    domain, handles = sample("frog")
    turns = [([7], -0.0675 + 4.1325j, 162.6), ([3], 0.6j, -154.7), ([6, 7], 1.16j, -131.8)]
    return domain, handles, turns, 12.013


def bent_ell() -> tuple[Domain, np.ndarray, list[Turn], float]:
    """One arm turns twice: once at its held end, and half at the corner."""
    outline = [
        [-10, -8],
        [8, -8],
        [8, -5.5],
        [0, -5.5],
        [-7.5, -5.5],
        [-7.5, 0],
        [-7.5, 8],
        [-10, 8],
    ]
    ends = [7.45 - 6.96j, -8.8 + 7.63j, -7.29 - 7.48j, -7.89 - 0.18j]
    handles = real(np.array([*ends, -0.37 - 5.92j, -7.89 + 3.99j, 3.54 - 7.48j]))
    turns = [([0, 6], -0.37 - 5.92j, 171.6), ([0, 4, 6], -5.24 - 7.02j, -158.1)]
    return Domain.from_cage(Cage(outline)), handles, turns, 3.0055


@pytest.mark.parametrize("bent", [bent_c, bent_ring, bent_frog, bent_teapot, wound_frog, bent_ell])
def test_limbs_bent_by_over_100_degrees_end_near_the_best_minimum_known(bent: Any) -> None:
    domain, handles, turns, best = bent()
    result = solve(domain, Pose(handles, turned(handles, turns)))
    assert result.energy < 1.02 * best
    check_certified(result)


def test_after_a_gain_turns_that_may_cost_a_little_more_are_still_tried() -> None:
    """A C closes to the other side. Its second best way is found first."""
    out = np.linspace(-2.4, 2.4, 25)
    outline = np.concatenate([10 * np.exp(1j * out), 7 * np.exp(-1j * out)])
    handles = [(-5.66, -6.34), (6.12, -5.9), (6.12, 5.9), (-5.66, 6.34)]
    pose = Pose(handles, [(0, 0), (5.89, 9.82), (14.58, 2.35), (5.75, -4.95)])
    result = solve(Domain.from_cage(Cage(real(outline))), pose)
    assert result.energy < 1.02 * 2.4439
    assert sum(not attempt.given_up for attempt in result.attempts) == 3


def test_what_the_better_map_winds_up_is_led_the_other_way_round_too() -> None:
    """An arm of an L turns twice. The first map twists neither of its ends."""
    domain, *_ = bent_ell()
    handles = [(-9.4, 7.63), (7.45, -5.92), (-7.29, -7.48), (-8.19, 0.34), (-0.07, -7.48)]
    targets = [handles[0], (-4.73, -3.74), *handles[2:4], (-5.84, -11.34), (-9.4, -3.83)]
    result = solve(domain, Pose([*handles, targets[-1]], targets))
    names = [attempt.name for attempt in result.attempts]
    assert names == ["direct", "the other way round at 1", "ends the other way round"]


@pytest.mark.parametrize("turn", ["end", "over"])
def test_a_bar_of_four_vertices_bends_as_a_finely_divided_one(turn: str) -> None:
    """An end turned by 180 degrees, or set upside down and bent over the other."""
    corners = np.array([[-10, -1], [10, -1], [10, 1], [-10, 1]])
    fine = [subdivided(corners @ np.array([1, 1j]), np.array([20, 2, 20, 2]))]
    handles = np.array([[-9, -0.5], [-9, 0.5], [9, -0.5], [9, 0.5]])
    targets = handles.copy()
    targets[2:] = [18, 0] - handles[2:] if turn == "end" else [0, 6] - handles[2:]
    four, many = (
        solve(Domain.from_cage(cage), Pose(handles, targets))
        for cage in (Cage(corners), Cage(real(fine[0])))
    )
    assert four.status is many.status is Status.CONVERGED
    assert four.energy < 1.05 * many.energy
    assert many.energy < 3


def test_the_paper_settings_never_return_an_uncertified_map() -> None:
    handles = np.array(INSIDE["ring"])
    pose = Pose(handles, handles[[1, 0, 3, 2]])
    result = solve(domain("ring"), pose, options=Options.paper(max_iterations=40))
    check_certified(result)
    assert result.status in (Status.BLOCKED, Status.MAX_ITERATIONS, Status.CONVERGED)


def test_values_are_immutable() -> None:
    result = solve(domain("ell"), Pose([[-2.0, -2.0]], [[0.0, 0.0]]))
    with pytest.raises(dataclasses.FrozenInstanceError):
        result.energy = 0.0  # type: ignore[misc]
    with pytest.raises(ValueError, match="read-only"):
        result.map.phi[0] = 0
    assert isinstance(result.map, HarmonicMap)


def test_arap_meets_its_targets_where_the_direct_way_is_blocked() -> None:
    """No barrier keeps ARAP's Newton steps from the limit of injectivity. A detour does."""
    pose = Pose([[-7.5, 0], [-3, 0], [3, 0], [7.5, 0]], [[2, 0], [-3, 0], [3, 0], [-2, 0]])
    direct = solve(bar(), pose, "arap", Options(restarts=0))
    result = solve(bar(), pose, "arap", Options(restarts=1))
    check_certified(result)
    assert direct.status is Status.BLOCKED
    assert [attempt.name for attempt in result.attempts] == [
        "direct",
        "from the symmetric Dirichlet minimum",
    ]
    assert result.energy < 0.01 * direct.energy


def test_mips_meets_its_targets_where_the_direct_way_is_blocked() -> None:
    """A limb may shrink to nothing on the way. Then other ways end lower."""
    pose = Pose([[-8, 0], [0, 0], [8, 0]], [[7.5, 3.0], [0, 0], [8, 0]])
    direct = solve(bar(), pose, "mips", Options(restarts=0))
    result = solve(bar(), pose, "mips")
    check_certified(result)
    assert direct.status is Status.BLOCKED
    assert direct.energy > 1000
    assert len(result.attempts) == 2
    assert result.energy < 1.1


def test_an_end_that_is_wound_up_is_led_the_other_way_round() -> None:
    domain = Domain.from_cage(Cage([[-10, -1], [10, -1], [10, 1], [-10, 1]]))
    pose = Pose([[9.6, -0.6], [-9.2, -0.3], [0.3, -0.3]], [[-2.5, -2.1], [1.4, -9.7], [0.3, -0.3]])
    direct = solve(domain, pose, options=Options(restarts=0))
    result = solve(domain, pose)
    check_certified(result)
    assert [a.name for a in result.attempts] == ["direct", "ends the other way round"]
    assert direct.energy > 1.1 * result.energy


def test_a_wanted_angle_is_met_from_the_map_without_it_where_that_is_better() -> None:
    """Turned by 127 degrees at the tip of a limb that folds back.

    The map that is free there tells from which side. The direct way ends 15 % higher.
    """
    along = np.exp(2j * np.pi * (np.arange(3) / 3 + 0.25))[:, None]
    star = (along * [1.8 - 1j, 10 - 1j, 10 + 1j, 1.8 + 1j]).ravel()
    domain = Domain.from_cage(Cage(np.stack([star.real, star.imag], axis=1)))
    handles = np.array([[8.3, -4.5], [-7.8, -4.5], [-0.3, 9.5]])
    targets = np.array([[8.3, -4.5], [-7.8, -4.5], [-0.7, -3.7]])
    pose = Pose(handles, targets, angles=[np.nan, 0, -2.2])
    direct = solve(domain, pose, options=Options(restarts=0))
    result = solve(domain, pose)
    check_certified(result)
    assert [a.name for a in result.attempts] == ["direct", "without its angles first"]
    assert direct.energy > 1.1 * result.energy
    assert result.map.wirtinger(handles[2:])[0] == pytest.approx(
        abs(result.map.wirtinger(handles[2:])[0]) * np.exp(-2.2j), abs=1e-2
    )
