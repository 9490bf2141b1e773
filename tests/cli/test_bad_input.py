"""Bad input: exit code 1, one line that names file and culprit, and no file written."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import glid_nb
from glid_nb._files import write_atomically


def assert_refused(outcome, *parts: object) -> None:
    assert outcome.code == 1
    assert outcome.out == ""
    assert outcome.err.startswith("glid-nb: error: ")
    assert outcome.err.count("\n") == 1
    for part in parts:
        assert str(part) in outcome.err


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"cage": None}, 'the key "cage" must be given'),
        ({"targets": None}, 'the key "targets" must be given'),
        ({"cage": "bar"}, '"cage" must be a list'),
        ({"cage": [[-8, -2], [8, -2]]}, "exterior loop: 2 vertices given"),
        ({"cage": [[-8, -2], [8, 2], [8, -2], [-8, 2]]}, "exterior loop: the edges"),
        ({"cage": [[-8, -2], [8, -2], [8, 2], [-8, float("nan")]]}, "cage[3] must be finite"),
        ({"cage": [[-8, -2], [8, -2], [8, -2], [-8, 2]]}, "vertices 1 and 2 coincide"),
        ({"holes": [[[9, 0], [10, 0], [9, 1]]]}, "Hole 1 lies outside"),
        ({"holes": [[[-8, -1], [1, -1], [1, 1]]]}, "Hole 1 touches the outline"),
        ({"handles": [[-7, 0], [0, -1.5]]}, "2 handles but 3 targets"),
        ({"handles": [[-7, 0], [0, 0], [7, 0]]}, "handle 1 at (0, 0) lies outside the domain"),
        ({"handles": [[-7, 0], [7, 0], [7, 0]]}, "handles 1 and 2 are the same point (7, 0)"),
        ({"targets": [[-7, 0], [0, 0], [float("nan"), 0]]}, "targets[2] must be finite"),
    ],
)
def test_a_bad_problem(
    run, problem: Path, problem_data: dict[str, Any], tmp_path: Path, change: dict, message: str
) -> None:
    problem.write_text(json.dumps({**problem_data, **change}), encoding="utf-8")
    out = tmp_path / "map.json"
    assert_refused(run("solve", problem, "--out", out), problem, message)
    assert not out.exists()


@pytest.mark.parametrize("text", ["", "{", "[]", "\x00"])
def test_a_problem_that_is_no_json_object(run, problem: Path, text: str) -> None:
    problem.write_text(text, encoding="utf-8")
    assert_refused(run("solve", problem), problem, "JSON")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            ["--energy", "stiff"],
            "unknown energy 'stiff'; choose one of iso, exp, amips, mips, arap",
        ),
        (["--energy", "exp", "--s", "0"], "s of the energy 'exp' must be positive"),
        (["--energy", "amips", "--s", "-1"], "s of the energy 'amips' must be positive"),
        (["--s", "2"], "--s is the parameter of exp and amips; iso has none"),
        (["--energy", "mips", "--s", "2"], "--s is the parameter of exp and amips; mips has none"),
        (["--p2p-weight", "0"], "p2p_weight must be a finite number greater than 0"),
        (["--p2p-weight", "nan"], "p2p_weight must be a finite number greater than 0"),
        (["--max-iterations", "-1"], "max_iterations must be a whole number of at least 0"),
        (["--sampling", "random"], "sampling must be one of graded, uniform, got 'random'"),
        (["--certificate", "none"], "certificate must be one of hermite, lipschitz, bdhm"),
        (["--hessian", "none"], "hessian must be one of adaptive, projected, exact"),
    ],
)
def test_a_bad_option(run, problem: Path, words: list[str], message: str) -> None:
    assert_refused(run("solve", problem, *words), message)


@pytest.mark.parametrize("command", ["solve", "demo", "trace", "render"])
def test_a_file_that_is_missing(run, tmp_path: Path, command: str) -> None:
    missing = tmp_path / "nothing.here"
    out = ["--out", tmp_path / "x.png"]
    words = {"render": [missing, *out], "trace": out, "solve": [], "demo": []}[command]
    outcome = run(command, missing, *words)
    assert_refused(outcome, missing)
    told = "no such file" if command == "demo" else "does not exist"
    assert told in outcome.err.lower()


def _picture(path: Path, rgba: np.ndarray) -> Path:
    Image.fromarray(rgba).save(path)
    return path


@pytest.mark.parametrize("command", ["demo", "trace"])
def test_a_picture_of_one_colour(run, tmp_path: Path, command: str) -> None:
    picture = _picture(tmp_path / "red.png", np.full((40, 60, 3), (200, 0, 0), dtype=np.uint8))
    out = tmp_path / "out"
    assert_refused(run(command, picture, "--out", out), picture, "one colour only")
    assert not out.exists()


def test_a_picture_without_foreground(run, picture: Path, tmp_path: Path) -> None:
    words = ("--method", "color", "--background", 0, 0, 0, "--threshold", 1)
    outcome = run("trace", picture, "--out", tmp_path / "cage.json", *words)
    assert_refused(outcome, picture)


def test_a_file_that_is_no_picture(run, problem: Path, tmp_path: Path) -> None:
    assert_refused(
        run("demo", problem, "--out", tmp_path / "out"), problem, "not in a picture format"
    )


def test_a_picture_that_is_cut_short(run, picture: Path, tmp_path: Path) -> None:
    picture.write_bytes(picture.read_bytes()[:-200])
    assert_refused(run("demo", picture, "--out", tmp_path / "out"), picture, "damaged or cut short")


def test_a_sample_that_does_not_exist(run, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert_refused(run("demo", "unicorn"), "unicorn", "no such file", "gecko")


def test_a_pose_that_does_not_fit(run, picture: Path, tmp_path: Path) -> None:
    pose = tmp_path / "pose.json"
    pose.write_text(json.dumps({"handles": [[-7, 0], [9.5, 6]], "targets": [[-7, 0], [6, 3]]}))
    outcome = run("demo", picture, "--pose", pose, "--out", tmp_path / "out")
    assert_refused(outcome, pose, "handle 1 at (9.5, 6) lies outside the domain")


def test_a_pose_of_a_sample_that_does_not_exist(run, tmp_path: Path) -> None:
    outcome = run("demo", "gecko", "--pose", "wild", "--out", tmp_path / "out")
    assert_refused(outcome, "wild", "gentle, extreme")


@pytest.fixture
def map_data(problem_data: dict[str, Any]) -> dict[str, Any]:
    return glid_nb.HarmonicMap.identity(glid_nb.io.Problem.from_dict(problem_data).domain).to_dict()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"format": "other"}, "this is not a glid_nb map"),
        ({"version": 99}, "version 99"),
        ({"phi": None}, '"phi" must be a list'),
        ({"phi": [[0, 0]]}, "phi has shape (1,)"),
        ({"psi": [["a", 0]]}, '"psi" must be a list of [re, im] pairs of numbers'),
        ({"hole_points": [[5, 0]]}, "the map's domain is not valid"),
        ({"offset_cage": [[-1, -1], [1, -1], [0, 1]]}, "the map's domain is not valid"),
    ],
)
def test_a_corrupt_map(
    run, picture: Path, tmp_path: Path, map_data: dict[str, Any], change: dict, message: str
) -> None:
    path = tmp_path / "map.json"
    path.write_text(json.dumps({**map_data, **change}))
    out = tmp_path / "out.png"
    assert_refused(run("render", picture, path, "--out", out), path, message)
    assert not out.exists()


def test_a_map_with_nan(run, picture: Path, tmp_path: Path, map_data: dict[str, Any]) -> None:
    map_data["psi"][2] = [float("nan"), 0]
    path = tmp_path / "map.json"
    path.write_text(json.dumps(map_data))
    outcome = run("render", picture, path, "--out", tmp_path / "x.png")
    assert_refused(outcome, path, "psi[2]", "finite")


def test_a_map_that_lacks_a_key(
    run, picture: Path, tmp_path: Path, map_data: dict[str, Any]
) -> None:
    del map_data["psi"]
    path = tmp_path / "map.json"
    path.write_text(json.dumps(map_data))
    outcome = run("render", picture, path, "--out", tmp_path / "x.png")
    assert_refused(outcome, path, 'lacks the key "psi"')


def test_a_foreign_map(run, picture: Path, problem: Path, tmp_path: Path) -> None:
    outcome = run("render", picture, problem, "--out", tmp_path / "x.png")
    assert_refused(outcome, problem, "this is not a glid_nb map")


def test_a_start_map_of_another_domain(run, problem: Path, tmp_path: Path) -> None:
    other = glid_nb.Domain.from_cage(glid_nb.Cage([[0, 0], [1, 0], [0, 1]]))
    start = tmp_path / "start.json"
    glid_nb.HarmonicMap.identity(other).save(start)
    assert_refused(run("solve", problem, "--start", start), start, "domain")


@pytest.mark.parametrize("command", ["solve", "trace", "render"])
def test_an_output_folder_that_is_missing(
    run, picture: Path, problem: Path, tmp_path: Path, command: str
) -> None:
    words = {"solve": [problem], "trace": [picture], "render": [picture, problem]}[command]
    folder = tmp_path / "missing"
    outcome = run(command, *words, "--out", folder / "file.png")
    assert_refused(outcome, folder, "there is no such folder")


def test_an_output_folder_that_is_a_file(run, picture: Path) -> None:
    assert_refused(run("demo", picture, "--out", picture), picture, "is a file; name a folder")
    outcome = run("demo", picture, "--out", picture / "deeper")
    assert_refused(outcome, picture, "is a file; name a folder")


def test_an_output_folder_in_which_the_result_would_replace_the_input(
    run, problem: Path, tmp_path: Path
) -> None:
    """In a folder, a result has the input's name."""
    before = problem.read_bytes()
    outcome = run("solve", problem, "--out", tmp_path)
    assert_refused(outcome, problem, "would be overwritten, but it is also an input")
    assert problem.read_bytes() == before


