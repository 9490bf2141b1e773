"""A reference picture behind the shape, in a real browser."""

from __future__ import annotations

import io
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageDraw

from .conftest import OpenNotebook
from .editor_page import EDITOR, NEW_PICTURE, SETUP, Hand, choose_view

pytestmark = [pytest.mark.browser, pytest.mark.slow]

_STYLE = "pane => getComputedStyle(pane, '::before').{}"


def test_a_picture_lies_dimmed_behind_the_shape(
    open_notebook: OpenNotebook, tmp_path: Path
) -> None:
    drawn = Image.new("RGB", (2400, 1200), "white")
    pen = ImageDraw.Draw(drawn)
    pen.rectangle((0, 0, 600, 300), fill="red")
    pen.line((300, 900, 1200, 300, 2100, 900), fill="black", width=60)
    drawn.save(tmp_path / "pose.png")
    (tmp_path / "broken.png").write_bytes(b"no picture")

    book = open_notebook([SETUP, NEW_PICTURE + EDITOR])
    hand, page = Hand(book), book.page
    book.value("None", setup=f"editor.export({str(tmp_path / 'before.png')!r})")

    def choose(name: str) -> None:
        with page.expect_file_chooser() as chooser:
            choose_view(page, "Reference picture…", closes=True)
        chooser.value.set_files(tmp_path / name)

    choose("broken.png")
    page.get_by_text("broken.png is not a picture").wait_for()
    choose("pose.png")
    book.wait_for("len(canvas.pane.stage.reference) > 0")
    pane = page.locator(".glid-pane.glid-referenced")
    pane.wait_for()
    size = book.value(
        "Image.open(io.BytesIO(stage.reference)).size",
        "import io; from PIL import Image; stage = canvas.pane.stage",
    )
    assert size == [1600, 800]  # smaller than the file

    # It covers the frame of the editor's picture, which has the same shape, and moves with it.
    def corners() -> np.ndarray:
        places = hand.places([(-10, 5), (10, -5)])  # which may scroll
        box = hand.pad.bounding_box()
        assert box is not None
        places = np.array(places) - [box["x"], box["y"]]
        return np.array([*places[0], *(places[1] - places[0])])

    def shown() -> np.ndarray:
        names = "Position", "Size"
        styles = [pane.evaluate(_STYLE.format(f"background{name}")) for name in names]
        lengths = [length for style in styles for length in style.split()]
        return np.array([float(length.removesuffix("px")) for length in lengths])

    np.testing.assert_allclose(shown(), corners(), atol=0.6)
    for theme in ("Dark", "Light"):
        book.theme(f"JupyterLab {theme}")
        book.screenshot(f"reference-{theme.lower()}")
    before = shown()
    size = pane.evaluate(_STYLE.format("backgroundSize"))
    hand.pad.focus()
    page.mouse.move(*hand.place((-7, 1)))
    page.mouse.wheel(0, -200)
    page.wait_for_function(
        "([pane, size]) => getComputedStyle(pane, '::before').backgroundSize !== size",
        arg=[pane.element_handle(), size],
    )
    assert shown()[2] > before[2]

    # No export has it.
    book.value("None", setup=f"editor.export({str(tmp_path / 'after.png')!r})")
    assert (tmp_path / "after.png").read_bytes() == (tmp_path / "before.png").read_bytes()
    choose_view(page, "Remove the reference", closes=True)
    pane.wait_for(state="detached")
    assert book.value("len(canvas.pane.stage.reference)") == 0

    # By code.
    book.value("None", setup="canvas.set_reference(picture)")
    pane.wait_for()
    page.set_viewport_size({"width": 390, "height": 844})
    hand.wait_until_still()
    book.screenshot("reference-390")
    page.set_viewport_size({"width": 1366, "height": 768})


def test_the_reference_lies_over_the_background_and_under_the_shape(
    open_notebook: OpenNotebook,
) -> None:
    book = open_notebook([SETUP, NEW_PICTURE + EDITOR])
    hand, page = Hand(book), book.page
    beside, on_shape, outside = (0, 4), (0, 0), (0, 6)

    def color(point: tuple[float, float]) -> np.ndarray:
        """The mean colour of the screen around a point of the world."""
        x, y = hand.place(point)
        shot = page.screenshot(clip={"x": x - 2, "y": y - 2, "width": 5, "height": 5})
        pixels = np.asarray(Image.open(io.BytesIO(shot)).convert("RGB"))
        return pixels.reshape(-1, 3).mean(axis=0)

    def wait_for_color(point: tuple[float, float], wanted: np.ndarray) -> None:
        end = time.monotonic() + 20
        while np.abs(color(point) - wanted).max() > 3:
            assert time.monotonic() < end, f"{color(point)}, not {wanted}"

    shape, stage = color(on_shape), color(outside)
    yellow, blue = np.array([255, 220, 0]), np.array([0, 0, 255])
    book.value("None", setup="editor.background = (255, 220, 0)")
    wait_for_color(beside, yellow)
    dimmed = 0.62 * yellow + 0.38 * blue
    set_blue = "blue = np.zeros((50, 100, 4), np.uint8); blue[..., 2:] = 255"
    book.value("None", setup=f"{set_blue}; canvas.set_reference(blue)")
    wait_for_color(beside, dimmed)
    wait_for_color(on_shape, shape)
    wait_for_color(outside, stage)
    for theme in ("Dark", "Light"):
        book.theme(f"JupyterLab {theme}")
        book.screenshot(f"reference-over-background-{theme.lower()}")

    # Another background comes under it too, also a picture. Without it all is as before.
    book.value("None", setup="editor.background = (255, 255, 255)")
    wait_for_color(beside, 0.62 * np.array([255, 255, 255]) + 0.38 * blue)
    book.value("None", setup="editor.background = 'filled'")
    hand.settle()
    book.value("None", setup="canvas.set_reference(None)")
    page.locator(".glid-referenced").wait_for(state="detached")
    book.value("None", setup="editor.background = (255, 220, 0)")
    wait_for_color(beside, yellow)
