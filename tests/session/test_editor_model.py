"""An editor without widgets: its parts fit together, and no file is lost."""

from __future__ import annotations

import errno
import gc
import shutil
import threading
import weakref
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from glid_nb.energies import CustomEnergy
from glid_nb.session import autosave
from glid_nb.session.autosave import MOST_KEPT, flush, kept_files
from glid_nb.session.document import Document, DocumentError
from glid_nb.session.document_file import load_document
from glid_nb.session.edit_state import EditError
from glid_nb.session.editor_model import (
    EditorModel,
    KeptWorkError,
    find_document,
    open_document,
)

from ..support.threads import NewThreads

pytestmark = pytest.mark.slow  # most of the time is compiling


def picture(width: int = 80) -> np.ndarray:
    """An opaque box with a hole, 100 x 60 pixels."""
    y, x = np.mgrid[:60, :100]
    image = np.zeros((60, 100, 4), np.uint8)
    inside = (abs(x - 49.5) < width / 2) & (abs(y - 29.5) < 20)
    image[inside & (np.hypot(x - 49.5, y - 29.5) > 6)] = (200, 120, 40, 255)
    return image


@pytest.fixture
def model(tmp_path: Path) -> Iterator[EditorModel]:
    model = EditorModel(picture(), path=tmp_path / "a.glid")
    model.deformation.paused = True  # nothing here needs a solve
    yield model
    model.close()


def _pin(model: EditorModel, *points: tuple[float, float]) -> None:
    model.deformation.paused = True
    for point in points:
        model.deformation.add_handle(point)


def _move_corner(model: EditorModel, to: tuple[float, float], gesture: str | None = None) -> None:
    """Drag the vertex that was the outline's upper left one at first."""
    frame, loops = model.tracing.frame, model.deformation.state.domain.cage.loops
    assert frame is not None
    corner = int(np.argmin(np.hypot(*(loops[0] - [-8, 4]).T)))
    model.tracing.move_vertex(0, corner, frame.to_pixel(to), gesture)


def test_a_picture_that_is_open_but_not_traced_is_not_saved(model: EditorModel) -> None:
    _pin(model, (-6, 0))
    before = model.document
    model.tracing.open(np.zeros((30, 30, 4), np.uint8))
    assert model.tracing.problems
    model.apply_tracing()
    assert model.document.image is before.image
    assert model.image is before.image
    assert model.document.trace_options == before.trace_options
    assert model.document.cage is before.cage


def test_an_opened_session_is_the_one_that_is_kept_up_to_date(
    model: EditorModel, tmp_path: Path
) -> None:
    first, second = tmp_path / "a.glid", tmp_path / "b.glid"
    other = EditorModel(picture(60))
    _pin(other, (5, 0))
    other.save(second)
    other.close()
    _pin(model, (-6, 0), (6, 0))
    model.load(second)
    assert model.autosave_path == second
    # It contains the changes that were pending for the first file.
    assert open_document(first).poses[0].pose.handles.tolist() == [[-6, 0], [6, 0]]
    _pin(model, (-5, 0))
    assert open_document(second).poses[0].pose.handles.tolist() == [[5, 0], [-5, 0]]
    assert load_document(first).poses[0].pose.handles.tolist() == [[-6, 0], [6, 0]]


def test_another_picture_is_another_session(model: EditorModel, tmp_path: Path) -> None:
    _pin(model, (-6, 0))
    (tmp_path / "a-2.glid").write_bytes(b"somebody's")
    model.tracing.open(picture(60))
    model.apply_tracing()
    assert model.autosave_path == tmp_path / "a-3.glid"
    _pin(model, (5, 0))
    assert open_document(tmp_path / "a-3.glid").poses[0].pose.handles.tolist() == [[5, 0]]
    old = open_document(tmp_path / "a.glid")
    assert old.poses[0].pose.handles.tolist() == [[-6, 0]]
    assert np.array_equal(old.image, picture())
    assert (tmp_path / "a-2.glid").read_bytes() == b"somebody's"