def test_what_was_there_stays_when_the_run_fails(
    run, problem: Path, problem_data: dict[str, Any], tmp_path: Path
) -> None:
    out, report = tmp_path / "map.json", tmp_path / "report.json"
    out.write_text("precious")
    report.write_text("dear")
    problem.write_text(json.dumps({**problem_data, "handles": []}), encoding="utf-8")
    assert run("solve", problem, "--out", out, "--report", report).code == 1
    assert (out.read_text(), report.read_text()) == ("precious", "dear")


def test_an_interrupted_write_leaves_what_was_there(tmp_path: Path, monkeypatch) -> None:
    path = tmp_path / "map.json"
    path.write_text("precious")

    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "replace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_atomically(path, b"new")
    assert path.read_text() == "precious"
    assert list(tmp_path.iterdir()) == [path]


def test_a_picture_of_other_proportions(run, tmp_path: Path, map_data: dict[str, Any]) -> None:
    picture = _picture(tmp_path / "tall.png", np.full((400, 40, 3), 200, dtype=np.uint8))
    path = tmp_path / "map.json"
    path.write_text(json.dumps(map_data))
    outcome = run("render", picture, path, "--out", tmp_path / "x.png")
    assert_refused(outcome, path, "take the picture that the cage was traced from")


def test_a_map_that_collapses(run, picture: Path, tmp_path: Path, map_data: dict) -> None:
    zeros = [[0.0, 0.0] for _ in map_data["phi"]]
    path = tmp_path / "map.json"
    path.write_text(json.dumps({**map_data, "phi": zeros, "psi": zeros}))
    words = ["render", picture, path, "--out", tmp_path / "x.png", "--view", "fit"]
    assert_refused(run(*words), path, "collapses the shape")


