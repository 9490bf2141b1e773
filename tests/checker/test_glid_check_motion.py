"""The independent checker on motions: what it verifies, and the false claims it must refuse."""

from __future__ import annotations

import copy
import functools
import itertools
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb import Motion
from glid_nb.certificate import certify
from glid_nb.harmonic import HarmonicMap
from glid_nb.motion import MotionError

from ..support.domains import turned
from .test_glid_check import Files, Verdict, check, flipped, places, points, small

pytestmark = pytest.mark.slow

# The claims of a piece, and the direction in which each is tighter.
TIGHTER = {0: 1.01, 1: 0.99, 2: 0.99}
LISTS = ("cage", "holes", "offset_cage", "offset_holes", "hole_points")
# Claims are so close to the dense evaluation that a claim 1 % tighter is false.
SLACK = 8e-3
TIMES = np.linspace(0, 1, 21)


def files_of(motion: Motion, folder: Path) -> Files:
    motion.save(folder / "motion.json", folder / "proof.json")
    read = (json.loads((folder / f"{name}.json").read_text()) for name in ("motion", "proof"))
    return Files(*read)


def seen(first: HarmonicMap, last: HarmonicMap) -> tuple[float, float, float]:
    """The least sigma_2, the largest sigma_1 and the largest k at many points and times."""
    dense = small()[1]
    found = []
    for t in TIMES:
        pairs = ((first.phi, last.phi), (first.psi, last.psi))
        found.append(dense.measure(*(a + t * (b - a) for a, b in pairs)))
    return min(m.sigma2 for m in found), max(m.sigma1 for m in found), max(m.k for m in found)


@functools.cache
def bent() -> HarmonicMap:
    """The square with a hole, bent another way and turned by half a radian."""
    map = small()[0]
    wave = 0.05 * np.exp(1j * np.arange(map.domain.n_coefficients))
    psi = map.psi + wave.conj()
    psi[-1] = (map.phi + wave)[-1].conj()
    return turned(HarmonicMap(map.domain, map.phi + wave, psi), 0.5, 1 + 2j)


@functools.cache
def claimed() -> Files:
    """Two pieces whose claims are almost the values that dense evaluation finds."""
    knots = [small()[0], bent(), turned(small()[0], 0.9)]
    map = small()[2].map
    shared = {"knots": [{"time": float(t), "phi": None, "psi": None} for t in range(3)]}
    for knot, at in zip(shared["knots"], knots, strict=True):
        knot.update({key: at.to_dict()[key] for key in ("phi", "psi")})
    loops = {key: map[key] for key in LISTS}
    bounds = [seen(*pair) for pair in itertools.pairwise(knots)]
    pieces = [[s2 * (1 - SLACK), s1 * (1 + SLACK), k * (1 + SLACK)] for s2, s1, k in bounds]
    head = {"version": 1, **loops, **shared}
    claims = {"pieces": pieces, "windings": [0, 0]}
    motion = {"format": "glid_nb-motion", **head}
    exact = json.loads(json.dumps({**head, **claims}), parse_float=lambda x: float(x).hex())
    return Files(motion, {"format": "glid_nb-motion-proof", **exact})


def mutable() -> Files:
    return copy.deepcopy(claimed())


@pytest.mark.parametrize(
    ("between", "start"), [("bounded", 1), ("linear", 1), ("bounded", 2.5 - 3e-9)]
)
def test_what_a_motion_saves_is_verified(between: Any, start: float, tmp_path: Path) -> None:
    motion = Motion([small()[0], bent()], [start, 2.5], between=between, tolerance=0.01)
    files = files_of(motion, tmp_path)
    verdict = check(files)
    assert verdict.verified, verdict.out
    proof = motion.certificate
    lines = verdict.out.splitlines()
    assert lines[0].startswith("VERIFIED: at every time the map is locally injective")
    assert lines[1] == f"sigma_2 >= {proof.sigma2_lower}"
    assert lines[3] == f"k <= {proof.k_upper}"
    assert len(lines) == 5 + len(motion.pieces)
    assert lines[-1].startswith(f"{motion.pieces[-1].start} s to 2.5 s: sigma_2 >= ")


def test_true_claims_are_verified_and_time_is_halved_where_that_takes_it() -> None:
    verdict = check(claimed())
    assert verdict.verified, verdict.out
    # A blended turn by 170 degrees: no direction is right for both ends.
    map, files = small()[0], mutable()
    last = turned(map, np.pi * 17 / 18)
    s2, s1, k = seen(map, last)
    knot = {key: last.to_dict()[key] for key in ("phi", "psi")}
    del files.map["knots"][2:], files.proof["knots"][2:]
    for place in places([knot["phi"], knot["psi"]]):
        name, *rest = ("phi", "psi")[place[0]], *place[1:]
        files.set(("knots", 1, name, *rest), knot[name][rest[0]][rest[1]])
    bounds = s2 * (1 - SLACK), s1 * (1 + SLACK), k * (1 + SLACK)
    files.proof["pieces"] = [[x.hex() for x in bounds]]
    assert s2 < 0.15
    verdict = check(files)
    assert verdict.verified, verdict.out


