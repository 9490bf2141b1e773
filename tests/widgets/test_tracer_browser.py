"""The tracer in JupyterLab, used by hand. The tests compare the kernel's values."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from playwright.sync_api import Locator
from skimage.color import deltaE_ciede2000, rgb2lab
from skimage.io import imread

from ..support.browser import LabNotebook, bring_into_view
from .conftest import OpenNotebook

pytestmark = [pytest.mark.browser, pytest.mark.slow]

CELLS = (
    "import glid_nb\nimport numpy as np",
    "tracer = glid_nb.widgets.CageTracer(glid_nb.samples.image('{name}'))\ntracer",
)

SHORT = "model = tracer.tracing_model"

# The tool after a key was pressed, before the kernel can have answered.
_TOOL_AFTER = """(canvas, key) => {
  canvas.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true, cancelable: true}));
  const root = canvas.closest('.glid-tracer');
  return root.querySelector('[data-tool][aria-pressed=true]').dataset.tool;
}"""


class Hand:
    """A tracer on the page, and where its picture's pixels are."""

    def __init__(self, book: LabNotebook, index: int = 0) -> None:
        self.book, self.page = book, book.page
        self.root = book.page.locator(".glid-tracer").nth(index)
        self.root.wait_for()
        self.stage = self.root.locator(".glid-stage[data-viewport]")
        self.stage.wait_for()
        bring_into_view(self.root)

    def place(self, x: float, y: float) -> tuple[float, float]:
        """Where a pixel of the picture is on the page."""
        box = self.stage.bounding_box()
        assert box is not None
        scale, left, top = map(float, (self.stage.get_attribute("data-viewport") or "").split())
        return box["x"] + left + scale * x, box["y"] + top + scale * y

    def drag(self, start: tuple[float, float], *stops: tuple[float, float], steps: int = 8) -> None:
        self.page.mouse.move(*self.place(*start))
        self.page.mouse.down()
        for stop in stops:
            self.page.mouse.move(*self.place(*stop), steps=steps)
        self.page.mouse.up()

    def button(self, name: str) -> Locator:
        return self.root.get_by_role("button", name=name)

    def settle(self) -> None:
        """Wait until the kernel has answered everything."""
        self.page.wait_for_function(
            "root => root.dataset.idle === 'true'", arg=self.root.element_handle()
        )

    @property
    def status(self) -> str:
        return self.root.locator(".glid-status").inner_text()

    def vertex(self, loop: int, index: int) -> tuple[float, float]:
        x, y = self.book.value(f"tracer.tracing_model.loops[{loop}][{index}].tolist()")
        return x, y


def tracer_of(open_notebook: OpenNotebook, name: str, **settings: object) -> Hand:
    return Hand(open_notebook([cell.format(name=name) for cell in CELLS], **settings))


def leftmost(hand: Hand) -> int:
    return hand.book.value("int(np.argmin(tracer.tracing_model.loops[0][:, 0]))")


