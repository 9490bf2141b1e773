"""Cages too large for a page's shaders: the kernel sends vertices, and the page draws them."""

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
