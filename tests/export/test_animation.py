"""Animations, read back frame by frame."""

from __future__ import annotations

import io
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from PIL import Image, ImageSequence

from glid_nb.export import animation_bytes
from glid_nb.harmonic import HarmonicMap
from glid_nb.pose import Pose

from ..support.shapes import bent, domain, picture, pose


def drag(count: int = 4) -> tuple[list[HarmonicMap], list[Pose]]:
    start, end = HarmonicMap.identity(domain()), bent()
    maps = [
        HarmonicMap(domain(), start.phi + t * (end.phi - start.phi), start.psi)
        for t in np.linspace(0, 1, count)
    ]
    handles = pose().handles
    return maps, [Pose(handles, m(handles)) for m in maps]


def frames(data: bytes) -> tuple[Image.Image, list[np.ndarray]]:
    read = Image.open(io.BytesIO(data))
    return read, [np.asarray(f.convert("RGB")).astype(int) for f in ImageSequence.Iterator(read)]


@pytest.mark.slow
@pytest.mark.parametrize(("format", "name"), [("gif", "GIF"), ("apng", "PNG")])
def test_every_map_is_a_frame(format: Any, name: str) -> None:
    maps, poses = drag()
    data = animation_bytes(
        picture(), maps, poses, size=120, format=format, frames_per_second=10, background=(0, 0, 0)
    )
    read, shown = frames(data)
    assert read.format == name
    assert read.info["duration"] == 100
    assert read.info["loop"] == 0
    assert len(shown) == 4
    assert max(shown[0].shape) in (120, 121)
    assert all((f[0, 0] < 8).all() for f in shown)
    changes = [np.abs(a - b).mean() for a, b in pairwise(shown)]
    assert min(changes) > 1
    assert np.abs(shown[0] - shown[-1]).mean() > max(changes)


@pytest.mark.slow
def test_all_frames_show_the_same_part_of_the_plane() -> None:
    """A map that does not change gives equal frames, even if other maps widen the view."""
    maps, _ = drag(2)
    _, shown = frames(animation_bytes(picture(), [maps[0], maps[1], maps[0]], format="apng"))
    np.testing.assert_array_equal(shown[0], shown[2])


@pytest.mark.slow
@pytest.mark.parametrize("color", [(255, 255, 255), (250, 240, 9), (0, 0, 0)])
def test_a_gif_keeps_the_background_as_it_is(color: tuple[int, int, int]) -> None:
    data = animation_bytes(picture(), drag(2)[0], size=120, background=color)
    for shown in frames(data)[1]:
        corner = shown[:8, :8].reshape(-1, 3)
        np.testing.assert_array_equal(corner, np.broadcast_to(color, corner.shape))
        assert (shown.std(axis=(0, 1)) > 10).all()  # the shape is in this frame, too


@pytest.mark.slow
def test_there_and_back_has_no_jump() -> None:
    maps, _ = drag(4)
    data = animation_bytes(picture(), maps, size=60, there_and_back=True, format="apng")
    _, shown = frames(data)
    assert len(shown) == 6
    np.testing.assert_array_equal(shown[1], shown[5])
    np.testing.assert_array_equal(shown[2], shown[4])


@pytest.mark.slow
def test_an_apng_may_be_transparent() -> None:
    maps, poses = drag(2)
    data = animation_bytes(picture(), maps, poses, size=60, background=None, format="apng")
    alpha = np.asarray(Image.open(io.BytesIO(data)).convert("RGBA"))[..., 3]
    assert (alpha.min(), alpha.max()) == (0, 255)


@pytest.mark.slow
def test_the_marks_are_drawn() -> None:
    maps, (there,) = drag(1)
    poses = [there.with_targets(there.targets + np.array([0.0, 1.5]))]
    _, (plain,) = frames(animation_bytes(picture(), maps, size=300, format="apng"))
    _, (marked,) = frames(animation_bytes(picture(), maps, poses, size=300, format="apng"))
    cyan = np.abs(marked - [0, 213, 224]).max(axis=2) < 30
    assert (cyan & (np.abs(plain - [0, 213, 224]).max(axis=2) > 60)).sum() > 40
    dark = marked.max(axis=2) < 70
    assert (dark & (plain.max(axis=2) > 90)).sum() > 10


@pytest.mark.parametrize(
    ("changes", "culprit"),
    [
        ({"maps": []}, "maps is empty"),
        ({"poses": []}, "4 maps but 0 poses"),
        ({"poses": [1, 2, 3, 4]}, "each of poses must be Pose, not int"),
        ({"maps": [1, 2]}, "each of maps must be HarmonicMap, not int"),
        ({"maps": drag()[0][0]}, r"maps must be Sequence, not HarmonicMap; .* motion\.resample"),
        ({"background": None}, "GIF has no transparency"),
        ({"size": 3}, "size"),
        ({"frames_per_second": 0}, "frames_per_second"),
        ({"frames_per_second": float("nan")}, "frames_per_second"),
        ({"background": (0, 0, 256)}, "background"),
        ({"format": "mp4"}, "format is 'mp4'"),
        ({"frames_per_second": 60}, "at most 50"),
    ],
)
def test_wrong_arguments_are_named(changes: dict[str, Any], culprit: str) -> None:
    arguments = {"maps": drag()[0], **changes}
    with pytest.raises(ValueError, match=culprit):
        animation_bytes(picture(), **arguments)
