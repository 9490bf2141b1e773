"""Exports of several shapes: drawn in their order, or one file for each of them."""

from __future__ import annotations

import io
import json
import re
import zipfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import glid_nb as glid
from glid_nb.cli import main
from glid_nb.imaging.backdrop import WHITE
from glid_nb.session.document import Document
from glid_nb.session.document_file import save_document
from glid_nb.session.editor_model import EditorModel
from glid_nb.session.posed_shapes import shapes_of
from glid_nb.widgets import exporting

RED, BLUE = (220, 30, 30), (30, 30, 220)


def disk(x: float, radius: float, color: tuple[int, int, int]) -> np.ndarray:
    rows, columns = np.mgrid[:90, :120]
    pixels = np.zeros((90, 120, 4), np.uint8)
    pixels[np.hypot(columns - x, rows - 45) < radius] = (*color, 255)
    return pixels


@pytest.fixture(scope="module")
def model() -> Iterator[EditorModel]:
    """A red disk, which comes from the left to the middle of a blue one in front of it."""
    made = EditorModel(parts={"red": disk(30, 22, RED), "blue": disk(85, 25, BLUE)})
    deformation = made.deformation
    x, y = deformation.state.domain.cage.exterior.mean(axis=0)
    pin = deformation.add_handle((x, y))
    deformation.save_pose()
    deformation.drag(pin, to=(x + 6, y))
    deformation.solve()
    yield made
    made.close()


def opened(data: bytes) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(data)).convert("RGBA"))


def picture(model: EditorModel, path: Path, view: str = "source") -> np.ndarray:
    return opened(exporting.exported(model, path, None, view)["a.png"])  # type: ignore[arg-type]


def test_a_picture_is_the_parts_warped_and_laid_over_each_other(
    model: EditorModel, tmp_path: Path
) -> None:
    drawn = picture(model, tmp_path / "a.png")
    whole = Image.new("RGBA", (120, 90))
    for shape in model.shapes:
        layer = glid.render(shape.layers.image, shape.state.map)
        whole.alpha_composite(Image.fromarray(layer))
    assert np.array_equal(drawn, np.asarray(whole))
    assert tuple(drawn[45, 85]) == (*BLUE, 255)


def test_order_and_visibility_decide_what_is_seen(model: EditorModel, tmp_path: Path) -> None:
    deformation = model.deformation
    try:
        deformation.move_part(0, 1)
        middle = picture(model, tmp_path / "a.png")[45, 75]
        assert tuple(middle) == (*RED, 255)  # the red disk was dragged here
        deformation.show_part(1, False)
        hidden = picture(model, tmp_path / "a.png")
        assert not (hidden[..., 0] > 100).any()
    finally:
        for _ in range(2):
            deformation.undo()


def test_the_whole_view_holds_all_parts(model: EditorModel, tmp_path: Path) -> None:
    drawn = picture(model, tmp_path / "a.png", "fit")
    for channel in (0, 2):
        columns = (drawn[..., channel] > 150).any(axis=0).nonzero()[0]
        assert columns[0] > 0
        assert columns[-1] < drawn.shape[1] - 1


def test_frames_show_all_parts_as_they_are_at_their_time(
    model: EditorModel, tmp_path: Path
) -> None:
    (path,) = exporting.export(model, tmp_path / "a.zip", (240, 240))
    with zipfile.ZipFile(path) as archive:
        first, *_, last = (opened(archive.read(name)) for name in sorted(archive.namelist()))
    reds, blues = (
        [((frame[..., c] > 150) & (frame[..., 3] > 128)).sum() for frame in (first, last)]
        for c in (0, 2)
    )
    assert reds[1] < 0.9 * reds[0]  # the blue disk covers a part of the red one at the end
    assert abs(blues[1] - blues[0]) < 0.01 * blues[0]


def test_a_gif_has_one_background(model: EditorModel, tmp_path: Path) -> None:
    (path,) = exporting.export(model, tmp_path / "a.gif", (120, 120))
    with Image.open(path) as gif:
        assert tuple(np.asarray(gif.convert("RGB"))[0, 0]) == WHITE
        assert gif.n_frames > 10


def test_formats_of_one_shape_have_files_for_each_part(model: EditorModel, tmp_path: Path) -> None:
    written = exporting.export(model, tmp_path / "a.proof.json")
    names = ["a-red.proof.json", "a-red.map.json", "a-blue.proof.json", "a-blue.map.json"]
    assert [path.name for path in written] == names
    assert exporting.written_names(model, tmp_path / "a.proof.json", moving=False) == tuple(names)
    maps = [glid.HarmonicMap.load(tmp_path / name) for name in names[1::2]]
    for map, shape in zip(maps, model.shapes, strict=True):
        assert np.array_equal(map.phi, shape.state.map.phi)
    moving = exporting.export(model, tmp_path / "b.motion.json")
    assert [path.name for path in moving if "proof" not in path.name] == [
        "b-red.motion.json",
        "b-blue.motion.json",
    ]
    assert exporting.written_names(model, tmp_path / "b.motion.json", moving=True) == tuple(
        path.name for path in moving
    )