def test_tracing_by_the_controls(open_notebook: OpenNotebook) -> None:
    hand = tracer_of(open_notebook, "monstera")
    book = hand.book
    assert book.value("[tracer.cage.n_holes, tracer.options.method]") == [8, "auto"]
    area = book.value("tracer.cage.area")

    # The ground is transparent and so has no colour. The page says so, and the cage is kept.
    hand.root.get_by_role("radio", name="Colour").click()
    hand.root.locator(".glid-callout", has_text="transparent").wait_for()
    assert book.value("tracer.cage.area") == area
    hand.root.get_by_role("radio", name="Brightness").click()
    book.wait_for("tracer.options.method == 'threshold' and not tracer.shown['problems']")
    area = book.value("tracer.cage.area")
    offset = book.value("tracer.tracing.offset")
    hand.root.locator("[data-name=offset] input[type=range]").focus()
    for _ in range(30):
        hand.page.keyboard.press("ArrowRight")
    hand.settle()
    assert book.value("tracer.options.offset") > offset
    book.wait_for(f"tracer.cage.area > {area}")
    simplify = hand.root.get_by_label("Simplify (px)")
    simplify.fill("2.5")
    simplify.press("Enter")
    book.wait_for("tracer.options.simplify == 2.5")
    hand.root.locator("[data-name=simplify] .glid-auto").click()
    hand.root.locator("[data-name=offset] .glid-auto").click()
    book.wait_for("tracer.options.simplify is tracer.options.offset is None")

    # The alpha channel again. One hole is dropped in the list, another one in the picture.
    hand.root.get_by_role("radio", name="Alpha").click()
    book.wait_for("tracer.options.method == 'alpha'")
    hand.root.locator(".glid-hole input").first.click()
    book.wait_for("tracer.cage.n_holes == 7")
    x, y = book.value("tracer.tracing.holes[3].pixel")
    hand.page.mouse.click(*hand.place(x, y))
    book.wait_for("tracer.cage.n_holes == 6")
    assert book.value("[h.kept for h in tracer.tracing.holes][:4]") == [False, True, True, False]
    hand.settle()
    assert "6 holes" in hand.status
    hand.root.locator(".glid-hint", has_text="Click to keep this hole").wait_for()
    book.screenshot("tracer-holes", hand.root)
    hand.button("Undo").click()
    book.wait_for("tracer.cage.n_holes == 7")
    hand.page.mouse.click(*hand.place(x, y))
    book.wait_for("tracer.cage.n_holes == 6")

    # A picture from a file.
    with hand.page.expect_file_chooser() as chooser:
        hand.button("Open a picture").click()
    samples = Path(__file__).parents[2] / "glid_nb" / "samples" / "pictures"
    chooser.value.set_files(samples / "teapot.png")
    book.wait_for("tracer.image.shape == (1400, 1600, 4) and tracer.cage.n_holes == 1")
    with hand.page.expect_file_chooser() as chooser:
        hand.button("Open a picture").click()
    chooser.value.set_files(Path(__file__))
    hand.root.locator(".glid-status", has_text="is not in a picture format").wait_for()
    assert book.value("tracer.cage.n_holes") == 1
    hand.page.evaluate(DROP, [hand.stage.element_handle(), [*(samples / "bar.png").read_bytes()]])
    book.wait_for("tracer.cage.n_holes == 0 and tracer.image.shape[0] < 1400")


DROP = """([stage, bytes]) => {
  const dataTransfer = new DataTransfer();
  dataTransfer.items.add(new File([new Uint8Array(bytes)], "bar.png", {type: "image/png"}));
  for (const name of ["dragenter", "dragover", "drop"]) {
    stage.dispatchEvent(new DragEvent(name, {dataTransfer, bubbles: true, cancelable: true}));
  }
}"""


