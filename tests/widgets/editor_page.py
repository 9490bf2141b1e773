"""Drive the deformation canvas in a page like a hand."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any

from playwright.sync_api import Locator, Page

from ..support.browser import NotebookPage, bring_into_view

# A bar of 16 x 4 units in a picture of 200 x 100 pixels. The checks show where each part goes.
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
editor = glid.Editor(picture, n_vertices=600, width=560, height=400)
canvas, model = editor.canvas, editor.deformation
editor
"""

# As large as there is room.
ROOMY_EDITOR = """
editor = glid.Editor(picture, n_vertices=300)
canvas, model = editor.canvas, editor.deformation
editor
"""

# Another picture than in other tests: no kept work is offered, which would take room.
NEW_PICTURE = """
picture[:10, :10] = np.random.default_rng().integers(256, size=4)
picture[:10, :10, 3] = 0
"""

# The contrast of an element's text with its background, by WCAG.
_CONTRAST = """(element) => {
  const pen = Object.assign(document.createElement('canvas'), {width: 1, height: 1})
    .getContext('2d', {willReadFrequently: true});
  const behind = [];
  for (let one = element; one; one = one.parentElement)
    behind.unshift(getComputedStyle(one).backgroundColor);
  const luminance = () => {
    const parts = [...pen.getImageData(0, 0, 1, 1).data].slice(0, 3).map((v) => v / 255)
      .map((v) => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
    return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2];
  };
  const paint = (color) => { pen.fillStyle = color; pen.fillRect(0, 0, 1, 1); };
  for (const color of ['white', ...behind]) paint(color);
  const below = luminance();
  paint(getComputedStyle(element).color);
  const [dark, light] = [below, luminance()].sort((a, b) => a - b);
  return (light + 0.05) / (dark + 0.05);
}"""

# The page's widget manager, which holds the models of the widgets by their identities.
MANAGER = """async () => {
  const rendermime = window.jupyterapp.shell.currentWidget.content.rendermime;
  const mimeType = 'application/vnd.jupyter.widget-view+json';
  const manager = rendermime.getFactory(mimeType).createRenderer({mimeType})._manager;
  return manager.promise ? await manager.promise : manager;
}"""

_COEFFICIENTS = f"""async (id) => {{
  const manager = await ({MANAGER})();
  const {{material, geometry}} = (await manager.get_model(id)).obj;
  const inShader = material.uniforms.coefficients;
  if (inShader) return Array.from(inShader.value);
  return Array.from(geometry.userData.wire ?? []);
}}"""

_SHOWS = f"""async ([id, wanted, pad, view]) => {{
  const manager = await ({MANAGER})();
  if (!manager.has_model(id)) return false;
  const shown = await ({_COEFFICIENTS})(id);
  const seen = (await manager.get_model(pad)).get('view');
  if (!seen.every((v, i) => Math.abs(v - view[i]) < 1e-9)) return false;
  return wanted.every((v, i) => Math.abs(v - shown[i]) < 1e-6);
}}"""

# The numbers in the page's three.js geometry.
_ATTRIBUTE = f"""async (id) => {{
  const manager = await ({MANAGER})();
  return Array.from((await manager.get_model(id)).obj.array);
}}"""

_HOLDS = f"""async ([id, wanted]) => {{
  const held = await ({_ATTRIBUTE})(id);
  return held.length === wanted.length && held.every((v, i) => Math.abs(v - wanted[i]) < 1e-5);
}}"""

_FRAMES = """async () => {
  for (let i = 0; i < 3; i++) await new Promise((go) => requestAnimationFrame(go));
}"""

_STILL = """async (pad) => {
  const place = () => JSON.stringify(pad.getBoundingClientRect());
  for (let same = 0, before = place(); same < 3; ) {
    await new Promise((go) => requestAnimationFrame(go));
    const now = place();
    [same, before] = [now === before ? same + 1 : 0, now];
  }
}"""

_PIXEL = """(pane, [u, v]) => {
  const canvas = pane.querySelector('.jupyter-threejs canvas');
  const copy = document.createElement('canvas');
  [copy.width, copy.height] = [canvas.width, canvas.height];
  const pen = copy.getContext('2d');
  pen.drawImage(canvas, 0, 0);
  return Array.from(pen.getImageData(u * copy.width, v * copy.height, 1, 1).data);
}"""


def contrast(text: Locator) -> float:
    """The contrast of a text with its background. WCAG 2 demands 4.5."""
    return text.evaluate(_CONTRAST)