def test_a_page_has_all_visible_parts(model: EditorModel, tmp_path: Path) -> None:
    """The page of the pose and the player; both are one file, with the proof of each part."""
    for moving in (False, True):
        assert exporting.written_names(model, tmp_path / "a.html", moving=moving) == ("a.html",)
    (path,) = exporting.export(model, tmp_path / "a.html")
    still = path.read_text(encoding="utf-8")
    parts = [shape.moving for shape in shapes_of(model.document)[0]]
    moving = glid.export.parts_motion_files("a.html", parts)["a.html"].decode()
    for page, at in ((still, "at any point."), (moving, "at any point, at any time.")):
        assert page.count('"source_bounds"') == 2
        assert f"Each of 2 parts is proved not to fold over or tear {at}" in page
        assert re.findall(r"<li><b>(.*?)</b> σ₂ ≥ ", page) == ["red", "blue"]
    try:
        model.deformation.show_part(0, False)
        (path,) = exporting.export(model, tmp_path / "b.html")
        assert path.read_text(encoding="utf-8").count('"source_bounds"') == 1
    finally:
        model.deformation.undo()


def test_a_session_with_parts_becomes_a_player_from_the_command_line(
    model: EditorModel, tmp_path: Path
) -> None:
    save_document(model.document, tmp_path / "two.glid")
    out = tmp_path / "a.html"
    assert main(["animate", str(tmp_path / "two.glid"), "--out", str(out)]) in (0, None)
    assert [path.name for path in tmp_path.glob("*.html")] == ["a.html"]
    assert out.read_text(encoding="utf-8").count('"source_bounds"') == 2


