"""Many inputs on one line, and results on standard output."""

from __future__ import annotations

import io
import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile
from PIL import Image

from glid_nb import Cage, HarmonicMap
from glid_nb.cli import main

from ..support import shapes

pytestmark = pytest.mark.slow


@pytest.fixture
def pictures(picture: Path, tmp_path: Path) -> list[Path]:
    """Two pictures that can be traced, and between them one that cannot."""
    empty = tmp_path / "empty.png"
    Image.new("RGBA", (20, 20)).save(empty)
    other = tmp_path / "other.png"
    shutil.copyfile(picture, other)
    return [picture, empty, other]


@pytest.fixture
def map_file(tmp_path: Path) -> Path:
    path = tmp_path / "bent.json"
    shapes.bent().save(path)
    return path


def test_one_that_fails_does_not_stop_the_others(run: Any, pictures: Any, tmp_path: Path) -> None:
    outcome = run("trace", *pictures, "--out", f"{tmp_path / 'cages'}/")
    assert outcome.code == 1
    written = sorted(path.name for path in (tmp_path / "cages").iterdir())
    assert written == ["other.json", "plus.json"]
    assert Cage.from_dict(json.loads((tmp_path / "cages" / "plus.json").read_text())).holes
    first, last = outcome.err.splitlines()
    assert first.startswith(f"glid-nb: error: {pictures[1]}: the image has one colour only")
    assert last == "glid-nb: error: 1 of 3 inputs failed, for the reasons above"


def test_many_pictures_that_can_be_traced(run: Any, pictures: Any, tmp_path: Path) -> None:
    outcome = run("trace", pictures[0], pictures[2], "--out", tmp_path / "new" / "cages")
    assert (outcome.code, outcome.err) == (0, "")
    assert len(list((tmp_path / "new" / "cages").iterdir())) == 2


def test_one_picture_into_a_folder(run: Any, picture: Path, tmp_path: Path) -> None:
    (tmp_path / "cages").mkdir()
    assert run("trace", picture, "--out", tmp_path / "cages").code == 0
    assert (tmp_path / "cages" / "plus.json").is_file()


def test_results_that_cannot_be_told_apart_are_refused(run: Any, picture: Path, tmp_path: Path):
    (tmp_path / "more").mkdir()
    same = tmp_path / "more" / "plus.png"
    shutil.copyfile(picture, same)
    outcome = run("trace", picture, same, "--out", f"{tmp_path / 'cages'}/")
    assert outcome.code == 1
    assert f"{picture} and {same} would both be written to" in outcome.err
    outcome = run("trace", picture, same, "--out", tmp_path / "cage.json")
    assert outcome.code == 1
    assert f"a file for the results of 2 inputs; name a folder, such as {tmp_path}" in outcome.err
    assert not (tmp_path / "cage.json").exists()


def test_a_cage_on_standard_output(run: Any, picture: Path, tmp_path: Path, monkeypatch: Any):
    monkeypatch.chdir(tmp_path)
    outcome = run("trace", picture, "--out", "-")
    assert outcome.code == 0
    assert Cage.from_dict(json.loads(outcome.out)).holes
    assert "vertices" in outcome.err
    assert not Path("-").exists()
    assert run("trace", picture, "--out", "./-").code == 0
    assert Path("-").is_file()
    outcome = run("trace", picture, picture, "--out", "-")
    assert outcome.code == 1
    assert "standard output takes the result of one input, and there are 2" in outcome.err


@pytest.mark.parametrize("flag", ["--out", "--report", "--proof"])
def test_a_solve_on_standard_output(run: Any, problem: Path, flag: str) -> None:
    outcome = run("solve", problem, flag, "-")
    assert outcome.code == 0, outcome.err
    json.loads(outcome.out)
    assert "standard output" in outcome.err


def test_two_results_cannot_share_standard_output(run: Any, problem: Path) -> None:
    outcome = run("solve", problem, "--out", "-", "--report", "-")
    assert outcome.code == 1
    assert "--out and --report would share standard output" in outcome.err
    outcome = run("solve", problem, "--out", "-", "--json")
    assert outcome.code == 1
    assert "--out and --json would share standard output" in outcome.err


def test_many_problems(run: Any, problem: Path, problem_data: Any, tmp_path: Path) -> None:
    wrong, second = tmp_path / "wrong.json", tmp_path / "second.json"
    wrong.write_text(json.dumps({**problem_data, "handles": [[99, 99]], "targets": [[0, 0]]}))
    shutil.copyfile(problem, second)
    words = ("--out", f"{tmp_path / 'maps'}/", "--report", f"{tmp_path / 'reports'}/")
    outcome = run("solve", problem, wrong, second, *words)
    assert outcome.code == 1
    for folder in ("maps", "reports"):
        names = sorted(path.name for path in (tmp_path / folder).iterdir())
        assert names == ["problem.json", "second.json"]
    assert f"{wrong}: " in outcome.err
    assert "1 of 3 inputs failed" in outcome.err
    HarmonicMap.load(tmp_path / "maps" / "second.json")


