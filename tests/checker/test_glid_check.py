"""The independent checker: what it verifies, and the false claims that it must refuse."""

from __future__ import annotations

import ast
import contextlib
import copy
import dataclasses
import functools
import io
import json
import os
import signal
import struct
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from threadpoolctl import threadpool_limits

import glid_check
from glid_nb._errors import InputError
from glid_nb.certificate import certify
from glid_nb.certificate.certify import Certificate, PanelCertificate, proof_text
from glid_nb.certificate.proof import dyadic_panels
from glid_nb.geometry import Cage, Domain, Panels, graded_panels, uniform_panels
from glid_nb.harmonic import HarmonicMap
from glid_nb.minima import solve
from glid_nb.pose import Pose
from glid_nb.solvers import Options

from ..support.domains import circle, dense_check, domain, random_map
from ..support.reference_map import DenseCheck, Measured

pytestmark = pytest.mark.slow

SOURCE = Path(glid_check.__file__)
COUNT = 20_000  # dense points
# Claims are so close to the dense evaluation that a claim 1 % tighter is false.
SLACK = 8e-3
BOUNDS = ("sigma2_lower", "sigma1_upper", "k_upper")
LISTS = ("cage", "holes", "offset_cage", "offset_holes", "hole_points", "phi", "psi")

Place = tuple[Any, ...]


class Files(NamedTuple):
    """The contents of a map's file and of a proof's file."""

    map: dict[str, Any]
    proof: dict[str, Any]

    def set(self, place: Place, value: float, *, in_map: bool = True) -> None:
        """Change a number in the proof, and in the map too."""
        _put(self.proof, place, float(value).hex())
        if in_map:
            _put(self.map, place, float(value))

    def get(self, place: Place) -> float:
        value: Any = self.map
        for key in place:
            value = value[key]
        return value


def _put(data: Any, place: Place, value: Any) -> None:
    *way, last = place
    functools.reduce(lambda inner, key: inner[key], way, data)[last] = value


def places(data: Any, way: Place = ()) -> list[Place]:
    """Where the numbers in nested lists are."""
    if not isinstance(data, list):
        return [way]
    return [place for i, item in enumerate(data) for place in places(item, (*way, i))]


class Verdict(NamedTuple):
    """The exit code and the printed text."""

    code: int
    out: str

    @property
    def verified(self) -> bool:
        assert self.out.startswith("VERIFIED") == (self.code == 0)
        assert self.out.startswith("NOT VERIFIED") == (self.code == 1)
        return self.code == 0


def check(files: Files) -> Verdict:
    """What ``glid-check`` says of two files."""
    out = io.StringIO()
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(out):
        paths = [Path(folder) / name for name in ("map.json", "proof.json")]
        for path, data in zip(paths, files, strict=True):
            path.write_text(json.dumps(data), encoding="utf-8")
        code = glid_check.main([str(path) for path in paths])
    return Verdict(code, out.getvalue())


def certificate(map: HarmonicMap, truth: Measured, panels: Panels | None = None) -> Certificate:
    """A certificate whose claims are almost the values that dense evaluation finds."""
    panels = graded_panels(map.domain) if panels is None else panels
    per_panel = PanelCertificate(**vars(panels), **dict.fromkeys(BOUNDS, np.empty(0)))
    bounds = (truth.sigma2 * (1 - SLACK), truth.sigma1 * (1 + SLACK), truth.k * (1 + SLACK))
    made = Certificate(False, *bounds, truth.windings, per_panel, "hermite", "as claimed", map)
    vars(made)["certified"] = True
    return made


def files_of(certificate: Certificate) -> Files:
    return Files(certificate.map.to_dict(), json.loads(proof_text(certificate)))


@functools.cache
def small() -> tuple[HarmonicMap, DenseCheck, Files]:
    """A bent square with a triangular hole, which is quick to check."""
    square, hole = circle(4, 3.0, turn=0.2), circle(3, 1.0)
    d = Domain(Cage(square, [hole]), Cage(square * 1.7, [hole * 0.4]), [[0.01, 0.02]])
    rng = np.random.default_rng(4)
    change = 0.06 * rng.normal(size=(2, 8, 2)) @ (1, 1j)
    change[1, -1] = change[0, -1].conj()
    map = HarmonicMap(d, HarmonicMap.identity(d).phi + change[0], change[1])
    dense = dense_on(map.to_dict(), 4000)
    truth = dense.measure(map.phi, map.psi)
    return map, dense, files_of(certificate(map, truth, graded_panels(d, 2.0)))


