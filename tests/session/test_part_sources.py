"""Folders and Photoshop files open as parts, the rearmost first."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from glid_nb.imaging import TraceError
from glid_nb.session.editor_model import EditorModel
from glid_nb.session.part_sources import named_parts, parts_in

from .test_parts import BLUE, RED


def test_a_folder_of_pictures_is_parts_in_the_order_of_their_names(tmp_path: Path) -> None:
    for name, pixels in {"2 blue": BLUE, "1 red": RED, "3 empty": 0 * RED}.items():
        Image.fromarray(pixels).save(tmp_path / f"{name}.png")
    (tmp_path / "notes.txt").write_text("no picture")
    parts: Any = parts_in(tmp_path)
    assert list(parts) == ["1 red", "2 blue"]
    assert (parts["1 red"] == RED).all()
    model = EditorModel(parts=parts)
    try:
        assert [shape.name for shape in model.shapes] == ["1 red", "2 blue"]
    finally:
        model.close()


def test_a_background_is_a_part_as_a_whole() -> None:
    rng = np.random.default_rng(1)
    noise = rng.integers(0, 256, RED.shape, dtype=np.uint8)
    noise[..., 3] = 255
    model = EditorModel(parts={"background": noise, "red": RED})
    try:
        low, _, high, _ = model.shapes[0].state.domain.cage.bounds
        assert (low, high) == (-10, 10)
    finally:
        model.close()


def test_other_pictures_are_no_parts(tmp_path: Path) -> None:
    Image.fromarray(RED).save(tmp_path / "red.png")
    assert parts_in(tmp_path / "red.png") is None
    assert parts_in(RED) is None
    assert parts_in(None) is None


def test_a_folder_without_a_shape_is_refused(tmp_path: Path) -> None:
    with pytest.raises(TraceError, match="holds no PNG with a shape"):
        parts_in(tmp_path)


def test_parts_without_names_get_numbers_and_files_their_names(tmp_path: Path) -> None:
    Image.fromarray(RED).save(tmp_path / "red.png")
    again = tmp_path / "again"
    again.mkdir()
    Image.fromarray(RED).save(again / "red.png")
    assert list(named_parts([tmp_path / "red.png", BLUE, again / "red.png"])) == [
        "red",
        "Part 2",
        "red 2",
    ]
    with pytest.raises(TraceError, match="there are 0 parts"):
        named_parts([])


def test_a_photoshop_file_is_its_visible_layers(tmp_path: Path) -> None:
    psd_tools = pytest.importorskip("psd_tools")
    document: Any = psd_tools.PSDImage.new("RGB", (RED.shape[1], RED.shape[0]))

    def layer(name: str, pixels: np.ndarray, left: int, right: int) -> Any:
        cropped = Image.fromarray(pixels[:, left:right])
        return document.create_pixel_layer(cropped, name=name, top=0, left=left)

    layer("red", RED, 5, 70)
    document.create_group([layer("blue", BLUE, 60, 120)], name="group")
    layer("hidden", RED, 5, 70).visible = False
    layer("empty", 0 * RED, 5, 70)
    document.save(tmp_path / "two.psd")
    parts: Any = parts_in(tmp_path / "two.psd")
    assert list(parts) == ["red", "blue"]
    for pixels, wanted in zip(parts.values(), (RED, BLUE), strict=True):
        assert np.array_equal(pixels[..., 3], wanted[..., 3])
        assert np.array_equal(pixels * (pixels[..., 3:] > 0), wanted)


def test_a_damaged_photoshop_file_is_named(tmp_path: Path) -> None:
    pytest.importorskip("psd_tools")
    (tmp_path / "bad.psd").write_bytes(b"8BPS" + bytes(40))
    with pytest.raises(TraceError, match=r"bad\.psd is damaged"):
        parts_in(tmp_path / "bad.psd")


def test_without_its_package_a_photoshop_file_names_the_extra(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "psd_tools", None)
    with pytest.raises(TraceError, match=r"pip install 'glid-nb\[psd\]'"):
        parts_in(tmp_path / "a.psd")