def test_many_maps_of_a_picture(run: Any, map_file: Path, tmp_path: Path) -> None:
    own = tmp_path / "own.png"
    Image.fromarray(shapes.picture()).save(own)
    start, wrong = tmp_path / "start.json", tmp_path / "wrong.json"
    HarmonicMap.identity(shapes.domain()).save(start)
    wrong.write_text("{}")
    outcome = run("render", own, map_file, wrong, start, "--out", f"{tmp_path / 'drawn'}/")
    assert outcome.code == 1
    assert sorted(p.name for p in (tmp_path / "drawn").iterdir()) == ["bent.png", "start.png"]
    assert f"{wrong}" in outcome.err


def test_a_picture_on_standard_output(map_file: Path, tmp_path: Path, capfdbinary: Any) -> None:
    own = tmp_path / "own.png"
    Image.fromarray(shapes.picture()).save(own)
    assert main(["render", str(own), str(map_file), "--out", "-"]) == 0
    out, err = capfdbinary.readouterr()
    assert Image.open(io.BytesIO(out)).size == shapes.SIZE
    assert b"300 x 200 pixels" in err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("animate", "a.glid"), "--out -: the suffix determines the format, so name a file"),
        (("demo",), "--out -: 5 files are written, so name a folder"),
    ],
)
def test_what_one_stream_cannot_hold_is_refused(
    run: Any, tmp_path: Path, monkeypatch: Any, words: Any, message: str
) -> None:
    monkeypatch.chdir(tmp_path)
    outcome = run(*words, "--out", "-")
    assert outcome.code == 1
    assert message in outcome.err
    assert not list(tmp_path.iterdir())


LABELS = 20 * np.random.default_rng(0).integers(0, 11, (25, 38)).repeat(8, 0).repeat(8, 1)[:, :300]


class TestLabels:
    """`render --interpolation nearest`."""

    @pytest.fixture
    def words(self, map_file: Path) -> tuple[Any, ...]:
        return (map_file, "--interpolation", "nearest", "--out")

    def test_a_png_of_labels(self, run: Any, words: Any, tmp_path: Path) -> None:
        for dtype in (np.uint8, np.uint16):
            Image.fromarray(LABELS.astype(dtype)).save(tmp_path / "labels.png")
            assert run("render", tmp_path / "labels.png", *words, tmp_path / "o.png").code == 0
            drawn = np.asarray(Image.open(tmp_path / "o.png"))
            assert (drawn.dtype, drawn.shape) == (dtype, LABELS.shape)
            assert set(np.unique(drawn)) == set(np.unique(LABELS))

    def test_a_palette_stays(self, run: Any, words: Any, tmp_path: Path) -> None:
        picture = Image.fromarray((LABELS // 20).astype(np.uint8))
        picture.putpalette([255, 0, 0, 0, 255, 0, 0, 0, 255, *range(24)])
        picture.save(tmp_path / "labels.png")
        assert run("render", tmp_path / "labels.png", *words, tmp_path / "o.png").code == 0
        drawn = Image.open(tmp_path / "o.png")
        assert drawn.mode == "P"
        assert (drawn.getpalette() or [])[:9] == [255, 0, 0, 0, 255, 0, 0, 0, 255]
        assert set(np.unique(np.asarray(drawn))) == set(range(11))

    @pytest.mark.parametrize("suffix", [".npy", ".tif"])
    @pytest.mark.parametrize("dtype", ["i4", "f4", "u1", "f8"])
    @pytest.mark.parametrize("channels", [0, 3, 5])
    def test_any_numbers(
        self, run: Any, words: Any, tmp_path: Path, suffix: str, dtype: str, channels: int
    ) -> None:
        values = LABELS.astype(dtype)
        values = np.stack([values] * channels, axis=2) if channels else values
        given, out = tmp_path / f"labels{suffix}", tmp_path / f"out{suffix}"
        if suffix == ".npy":
            np.save(given, values)
        else:
            tifffile.imwrite(given, values, photometric="minisblack", planarconfig="contig")
        outcome = run("render", given, *words, out, "--view", "fit")
        assert outcome.code == 0, outcome.err
        drawn = np.load(out) if suffix == ".npy" else tifffile.imread(out)
        assert (drawn.dtype, drawn.shape) == (values.dtype, values.shape)
        assert set(np.unique(drawn)) <= set(np.unique(values))

    def test_what_a_png_cannot_hold_is_refused(self, run: Any, words: Any, tmp_path: Path) -> None:
        np.save(tmp_path / "labels.npy", LABELS.astype(np.int32))
        outcome = run("render", tmp_path / "labels.npy", *words, tmp_path / "o.png")
        assert outcome.code == 1
        assert "a PNG cannot hold int32 values" in outcome.err
        (tmp_path / "no.npy").write_bytes(b"nothing")
        outcome = run("render", tmp_path / "no.npy", *words, tmp_path / "o.png")
        assert outcome.code == 1
        assert "no.npy is damaged or cut short" in outcome.err