def test_a_picture_is_written_as_png_only(run, picture: Path, tmp_path: Path) -> None:
    outcome = run("render", picture, tmp_path / "map.json", "--out", tmp_path / "x.jpg")
    assert_refused(outcome, "x.jpg", "ends in .png")


def _names(path: Path, tmp_path: Path, kind: str) -> Path:
    """The same file by another name."""
    other = tmp_path / "by-another-name.png"
    if kind == "the same":
        return path
    if kind == "roundabout":
        return path.parent / ".." / path.parent.name / path.name
    if kind == "symbolic link":
        other.symlink_to(path)
    else:
        other.hardlink_to(path)
    return other


@pytest.mark.parametrize("kind", ["the same", "roundabout", "symbolic link", "hard link"])
@pytest.mark.parametrize(
    ("words", "place"),
    [
        ("solve FILE --out OUT", "problem"),
        ("solve FILE --report OUT", "problem"),
        ("solve problem.json --start FILE --out OUT", "map"),
        ("trace FILE --out OUT", "picture"),
        ("trace plus.png --scribbles FILE --out OUT", "scribbles"),
        ("render FILE map.json --out OUT", "picture"),
        ("render plus.png FILE --out OUT", "map"),
    ],
)
def test_a_command_never_writes_over_its_input(
    run, picture: Path, problem: Path, tmp_path: Path, words: str, place: str, kind: str
) -> None:
    file = {"problem": problem, "picture": picture}.get(place, tmp_path / f"{place}.png")
    if not file.exists():
        file.write_text("{}")
    before, out = file.read_bytes(), _names(file, tmp_path, kind)
    known = {"FILE": file, "OUT": out, "problem.json": problem, "plus.png": picture}
    outcome = run(*(known.get(word, word) for word in words.split()))
    assert_refused(outcome, out, "would be overwritten, but it is also an input")
    assert file.read_bytes() == before


