"""Pins that are locked, hidden or grouped: as values, as steps of undo, and in files."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from glid_nb._errors import InputFileError
from glid_nb.session import actions
from glid_nb.session.deformation import Deformation
from glid_nb.session.document_file import load_document, save_document
from glid_nb.session.edit_state import EditError, EditState
from glid_nb.session.pin_marks import PinMark, PinMarks, switched, with_groups
from glid_nb.session.pose_text import mirror_pose
from glid_nb.session.script import python_code

from ..support.domains import domain
from .test_document import document

POINTS = [(2.0, 0.0), (-2.0, 0.0), (0.0, 2.0)]


def test_a_pin_is_added_to_the_chosen_ones_or_taken_out_with_its_group() -> None:
    marks = [PinMark(group=1), PinMark(), PinMark(group=1), PinMark()]
    assert switched(marks, (3,), 1) == (3, 1)
    assert switched(marks, (0, 3, 2), 2) == (3,)
    assert switched(marks, (0, 3, 2), 3) == (0, 2)


@pytest.fixture
def state() -> EditState:
    return actions.add_handles(EditState.initial(domain("ring")), POINTS)


def test_marks_belong_to_handles_in_all_poses(state: EditState) -> None:
    marked = actions.mark_pins(actions.save_pose(state), [1], locked=True)
    marked = actions.mark_pins(marked, [1, 2], hidden=True)
    wanted = (PinMark(), PinMark(True, True), PinMark(hidden=True))
    assert marked.marks == wanted
    assert actions.go_to_pose(marked, 0).marks == wanted
    assert actions.remove_handles(marked, [0]).marks == wanted[1:]
    assert actions.show_all_pins(marked).marks == (PinMark(), PinMark(locked=True), PinMark())
    assert actions.mark_pins(marked, [1], locked=True) is marked
    assert marked.current is actions.show_all_pins(marked).current  # nothing to solve again


def test_groups_are_selected_together_and_the_last_pin_stays_last(state: EditState) -> None:
    grouped = actions.group_pins(state, [0, 2])
    assert with_groups(grouped.marks, [0]) == (2, 0)
    assert with_groups(grouped.marks, [2, 0]) == (2, 0)
    assert with_groups(grouped.marks, [1]) == (1,)
    assert with_groups(grouped.marks, [1, 2]) == (0, 1, 2)
    again = actions.group_pins(grouped, [1, 2])
    assert len({again.marks[i].group for i in (0, 1)}) == 2
    assert not actions.ungroup_pins(again, range(3)).pins
    with pytest.raises(EditError, match="two pins or more"):
        actions.group_pins(state, [1])


def test_marks_are_mirrored_with_their_pins(state: EditState) -> None:
    marked = actions.mark_pins(state, [0], locked=True)
    mirrored = mirror_pose(marked)
    np.testing.assert_allclose(mirrored.pose.handles[0], [-2, 0], atol=1e-9)
    assert [mark.locked for mark in mirrored.marks] == [True, False, False]


def test_undo_takes_marks_back_and_selecting_selects_the_group() -> None:
    with Deformation(domain("ring"), begin=False) as model:
        model.paused = True
        model.add_handles(POINTS)
        model.group_pins([0, 1])
        model.select([1])
        assert model.selection == (0, 1)
        model.undo()
        assert not model.state.pins
        model.select([1])
        assert model.selection == (1,)


def test_a_file_keeps_marks_and_only_those_of_its_pins(tmp_path: Path) -> None:
    path, plain = tmp_path / "a.glid", document()
    handles = plain.poses[0].pose.handles
    pins = PinMarks().changed(handles[:1], locked=True, hidden=True).grouped(handles)
    pins = pins.changed([(9.0, 9.0)], locked=True)  # of a pin that was removed
    marked = replace(plain, pins=pins)
    save_document(marked, path)
    read = load_document(path).pins
    assert read == pins.only([handles])
    assert read.of(handles) == (PinMark(True, True, 1), PinMark(group=1))
    assert python_code(marked) == python_code(plain)


@pytest.mark.parametrize(
    ("data", "wrong"),
    [
        ({}, "must be a list"),
        ([{"locked": True}], "handle"),
        ([{"handle": [0, "x"]}], "pair"),
        ([{"handle": [0, 0], "locked": 1}], "locked"),
        ([{"handle": [0, 0], "group": -1}], "group"),
        ([{"handle": [0, 0], "shy": True}], "unknown key 'shy'"),
    ],
)
def test_wrong_marks_are_refused(data: object, wrong: str) -> None:
    with pytest.raises(InputFileError, match=wrong):
        PinMarks.from_list(data, "pins")
