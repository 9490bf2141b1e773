"""Motion as a value: where it passes, its proof, its refusals, and its file."""

from __future__ import annotations

import itertools
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb import Cage, Domain, Motion, Pose, samples, solve, trace
from glid_nb.certificate import certificate_of, certify
from glid_nb.certificate.pieces import certify_pieces
from glid_nb.geometry import as_points, uniform_panels
from glid_nb.harmonic import HarmonicMap
from glid_nb.io import load_pose
from glid_nb.motion import MotionError, bounded, curve
from glid_nb.motion.boundary import boundary_of
from glid_nb.motion.easing import Easing, Handles, eased, sample_times

from ..support.domains import MANY_HOLES, NAMES, circle, dense_check, domain, random_map, turned
from .test_pieces import check

pytestmark = pytest.mark.slow


def same(a: HarmonicMap, b: HarmonicMap) -> bool:
    return np.array_equal(a.phi, b.phi) and np.array_equal(a.psi, b.psi)


def poses(name: str, *angles: float) -> list[HarmonicMap]:
    return [turned(random_map(name, 0.01, i), a, complex(a)) for i, a in enumerate(angles)]


def extremes(map: HarmonicMap, points: Any = None) -> tuple[float, float]:
    """The least sigma_2 and the largest k at points, by default at the corners."""
    corners = np.concatenate([*map.domain.cage.loops])
    f, g = map.wirtinger(corners if points is None else as_points(points))
    return float((np.abs(f) - np.abs(g)).min()), float((np.abs(g) / np.abs(f)).max())


@pytest.mark.parametrize("name", NAMES)
def test_a_motion_passes_through_its_keyframes_and_is_proved(name: str) -> None:
    maps = poses(name, 0, 2.0, -0.5)
    motion = Motion(maps, [1, 2, 4.5], easing=["in-out", "linear"])
    assert motion.certificate.certified
    assert motion.certificate.until == motion.end == 4.5
    for map, time in zip(maps, motion.times, strict=True):
        assert same(motion(time), map)
    for before, after in itertools.pairwise(motion.pieces):
        assert before.end == after.start
        assert before.end_map is after.start_map
    proofs = motion.certificate.pieces
    assert len(proofs) == len(motion.pieces)
    for piece, proof in list(zip(motion.pieces, proofs, strict=True))[::5]:
        found = certify(motion((piece.start + piece.end) / 2))
        assert found.sigma2_lower >= proof.sigma2_lower * 0.97
        assert proof.sigma2_lower >= motion.certificate.sigma2_lower


@given(
    st.sampled_from([*NAMES, *MANY_HOLES]),
    st.floats(-3, 3),
    st.tuples(*[st.integers(0, 10**6)] * 2),
    st.sampled_from([0.01, 0.03]),
)
@settings(max_examples=14)
def test_nothing_between_two_keyframes_is_worse_than_the_worse_one(
    name: str, angle: float, seeds: tuple[int, int], size: float
) -> None:
    maps = [random_map(name, size, seeds[0]), turned(random_map(name, size, seeds[1]), angle)]
    if not all(certificate_of(map).certified for map in maps):
        return
    curve = Motion(maps).curve
    ends = [extremes(map) for map in maps]
    for t in (0.25, 0.5, 0.75):
        sigma2, k = extremes(curve.map(t))
        assert sigma2 >= 0.98 * min(s for s, _ in ends)
        assert k <= 1.02 * max(k for _, k in ends)


@pytest.fixture(scope="module")
def stretched() -> list[HarmonicMap]:
    """The frog at rest and pulled far in two ways. The plain interpolation between the two
    folds."""
    d = Domain.from_cage(trace(samples.image("frog")).cage)
    pose = load_pose(samples.pose_path("frog", "extreme"))
    first = (
        "1.807 -6.425 -6.609 -3.478 .897 -1.989 5.724 -1.798 -2.365 -2.078 0 -.819 3.44 2.767 2 3.7"
    )
    last = (
        "1.473 -7.036 -4.093 -5.598 .289 -2.353 4.677 -.577 -3.33 -.708 0 -.268 .848 3.024 1.4 4.9"
    )
    pulled = (np.reshape([float(x) for x in to.split()], (-1, 2)) for to in (first, last))
    solved = [solve(d, pose.with_targets(to)).map for to in pulled]
    return [HarmonicMap.identity(d), *(map for map in solved if isinstance(map, HarmonicMap))]


