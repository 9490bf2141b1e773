"""Every command is run on small input."""

from __future__ import annotations

import json
import signal
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import glid_check
import glid_nb

pytestmark = pytest.mark.slow  # most of the time is compiling

ROWS = (
    "picture",
    "cage",
    "pose",
    "status",
    "unknowns",
    "panels",
    "iterations",
    "energy",
    "certified",
    "sigma_2",
    "sigma_1",
    "k",
    "winding number",
    "injective",
    "times",
    "written",
)


def read(path: Path) -> dict:
    return json.loads(path.read_text(encoding="utf-8"))


def strict_json(text: str) -> dict:
    """Reads JSON without the NaN and Infinity that Python's reader accepts."""

    def refuse(name: str) -> float:
        raise AssertionError(f"{name} is not JSON")

    return json.loads(text, parse_constant=refuse)


def test_page_makes_a_live_page(run, picture: Path, tmp_path: Path) -> None:
    out = tmp_path / "page.html"
    outcome = run("page", picture, "--out", out, "--title", "A <ring>", "--energy", "mips")
    assert outcome.code == 0
    assert outcome.out.startswith(f"{out}: a live page, ")
    text = out.read_text(encoding="utf-8")
    assert "<title>A &lt;ring&gt;</title>" in text
    assert "foreground by alpha" in outcome.err + outcome.out  # what the tracing noticed
    assert run("page", picture, "--out", picture).code == 1  # it would overwrite the picture


def test_page_says_how_a_session_must_be_named(run, tmp_path: Path) -> None:
    (tmp_path / "two.zip").write_bytes(b"PK\x03\x04 and so on")
    outcome = run("page", tmp_path / "two.zip", "--out", tmp_path / "page.html")
    assert outcome.code == 1
    assert "two.zip is a session or another zip file; the name of a session must end in .glid" in (
        outcome.err
    )


def test_trace_writes_the_cage_in_world_coordinates(run, picture: Path, tmp_path: Path) -> None:
    out = tmp_path / "cage.json"
    outcome = run("trace", picture, "--out", out, "--offset", 0, "--simplify", 0.5)
    assert outcome.code == 0
    assert outcome.out.startswith(f"{out}: ")
    assert "1 hole" in outcome.out
    data = read(out)
    assert data["image_size_px"] == [160, 120]
    cage = glid_nb.Cage.from_dict(data)
    # The plus sign spans the pixels 15..145 x 15..105 of 160 x 120, a pixel being 1/8 unit.
    np.testing.assert_allclose(cage.bounds, (-8.125, -5.625, 8.125, 5.625), atol=0.15)
    assert len(cage.holes) == 1


def test_trace_takes_its_options(run, picture: Path, tmp_path: Path) -> None:
    out = tmp_path / "cage.json"
    assert run("trace", picture, "--out", out, "--drop-hole", 80, 60).code == 0
    assert read(out)["holes"] == []
    assert run("trace", picture, "--out", out, "--min-hole-area", 1000).code == 0
    assert read(out)["holes"] == []


def test_trace_takes_scribbles(run, picture: Path, tmp_path: Path) -> None:
    strokes = tmp_path / "strokes.json"
    strokes.write_text(
        json.dumps(
            {"foreground": [[[20, 60], [60, 60]]], "background": [[[5, 5], [40, 20]]]},
        )
    )
    out = tmp_path / "cage.json"
    outcome = run("trace", picture, "--out", out, "--method", "scribbles", "--scribbles", strokes)
    assert outcome.code == 0
    assert glid_nb.Cage.from_dict(read(out)).contains([[-5.0, 0.0]]).all()


