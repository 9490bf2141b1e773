"""A renderer adapts to the speed of the page."""

from __future__ import annotations

import numpy as np
import pytest

from glid_nb.widgets import DeformCanvas

from ..support.domains import domain
from .test_shader import PICTURE

pytestmark = pytest.mark.slow  # most of the time is compiling


def _canvas(**settings: object) -> DeformCanvas:
    return DeformCanvas(PICTURE, domain("ell"), **settings)


def test_the_mesh_is_coarse_until_the_page_has_said_what_it_can_draw() -> None:
    canvas = _canvas()
    pane, stage = canvas.pane, canvas.pane.stage
    texture = pane.scene.picture.material.uniforms["map"]["value"]
    coarse = pane.scene.picture.n_vertices
    assert coarse < 1600
    stage.drawing_time = 6.0
    fine = pane.scene.picture.n_vertices
    assert 9000 < fine < 11_000
    assert stage.materials == pane.scene.materials
    assert stage.coefficients == pane.scene.shader_map.wire(canvas.deformation.map)
    assert pane.scene.picture.material.uniforms["map"]["value"] is texture  # sent once
    # Another page is slower: half of the vertices, within 40 ms.
    stage.drawing_time = 80.0
    between = pane.scene.picture.n_vertices
    assert 0.4 * fine < between < 0.6 * fine
    # The time was that of the finer mesh. What another page reports of this mesh counts by itself.
    stage.drawing_time = 5.0
    assert pane.scene.picture.n_vertices == between
    stage.drawing_time = 1e4
    assert pane.scene.picture.n_vertices == coarse
    canvas.close()


@pytest.mark.parametrize("time", [0.0, 25.0, 39.0, 1e4])
def test_a_slow_page_keeps_the_mesh(time: float) -> None:
    canvas = _canvas()
    scene = canvas.pane.scene
    canvas.pane.stage.drawing_time = time
    assert canvas.pane.scene is scene
    canvas.close()


def test_a_mesh_that_was_asked_for_stays() -> None:
    canvas = _canvas(n_vertices=4000)
    scene = canvas.pane.scene
    canvas.pane.stage.drawing_time = 1e3
    assert canvas.pane.scene is scene
    canvas.close()


def test_what_was_shown_is_shown_on_the_other_mesh() -> None:
    canvas = _canvas()
    canvas.overlay, canvas.show_cage, canvas.show_panels = "sigma1", True, True
    canvas.pane.stage.drawing_time = 4.0
    scene = canvas.pane.scene
    assert set(scene.lines) == {"cage", "panels"}
    assert [material.uniforms["overlay"]["value"] for material in scene.materials[:1]] == [2.0]
    assert scene.meshes[-1].visible
    canvas.close()


def test_a_page_with_few_uniforms_gets_vertices_from_the_kernel() -> None:
    canvas = _canvas()
    assert canvas.pane.scene.evaluated_in == "shader"
    canvas.pane.stage.uniform_vectors = 40
    assert canvas.pane.scene.evaluated_in == "kernel"
    assert canvas.pane.stage.coefficients == b""
    canvas.close()


def test_what_has_moved_stays_in_view_when_the_canvas_takes_another_shape() -> None:
    canvas = _canvas(width=600, height=480)
    canvas.deformation.add_handle((0, 0))
    canvas.deformation.drag(0, to=(1, 0))
    assert canvas.deformation.solve(60)
    stage, cage = canvas.pane.stage, canvas.pane.scene.domain.cage
    outline = canvas.deformation.map(np.concatenate(cage.loops))

    def all_in_view() -> bool:
        x, y, unit = stage.view
        half = np.array([stage.width, stage.height]) * unit / 2
        return bool((abs(outline - [x, y]) <= half).all())

    for width, height in ((600, 480), (480, 800), (900, 480), (600, 480)):
        canvas.pane.resize(width, height)
        assert all_in_view()
    canvas.close()