@pytest.mark.parametrize("chosen", [(1, 2), (0, 1, 2)])
def test_maps_solved_on_the_way_mend_what_the_projection_loses(
    stretched: list[HarmonicMap], chosen: tuple[int, ...]
) -> None:
    maps = [stretched[i] for i in chosen]
    times = [0, 0.3, 2, 2.4, 3][: len(maps) + 1]
    motion = Motion(maps, times, repeat="loop")
    assert motion.certificate.certified
    points = uniform_panels(motion.domain.cage, 6000).start
    ends = np.array([extremes(map, points) for map in (*maps, maps[0])])
    assert {*motion.ways} <= {"solved", "bounded"}
    for i, way in enumerate(motion.ways):
        assert way == "solved" or {*chosen[i : i + 2]} != {1, 2}
        worse = ends[i : i + 2, 0].min(), ends[i : i + 2, 1].max()
        for s in np.linspace(0, 1, 24):
            map = motion.curve.map(times[i] + s * (times[i + 1] - times[i]))
            sigma2, k = extremes(map, points)
            assert sigma2 >= 0.985 * worse[0]
            assert k <= 1.015 * worse[1]


def bent_ring() -> HarmonicMap:
    """A thin ring, bent by three handles: k is small, but parts of it turn far."""
    outer, hole = circle(50, 3.0), circle(30, 2.5)
    handles = [[2.63, -0.81], [-0.73, 2.65], [-0.35, -2.73]]
    targets = [[0.19, -1.14], [1.07, 3.42], [0.79, -2.45]]
    result = solve(Domain.from_cage(Cage(outer, [hole]), 0.1), Pose(handles, targets))
    assert result.status.ok
    assert isinstance(result.map, HarmonicMap)
    return result.map


def test_periods_around_holes_are_closed_without_distortion() -> None:
    """If the gap were only distributed, k in between would exceed the worse end's by up to a
    quarter."""
    end = bent_ring()
    motion = Motion([HarmonicMap.identity(end.domain), end])
    assert motion.ways == ("bounded",)
    assert motion.certificate.certified
    points = uniform_panels(end.domain.cage, 4000).start
    sigma2, k = extremes(end, points)
    for s in np.linspace(0, 1, 17):
        now = extremes(motion.curve.map(s), points)
        assert now[0] >= 0.98 * sigma2
        assert now[1] <= 1.02 * k


def test_closing_changes_f_z_alone_and_leaves_a_thousandth_of_the_gap() -> None:
    for name in NAMES[1:]:
        boundary, end = boundary_of(domain(name)), poses(name, 0.4)[-1]
        fz, fzb_conj = boundary.first @ end.phi, boundary.first @ end.psi
        log, nu = 0.5 * boundary.logarithm(end.phi, fz), 0.5 * fzb_conj / fz
        open_gap = np.abs(boundary.gap(np.exp(log), nu)[0]).max()
        closed = boundary.closed(log, nu)
        assert np.abs(boundary.gap(closed, nu)[0]).max() <= 1e-3 * open_gap
        phi, _ = boundary.fitted(closed, nu * closed)
        missed = np.abs(boundary.first @ phi - closed).max() / np.abs(closed).max()
        assert missed < 0.05, name


