"""A pose that is not solved on its cage is solved before use, or reported."""

from __future__ import annotations

import json
import threading
import zipfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor, wait
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import glid_nb as glid
from glid_nb import methods
from glid_nb._files import zipped
from glid_nb.cli.main import main
from glid_nb.harmonic import HarmonicMap
from glid_nb.session.animation import Animation, motion_of
from glid_nb.session.document import Document, NamedPose
from glid_nb.session.document_file import load_document, save_document
from glid_nb.session.edit_state import EditError
from glid_nb.session.editor_model import EditorModel
from glid_nb.session.script import python_code
from glid_nb.session.unsolved import solved_document
from glid_nb.widgets import exporting

from .test_editor_model import picture

pytestmark = pytest.mark.slow

TIMEOUT = 120.0


def miss(pose: NamedPose) -> float:
    """The largest distance of a handle from its target, world units."""
    return float(np.abs(pose.map(pose.pose.handles) - pose.pose.targets).max(initial=0))


@pytest.fixture
def model() -> Iterator[EditorModel]:
    """A box with a hole in two poses that are solved."""
    model = EditorModel(picture())
    deformation = model.deformation
    deformation.add_handles([(-6, 0), (6, 0)])
    deformation.drag(1, (6, 1.5))
    assert deformation.solve(TIMEOUT)
    deformation.save_pose("a")
    deformation.drag(1, (6, -1))
    assert deformation.solve(TIMEOUT)
    yield model
    model.close()


def test_a_wait_for_all_poses_ends_after_the_news_of_the_last(model: EditorModel) -> None:
    """The bug: it ended between the last solve and its news, so the motion was not begun."""
    began, go_on, told = threading.Event(), threading.Event(), []

    def slow_reader(what: str) -> None:
        if threading.current_thread().name == "other poses":
            began.set()
            go_on.wait(TIMEOUT)
            told.append(what)

    model.deformation.observe(slow_reader)
    retrace(model)
    assert began.wait(TIMEOUT)
    with ThreadPoolExecutor(1) as pool:
        solved = pool.submit(model.deformation.solve, TIMEOUT)
        assert not wait([solved], 0.2).done  # long enough to look for other poses
        go_on.set()
        assert solved.result(TIMEOUT)
    assert told == ["state"]


def retrace(model: EditorModel) -> None:
    model.tracing.set_options(offset=4.0)
    before = model.deformation.state.domain
    model.apply_tracing()
    assert model.deformation.state.domain is not before


def test_a_new_cage_leaves_no_pose_that_claims_to_be_solved(model: EditorModel) -> None:
    retrace(model)
    assert all(pose.unsolved and not pose.solved for pose in model.deformation.state.poses)
    assert model.deformation.solve(TIMEOUT)
    poses = model.deformation.state.poses
    assert all(pose.solved for pose in poses)
    assert max(map(miss, poses)) < 1e-3


def test_what_is_saved_is_solved_first(model: EditorModel, tmp_path: Path) -> None:
    retrace(model)
    model.save(tmp_path / "s.glid")
    saved = load_document(tmp_path / "s.glid")
    assert max(map(miss, saved.poses)) < 1e-3
    assert saved.unsolved == ()


def test_a_motion_is_solved_first(model: EditorModel) -> None:
    animation = Animation(model.deformation)
    retrace(model)
    motion = animation.motion
    assert {keyframe.domain for keyframe in motion.keyframes} == {model.deformation.state.domain}
    np.testing.assert_allclose(motion(0.0)([[6, 0]]), [[6, 1.5]], atol=1e-3)
    np.testing.assert_allclose(motion(1.0)([[6, 0]]), [[6, -1]], atol=1e-3)
    animation.close()


def test_what_is_exported_is_solved_first(model: EditorModel, tmp_path: Path) -> None:
    retrace(model)
    exporting.export(model, tmp_path / "a.proof.json")
    exported = HarmonicMap.load(tmp_path / "a.map.json")
    np.testing.assert_allclose(exported([[6, 0]]), [[6, -1]], atol=1e-3)
    model.deformation.undo()
    model.deformation.redo()
    exporting.export(model, tmp_path / "a.motion.json")
    moved = glid.Motion.load(tmp_path / "a.motion.json")
    np.testing.assert_allclose(moved(0.0)([[6, 0]]), [[6, 1.5]], atol=1e-3)


def test_while_the_solver_is_paused_a_file_says_what_is_not_solved(
    model: EditorModel, tmp_path: Path
) -> None:
    path, deformation = tmp_path / "s.glid", model.deformation
    deformation.paused = True
    retrace(model)
    model.save(path)
    assert [pose.name for pose in load_document(path).unsolved] == ["a", "a 1"]
    for name in ("a.png", "a.glb", "a.proof.json", "a.svg", "a.html"):
        with pytest.raises(EditError, match="the pose 'a 1' is not solved, because the solver is"):
            exporting.export(model, tmp_path / name)
    with pytest.raises(EditError, match=r"the pose 'a' is not solved.*; the pose 'a 1' is not"):
        exporting.export(model, tmp_path / "a.gif")
    # The command line solves it, and so does an editor that opens it.
    out = tmp_path / "walk.motion.json"
    assert main(["animate", str(path), "--out", str(out)]) == 0
    np.testing.assert_allclose(glid.Motion.load(out)(0.0)([[6, 0]]), [[6, 1.5]], atol=1e-3)
    other = EditorModel(document=load_document(path))
    assert other.deformation.solve(TIMEOUT)
    assert max(map(miss, other.deformation.state.poses)) < 1e-3
    other.close()
    deformation.paused = False
    assert deformation.solve(TIMEOUT)
    assert max(map(miss, deformation.state.poses)) < 1e-3