def mutable() -> Files:
    return copy.deepcopy(small()[2])


def dense_on(data: dict[str, Any], count: int = COUNT) -> DenseCheck:
    """Dense evaluation on the cages in a map's file."""
    cage, offset = (
        [points(loop) for loop in [data[exterior], *data[holes]]]
        for exterior, holes in (LISTS[0:2], LISTS[2:4])
    )
    return DenseCheck.on(cage, offset, points(data["hole_points"]), count)


def points(data: Any) -> np.ndarray:
    return np.reshape(np.array(data, dtype=float), (-1, 2)) @ (1, 1j)


def is_true(files: Files, dense: DenseCheck) -> bool | None:
    """Whether dense evaluation confirms the claims; None if it is too close to tell."""
    # Threads slow down such small products.
    with np.errstate(all="ignore"), threadpool_limits(1):
        truth = dense.measure(points(files.map["phi"]), points(files.map["psi"]))
    s2, s1, k = (float.fromhex(files.proof[key]) for key in BOUNDS)
    gaps = [truth.sigma2 / s2 - 1, 1 - truth.sigma1 / s1, 1 - truth.k / k]
    if s2 <= 0 or not min(gaps) > -1e-9 or list(truth.windings) != files.proof["windings"]:
        return False
    # Dense points miss the extremes by less than this.
    return True if min(gaps) > 1e-4 else None


@pytest.mark.parametrize("name", ["ell", "ring", "twin", "triple", "annulus"])
def test_a_true_claim_is_verified(name: str) -> None:
    map = random_map(name, 0.05, seed=1)
    files = files_of(certificate(map, dense_check(name, COUNT).measure(map.phi, map.psi)))
    verdict = check(files)
    assert verdict.verified, verdict.out
    assert f"sigma_2 >= {float.fromhex(files.proof['sigma2_lower'])}" in verdict.out


def test_a_knot_is_verified() -> None:
    """Figure 3: f_z turns once around on the exterior loop and back on the interior one."""
    d = domain("annulus")
    z = np.append(np.concatenate(d.offset_cage.loops_complex), 0)
    map = HarmonicMap(d, z**2 / 2, 0.2 * z)
    verdict = check(
        files_of(certificate(map, dense_check("annulus", COUNT).measure(map.phi, map.psi)))
    )
    assert verdict.verified, verdict.out
    assert "[1, -1]" in verdict.out


def test_a_cage_with_ten_holes_is_verified() -> None:
    holes = [circle(3, 0.5, 4 * np.exp(0.2j * np.pi * k), k) for k in range(10)]
    d = Domain.from_cage(Cage(circle(12, 6.0), holes), 0.3)
    map = HarmonicMap.identity(d)
    wave = 0.02 * np.cos(np.arange(d.n_coefficients))
    map = HarmonicMap(d, map.phi + wave, np.where(np.arange(len(wave)) < len(wave) - 10, 0, wave))
    truth = dense_on(map.to_dict()).measure(map.phi, map.psi)
    assert 0.5 < truth.sigma2 < 0.99
    # Uniform panels are replaced by graded ones.
    verdict = check(files_of(certificate(map, truth, uniform_panels(d.cage, 300))))
    assert verdict.verified, verdict.out


@pytest.mark.skipif(not hasattr(signal, "SIGPIPE"), reason="nothing tells of a broken pipe there")
def test_a_reader_that_has_seen_enough_is_no_error(tmp_path: Path) -> None:
    """Like `head`, this closes the pipe before the checker writes."""
    paths = [tmp_path / "map.json", tmp_path / "proof.json"]
    for path, data in zip(paths, small()[2], strict=True):
        path.write_text(json.dumps(data), encoding="utf-8")
    read, write = os.pipe()
    os.close(read)
    command = [sys.executable, str(SOURCE), *map(str, paths)]
    done = subprocess.run(command, stdout=write, stderr=subprocess.PIPE, check=False)
    os.close(write)
    assert (done.returncode, done.stderr) == (-signal.SIGPIPE, b"")


def test_what_the_certificate_saves_is_verified(tmp_path: Path) -> None:
    map = random_map("ring", 0.3, seed=1)
    map.save(tmp_path / "map.json")
    certify(map).save(tmp_path / "proof.json")
    assert glid_check.main([str(tmp_path / "map.json"), str(tmp_path / "proof.json")]) == 0


