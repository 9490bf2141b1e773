"""What an editor draws of its picture: the shape cut out, and what lies behind it."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from glid_nb import InputError, cut_out, samples, trace
from glid_nb import io as glid_io
from glid_nb.session.document import DocumentError
from glid_nb.session.editor_model import EditorModel
from glid_nb.session.look import WHOLE_CAGE, Look
from glid_nb.session.tracing import layers_of


def photograph() -> np.ndarray:
    """A round shape before a wall, 120 x 100 pixels, without transparency."""
    y, x = np.mgrid[:100, :120] + 0.5
    share = (32.5 - np.hypot(x - 60, y - 50)).clip(0, 1)[..., None]
    wall = np.stack([200 + 0.2 * x, 190 + 0.2 * y, 180 + 0 * x], axis=-1)
    return np.rint(share * [150, 40, 30] + (1 - share) * wall).astype(np.uint8)


@pytest.fixture
def model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[EditorModel]:
    monkeypatch.setenv("GLID_NB_DATA", str(tmp_path / "data"))
    model = EditorModel(photograph())
    yield model
    model.close()


def changed(path: Path, **changes: Any) -> Path:
    """A session file with other values in its JSON; None removes a key."""
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    data = {**json.loads(members["document.json"]), **changes}
    members["document.json"] = json.dumps({k: v for k, v in data.items() if v is not None}).encode()
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return path


def test_a_photograph_is_cut_out_by_default(model: EditorModel) -> None:
    layers = model.layers
    np.testing.assert_array_equal(layers.image, cut_out(photograph(), trace(photograph())))
    assert layers.background is None
    assert model.layers is layers  # made once


def test_a_picture_with_transparency_is_drawn_as_it_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("GLID_NB_DATA", str(tmp_path))
    model = EditorModel(samples.image("bar"))
    np.testing.assert_array_equal(model.layers.image, samples.image("bar"))
    model.set_look(Look(background="filled"))
    assert model.layers.background is None  # nothing behind it is known
    model.close()


def test_another_background_keeps_the_shape_that_was_cut_out(model: EditorModel) -> None:
    told: list[str] = []
    model.observe(told.append)
    image = model.layers.image
    model.set_look(Look(background="filled"))
    assert told == ["look"]
    assert model.layers.image is image
    behind = model.layers.background
    assert isinstance(behind, np.ndarray)
    assert np.abs(behind[50, 60, :3].astype(int) - [212, 200, 180]).max() < 12
    model.set_look(Look(cut_out=False, background=(1, 2, 3)))
    np.testing.assert_array_equal(model.layers.image[..., :3], photograph())
    assert model.layers.background == (1, 2, 3)


def test_another_cage_cuts_out_another_shape(model: EditorModel) -> None:
    before = model.layers.image
    exterior = model.deformation.state.domain.cage.exterior.copy()
    exterior[int(np.argmax(exterior[:, 0]))] += [1.0, 0.0]
    model.tracing.set_loops((exterior,))
    model.apply_tracing()
    after = model.layers.image
    assert np.count_nonzero(after[..., 3]) > np.count_nonzero(before[..., 3])
    model.deformation.undo()
    np.testing.assert_array_equal(model.layers.image, before)


def test_an_outline_drawn_by_hand_is_the_shape(model: EditorModel) -> None:
    model.tracing.draw([[20, 20], [100, 20], [100, 80], [20, 80]])
    model.apply_tracing()
    assert (model.layers.image[..., 3] == 255).all()
    model.set_look(Look(background="filled"))
    behind = model.layers.background
    assert isinstance(behind, np.ndarray)
    assert behind[50, 60, 0] > 190  # the red shape lies in the drawn outline


@pytest.mark.parametrize("look", [Look(), Look(background="filled"), Look(False, (0, 9, 255))])
def test_a_session_keeps_the_look(model: EditorModel, tmp_path: Path, look: Look) -> None:
    model.set_look(look)
    model.save(tmp_path / "kept.glid")
    assert glid_io.load_document(tmp_path / "kept.glid").look == look
    model.set_look(Look(background=(7, 7, 7)))
    model.load(tmp_path / "kept.glid")
    assert model.look == look


def test_a_document_is_drawn_as_in_its_editor(model: EditorModel) -> None:
    model.set_look(Look(background="filled"))
    layers = layers_of(model.document)
    np.testing.assert_array_equal(layers.image, model.layers.image)
    np.testing.assert_array_equal(np.asarray(layers.background), model.layers.background)


def test_older_sessions_are_drawn_as_before(model: EditorModel, tmp_path: Path) -> None:
    model.save(tmp_path / "old.glid")
    old = changed(tmp_path / "old.glid", version=5, look=None)
    model.load(old)
    assert model.look == WHOLE_CAGE
    np.testing.assert_array_equal(model.layers.image[..., :3], photograph())
    assert (model.layers.image[..., 3] == 255).all()


@pytest.mark.parametrize(
    ("look", "message"),
    [
        ({"background": "red"}, 'look: background must be .* "filled" or None, not .red'),
        ({"cut_out": 1}, "look: cut_out must be True or False, not 1"),
        ({"colour": 1}, "unknown key 'colour'"),
    ],
)
def test_a_damaged_look_is_refused(
    model: EditorModel, tmp_path: Path, look: dict[str, Any], message: str
) -> None:
    model.save(tmp_path / "damaged.glid")
    with pytest.raises(DocumentError, match=message):
        glid_io.load_document(changed(tmp_path / "damaged.glid", look=look))


def test_other_backgrounds_are_refused() -> None:
    with pytest.raises(InputError, match="three whole numbers from 0 to 255"):
        Look(background=(0, 0, 300))


@pytest.mark.slow
def test_exports_show_what_the_canvas_shows(model: EditorModel) -> None:
    from glid_nb.widgets.exporting import exported

    def written(name: str) -> bytes:
        return exported(model, Path(name), None, "source")[name]

    cut = np.asarray(Image.open(io.BytesIO(written("cut.png"))))
    assert cut[50, 60, 3] == 255
    assert not cut[50, 93:].any()  # the room up to the cage was the wall
    model.set_look(Look(background="filled"))
    behind = model.layers.background
    assert isinstance(behind, np.ndarray)
    placed = np.asarray(Image.open(io.BytesIO(written("placed.png"))))
    np.testing.assert_array_equal(placed[0], behind[0])
    for name in ("placed.html", "placed.live.html"):
        assert b"main canvas:first-child { background: url(" in written(name)
