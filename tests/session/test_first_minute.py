"""One hint at a time, until its step was made."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from glid_nb.session import actions
from glid_nb.session.edit_state import EditState
from glid_nb.session.first_minute import HINTS, FirstMinute, steps_in

from ..support.domains import domain

STEPS: dict[str, Callable[[EditState], EditState]] = {
    "pin": lambda state: actions.add_handles(state, [(2, 0)]),
    "drag": lambda state: actions.move_target(state, 0, (2.5, 0)),
    "turn": lambda state: actions.turn(state, [0], 0.3),
    "keep": actions.save_pose,
}


@pytest.fixture
def state() -> EditState:
    return EditState.initial(domain("ring"))


def test_each_step_brings_the_next_hint(state: EditState) -> None:
    first_minute = FirstMinute()
    for step, make in STEPS.items():
        assert first_minute.hint(state) == HINTS[step]
        assert step not in steps_in(state)
        state = make(state)
        assert step in steps_in(state)
    assert first_minute.hint(state) == HINTS["play"]
    first_minute.made("play")
    assert first_minute.hint(state) == ""


def test_what_was_done_once_is_never_told_again(state: EditState) -> None:
    first_minute = FirstMinute()
    pinned = STEPS["drag"](STEPS["pin"](state))
    assert first_minute.hint(pinned) == HINTS["turn"]
    assert first_minute.hint(state) == HINTS["turn"]  # all pins were removed, or another editor
    first_minute.made("turn", "keep")  # in another order
    assert first_minute.hint(state) == HINTS["play"]
    assert FirstMinute().hint(state) == HINTS["pin"]