def test_vertices_by_hand(open_notebook: OpenNotebook) -> None:
    hand = tracer_of(open_notebook, "frog")
    book, page = hand.book, hand.page
    n = book.value("tracer.cage.n_vertices")
    i = leftmost(hand)
    start = hand.vertex(0, i)
    end = (start[0] - 60, start[1] + 25)

    hand.drag(start, (start[0] - 100, start[1] - 100), end)
    hand.settle()
    np.testing.assert_allclose(hand.vertex(0, i), end, atol=1.5)
    assert book.value("tracer.tracing_model.edited")
    assert book.value("tracer.shown['problems']") == []
    page.keyboard.press("Control+z")  # one step for the whole drag
    hand.settle()
    np.testing.assert_allclose(hand.vertex(0, i), start, atol=1e-9)
    assert not book.value("tracer.tracing_model.can_undo")
    page.keyboard.press("Control+Shift+z")
    hand.settle()
    np.testing.assert_allclose(hand.vertex(0, i), end, atol=1.5)

    # A drag may end outside the stage.
    page.mouse.move(*hand.place(*hand.vertex(0, i)))
    page.mouse.down()
    page.mouse.move(30, 300, steps=5)
    page.mouse.up()
    hand.settle()
    assert hand.vertex(0, i)[0] < -10
    page.keyboard.press("Control+z")

    # Escape cancels.
    hand.settle()
    before = hand.vertex(0, i)
    page.mouse.move(*hand.place(*before))
    page.mouse.down()
    page.mouse.move(*hand.place(before[0] + 50, before[1] + 50), steps=4)
    page.keyboard.press("Escape")
    page.mouse.up()
    hand.settle()
    np.testing.assert_allclose(hand.vertex(0, i), before, atol=1e-9)

    # Added by a double click on an edge, deleted by the right button, and by the keyboard.
    a, b = np.array(hand.vertex(0, i)), np.array(hand.vertex(0, i + 1))
    page.mouse.dblclick(*hand.place(*((a + b) / 2)))
    book.wait_for(f"tracer.cage.n_vertices == {n + 1}")
    np.testing.assert_allclose(hand.vertex(0, i + 1), (a + b) / 2, atol=2)
    page.mouse.click(*hand.place(*hand.vertex(0, i + 1)), button="right")
    book.wait_for(f"tracer.cage.n_vertices == {n}")
    assert page.locator(".lm-Menu, .p-Menu").count() == 0  # JupyterLab's menu stays away
    page.mouse.click(*hand.place(*hand.vertex(0, i)))
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("ArrowLeft")
    hand.settle()
    assert hand.vertex(0, i)[0] == pytest.approx(before[0] - 2)
    page.keyboard.press("Delete")
    book.wait_for(f"tracer.cage.n_vertices == {n - 1}")

    # Dragged across the shape: shown with place and reason. The last valid cage is kept.
    cage = book.value("tracer.cage.exterior.tolist()")
    j = leftmost(hand)
    x, y = hand.vertex(0, j)
    hand.drag((x, y), (x + 900, y + 30))
    hand.settle()
    callout = hand.root.locator(".glid-callout")
    callout.wait_for()
    assert callout.inner_text().startswith("The outline crosses itself; move")
    assert "last valid cage is kept" in hand.status
    problem = book.value("tracer.shown['problems'][0]['point']")
    box = callout.bounding_box()
    assert box is not None
    px, py = hand.place(*problem)
    assert box["x"] - 30 < px < box["x"] + box["width"] + 30
    assert abs(py - box["y"]) < 60
    assert book.value("tracer.cage.exterior.tolist()") == cage
    book.screenshot("tracer-crossing", hand.root)
    hand.button("Undo").click()
    callout.wait_for(state="hidden")


def dominant(pixels: NDArray[np.uint8], color: tuple[int, int, int]) -> int:
    """How many pixels have nearly this colour."""
    wanted = np.broadcast_to(np.array(color) / 255, (*pixels.shape[:2], 3))
    return int((deltaE_ciede2000(rgb2lab(pixels[..., :3]), rgb2lab(wanted)) < 8).sum())


def test_scribbles_themes_and_a_reload(open_notebook: OpenNotebook) -> None:
    hand = tracer_of(open_notebook, "gingerbread")
    book = hand.book
    width, height = book.value("tracer.shown['size']")
    hand.button("Paint over the shape").click()
    hand.drag((width * 0.5, height * 0.25), (width * 0.5, height * 0.6))
    hand.settle()
    assert book.value("tracer.options.method") == "scribbles"
    assert book.value("len(tracer.options.scribbles.foreground)") == 1
    stroke = book.value("tracer.options.scribbles.foreground[0][[0, -1]].tolist()")
    ends = [[width * 0.5, height * 0.25], [width * 0.5, height * 0.6]]
    np.testing.assert_allclose(stroke, ends, atol=8)
    hand.root.get_by_role("button", name="Background", exact=True).click()
    hand.drag((20, 20), (20, height - 20), (width - 20, height - 20), (width - 20, 20))
    hand.settle()
    assert book.value("len(tracer.options.scribbles.background)") == 1
    assert book.value("tracer.shown['problems']") == []
    assert hand.root.get_by_role("radio", name="Scribbles").get_attribute("aria-checked") == "true"
    light = imread(book.screenshot("tracer-scribbles", hand.root))
    assert dominant(light, (0, 114, 178)) > 200
    assert dominant(light, (230, 159, 0)) > 200
    loops = book.value("[p.tolist() for p in tracer.tracing_model.loops]")

    book.theme("JupyterLab Dark")
    book.screenshot("tracer-dark", hand.root)
    dark = imread(book.screenshot("tracer-dark", hand.root))
    assert dark[..., :3].mean() < light[..., :3].mean() - 60
    book.theme("JupyterLab Light")

    book.reload()
    hand = Hand(book)
    hand.root.locator(".glid-status", has_text="Cage with").wait_for()
    assert book.value("[p.tolist() for p in tracer.tracing_model.loops]") == loops
    hand.page.wait_for_function(
        "root => root.querySelectorAll('[aria-checked=true]').length === 1",
        arg=hand.root.element_handle(),
    )
    hand.button("Undo").click()
    book.wait_for("len(tracer.options.scribbles.background) == 0")


