"""Other shapes around the edited one: what the page gets of them, and what a press does."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from glid_nb.geometry import Cage, Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.session.deformation import Deformation
from glid_nb.session.scenery import Scenery
from glid_nb.widgets import DeformCanvas

pytestmark = pytest.mark.slow

PICTURE = np.full((40, 40, 4), 255, np.uint8)


def _square(x: float, side: float = 6) -> HarmonicMap:
    half = side / 2
    cage = Cage([[x - half, -half], [x + half, -half], [x + half, half], [x - half, half]])
    return HarmonicMap.identity(Domain.from_cage(cage))


EDITED, LEFT, RIGHT = _square(0), _square(-6), _square(6)
SCENERY = [
    Scenery("left", PICTURE.copy(), LEFT),
    Scenery("right", PICTURE.copy(), RIGHT, above=True),
]


def _moved(map: HarmonicMap, by: float) -> HarmonicMap:
    return HarmonicMap(map.domain, map.phi + by * (map.phi != 0), map.psi)


@pytest.fixture
def canvas() -> Iterator[DeformCanvas]:
    with Deformation(EDITED.domain, begin=False) as model:
        model.paused = True
        canvas = DeformCanvas(PICTURE, model, n_vertices=1200)
        yield canvas
        canvas.close()


def test_shapes_are_drawn_in_their_order_each_with_its_own_heights(canvas: DeformCanvas) -> None:
    pane = canvas.pane
    (alone,) = pane.scene.meshes
    assert (alone.position, alone.scale) == ((0, 0, 0), (1, 1, 1))
    canvas.show_scenery(SCENERY)
    scenes = [pane.part_scenes["left"], pane.scene, pane.part_scenes["right"]]
    meshes = [scene.picture.mesh for scene in scenes]
    assert list(pane.stage.renderer.scene.children) == meshes
    ends = []
    for scene, mesh in zip(scenes, meshes, strict=True):
        z = scene.picture.attributes["position"].array[:, 2]
        ends += [mesh.position[2] + mesh.scale[2] * height for height in (z.min(), z.max())]
    assert ends == sorted(ends)
    assert ends[0] >= -4
    assert ends[-1] <= 4
    # The vertices are shared by area.
    assert sum(scene.n_vertices for scene in scenes) == 1200
    # Lines along the edited shape are over all.
    canvas.show_cage = True
    assert list(pane.stage.renderer.scene.children) == [*meshes, pane.scene.lines["cage"].mesh]
    canvas.show_cage = False
    canvas.show_scenery([])
    assert not pane.part_scenes
    assert pane.stage.part_shapes == []
    assert tuple(pane.scene.picture.mesh.scale) == (1, 1, 1)


def test_another_map_of_a_shape_is_one_message(canvas: DeformCanvas, sent: list[Any]) -> None:
    canvas.show_scenery(SCENERY)
    scenes = canvas.pane.part_scenes
    before, wires = dict(scenes), dict(canvas.pane.stage.part_maps)
    sent.clear()
    moved = _moved(LEFT, 1.0)
    canvas.show_scenery([replace(SCENERY[0], map=moved), SCENERY[1]])
    assert [list(data["state"]) for data, _ in sent] == [["part_maps"]]
    assert canvas.pane.part_scenes == before
    assert canvas.pane.stage.part_maps["left"] == before["left"].shader_map.wire(moved)
    assert canvas.pane.stage.part_maps["right"] == wires["right"]


def test_a_shape_keeps_what_the_page_has_of_it_when_it_is_edited(canvas: DeformCanvas) -> None:
    canvas.show_scenery(SCENERY)
    edited, scenes = canvas.pane.scene, dict(canvas.pane.part_scenes)
    textures = edited.texture, scenes["left"].texture
    with Deformation(LEFT.domain, begin=False) as model:
        model.paused = True
        around = [Scenery("edited", PICTURE, EDITED, above=True), SCENERY[1]]
        canvas.edit(model, SCENERY[0].picture, around)
        assert canvas.pane.scene is scenes["left"]
        assert canvas.pane.part_scenes == {"edited": edited, "right": scenes["right"]}
        assert (edited.texture, canvas.pane.scene.texture) == textures
        assert canvas.pane.stage.materials == scenes["left"].materials
        assert canvas.pane.stage.outline["outline"]["cage"] == LEFT.domain.cage.exterior.tolist()
        # What the model says now is drawn, and the model before is no longer heard.
        model.add_handle((-6, 1))
        assert canvas.pane.stage.marks["targets"] == [[-6, 1]]


def _event(kind: str, x: float, y: float, **more: Any) -> dict[str, Any]:
    place = {"x": x, "y": y, "reach": 0.26, "unit": 0.02, "button": 0, "shift": False}
    return {"type": kind, **place, **more}


def test_a_press_asks_for_the_other_shape_before_it_acts(canvas: DeformCanvas) -> None:
    canvas.show_scenery(SCENERY)
    asked: list[str] = []
    with Deformation(RIGHT.domain, begin=False) as model:
        model.paused = True

        def edit(key: str, event: Any) -> None:
            asked.append(key)
            assert event["type"] == "down"
            if key == "right":
                canvas.edit(model, SCENERY[1].picture, [Scenery("edited", PICTURE, EDITED)])

        canvas.on_other_part = edit
        # A press on the edited shape, one beside all, one that selects several by a box.
        for press in (
            _event("down", 0, 0),
            _event("down", 0, 9),
            _event("down", -6, 0, shift=True),
        ):
            assert canvas.handle([press, {**press, "type": "cancel"}]) is None
        assert not asked
        click = _event("down", 6, 1), _event("up", 6, 1)
        first = canvas.deformation
        assert canvas.handle([_event("down", 0, 1), _event("up", 0, 1), *click]) is None
        assert asked == ["right"]
        assert first.pose.handles == pytest.approx(np.array([[0, 1]]))
        assert model.pose.handles == pytest.approx(np.array([[6, 1]]))