def test_solving_ends_where_it_mends_nothing(
    stretched: list[HarmonicMap], monkeypatch: pytest.MonkeyPatch
) -> None:
    solved = []

    def in_vain(between: Any, piece: int, s: float, *_: Any) -> HarmonicMap:
        solved.append(s)
        return HarmonicMap(stretched[0].domain, *between(piece, s))

    monkeypatch.setattr(curve, "solved_between", in_vain)
    # Shorter pieces close more periods, which already helps.
    monkeypatch.setattr(bounded, "CLOSES", 0.0)
    assert not Motion(stretched[1:]).certificate.certified
    assert 1 <= len(solved) <= 3


def test_a_fold_is_refused_at_once_and_as_asked(
    stretched: list[HarmonicMap], monkeypatch: pytest.MonkeyPatch
) -> None:
    proved = counted(monkeypatch)
    motion = Motion(stretched[1:], between="bounded")
    assert motion.certificate.until < 0.2
    assert motion.ways == ("bounded",)
    assert len(proved) == 1


def test_only_the_piece_that_fails_is_divided(monkeypatch: pytest.MonkeyPatch) -> None:
    proved = counted(monkeypatch)
    one, two = (random_map("ell", 0.3, i) for i in (1, 2))
    motion = Motion([one, turned(two, 3.05), turned(one, 3.05)], tolerance=9)
    assert motion.certificate.certified
    assert proved == [2, 4, 2]


