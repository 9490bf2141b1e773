"""What pointers and keys on the tracer mean, without a browser."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import shapely
import skimage.data

from glid_nb.session.tracing import TracingModel
from glid_nb.widgets.tracer_gestures import TraceGestures

from ..support.drawing import DRAWING, IN_LARGE_HOLE, IN_SMALL_DISC, far_vertex


class Hand:
    """Sends events as the page does, in pixels of the picture. A screen pixel is half of one."""

    def __init__(self, model: TracingModel) -> None:
        self.model, self.gestures = model, TraceGestures(model)
        self.time = 0.0

    def send(self, kind: str, x: float = 0, y: float = 0, **more: Any) -> str | None:
        self.time += 1000
        event = {"type": kind, "x": x, "y": y, "button": 0, "shift": False, "time": self.time}
        return self.gestures.handle([{**event, "reach": 4.5, "unit": 0.5, **more}])

    def click(self, x: float, y: float, **more: Any) -> str | None:
        return self.send("down", x, y, **more) or self.send("up", x, y, **more)

    def key(self, key: str, **more: Any) -> str | None:
        return self.send("key", key=key, **more)

    def vertex(self, index: int, loop: int = 0) -> Any:
        return self.model.loops[loop][index]


@pytest.fixture
def hand() -> Hand:
    return Hand(TracingModel(DRAWING))


def test_a_photograph_begins_with_the_brush_and_its_guess_is_not_hit() -> None:
    model = TracingModel(skimage.data.cat())
    hand = Hand(model)
    middle = np.array([200.0, 150.0])
    hand.gestures.begin()
    assert hand.gestures.tool == "foreground"
    hand.key("Escape")
    assert hand.gestures.tool == "edit"
    found = hand.gestures.find(middle, 500.0)
    assert (found.vertex, found.edge, found.hole) == (None, False, None)
    hand.key("]")
    assert hand.gestures.selected == ()
    hand.send("accept_guess")
    assert hand.gestures.find(middle, 500.0).vertex is not None

    clear = Hand(TracingModel(DRAWING))
    clear.gestures.begin()
    assert clear.gestures.tool == "edit"


def test_a_drag_takes_the_vertex_along_as_one_step(hand: Hand) -> None:
    model, before = hand.model, hand.model.state
    i = far_vertex(model)
    x, y = hand.vertex(i)
    hand.send("down", x + 1, y)
    assert hand.gestures.selected == ((0, i),)
    hand.send("move", x + 2, y)  # a trembling hand
    assert model.state is before
    for k in range(3, 9):
        hand.send("move", x - k, y + 1)
    hand.send("up", x - 8, y + 1)
    np.testing.assert_allclose(hand.vertex(i), [x - 9, y + 1])
    hand.key("undo")
    assert model.state is before


@pytest.mark.parametrize("how", ["Escape", "undo", "cancel"])
def test_a_drag_that_is_cancelled_never_was(hand: Hand, how: str) -> None:
    model = hand.model
    model.set_options(offset=6)
    model.undo()
    before, i = model.state, far_vertex(model)
    x, y = hand.vertex(i)
    hand.send("down", x, y)
    hand.send("move", x - 9, y)
    assert model.state is not before
    hand.send("cancel") if how == "cancel" else hand.key(how)
    assert model.state is before
    hand.send("move", x - 12, y)
    hand.send("up", x - 12, y)
    assert model.state is before
    assert not model.can_undo
    assert model.redo()  # even the undone steps are still there
    assert model.options.offset == 6


def test_escape_takes_nothing_back_that_is_over(hand: Hand) -> None:
    i = far_vertex(hand.model)
    x, y = hand.vertex(i)
    hand.send("down", x, y)
    hand.send("move", x - 9, y)
    hand.send("up", x - 9, y)
    after = hand.model.state
    hand.key("Escape")
    assert hand.model.state is after
    assert hand.gestures.selected == ()
    # Neither a click on a vertex nor Escape while it is pressed leaves anything to take back.
    hand.send("down", *hand.vertex(i))
    hand.key("Escape")
    assert hand.model.state is after


def test_shift_selects_several_that_a_key_deletes(hand: Hand) -> None:
    n = len(hand.model.loops[0])
    hand.click(*hand.vertex(0))
    hand.click(*hand.vertex(2), shift=True)
    hand.click(*hand.vertex(4), shift=True)
    hand.click(*hand.vertex(2), shift=True)
    assert hand.gestures.selected == ((0, 0), (0, 4))
    hand.key("Delete")
    assert len(hand.model.loops[0]) == n - 2
    assert hand.gestures.selected == ()


def test_the_right_button_deletes(hand: Hand) -> None:
    n = len(hand.model.loops[0])
    hand.send("down", *hand.vertex(0), button=2)
    assert len(hand.model.loops[0]) == n - 1


def test_a_double_click_adds_a_vertex_and_two_clicks_do_not(hand: Hand) -> None:
    n = len(hand.model.loops[0])
    middle = hand.model.loops[0][:2].mean(axis=0)
    for time in (0, 500, 800):
        hand.click(*middle, time=time, reach=1.0)
        assert len(hand.model.loops[0]) == n + (time == 800)


def test_a_click_drops_a_hole_and_a_moved_view_does_not(hand: Hand) -> None:
    hand.send("down", *IN_LARGE_HOLE)
    hand.send("cancel")  # the page moves its view
    hand.send("up", *IN_LARGE_HOLE)
    assert hand.model.holes[0].kept
    hand.click(*IN_LARGE_HOLE)
    assert not hand.model.holes[0].kept
    hand.click(*IN_LARGE_HOLE)
    assert hand.model.holes[0].kept


def test_arrows_nudge_and_soon_after_one_another_are_one_step(hand: Hand) -> None:
    i = far_vertex(hand.model)
    x, y = hand.vertex(i)
    hand.click(x, y)
    before = hand.model.state
    hand.key("ArrowLeft", time=1e6)
    hand.key("ArrowUp", time=1e6 + 100, shift=True)
    np.testing.assert_allclose(hand.vertex(i), [x - 1, y - 10])
    hand.key("ArrowLeft", time=1e6 + 2000)
    hand.key("undo")
    np.testing.assert_allclose(hand.vertex(i), [x - 1, y - 10])
    hand.key("undo")
    assert hand.model.state is before


def test_brackets_walk_through_the_vertices(hand: Hand) -> None:
    last = len(hand.model.loops) - 1
    hand.key("[")
    assert hand.gestures.selected == ((last, len(hand.model.loops[last]) - 1),)
    hand.key("]")
    assert hand.gestures.selected == ((0, 0),)
    hand.key("]")
    assert hand.gestures.selected == ((0, 1),)


def test_tools(hand: Hand) -> None:
    hand.send("tool", name="component")
    assert hand.gestures.tool == "component"
    hand.click(*IN_SMALL_DISC)
    assert hand.gestures.tool == "edit"
    assert hand.model.outcome.tracing is not None
    assert hand.model.outcome.tracing.component.rank == 1
    hand.model.undo()
    hand.send("tool", name="foreground")
    hand.send("down", 60, 20)
    hand.send("up", 60, 100, path=[[60, 20], [60, 60], [60, 100]])
    scribbles = hand.model.state.scribbles
    assert scribbles is not None
    assert len(scribbles.foreground[0]) == 3
    hand.send("down", 60, 20)
    hand.key("Escape")  # the stroke, but not the tool
    hand.send("up", 60, 100, path=[[60, 20], [60, 100]])
    assert hand.model.state.scribbles is scribbles
    assert hand.gestures.tool == "foreground"
    hand.key("Escape")
    assert hand.gestures.tool == "edit"


def test_a_refusal_is_told_in_plain_words(hand: Hand) -> None:
    hand.send("tool", name="color")
    assert hand.click(-5, 0) == "That place lies outside the picture"
    assert hand.gestures.handle([{"type": "format_disk"}]) is not None


def test_a_polygon_is_drawn_corner_by_corner(hand: Hand) -> None:
    hand.send("tool", name="polygon")
    for corner in ((20, 20), (140, 20), (140, 100), (150, 110)):
        hand.click(*corner)
    hand.key("undo")
    assert hand.gestures.corners == ((20, 20), (140, 20), (140, 100))
    assert not hand.model.edited
    hand.click(21, 21)  # the first corner again
    assert (hand.gestures.corners, hand.gestures.tool) == ((), "edit")
    np.testing.assert_allclose(hand.model.loops[0].min(axis=0), 20)
    np.testing.assert_allclose(hand.model.loops[0].max(axis=0), [140, 100])


@pytest.mark.parametrize("how", ["Enter", "twice", "freehand", "rectangle"])
def test_other_ways_to_draw_an_outline(hand: Hand, how: str) -> None:
    hand.send("tool", name="rectangle" if how == "rectangle" else "polygon")
    path = [(20.0, 20.0), (140.0, 20.0), (140.0, 100.0), (20.0, 100.0)]
    if how == "rectangle":
        hand.send("down", 20, 20)
        hand.send("up", 140, 100, path=[path[0], path[2]])
    elif how == "freehand":
        hand.send("down", 20, 20)
        hand.send("up", 20, 100, path=path)
    else:
        for corner in path:
            hand.click(*corner)
        hand.key("Enter") if how == "Enter" else hand.click(*path[-1])
    np.testing.assert_allclose(hand.model.loops[0].max(axis=0), [140, 100])
    assert len(hand.model.loops) == 1


def test_escape_gives_a_polygon_up_and_too_few_corners_are_refused(hand: Hand) -> None:
    hand.send("tool", name="polygon")
    hand.click(20, 20)
    hand.key("Escape")
    assert (hand.gestures.corners, hand.gestures.tool) == ((), "polygon")
    hand.click(20, 20)
    assert "encloses nothing" in str(hand.key("Enter"))
    assert not hand.model.edited


@pytest.mark.parametrize("what", ["hole", "outline", "", "Escape", "undo"])
def test_an_outline_inside_the_shape_is_a_hole_or_a_new_one(hand: Hand, what: str) -> None:
    model, before = hand.model, hand.model.state
    count = len(model.loops)
    middle = shapely.Polygon(model.loops[0], model.loops[1:]).buffer(-12).representative_point()
    x, y = middle.x, middle.y
    hand.send("tool", name="rectangle")
    hand.send("down", x - 8, y - 8)
    hand.send("up", x + 8, y + 8)
    assert model.state is before  # nothing yet: the page asks
    assert len(hand.gestures.inside) == 4
    if what in ("Escape", "undo"):
        hand.key(what)
    else:
        hand.send("drawn_as", what=what)
    assert hand.gestures.inside == []
    if what == "hole":
        assert len(model.loops) == count + 1
        assert not model.outcome.problems
        np.testing.assert_allclose(model.loops[-1].max(axis=0), [x + 8, y + 8])
    elif what == "outline":
        assert len(model.loops) == 1
        np.testing.assert_allclose(model.loops[0].max(axis=0), [x + 8, y + 8])
    else:
        assert model.state is before


def cut(hand: Hand, *path: tuple[float, float]) -> str | None:
    return hand.send("down", *path[0]) or hand.send("up", *path[-1], path=path)


def test_the_knife_cuts_along_its_path_and_stays_in_the_hand(hand: Hand) -> None:
    model, before = hand.model, hand.model.state
    hand.send("tool", name="knife")
    assert cut(hand, (60, 5), (61, 50), (60, 100)) is None
    assert hand.gestures.tool == "knife"
    assert hand.gestures.cut is not None
    assert not hand.gestures.cut.in_middle
    assert len(hand.gestures.cut.pieces) == 1
    first = model.state
    assert cut(hand, (30, 90), (50, 95)) is None
    assert hand.gestures.cut.in_middle
    hand.key("undo")
    assert model.state is first
    assert hand.gestures.cut is None  # what it said is over
    hand.key("undo")
    assert model.state is before
    hand.key("Escape")
    assert hand.gestures.tool == "edit"


def test_the_knife_has_a_width(hand: Hand) -> None:
    model = hand.model
    hand.send("tool", name="knife")
    line, lost = ((60, 5), (61, 50), (60, 100)), []
    for width in (None, 2.0, 6.0):
        assert hand.send("knife", width=width) is None
        assert hand.gestures.knife_width == width
        assert model.cage is not None
        before = model.cage.area
        assert cut(hand, *line) is None
        by_hand = model.cage
        lost.append(before - by_hand.area)
        hand.key("undo")
        assert model.cut(line, width)[0].equals(by_hand)
        hand.key("undo")
    assert 0 < lost[0] < lost[1] < lost[2]
    for wrong in (0, -1, np.inf):
        assert "above 0 pixels" in str(hand.send("knife", width=wrong))
    assert hand.gestures.knife_width == 6.0


def test_another_piece_of_the_cut_can_be_kept_in_the_same_step(hand: Hand) -> None:
    model, before = hand.model, hand.model.state
    hand.send("tool", name="knife")
    cut(hand, (95, 0), (95, 120))
    assert hand.gestures.cut is not None
    large, small = hand.gestures.cut.pieces
    assert (hand.gestures.cut.kept, model.cage.n_vertices) == (0, large.n_vertices)
    assert hand.send("keep_piece", number=1) is None
    assert hand.gestures.cut.kept == 1
    assert model.cage.equals(small)
    assert "no such piece" in str(hand.send("keep_piece", number=2))
    hand.send("keep_piece", number=0)
    assert model.cage.equals(large)
    hand.key("undo")
    assert model.state is before
    assert "no such piece" in str(hand.send("keep_piece", number=0))
    hand.key("redo")
    assert model.cage.equals(large)


@pytest.mark.parametrize("how", ["Escape", "cancel"])
def test_a_cut_that_is_cancelled_never_was(hand: Hand, how: str) -> None:
    before = hand.model.state
    hand.send("tool", name="knife")
    hand.send("down", 60, 5)
    hand.send("cancel") if how == "cancel" else hand.key(how)
    hand.send("up", 60, 100, path=[(60, 5), (60, 100)])
    assert hand.model.state is before
    assert hand.gestures.tool == "knife"


def test_a_cut_that_is_refused_says_why(hand: Hand) -> None:
    before = hand.model.state
    hand.send("tool", name="knife")
    assert cut(hand, (150, 5), (155, 5)) == (
        "The cut misses the shape; draw it across the part that should come loose"
    )
    assert "two different points" in str(hand.click(60, 60))
    assert "crosses itself" in str(cut(hand, (10, 60), (60, 90), (60, 20), (30, 95)))
    assert hand.model.state is before