@pytest.mark.parametrize("flag", ["IMAGE", "--pose", "--scribbles"])
def test_a_demo_never_writes_over_its_input(run, picture: Path, tmp_path: Path, flag: str) -> None:
    out = tmp_path / "out"
    out.mkdir()
    file = out / ("deformed.png" if flag == "IMAGE" else "map.json")
    file.write_bytes(picture.read_bytes())
    words = [file] if flag == "IMAGE" else [picture, flag, file]
    assert_refused(run("demo", *words, "--out", out), file, "would be overwritten")
    assert file.read_bytes() == picture.read_bytes()


def test_two_results_never_go_to_one_file(run, problem: Path, tmp_path: Path) -> None:
    out, link = tmp_path / "map.json", tmp_path / "link"
    link.symlink_to(out)
    for report in (out, link):
        outcome = run("solve", problem, "--out", out, "--report", report)
        assert_refused(outcome, report, "another result is written there")


def test_a_picture_of_another_size_than_the_maps(
    run, picture: Path, tmp_path: Path, map_data: dict[str, Any]
) -> None:
    other = _picture(tmp_path / "half.png", np.array(Image.open(picture).resize((80, 60))))
    path = tmp_path / "map.json"
    path.write_text(json.dumps({**map_data, "image_size_px": [160, 120]}))
    out = tmp_path / "x.png"
    outcome = run("render", other, path, "--out", out)
    assert_refused(outcome, other, "80 x 60", "[160, 120]", "that its cage was traced from")
    assert not out.exists()
    assert run("render", picture, path, "--out", out).code == 0


def test_a_picture_size_that_is_none(
    run, problem: Path, problem_data: dict[str, Any], tmp_path: Path
) -> None:
    problem.write_text(json.dumps({**problem_data, "image_size_px": [160, "wide"]}))
    outcome = run("solve", problem, "--out", tmp_path / "map.json")
    assert_refused(outcome, problem, "image_size_px must be [width, height] in pixels")