def test_solve_writes_a_map_and_a_report(
    run, problem: Path, problem_data: dict[str, Any], tmp_path: Path
) -> None:
    problem.write_text(json.dumps({**problem_data, "image_size_px": [160.0, 120]}))
    out, proof, report_path = (tmp_path / f"{name}.json" for name in ("map", "proof", "report"))
    outcome = run("solve", problem, "--out", out, "--proof", proof, "--report", report_path)
    assert outcome.code == 0
    assert glid_check.main([str(out), str(proof)]) == 0
    harmonic_map = glid_nb.HarmonicMap.load(out)
    assert json.loads(out.read_text())["image_size_px"] == [160, 120]
    np.testing.assert_allclose(harmonic_map([[7.0, 0.0]]), [[6.0, 3.0]], atol=1e-3)
    report = strict_json(report_path.read_text())
    assert report["status"] in ("converged", "stationary")
    assert report["certified"] is True
    assert report["winding"] == 0
    assert len(report["windings"]) == 2
    assert report["energy"] == "iso"
    assert report["E"] == pytest.approx(report["E_iso"] + report["E_p2p"], rel=1e-12)
    assert len(report["history"]) == report["iterations"] > 0
    assert {
        "iteration",
        "energy",
        "energy_distortion",
        "energy_p2p",
        "step",
        "decrement",
        "sigma2_lower",
        "panels_split",
        "time",
    } <= set(report["history"][0])
    assert 0 < report["sigma2_lower"] <= report["sigma1_upper"]
    assert 0 < report["k_upper"] < 1
    certificate = glid_nb.certify(harmonic_map)
    assert certificate.certified
    points = glid_nb.triangulate(harmonic_map.domain.cage, 2000).vertices
    assert harmonic_map.sigma2(points).min() >= report["sigma2_lower"]
    assert harmonic_map.sigma1(points).max() <= report["sigma1_upper"]
    assert harmonic_map.k(points).max() <= report["k_upper"]


def test_solve_takes_its_options(run, problem: Path, tmp_path: Path) -> None:
    report_path = tmp_path / "report.json"
    words = ("--energy", "amips", "--s", 0.5, "--p2p-weight", 10, "--max-iterations", 1)
    words += ("--sampling", "uniform", "--certificate", "lipschitz", "--hessian", "projected")
    out, proof = tmp_path / "map.json", tmp_path / "proof.json"
    words += ("--out", out, "--proof", proof)
    outcome = run("solve", problem, "--report", report_path, "--json", *words)
    assert outcome.code == 0
    assert glid_check.main([str(out), str(proof)]) == 0
    report = strict_json(report_path.read_text())
    assert (report["energy"], report["s"], report["p2p_weight"]) == ("amips", 0.5, 10)
    assert report["iterations"] == 1
    assert report["options"]["sampling"] == "uniform"
    assert report["options"]["certificate"] == "lipschitz"
    assert report["options"]["hessian"] == "projected"
    summary = strict_json(outcome.out)
    assert summary["E"] == report["E"]
    files = (out, proof, report_path)
    assert summary["files"] == {path.name: str(path) for path in files}


def test_conformal_maps_have_no_dilatation(run, problem: Path, tmp_path: Path) -> None:
    out = tmp_path / "map.json"
    assert run("solve", problem, "--out", out, "--conformal").code == 0
    harmonic_map = glid_nb.HarmonicMap.load(out)
    vertices = harmonic_map.domain.offset_cage.n_vertices
    assert not harmonic_map.psi[:vertices].any()
    assert harmonic_map.k([[3.0, 0.5]]) < 1e-12


def test_solving_again_from_the_solution_takes_no_time(run, problem: Path, tmp_path: Path) -> None:
    out, report = tmp_path / "map.json", tmp_path / "report.json"
    assert run("solve", problem, "--out", out).code == 0
    assert run("solve", problem, "--start", out, "--report", report).code == 0
    assert read(report)["iterations"] <= 2


@pytest.fixture
def solved(run, problem: Path, tmp_path: Path) -> Path:
    path = tmp_path / "map.json"
    assert run("solve", problem, "--out", path).code == 0
    return path


def test_render_warps_the_picture(run, picture: Path, solved: Path, tmp_path: Path) -> None:
    out = tmp_path / "warped.png"
    outcome = run("render", picture, solved, "--out", out)
    assert (outcome.code, outcome.err) == (0, "")
    with Image.open(out) as warped:
        assert (warped.size, warped.mode) == ((160, 120), "RGBA")


