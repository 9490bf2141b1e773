"""Motions as files, read by programs that did not write them."""

from __future__ import annotations

import errno
import io
import json
import os
import struct
import subprocess
import zipfile
from pathlib import Path
from typing import IO, Any

import imageio_ffmpeg
import numpy as np
import pytest
import trimesh
from PIL import Image, ImageSequence

import glid_check
from glid_nb import InputError, Motion
from glid_nb.export import (
    MOTION_FORMATS,
    MovingPart,
    animate,
    encode,
    motion_files,
    motion_glb,
)
from glid_nb.export.moving import MovingMesh, frames
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import PixelFrame
from glid_nb.imaging.order import order_of
from glid_nb.pose import Pose

from ..support.shapes import SIZE, bent, domain, picture, pose

pytestmark = pytest.mark.slow

SMALL = {"size": 64, "frames_per_second": 3.0}


def motion(repeat: Any = "once") -> Motion:
    return Motion([HarmonicMap.identity(domain()), bent()], repeat=repeat)


@pytest.fixture(scope="module")
def drawn() -> list[np.ndarray]:
    return list(frames([MovingPart(picture(), motion())], 64, 3.0, (255, 255, 255)).pictures)


def rgb(image: Image.Image) -> np.ndarray:
    return np.asarray(image.convert("RGB")).astype(int)


def test_the_mesh_moves_as_the_motion_does() -> None:
    for repeat in ("once", "loop", "ping-pong"):
        moving = motion(repeat)
        mesh = MovingMesh.of(moving, None, 300, 0.05)
        for time in np.linspace(moving.start, moving.end, 7):
            at, map = mesh.at(time), moving(time)
            np.testing.assert_allclose(at.images, map(mesh.vertices), atol=1e-10)
            sides = at.triangles[:, [0, 1]]
            middles = map(mesh.vertices[sides].mean(axis=1)) - at.images[sides].mean(axis=1)
            assert np.linalg.norm(middles, axis=1).max() <= 0.05 + 1e-10


def test_depths_pass_from_one_keyframes_to_the_next() -> None:
    there = Pose(pose().handles, pose().targets, [1.0, -1.0])
    mesh = MovingMesh.of(motion(), [pose(), there], 300)
    first, last = (order_of(domain().cage, one)(mesh.vertices) for one in (pose(), there))
    np.testing.assert_allclose(mesh.at(0).heights, first)
    np.testing.assert_allclose(mesh.at(1).heights, last)
    np.testing.assert_allclose(mesh.at(0.25).heights, 0.75 * first + 0.25 * last)
    assert len(MovingMesh.of(motion(), [pose(), pose()], 300).heights) == 1
    with pytest.raises(InputError, match="2 keyframes but 1 poses"):
        MovingMesh.of(motion(), [pose()], 300)


@pytest.mark.parametrize("loop", [True, False])
@pytest.mark.parametrize("kind", ["gif", "apng"])
def test_pillow_opens_animations(kind: str, loop: bool, drawn: list[np.ndarray]) -> None:
    name = f"walk.{kind}"
    with Image.open(
        io.BytesIO(motion_files(name, picture(), motion(), loop=loop, **SMALL)[name])
    ) as read:
        shown, spans = [], []
        for frame in ImageSequence.Iterator(read):
            shown.append(rgb(frame))
            spans.append(frame.info["duration"])
        assert read.info.get("loop", 1) == int(not loop)
    assert len(shown) == len(drawn) == 4
    assert sum(spans) == pytest.approx(4000 / 3, abs=6)
    assert max(shown[0].shape) == 64
    for seen, frame in zip(shown, drawn, strict=True):
        assert np.abs(seen - frame[..., :3]).mean() < (4 if kind == "gif" else 1e-9)


def test_an_apng_may_be_transparent() -> None:
    data = motion_files("a.apng", picture(), motion(), background=None, **SMALL)["a.apng"]
    with Image.open(io.BytesIO(data)) as read:
        last = np.asarray(list(ImageSequence.Iterator(read))[-1].convert("RGBA"))
    assert last[0, 0, 3] == 0
    assert last[..., 3].max() == 255


