"""`glid-nb animate`: sessions and saved motions as moving pictures."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from glid_nb import Motion
from glid_nb.cli import animate
from glid_nb.energies import SymmetricDirichlet
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import TraceOptions
from glid_nb.session.document import Document, NamedPose
from glid_nb.session.document_file import save_document
from glid_nb.session.timeline import Timeline
from glid_nb.solvers import Options

from ..support import shapes

pytestmark = pytest.mark.slow

SMALL = ("--size", 32, "--fps", 2)


def document(timeline: Timeline | None = None, count: int = 2) -> Document:
    maps = [HarmonicMap.identity(shapes.domain()), shapes.bent()][:count]
    poses = [
        NamedPose(f"pose {i}", shapes.pose(), SymmetricDirichlet(), Options(), map)
        for i, map in enumerate(maps)
    ]
    domain = shapes.domain()
    return Document(
        shapes.picture(), domain.cage, domain, TraceOptions(), None, tuple(poses), 0, timeline
    )


@pytest.fixture
def session(tmp_path: Path) -> Path:
    save_document(document(), tmp_path / "walk.glid")
    return tmp_path / "walk.glid"


def opened(path: Path) -> tuple[int, float, bool]:
    """Frames and seconds of a GIF, and whether it repeats for ever."""
    with Image.open(path) as read:
        seconds = 0.0
        for i in range(read.n_frames):
            read.seek(i)
            seconds += read.info["duration"] / 1000
        return read.n_frames, seconds, "loop" in read.info


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ((), (4, 2.0, True)),
        (("--loop", "once"), (3, 1.5, False)),
        (("--loop", "ping-pong", "--seconds", 3), (6, 3.0, True)),
    ],
)
def test_a_session_becomes_a_gif(
    run: Any, session: Path, tmp_path: Path, words: tuple, expected: tuple[int, float, bool]
) -> None:
    outcome = run("animate", session, "--out", tmp_path / "walk.gif", *SMALL, *words)
    assert outcome.code == 0, outcome.err
    assert opened(tmp_path / "walk.gif") == pytest.approx(expected)
    assert "Proved locally injective at every time" in outcome.out


def test_the_timeline_of_a_session_is_followed(run: Any, tmp_path: Path) -> None:
    timeline = Timeline((0.5, 1.0), ("in", "linear"), "ping-pong")
    save_document(document(timeline), tmp_path / "walk.glid")
    assert run("animate", tmp_path / "walk.glid", "--out", tmp_path / "a.gif", *SMALL).code == 0
    assert opened(tmp_path / "a.gif") == (2, 1.0, True)
    assert replace(timeline, repeat="loop").lasting(3).closed_times == pytest.approx((0, 1, 3))


@pytest.mark.parametrize(
    ("words", "seconds"),
    [
        (("--loop-range",), "0.75"),
        (("--loop-range", "--seconds", 4), "1.5"),
        (("--range", 0.5, 1), "0.5"),
    ],
)
def test_a_part_of_the_timeline_becomes_a_gif_that_repeats(
    run: Any, tmp_path: Path, words: tuple, seconds: str
) -> None:
    timeline = replace(Timeline.even(2), repeat="loop", loop_range=(0.25, 1.0))
    save_document(document(timeline), tmp_path / "walk.glid")
    outcome = run("animate", tmp_path / "walk.glid", "--out", tmp_path / "a.gif", *SMALL, *words)
    assert outcome.code == 0, outcome.err
    assert f"; {seconds} s." in outcome.out
    assert opened(tmp_path / "a.gif")[2]


def test_a_loop_range_that_covers_the_motion_is_all_of_it(run: Any, tmp_path: Path) -> None:
    save_document(document(replace(Timeline.even(2), loop_range=(0, 1.0))), tmp_path / "walk.glid")
    words = ("animate", tmp_path / "walk.glid", "--out", tmp_path / "a.gif", *SMALL)
    for more, seconds in (((), "1"), (("--seconds", 2), "2")):
        outcome = run(*words, "--loop-range", *more)
        assert outcome.code == 0, outcome.err
        assert f"; {seconds} s." in outcome.out
        assert opened(tmp_path / "a.gif")[2]


@pytest.mark.parametrize("more", [(), ("--seconds", 4)])
def test_a_loop_range_beyond_the_motion_is_refused_with_its_place(
    run: Any, tmp_path: Path, more: tuple
) -> None:
    timeline = replace(Timeline.even(2), repeat="loop", loop_range=(1.25, 2.0))
    save_document(document(timeline), tmp_path / "walk.glid")
    words = ("animate", tmp_path / "walk.glid", "--out", tmp_path / "a.gif", *SMALL)
    outcome = run(*words, "--loop-range", "--loop", "once", *more)
    where = "the loop range lies from 1.25 to 2 s, but the motion from 0 to 1 s"
    assert (outcome.code, where in outcome.err) == (1, True)
    assert run(*words, "--loop-range").code == 0


def test_a_part_that_is_not_there_is_refused(run: Any, session: Path, tmp_path: Path) -> None:
    words = ("animate", session, "--out", tmp_path / "a.gif", *SMALL)
    outcome = run(*words, "--loop-range")
    assert (outcome.code, "has no loop range" in outcome.err) == (1, True)
    outcome = run(*words, "--range", 0.5, 9)
    assert (outcome.code, "there is no motion from 0.5 to 9 s" in outcome.err) == (1, True)
    assert not (tmp_path / "a.gif").exists()


@pytest.mark.parametrize("name", ["a.webm", "a.sheet.png", "a"])
def test_the_suffix_says_the_format(run: Any, session: Path, tmp_path: Path, name: str) -> None:
    outcome = run("animate", session, "--out", tmp_path / name, *SMALL, "--background", "#204060")
    assert outcome.code == 0, outcome.err
    assert (tmp_path / name).exists()


def test_a_saved_motion_moves_its_picture(run: Any, tmp_path: Path) -> None:
    Motion([HarmonicMap.identity(shapes.domain()), shapes.bent()]).save(tmp_path / "motion.json")
    Image.fromarray(shapes.picture()).save(tmp_path / "picture.png")
    words = ("animate", tmp_path / "motion.json", "--picture", tmp_path / "picture.png", *SMALL)
    outcome = run(*words, "--out", tmp_path / "a.apng", "--background", "transparent")
    assert outcome.code == 0, outcome.err
    with Image.open(tmp_path / "a.apng") as read:
        assert read.n_frames == 3
        assert np.asarray(read.convert("RGBA"))[0, 0, 3] == 0
    own = tmp_path / "a.apng"
    outcome = run("animate", tmp_path / "motion.json", "--picture", own, "--out", own)
    assert (outcome.code, "it is also an input" in outcome.err) == (1, True)
    assert run(*words, "--out", tmp_path / "b.gif", "--seconds", 2).code == 0
    assert opened(tmp_path / "b.gif")[0] == 5


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--out", "walk.avi"), "must end in .gif"),
        (("--out", "walk.gif", "--seconds", "-1"), "--seconds is -1"),
        (("--out", "walk.gif", "--fps", "0"), "greater than 0"),
        (("--out", "walk.gif", "--picture", "a.png"), "a session holds its picture"),
        (("--out", "walk.glid"), "must end in .gif"),
    ],
)
def test_what_does_not_fit_is_refused(
    run: Any, session: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], message: str
) -> None:
    monkeypatch.chdir(session.parent)
    outcome = run("animate", session, *words)
    assert outcome.code == 1
    assert message in outcome.err
    assert outcome.err.count("\n") == 1


def test_a_session_needs_two_poses_and_a_motion_its_picture(run: Any, tmp_path: Path) -> None:
    save_document(document(count=1), tmp_path / "one.glid")
    outcome = run("animate", tmp_path / "one.glid", "--out", tmp_path / "a.gif")
    assert outcome.code == 1
    assert "holds 1 poses; a motion needs at least 2" in outcome.err
    Motion([HarmonicMap.identity(shapes.domain()), shapes.bent()]).save(tmp_path / "motion.json")
    outcome = run("animate", tmp_path / "motion.json", "--out", tmp_path / "a.gif")
    assert outcome.code == 1
    assert "name its picture with --picture" in outcome.err


def test_a_motion_that_folds_is_not_written(run: Any, tmp_path: Path) -> None:
    start = HarmonicMap.identity(shapes.domain())
    turned = HarmonicMap(start.domain, -start.phi, -start.psi)
    Motion([start, turned], between="linear").save(tmp_path / "motion.json")
    Image.fromarray(shapes.picture()).save(tmp_path / "picture.png")
    words = ("--picture", tmp_path / "picture.png", "--out", tmp_path / "a.gif", *SMALL)
    outcome = run("animate", tmp_path / "motion.json", *words)
    assert outcome.code == 1
    assert "Certified up to t = 0.49" in outcome.err
    assert not (tmp_path / "a.gif").exists()


def test_a_wrong_size_is_refused_before_anything_is_proved(
    run: Any, session: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Motion, "certificate", None)
    outcome = run("animate", session, "--out", tmp_path / "a.gif", "--size", "9999")
    assert outcome.code == 1
    assert "size is 9999; it must be a whole number from 16 to 8192" in outcome.err


def test_ctrl_c_leaves_nothing(
    run: Any, session: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: Any, progress: Any, **__: Any) -> None:
        progress(1, 4)
        raise KeyboardInterrupt

    monkeypatch.setattr(animate.glid_nb.export, "animate", interrupted)
    outcome = run("animate", session, "--out", tmp_path / "walk.gif")
    assert outcome.code == 130
    assert not (tmp_path / "walk.gif").exists()


def test_a_saved_motion_refuses_a_picture_of_another_size(run: Any, tmp_path: Path) -> None:
    maps = [HarmonicMap.identity(shapes.domain()), shapes.bent()]
    Motion(maps, image_size=shapes.SIZE).save(tmp_path / "motion.json")
    other = tmp_path / "other.png"
    Image.new("RGBA", (240, 200), (9, 9, 9, 255)).save(other)  # the cage would replace it
    words = ("animate", tmp_path / "motion.json", "--picture", other, *SMALL)
    outcome = run(*words, "--out", tmp_path / "a.gif")
    assert outcome.code == 1
    assert "the picture has 240 x 200 pixels, but the motion is of 300 x 200" in outcome.err
    assert not (tmp_path / "a.gif").exists()


def test_an_exported_motion_knows_the_size_of_its_picture(
    run: Any, session: Path, tmp_path: Path
) -> None:
    out = tmp_path / "walk.motion.json"
    assert run("animate", session, "--out", out).code == 0
    assert Motion.load(out).image_size == shapes.SIZE
    Image.new("RGBA", (100, 100), (9, 9, 9, 255)).save(tmp_path / "other.png")
    words = ("animate", out, "--picture", tmp_path / "other.png", *SMALL)
    outcome = run(*words, "--out", tmp_path / "a.gif")
    assert outcome.code == 1
    assert "100 x 100 pixels, but the motion is of 300 x 200" in outcome.err