def test_render_tells_that_a_map_folds(run, picture: Path, solved: Path, tmp_path: Path) -> None:
    data, out = read(solved), tmp_path / "warped.png"
    mirrored = [[1.5 * x, -1.5 * y] for x, y in data["phi"]]
    mirrored[-1] = data["psi"][-1]  # the hole's, which is phi's conjugate
    solved.write_text(json.dumps({**data, "psi": mirrored}), encoding="utf-8")
    outcome = run("render", picture, solved, "--out", out)
    assert (outcome.code, outcome.out) == (0, f"{out}: 160 x 120 pixels\n")
    assert outcome.err.startswith(f"glid-nb: {solved} is not proved locally injective. The map is")
    assert outcome.err.count("\n") == 1
    assert out.exists()


def test_depths_go_from_the_problem_into_the_map_and_its_picture(
    run, picture: Path, problem: Path, tmp_path: Path
) -> None:
    data = {**read(problem), "depths": [0, 0, -1.5]}
    problem.write_text(json.dumps(data), encoding="utf-8")
    out, warped = tmp_path / "map.json", tmp_path / "warped.png"
    assert run("solve", problem, "--out", out).code == 0
    assert read(out)["depths"] == [0, 0, -1.5]
    assert glid_nb.io.Problem.load(problem).pose.depths.tolist() == [0, 0, -1.5]
    assert run("render", picture, out, "--out", warped).code == 0
    expected = glid_nb.render(
        glid_nb.read_image(picture),
        glid_nb.HarmonicMap.load(out),
        pose=glid_nb.io.load_pose(problem),
    )
    with Image.open(warped) as image:
        np.testing.assert_array_equal(np.array(image), expected)
    out.write_text(json.dumps({**read(out), "depths": [1]}), encoding="utf-8")
    assert "depths must be 3 numbers" in run("render", picture, out, "--out", warped).err


def test_render_takes_a_size_and_a_view(run, picture: Path, solved: Path, tmp_path: Path) -> None:
    out = tmp_path / "warped.png"
    words = ("--size", 200, 90, "--view", "fit")
    outcome = run("render", picture, solved, "--out", out, *words)
    assert outcome.out == f"{out}: 200 x 90 pixels\n"
    with Image.open(out) as warped:
        assert warped.size == (200, 90)
        box = warped.getchannel("A").getbbox()
    assert box is not None
    left, top, right, bottom = box
    # Nothing is cut off, and the picture fills one direction except for the margin.
    assert 0 < left < right < 200
    assert 0 < top < bottom < 90
    assert right - left > 170 or bottom - top > 75


def test_demo_on_ones_own_picture(run, picture: Path, tmp_path: Path) -> None:
    out = tmp_path / "a" / "b"
    outcome = run("demo", picture, "--out", out)
    assert outcome.code == 0
    names = {"deformed.png", "overview.png", "cage.json", "map.json", "report.json"}
    assert {path.name for path in out.iterdir()} == names
    with Image.open(out / "deformed.png") as deformed:
        assert (deformed.size, deformed.mode) == ((160, 120), "RGBA")
    with Image.open(out / "overview.png") as overview:
        assert min(overview.size) > 500
    assert glid_nb.certify(glid_nb.HarmonicMap.load(out / "map.json")).certified
    lines = outcome.out.splitlines()
    assert len(lines) <= 40
    first = [line.split("  ")[0] for line in lines if not line.startswith(" ")]
    assert [name for name in first if name != "notes"] == list(ROWS)
    assert "chosen automatically" in outcome.out