def decoded(path: Path, kind: str, *before: str) -> bytes:
    """Pixels of a video, by ffmpeg."""
    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", *before, "-i", str(path)]
    raw = ["-f", "rawvideo", "-pix_fmt", kind, "-"]
    return subprocess.run([*command, *raw], capture_output=True, check=True).stdout


@pytest.mark.parametrize("kind", ["mp4", "webm"])
def test_ffmpeg_reads_videos(kind: str, drawn: list[np.ndarray], tmp_path: Path) -> None:
    (path,) = animate(tmp_path / f"walk.{kind}", picture(), motion(), **SMALL)
    count, seconds = imageio_ffmpeg.count_frames_and_secs(str(path))
    assert (count, seconds) == (4, pytest.approx(4 / 3, abs=0.02))
    # Browsers guess colours that a video does not name.
    probe = [imageio_ffmpeg.get_ffmpeg_exe(), "-hide_banner", "-i", str(path)]
    told = subprocess.run(probe, capture_output=True, text=True, check=False).stderr
    assert "yuv420p(tv, bt709, progressive), 64x" in told
    assert " 3 fps" in told
    shape = (*drawn[0].shape[:2], 3)
    seen = np.frombuffer(decoded(path, "rgb24"), np.uint8).reshape(4, *shape).astype(int)
    for frame, expected in zip(seen, drawn, strict=True):
        assert np.abs(frame - expected[..., :3]).mean() < 5


def test_a_video_may_be_transparent(drawn: list[np.ndarray], tmp_path: Path) -> None:
    (path,) = animate(tmp_path / "a.webm", picture(), motion(), background=None, **SMALL)
    # ffmpeg's own decoder ignores alpha.
    data = decoded(path, "rgba", "-c:v", "libvpx-vp9")
    alpha = np.frombuffer(data, np.uint8).reshape(4, *drawn[0].shape)[..., 3]
    assert alpha[:, 0, 0].max() < 10
    assert alpha.max() > 245


def test_a_sheet_says_where_its_frames_are(drawn: list[np.ndarray]) -> None:
    files = motion_files("walk.sheet.png", picture(), motion(), **SMALL)
    assert list(files) == ["walk.sheet.png", "walk.sheet.json"]
    told = json.loads(files["walk.sheet.json"])
    with Image.open(io.BytesIO(files["walk.sheet.png"])) as sheet:
        assert told["meta"]["image"] == "walk.sheet.png"
        assert told["meta"]["size"] == {"w": sheet.width, "h": sheet.height}
        assert told["animations"]["walk"] == list(told["frames"]) == encode.names(4)
        for one, expected in zip(told["frames"].values(), drawn, strict=True):
            x, y, w, h = (one["frame"][key] for key in "xywh")
            np.testing.assert_array_equal(sheet.crop((x, y, x + w, y + h)), expected)
            assert one["sourceSize"] == {"w": w, "h": h}


def test_transparent_texels_of_sheets_and_frames_have_the_colours_beside_them() -> None:
    """Game engines interpolate them with straight alpha."""
    settings = {**SMALL, "background": None}
    sheet = motion_files("walk.sheet.png", picture(), motion(), **settings)["walk.sheet.png"]
    with zipfile.ZipFile(
        io.BytesIO(motion_files("a.zip", picture(), motion(), **settings)["a.zip"])
    ) as archive:
        first = archive.read("frame-000.png")
    for data in (sheet, first):
        with Image.open(io.BytesIO(data)) as read:
            pixels = np.asarray(read)
        clear = pixels[..., 3] == 0
        assert clear.any()
        assert pixels[clear][:, :3].max(axis=1).min() > 0  # black before


