"""Saving, opening and exporting by the section Files and from code, without a browser."""

from __future__ import annotations

import io
import os
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import ipywidgets
import numpy as np
import pytest
from PIL import Image

import glid_nb as glid
from glid_nb.export import FORMATS, ExportError
from glid_nb.export.formats import MOTION_FORMATS, file_names
from glid_nb.imaging import PixelFrame
from glid_nb.session.animation import Animation
from glid_nb.session.editor_model import EditorModel
from glid_nb.widgets.exporting import OccupiedError, export, files_of
from glid_nb.widgets.file_panel import FilePanel

from ..support import from_page

pytestmark = pytest.mark.slow  # most of the time is compiling

THEIRS = b"somebody else's"


def bar() -> np.ndarray:
    """An opaque bar of 16 x 6 units, 200 x 100 pixels."""
    picture = np.zeros((100, 200, 4), np.uint8)
    picture[20:80, 20:180] = (200, 120, 40, 255)
    return picture


@pytest.fixture
def model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[EditorModel]:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GLID_NB_DATA", str(tmp_path.with_name(f"{tmp_path.name}-data")))
    model = EditorModel(bar())
    yield model
    model.close()


@pytest.fixture
def panel(model: EditorModel, monkeypatch: pytest.MonkeyPatch) -> FilePanel:
    monkeypatch.setattr("glid_nb.widgets.file_panel.DOUBLE_CLICK", 0.0)
    return FilePanel(model)


def test_a_sample_names_its_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GLID_NB_DATA", str(tmp_path))
    for image, name in ((glid.samples.image("bar"), "bar"), (bar(), "glid")):
        model = EditorModel(image)
        panel = FilePanel(model)
        assert panel.path.value == panel.path.tooltip == f"{name}.glid"
        panel.close()
        model.close()


def bytes_here() -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in Path().iterdir()}


@pytest.mark.parametrize("suffixes", [list(FORMATS), list(FORMATS)[::-1]])
def test_no_export_touches_the_files_of_another(model: EditorModel, suffixes: list[str]) -> None:
    seen: dict[str, bytes] = {}
    for suffix in suffixes:
        written = export(model, f"e{suffix}")
        assert written == files_of(Path(f"e{suffix}"))
        now = bytes_here()
        assert {name: now[name] for name in seen} == seen
        assert set(now) - set(seen) == {path.name for path in written}
        seen = now
    assert b"mtllib e.mtl" in seen["e.obj"]
    assert b"map_Kd e-texture.png" in seen["e.mtl"]
    assert b"read_image('e-source.png')" in seen["e.py"]
    with Image.open("e-source.png") as source:
        np.testing.assert_array_equal(np.asarray(source), bar())


def test_what_comes_with_an_export_replaces_only_its_own(model: EditorModel) -> None:
    for suffix, name in ((".obj", "e-texture.png"), (".obj", "e.mtl"), (".py", "e-source.png")):
        Path(name).write_bytes(THEIRS)
        with pytest.raises(OccupiedError, match=f"already there: .*{name}"):
            export(model, f"e{suffix}")
        assert bytes_here() == {name: THEIRS}  # nothing was written
        Path(name).unlink()
    export(model, "e.obj")
    Path("e.obj").unlink()
    export(model, "e.obj")  # written by this editor
    export(model, "own.py")
    Path("e-source.png").write_bytes(Path("own-source.png").read_bytes())
    other = EditorModel(bar()[:, ::-1].copy())
    export(other, "e.obj")  # the other files of an OBJ were written with it
    export(model, "e.py")  # the same picture
    other.close()


def test_other_names_are_refused(model: EditorModel) -> None:
    for name in ("e.xyz", "e", ""):
        with pytest.raises(ExportError, match=r"must end in \.png"):
            export(model, name)


def click(panel: FilePanel, button: ipywidgets.Button) -> str:
    button.click()
    return panel.message.value


def test_a_name_without_suffix_gets_it(panel: FilePanel) -> None:
    panel.path.value = " bent "
    assert f"Saved {Path('bent.glid').absolute()}" in click(panel, panel.save_button)
    assert panel.path.value == "bent.glid"
    panel.path.value = "bent"
    assert "Opened" in click(panel, panel.open_button)
    assert FilePanel(panel.model).path.value == "bent.glid"


@pytest.mark.parametrize(
    ("name", "wanted"),
    [
        ("", "Give the session file a name"),
        (".", "Give the session file a name"),
        ("/nope/x.glid", "The folder /nope does not exist"),
        ("test.ipynb", "must end in .glid"),
    ],
)
def test_refusals_are_in_plain_words(panel: FilePanel, name: str, wanted: str) -> None:
    Path("test.ipynb").write_bytes(THEIRS)
    panel.path.value = name
    for button in (panel.save_button, panel.export_button, panel.code_button):
        said = click(panel, button)
        assert wanted in said
        assert "Errno" not in said
        assert button.description != "Replace?"
    if name != "test.ipynb":
        assert wanted in click(panel, panel.open_button)
    assert bytes_here() == {"test.ipynb": THEIRS}