def test_it_answers_while_another_cell_runs(open_notebook: OpenNotebook) -> None:
    hand = tracer_of(open_notebook, "frog")
    # Code that waits for an event, which only a change by hand sets.
    code = """
import threading
changed = threading.Event()
stop = tracer.on_change(changed.set)
in_time = changed.wait(60)
stop()
"""
    with hand.book.running(code):
        hand.root.get_by_role("radio", name="Brightness").click()
    assert hand.book.value("[in_time, tracer.options.method]") == [True, "threshold"]


def test_two_views_and_code_agree(open_notebook: OpenNotebook) -> None:
    book = open_notebook(
        [
            "import glid_nb as glid\nimport numpy as np",
            "tracer = glid.widgets.CageTracer(glid.samples.image('teapot'), height=240)\ntracer",
            "tracer",
        ]
    )
    first, second = Hand(book, 0), Hand(book, 1)
    second.root.get_by_role("radio", name="Alpha").click()
    book.wait_for("tracer.options.method == 'alpha'")
    first.root.locator("[role=radio][data-value=alpha][aria-checked=true]").wait_for()
    book.value("tracer.tracing_model.set_options(offset=31)")
    for hand in (first, second):
        hand.page.wait_for_function(
            "root => root.querySelector('[data-name=offset] input[type=number]').value === '31'",
            arg=hand.root.element_handle(),
        )


def test_touch(open_notebook: OpenNotebook) -> None:
    hand = tracer_of(open_notebook, "bar", has_touch=True)
    book, page = hand.book, hand.page
    session = page.context.new_cdp_session(page)

    def touch(kind: str, *points: tuple[float, float]) -> None:
        session.send(
            "Input.dispatchTouchEvent",
            {
                "type": kind,
                "touchPoints": [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)],
            },
        )

    i = leftmost(hand)
    x, y = hand.vertex(0, i)
    touch("touchStart", hand.place(x, y))
    for step in range(1, 6):
        touch("touchMove", hand.place(x - 6 * step, y - 2 * step))
    touch("touchEnd")
    hand.settle()
    np.testing.assert_allclose(hand.vertex(0, i), (x - 30, y - 10), atol=2)

    # Two fingers zoom and move the picture, not the vertex under one of them.
    scale = float((hand.stage.get_attribute("data-viewport") or "").split()[0])
    a, b = hand.place(*hand.vertex(0, i)), hand.place(600, 200)
    touch("touchStart", a)
    touch("touchStart", a, b)
    for step in range(1, 6):
        touch("touchMove", (a[0] - 8 * step, a[1]), (b[0] + 8 * step, b[1]))
    touch("touchEnd")
    page.wait_for_function(
        "([stage, scale]) => Number(stage.dataset.viewport.split(' ')[0]) > 1.1 * scale",
        arg=[hand.stage.element_handle(), scale],
    )
    hand.settle()
    np.testing.assert_allclose(hand.vertex(0, i), (x - 30, y - 10), atol=2)
    assert book.value("tracer.shown['problems']") == []

    # The kernel closes it during a drag. An error in the console would fail this test.
    touch("touchStart", hand.place(*hand.vertex(0, i)))
    place = hand.place(300, 200)
    book.value("tracer.close()")
    for step in range(5):
        touch("touchMove", (place[0] + 5 * step, place[1]))
    touch("touchEnd")
    hand.root.wait_for(state="detached")