@given(piece=st.integers(0, 1), bound=st.integers(0, 2), share=st.floats(1, 40))
@settings(max_examples=9)
def test_a_bound_tightened_by_a_hundredth_or_more_is_refused(
    piece: int, bound: int, share: float
) -> None:
    files = mutable()
    value = float.fromhex(files.proof["pieces"][piece][bound])
    files.proof["pieces"][piece][bound] = (value * (1 + share * (TIGHTER[bound] - 1))).hex()
    verdict = check(files)
    assert not verdict.verified
    assert "is false on the panel from" in verdict.out
    assert ", at t = " in verdict.out
    assert "folds" not in verdict.out


@given(data=st.data(), bit=st.integers(0, 63), in_map=st.booleans())
@settings(max_examples=25)
def test_a_changed_number_is_verified_only_if_the_claims_still_hold(
    data: st.DataObject, bit: int, in_map: bool
) -> None:
    files = mutable()
    found = [(key, *place) for key in LISTS for place in places(files.map[key])]
    knots = files.map["knots"]
    for i, key in itertools.product(range(len(knots)), ("time", "phi", "psi")):
        found += [("knots", i, key, *place) for place in places(knots[i][key])]
    place = data.draw(st.sampled_from(found))
    changed = flipped(files.get(place), bit)
    files.set(place, changed, in_map=in_map)
    verdict = check(files)
    if not in_map or not np.isfinite(changed):
        assert not verdict.verified
    elif verdict.verified and place[0] == "knots" and place[2] != "time":
        maps = [[points(knot[key]) for key in ("phi", "psi")] for knot in files.map["knots"]]
        for pair, bounds in zip(itertools.pairwise(maps), files.proof["pieces"], strict=True):
            s2, s1, k = (float.fromhex(x) for x in bounds)
            for t in TIMES[::5]:
                phi, psi = (a + t * (b - a) for a, b in zip(*pair, strict=True))
                truth = small()[1].measure(phi, psi)
                assert truth.sigma2 >= s2 * (1 - 1e-9)
                assert truth.sigma1 <= s1 * (1 + 1e-9)
                assert truth.k <= k * (1 + 1e-9)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda files: files.proof.update(windings=[1, -1]), "f_z turns [0, 0] times"),
        (lambda files: files.proof["pieces"][1].__setitem__(0, "0x0.0p+0"), "not claimed"),
        (lambda files: files.proof["knots"].reverse(), None),
        (lambda files: files.proof["knots"].pop(), None),
        (lambda files: files.proof["pieces"].pop(), None),
        (lambda files: files.proof.update(format="glid_nb-proof"), None),
        (lambda files: [f["knots"].__setitem__(0, f["knots"][1]) for f in files], None),
    ],
)
def test_other_false_claims_are_refused(change: Any, message: str | None) -> None:
    files = mutable()
    change(files)
    verdict = check(files)
    assert verdict.code == (2 if message is None else 1)
    assert message is None or message in verdict.out


def in_a_false_proof(first: HarmonicMap, last: HarmonicMap) -> Verdict:
    """What the checker says of a motion that folds, if weak bounds are claimed."""
    files = mutable()
    del files.map["knots"][2:], files.proof["knots"][2:]
    for i, map in enumerate((first, last)):
        for key in ("phi", "psi"):
            for place in places(map.to_dict()[key]):
                value = functools.reduce(lambda inner, k: inner[k], place, map.to_dict()[key])
                files.set(("knots", i, key, *place), value)
    files.proof["pieces"] = [[x.hex() for x in (1e-9, 1e3, 0.999999)]]
    return check(files)


def test_a_motion_that_folds_between_certified_frames_is_never_verified() -> None:
    first = small()[0]
    motion = Motion([first, turned(first, np.pi)], [0, 0.1], between="linear")
    assert all(certify(frame).certified for frame in motion.resample(30)[1])
    with pytest.raises(MotionError, match=r"no proof to write: Certified up to t = 0\.04"):
        motion.save("never.json", "never.proof.json")
    assert not Path("never.json").exists()
    verdict = in_a_false_proof(first, turned(first, np.pi))
    assert not verdict.verified  # halfway the image is a point, and no determinant is negative
    assert "at t = 0." in verdict.out
    # It folds for a moment.
    psi = first.psi.copy()
    psi[:4] += 1.05 * first.phi[:4]
    folded = turned(HarmonicMap(first.domain, first.phi, psi), 1.5)
    verdict = in_a_false_proof(folded, turned(first, -1.5))
    assert not verdict.verified
    assert "The map folds. Its determinant is [-" in verdict.out
    assert verdict.out.count(", at t = ") == 2