def test_what_cannot_be_opened_is_named(panel: FilePanel) -> None:
    path = Path("away.glid").absolute()
    panel.path.value = "away.glid"
    assert f"The file {path} does not exist" in click(panel, panel.open_button)
    path.write_bytes(THEIRS)
    assert "it is not a saved session" in click(panel, panel.open_button)


def test_a_file_of_others_is_replaced_by_a_second_click(panel: FilePanel) -> None:
    path = Path("theirs.glid")
    path.write_bytes(THEIRS)
    panel.path.value = "theirs.glid"
    assert "theirs.glid is in" in click(panel, panel.save_button)
    assert panel.save_button.description == "Replace?"
    assert path.read_bytes() == THEIRS
    assert "Saved" in click(panel, panel.save_button)
    assert panel.save_button.description == "Save"
    glid.io.load_document(path)
    assert "Saved" in click(panel, panel.save_button)  # now this editor has written it


def test_the_question_is_forgotten_when_something_else_is_done(panel: FilePanel) -> None:
    for name in ("a.glid", "b.glid"):
        Path(name).write_bytes(THEIRS)
    panel.path.value = "a.glid"
    click(panel, panel.save_button)
    panel.path.value = "b.glid"
    assert panel.save_button.description == "Save"
    assert "Saved" not in click(panel, panel.save_button)
    click(panel, panel.open_button)
    assert "Saved" not in click(panel, panel.save_button)
    assert set(bytes_here().values()) == {THEIRS}


def test_a_double_click_is_no_answer(model: EditorModel) -> None:
    panel = FilePanel(model)
    Path("glid.glid").write_bytes(THEIRS)
    for _ in range(3):
        click(panel, panel.save_button)
    assert panel.save_button.description == "Replace?"
    assert Path("glid.glid").read_bytes() == THEIRS


def test_opening_asks_before_it_discards(panel: FilePanel, tmp_path: Path) -> None:
    panel.path.value = str(tmp_path / "other.glid")
    panel.model.save(panel.path.value)
    assert "Opened" in click(panel, panel.open_button)
    panel.model.deformation.paused = True
    panel.model.deformation.add_handle(
        panel.model.deformation.state.domain.cage.exterior.mean(axis=0)
    )
    count, there = len(panel.model.deformation.pose), panel.path.value
    Path("wrong.glid").write_bytes(THEIRS)
    for wrong, said in (("none.glid", "does not exist"), ("wrong.glid", "is not a saved session")):
        panel.path.value = wrong
        assert said in click(panel, panel.open_button)
        assert panel.open_button.description == "Open"
    panel.path.value = there
    assert "not saved in a file yet" in click(panel, panel.open_button)
    assert panel.open_button.description == "Discard?"
    assert len(panel.model.deformation.pose) == count
    assert "Opened" in click(panel, panel.open_button)
    assert len(panel.model.deformation.pose) == count - 1


def test_an_export_asks_too(panel: FilePanel) -> None:
    for name in ("glid.obj", "glid.mtl", "glid.png"):
        Path(name).write_bytes(THEIRS)
    panel.format.value = ".obj"
    assert "glid.obj and glid.mtl are in" in click(panel, panel.export_button)
    assert Path("glid.obj").read_bytes() == THEIRS
    wrote = "Wrote glid.obj, glid.mtl and glid-texture.png"
    assert wrote in click(panel, panel.export_button)
    assert wrote in click(panel, panel.export_button)
    panel.format.value = ".png"
    assert "glid.png is in" in click(panel, panel.export_button)
    assert Path("glid.png").read_bytes() == THEIRS


def test_a_picture_has_the_size_and_the_view_that_are_chosen(panel: FilePanel) -> None:
    model = panel.model
    model.deformation.paused = True
    assert (panel.view.value, panel.size) == ("fit", (200, 100))

    def exported() -> Any:
        click(panel, panel.export_button)
        return np.asarray(Image.open("glid.png"))

    map = model.deformation.map
    np.testing.assert_array_equal(exported(), glid.render(bar(), map, view="fit"))
    panel.width.value = 90
    panel.view.value = "source"
    np.testing.assert_array_equal(exported(), glid.render(bar(), map, (90, 45)))
    assert "× 45 px" in panel.height.value
    panel.width.value = 10**6
    assert panel.size == (8000, 4000)
    assert panel.picture.layout.display == "flex"
    panel.format.value = ".svg"
    assert panel.picture.layout.display == "none"