def test_a_gltf_file_has_a_node_for_each_part(model: EditorModel, tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    (path,) = exporting.export(model, tmp_path / "a.glb")
    assert exporting.written_names(model, path, moving=False) == ("a.glb",)
    scene = trimesh.load(path)
    assert set(scene.graph.nodes_geometry) == {"red", "blue"}
    heights = {name: scene.geometry[name].vertices[:, 2] for name in ("red", "blue")}
    assert heights["red"].max() < heights["blue"].min()
    for name, color in (("red", RED), ("blue", BLUE)):
        texture = np.asarray(scene.geometry[name].visual.material.baseColorTexture)
        assert tuple(texture[45, 30 if name == "red" else 85][:3]) == color
    x = {name: scene.geometry[name].vertices[:, 0].mean() for name in ("red", "blue")}
    assert x["red"] < x["blue"]


def test_a_session_with_parts_is_animated_from_the_command_line(
    model: EditorModel, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    document: Document = model.document
    save_document(document, tmp_path / "two.glid")
    assert main(["animate", str(tmp_path / "two.glid"), "--out", str(tmp_path / "a.gif")]) in (
        0,
        None,
    )
    said = capsys.readouterr().out
    assert re.search(r"a\.gif; .* s\. red: .*prove.* blue: .*prove", said, re.IGNORECASE), said
    with Image.open(tmp_path / "a.gif") as gif:
        frame = np.asarray(gif.convert("RGB")).astype(int)
    assert ((frame[..., 0] - frame[..., 2]) > 100).any()
    assert ((frame[..., 2] - frame[..., 0]) > 100).any()


def test_a_live_page_has_all_visible_parts(model: EditorModel, tmp_path: Path) -> None:
    (path,) = exporting.export(model, tmp_path / "two.html", live=True)
    assert path.name == "two.html"
    assert len(re.findall('<img id="source', path.read_text(encoding="utf-8"))) == 2
    assert exporting.written_names(model, tmp_path / "a.live.html", moving=False) == (
        "a.live.html",
    )
    try:
        model.deformation.show_part(0, False)
        (path,) = exporting.export(model, tmp_path / "one.live.html")
        assert len(re.findall('<img id="source', path.read_text(encoding="utf-8"))) == 1
    finally:
        model.deformation.undo()


def test_a_session_becomes_a_live_page_from_the_command_line(
    model: EditorModel, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    session, page = tmp_path / "two.glid", tmp_path / "two.html"
    save_document(model.document, session)
    assert main(["page", str(session), "--out", str(page), "--title", "Both"]) in (0, None)
    text = page.read_text(encoding="utf-8")
    assert "<title>Both</title>" in text
    assert len(re.findall('<img id="source', text)) == 2
    for flags in (["--energy", "arap"], ["--energy", "iso"], ["--max-vertices", "40"]):
        assert main(["page", str(session), "--out", str(page), *flags])
        assert "a session, with its own outlines" in capsys.readouterr().err


def test_a_moving_gltf_file_has_a_node_and_a_channel_for_each_part(
    model: EditorModel, tmp_path: Path
) -> None:
    parts = [shape.moving for shape in shapes_of(model.document)[0]]
    data = glid.export.parts_motion_files("a.glb", parts)["a.glb"]
    assert exporting.written_names(model, tmp_path / "a.glb", moving=True) == ("a.glb",)
    length = int.from_bytes(data[12:16], "little")
    tree, binary = json.loads(data[20 : 20 + length]), data[28 + length :]

    def array(index: int) -> np.ndarray:
        accessor = tree["accessors"][index]
        view = tree["bufferViews"][accessor["bufferView"]]
        rows = np.frombuffer(binary, "<f4", view["byteLength"] // 4, view.get("byteOffset", 0))
        return rows.reshape(accessor["count"], -1)

    (animation,) = tree["animations"]
    moved = {}
    for channel in animation["channels"]:
        node = tree["nodes"][channel["target"]["node"]]
        sampler = animation["samplers"][channel["sampler"]]
        (primitive,) = tree["meshes"][node["mesh"]]["primitives"]
        targets = np.array([array(one["POSITION"]) for one in primitive["targets"]])
        weights = array(sampler["output"]).reshape(len(array(sampler["input"])), -1)
        start = array(primitive["attributes"]["POSITION"])
        moved[node["name"]] = np.einsum("t,tvx->vx", weights[-1], targets).mean(axis=0)
        assert weights.shape[1] == len(targets)
        assert targets.shape[1:] == start.shape
    assert set(moved) == {"red", "blue"}
    assert moved["red"][0] == pytest.approx(6, abs=0.2)  # the red disk was dragged so far
    assert np.abs(moved["blue"]).max() < 0.01


def test_an_obj_file_has_an_object_and_a_texture_for_each_part(
    model: EditorModel, tmp_path: Path
) -> None:
    trimesh = pytest.importorskip("trimesh")
    written = exporting.export(model, tmp_path / "a.obj")
    names = ("a.obj", "a.mtl", "a-red-texture.png", "a-blue-texture.png")
    assert tuple(path.name for path in written) == names
    assert exporting.written_names(model, tmp_path / "a.obj", moving=False) == names
    lines = (tmp_path / "a.obj").read_text(encoding="utf-8").splitlines()
    assert [line for line in lines if line.startswith("o ")] == ["o red", "o blue"]
    loaded = trimesh.load(tmp_path / "a.obj").geometry  # by the materials' names
    meshes = {name: loaded[f"a-{name}"] for name in ("red", "blue")}
    heights = {name: mesh.vertices[:, 2] for name, mesh in meshes.items()}
    assert heights["red"].max() < heights["blue"].min()
    for name, shape in zip(("red", "blue"), model.shapes, strict=True):
        own = shape.state.map(shape.state.domain.cage.exterior)[:, 0]
        low, high = meshes[name].vertices[:, 0].min(), meshes[name].vertices[:, 0].max()
        assert (low, high) == pytest.approx((own.min(), own.max()), abs=0.05)
        texture = np.asarray(meshes[name].visual.material.image.convert("RGB"))
        assert tuple(texture[45, 30 if name == "red" else 85]) == (RED if name == "red" else BLUE)


def test_names_of_parts_give_files_of_their_own() -> None:
    names = glid.export.formats.obj_names("a.obj", ["left arm", "left_arm", "x/y"])
    assert names[2:] == ("a-left_arm-texture.png", "a-left_arm-2-texture.png", "a-x_y-texture.png")


def test_parts_that_no_file_system_tells_apart_have_files_of_their_own() -> None:
    """`arm?` and `arm*` have the same plain name, and so have `Arm` and `arm` on many systems."""
    names = glid.export.formats.part_names("a.svg", ".svg", ["arm?", "arm*", "Arm", "arm", "?"])
    assert len({name.casefold() for name in names}) == 5
    assert names[2] == "a-Arm.svg"
    assert all(name.startswith("a-") and name.endswith(".svg") for name in names)
    composed, apart = glid.export.formats.part_names("a.svg", ".svg", ["\u00e9", "e\u0301"])
    assert (composed, apart) == ("a-\u00e9.svg", "a-e\u0301-2.svg")