def counted(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The number of maps that each proof of pieces gets."""
    counts: list[int] = []

    def certify(maps: list[HarmonicMap]) -> Any:
        counts.append(len(maps))
        return certify_pieces(maps)

    monkeypatch.setattr("glid_nb.motion.motion.certify_pieces", certify)
    return counts


def test_forty_million_points_and_times_contradict_nothing_of_a_whole_motion() -> None:
    """Several pieces, with three holes and 200 times, at 2 x 10^5 points."""
    maps = [turned(random_map("triple", 0.02, i), a) for i, a in enumerate((0, 1.5, 0.4))]
    motion = Motion(maps, [0, 1, 1.5], repeat="loop", tolerance=0.01)
    assert motion.certificate.certified
    pieces = list(zip(motion.pieces, motion.certificate.pieces, strict=True))
    assert len(pieces) >= 5
    for piece, proof in pieces:
        check(proof, *piece[2:], dense_check("triple"), 1 + 200 // len(pieces))


def test_the_logarithm_of_f_z_has_one_branch_on_all_loops() -> None:
    """Its value on a hole agrees with the values along any other path through the domain."""
    map = turned(random_map("triple", 0.05, 3), 2.9)
    boundary = boundary_of(map.domain)
    fz = boundary.first @ map.phi
    log = boundary.logarithm(map.phi, fz)
    assert np.abs(np.exp(log) - fz).max() < 1e-12
    # The map is nearly a rotation by 2.9, so the argument is near 2.9 everywhere.
    assert np.abs(log.imag - log.imag[0]).max() < 1.5


def test_a_projection_gives_back_what_the_basis_holds() -> None:
    for name in NAMES:
        map, boundary = random_map(name, 0.05, 1), boundary_of(domain(name))
        phi, psi = boundary.fitted(boundary.first @ map.phi, boundary.first @ map.psi)
        fitted = HarmonicMap(map.domain, phi, psi)  # refuses logarithms that are not tied
        shift = boundary.images(phi, psi) - boundary.images(map.phi, map.psi)
        assert np.abs(shift - shift.mean()).max() < 1e-8
        assert fitted.domain is map.domain


def test_loops_close_and_ping_pong_runs_back() -> None:
    maps = poses("ell", 0, 2.2, 4.4)  # a full turn by the short way
    loop = Motion(maps, [0, 1, 2, 3], repeat="loop")
    assert (loop.duration, loop.times) == (3, (0, 1, 2, 3))
    assert Motion(maps, [0, 1, 2], repeat="loop").times == loop.times
    assert same(loop(3), maps[0])
    assert same(loop(4), maps[1])
    assert loop(2.5).distance(loop(-0.5)) < 1e-9
    angles = [np.angle(np.mean(loop(t).wirtinger([[-1, -1]])[0])) for t in np.linspace(0, 3, 19)]
    assert np.abs(np.ptp(np.unwrap(angles)[[0, -1]]) - 2 * np.pi) < 1e-6
    back = Motion(maps[:2], repeat="ping-pong")
    assert back.duration == 2
    assert len(back.pieces) == len(back.certificate.pieces)
    assert back(1.75).distance(back(0.25)) < 1e-9
    assert back.certificate.certified


def angles(motion: Motion, times: np.ndarray) -> np.ndarray:
    """The rotation of a point's surroundings, at times close to each other."""
    turned = [np.angle(motion(float(t)).wirtinger([[-1, -1]])[0][0]) for t in times]
    return np.unwrap(turned)


@pytest.mark.parametrize("between", ["bounded", "solved"])
def test_whole_turns_are_added(between: Any) -> None:
    motion = Motion(poses("ell", 0, 0.5), turns=[1], between=between)
    assert abs(angles(motion, np.linspace(0, 1, 33))[-1] - (2 * np.pi + 0.5)) < 0.05
    assert motion.certificate.certified


@pytest.mark.parametrize("turns", [12, -25])
def test_many_turns_are_cut_into_as_many_pieces_as_they_need(turns: int) -> None:
    motion = Motion(poses("ell", 0, 0.5), turns=turns)
    times = np.linspace(0, 1, 16 * abs(turns))
    np.testing.assert_allclose(angles(motion, times), (2 * np.pi * turns + 0.5) * times, atol=0.1)
    assert motion.certificate.certified


@pytest.mark.parametrize("name", ["ell", "ring", "twin"])
def test_a_motion_hardly_slows_down_at_its_keyframes(name: str) -> None:
    """The shape swings evenly, so its speed should be even, except where k and sigma_2 forbid
    it."""
    one, two = (random_map(name, 0.02, i) for i in (1, 2))
    rest = HarmonicMap.identity(domain(name))

    def swung(angle: float, key: str) -> np.ndarray:
        a, b, c = (getattr(map, key) for map in (rest, one, two))
        return a + np.cos(angle) * (b - a) + np.sin(angle) * (c - a)

    turns = 2 * np.pi * np.arange(5) / 5
    maps = [HarmonicMap(domain(name), swung(a, "phi"), swung(a, "psi")) for a in turns]
    curve = Motion(maps, repeat="loop").curve
    speeds = [curve.map(t % 5).distance(curve.map(t + 1e-4)) for t in np.arange(0, 5, 0.5) - 5e-5]
    assert np.mean(speeds[::2]) > 0.75 * np.mean(speeds[1::2])
    worst = [extremes(map) for map in (*maps, maps[0])]
    for i, (ends, t) in enumerate(itertools.product(itertools.pairwise(worst), (0.2, 0.5, 0.8))):
        sigma2, k = extremes(curve.map(i // 3 + t))
        assert sigma2 >= 0.98 * min(s for s, _ in ends)
        assert k <= 1.05 * max(k for _, k in ends)  # these coarse bases miss their fit by 3 %


def test_a_motion_that_slows_down_does_not_spin() -> None:
    motion = Motion(poses("ell", 0, 1.0, 1.1), [0, 0.01, 10])
    seen = angles(motion, np.linspace(0.01, 10, 60))
    assert 0.9 < seen.min() < seen.max() < 1.3


@pytest.mark.parametrize("times", [[0, 1e-8, 10], [10, 1e9 - 1, 1e9], [-1, 0, 1e-9]])
def test_close_times_are_told_apart(times: list[float], tmp_path: Path) -> None:
    maps = [random_map("ell", 0.05, 0), turned(random_map("ell", 0.05, 1), 2.0)]
    motion = Motion([*maps, maps[0]], times, turns=[0, 4], tolerance=1e-3)
    starts = [piece.start for piece in motion.pieces]
    assert all(a < b for a, b in itertools.pairwise([*starts, motion.end]))
    assert motion.certificate.certified
    motion.save(tmp_path / "motion.json")
    assert len(Motion.load(tmp_path / "motion.json").pieces) == len(starts)


def test_what_needs_too_many_pieces_is_refused() -> None:
    motion = Motion(poses("ell", 0, 3.0), tolerance=1e-9)
    with pytest.raises(MotionError, match=r"from 0 to 1 s .* the tolerance needs \d+,\d+ straight"):
        motion(0.5)
    with pytest.raises(MotionError, match="1,000,000,000 frames; 100,000 is the most"):
        Motion(motion.keyframes, [0, 1e8]).resample(10)


@pytest.mark.parametrize("index", [-1, 1, 5, 0.0, "x", None])
def test_an_interval_that_is_not_there_is_named(index: Any) -> None:
    with pytest.raises(MotionError, match=rf"no interval {index!r}; give a number from 0 to 0"):
        Motion(poses("ell", 0, 1.0)).interval(index)


def test_one_keyframe_is_no_motion() -> None:
    with pytest.raises(MotionError, match="a list of at least 2 keyframes, not 1") as refusal:
        Motion(poses("ell", 0, 1.0)[:1])
    assert refusal.value.plain == "a motion needs at least 2 keyframes; keep a pose"


def test_easing_changes_when_and_not_what() -> None:
    maps = poses("ell", 0, 1.0)
    plain = Motion(maps)
    for easing, s in (("in", 0.25), ("out", 0.75), ("in-out", 0.5)):
        eased = Motion(maps, easing=easing)
        assert eased(0.5).distance(plain(s)) < 3 * eased.tolerance * 6


def test_a_curve_eases_as_its_handles_say() -> None:
    """CSS's "ease" is (0.25, 0.1, 0.25, 1): after half the time 80.24 % of the way is done."""
    css = 0.25, 0.1, 0.25, 1.0
    assert eased(css, 0.5) == pytest.approx(0.8024, abs=1e-4)
    shares = np.linspace(0, 1, 41).tolist()
    same = {"in": (1 / 3, 0, 2 / 3, 1 / 3), "out": (1 / 3, 2 / 3, 2 / 3, 1)}
    same |= {"in-out": (1 / 3, 0, 2 / 3, 1), "linear": (0.2, 0.2, 0.9, 0.9)}
    for name, handles in same.items():
        on_curve = [eased(handles, share) for share in shares]
        np.testing.assert_allclose(on_curve, [eased(name, s) for s in shares], atol=1e-12)
    maps = poses("ell", 0, 1.0)
    curved, plain = Motion(maps, easing=css), Motion(maps)
    assert curved.certificate.certified
    assert curved(0.5).distance(plain(0.8024)) < 3 * curved.tolerance * 6


@given(st.tuples(*[st.floats(0, 1)] * 4))
def test_every_easing_goes_forward_from_start_to_end(handles: Handles) -> None:
    for easing in (handles, "in-out", "hold"):
        ways = [eased(easing, share) for share in np.linspace(0, 1, 101)]
        assert (ways[0], ways[-1]) == (0, 1)
        assert min(np.diff(ways)) >= -1e-12
        times = sample_times(easing, 2.0, 5.0, 24)
        assert times[-1] == 5
        assert min(np.diff(times)) > 0


def test_hold_stays_until_the_end_and_is_proved_on_its_way() -> None:
    maps = poses("ell", 0, 1.0)
    held = Motion(maps, easing="hold")
    assert same(held(0.96), maps[0])  # the last frame of 25 in a second
    assert same(held(1), maps[1])
    assert held(0.995).distance(Motion(maps)(0.5)) < 3 * held.tolerance * 6
    assert held.certificate.certified


@pytest.mark.parametrize("easing", [(0, 1, 0, 1), (1, 0, 1, 0), (0, 1, 1, 0), (1, 0, 0, 1), "hold"])
def test_pieces_follow_the_steepest_easing(easing: Easing) -> None:
    motion = Motion(poses("twin", 0, 1.5), easing=easing)
    curve, times = motion.curve, np.unique([np.linspace(0, 1, 53), np.geomspace(1e-6, 1, 53)])
    times = np.unique([*times, *(1 - times)])
    off = max(motion(t).distance(curve.map(float(t)), 100) for t in times)
    assert off <= 1.5 * motion.tolerance * motion.domain.cage.longer_side
    assert len(motion.pieces) < 100
    assert motion.certificate.certified


def test_pieces_follow_the_curve_within_the_tolerance() -> None:
    maps = poses("twin", 0, 1.5, 0.3)
    for tolerance in (0.01, 0.001):
        motion = Motion(maps, tolerance=tolerance)
        curve, size = motion.curve, motion.domain.cage.longer_side
        times = np.linspace(0, 2, 23)
        off = max(motion(t).distance(curve.map(float(t)), 100) for t in times)
        assert off <= 1.5 * tolerance * size


@pytest.mark.parametrize("repeat", ["once", "loop", "ping-pong"])
def test_a_part_moves_as_the_whole_does_and_is_proved(repeat: Any, tmp_path: Path) -> None:
    motion = Motion(poses("twin", 0, 1.0, 0.2), [0, 1, 2], easing="in-out", repeat=repeat)
    end = motion.times[-1]
    for start, stop in ((0.3, 1.6), (1.0, end), (0.2, 0.4)):
        part = motion.part(start, stop)
        assert part.repeat == "once"
        assert part.times == (start, *(t for t in motion.times if start < t < stop), stop)
        assert part.certificate.certified
        for time in np.linspace(start, stop, 9)[:-1]:
            assert part(time).distance(motion(time)) < 1e-12
        part.save(tmp_path / "part")
        assert Motion.load(tmp_path / "part")(stop).distance(part(stop)) == 0
    for start, stop in ((-0.1, 1), (1, end + 0.1), (0.5, 0.5), (1, 0)):
        with pytest.raises(MotionError, match="there is no motion from"):
            motion.part(start, stop)


def test_resampling_gives_even_times() -> None:
    motion = Motion(poses("ell", 0, 1.0), [2, 3])
    times, maps = motion.resample(30)
    assert len(times) == len(maps) == 31
    assert (times[0], times[-1]) == (2, 3)
    times, maps = Motion(poses("ell", 0, 1.0), repeat="loop").resample(12)
    assert len(maps) == 24


def test_a_motion_that_folds_between_its_frames_is_refused() -> None:
    first = random_map("ell", 0.01, 2)
    motion = Motion([first, turned(first, np.pi)], [0, 0.1], between="linear")
    _, frames = motion.resample(30)
    assert len(frames) == 4
    assert all(certify(frame).certified for frame in frames)
    proof = motion.certificate
    assert not proof.certified
    assert 0.045 < proof.until <= 0.05
    assert proof.reason.startswith("Certified up to t = 0.04")
    assert "the panel near (" in proof.reason
    assert Motion(motion.keyframes, [0, 0.1]).certificate.certified  # the rotation by itself


@given(st.floats(-1e4, 1e4), st.floats(1e-3, 1e3))
@settings(max_examples=10)
def test_the_time_of_a_fold_is_never_overstated(start: float, seconds: float) -> None:
    first = random_map("ell", 0.01, 2)
    times = [start, start + seconds]
    proof = Motion([first, turned(first, np.pi)], times, between="linear").certificate
    told = re.match("Certified up to t = (.*); the panel", proof.reason)
    assert told is not None
    assert float(told[1]) <= proof.until


def test_solved_motion_goes_through_certified_maps() -> None:
    maps = poses("ell", 0, 1.4)
    motion = Motion(maps, between="solved", handles=[[-2, 2], [-2, -2], [2, -2]])
    assert motion.certificate.certified
    assert same(motion(1), maps[1])
    middle = motion(0.5)
    assert 0.5 < np.angle(middle.wirtinger([[-1, -1]])[0][0]) < 0.9


def test_keyframes_that_turn_otherwise_are_refused() -> None:
    """The ring turned inside out. No motion of locally injective maps leads there."""
    d = domain("ring")
    vertices = np.concatenate(d.offset_cage.loops_complex)
    phi = np.append(9 / (vertices - d.hole_points_complex[0]), 0)  # Cauchy's integral formula
    inverse = HarmonicMap(d, phi, np.zeros_like(phi))
    assert certificate_of(inverse).windings == (-2, 2)
    with pytest.raises(MotionError, match=r"keyframes 0 and 1 cannot be joined.*hole 1"):
        Motion([HarmonicMap.identity(d), inverse])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"keyframes": 1}, "a list of at least 2 keyframes"),
        ({"times": [0, 0]}, r"times\[1\] is 0 and times\[0\] is 0; times must increase"),
        ({"times": [1, 1 + 1e-15]}, r"times\[1\] .*times must increase, here by 1e-09 s at least"),
        ({"times": [0, 1e-320]}, r"times\[1\] is 9.99\d+e-321 and times\[0\] is 0; times must"),
        ({"times": [1e9 - 1e-6, 1e9]}, r"times\[1\] is 1000000000 and .*, here by 1 s at least"),
        ({"times": [0, 1, 2]}, "there are 3 times for 2 keyframes; give 2"),
        ({"times": [0, np.nan]}, r"times\[1\] is nan; it must be a finite number"),
        ({"easing": "bounce"}, r"easing\[0\] is 'bounce'; it must be one of linear, in, out"),
        ({"easing": ["in", "out"]}, "easing has 2 values for 1 intervals; give 1"),
        ({"easing": [0.3, 0, 0.7]}, r"easing\[0\] is .*; it must be four numbers from 0 to 1"),
        ({"easing": [(0.3, 0, 0.7, 1.2)]}, r"easing\[0\] is .*; it must be four numbers"),
        ({"repeat": "forever"}, "repeat is 'forever'; it must be one of once, loop, ping-pong"),
        ({"between": "cubic"}, "between is 'cubic'"),
        ({"tolerance": 0}, "tolerance is 0; it must be a finite number greater than 0"),
        ({"turns": [0.5]}, r"turns\[0\] is 0.5; it must be a whole number"),
        ({"turns": 1, "between": "linear"}, r"turns are \(1,\); linear blending allows no turns"),
    ],
)
def test_wrong_settings_are_named(change: dict[str, Any], message: str) -> None:
    maps = {"keyframes": [random_map("ell", 0.01, 1), random_map("ell", 0.01, 2)]}
    with pytest.raises(MotionError, match=message):
        Motion(**{**maps, **change})