def test_frames_go_into_a_zip_or_a_folder(drawn: list[np.ndarray], tmp_path: Path) -> None:
    (path,) = animate(tmp_path / "walk.zip", picture(), motion(), **SMALL)
    files = animate(tmp_path / "walk", picture(), motion(), **SMALL)
    with zipfile.ZipFile(path) as archive:
        assert archive.namelist() == [file.name for file in files]
        for file, expected in zip(files, drawn, strict=True):
            assert archive.read(file.name) == file.read_bytes()
            with Image.open(file) as read:
                np.testing.assert_array_equal(read, expected)


def test_a_motion_comes_with_its_proof(tmp_path: Path) -> None:
    files = animate(tmp_path / "walk.motion.json", picture(), motion())
    assert [path.name for path in files] == ["walk.motion.json", "walk.motion.proof.json"]
    assert glid_check.main([str(path) for path in files]) == 0
    assert Motion.load(files[0]).certificate.certified


def parts_of(glb: bytes) -> tuple[dict[str, Any], list[np.ndarray]]:
    """The JSON of a binary glTF, and its accessors as arrays."""
    magic, version, size, length = struct.unpack_from("<4sIII", glb)
    assert (magic, version, size) == (b"glTF", 2, len(glb))
    tree = json.loads(glb[20 : 20 + length])
    start = 20 + length + 8
    kinds = {5126: "<f4", 5125: "<u4", 5123: "<u2"}
    arrays = []
    for accessor in tree["accessors"]:
        view = tree["bufferViews"][accessor["bufferView"]]
        at = start + view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[accessor["type"]]
        count = accessor["count"] * width
        values = np.frombuffer(glb, kinds[accessor["componentType"]], count, at).reshape(-1, width)
        np.testing.assert_array_equal(values.min(axis=0), accessor["min"])
        np.testing.assert_array_equal(values.max(axis=0), accessor["max"])
        arrays.append(values)
    return tree, arrays


@pytest.mark.parametrize("repeat", ["once", "loop", "ping-pong"])
def test_morph_targets_follow_the_motion(repeat: Any) -> None:
    moving = motion(repeat)
    glb = motion_glb(picture(), moving, n_vertices=300)
    scene = trimesh.load(io.BytesIO(glb), file_type="glb", process=False)
    (read,) = scene.geometry.values()
    tree, arrays = parts_of(glb)
    (primitive,) = tree["meshes"][0]["primitives"]
    positions = arrays[primitive["attributes"]["POSITION"]]
    np.testing.assert_allclose(read.vertices, positions, atol=1e-6)
    targets = np.stack([arrays[target["POSITION"]] for target in primitive["targets"]])
    (animation,) = tree["animations"]
    (channel,), (sampler,) = animation["channels"], animation["samplers"]
    assert sampler["interpolation"] == "LINEAR"
    assert channel["target"]["path"] == "weights"
    assert "mesh" in tree["nodes"][channel["target"]["node"]]
    times = arrays[sampler["input"]].ravel()
    weights = arrays[sampler["output"]].reshape(len(times), -1)
    assert times[0] == 0
    assert times[-1] == pytest.approx(moving.duration)
    u, v = arrays[primitive["attributes"]["TEXCOORD_0"]].T
    z = PixelFrame(*SIZE).to_world(np.stack([u, v], axis=-1) * SIZE)  # glTF's v points down
    for time in np.linspace(0, moving.duration, 9):
        shares = [np.interp(time, times, column) for column in weights.T]
        seen = positions + np.tensordot(shares, targets, 1)
        np.testing.assert_allclose(seen[:, :2], moving(time)(z), atol=2e-4)


@pytest.mark.parametrize("repeat", ["once", "loop", "ping-pong"])
def test_times_of_a_moving_mesh_increase_in_single_precision(repeat: Any) -> None:
    identity = HarmonicMap.identity(domain())
    close = Motion([identity, bent(), identity], [0, 10, 10.0000005], repeat=repeat)
    tree, arrays = parts_of(motion_glb(picture(), close, n_vertices=300))
    sampler = tree["animations"][0]["samplers"][0]
    times, weights = (arrays[sampler[key]] for key in ("input", "output"))
    assert (np.diff(times.ravel()) > 0).all()
    assert weights.size == len(times) * len(tree["meshes"][0]["weights"])