def test_a_pose_that_was_left_half_way_is_known_in_a_file(
    model: EditorModel, tmp_path: Path
) -> None:
    """Its map is not the identity, so the file must mark it. Older versions did not."""
    deformation, path = model.deformation, tmp_path / "s.glid"
    deformation.paused = True
    deformation.drag(1, (6, 2.5))
    deformation.go_to_pose(0)
    model.save(path)
    with zipfile.ZipFile(path) as archive:
        data = json.loads(archive.read("document.json"))
        others = {name: archive.read(name) for name in archive.namelist()}
    assert data["version"] == 7
    document = load_document(path)
    assert [pose.name for pose in document.unsolved] == ["a 1"]
    assert miss(document.poses[1]) > 1
    assert max(map(miss, solved_document(document).poses)) < 1e-3
    data["poses"][1]["unsolved"] = "perhaps"
    path.write_bytes(zipped({**others, "document.json": json.dumps(data).encode()}))
    with pytest.raises(glid.InputError, match="unsolved must be true or false"):
        load_document(path)


def as_older_versions_wrote(document: Document, path: Path) -> None:
    """The bug: every other pose was the identity, and nothing said so."""
    identity = HarmonicMap.identity(document.domain)
    first, *others = document.poses
    poses = (replace(first, map=identity), *others)
    save_document(replace(document, poses=poses), path)
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    data = json.loads(members["document.json"])
    assert not any("unsolved" in pose for pose in data["poses"])
    data["version"] = 4
    data.pop("look", None)
    path.write_bytes(zipped({**members, "document.json": json.dumps(data).encode()}))


def test_a_file_with_the_fault_of_older_versions_is_repaired(
    model: EditorModel, tmp_path: Path
) -> None:
    path = tmp_path / "s.glid"
    as_older_versions_wrote(model.document, path)
    assert [pose.name for pose in load_document(path).unsolved] == ["a"]
    out = tmp_path / "walk.motion.json"
    assert main(["animate", str(path), "--out", str(out)]) == 0
    np.testing.assert_allclose(glid.Motion.load(out)(0.0)([[6, 0]]), [[6, 1.5]], atol=1e-3)
    kept = load_document(path).poses[1].map
    other = EditorModel(path=path, document=load_document(path))
    motion = motion_of(other.deformation.solved_state())
    np.testing.assert_allclose(motion(0.0)([[6, 0]]), [[6, 1.5]], atol=1e-3)
    assert other.deformation.state.poses[1].map.distance(kept) == 0  # the right part stays
    other.close()
    assert load_document(path).unsolved == ()  # and the file is right, too


def test_undo_and_redo_across_a_change_of_the_cage(model: EditorModel) -> None:
    deformation = model.deformation
    before = [pose.map for pose in deformation.state.poses]
    retrace(model)
    deformation.undo()
    assert [pose.map for pose in deformation.state.poses] == before
    assert all(pose.solved for pose in deformation.state.poses)
    deformation.redo()
    state = deformation.solved_state()
    assert {pose.map.domain for pose in state.poses} == {state.domain}
    assert max(map(miss, state.poses)) < 1e-3


@pytest.mark.parametrize("act", ["duplicate_pose", "delete_pose", "rename_pose", "move_pose"])
def test_the_timeline_changes_right_after_the_cage(model: EditorModel, act: str) -> None:
    more = {"rename_pose": ("b",), "move_pose": (3.0,)}.get(act, ())
    retrace(model)
    getattr(model.deformation, act)(0, *more)
    state = model.deformation.solved_state()
    assert max(map(miss, state.poses)) < 1e-3


def test_a_pose_of_a_method_without_certified_maps_is_named(
    model: EditorModel, tmp_path: Path
) -> None:
    deformation = model.deformation
    deformation.set_method(methods.MeanValueCoordinates())
    retrace(model)
    assert deformation.solve(TIMEOUT)
    named = "the pose 'a 1' is deformed by .*, which gives no certified map"
    with pytest.raises(EditError, match=named):
        exporting.export(model, tmp_path / "a.gif")
    model.save(tmp_path / "s.glid")
    document = load_document(tmp_path / "s.glid")
    assert [pose.name for pose in document.unsolved] == ["a 1"]
    with pytest.raises(glid.InputError, match=r"these poses are not solved.*'a 1'; open"):
        solved_document(document)


def test_exact_code_of_a_pose_that_is_not_solved_solves_it(model: EditorModel) -> None:
    model.deformation.paused = True
    retrace(model)
    code = python_code(model.document, exact=True)
    assert code.count("glid.solve(") == 2
    model.deformation.paused = False
    assert model.deformation.solve(TIMEOUT)
    assert "glid.solve(" not in python_code(model.document, exact=True)


def test_a_picture_that_comes_back_comes_back_solved(model: EditorModel) -> None:
    retrace(model)
    model.tracing.open(picture(60))
    model.apply_tracing()
    assert all(pose.map.domain is model.deformation.state.domain for pose in model.document.poses)
    model.tracing.undo()
    model.apply_tracing()
    state = model.deformation.solved_state()
    assert [pose.name for pose in state.poses] == ["a", "a 1"]
    assert max(map(miss, state.poses)) < 1e-3