def test_wrong_keyframes_are_named() -> None:
    good = random_map("ell", 0.01, 1)
    with pytest.raises(MotionError, match="keyframe 1 lives on another domain"):
        Motion([good, random_map("ring", 0.01, 1)])
    with pytest.raises(MotionError, match=r"keyframe 1 is not certified.* -0.32 near"):
        Motion([good, random_map("ell", 2, 3)])
    with pytest.raises(MotionError, match="keyframe 1 has no harmonic map but is a str"):
        Motion([good, "walk"])
    with pytest.raises(MotionError, match="the time 3 is outside the motion, from 0 to 1 s"):
        Motion([good, good])(3)


def test_a_saved_motion_reads_back_bit_for_bit_and_is_proved_anew(tmp_path: Path) -> None:
    path = tmp_path / "walk.motion"
    motion = Motion(poses("twin", 0, 1.0, 0.4), repeat="loop", easing="in-out")
    motion.save(path)
    back = Motion.load(path)
    assert back.times == motion.times
    assert back.easing == motion.easing
    assert back.certificate.certified
    assert back.certificate.sigma2_lower == motion.certificate.sigma2_lower
    for a, b in zip(motion.pieces, back.pieces, strict=True):
        assert (a.start, a.end) == (b.start, b.end)
        assert same(a.start_map, b.start_map)
        assert same(a.end_map, b.end_map)


