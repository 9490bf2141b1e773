"""Driving the deformation canvas in a page as a hand does."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..browser import LabNotebook

# A bar of 16 x 4 units in a picture of 200 x 100 pixels, checked so that one sees where it goes.
SETUP = """
import numpy as np
import glid_nb as glid
glid.enable_compilation_cache()
y, x = np.mgrid[:100, :200]
picture = np.zeros((100, 200, 4), np.uint8)
inside = (abs(x - 99.5) < 80) & (abs(y - 49.5) < 20)
picture[inside, 3] = 255
picture[..., 0] = np.where((x // 20 + y // 20) % 2, 230, 40)
picture[..., 1] = x
picture[..., 2] = 255 - x
"""

EDITOR = """
editor = glid.Editor(picture, n_vertices=1500, width=560, height=400)
canvas, model = editor.canvas, editor.deformation
editor
"""

_MANAGER = """async () => {
  const rendermime = window.jupyterapp.shell.currentWidget.content.rendermime;
  const mimeType = 'application/vnd.jupyter.widget-view+json';
  const manager = rendermime.getFactory(mimeType).createRenderer({mimeType})._manager;
  return manager.promise ? await manager.promise : manager;
}"""

_COEFFICIENTS = f"""async (id) => {{
  const manager = await ({_MANAGER})();
  const material = await manager.get_model(id);
  return Array.from(material.obj.uniforms.coefficients.value);
}}"""

_SHOWS = f"""async ([id, wanted, pad, view]) => {{
  const shown = await ({_COEFFICIENTS})(id);
  const manager = await ({_MANAGER})();
  const seen = (await manager.get_model(pad)).get('view');
  if (!seen.every((v, i) => Math.abs(v - view[i]) < 1e-9)) return false;
  return shown.length === wanted.length && shown.every((v, i) => Math.abs(v - wanted[i]) < 1e-6);
}}"""

_FRAMES = """async () => {
  for (let i = 0; i < 3; i++) await new Promise((go) => requestAnimationFrame(go));
}"""

_PIXEL = """([u, v]) => {
  const canvas = document.querySelector('.jupyter-threejs canvas');
  const copy = document.createElement('canvas');
  [copy.width, copy.height] = [canvas.width, canvas.height];
  const pen = copy.getContext('2d');
  pen.drawImage(canvas, 0, 0);
  return Array.from(pen.getImageData(u * copy.width, v * copy.height, 1, 1).data);
}"""


class Hand:
    """A hand on the first pad of a page; points are in world units.

    The canvas, in the kernel ``canvas``, must show ``model``.
    """

    def __init__(self, book: LabNotebook, pad: int = 0) -> None:
        self.book, self.page = book, book.page
        self.pad = self.page.locator(".glid-pad").nth(pad)
        self.pad.wait_for()
        self.settle()

    def settle(self) -> None:
        """Wait for the solver."""
        self.book.wait_for("model.solved and not model.busy", 90)

    def place(self, point: Sequence[float]) -> tuple[float, float]:
        """Where a point is in the page."""
        return self.places([point])[0]

    def places(self, points: Sequence[Sequence[float]]) -> list[tuple[float, float]]:
        """Where points are in the page, which is scrolled to show the pad."""
        self.pad.scroll_into_view_if_needed()
        box = self.pad.bounding_box()
        assert box is not None
        (cx, cy, unit), width, height = self.book.value(
            "[canvas.pane.stage.view, canvas.pane.stage.width, canvas.pane.stage.height]"
        )
        return [
            (box["x"] + (x - cx) / unit + width / 2, box["y"] + (cy - y) / unit + height / 2)
            for x, y in points
        ]

    def click(self, point: Sequence[float], **options: Any) -> None:
        self.page.mouse.click(*self.place(point), **options)

    def drag(self, points: Sequence[Sequence[float]], pause: float = 1000 / 60) -> None:
        """Press at the first point, move along the others, let go at the last."""
        places = self.places(points)
        self.page.mouse.move(*places[0])
        self.page.mouse.down()
        for place in places[1:]:
            self.page.mouse.move(*place)
            self.page.wait_for_timeout(pause)
        self.page.mouse.up()

    @property
    def handles(self) -> list[list[float]]:
        return self.book.value("model.pose.handles.tolist()")

    @property
    def targets(self) -> list[list[float]]:
        return self.book.value("model.pose.targets.tolist()")

    def certified(self) -> bool:
        return self.book.value("glid.certify(model.map).certified")

    def wait_for_target(self, index: int, wanted: Sequence[float]) -> None:
        """Wait until the page's events have put a target there, nothing is held and all is solved.

        The page sends one batch at a time, so its last moves come after the pointer was let go.
        """
        near = f"abs(model.pose.targets[{index}] - {list(wanted)}).max() < 0.1"
        self.book.wait_for(f"{near} and not model.dragged", 60)
        self.settle()

    def coefficients(self) -> list[float]:
        """phi and psi in the shader of the page's picture, as three.js has them."""
        identity = self.book.value("canvas.pane.scene.picture.material.model_id")
        return self.page.evaluate(_COEFFICIENTS, identity)

    def wait_until_drawn(self) -> None:
        """Wait until the shader has the kernel's map, to float32, and a frame was drawn with it."""
        wanted = self.book.value(
            "canvas.pane.scene.shader_map.coefficients(model.map)[0].ravel().tolist()"
        )
        identity = self.book.value("canvas.pane.scene.picture.material.model_id")
        pad, view = self.book.value("[canvas.pane.stage.model_id, list(canvas.pane.stage.view)]")
        self.page.wait_for_function(_SHOWS, arg=[identity, wanted, pad, view], timeout=20_000)
        self.page.evaluate(_FRAMES)

    def color_at(self, point: Sequence[float]) -> list[int]:
        """RGBA of the canvas below a point of the world."""
        box = self.pad.bounding_box()
        assert box is not None
        x, y = self.place(point)
        return self.page.evaluate(
            _PIXEL, [(x - box["x"]) / box["width"], (y - box["y"]) / box["height"]]
        )


def line(start: Sequence[float], end: Sequence[float], count: int) -> list[list[float]]:
    """``count`` + 1 points from start to end."""
    return [
        [s + (e - s) * i / count for s, e in zip(start, end, strict=True)] for i in range(count + 1)
    ]