def test_a_hard_pose_is_verified(tmp_path: Path) -> None:
    """sigma_2 is at least 0.047, and the energy 33 times an isometry's, with any kernel of BLAS."""
    handles = np.array([[-2.5, 2.5], [2.5, -2.5], [-2.0, -2.0], [-0.5, -0.5]])
    targets = handles.copy()
    turned = 1.3 * np.exp(2.5j) * ((handles[1] - handles[2]) @ [1, 1j])
    targets[1] = targets[2] + [turned.real, turned.imag]
    result = solve(domain("ell"), Pose(handles, targets), options=Options(restarts=0))
    assert 0.03 < result.certificate.sigma2_lower < 0.05
    result.map.save(tmp_path / "map.json")
    result.certificate.save(tmp_path / "proof.json")
    assert glid_check.main([str(tmp_path / name) for name in ("map.json", "proof.json")]) == 0


def test_no_proof_is_written_of_a_map_that_is_not_certified(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no proof to write: The map is not locally injective"):
        certify(random_map("ring", 1.0, seed=0)).save(tmp_path / "proof.json")
    assert not list(tmp_path.iterdir())


def flipped(value: float, bit: int) -> float:
    """A number with one of its 64 bits changed."""
    (bits,) = struct.unpack("<Q", struct.pack("<d", value))
    return struct.unpack("<d", struct.pack("<Q", bits ^ (1 << bit)))[0]


@functools.cache
def numbers(*keys: str) -> list[Place]:
    """Where the numbers under keys of the map's file are."""
    return [(key, *place) for key in keys for place in places(small()[2].map[key])]


@given(data=st.data(), bit=st.integers(0, 63))
@settings(max_examples=80)
def test_a_proof_of_a_map_that_differs_in_one_bit_is_refused(data: st.DataObject, bit: int) -> None:
    files, place = mutable(), data.draw(st.sampled_from(numbers(*LISTS)))
    changed = flipped(files.get(place), bit)
    files.set(place, changed, in_map=False)
    verdict = check(files)
    assert verdict.code != 0
    assert not np.isfinite(changed) or "another map" in verdict.out


@given(data=st.data(), bit=st.integers(0, 63))
@settings(max_examples=120)
def test_a_changed_coefficient_is_verified_only_if_the_claims_still_hold(
    data: st.DataObject, bit: int
) -> None:
    files, place = mutable(), data.draw(st.sampled_from(numbers("phi", "psi")))
    changed = flipped(files.get(place), bit)
    files.set(place, changed)
    verdict = check(files)
    if not np.isfinite(changed):
        assert verdict.code == 2
    elif place[1] == len(files.map["phi"]) - 1:
        assert not verdict.verified  # the logarithm's coefficients are no longer conjugate
    elif (truth := is_true(files, small()[1])) is not None:
        assert verdict.verified == truth, verdict.out


@given(
    edge=st.integers(0, 6),
    panel=st.integers(0, 3),
    kind=st.sampled_from(["dropped", "twice", "moved", "longer", "shorter", "swapped", "no edge"]),
)
@settings(max_examples=120)
def test_panels_that_do_not_tile_the_boundary_are_refused(edge: int, panel: int, kind: str) -> None:
    files = mutable()
    own = files.proof["panels"][edge]
    panel %= len(own)
    k, d = own[panel]
    match kind:
        case "dropped":
            del own[panel]
        case "twice":
            own.insert(panel, [k, d])
        case "moved":
            own[panel] = [k + 1, d]
        case "longer":
            own[panel] = [k, d - 1]
        case "shorter":
            own[panel] = [2 * k, d + 1]
        case "swapped":
            own.reverse()
        case _:
            del files.proof["panels"][edge]
    verdict = check(files)
    assert not verdict.verified
    assert "panel" in verdict.out


@given(bound=st.sampled_from(BOUNDS), share=st.floats(0.01, 0.9))
@settings(max_examples=40)
def test_a_bound_tightened_by_a_hundredth_or_more_is_refused(bound: str, share: float) -> None:
    files = mutable()
    value = float.fromhex(files.proof[bound])
    files.proof[bound] = (value * (1 + share if bound == BOUNDS[0] else 1 - share)).hex()
    verdict = check(files)
    assert not verdict.verified
    assert "is false on the panel from" in verdict.out
    assert "folds" not in verdict.out


@pytest.mark.parametrize("bound", BOUNDS)
def test_a_weaker_claim_is_verified(bound: str) -> None:
    files = mutable()
    value = float.fromhex(files.proof[bound])
    files.proof[bound] = (value * (0.9 if bound == BOUNDS[0] else 1.1)).hex()
    assert check(files).verified


@given(turns=st.lists(st.integers(-2, 2), max_size=3))
@settings(max_examples=30)
def test_other_windings_are_refused(turns: list[int]) -> None:
    files = mutable()
    files.proof["windings"] = turns
    assert check(files).verified == (turns == [0, 0])


@given(
    data=st.data(),
    radius=st.floats(-3, 1).map(lambda e: 10.0**e),
    angle=st.floats(0, 6.3),
)
@settings(max_examples=90)
def test_a_moved_vertex_is_verified_only_if_the_claims_hold_there(
    data: st.DataObject, radius: float, angle: float
) -> None:
    """Of the cage, of the offset cage, which changes the map, and the point of the hole."""
    files = mutable()
    *way, _ = data.draw(st.sampled_from(numbers(*LISTS[:5])))
    for i, step in enumerate((radius * np.cos(angle), radius * np.sin(angle))):
        files.set((*way, i), files.get((*way, i)) + step)
    if not is_domain(files.map):
        assert not check(files).verified
    elif (truth := is_true(files, dense_on(files.map, 4000))) is not None:
        # With fewer dense points, a slightly false claim may be missed.
        assert check(files).verified == truth or truth


def is_domain(data: dict[str, Any]) -> bool:
    """Whether cage and hole bound a domain with no singularity in it or on its boundary."""
    cage = shapely.Polygon(data["cage"], data["holes"])
    exterior, hole = shapely.Polygon(data["cage"]), shapely.Polygon(data["holes"][0])
    singular = [*map(shapely.LinearRing, (data["offset_cage"], data["offset_holes"][0]))]
    return (
        cage.is_valid
        and exterior.contains_properly(hole)
        and exterior.exterior.is_ccw
        and not hole.exterior.is_ccw
        and not any(cage.intersects(ring) for ring in singular)
        and hole.contains_properly(shapely.Point(data["hole_points"][0]))
    )


@given(x=st.floats(-8, 8), y=st.floats(-8, 8))
@settings(max_examples=40)
def test_a_hole_is_verified_only_inside(x: float, y: float) -> None:
    files = mutable()
    for key in ("holes", "offset_holes", "hole_points"):
        for place in numbers(key):
            files.set(place, files.get(place) + (x, y)[place[-1]])
    if not is_domain(files.map):
        assert not check(files).verified


@given(seed=st.integers(0, 10**6), size=st.floats(0.1, 2.0))
@settings(max_examples=30)
def test_a_folded_map_is_never_verified(seed: int, size: float) -> None:
    map = small()[0]
    change = size * np.random.default_rng(seed).normal(size=(2, 8, 2)) @ (1, 1j)
    change[1, -1] = change[0, -1].conj()
    map = HarmonicMap(map.domain, map.phi + change[0], map.psi + change[1])
    truth = small()[1].measure(map.phi, map.psi)
    claim = {"sigma2": 1e-6, "k": 0.99, "sigma1": 2 * truth.sigma1, "windings": (0, 0)}
    verdict = check(files_of(certificate(map, dataclasses.replace(truth, **claim))))
    if truth.sigma2 < -1e-6 or sum(truth.windings):
        assert not verdict.verified
        assert "The map folds. Its determinant is [-" in verdict.out


def test_a_branch_point_inside_is_named() -> None:
    """f = z^2 / 2 on a square around 0: sigma_2 > 0 on the boundary, but f_z vanishes inside."""
    square = circle(4, 3.0)
    d = Domain(Cage(square), Cage(square * 1.5))
    z = d.offset_cage.loops_complex[0]
    map = HarmonicMap(d, z**2 / 2 + 0.3 * z, 0.1 * z)
    truth = dense_on(map.to_dict()).measure(map.phi, map.psi)
    assert truth.sigma2_boundary > 0.5
    assert truth.windings == (1,)
    for turns in ((0,), (1,)):
        claim = dataclasses.replace(truth, sigma2=0.1, k=0.9, windings=turns)
        verdict = check(files_of(certificate(map, claim)))
        assert not verdict.verified
        assert "The map folds. Its determinant is [-0.0" in verdict.out


def test_exit_code_2_names_the_file_and_what_is_wrong(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = mutable()
    paths = [tmp_path / "map.json", tmp_path / "proof.json"]
    whole = [json.dumps(data) for data in files]

    def refused(*texts: str) -> str:
        for path, text in zip(paths, texts, strict=True):
            path.write_text(text, encoding="utf-8")
        assert glid_check.main([str(path) for path in paths]) == 2
        out, err = capsys.readouterr()
        assert not out
        return err

    assert "map.json: Expecting" in refused("{", whole[1])
    assert "proof.json: this is not a file of the format glid_nb-proof" in refused(
        whole[0], whole[0]
    )
    assert "proof.json: a key is given twice" in refused(whole[0], '{"version": 1, "version": 1}')
    assert "RecursionError" not in refused(whole[0], "[" * 100_000)
    for key, value, wanted in (
        ("phi", files.proof["phi"][1:], "is not a list of 8 items"),
        ("phi", [["0x1p0", "0x1p0"]] * 8, "not a finite binary64 number"),
        ("k_upper", "nan", "not a finite binary64 number"),
        ("k_upper", None, "not a finite binary64 number"),
        ("windings", [0.0, 0.0], "integer"),
        ("panels", [[[0]]], "is not a list of 2 items"),
        ("cage", [], "three vertices"),
        ("holes", [], "three vertices, and every hole"),
        ("version", 2, "version 1"),
        ("version", True, "version 1"),
    ):
        assert wanted in refused(whole[0], json.dumps({**files.proof, key: value}))
    del files.proof["psi"]
    assert "the key 'psi' is missing" in refused(whole[0], json.dumps(files.proof))
    paths[1].unlink()
    assert glid_check.main([str(path) for path in paths]) == 2
    with pytest.raises(SystemExit, match="2"):
        glid_check.main([])


def test_a_search_for_zeros_that_runs_off_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    checker = glid_check.Checker(glid_check.File(mutable().proof))
    monkeypatch.setattr(checker, "turns", lambda _: [])
    monkeypatch.setattr(checker.proof, "cage", [[[-1e308, -1.0], [1e308, -1.0], [0.0, 1.0]]])
    assert checker.fold() == ""


def test_dyadic_panels_are_those_of_the_certificate() -> None:
    d = domain("ring")
    loops = d.cage.loops_complex
    panels = graded_panels(d)
    panels, _ = panels.split(np.arange(len(panels)) % 3 == 0)
    found = dyadic_panels(panels, loops)
    assert found is not None
    starts = [
        start + (np.roll(loop, -1)[i] - start) * k / 2**d
        for loop, edges in zip(loops, (found[:8], found[8:]), strict=True)
        for i, start in enumerate(loop)
        for k, d in edges[i]
    ]
    np.testing.assert_allclose(starts, panels.start, atol=1e-14)
    assert dyadic_panels(uniform_panels(d.cage, 300), loops) is None


def test_the_checker_is_one_short_file_that_imports_flint_and_the_standard_library() -> None:
    source = SOURCE.read_text(encoding="utf-8")
    assert len(source.splitlines()) <= 500
    names = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names |= {alias.name.partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names.add((node.module or ".").partition(".")[0])
    assert names - set(sys.stdlib_module_names) == {"flint"}


_ALONE = """
import runpy, sys
class Hidden:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] not in {*sys.stdlib_module_names, "flint"}:
            raise ModuleNotFoundError(name)
sys.meta_path.insert(0, Hidden())
sys.path.append(sys.argv.pop(1))
for name in ("glid_nb", "numpy", "jax"):
    try:
        __import__(name)
    except ModuleNotFoundError:
        continue
    raise SystemExit(f"{name} can be imported")
sys.argv = sys.argv[1:]
runpy.run_path(sys.argv[0], run_name="__main__")
"""


def test_it_runs_where_the_package_is_not_installed(tmp_path: Path) -> None:
    import flint

    paths = [tmp_path / name for name in ("map.json", "proof.json")]
    for path, data in zip(paths, small()[2], strict=True):
        path.write_text(json.dumps(data), encoding="utf-8")
    site = str(Path(flint.__file__).parents[1])
    command = [sys.executable, "-I", "-S", "-c", _ALONE, site, str(SOURCE), *map(str, paths)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("VERIFIED")


def test_it_says_that_python_flint_is_missing() -> None:
    command = [sys.executable, "-I", "-S", str(SOURCE), "map.json", "proof.json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr == "glid-check needs python-flint: pip install python-flint\n"
