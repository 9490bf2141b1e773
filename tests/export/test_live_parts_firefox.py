"""The live page of several shapes in Firefox, on a phone, by touch."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import glid_check
from glid_nb import HarmonicMap
from glid_nb.session.editor_model import EditorModel
from glid_nb.widgets import exporting

from ..support.browser import ARTEFACTS
from ..support.firefox import Firefox, launched_firefox
from ..support.two_disks import two_disks
from .test_live_page_firefox import READY, SETTLED, WATCH, click_named, downloaded, on_screen

pytestmark = [pytest.mark.browser, pytest.mark.slow]

PINS = "window.glidPage.editing.pins"


@pytest.fixture(scope="module")
def firefox() -> Iterator[Firefox]:
    with launched_firefox() as one:
        yield one


@pytest.fixture(scope="module")
def model() -> Iterator[EditorModel]:
    with two_disks() as made:
        yield made


def touch(firefox: Firefox, *points: tuple[float, float]) -> None:
    """Tap a point of the world, or drag from the first one to the last."""
    firefox.drag([on_screen(firefox, point) for point in points], "touch")
    firefox.wait_for(SETTLED)


def targets(firefox: Firefox) -> np.ndarray:
    return np.array(firefox.value(f"{PINS}.map((pin) => pin.target)"))


def test_both_parts_are_pinned_dragged_undone_played_and_proved_by_touch(
    model: EditorModel, firefox: Firefox, tmp_path: Path
) -> None:
    (path,) = exporting.export(model, tmp_path / "two.html", live=True)
    firefox.open(path.as_uri(), 390, 844, downloads=tmp_path)
    firefox.wait_for(READY)
    firefox.value(WATCH)
    assert firefox.value("document.documentElement.scrollWidth") == 390
    touch(firefox, (3.0, 1.0))  # on the blue disk, which has no pin yet
    touch(firefox, (3.0, -2.0))
    assert firefox.value(f"{PINS}.map((pin) => pin.handle[2])") == [0, 0, 1, 1]
    before = targets(firefox)
    way = np.linspace([3.0, -2.0], [4.0, -3.0], 9)
    touch(firefox, *(tuple(point) for point in way))
    pulled = before[1] + [-0.8, -0.4]  # the red disk's
    touch(firefox, *(tuple(point) for point in np.linspace(before[1], pulled, 9)))
    wanted = before.copy()
    wanted[1], wanted[3] = pulled, [4.0, -3.0]
    np.testing.assert_allclose(targets(firefox), wanted, atol=0.1)
    firefox.screenshot(ARTEFACTS / "firefox-parts-390.png")

    click_named(firefox, "Download the maps and their proofs")
    files = [tmp_path / f"two-{part}.{kind}.json" for part in ("red", "blue") for kind in _KINDS]
    assert downloaded(firefox, files)
    for part, (map_file, proof_file) in enumerate(zip(files[::2], files[1::2], strict=True)):
        assert glid_check.main([str(map_file), str(proof_file)]) == 0
        map = HarmonicMap.from_dict(json.loads(map_file.read_text(encoding="utf-8")))
        own = firefox.value(f"{PINS}.filter((pin) => pin.handle[2] === {part})")
        handles = np.array([pin["handle"][:2] for pin in own])
        np.testing.assert_allclose(map(handles), [pin["target"] for pin in own], atol=0.1)

    click_named(firefox, "Undo (Ctrl+Z)")
    firefox.wait_for(SETTLED)
    np.testing.assert_allclose(targets(firefox)[1], before[1], atol=0.1)
    click_named(firefox, "Undo (Ctrl+Z)")
    firefox.wait_for(SETTLED)
    np.testing.assert_allclose(targets(firefox), before, atol=0.1)

    click_named(firefox, "Play")
    firefox.wait_for("document.querySelector('.track input').value > 0.5")
    click_named(firefox, "Pause")
    bounds = firefox.value("window.bounds")
    assert len(bounds) > 3
    assert min(float(text.split("σ₂ ≥ ")[1].split()[0].rstrip(",")) for text in bounds) > 0
    assert firefox.errors == []
    outside = ("file:", "data:", "blob:")
    assert [url for url in firefox.requests if not url.startswith(outside)] == []


_KINDS = "map", "proof"


def test_a_page_that_plays_several_parts_is_drawn_in_firefox_too(
    model: EditorModel, firefox: Firefox, tmp_path: Path
) -> None:
    """The red disk and the blue one are seen at their places, and no error is told."""
    (path,) = exporting.export(model, tmp_path / "pose.html")
    firefox.open(path.as_uri(), 390, 844)
    firefox.wait_for(READY)
    count = """(() => {
      const canvas = document.querySelector("main canvas");
      const small = new OffscreenCanvas(canvas.width, canvas.height);
      const pen = small.getContext("2d");
      pen.drawImage(canvas, 0, 0);
      const { data } = pen.getImageData(0, 0, canvas.width, canvas.height);
      let [red, blue] = [0, 0];
      for (let i = 0; i < data.length; i += 4) {
        if (data[i] > data[i + 2] + 60) red += 1;
        if (data[i + 2] > data[i] + 60) blue += 1;
      }
      return [red, blue];
    })()"""
    red, blue = firefox.value(count)
    assert red > 0.5 * blue > 1000  # the blue disk covers a part of the red one
    assert blue > red
    assert "Each of 2 parts is proved" in firefox.value("document.body.innerText")
    firefox.screenshot(ARTEFACTS / "firefox-parts-pose-390.png")
    assert firefox.errors == []