def test_a_file_names_the_oldest_version_that_reads_it(tmp_path: Path) -> None:
    path, proof = tmp_path / "walk.motion", tmp_path / "proof"
    for easing, version in (("in", 1), ("hold", 2), ((0.2, 0.0, 0.4, 1.0), 2)):
        motion = Motion(poses("ell", 0, 0.3), easing=easing)  # type: ignore[arg-type]
        motion.save(path, proof)
        assert json.loads(path.read_text())["version"] == version
        assert json.loads(proof.read_text())["version"] == 1
        back = Motion.load(path)
        assert back.easing == motion.easing
        assert [p.start for p in back.pieces] == [p.start for p in motion.pieces]


def test_saving_loses_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, link = tmp_path / "walk.motion", tmp_path / "link"
    motion = Motion(poses("ell", 0, 0.3))
    path.write_text("before")
    link.symlink_to(path)
    for proof in (path, str(path), link):
        with pytest.raises(MotionError, match="the proof would overwrite the motion"):
            motion.save(path, proof)
    monkeypatch.setattr("glid_nb.motion.file.MOST_KNOTS", 2)
    with pytest.raises(MotionError, match=r"[\d,]+ maps are too many"):
        motion.save(path)
    assert path.read_text() == "before"
    with pytest.raises(MotionError, match=f"{tmp_path} is a folder; name a file"):
        Motion.load(tmp_path)


