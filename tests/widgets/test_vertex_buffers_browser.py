"""Vertices that the shader does not move: those of the kernel, and those of the page's script."""

from __future__ import annotations

import numpy as np
import pytest

from .conftest import OpenNotebook
from .editor_page import SETUP, Hand, line

pytestmark = [pytest.mark.browser, pytest.mark.slow]

# A disc of radius 4.5 in the bar's picture.
CANVAS = """
picture[..., 3] = 255
angles = 2 * np.pi * np.arange(60) / 60
disc = glid.Domain.from_cage(glid.Cage(4.5 * np.stack([np.cos(angles), np.sin(angles)], 1)))
canvas = glid.widgets.DeformCanvas(picture, disc, 420, 300, n_vertices=600)
model, before = canvas.deformation, canvas.pane.scene.evaluated_in
canvas
"""

# The least that WebGL allows: 128 vectors.
FEW_UNIFORMS = """
for (const kind of [WebGLRenderingContext, WebGL2RenderingContext]) {
  const getParameter = kind.prototype.getParameter;
  kind.prototype.getParameter = function (name) {
    return name === this.MAX_VERTEX_UNIFORM_VECTORS ? 128 : getParameter.call(this, name);
  };
}
"""


def test_the_page_draws_the_kernels_vertices(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, CANVAS], script=FEW_UNIFORMS)
    book.wait_for("canvas.pane.scene.evaluated_in == 'kernel'")
    assert book.value("[before, canvas.pane.stage.uniform_vectors]") == ["shader", 128]
    hand = Hand(book)
    hand.click((-2.5, 0.0))
    hand.click((2.5, 0.0))
    book.wait_for("len(model.pose) == 2")
    hand.settle()
    hand.drag(line((2.5, 0.0), (3.0, 2.0), 10))
    hand.wait_for_target(1, [3.0, 2.0])
    assert hand.certified()
    assert hand.targets[1] != hand.handles[1]
    # three.js holds the images of the mesh's vertices under the kernel's map.
    points = np.reshape(hand.attribute("position"), (-1, 3))[:, :2]
    assert len(points) > 400
    expected = book.value(f"model.map({points.tolist()}).tolist()")
    hand.wait_for_attribute("image", np.ravel(expected).tolist())
    source = [1.5, 1.5]
    (image,) = book.value(f"model.map([{source}]).tolist()")
    seen = hand.color_at(image)
    wanted = 100 + 10 * source[0]  # 10 pixels of the picture are one unit
    assert abs(seen[1] - wanted) < 6
    assert abs(seen[2] - (255 - wanted)) < 6
    book.screenshot("canvas-vertex-buffers")


SLOW_SHADER = """
bar = glid.Domain.from_cage(glid.Cage([[-8, -2], [8, -2], [8, 2], [-8, 2]]))
canvas = glid.widgets.DeformCanvas(
    picture, bar, 420, 300, n_vertices=600, evaluated_in="shader"
)
model, pane = canvas.deformation, canvas.pane
canvas
"""
# As if the page's script had been found to be quicker than its shader.
SWITCH = """
with model.locked():
    pane._asked = None
    pane._times.update(page=1e-9)
    pane.adapt()
"""


def test_a_page_that_goes_over_to_its_script_keeps_the_hands_place(
    open_notebook: OpenNotebook,
) -> None:
    book = open_notebook([SETUP, SLOW_SHADER])
    hand, page = Hand(book), book.page
    book.wait_for("pane.stage.drawing_time > 0")
    hand.pad.focus()
    assert book.value("pane.stage.renderer._antialias")
    assert book.value("pane.stage.renderer._antialias", setup=SWITCH) is False
    page.wait_for_function(
        "pane => pane.querySelectorAll('.jupyter-threejs canvas').length === 1",
        arg=hand.pane.element_handle(),
    )
    samples = """pane => {
      const canvas = pane.querySelector('.jupyter-threejs canvas');
      const gl = canvas.getContext('webgl2') || canvas.getContext('webgl');
      return gl.getContextAttributes().antialias;
    }"""
    assert hand.pane.evaluate(samples) is False
    assert hand.pad.evaluate("pad => pad.contains(document.activeElement)")
    hand.click((-6.0, 0.0))
    hand.click((6.0, 0.0))
    book.wait_for("len(model.pose) == 2")
    hand.drag(line((6.0, 0.0), (6.5, 2.0), 10))
    hand.wait_for_target(1, [6.5, 2.0])
    hand.wait_until_drawn()
    # The plain picture needs no derivatives; the overlay has those of the map that is shown.
    points = np.reshape(hand.attribute("position"), (-1, 3))[:, :2]
    book.value("None", setup="canvas.overlay = 'sigma1'")
    parts = "[[d.real.tolist(), d.imag.tolist()] for d in model.map.wirtinger(points)]"
    fz, fzb = np.array(book.value(parts, setup=f"points = np.array({points.tolist()})"))
    wanted = np.stack([*fz, fzb[0], -fzb[1]], axis=1)
    hand.wait_for_attribute("derivatives", wanted.ravel().tolist())
    book.screenshot("canvas-moved-by-page")
