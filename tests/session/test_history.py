"""Undo and redo as a value."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from glid_nb.session.model import MOST_STEPS, History


def test_undo_and_redo_walk_back_and_forth() -> None:
    history = History("a").step("b").step("c")
    assert history.undone().present == "b"
    assert history.undone().undone().present == "a"
    assert history.undone().undone().undone().present == "a"
    assert history.undone().redone().present == "c"
    assert history.redone() is history


def test_a_step_forgets_what_was_undone() -> None:
    history = History("a").step("b").undone().step("c")
    assert history.future == ()
    assert history.undone().present == "a"


def test_many_small_steps_count_as_one() -> None:
    history = History("a").step("a1", gesture=7).amended("a2").step("b", gesture=7)
    assert history.past == ("a",)
    assert history.undone().present == "a"
    for other in (history.step("c", gesture=8), history.ended().step("c", gesture=7)):
        assert other.past == ("a", "b")


def test_a_gesture_that_is_cancelled_never_began() -> None:
    before = History("a").step("b").undone()
    going = before.step("a1", gesture=7).step("a2", gesture=7)
    assert going.cancelled().present == "a"
    assert going.cancelled().redone().present == "b"
    assert going.ended().cancelled().present == "a2"


def test_the_past_is_limited() -> None:
    history = History(0)
    for i in range(1, MOST_STEPS + 50):
        history = history.step(i)
    assert len(history.past) == MOST_STEPS
    assert history.past[-1] == history.present - 1


@given(st.lists(st.sampled_from(["step", "undo", "redo"])))
def test_the_states_stay_in_order(moves: list[str]) -> None:
    history, count = History(0), 0
    for move in moves:
        if move == "step":
            count += 1
            history = history.step(count)
        else:
            history = history.undone() if move == "undo" else history.redone()
        timeline = [*history.past, history.present, *history.future]
        assert timeline == sorted(set(timeline))
