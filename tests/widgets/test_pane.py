"""A renderer adapts to the speed of the page."""

from __future__ import annotations

import ipywidgets
import numpy as np
import pytest

from glid_nb.imaging import PixelFrame
from glid_nb.widgets import DeformCanvas
from glid_nb.widgets.layers import MOVED_BY_PAGE

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
    # Another page is as quick.
    stage.drawing_time = 7.0
    assert (pane.scene.picture.n_vertices, pane.scene.evaluated_in) == (fine, "shader")
    # Another page is slower. Its script moves the vertices then, and that is measured.
    stage.drawing_time = 80.0
    assert (pane.scene.picture.n_vertices, pane.scene.evaluated_in) == (fine, "page")
    # Half of the vertices, within 40 ms.
    stage.drawing_time = 79.0
    between = pane.scene.picture.n_vertices
    assert 0.4 * fine < between < 0.6 * fine
    assert pane.scene.evaluated_in == "page"
    # The time was that of the finer mesh. What another page reports of this mesh counts by itself.
    stage.drawing_time = 5.0
    assert pane.scene.picture.n_vertices == between
    # A page that moves vertices more slowly than its shader gets the shader.
    stage.drawing_time = 1e4
    assert pane.scene.evaluated_in == "shader"
    canvas.close()


@pytest.mark.parametrize("time", [0.0, 3.0, 7.9])
@pytest.mark.parametrize("asked", [None, "shader"])
def test_a_page_whose_shader_is_quick_keeps_it(time: float, asked: str | None) -> None:
    canvas = _canvas(n_vertices=1600, evaluated_in=asked)
    scene = canvas.pane.scene
    canvas.pane.stage.drawing_time = time
    assert canvas.pane.scene is scene
    canvas.close()


@pytest.mark.parametrize("times", [(25.0, 12.0), (39.0, 38.0), (1e4, 1e3)])
def test_where_drawing_is_slow_the_page_moves_the_vertices(times: tuple[float, float]) -> None:
    canvas = _canvas()
    pane = canvas.pane
    coarse, wire = pane.scene.picture.n_vertices, pane.stage.coefficients
    pane.stage.drawing_time = times[0]
    assert pane.stage.drawing_time == 0.0  # the page is to measure again
    pane.stage.drawing_time = times[1]
    assert pane.scene.evaluated_in == "page"
    assert pane.scene.picture.n_vertices >= coarse
    assert pane.stage.coefficients == wire
    assert {mesh.name for mesh in pane.scene.meshes} == {MOVED_BY_PAGE}
    canvas.close()


def test_where_the_page_moves_vertices_more_slowly_the_shader_stays() -> None:
    canvas = _canvas()
    pane = canvas.pane
    pane.stage.drawing_time = 30.0
    pane.stage.drawing_time = 31.0
    assert pane.scene.evaluated_in == "shader"
    pane.stage.drawing_time = 30.0
    assert (pane.scene.evaluated_in, pane.stage.drawing_time) == ("shader", 30.0)
    canvas.close()


def _renderers() -> list[str]:
    """The kinds of all widgets that a renderer has."""
    kinds = [type(one).__name__ for one in ipywidgets.widgets.widget._instances.values()]
    parts = "Layout", "OrthographicCamera", "Renderer", "Scene", "WebGLShadowMap"
    return sorted(kind for kind in kinds if kind in parts)


@pytest.mark.parametrize("asked", [None, "shader", "page", "kernel"])
def test_there_is_multisampling_but_where_a_processor_would_do_it(asked: str | None) -> None:
    canvas = _canvas(evaluated_in=asked)
    pane = canvas.pane
    old = pane.stage.renderer
    made = _renderers()
    assert old.get_state()["_antialias"] == (asked != "page")
    for time in (30.0, 10.0):  # the page's script is quicker
        pane.stage.drawing_time = time
    new = pane.stage.renderer
    assert pane.children == (pane.stage, new)
    assert new.get_state()["_antialias"] == (pane.scene.evaluated_in != "page")
    assert (new is old) == (asked is not None)
    assert (new.scene, new.camera) == (old.scene, pane.stage.camera)
    pane.resize(500, 300)
    assert (new.width, new.height) == (500, 300)
    assert (old.comm is None) == (new is not old)
    assert _renderers() == made
    canvas.close()
    assert new.comm is None


def test_a_mesh_that_was_asked_for_stays() -> None:
    canvas = _canvas(n_vertices=4000)
    count = canvas.pane.scene.picture.n_vertices
    for time in (1e3, 9e2):
        canvas.pane.stage.drawing_time = time
        assert canvas.pane.scene.picture.n_vertices == count
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


def test_a_picture_behind_the_shape_is_seen_as_a_whole() -> None:
    wide = np.zeros((100, 400, 4), np.uint8)
    canvas = DeformCanvas(wide, domain("ell"), width=600, height=480)
    left, bottom, right, top = PixelFrame(400, 100).bounds
    stage = canvas.pane.stage

    def seen() -> bool:
        (x, y, unit), sides = stage.view, (stage.width, stage.height)
        across, up = (0.5 * unit * side for side in sides)
        whole = x - across <= left and right <= x + across
        return whole and y - up <= bottom and top <= y + up

    shape_alone = list(stage.view)
    assert not seen()
    canvas.set_picture(wide, (255, 255, 255))
    assert stage.view == shape_alone
    canvas.set_picture(wide, wide)
    assert seen()
    # Another one leaves a view that the user has chosen.
    stage.view = shape_alone
    canvas.set_picture(wide, wide)
    assert stage.view == shape_alone
    canvas.fit()
    assert seen()
    canvas.close()