def test_it_says_where_changes_are_saved_by_themselves(model: EditorModel, tmp_path: Path) -> None:
    assert "kept for the next editor of this picture" in FilePanel(model).autosave.value
    path = tmp_path / "kept.glid"
    kept = EditorModel(bar(), path=path)
    panel = FilePanel(kept)
    assert panel.path.value == str(path)
    assert f"Saved automatically to {path}" in panel.autosave.value
    kept.autosave()
    kept.close()  # which saves
    assert path.exists()
    assert "Saved" in click(panel, panel.save_button)  # the panel's own file


def test_the_copied_lines_run(panel: FilePanel, sent: list[Any]) -> None:
    panel.path.value = "bent.glid"
    sent.clear()
    said = click(panel, panel.code_button)
    assert "They read bent-source.png" in said
    (copy,) = [data["content"] for data, _ in sent if data.get("method") == "custom"]
    assert copy["text"] == panel.code.value
    scope: dict[str, Any] = {}
    exec(copy["text"], scope)
    assert scope["result"].certificate.certified

    # The page's answers.
    from_page.send(panel.clipboard, {"number": copy["number"], "copied": False})
    assert "did not allow copying" in panel.message.value
    from_page.send(panel.clipboard, {"number": copy["number"], "copied": True})
    assert "in the clipboard" in panel.message.value
    from_page.send(panel.clipboard, {"number": copy["number"], "copied": False})
    assert "in the clipboard" in panel.message.value  # another view of the widget


def test_a_picture_of_others_is_not_replaced_by_copying(panel: FilePanel) -> None:
    path = Path("glid-source.png")
    path.write_bytes(THEIRS)
    assert "glid-source.png is in" in click(panel, panel.code_button)
    assert path.read_bytes() == THEIRS
    assert panel.code_button.description == "Replace?"
    click(panel, panel.code_button)
    assert path.read_bytes() != THEIRS
    assert panel.code_button.description == "Copy as Python"


def test_lines_that_need_no_picture_write_none(panel: FilePanel) -> None:
    cage = panel.model.tracing.cage
    assert cage is not None
    x, y = PixelFrame(200, 100).to_pixel(cage.exterior[0])
    panel.model.tracing.move_vertex(0, 0, (x + np.sign(x - 100), y + np.sign(y - 50)))
    panel.model.apply_tracing()
    click(panel, panel.code_button)
    assert "read_image" not in panel.code.value
    assert bytes_here() == {}


@pytest.mark.parametrize("suffix", FORMATS)
def test_every_export_can_be_had_through_the_browser(
    panel: FilePanel, sent: list[Any], suffix: str
) -> None:
    panel.path.value, panel.format.value = "bent", suffix
    before = bytes_here()
    assert "Sent bent" in click(panel, panel.download_button)
    assert bytes_here() == before  # nothing is written
    files = files_of(Path(f"bent{suffix}"))
    content = next(m["content"] for m, _ in sent if m.get("method") == "custom")
    (data,) = next(buffers for m, buffers in sent if m.get("method") == "custom")
    written = export(panel.model, f"bent{suffix}", panel.size, panel.view.value)
    if len(files) == 1:
        assert content["name"] == f"bent{suffix}"
        assert data == written[0].read_bytes()
    else:
        assert content["name"] == f"bent{suffix.removesuffix('.json')}.zip"
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            assert {n: archive.read(n) for n in archive.namelist()} == {
                path.name: path.read_bytes() for path in written
            }