def test_on_a_photograph_the_outline_is_drawn_by_hand(open_notebook: OpenNotebook) -> None:
    cells = ("import glid_nb\nimport numpy as np\nimport skimage.data",)
    editor = "editor = glid_nb.Editor(skimage.data.cat(), n_vertices=300)\ntracer = editor.tracer"
    hand = Hand(open_notebook((*cells, f"{editor}\neditor")))
    book, page = hand.book, hand.page
    box = hand.root.locator(".glid-by-hand.glid-guess")
    box.get_by_text("The outline is not clear").wait_for()
    assert hand.status.startswith("No outline yet")
    paint = hand.root.locator(".glid-toolbar").get_by_role("button", name="Paint over the shape")
    assert paint.get_attribute("aria-pressed") == "true"
    assert hand.root.get_by_role("heading", name="in the cage").is_hidden()
    book.screenshot("tracer-no-outline")
    box.get_by_role("button", name="Use the guess").click()
    n_holes = book.value("tracer.cage.n_holes")
    hand.root.get_by_role("heading", name=f"{n_holes} holes in the cage").wait_for()
    assert f"{n_holes} holes ·" in hand.status
    assert box.is_hidden()
    book.screenshot("tracer-guess")
    hand.button("Undo").click()
    box.wait_for()
    for name in ("Paint over it", "Rectangle", "Whole picture"):
        assert box.get_by_role("button", name=name).is_visible()
    box.get_by_role("button", name="Draw its outline").click()
    corners = ((60, 30), (380, 30), (380, 260), (60, 260))
    for corner in corners:
        page.mouse.click(*hand.place(*corner))
    page.keyboard.press("Enter")
    book.wait_for("tracer.cage.n_holes == 0")
    hand.settle()
    assert hand.status.endswith("and no holes")
    assert not box.is_visible()
    ends = book.value("[f(tracer.tracing_model.loops[0], 0).tolist() for f in (np.min, np.max)]")
    np.testing.assert_allclose(ends, [[60, 30], [380, 260]], atol=1)


def test_an_outline_inside_the_shape_is_asked_about(open_notebook: OpenNotebook) -> None:
    hand = tracer_of(open_notebook, "bar")
    question = hand.root.get_by_role("group", name="What you drew")
    outline = np.array(hand.book.value("model.loops[0].tolist()", SHORT))
    (left, top), (wide, high) = outline.min(axis=0), np.ptp(outline, axis=0)

    def draw_inside() -> None:
        assert question.is_hidden()
        canvas = hand.stage.locator("canvas").last
        canvas.focus()
        # A hand that drags at once does not move the view.
        assert canvas.evaluate(_TOOL_AFTER, "r") == "rectangle"
        hand.drag((left + 0.4 * wide, top + 0.4 * high), (left + 0.6 * wide, top + 0.6 * high))
        hand.settle()
        question.wait_for()

    draw_inside()
    hand.book.screenshot("tracer-hole-or-outline")
    question.get_by_role("button", name="nothing").click()
    hand.settle()
    assert hand.book.value("len(model.loops)", SHORT) == 1
    draw_inside()
    question.get_by_role("button", name="a hole").click()
    hand.settle()
    assert hand.book.value("len(model.loops)", SHORT) == 2
    hand.button("Undo").click()
    hand.settle()
    draw_inside()
    question.get_by_role("button", name="the new outline").click()
    hand.settle()
    size = hand.book.value("np.ptp(model.loops[0], axis=0).tolist()", SHORT)
    np.testing.assert_allclose(size, [0.2 * wide, 0.2 * high], atol=2)
    assert question.is_hidden()
