"""Experiments on a small shape, their figures and tables."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from glid_nb._errors import InputFileError
from glid_nb.geometry import MeshMap, uniform_panels
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods import METHODS
from glid_nb.session.problem import Problem
from studies.__main__ import main
from studies.cases import Case, reference_cases, sample_case
from studies.compare import hessian_samples, iteration_times, lipschitz, progress
from studies.compare.lipschitz import lipschitz_constants, refused_segments
from studies.compare.minimum import NoMinimumError
from studies.runs import VISIBLE
from studies.study import Plan

from ..support.problems import problem, run_method
from ..support.reference_map import ReferenceMap

pytestmark = pytest.mark.slow  # most of the time is compiling


def small(name: str = "bent") -> Case:
    return Case(name, Problem(*problem(name)))


def test_lipschitz_constants_bound_the_derivative() -> None:
    result = run_method("newton", *problem("ring"))
    map_ = result.map
    assert isinstance(map_, HarmonicMap)
    ours, theirs = lipschitz_constants(map_, 100)
    assert (theirs > 0).all()
    domain = map_.domain
    reference = ReferenceMap(
        domain.offset_cage.loops_complex, domain.hole_points_complex, map_.phi, map_.psi
    )
    samples = uniform_panels(domain.cage, 100)
    start, end = samples.start, samples.end
    for t, u in ((0.0, 0.1), (0.3, 0.5), (0.6, 1.0)):
        a, b = (reference.fz(start + v * (end - start)) for v in (t, u))
        quotient = np.abs(b - a) / ((u - t) * np.abs(end - start))
        assert (quotient <= ours * (1 + 1e-9)).all()
        assert (quotient <= theirs * (1 + 1e-9)).all()


def test_segments_that_are_too_long_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    map_ = run_method("newton", *problem("bent")).map
    assert isinstance(map_, HarmonicMap)
    for constants in ("lipschitz", "bdhm"):
        monkeypatch.setattr(lipschitz, "UNIFORM_SAMPLES", 16)
        assert refused_segments(map_, constants) > 0
        # A rigid map's derivative does not vary.
        assert refused_segments(HarmonicMap.identity(map_.domain), constants) == 0
        monkeypatch.setattr(lipschitz, "UNIFORM_SAMPLES", 200)
        assert refused_segments(map_, constants) == 0


@pytest.fixture
def small_sizes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "MESH_VERTICES", 400)
    monkeypatch.setattr(progress, "MESH_SECONDS", 20.0)
    monkeypatch.setattr(progress, "LIMITS", dict.fromkeys(progress.LIMITS, 12))
    monkeypatch.setattr(iteration_times, "MESH_VERTICES", 400)
    monkeypatch.setattr(hessian_samples, "SAMPLES", (400, 1_000))


def shades(path: Path) -> np.ndarray:
    with Image.open(path) as picture:
        return np.asarray(picture.convert("L"))


def test_a_minimum_is_borrowed_where_there_is_none_below() -> None:
    shape, pose = problem("ell")
    result = run_method("aqp", shape, pose, n_vertices=150, max_iterations=30)
    map_ = result.map
    assert isinstance(map_, MeshMap)
    flat = MeshMap(map_.triangulation, 0 * map_.images)
    own = progress.minimum_below("slim", map_, None, pose)
    borrowed = progress.minimum_below("slim", flat, map_, pose)
    assert borrowed.energy == own.energy
    with pytest.raises(NoMinimumError, match="inverted triangles"):
        progress.minimum_below("slim", flat, None, pose)


@pytest.mark.usefixtures("small_sizes")
def test_progress_from_measurement_to_table(tmp_path: Path) -> None:
    data = {"name": "bent", **progress.measure(small(), Plan())}
    runs = data["runs"]
    assert runs["newton"]["status"] == "converged"
    assert runs["newton"]["certified"]
    assert runs["newton"]["energy"][-1] <= runs["newton-eigen"]["energy"][-1] * (1 + 1e-6)
    assert runs["newton-unmodified"]["status"] == "indefinite"
    found = runs["newton"]["reached"]
    assert 0 < found["energy"]["iteration"] <= found["map"]["iteration"]
    assert found["map"]["time"] <= runs["newton"]["time"][-1]
    # Each row ends with the map of the run whose numbers are beside it.
    for method in ("newton", "newton-eigen", "newton-unmodified"):
        assert runs[method]["thumbnails"][-1] == runs[method]["iterations"]
    # The mesh has many more unknowns, so its minimum has the lower energy. Both are in one basin.
    ours, below = runs["newton"]["area_mean"], data["area_mean_below_ours"]
    assert 2 <= runs["aqp"]["area_mean"] < ours
    assert 2 <= below < ours
    aqp = runs["aqp"]
    assert aqp["most_flips"] == 0
    # On so small a mesh, AQP reaches the minimum of Newton's method on the mesh in time.
    assert aqp["reached"]["map"] is not None
    assert aqp["left"] < VISIBLE
    assert aqp["minimum"] <= aqp["energy"][-1] <= aqp["minimum"] * (1 + 1e-3)
    progress.draw([data], tmp_path)
    assert shades(tmp_path / "progress-bent.webp").std() > 5
    assert shades(tmp_path / "energies-bent.webp").std() > 5
    variants = data["variants"]
    assert variants["projected Hessian, our samples"]["status"] == "converged"
    assert 2 <= data["area_mean_aligned"] <= ours * (1 + 1e-6)
    tables = progress.tables([data])
    iterations, speed = tables["iterations"][0], tables["speed"][0]
    titles = {name: method.label for name, method in METHODS.items()}
    assert iterations[titles["newton"]] == str(runs["newton"]["iterations"])
    assert iterations[titles["newton-unmodified"]].startswith("indefinite at ")
    assert len(speed[titles["aqp"]].split(" / ")) == 3
    assert float(tables["distortion"][0][titles["newton"]]) == pytest.approx(ours, abs=6e-4)


@pytest.mark.usefixtures("small_sizes")
def test_parts_from_measurement_to_table() -> None:
    ring = small("ring")
    times = {"name": "ring", **iteration_times.measure(ring, Plan())}
    seconds = times["seconds"]
    assert {"newton", "newton-eigen", "lbfgs", "aqp"} <= set(seconds)
    assert min(seconds.values()) > 0
    (row,) = iteration_times.tables([times])["iteration-times"]
    assert float(row["L-BFGS"]) == pytest.approx(1e3 * seconds["lbfgs"], abs=0.06)

    constants = {"name": "ring", **lipschitz.measure(ring, Plan())}
    ours, theirs = constants["arrays"]["ours"], constants["arrays"]["bdhm"]
    assert theirs.mean() > ours.mean() > 0
    (row,) = lipschitz.tables([constants])["lipschitz"]
    assert row["segments"] == len(ours)

    samples = {"name": "ring", **hessian_samples.measure(ring, Plan())}
    rows = hessian_samples.tables([samples])["hessian-samples"]
    assert [row["samples"] for row in rows] == ["400", "1,000"]


def test_a_study_writes_its_table_and_figure(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "figures"
    main(["compare", "--out", str(out), "--only", "exponential"])
    page = tmp_path / "figures.md"
    assert capsys.readouterr().out.strip() == str(page)
    assert "| bar-extreme | minimises $E_{exp}$ |" in page.read_text(encoding="utf-8")
    assert (out / "exponential.webp").stat().st_size > 10_000
    kept = json.loads((out / "data" / "exponential-bar-extreme.json").read_text())
    iso, exponential = kept["runs"]["iso"], kept["runs"]["exp"]
    assert exponential["status"] == "converged"
    # The paper's claim of Figure 6.
    assert exponential["most"] < iso["most"]
    assert exponential["mean"] > iso["mean"]


def test_reference_folders_are_checked(tmp_path: Path) -> None:
    with pytest.raises(
        InputFileError, match="no JSON file in this folder holds a cage and handles"
    ):
        reference_cases(tmp_path)
    small().problem.save(tmp_path / "My Shape.json")
    assert list(reference_cases(tmp_path)) == ["my-shape"]
    assert sample_case("bar", "gentle").name == "bar-gentle"