@pytest.mark.parametrize("kept", [True, False], ids=["with a file", "without"])
def test_undo_brings_a_picture_back_with_its_poses(tmp_path: Path, kept: bool) -> None:
    path = tmp_path / "a.glid" if kept else None
    model = EditorModel(picture(), path=path)
    _pin(model, (-6, 0), (6, 0))
    poses, image = model.deformation.state.poses, model.image
    for width in (60, 50):
        model.tracing.open(picture(width))
        before = model.autosave_path
        words = model.apply_tracing()
        place = f" (in {before.name})" if before is not None else ""
        assert f"The session before{place} comes back with Undo" in words
        _pin(model, (4, 0))
    for _ in range(2):
        model.tracing.undo()
    place = " (in a-3.glid)" if kept else ""
    assert f"The session before{place} comes back with Redo" in model.apply_tracing()
    assert model.image is image
    assert model.deformation.state.poses == poses
    assert model.autosave_path == path
    model.deformation.undo()
    assert len(model.deformation.pose) == 1  # its own steps are there, too
    model.tracing.redo()
    model.apply_tracing()
    assert model.deformation.pose.handles.tolist() == [[4, 0]]
    assert model.autosave_path == (tmp_path / "a-2.glid" if kept else None)
    model.close()


def test_undo_of_the_deformation_takes_the_tracing_along(model: EditorModel) -> None:
    _pin(model, (-6, 0))
    traced = model.tracing.domain
    for _ in range(2):
        model.tracing.toggle_hole(0)
        assert model.apply_tracing() == ""
        assert model.deformation.state.domain.cage.n_holes == 0
        model.deformation.undo()
        assert model.deformation.state.domain is model.tracing.domain is traced
        assert not model.tracing.options.drop_holes
        assert model.document.trace_options == model.tracing.options
        model.deformation.redo()
        assert model.tracing.cage is not None
        assert model.tracing.cage.n_holes == 0
        model.deformation.undo()
    assert model.deformation.pose.handles.tolist() == [[-6, 0]]
    assert not model.tracing.edited


def test_a_hole_dropped_in_the_deformation_is_dropped_in_the_tracing(model: EditorModel) -> None:
    model.deformation.paused = True
    model.deformation.drop_hole(0)
    assert model.tracing.cage is not None
    assert model.tracing.cage.equals(model.deformation.state.domain.cage)
    assert model.apply_tracing() == ""
    model.deformation.undo()
    assert model.tracing.cage.n_holes == 1
    assert not model.tracing.edited


def test_what_is_in_no_file_is_unsaved(tmp_path: Path) -> None:
    model = EditorModel(picture())
    assert not model.unsaved
    _pin(model, (-6, 0))
    assert model.unsaved
    model.save(tmp_path / "c.glid")
    assert not model.unsaved
    model.deformation.drag(0, to=(-5, 1))
    assert model.unsaved
    model.load(tmp_path / "c.glid")
    assert not model.unsaved
    model.deformation.drag(0, to=(-5, 1))
    model.tracing.open(picture(60))
    model.apply_tracing()
    assert model.unsaved  # the states that undo would bring back
    model.close()


def test_a_file_that_is_kept_up_to_date_has_everything(model: EditorModel) -> None:
    _pin(model, (-6, 0))
    assert not model.unsaved


def test_without_a_file_opening_a_session_keeps_none_up_to_date(tmp_path: Path) -> None:
    model = EditorModel(picture())
    model.save(tmp_path / "c.glid")
    model.load(tmp_path / "c.glid")
    assert model.autosave_path is None
    model.close()