def test_demo_with_a_pose_of_ones_own(run, picture: Path, tmp_path: Path) -> None:
    pose = tmp_path / "pose.json"
    pose.write_text(json.dumps({"handles": [[-7, 0], [7, 0]], "targets": [[-7, 0], [6, 3]]}))
    out = tmp_path / "out"
    outcome = run("demo", picture, "--pose", pose, "--out", out, "--json", "--energy", "arap")
    assert outcome.code == 0
    summary = strict_json(outcome.out)
    assert summary["pose"] == str(pose)
    assert summary["energy"] == "arap"
    assert set(summary["files"]) == {path.name for path in out.iterdir()}
    harmonic_map = glid_nb.HarmonicMap.load(out / "map.json")
    np.testing.assert_allclose(harmonic_map([[7.0, 0.0]]), [[6.0, 3.0]], atol=1e-2)


def test_demo_without_anything_uses_a_sample(run, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    outcome = run("demo")
    assert outcome.code == 0
    assert "the sample's own, gentle" in outcome.out
    source = glid_nb.read_image(glid_nb.samples.path("gecko"))
    with Image.open(tmp_path / "glid-nb-demo" / "deformed.png") as deformed:
        assert deformed.size == source.shape[1::-1]


def test_results_may_overwrite_results(run, problem: Path, tmp_path: Path) -> None:
    out = tmp_path / "map.json"
    out.write_text("old")
    assert run("solve", problem, "--out", out).code == 0
    assert glid_nb.HarmonicMap.load(out)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["map.json", "problem.json"]


def test_ctrl_c_keeps_the_last_certified_map(
    run, problem: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first interrupt asks to stop. The result so far is written, and the exit code shows the
    stop."""
    solve, before = glid_nb.solve, signal.getsignal(signal.SIGINT)

    def interrupted(*args, callback, **keywords):
        def press(state: glid_nb.Progress) -> bool | None:
            signal.raise_signal(signal.SIGINT)
            return callback(state)

        return solve(*args, callback=press, **keywords)

    monkeypatch.setattr(glid_nb, "solve", interrupted)
    out, report = tmp_path / "map.json", tmp_path / "report.json"
    outcome = run("solve", problem, "--out", out, "--report", report)
    assert outcome.code == 130
    assert "interrupted" in outcome.err
    assert read(report)["status"] == "stopped"
    assert glid_nb.certify(glid_nb.HarmonicMap.load(out)).certified
    assert signal.getsignal(signal.SIGINT) is before


def test_flags_of_the_start(run, problem: Path, tmp_path: Path) -> None:
    report = tmp_path / "report.json"
    outcome = run("solve", problem, "--no-align", "--restarts", 0, "--report", report)
    assert outcome.code == 0
    options = read(report)["options"]
    assert options["align"] is False
    assert options["restarts"] == 0


def test_a_solve_without_files_says_so(run, problem: Path) -> None:
    outcome = run("solve", problem)
    assert outcome.code == 0
    assert "nothing; name files with --out and --report" in outcome.out


def bar_with_a_turned_end() -> dict:
    """A bar of 20 x 2 units with edges of 1 unit, whose right end is to turn by 180 degrees."""
    along, up = np.arange(-10.0, 10.0), np.arange(-1.0, 1.0)
    cage = [[x, -1] for x in along] + [[10, y] for y in up]
    cage += [[-x, 1] for x in along] + [[-10, -y] for y in up]
    left, right = [[-9.5, -0.5], [-9.5, 0.5]], [[9.5, -0.5], [9.5, 0.5]]
    return {"cage": cage, "handles": left + right, "targets": left + right[::-1]}


@pytest.mark.parametrize(
    "words",
    [
        ("--max-iterations", 10),
        ("--max-iterations", 1, "--restarts", 0, "--conformal"),
        ("--max-iterations", 10, "--no-align", "--p2p-weight", 1e8),
    ],
)
def test_a_hard_pose_is_solved(run, problem: Path, tmp_path: Path, words: tuple) -> None:
    """For conformal maps, the first call takes no step, because panels must be split first."""
    problem.write_text(json.dumps(bar_with_a_turned_end()))
    out = tmp_path / "map.json"
    outcome = run("solve", problem, "--out", out, *words)
    assert outcome.code == 0
    assert outcome.err == ""
    assert glid_nb.certify(glid_nb.HarmonicMap.load(out)).certified