def test_a_folded_file_is_not_believed(tmp_path: Path) -> None:
    path = tmp_path / "walk.motion"
    first = random_map("ell", 0.01, 2)
    Motion([first, turned(first, 0.4)]).save(path)
    data = json.loads(path.read_text())
    last = turned(first, np.pi)
    data["knots"] = [data["knots"][0], {**data["knots"][-1], **_pairs(last)}]
    path.write_text(json.dumps(data))
    assert not Motion.load(path).certificate.certified


def _pairs(map: HarmonicMap) -> dict[str, Any]:
    both = {"phi": map.phi, "psi": map.psi}
    return {key: np.stack([v.real, v.imag], axis=1).tolist() for key, v in both.items()}


def test_a_wrong_file_is_refused_by_key(tmp_path: Path) -> None:
    path = tmp_path / "walk.motion"
    Motion(poses("ell", 0, 0.3)).save(path)
    good = json.loads(path.read_text())
    for change, message in (
        ({"format": "glid_nb-map"}, 'the key "format" is not'),
        ({"version": 9}, "motion version 9 is not supported"),
        ({"times": [0, 0.123]}, '"times" must be times of knots'),
        ({"extra": 1}, "unknown key 'extra'"),
        ({"knots": good["knots"][:1]}, '"knots" must hold 2 to'),
        ({"knots": good["knots"][::-1]}, r"knots\[1\] is not later"),
        ({"knots": [{**good["knots"][0], "phi": []}, good["knots"][1]]}, r"knots\[0\]"),
        ({"knots": [good["knots"][0], {"time": 1}]}, r'knots\[1\]: the keys "phi", "psi"'),
    ):
        path.write_text(json.dumps({**good, **change}))
        with pytest.raises(MotionError, match=message) as error:
            Motion.load(path)
        assert str(path) in str(error.value)
    text = json.dumps(good)
    path.write_text(text.replace('"version": 1', '"version": 1, "version": 1', 1))
    with pytest.raises(MotionError, match="given twice"):
        Motion.load(path)


def test_a_motions_map_has_an_inverse() -> None:
    motion = Motion(poses("ell", 0, 1.0), [0, 1])
    z = np.array([[-2.0, -2.0], [2.0, -1.0], [-1.0, 2.5]])
    map = motion(0.4)
    found = map.inverse.locate(map(z))
    np.testing.assert_allclose(found.points, z, atol=1e-9)
    assert found.proved.all()
    assert map.inverse.inverse is map
