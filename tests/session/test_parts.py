"""Several shapes in one session: one timeline, one undo, each shape with its own certified maps."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb.certificate import certificate_of
from glid_nb.imaging.read import read_image
from glid_nb.motion import Piece
from glid_nb.session import parts as acts
from glid_nb.session.animation import Animation
from glid_nb.session.document import DocumentError
from glid_nb.session.document_file import load_document, save_document
from glid_nb.session.edit_state import EditError, EditState
from glid_nb.session.editor_model import EditorModel
from glid_nb.widgets import exporting

SIZE = (120, 90)


def disk(x: float, y: float, radius: float, color: tuple[int, int, int]) -> np.ndarray:
    rows, columns = np.mgrid[: SIZE[1], : SIZE[0]]
    pixels = np.zeros((SIZE[1], SIZE[0], 4), np.uint8)
    pixels[np.hypot(columns - x, rows - y) < radius] = (*color, 255)
    return pixels


RED, BLUE = disk(35, 45, 22, (220, 30, 30)), disk(85, 45, 18, (30, 30, 220))
ISLANDS = np.maximum(RED, BLUE)


@pytest.fixture
def model() -> Iterator[EditorModel]:
    """An editor with a red disk behind a blue one."""
    made = EditorModel(parts={"red": RED, "blue": BLUE})
    yield made
    made.close()


def names(state: EditState) -> list[str]:
    return [part.name for part in state.parts]


def test_each_part_has_its_picture_its_cage_and_its_proof(model: EditorModel) -> None:
    state = model.deformation.state
    assert names(state) == ["red", "blue"]
    assert state.edited_part is not None
    assert state.edited_part.name == "red"
    red, blue = model.shapes
    assert (red.layers.picture == RED).all()
    assert (blue.layers.picture == BLUE).all()
    x = [shape.state.domain.cage.exterior[:, 0].mean() for shape in (red, blue)]
    assert x[0] < 0 < x[1]
    assert all(certificate_of(shape.state.map).certified for shape in (red, blue))


def test_switching_shows_the_parts_tracing_and_undo_comes_back(model: EditorModel) -> None:
    deformation, red = model.deformation, model.tracing.state
    deformation.select_part(1)
    assert model.tracing.image is not None
    assert (model.tracing.image == BLUE).all()
    assert (model.layers.picture == BLUE).all()
    assert not model.tracing.can_undo  # the history of the tracing is the part's own
    model.tracing.set_options(simplify=2.0)
    model.apply_tracing()
    changed = deformation.state.domain
    deformation.select_part(0)
    assert model.tracing.state is red
    deformation.undo()
    assert deformation.state.domain is changed
    assert model.tracing.options.simplify == 2.0
    deformation.undo()
    assert not deformation.state.domain.cage.equals(changed.cage)
    assert names(deformation.state) == ["red", "blue"]
    deformation.undo()
    assert model.tracing.state is red


def test_pins_belong_to_one_part_and_undo_goes_back_in_order(model: EditorModel) -> None:
    deformation = model.deformation
    x, y = deformation.state.domain.cage.exterior.mean(axis=0)
    pin = deformation.add_handle((x, y))
    deformation.drag(pin, to=(x + 1, y))
    deformation.select_part(1)
    assert len(deformation.pose) == 0
    x, y = deformation.state.domain.cage.exterior.mean(axis=0)
    deformation.add_handle((x, y))
    counts = []
    while deformation.can_undo:
        deformation.undo()
        counts.append([len(part.poses[0].pose) for part in deformation.state.parts])
    assert counts == [[1, 0], [1, 0], [1, 0], [0, 0]]
    while deformation.redo():
        pass
    assert [len(part.poses[0].pose) for part in deformation.state.parts] == [1, 1]


def test_keyframes_are_common_to_all_parts(model: EditorModel) -> None:
    deformation = model.deformation
    deformation.save_pose("rest")
    deformation.rename_pose(1, "up")
    deformation.move_pose(1, 2.5)
    deformation.duplicate_pose(0)
    deformation.set_easing(0, "in-out")
    for part in deformation.state.parts:
        assert [pose.name for pose in part.poses] == ["rest", "rest 1", "up"]
    assert deformation.state.timeline.times == (0.0, 1.25, 2.5)
    deformation.select_part(1)
    deformation.delete_pose(1)
    for part in deformation.state.parts:
        assert [pose.name for pose in part.poses] == ["rest", "up"]
    deformation.undo()
    assert all(len(part.poses) == 3 for part in deformation.state.parts)


def test_the_poses_of_all_parts_are_solved_and_each_motion_is_proved(model: EditorModel) -> None:
    deformation = model.deformation
    animation = Animation(deformation)
    try:
        for index in (0, 1):
            deformation.select_part(index)
            x, y = deformation.state.domain.cage.exterior.mean(axis=0)
            pin = deformation.add_handle((x, y))
            if not index:
                deformation.save_pose()
            deformation.drag(pin, to=(x, y + 1 + index))
        state = deformation.solved_state()
        assert not any(pose.unsolved for shape in state.shapes for pose in shape.poses)
        assert animation.wait(60)
        spans = [animation.spans_of(key)[0] for key in state.keys]
        assert [span.status for span in spans] == ["proved", "proved"]
        rises = []
        for key, shape in zip(state.keys, state.shapes, strict=True):
            seen = animation.seen(0.5, key)
            assert seen is not None
            center = shape.domain.cage.exterior.mean(axis=0)
            rises.append(float(seen[0]([center])[0, 1] - center[1]))
        assert 0.2 < rises[0] < rises[1]
        animation.keep(0.4)
        assert all(len(part.poses) == 3 for part in deformation.state.parts)
    finally:
        animation.close()


def test_a_part_that_is_not_proved_stops_all_at_its_last_proved_instant(
    model: EditorModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    deformation = model.deformation
    x, y = deformation.state.domain.cage.exterior.mean(axis=0)
    pin = deformation.add_handle((x, y))
    deformation.save_pose()
    deformation.drag(pin, to=(x, y + 2))
    animation = Animation(deformation)
    try:
        assert animation.wait(60)
        whole = animation.at(0.75)
        blue = animation.spans_of(1)
        end, (piece, *_) = 0.5, blue[0].pieces
        held_piece = Piece(0.0, end, piece.start_map, piece.at(end))
        short = blue[0]._replace(status="fails", pieces=(held_piece,))
        spans = {0: animation.spans_of(0), 1: (short,)}
        monkeypatch.setattr(animation, "_spans", spans)
        stopped, held = animation.at(0.75), animation.at(end)
        assert whole is not None
        assert stopped is not None
        assert held is not None
        assert np.array_equal(stopped.phi, held.phi)
        assert not np.array_equal(stopped.phi, whole.phi)
        with pytest.raises(EditError, match=r"nothing is proved at 0\.75 s"):
            animation.keep(0.75)
    finally:
        animation.close()


def test_order_names_and_visibility_change_in_steps(model: EditorModel) -> None:
    deformation = model.deformation
    deformation.move_part(0, 1)
    assert names(deformation.state) == ["blue", "red"]
    assert deformation.state.part == 1  # red is still the edited one
    deformation.rename_part(0, "red")
    assert names(deformation.state) == ["red 2", "red"]
    deformation.show_part(0, False)
    assert [shape.visible for shape in model.shapes] == [False, True]
    deformation.remove_part(1)
    assert names(deformation.state) == ["red 2"]
    assert (model.layers.picture == BLUE).all()
    with pytest.raises(EditError, match="only part"):
        deformation.remove_part(0)
    with pytest.raises(EditError, match="only visible part"):
        deformation.show_part(0, False)
    with pytest.raises(EditError, match="there is no part 3"):
        deformation.select_part(2)
    assert model.shapes[0].visible  # it is edited now
    deformation.undo()
    assert names(deformation.state) == ["red 2", "red"]
    assert (model.layers.picture == RED).all()


def test_a_picture_of_two_islands_is_kept_as_two_parts() -> None:
    model = EditorModel(ISLANDS)
    try:
        model.deformation.add_handle(model.deformation.state.domain.cage.exterior.mean(axis=0))
        assert model.keep_pieces(model.tracing.pieces()) == 1
        state = model.deformation.state
        assert names(state) == ["Part 1", "Part 2"]
        assert [len(part.poses[0].pose) for part in state.parts] == [1, 0]
        blue = state.parts[1].domain.cage.exterior.mean(axis=0)
        expected = EditorModel(BLUE)
        try:
            wanted = expected.deformation.state.domain.cage.exterior.mean(axis=0)
        finally:
            expected.close()
        assert np.allclose(blue, wanted, atol=0.1)
        model.deformation.undo()
        assert not model.deformation.state.parts
        model.deformation.redo()
        model.deformation.select_part(1)
        assert model.tracing.options.component == 1
    finally:
        model.close()


def test_pieces_of_a_cut_are_parts() -> None:
    model = EditorModel(RED)
    try:
        pieces = model.tracing.cut([(35, 0), (35, 89)])
        assert model.keep_pieces(model.tracing.pieces(pieces[1:])) == 1
        left, right = model.deformation.state.shapes
        ends = [(s.domain.cage.exterior[:, 0].min(), s.domain.cage.exterior[:, 0].max())
                for s in (left, right)]  # fmt: skip
        assert ends[0][1] < ends[1][0] or ends[1][1] < ends[0][0]
    finally:
        model.close()


def test_parts_are_saved_and_opened_bit_for_bit(model: EditorModel, tmp_path: Path) -> None:
    deformation = model.deformation
    deformation.select_part(1)
    x, y = deformation.state.domain.cage.exterior.mean(axis=0)
    deformation.drag(deformation.add_handle((x, y)), to=(x, y + 1))
    deformation.save_pose()
    deformation.show_part(0, False)
    model.save(tmp_path / "two.glid")
    saved = model.document
    opened = load_document(tmp_path / "two.glid")
    assert opened.part == 1
    for old, new in zip(saved.parts, opened.parts, strict=True):
        assert (old.name, old.visible) == (new.name, new.visible)
        assert np.array_equal(old.image, new.image)
        assert old.domain.equals(new.domain)
        for before, after in zip(old.poses, new.poses, strict=True):
            assert np.array_equal(before.map.phi, after.map.phi)
            assert np.array_equal(before.map.psi, after.map.psi)
    save_document(opened, tmp_path / "again.glid")
    again = EditorModel(document=load_document(tmp_path / "again.glid"))
    try:
        assert names(again.deformation.state) == ["red", "blue"]
        assert [shape.visible for shape in again.shapes] == [False, True]
        assert again.deformation.state.part == 1
        again.deformation.select_part(0)
        assert (again.layers.picture == RED).all()
        assert not again.tracing.edited
    finally:
        again.close()


def test_one_shape_is_saved_as_before_and_parts_of_one_picture_share_it(tmp_path: Path) -> None:
    def written(model: EditorModel) -> tuple[dict[str, Any], list[str]]:
        model.save(tmp_path / "one.glid")
        with zipfile.ZipFile(tmp_path / "one.glid") as archive:
            return json.loads(archive.read("document.json")), archive.namelist()

    model = EditorModel(ISLANDS)
    try:
        data, members = written(model)
        assert (data["version"], "parts" in data) == (7, False)
        assert sorted(members) == ["document.json", "image.png"]
        model.keep_pieces(model.tracing.pieces())
        data, members = written(model)
        assert data["version"] == 7
        assert sorted(members) == ["document.json", "image.png"]
        model.deformation.remove_part(1)
        assert written(model)[0]["version"] == 7
    finally:
        model.close()


def changed_session(model: EditorModel, folder: Path, change: Any) -> Path:
    """A file of the model's session whose JSON ``change`` changed."""
    path = folder / "changed.glid"
    save_document(model.document, path)
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    data = json.loads(members["document.json"])
    change(data)
    members["document.json"] = json.dumps(data).encode()
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return path


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda d: d.update(part=2), "part must be 0 to 1, not 2"),
        (lambda d: d.pop("part"), "part must be 0 to 1, not None"),
        (lambda d: d["parts"].pop(), "there are 1; 2 to 100 are allowed"),
        (lambda d: d["parts"][1].update(image="image-7.png"), "'image-7.png' is missing"),
        (lambda d: d["parts"][1].update(name=""), r"parts\[1\].*1 to 200 characters"),
        (lambda d: d["parts"][1]["poses"].clear(), "0 poses for 1 keyframes"),
        (lambda d: d.update(version=6), "unknown key 'part"),
        (lambda d: d["parts"][1].update(visible=1), "visible must be true or false"),
    ],
)
def test_wrong_parts_are_refused(
    model: EditorModel, tmp_path: Path, change: Any, says: str
) -> None:
    path = changed_session(model, tmp_path, change)
    with pytest.raises(DocumentError, match=says):
        load_document(path)