class Hand:
    """A hand on a pad of a page, by default the first; points are in world units.

    ``canvas`` is what the pad's `DeformCanvas` is called in the kernel; with ``settle`` the hand
    waits for the solver first.
    """

    def __init__(
        self, book: NotebookPage, pad: int = 0, canvas: str = "canvas", settle: bool = True
    ) -> None:
        self.book, self.page = book, book.page
        self.canvas, self.model = canvas, f"{canvas}.deformation"
        self.pad = self.page.locator(".glid-pad").nth(pad)
        self.pane = self.page.locator(".glid-pane").nth(pad)
        self.pad.wait_for()
        if settle:
            self.settle()
            if self.pane.locator("xpath=ancestor::*[contains(@class, 'glid-editor')]").count():
                self.book.wait_for(f"{canvas}.pane.stage.room")  # for then it has its size

    def settle(self) -> None:
        """Wait for the solver."""
        self.book.wait_for(f"{self.model}.moment.solved and not {self.model}.busy", 90)

    def place(self, point: Sequence[float]) -> tuple[float, float]:
        """Where a point is in the page."""
        return self.places([point])[0]

    def places(self, points: Sequence[Sequence[float]]) -> list[tuple[float, float]]:
        """Where points are in the page, which is scrolled to show the pad."""
        (cx, cy, unit), width, height = self.book.value(
            "[stage.view, stage.width, stage.height]", f"stage = {self.canvas}.pane.stage"
        )
        bring_into_view(self.pad)
        self.wait_until_still()
        box = self.pad.bounding_box()
        assert box is not None
        return [
            (box["x"] + (x - cx) / unit + width / 2, box["y"] + (cy - y) / unit + height / 2)
            for x, y in points
        ]

    def wait_until_still(self) -> None:
        """Wait until the page has stopped moving the pad, for example after loading or resizing."""
        self.pad.evaluate(_STILL)

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
        return self.book.value(f"{self.model}.pose.handles.tolist()")

    @property
    def targets(self) -> list[list[float]]:
        return self.book.value(f"{self.model}.pose.targets.tolist()")

    def certified(self) -> bool:
        return self.book.value(f"glid.certify({self.model}.map).certified")

    def wait_for_target(self, index: int, wanted: Sequence[float]) -> None:
        """Wait until the page's events have put a target there, nothing is held and all is solved.

        The page sends one batch at a time, so its last moves come after the pointer was let go.
        """
        near = f"abs({self.model}.pose.targets[{index}] - {list(wanted)}).max() < 0.1"
        self.book.wait_for(f"{near} and not {self.model}.dragged", 60)
        self.settle()

    def coefficients(self) -> list[float]:
        """phi and psi of the map that the page draws, as three.js has them."""
        return self.drawn(self.picture())

    def picture(self) -> list[Any]:
        """Which of the page's meshes is the picture, for `drawn`."""
        scene = f"scene = {self.canvas}.pane.scene"
        return self.book.value("[scene.picture.mesh.model_id, 4 * scene.shader_map.n_chain]", scene)

    def drawn(self, picture: list[Any]) -> list[float]:
        """As `coefficients`, without asking the kernel."""
        identity, count = picture
        return self.page.evaluate(_COEFFICIENTS, identity)[:count]

    def attribute(self, name: str) -> list[float]:
        """A vertex attribute of the page's picture, as three.js has it."""
        identity = self.book.value(
            f"{self.canvas}.pane.scene.picture.attributes[{name!r}].model_id"
        )
        return self.page.evaluate(_ATTRIBUTE, identity)

    def wait_for_attribute(self, name: str, wanted: Sequence[float]) -> None:
        """Wait until a vertex attribute has these values, to float32, and a frame was drawn with
        it."""
        identity = self.book.value(
            f"{self.canvas}.pane.scene.picture.attributes[{name!r}].model_id"
        )
        self.page.wait_for_function(_HOLDS, arg=[identity, list(wanted)], timeout=20_000)
        self.page.evaluate(_FRAMES)

    def wait_until_drawn(self) -> None:
        """Wait until the page has the kernel's map, to float32, and a frame was drawn with it.

        The kernel is asked each time: a canvas that still tries how to draw fast has other widgets
        a moment later.
        """
        end = time.monotonic() + 20
        while not self.page.evaluate(_SHOWS, self._to_be_shown()):
            assert time.monotonic() < end, "the page does not draw the kernel's map"
            self.page.evaluate(_FRAMES)
        self.page.evaluate(_FRAMES)

    def _to_be_shown(self) -> list[Any]:
        """The arguments of _SHOWS."""
        return self.book.value(
            "[pane.scene.picture.mesh.model_id,"
            f" pane.scene.shader_map.coefficients({self.model}.map)[0].ravel().tolist(),"
            " pane.stage.model_id, list(pane.stage.view)]",
            f"pane = {self.canvas}.pane",
        )

    def wait_for_color(self, point: Sequence[float], wanted: Callable[[list[int]], bool]) -> None:
        """Wait until the canvas has this colour at a point of the world."""
        end = time.monotonic() + 20
        while not wanted(seen := self.color_at(point)):
            assert time.monotonic() < end, f"at {point} the canvas shows {seen}"
            self.page.evaluate(_FRAMES)

    def color_at(self, point: Sequence[float]) -> list[int]:
        """RGBA of the canvas at a point of the world."""
        x, y = self.place(point)  # which may scroll
        box = self.pad.bounding_box()
        assert box is not None
        return self.pane.evaluate(
            _PIXEL, [(x - box["x"]) / box["width"], (y - box["y"]) / box["height"]]
        )


def line(start: Sequence[float], end: Sequence[float], count: int) -> list[list[float]]:
    """``count`` + 1 points from start to end."""
    return [
        [s + (e - s) * i / count for s, e in zip(start, end, strict=True)] for i in range(count + 1)
    ]


def choose_view(page: Page, label: str, closes: bool = False) -> None:
    """Choose an item of the menu of what the canvas shows. Some items close it."""
    menu = page.locator(".glid-view-menu")
    page.locator(".glid-view-button").click()
    menu.get_by_text(label, exact=True).click()
    if not closes:
        page.keyboard.press("Escape")
    menu.wait_for(state="hidden")


def center(of: Locator) -> tuple[float, float]:
    """The middle of an element on the page."""
    box = of.bounding_box()
    assert box is not None
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
