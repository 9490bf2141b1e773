"""Folders and Photoshop files open as parts, the rearmost first."""

from __future__ import annotations

import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from glid_nb.imaging import TraceError
from glid_nb.imaging.photoshop import LayerWarning
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


def test_long_names_of_layers_and_pictures_are_cut(tmp_path: Path) -> None:
    psd_tools = pytest.importorskip("psd_tools")
    document: Any = psd_tools.PSDImage.new("RGB", (RED.shape[1], RED.shape[0]))
    for pixels in (RED, BLUE):
        _layer(document, "x" * 230, pixels)
    document.save(tmp_path / "long.psd")
    Image.fromarray(RED).save(tmp_path / f"{'y' * 230}.png")
    for parts in (parts_in(tmp_path / "long.psd"), named_parts([*tmp_path.glob("y*.png"), BLUE])):
        assert parts is not None
        model = EditorModel(parts=parts)
        try:
            names = [shape.name for shape in model.shapes]
            assert names == list(parts)
            assert max(map(len, names)) == 200
        finally:
            model.close()


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


def _layer(document: Any, name: str, pixels: np.ndarray) -> Any:
    return document.create_pixel_layer(Image.fromarray(pixels), name=name, top=0, left=0)


def _assert_drawn(pixels: np.ndarray, wanted: np.ndarray) -> None:
    """To one step of 255: early versions of psd-tools round down."""
    seen = pixels[..., 3:] > 0
    np.testing.assert_allclose(pixels[..., 3], wanted[..., 3], atol=1)
    np.testing.assert_allclose((pixels * seen)[..., :3], (wanted * seen)[..., :3], atol=1)


def test_masks_and_opacity_of_groups_and_clipped_layers_are_drawn(tmp_path: Path) -> None:
    psd_tools = pytest.importorskip("psd_tools")
    path, (height, width) = tmp_path / "drawn.psd", RED.shape[:2]
    document: Any = psd_tools.PSDImage.new("RGB", (width, height))
    _layer(document, "base", RED)
    clipped = _layer(document, "clipped", np.full_like(RED, (0, 200, 0, 255)))
    clipped.clipping = True
    clipped.opacity = 51
    inner = document.create_group([_layer(document, "grouped", BLUE)], name="inner")
    document.create_group([inner], name="outer").opacity = 128
    document.save(path)
    # psd-tools writes a new group's mask only if the group was read from a file.
    document = psd_tools.PSDImage.open(path)
    left = np.zeros((height, width), np.uint8)
    left[:, :90] = 255
    document[-1][0].create_mask(Image.fromarray(left), top=0, left=0)
    document.save(path)

    parts: Any = parts_in(path)
    assert list(parts) == ["base", "grouped"]
    tinted = RED.astype(float)
    tinted[..., :3] = 0.8 * tinted[..., :3] + 0.2 * np.array([0, 200, 0])
    tinted[RED[..., 3] == 0] = 0
    _assert_drawn(parts["base"], tinted)
    half = BLUE.astype(float)
    half[..., 3] *= (left / 255) * (128 / 255)
    _assert_drawn(parts["grouped"], half)


def test_a_clipped_layer_without_a_layer_below_is_drawn_as_it_is(tmp_path: Path) -> None:
    psd_tools = pytest.importorskip("psd_tools")
    path, document = tmp_path / "a.psd", psd_tools.PSDImage.new("RGB", (RED.shape[1], RED.shape[0]))
    for name, pixels in {"bottom": RED, "faint": BLUE}.items():
        layer = _layer(document, name, pixels)
        layer.clipping = True
    layer.opacity = 51
    document.create_group([_layer(document, "inner", BLUE)], name="group")[0].clipping = True
    document.save(path)
    with warnings.catch_warnings():
        warnings.simplefilter("error", LayerWarning)
        parts: Any = parts_in(path)
    assert list(parts) == ["bottom", "faint", "inner"]
    faint = BLUE.astype(float)
    faint[..., 3] *= 51 / 255
    for pixels, wanted in zip(parts.values(), (RED, faint, BLUE), strict=True):
        _assert_drawn(pixels, wanted)


def test_a_warning_names_the_layer_and_what_is_not_drawn(tmp_path: Path) -> None:
    psd_tools = pytest.importorskip("psd_tools")
    from psd_tools.constants import BlendMode, Tag
    from psd_tools.psd.descriptor import Bool, Descriptor, DescriptorBlock2
    from psd_tools.psd.tagged_blocks import TaggedBlock

    document: Any = psd_tools.PSDImage.new("RGB", RED.shape[1::-1])
    shadowed, blended = _layer(document, "red", RED), _layer(document, "blue", BLUE)
    effects: Any = DescriptorBlock2(version=0, name="", classID=b"null", data_version=16)
    effects[b"masterFXSwitch"] = Bool(True)
    effects[b"DrSh"] = shadow = Descriptor(name="", classID=b"DrSh")
    shadow[b"enab"] = shadow[b"present"] = Bool(True)
    tag = Tag.OBJECT_BASED_EFFECTS_LAYER_INFO
    shadowed.tagged_blocks[tag] = TaggedBlock(key=tag, data=effects)
    blended.blend_mode = BlendMode.MULTIPLY
    document.save(tmp_path / "two.psd")
    with pytest.warns(LayerWarning) as told:
        parts: Any = parts_in(tmp_path / "two.psd")
    assert [str(one.message) for one in told] == [
        "two.psd is drawn without the drop shadow of the layer 'red'; "
        "the blend mode multiply of the layer 'blue'"
    ]
    _assert_drawn(parts["red"], RED)
    _assert_drawn(parts["blue"], BLUE)


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