def test_progress_is_told_and_stops(tmp_path: Path) -> None:
    told = []
    settings = {**SMALL, "progress": lambda done, total: told.append((done, total))}
    animate(tmp_path / "walk.gif", picture(), motion(), **settings)
    assert told == [(i, 4) for i in range(5)]
    for kind in (".apng", ".mp4", ""):
        settings["progress"] = lambda done, _: done == 1
        assert animate(tmp_path / f"stopped{kind}", picture(), motion(), **settings) == ()
    assert [path.name for path in tmp_path.iterdir()] == ["walk.gif"]


@pytest.mark.parametrize(("kind", "stages"), [("html", 3), ("glb", 2), ("motion.json", 1)])
def test_page_and_mesh_tell_their_stages_and_stop(kind: str, stages: int) -> None:
    told = []
    name = f"walk.{kind}"
    for last in (None, 0, 1, stages):
        told.clear()

        def progress(done: int, total: int, last: int | None = last) -> bool:
            told.append((done, total))
            return done == last

        files = motion_files(name, picture(), motion(), progress=progress)
        assert bool(files) == (last is None)
        assert told == [(i, stages) for i in range((stages if last is None else last) + 1)]


@pytest.mark.parametrize(
    ("name", "changes", "message"),
    [
        ("walk.avi", {}, "must end in .gif"),
        (".gif", {}, "must end in .gif"),
        ("walk.gif", {"background": None}, "GIF has no transparency"),
        ("walk.mp4", {"background": (0, 0)}, "three whole numbers"),
        ("walk.mp4", {"background": "red"}, "background is 'red'; it must be three whole numbers"),
        ("walk.mp4", {"background": (0, None, 0)}, "three whole numbers"),
        ("walk.mp4", {"size": 8}, "size is 8; it must be a whole number from 16 to 8192"),
        ("walk.mp4", {"size": 100_000}, "size is 100000; .* 8192"),
        ("walk.mp4", {"size": "large"}, "size is 'large'; it must be a whole number"),
        ("walk.zip", {"frames_per_second": 0}, "greater than 0"),
        ("walk.zip", {"frames_per_second": 1e6}, "frames_per_second is 1000000.0; .* at most 100"),
        ("walk.zip", {"frames_per_second": None}, "frames_per_second is None; it must be a finite"),
        ("walk.gif", {"frames_per_second": 51}, "frames_per_second of a GIF is 51; .* at most 50"),
        ("walk.gif", {"loop": "no"}, "loop is 'no'; it must be True or False"),
        ("walk.html", {"progress": 5}, "progress is 5; it must be a function"),
        ("walk.gif", {"progress": "%"}, "progress is '%'; it must be a function"),
        ("walk.gif", {"poses": [1, 2]}, "a pose must be Pose or None, not int"),
        ("walk.gif", {"poses": 3}, "a pose must be Pose or None, not int"),
        ("walk.gif", {"image": "walk.png"}, r"an image must have the shape .*, not str"),
        ("walk.html", {"image": None}, r"shape \(h, w\) .*, not NoneType"),
        ("walk.glb", {"motion": bent()}, "motion must be Motion, not HarmonicMap"),
        ("walk.sheet.png", {"size": 3000, "frames_per_second": 60}, "smaller size"),
        ("walk.apng", {"size": 8000, "frames_per_second": 100}, "too many at once; .* smaller"),
    ],
)
def test_what_cannot_be_made_is_refused(name: str, changes: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        motion_files(**{"name": name, "image": picture(), "motion": motion(), **changes})


@pytest.mark.parametrize("kind", [*MOTION_FORMATS, ""])
def test_what_is_not_proved_throughout_is_not_exported(kind: str, tmp_path: Path) -> None:
    start = HarmonicMap.identity(domain())
    folding = Motion([start, HarmonicMap(domain(), -start.phi, -start.psi)], between="linear")
    with pytest.raises(
        InputError, match=r"up to t = 0\.49.*Nothing uncert.*; add a keyframe before"
    ):
        animate(tmp_path / f"walk{kind}", picture(), folding)
    assert not [*tmp_path.iterdir()]


@pytest.mark.skipif(os.name == "nt", reason="programs have other names there")
@pytest.mark.parametrize(
    ("program", "message"),
    [
        ("/nonexistent/ffmpeg", "ffmpeg cannot be run, /nonexistent/ffmpeg: No such file or direc"),
        ("/bin/false", r"ffmpeg \(/bin/false\) could not write .*, exit code 1: no message"),
        ("/bin/true", r"ffmpeg \(/bin/true\) could not write .*, exit code 0: no message"),
    ],
)
def test_an_ffmpeg_that_fails_is_named(
    program: str, message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", program)
    with pytest.raises((InputError, OSError), match=message):
        motion_files("walk.mp4", picture(), motion(), **SMALL)


@pytest.mark.parametrize("number", [errno.EPIPE, errno.EINVAL])
def test_an_ffmpeg_that_ends_early_is_named_by_its_log(
    number: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Windows calls the broken pipe an invalid argument; the log need not be UTF-8."""

    class Ended:
        returncode = 3

        def __init__(self, _command: list[str], told: IO[bytes]) -> None:
            told.write(b"no space on drive \xdc:")
            told.flush()
            self.stdin = self

        def __enter__(self) -> Ended:
            return self

        def __exit__(self, *_: object) -> None: ...

        def write(self, _: bytes) -> None:
            raise OSError(number, os.strerror(number))

    monkeypatch.setattr(encode, "running", Ended)
    with pytest.raises(OSError, match="exit code 3: no space on drive \N{REPLACEMENT CHARACTER}:"):
        motion_files("walk.mp4", picture(), motion(), **SMALL)


def test_a_motion_of_too_many_frames_is_refused() -> None:
    long = Motion(motion().keyframes, [0, 1e6])
    with pytest.raises(InputError, match="25,000,000 frames; 100,000 is the most"):
        motion_files("walk.mp4", picture(), long)
    assert motion_files("walk.glb", picture(), long)  # which has no frames


def test_files_that_cannot_be_there_are_refused_before_anything_is_drawn(tmp_path: Path) -> None:
    def told(*_: int) -> None:
        raise AssertionError("it was drawn")

    (tmp_path / "file").touch()
    (tmp_path / "a.gif").mkdir()
    for name, message in (
        ("no/walk.gif", f"there is no folder {tmp_path / 'no'}; make it"),
        ("no/walk", f"there is no folder {tmp_path / 'no'}; make it"),
        ("file", "is a file; name a folder"),
        ("a.gif", "is a folder; name a file"),
    ):
        with pytest.raises(InputError, match=message):
            animate(tmp_path / name, picture(), motion(), progress=told)


def test_frames_of_a_longer_export_do_not_stay_between(tmp_path: Path) -> None:
    folder, settings = tmp_path / "walk", {"size": 32, "frames_per_second": 3}
    files = animate(folder, picture(), motion(), **settings)
    assert animate(folder, picture(), motion(), **settings) == files
    with pytest.raises(InputError, match=r"walk holds frame-003\.png of another.*; delete the old"):
        animate(folder, picture(), motion(), size=32, frames_per_second=2)
    assert sorted(folder.iterdir()) == sorted(files)


def test_a_picture_of_other_proportions_is_refused() -> None:
    with pytest.raises(InputError, match="take the picture that the cage was traced from"):
        motion_files("walk.glb", picture()[:60], motion())


def test_a_missing_ffmpeg_is_told_before_anything_is_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(encode.importlib.util, "find_spec", lambda _: None)
    with pytest.raises(InputError, match=r"pip install 'glid-nb\[video\]'"):
        motion_files("walk.mp4", picture(), motion())
    assert ".mp4" in MOTION_FORMATS