def test_handles_outside_a_new_outline_come_back_with_the_old_one(model: EditorModel) -> None:
    _pin(model, (-6, 0), (-7.5, 3.5))
    state = model.deformation.state
    _move_corner(model, (-6.5, 2.5))
    assert model.apply_tracing().startswith("A pin was outside the new outline")
    assert model.deformation.pose.handles.tolist() == [[-6, 0]]
    model.tracing.undo()
    assert model.apply_tracing() == ""
    assert model.deformation.state is state


def test_what_was_valid_for_a_moment_of_a_drag_is_not_deformed(model: EditorModel) -> None:
    _pin(model, (-6, 0))
    domain = model.deformation.state.domain
    for point in ((-6.5, 2.5), (-6, 2.4), (20, -1)):  # valid, then across the opposite side
        _move_corner(model, point, gesture="drag")
    assert model.tracing.problems
    assert "not valid yet" in model.apply_tracing()
    assert model.deformation.state.domain is domain


def test_scribbles_that_are_not_painted_yet_can_be_saved(model: EditorModel) -> None:
    _pin(model, (-6, 0))
    model.tracing.set_options(method="scribbles")
    assert model.tracing.problems
    assert model.document.trace_options.method == "scribbles"


@pytest.mark.parametrize(("place", "reason"), [(".", "is a folder"), ("no/a.glid", "not exist")])
def test_a_path_where_no_file_can_be_is_refused(tmp_path: Path, place: str, reason: str) -> None:
    threads = set(threading.enumerate())
    with pytest.raises(DocumentError, match=reason):
        find_document(tmp_path / place)
    with pytest.raises(DocumentError, match=reason):
        EditorModel(picture(), path=tmp_path / place)
    assert set(threading.enumerate()) <= threads
    assert not list(tmp_path.iterdir())


def test_two_editors_of_one_file_do_not_write_over_one_another(
    model: EditorModel, tmp_path: Path
) -> None:
    path = tmp_path / "a.glid"
    _pin(model, (-6, 0))
    other = EditorModel(document=open_document(path), path=path)
    _pin(model, (6, 0))
    flush(path)
    _pin(other, (0, 2))
    flush(path)
    flush(tmp_path / "a-2.glid")
    assert (model.autosave_path, model.left_path) == (path, None)
    assert (other.autosave_path, other.left_path) == (tmp_path / "a-2.glid", path)
    assert load_document(path).poses[0].pose.handles.tolist() == [[-6, 0], [6, 0]]
    assert load_document(tmp_path / "a-2.glid").poses[0].pose.handles.tolist() == [[-6, 0], [0, 2]]
    assert other.own_files.strangers([path], path) == (path,)  # Save asks before replacing it
    assert model.own_files.strangers([path], path) == ()
    other.close()


def test_saving_to_the_file_that_is_kept_up_to_date_is_no_conflict(
    model: EditorModel, tmp_path: Path
) -> None:
    for point in [(-6, 0), (6, 0), (0, 3), (0, -3)]:
        _pin(model, point)
        model.save(tmp_path / "a.glid")
    flush(tmp_path / "a.glid")
    assert model.left_path is None
    assert len(load_document(tmp_path / "a.glid").poses[0].pose.handles) == 4


