"""Experiments on a small shape, their figures and the page's verdicts."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from glid_nb.geometry import uniform_boundary_samples
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods import MeshMap, run_method
from glid_nb.session import InputFileError, Problem
from studies.comparisons import (
    ComparisonError,
    compare_all,
    experiments,
    hessian_samples,
    iteration_times,
    lipschitz,
    progress,
    stages,
)
from studies.comparisons.cases import Case, reference_cases, sample_case
from studies.comparisons.lipschitz import lipschitz_constants, refused_segments
from studies.comparisons.minimum import NoMinimumError
from studies.comparisons.page import page
from studies.comparisons.runs import VISIBLE

from ...methods.problems import problem
from ...reference_map import ReferenceMap


def small(name: str = "bent") -> Case:
    return Case(name, Problem(*problem(name)))


def nothing(_: str) -> None:
    pass


@pytest.mark.slow
def test_lipschitz_constants_bound_the_derivative() -> None:
    result = run_method("newton", *problem("ring"))
    map_ = result.map
    assert isinstance(map_, HarmonicMap)
    ours, theirs = lipschitz_constants(map_, 100)
    assert (theirs > 0).all()
    domain = map_.domain
    reference = ReferenceMap(
        domain.offset_loops_complex, domain.hole_points_complex, map_.phi, map_.psi
    )
    samples = uniform_boundary_samples(domain.cage, 100)
    start, end = samples.points, samples.points[samples.next]
    for t, u in ((0.0, 0.1), (0.3, 0.5), (0.6, 1.0)):
        a, b = (reference.fz(start + v * (end - start)) for v in (t, u))
        quotient = np.abs(b - a) / ((u - t) * np.abs(end - start))
        assert (quotient <= ours * (1 + 1e-9)).all()
        assert (quotient <= theirs * (1 + 1e-9)).all()


@pytest.mark.slow
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
    monkeypatch.setattr(stages, "_REPEATS", 1)


def shades(path: Path) -> np.ndarray:
    with Image.open(path) as picture:
        return np.asarray(picture.convert("L"))


def test_a_minimum_is_borrowed_where_there_is_none_below() -> None:
    shape, pose = problem("ell")
    result = run_method("aqp", shape, pose, n_vertices=150, max_iterations=30)
    map_ = result.map
    assert isinstance(map_, MeshMap)
    flat = MeshMap(map_.triangulation, 0 * map_.images)
    own, its_own = progress.minimum_below("slim", map_, None, pose)
    assert its_own
    borrowed, its_own = progress.minimum_below("slim", flat, map_, pose)
    assert not its_own
    assert borrowed.energy == own.energy
    with pytest.raises(NoMinimumError, match="inverted triangles"):
        progress.minimum_below("slim", flat, None, pose)


@pytest.mark.slow
@pytest.mark.usefixtures("small_sizes")
def test_progress_from_measurement_to_page(tmp_path: Path) -> None:
    results = {"progress": [progress.measure(small(), nothing)]}
    runs = results["progress"][0]["runs"]
    assert runs["newton"]["status"] == "converged"
    assert runs["newton"]["certified"]
    assert runs["newton"]["energy"][-1] <= runs["newton-eigen"]["energy"][-1] * (1 + 1e-6)
    assert runs["newton-unmodified"]["status"] == "indefinite"
    found = runs["newton"]["reached"]
    assert 0 < found["energy"]["iteration"] <= found["map"]["iteration"]
    assert found["map"]["time"] <= runs["newton"]["time"][-1]
    # Each row ends with the map of the run whose numbers stand beside it.
    for method in ("newton", "newton-eigen", "newton-unmodified"):
        assert runs[method]["thumbnails"][-1] == runs[method]["iterations"]
    # The mesh has far more unknowns, and its minimum the lower energy; both are of one basin.
    ours, below = runs["newton"]["area_mean"], results["progress"][0]["area_mean_below_ours"]
    assert 2 <= runs["aqp"]["area_mean"] < ours
    assert 2 <= below < ours
    assert all(runs[m]["preparation"] > 0 for m in ("newton", "aqp"))
    aqp = runs["aqp"]
    assert aqp["most_flips"] == 0
    # On so small a mesh it is there in time, and where Newton's method on the mesh goes.
    assert aqp["reached"]["map"] is not None
    assert aqp["left"] < VISIBLE
    assert aqp["minimum"] <= aqp["energy"][-1] <= aqp["minimum"] * (1 + 1e-3)
    experiments.draw_all(results, tmp_path)
    assert shades(tmp_path / "progress-bent.png").std() > 5
    text = page(results, "figures")
    assert "it halts on 1 of 1 shapes" in text
    assert "](figures/progress-bent.png)" in text
    assert "nan" not in text
    assert results["progress"][0]["projected"]["status"] == "converged"
    assert results["progress"][0]["aligned"]["certified"]
    # Four claims, three criteria of speed, and Newton-Eigen's, each with a verdict.
    assert text.count("eproduced.**") == 8


@pytest.mark.slow
@pytest.mark.usefixtures("small_sizes")
def test_parts_from_measurement_to_page(tmp_path: Path) -> None:
    results = {
        "iteration-times": [iteration_times.measure(small("ring"), nothing)],
        "lipschitz": [lipschitz.measure(small("ring"), nothing)],
        "hessian-samples": [hessian_samples.measure(small("ring"), nothing)],
        "stages": [stages.measure(small("ring"), nothing)],
    }
    assert all(seconds >= 0 for seconds in results["stages"][0]["seconds"].values())
    times = results["iteration-times"][0]["seconds"]
    assert {"newton", "newton-eigen", "lbfgs", "aqp"} <= set(times)
    least, most = results["iteration-times"][0]["spread"]
    assert 0 < least <= most
    assert min(times.values()) > 0
    constants = results["lipschitz"][0]["arrays"]
    assert constants["bdhm"].mean() > constants["ours"].mean() > 0
    experiments.draw_all(results, tmp_path)
    for name in ("lipschitz", "hessian-samples", "stages"):
        assert shades(tmp_path / f"{name}.png").std() > 5
    text = page(results, "figures")
    assert "**Not judged:**" in text
    assert "ring is not in the paper's table" in text
    assert "nan" not in text


def test_reference_folders_are_checked(tmp_path: Path) -> None:
    with pytest.raises(InputFileError, match="no JSON file there holds a cage and handles"):
        reference_cases(tmp_path)
    small().problem.save(tmp_path / "My Shape.json")
    assert list(reference_cases(tmp_path)) == ["my-shape"]
    assert sample_case("bar", "gentle").name == "bar-gentle"


def test_an_unknown_experiment_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ComparisonError, match="unknown experiment 'figure-1'; choose of progress"):
        compare_all(tmp_path / "out", only=["figure-1"])
    assert not (tmp_path / "out").exists()