def test_no_two_exports_have_the_same_name(
    model: EditorModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    animation, sent = Animation(model.deformation), list[str]()
    panel = FilePanel(model, animation)
    monkeypatch.setattr(panel.clipboard, "download", lambda name, _: sent.append(name))

    def exported(_: EditorModel, path: Path, *__: Any) -> dict[str, None]:
        written.append(path.name)
        return dict.fromkeys(file_names(path.name, FORMATS))

    def start(name: str, deliver: Any) -> str:
        written.append(name)
        return deliver(dict.fromkeys(file_names(name, MOTION_FORMATS)))

    monkeypatch.setattr("glid_nb.widgets.exporting.exported", exported)
    monkeypatch.setattr(panel.motion, "start", start)
    monkeypatch.setattr("glid_nb.widgets.file_panel.zipped", lambda _: b"")
    panel.path.value, written = "cat", list[str]()
    for _, chosen in panel.format.options:
        panel.format.value = chosen
        panel.download_button.click()
    assert len(sent) == len(written) == len(FORMATS) + len(MOTION_FORMATS)
    assert len(set(sent)) == len(sent)
    assert len(set(written)) == len(written)
    still = {"cat.obj.zip", "cat.py.zip", "cat.proof.zip", "cat.html", "cat.glb"}
    moving = {"cat.motion.html", "cat.motion.glb", "cat.frames.zip", "cat.motion.zip", "cat.gif"}
    assert still | moving < set(sent)
    animation.close()


def test_files_are_named_after_the_picture(tmp_path: Path) -> None:
    Image.fromarray(bar()).save(tmp_path / "my cat.v2.png")
    for source in (tmp_path / "my cat.v2.png", Image.open(tmp_path / "my cat.v2.png")):
        model = EditorModel(source)
        assert FilePanel(model).path.value == "my cat.v2.glid"
        model.tracing.open(bar()[:, ::-1].copy(), "dog.jpg")
        model.apply_tracing()
        assert FilePanel(model).path.value == "dog.glid"
        model.close()


def test_the_motion_is_exported_in_the_background(model: EditorModel, tmp_path: Path) -> None:
    deformation = model.deformation
    animation = Animation(deformation)
    panel = FilePanel(model, animation)
    motion = panel.motion
    assert motion is not None
    panel.show_motion()
    motion.size.value, motion.rate.value = 64, 4
    panel.export_button.click()
    assert motion.worker.wait(60)
    assert "at least 2 keyframes" in panel.message.value
    deformation.add_handle((-6, 0))
    moved = deformation.add_handle((6, 0))
    deformation.save_pose()
    deformation.drag(moved, (5.5, 2))
    assert animation.wait(60)
    panel.export_button.click()
    assert motion.worker.wait(60)
    assert "Wrote" in panel.message.value
    with Image.open(next(tmp_path.glob("*.gif"))) as picture:
        assert (picture.n_frames, max(picture.size)) == (5, 64)  # type: ignore[attr-defined]
    assert motion.progress.layout.display == "none"
    # A loop range can be exported alone; its order of parts is that of its times.
    assert motion.part.layout.display == "none"
    deformation.bring_forward([moved], 1)
    deformation.set_loop_range((0.25, 0.75))
    assert motion.part.layout.display is None
    motion.part.value = True
    panel.export_button.click()
    assert motion.worker.wait(60)
    with Image.open(next(tmp_path.glob("*.gif"))) as picture:
        assert picture.n_frames == 3  # type: ignore[attr-defined]
        assert picture.info["loop"] == 0  # for ever
    motion.part.value = False
    panel.format.value = "motion.sheet.png"
    panel.export_button.click()
    assert motion.worker.wait(60)
    assert len(list(tmp_path.glob("*.sheet.*"))) == 2
    # A stopped export writes nothing.
    panel.format.value, motion.rate.value = "motion.zip", 100
    motion.progress.observe(lambda _: motion.cancel.click(), ["value"])
    panel.export_button.click()
    assert motion.worker.wait(60)
    assert "Stopped" in panel.message.value
    assert not list(tmp_path.glob("*.zip"))
    panel.close()
    animation.close()


@pytest.mark.parametrize("below", [True, False], ids=["no folder", "no file"])
def test_choices_that_cannot_be_kept_end_no_export(
    model: EditorModel, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, below: bool
) -> None:
    folder = tmp_path / "data"
    if below:
        folder.write_text("a file")
    else:
        (folder / "last-export.json").mkdir(parents=True)
    monkeypatch.setenv("GLID_NB_DATA", str(folder))
    panel = FilePanel(model)
    panel.format.value = ".svg"
    panel.export_button.click()
    assert Path("glid.svg").is_file()
    assert "Wrote glid.svg" in panel.message.value
    assert "GLID_NB_DATA" in str(model.save_error)
    assert FilePanel(model).format.value == ".png"


def test_the_last_export_is_chosen_again_in_the_next_session(model: EditorModel) -> None:
    first = FilePanel(model)
    assert (first.format.value, first.view.value) == (".png", "fit")
    first.format.value, first.view.value = ".svg", "source"
    assert FilePanel(model).format.value == ".png"  # chosen, but not exported
    first.export_button.click()
    assert Path("glid.svg").is_file()
    again = FilePanel(model)
    assert (again.format.value, again.view.value) == (".svg", "source")
    again.format.value = ".obj"
    again.download_button.click()
    assert FilePanel(model).format.value == ".obj"
    # Settings that cannot be read or chosen are ignored.
    values = ('{"format": ".xyz", "view": "source", "more": 1}', '{"format": Infinity}', "[1]")
    for text in (*values, "{", "", "[" * 5000, "x" * 20_000):
        (last,) = Path(os.environ["GLID_NB_DATA"]).glob("last-export.json")
        last.write_text(text)
        assert FilePanel(model).format.value == ".png"
