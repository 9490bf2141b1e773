"""What pointers and keys mean, without a browser."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from glid_nb.certificate import certify
from glid_nb.geometry import Cage, Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.pose import Stiffness
from glid_nb.session.deformation import Deformation
from glid_nb.solvers import MethodError
from glid_nb.widgets.brush import BrushGestures, painted_areas

from ..support.domains import domain

TIMEOUT = 120.0


class Hand:
    """Sends events as the page does: world units, pixels of 0.02 units."""

    def __init__(self, model: Deformation) -> None:
        self.fitted = 0
        self.gestures = BrushGestures(model, self._fit)
        self.model = model

    def _fit(self) -> None:
        self.fitted += 1

    def send(self, type: str, x: float = 0, y: float = 0, **more: Any) -> str:
        event = {"type": type, "x": x, "y": y, "id": 1, "button": 0, "shift": False}
        return self.gestures.handle([{**event, "reach": 0.26, "unit": 0.02, **more}]) or ""

    def click(self, x: float, y: float, **more: Any) -> str:
        return self.send("down", x, y, **more) or self.send("up", x, y, **more)

    def drag(self, *points: tuple[float, float], **more: Any) -> None:
        self.send("down", *points[0], **more)
        for point in points[1:]:
            self.send("move", *point, **more)
        self.send("up", *points[-1], **more)

    def key(self, key: str, **more: Any) -> str:
        return self.send("key", key=key, **more)


@pytest.fixture
def hand() -> Iterator[Hand]:
    with Deformation(domain("ring"), begin=False) as model:
        model.paused = True  # the gestures need no solver, which compiles first
        yield Hand(model)


def test_a_click_adds_a_handle_below_the_pointer(hand: Hand) -> None:
    assert hand.click(2, 0) == ""
    np.testing.assert_allclose(hand.model.pose.handles, [[2, 0]], atol=1e-9)
    assert hand.model.selection == (0,)
    hand.click(0, 0)  # in the hole: no handle, and nothing is selected any more
    assert len(hand.model.pose) == 1
    assert hand.model.selection == ()


def test_keys_send_selected_handles_back_and_forward(hand: Hand) -> None:
    hand.click(2, 0)
    hand.click(-2, 0)
    for key, depth in (("PageDown", -1), ("[", -2), ("PageUp", -1), ("]", 0), ("PageUp", 1)):
        hand.key(key)
        assert hand.model.pose.depths.tolist() == [0, depth]
    hand.key("undo")
    assert hand.model.pose.depths.tolist() == [0, 0]
    hand.key("redo")
    hand.model.select([])
    hand.key("PageUp")
    assert hand.model.pose.depths.tolist() == [0, 1]


def test_a_brush_paints_and_erases_in_steps_for_undo(hand: Hand) -> None:
    brush, model = hand.gestures.brush, hand.model
    brush.radius, brush.strength = 0.5, 0.6
    assert "no tool 'spray'" in hand.send("tool", name="spray")
    hand.send("tool", name="stiff")
    assert brush.tool == "stiff"
    # Through the ring, its hole and the ring again: no pin, two lines, one step.
    path = [[-2.8, 0.0], [-1.0, 0.05], [2.8, 0.0]]
    hand.send("down", *path[0])
    assert hand.send("up", *path[-1], path=path) == ""
    assert len(model.pose) == 0
    assert len(model.pose.stiffness.strokes) == 2
    assert model.pose.stiffness([[2, 0.4], [-2, -0.4], [2, 0.7], [0, 2]]).tolist() == [
        0.6,
        0.6,
        0,
        0,
    ]
    hand.send("tool", name="erase")
    hand.send("down", 2, 0)
    hand.send("up", 2, 0, path=[[2, 0]])
    assert model.pose.stiffness([[2, 0.4], [-2, 0.4]]).tolist() == [0, 0.6]
    hand.key("undo")
    assert model.pose.stiffness([[2, 0.4], [-2, 0.4]]).tolist() == [0.6, 0.6]
    assert "no shape here" in hand.send("up", 0, 0, path=[[0, 0]])
    hand.key("undo")
    assert not model.pose.stiffness
    hand.key("redo")
    model.set_stiffness(Stiffness())
    assert not model.pose.stiffness
    hand.key("Escape")
    assert brush.tool == ""
    hand.click(2, 0)
    assert len(model.pose) == 1


def test_painting_follows_the_deformed_shape(hand: Hand) -> None:
    ring = domain("ring")
    identity = HarmonicMap.identity(ring)
    phi = identity.phi.copy()
    phi[: len(ring.offset_cage.exterior)] += 10
    aside = HarmonicMap(ring, phi, identity.psi)
    hand.model.apply(lambda state: state.changed(map=aside))
    hand.gestures.brush.tool, hand.gestures.brush.radius = "stiff", 0.3
    hand.send("up", 12, 0, path=[[12, 0]])
    (stroke,) = hand.model.pose.stiffness.strokes
    np.testing.assert_allclose(stroke.points, [[2, 0]] * len(stroke.points), atol=1e-6)
    ((strength, (loop,)),) = painted_areas(hand.model.moment)
    assert strength == 1
    np.testing.assert_allclose(np.linalg.norm(np.array(loop) - [12, 0], axis=1), 0.3, rtol=0.02)


def test_stiff_areas_stay_with_another_outline_and_other_pins(hand: Hand) -> None:
    model = hand.model
    model.add_handle((2, 0))
    model.set_stiffness(Stiffness().painted([[2, 0]], 0.5))
    model.mirror_pose()
    assert model.pose.stiffness([[-2, 0.2], [2, 0.2]]).tolist() == [1, 0]
    model.undo()
    model.set_stiffness(model.pose.stiffness.painted([[-2, 0]], 0.5))
    model.clear_handles()
    model.save_pose()
    cage = model.state.domain.cage
    model.set_domain(Domain.from_cage(Cage(cage.exterior[cage.exterior[:, 0] > -1])))
    assert model.pose.stiffness([[2, 0.2]]).tolist() == [1]
    assert len(model.pose.stiffness.within(model.state.domain.cage)) == 1
    with pytest.raises(MethodError, match="'mls' does not support stiff areas"):
        model.set_method("mls")


@pytest.mark.slow
def test_a_drag_moves_a_target_and_a_trembling_click_does_not(hand: Hand) -> None:
    hand.click(2, 0)
    hand.click(-2, 0)
    hand.drag((2.1, 0), (2.11, 0.01))
    np.testing.assert_allclose(hand.model.pose.targets[0], [2, 0], atol=1e-9)
    steps = len(hand.model.history.past)
    hand.drag((2.1, 0), (2.5, 0), (3.1, 0.4))
    np.testing.assert_allclose(hand.model.pose.targets[0], [3, 0.4], atol=1e-9)
    assert len(hand.model.history.past) == steps + 1
    hand.model.paused = False
    assert hand.model.solve(TIMEOUT)
    assert certify(hand.model.map).certified


def test_a_pull_on_the_shape_takes_the_point_along(hand: Hand) -> None:
    hand.click(-2, 0)
    hand.drag((2, 0), (2.05, 0), (2.6, 0.3))
    np.testing.assert_allclose(hand.model.pose.targets[1], [2.6, 0.3], atol=1e-9)
    np.testing.assert_allclose(hand.model.pose.handles[1], [2, 0], atol=1e-6)


def test_shift_selects_several_that_move_together(hand: Hand) -> None:
    for place in ((2, 0), (-2, 0), (0, 2)):
        hand.click(*place)
    hand.click(2, 0, shift=True)
    assert hand.model.selection == (2, 0)
    hand.drag((0, 2), (0.5, 2.5))
    np.testing.assert_allclose(
        hand.model.pose.targets, [[2.5, 0.5], [-2, 0], [0.5, 2.5]], atol=1e-6
    )
    hand.click(2.5, 0.5, shift=True)
    assert hand.model.selection == (2,)


def test_a_click_on_one_of_several_selected_pins_selects_it_alone(hand: Hand) -> None:
    model = hand.model
    for place in ((2, 0), (-2, 0), (0, 2)):
        hand.click(*place)
    model.select([0, 1, 2])
    hand.click(-2, 0)
    assert model.selection == (1,)
    model.mark_pins([2], locked=True)
    model.select([0, 1, 2])
    hand.click(0, 2)
    assert model.selection == (2,)
    # Those of its group stay with it.
    model.group_pins([0, 1])
    model.select([0, 1, 2])
    hand.click(2, 0)
    assert model.selection == (1, 0)  # the pressed one is shown


def test_a_drag_with_shift_moves_the_pin_and_selects_no_other(hand: Hand) -> None:
    for place in ((2, 0), (-2, 0), (0, 2)):
        hand.click(*place)
    hand.drag((2, 0), (2.5, 0), shift=True)  # the page keeps it on an axis
    assert hand.model.selection == (0,)
    np.testing.assert_allclose(hand.model.pose.targets, [[2.5, 0], [-2, 0], [0, 2]], atol=1e-6)
    hand.click(0, 2, shift=True)
    hand.drag((0, 2), (0, 2.5), shift=True)  # those that are selected move together
    assert hand.model.selection == (0, 2)
    np.testing.assert_allclose(hand.model.pose.targets, [[2.5, 0.5], [-2, 0], [0, 2.5]], atol=1e-6)


@pytest.mark.slow
def test_shift_turns_the_ring_to_multiples_of_15_degrees(hand: Hand) -> None:
    hand.click(2, 0)
    hand.drag((3, 0), (2, 1), (1, 0.01), part="turn")
    hand.drag((3, 0), (2.95, -0.3), (2.9, -0.4), part="turn", shift=True)
    # By 24 degrees less than nearly 180.
    np.testing.assert_allclose(np.degrees(hand.model.pose.angles), [150])


@pytest.mark.slow
def test_the_ring_turns_and_scales_in_one_step_each(hand: Hand) -> None:
    model = hand.model
    hand.click(2, 0)
    hand.drag((3, 0), (2, 1), (1, 0.001), part="turn")
    np.testing.assert_allclose(model.pose.angles, [np.pi - 0.001], atol=1e-6)
    assert np.isnan(model.pose.scales).all()
    hand.drag((2, 1), (2, 2), (2, 1.5), part="knob")
    np.testing.assert_allclose(model.pose.scales, [1.5])
    np.testing.assert_allclose(model.pose.angles, [np.pi - 0.001], atol=1e-6)
    np.testing.assert_allclose(model.pose.targets, [[2, 0]], atol=1e-9)
    hand.click(3, 0, part="turn")  # nothing is pinned on the ring, nothing moves
    assert len(model.pose) == 1
    hand.drag((3, 0), (2, 1), (3, 0), part="turn")  # and back
    model.undo()
    assert np.isnan(model.pose.scales).all()
    model.undo()
    assert not model.pose.oriented.any()
    model.undo()
    assert not len(model.pose)


@pytest.mark.slow
def test_one_knob_turns_and_scales_and_alt_turns_a_pin(hand: Hand) -> None:
    model = hand.model
    hand.click(2, 0)
    hand.drag((3, 0), (2, 1.02), part="knob")  # nearly a circle
    np.testing.assert_allclose(model.pose.angles, [np.pi / 2])
    assert np.isnan(model.pose.scales).all()
    hand.drag((3, 0), (2, 2), part="knob")
    np.testing.assert_allclose(model.pose.angles, [np.pi])
    np.testing.assert_allclose(model.pose.scales, [2])
    # From the pin itself: its first direction is where the turn begins.
    hand.drag((2, 0), (2.5, 0), (2, 1), alt=True)
    np.testing.assert_allclose(abs(model.pose.angles), [np.pi / 2])
    np.testing.assert_allclose(model.pose.targets, [[2, 0]], atol=1e-9)


def test_a_method_on_a_mesh_refuses_the_ring(hand: Hand) -> None:
    hand.click(2, 0)
    hand.model.set_method("mls")
    hand.send("down", 3, 0, part="turn")
    assert "cannot hold the angle" in hand.send("move", 2, 1, part="turn")
    assert hand.model.dragged == ()


def test_keys_turn_scale_and_set_free(hand: Hand) -> None:
    hand.click(2, 0)
    for key in "<<+-":
        assert hand.key(key) == ""
    np.testing.assert_allclose(hand.model.pose.angles, [np.radians(10)])
    np.testing.assert_allclose(hand.model.pose.scales, [1])
    hand.key("x")
    assert not hand.model.pose.oriented.any()
    hand.key("Escape")
    before = hand.model.state
    assert hand.key("<") == hand.key("+") == hand.key("x") == ""
    assert hand.model.state is before


def test_a_box_or_a_lasso_selects(hand: Hand) -> None:
    for x in (2, -2):
        hand.click(x, 0)
    hand.key("Escape")
    loop = [[1, -1], [3, -1], [3, 1], [1, 1]]
    hand.send("down", 1, -1, shift=True)
    hand.send("up", 3, 1, shift=True, path=loop, encloses=True)
    assert hand.model.selection == (0,)
    hand.send("down", -1, -1)
    lasso = [[-1, -1], [-3, -1], [-3, 2], [-1.1, -1]]
    hand.send("up", -1, -1, path=lasso, encloses=True)
    assert hand.model.selection == (0, 1)
    assert len(hand.model.pose) == 2
    hand.send("down", 1, -1)
    hand.send("up", 1, -1, path=[[0, 0]] * 2)  # trembling
    assert len(hand.model.pose) <= 3


def test_poses_travel_as_text_and_are_mirrored(hand: Hand) -> None:
    model, texts = hand.model, list[str]()
    hand.gestures.copy = texts.append
    model.add_handles([(2, 0.5), (-2, 0)], [(2.5, 1), (-2, 0)])
    model.set_pins([0], angles=0.5, weights=0.1)
    assert hand.key("copy") == ""
    assert hand.key("m") == ""
    np.testing.assert_allclose(model.pose.handles, [[-2, 0.5], [2, 0]], atol=1e-9)
    np.testing.assert_allclose(model.pose.targets, [[-2.5, 1], [2, 0]], atol=1e-9)
    np.testing.assert_allclose(model.pose.angles, [-0.5, np.nan])
    assert hand.send("paste_pose", text=texts[0]) == ""
    np.testing.assert_array_equal(model.pose.targets, [[2.5, 1], [-2, 0]])
    assert model.pose.weights.tolist() == [0.1, 1]
    model.undo()
    model.undo()
    assert model.pose.angles[0] == 0.5
    for wrong in ("hello", "[1]", '{"handles": [[0, 0]]}', '{"handles": [], "targets": 3}'):
        assert "holds no pose" in hand.send("paste_pose", text=wrong)


@pytest.mark.slow
def test_escape_and_undo_take_a_drag_back(hand: Hand) -> None:
    hand.click(2, 0)
    hand.model.paused = False
    assert hand.model.solve(TIMEOUT)
    before = hand.model.state
    for key in ("Escape", "undo"):
        hand.send("down", 2, 0)
        hand.send("move", 3, 0)
        hand.key(key)
        assert hand.model.state is before
        hand.send("move", 3.5, 0)
        hand.send("up", 3.5, 0)
        assert hand.model.state is before


def test_the_right_button_selects_what_its_menu_is_about(hand: Hand) -> None:
    for place in ((2, 0), (-2, 0), (0, 2)):
        hand.click(*place)
    hand.click(-2, 0, button=2)
    assert hand.model.selection == (1,)
    hand.click(0, 2, shift=True)
    hand.click(-2, 0, button=2)  # all that are selected stay so
    assert hand.model.selection == (1, 2)
    hand.click(0, -2, button=2)
    assert hand.model.selection == (1, 2)
    hand.send("pin", 0, -2)
    np.testing.assert_allclose(hand.model.pose.handles[3], [0, -2], atol=1e-9)
    assert hand.model.selection == (3,)
    assert "no shape here" in (hand.send("pin", 9, 9) or "")


def three_pins(hand: Hand) -> Deformation:
    for x, y in ((2, 0), (-2, 0), (0, 2)):
        hand.click(x, y)
    return hand.model


def test_a_locked_pin_is_not_moved_by_the_hand(hand: Hand) -> None:
    model = three_pins(hand)
    before = model.pose.targets.copy()
    hand.key("l")
    assert [mark.locked for mark in model.state.marks] == [False, False, True]
    assert hand.send("down", 0, 2) == ""
    assert hand.send("move", 0, 2.5) == ""
    assert hand.send("up", 0, 2.5) == "pin 3 is locked; unlock it first (L)"
    assert model.selection == (2,)  # but it can be selected
    for key in ("ArrowUp", ">", "x", "Delete"):
        assert "locked" in hand.key(key)
    assert hand.send("down", 0.8, 2, part="turn") == "pin 3 is locked; unlock it first (L)"
    hand.send("up", 0.8, 2)
    np.testing.assert_array_equal(model.pose.targets, before)

    # Selected with others, it stays where it is and they move.
    hand.key("a")
    hand.drag((2, 0), (2.2, 0), (2.5, 0))
    np.testing.assert_allclose(model.pose.targets - before, [[0.5, 0], [0.5, 0], [0, 0]], atol=1e-9)
    hand.key("Delete")
    np.testing.assert_allclose(model.pose.handles, [[0, 2]], atol=1e-9)
    model.select([0])
    hand.key("L")
    hand.drag((0, 2), (0, 2.5))
    np.testing.assert_allclose(model.pose.targets, [[0, 2.5]], atol=1e-9)


def test_a_hidden_pin_is_neither_hit_nor_chosen(hand: Hand) -> None:
    model = three_pins(hand)
    hand.key("h")
    hidden = [mark.hidden for mark in model.state.marks]
    assert hidden == [False, False, True]
    assert hand.gestures.hit(np.array([0.0, 2.0]), 0.26) is None
    hand.key("a")
    assert model.selection == (0, 1)
    hand.key("Escape")
    seen = []
    for _ in range(3):
        hand.key(".")
        seen += model.selection
    assert seen == [0, 1, 0]
    hand.key("Escape")
    box = [(-3, -3), (3, -3), (3, 3), (-3, 3)]
    hand.send("up", path=box, encloses="box")
    assert model.selection == (0, 1)
    hand.key("h", shift=True)
    assert hand.gestures.hit(np.array([0.0, 2.0]), 0.26) == 2


def test_a_group_is_selected_and_moved_together(hand: Hand) -> None:
    model = three_pins(hand)
    model.select([0, 2])
    hand.key("g")
    hand.key("Escape")
    before = model.pose.targets.copy()
    hand.drag((2, 0), (2.2, 0.2), (2.5, 0.5))
    assert model.selection == (2, 0)
    moved = [[0.5, 0.5], [0, 0], [0.5, 0.5]]
    np.testing.assert_allclose(model.pose.targets - before, moved, atol=1e-9)

    # Shift and a click take the whole group out of the selection.
    hand.key("a")
    hand.click(2.5, 0.5, shift=True)
    assert model.selection == (1,)
    hand.click(2.5, 0.5)
    hand.key("g", shift=True)
    hand.key("Escape")
    hand.click(0.5, 2.5)
    assert model.selection == (2,)


def test_removing_by_key(hand: Hand) -> None:
    for place in ((2, 0), (-2, 0), (0, 2)):
        hand.click(*place)
    # With Shift the shape is kept, which it can be at rest only.
    assert "still moving" in hand.key("Delete", shift=True)
    assert len(hand.model.pose) == 3
    hand.key("a")
    hand.key("Delete")
    assert len(hand.model.pose) == 0
    hand.key("undo")
    assert len(hand.model.pose) == 3


def test_arrows_nudge_or_move_the_cursor(hand: Hand) -> None:
    hand.key("Enter", x=2.0, y=0.0)
    assert hand.gestures.cursor == [2.0, 0.0]
    hand.key("ArrowUp")
    assert hand.gestures.cursor == pytest.approx([2.0, 0.12])
    hand.key("Enter")
    assert hand.model.selection == (0,)
    assert hand.gestures.cursor is None
    hand.key("ArrowRight")
    np.testing.assert_allclose(hand.model.pose.targets, [[2.1, 0.12]], atol=1e-9)
    hand.key("Escape")
    assert hand.model.selection == ()
    hand.key(".")
    assert hand.model.selection == (0,)
    hand.key("0")
    np.testing.assert_allclose(hand.model.pose.targets, hand.model.pose.handles)
    hand.key("f")
    assert hand.fitted == 1


def test_a_refusal_is_told_and_changes_nothing(hand: Hand) -> None:
    hand.key("Enter", x=0.0, y=0.0)
    assert "no shape here" in hand.key("Enter")
    assert len(hand.model.pose) == 0
    assert hand.key("Escape") == ""


def test_an_event_after_its_handle_went_is_harmless(hand: Hand) -> None:
    hand.click(2, 0)
    hand.send("down", 2, 0)
    hand.send("move", 2.5, 0)
    hand.model.clear_handles()
    hand.send("move", 3, 0)
    hand.send("up", 3, 0)
    assert len(hand.model.pose) == 0
    assert not hand.model.dragged