class TestKeptWork:
    """The work of an editor without a file is kept for the next editor of the same picture."""

    @pytest.fixture(autouse=True)
    def folder(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
        monkeypatch.setenv("GLID_NB_DATA", str(tmp_path / "data"))
        return tmp_path / "data"

    def left(self, *points: tuple[float, float], width: int = 80) -> None:
        model = EditorModel(picture(width))
        _pin(model, *points)
        model.deformation.save_pose()
        model.deformation.move_pose(1, 2.5)
        model.close()

    def test_the_next_editor_of_the_picture_goes_on_with_it(self) -> None:
        self.left((-6, 0), (6, 0))
        assert EditorModel(picture(60)).kept is None
        again = EditorModel(picture())
        assert again.kept == kept_files(picture())[0]
        again.recover()
        assert again.kept is None
        assert len(again.deformation.pose) == 2
        assert again.deformation.state.timeline.times == (0, 2.5)
        _pin(again, (0, 3.5))
        again.close()
        (path,) = kept_files()  # it continued in the same file
        assert len(load_document(path).poses[1].pose) == 3

    def test_work_that_nobody_asked_for_is_not_written_over(self) -> None:
        self.left((-6, 0), (6, 0))
        self.left((-6, 0))
        counts = sorted(len(load_document(path).poses[0].pose) for path in kept_files(picture()))
        assert counts == [1, 2]

    def test_at_most_five_files_are_kept(self) -> None:
        for width in range(60, 82, 3):
            self.left((-4, 0), width=width)
        assert len(kept_files()) == MOST_KEPT
        assert not kept_files(picture(60))
        assert kept_files(picture(81))

    def test_nothing_is_kept_of_what_is_saved_discarded_or_empty(self, tmp_path: Path) -> None:
        EditorModel(picture()).close()
        EditorModel(picture(), path=tmp_path / "a.glid").close()
        assert kept_files() == []
        model = EditorModel(picture())
        _pin(model, (-6, 0))
        assert len(kept_files()) <= 1
        model.save(tmp_path / "b.glid")
        model.close()
        assert kept_files() == []
        self.left((-6, 0))
        again = EditorModel(picture())
        _pin(again, (6, 0))  # meanwhile
        again.discard_kept()
        again.close()
        assert again.kept is None
        (path,) = kept_files()
        assert load_document(path).poses[0].pose.handles[0, 0] == 6

    def test_what_no_file_can_hold_raises_no_alarm(self) -> None:
        model = EditorModel(picture())
        model.deformation.paused = True
        model.deformation.set_energy(CustomEnergy(lambda x, y: (x + y) * (1 + 1 / (x - y) ** 2)))
        _pin(model, (-6, 0))
        model.close()
        assert model.save_error is None

    def test_a_folder_that_cannot_be_made_is_said_and_stops_nothing(self, folder: Path) -> None:
        folder.write_text("a file")
        model = EditorModel(picture())
        _pin(model, (-6, 0))
        self.told(model)
        assert len(model.deformation.pose) == 1
        model.close()

    @staticmethod
    def told(model: EditorModel) -> None:
        assert isinstance(model.save_error, KeptWorkError)
        assert "cannot be used: " in str(model.save_error)
        assert "GLID_NB_DATA" in str(model.save_error)

    @staticmethod
    def flushed(model: EditorModel) -> None:
        assert model.saving is not None
        assert model.saving.flush(60)

    def test_the_work_of_a_user_without_a_home_is_kept_among_temporary_files(
        self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
    ) -> None:
        for name in ("GLID_NB_DATA", "XDG_DATA_HOME"):
            monkeypatch.delenv(name, raising=False)

        def none() -> Path:
            raise RuntimeError("Could not determine home directory.")

        monkeypatch.setattr("pathlib.Path.home", none)
        monkeypatch.setattr("tempfile.gettempdir", lambda: str(tmp_path))
        model = EditorModel(picture())
        _pin(model, (-6, 0))
        self.flushed(model)
        assert model.save_error is None
        assert list(tmp_path.rglob("*.glid"))
        model.close()

    def test_a_folder_that_vanishes_is_made_again(self, folder: Path) -> None:
        model = EditorModel(picture())
        _pin(model, (-6, 0))
        self.flushed(model)
        shutil.rmtree(folder)
        _pin(model, (6, 0))
        self.flushed(model)
        assert model.save_error is None
        (path,) = kept_files()
        assert len(load_document(path).poses[0].pose) == 2
        model.close()

    def test_a_full_disk_is_said_and_the_next_change_tries_again(
        self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
    ) -> None:
        def full(_: int) -> None:
            raise OSError(errno.ENOSPC, "No space left on device")

        model = EditorModel(picture())
        with monkeypatch.context() as patch:
            patch.setattr("glid_nb._files.os.fsync", full)
            _pin(model, (-6, 0))
            self.flushed(model)
            self.told(model)
            assert "No space left on device" in str(model.save_error)
            assert kept_files() == []
        _pin(model, (6, 0))
        self.flushed(model)
        assert model.save_error is None
        assert len(kept_files()) == 1
        model.save(tmp_path / "a.glid")
        model.close()

    def test_what_stays_unkept_is_warned_of_when_all_is_closed(self, folder: Path) -> None:
        model = EditorModel(picture())
        _pin(model, (-6, 0))
        self.flushed(model)
        shutil.rmtree(folder)
        folder.write_text("a file")
        _pin(model, (6, 0))
        with pytest.warns(RuntimeWarning, match=r"^The editor's data folder.*GLID_NB_DATA"):
            model.close()
        with pytest.raises(EditError, match="closed"):
            model.deformation.add_handle((0, 3.5))

    def test_a_kept_file_of_another_user_is_left_and_another_one_is_kept(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        self.left((-6, 0), (6, 0))
        again = EditorModel(picture())
        theirs, save = again.kept, autosave.save_document
        assert theirs is not None
        before = theirs.read_bytes()

        def refused(document: Document, path: Path) -> None:
            if path == theirs:
                raise PermissionError(errno.EACCES, f"{path} cannot be written")
            save(document, path)

        monkeypatch.setattr(autosave, "save_document", refused)
        again.recover()
        _pin(again, (0, 3.5))
        again.close()
        assert again.save_error is None
        assert theirs.read_bytes() == before
        (ours,) = set(kept_files()) - {theirs}
        assert len(load_document(ours).poses[1].pose) == 3

    def test_a_kept_file_that_cannot_be_deleted_ends_no_save(
        self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
    ) -> None:
        for width in range(60, 82, 4):  # also of the oldest ones
            self.left((-4, 0), width=width)

        def refused(path: Path, **_: bool) -> None:
            if path.suffix == ".glid":
                raise PermissionError(errno.EACCES, f"{path} cannot be deleted")

        monkeypatch.setattr(Path, "unlink", refused)
        model = EditorModel(picture())
        _pin(model, (-6, 0))
        self.flushed(model)
        assert model.save_error is None
        model.save(tmp_path / "a.glid")
        assert len(load_document(tmp_path / "a.glid").poses[0].pose) == 1
        self.told(model)
        other = EditorModel(picture())
        assert other.kept is not None
        other.discard_kept()
        assert other.kept is None
        self.told(other)

    @pytest.mark.parametrize("damage", [b"", b"PK\x03\x04 half", b"{}"])
    def test_a_damaged_kept_file_is_refused_and_the_work_goes_on(self, damage: bytes) -> None:
        self.left((-6, 0), (6, 0))
        (path,) = kept_files()
        path.write_bytes(damage)
        again = EditorModel(picture())
        _pin(again, (0, 3.5))
        with pytest.raises(DocumentError, match=path.name):
            again.recover()
        assert len(again.deformation.pose) == 1
        again.discard_kept()
        again.close()
        assert path not in kept_files()


@pytest.mark.parametrize("named", [True, False])
def test_a_model_that_is_dropped_ends_its_threads_and_saves_its_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, named: bool
) -> None:
    monkeypatch.setenv("GLID_NB_DATA", str(tmp_path))
    threads = NewThreads()
    model = EditorModel(picture(), path=tmp_path / "a.glid" if named else None)
    _pin(model, (-6, 0))
    saving = model.saving
    assert saving is not None
    saving.flush()
    _pin(model, (6, 0))  # waits for the interval
    thread, path = threads.named(f"autosave {saving.path.name}"), saving.path
    assert thread is not None
    gone = weakref.ref(model)
    del model, saving
    gc.collect()
    assert gone() is None
    thread.join(60)
    assert not thread.is_alive()
    assert len(load_document(path).poses[0].pose) == 2
