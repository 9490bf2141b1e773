"""The timeline's side in the kernel: what the page gets, and what its events do."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from glid_nb.geometry import Domain
from glid_nb.imaging import trace
from glid_nb.widgets import DeformCanvas, TimelinePanel, timeline

from ..support import from_page

pytestmark = pytest.mark.slow

TIMEOUT = 60.0
Y, X = np.mgrid[:40, :60]
PICTURE = np.zeros((40, 60, 4), np.uint8)
PICTURE[(abs(X - 30) < 25) & (abs(Y - 20) < 12)] = 200


@pytest.fixture(params=["shader", "kernel"])
def panel(request: pytest.FixtureRequest) -> Iterator[TimelinePanel]:
    domain = Domain.from_cage(trace(PICTURE).cage)
    canvas = DeformCanvas(PICTURE, domain, n_vertices=80, evaluated_in=request.param)
    canvas.pane.stage.drawn = True  # a page has drawn it
    panel = TimelinePanel(canvas)
    yield panel
    panel.close()
    canvas.close()


def act(panel: TimelinePanel, kind: str, **content: Any) -> str | None:
    """Send an event; the refusal."""
    answers: list[dict[str, Any]] = []
    panel.send = lambda answer, buffers=None: answers.append(answer)  # noqa: ARG005
    from_page.send(panel, {"view": "page", "events": [{"type": kind, "seq": 1, **content}]})
    del panel.send
    (refusal,) = [answer["refusal"] for answer in answers if "ack" in answer]
    return refusal


def test_the_page_is_given_what_is_proved_and_its_events_act(panel: TimelinePanel) -> None:
    canvas, model = panel.canvas, panel.canvas.deformation
    first = model.add_handle((-6, 0))
    model.add_handle((6, 0))
    assert act(panel, "keep", time=0) is None
    model.drag(first, (-6, 1.5))
    assert panel.animation.wait(TIMEOUT)
    panel.worker.wait(TIMEOUT)
    (span,) = panel.motion["spans"]
    assert span["status"] == "proved"
    assert len(span["sigma2"]) == len(span["times"]) - 1
    assert [key["name"] for key in panel.shown["keyframes"]] == ["Pose 1", "Pose 2"]
    pictures = [panel.thumbnails[key["thumbnail"]] for key in panel.shown["keyframes"]]
    assert pictures[0] != pictures[1]
    scene = canvas.pane.scene
    if panel.shown["kernel"]:
        assert span["floats"] == b""
        middle = panel.animation.at(0.5)
        act(panel, "frame", time=0.5)
        assert canvas.pane.scene.map is middle or np.array_equal(scene.map.phi, middle.phi)  # type: ignore[union-attr]
        assert canvas.pane.stage.marks["targets"] == []
        act(panel, "frame", time=None)
        assert scene.map is model.map
    else:
        ends = (pose.map for pose in model.state.poses)
        wires = [scene.shader_map.wire(map) for map in ends]
        assert span["floats"].startswith(wires[0])
        assert span["floats"].endswith(wires[1])

    assert act(panel, "rename_pose", index=1, name="up") is None
    assert "200 characters" in str(act(panel, "rename_pose", index=1, name="x" * 300))
    act(panel, "move_pose", index=1, time=2.5)
    act(panel, "set_easing", index=0, easing="in")
    act(panel, "play_all", repeat="loop")
    assert "repeat is 'often'" in str(act(panel, "play_all", repeat="often"))
    act(panel, "record", on=True)
    act(panel, "onion", on=True)
    assert [(k["name"], k["time"], k["easing"]) for k in panel.shown["keyframes"]] == [
        ("Pose 1", 0, "in"),
        ("up", 2.5, "linear"),
    ]
    assert {k: panel.shown[k] for k in ("repeat", "back", "recording", "onion", "active")} == {
        **{"repeat": "loop", "back": 2.5, "recording": True, "onion": True, "active": 1}
    }
    (_, (outline,)) = canvas.pane.stage.onion[0]
    assert [color for color, _ in canvas.pane.stage.onion] == ["#0072b2", "#e69f00"]  # a loop's
    assert len(outline) > 20
    act(panel, "delete_pose", index=0)
    assert "cannot be deleted" in str(act(panel, "delete_pose", index=0))
    for _ in range(5):
        act(panel, "undo")
    assert [k["name"] for k in panel.shown["keyframes"]] == ["Pose 1", "Pose 2"]
    assert "which this canvas cannot do" in str(act(panel, "close"))


def test_a_drag_between_keyframes_makes_one_and_goes_on(panel: TimelinePanel) -> None:
    canvas, model = panel.canvas, panel.canvas.deformation
    model.add_handle((-6, 0))
    act(panel, "keep", time=0)
    model.drag(0, (-6, 2))
    assert panel.animation.wait(TIMEOUT)
    model.go_to_pose(0)
    assert panel.animation.wait(TIMEOUT)  # it was kept before it was solved

    def press(kind: str, x: float, y: float, **more: Any) -> str | None:
        event = {"type": kind, "x": x, "y": y, "button": 0, "shift": False}
        return canvas.handle([{**event, "reach": 0.3, "unit": 0.05, **more}])

    steps = len(model.history.past)
    press("down", 0, 9, at=0.5)  # beside the shape
    press("move", 0, 8)
    press("up", 0, 8)
    press("down", 0, 0, at=0.5)  # a click goes back to the edited pose, which the page does
    press("up", 0, 0)
    assert len(model.history.past) == steps
    between = panel.animation.at(0.5)
    assert between is not None
    place = between([[-6, 0]])[0]
    beside = np.add(place, [1, 0])
    press("down", *place, at=0.5)
    press("move", *beside)
    press("up", *beside)
    assert model.state.timeline.times == (0.0, 0.5, 1.0)
    assert model.state.active == 1
    np.testing.assert_allclose(model.pose.targets, [beside])
    press("down", *place, at=1.0)  # on a keyframe: that one is edited
    press("move", *beside)
    press("up", *beside)
    assert (model.state.active, len(model.state.poses)) == (2, 3)
    while len(model.history.past) > steps:
        model.undo()
    assert model.state.timeline.times == (0.0, 1.0)


def test_pins_are_told_for_every_time_as_a_drag_there_takes_them(panel: TimelinePanel) -> None:
    canvas, model = panel.canvas, panel.canvas.deformation
    for x in (-6.0, 6.0, 0.0):
        model.add_handle((x, 0.0))
    act(panel, "keep", time=0)
    model.drag(1, (6, 2))
    act(panel, "set_easing", index=0, easing="in-out")
    model.mark_pins([0], locked=True)
    model.mark_pins([2], hidden=True)
    assert panel.animation.wait(TIMEOUT)

    pins: dict[str, Any] = panel.pins  # type: ignore[assignment]
    (span,) = pins["spans"]
    knots = span["times"]
    assert len(knots) > 2
    assert (span["end"], span["locked"]) == (1.0, [0])
    floats = np.frombuffer(span["floats"], np.float32).reshape(len(knots), 3, 2)
    assert np.isnan(floats[:, 2]).all()
    for time in (0.1, 0.5, 0.77):
        mixed = [np.interp(time, knots, floats[:, i, j]) for i in (0, 1) for j in (0, 1)]
        here = panel.animation.pins(time)
        np.testing.assert_allclose(mixed, here[:2].ravel(), atol=1e-5)
        assert np.isnan(here[2]).all()
        map_ = panel.animation.at(time)
        assert map_ is not None
        np.testing.assert_allclose(here[:2], map_(model.pose.handles[:2]))
    assert pins["keyframes"] == [0.0, 1.0]
    first, last = (np.frombuffer(p["floats"], np.float32).reshape(3, 2) for p in pins["poses"])
    np.testing.assert_allclose(first[1], [6, 0])
    np.testing.assert_allclose(last[1], [6, 2])
    np.testing.assert_array_equal(panel.animation.pins(3.0)[1], [6, 2])
    np.testing.assert_array_equal(panel.animation.pins(1.0)[1], [6, 2])

    # Beside the shape, though within reach of a pin, a press takes it.
    place = panel.animation.pins(0.5)[1]
    edge = np.abs(canvas.deformation.map(canvas.deformation.state.domain.cage.exterior)).max(0)
    beside = np.array([edge[0] + 0.4, place[1]])
    event: dict[str, Any] = {"button": 0, "shift": False, "unit": 0.05}
    event["reach"] = float(np.linalg.norm(beside - place)) + 0.01
    above = np.array([0.0, 1.0])
    for kind, (x, y) in (("down", beside), ("move", beside + above), ("up", beside + above)):
        canvas.handle([{**event, "type": kind, "x": x, "y": y, "at": 0.5}])
    assert model.state.timeline.times == (0.0, 0.5, 1.0)
    np.testing.assert_allclose(model.pose.targets[1], place + above)


def test_pins_are_placed_again_only_when_they_move(
    panel: TimelinePanel, monkeypatch: pytest.MonkeyPatch
) -> None:
    model, placed = panel.canvas.deformation, []
    model.add_handle((-6.0, 0.0))
    act(panel, "keep", time=0)
    model.drag(0, (-6, 1.5))
    assert panel.animation.wait(TIMEOUT)
    before = dict(panel.pins)  # type: ignore[call-overload]
    place = timeline.moving_pins
    monkeypatch.setattr(timeline, "moving_pins", lambda *a: placed.append(a) or place(*a))
    for what in ("frame", "state", "selection", "status"):
        model.tell(what)
    assert placed == []
    model.mark_pins([0], hidden=True)
    assert len(placed) == 1
    assert panel.pins != before


def test_pins_of_a_shape_without_any_are_none(panel: TimelinePanel) -> None:
    model = panel.canvas.deformation
    act(panel, "keep", time=0)
    assert panel.animation.wait(TIMEOUT)
    pins: dict[str, Any] = panel.pins  # type: ignore[assignment]
    assert [span["floats"] for span in pins["spans"]] == [b""]
    assert pins["poses"] == 2 * [{"floats": b"", "locked": []}]
    assert panel.animation.pins(0.5).shape == (0, 2)
    assert model.state.timeline.times == (0.0, 1.0)


def test_a_finer_cage_is_not_shown_the_motion_of_the_coarser(panel: TimelinePanel) -> None:
    """The bug was an IndexError in the shader's coefficients."""
    model, coarse = panel.canvas.deformation, panel.canvas.deformation.state.domain
    model.add_handle((-6, 0))
    act(panel, "keep", time=0)
    model.drag(0, (-6, 1.5))
    assert panel.animation.wait(TIMEOUT)
    fine = Domain.from_cage(trace(PICTURE, max_edge=1.0).cage)
    assert fine.n_coefficients > coarse.n_coefficients
    model.set_domain(fine)
    assert {span.map.domain for span in panel.animation.spans} == {fine}
    assert panel.animation.wait(TIMEOUT)
    (span,) = panel.motion["spans"]
    assert span["status"] == "proved"
    shown = panel.animation.at(0.0)
    assert shown is not None
    np.testing.assert_allclose(shown([[-6, 0]]), [[-6, 0]], atol=1e-3)
    model.undo()
    assert {span.map.domain for span in panel.animation.spans} == {coarse}