def test_a_session_with_two_parts_of_one_name_opens_with_a_number(
    model: EditorModel, tmp_path: Path
) -> None:
    path = changed_session(model, tmp_path, lambda d: d["parts"][1].update(name="red"))
    opened = load_document(path)
    assert [part.name for part in opened.parts] == ["red", "red 2"]
    again = [replace(part, name="red") for part in opened.parts]
    with pytest.raises(DocumentError, match=r"parts\[1\]: another part has the name 'red'"):
        replace(opened, parts=again)
    other = EditorModel(document=opened)
    try:
        files = exporting.exported(other, tmp_path / "a.obj", None, "source")
        assert {"a-red-texture.png", "a-red_2-texture.png"} < set(files)
    finally:
        other.close()


def test_pictures_of_parts_have_one_size() -> None:
    with pytest.raises(EditError, match="same size, not 120 x 90 and 60 x 90"):
        EditorModel(parts={"red": RED, "half": read_image(RED[:, :60])})


ACTIONS = st.lists(
    st.one_of(
        st.tuples(st.just("select_part"), st.integers(0, 2)),
        st.tuples(st.just("move_part"), st.integers(0, 2), st.integers(-1, 3)),
        st.tuples(st.just("show_part"), st.integers(0, 2), st.booleans()),
        st.tuples(st.just("remove_part"), st.integers(0, 2)),
        st.tuples(st.just("rename_part"), st.integers(0, 2), st.sampled_from(["a", "b", " "])),
    ),
    max_size=12,
)


@pytest.fixture(scope="module")
def three() -> EditState:
    made = EditorModel(parts={"a": RED, "b": BLUE, "c": RED})
    state = made.deformation.state
    made.close()
    return state


@settings(max_examples=60, deadline=None)
@given(steps=ACTIONS)
def test_any_actions_on_parts_leave_a_whole_state(steps: list[Any], three: EditState) -> None:
    state = three
    for name, *arguments in steps:
        before = state
        try:
            state = getattr(acts, name)(state, *arguments)
        except EditError:
            assert state is before
        keys, called = list(state.keys), names(state)
        assert len(set(keys)) == len(keys) > 0
        assert len(set(called)) == len(called)
        assert set(keys) <= set(three.keys)
        part = state.edited_part
        assert part is not None
        assert part.domain is state.domain
        assert part.poses is state.poses
        if name in ("select_part", "show_part", "remove_part"):
            assert part.visible
        if name in ("move_part", "rename_part"):
            assert state.keys[state.part] == before.keys[before.part]
