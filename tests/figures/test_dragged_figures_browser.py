"""Figures with a point to drag, in a real browser, without a kernel."""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, Locator, Page

from glid_nb import figures
from glid_nb.figures.drawing import NotebookFigure

from ..support.browser import launched_chromium

pytestmark = [pytest.mark.browser, pytest.mark.slow]


def show(x: float, y: float) -> NotebookFigure:
    return figures.function([0, 4], {"line": [x, y]})


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with launched_chromium() as found:
        yield found


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A page with a figure whose point moves on a grid of 5 by 5 places."""
    drawn = figures.live(show, 1, 1, point=lambda x, y: (x, y), x=range(5), y=range(5))
    body = drawn._repr_mimebundle_()[0]["text/html"]
    path = tmp_path_factory.mktemp("figure") / "figure.html"
    path.write_text(f"<!doctype html><meta charset='utf-8'>{body}", encoding="utf-8")
    return path


def middle(ring: Locator) -> tuple[float, float]:
    box = ring.bounding_box()
    assert box is not None
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def values(page: Page) -> list[str]:
    return page.locator("output").all_inner_texts()


def place(page: Page, x: int, y: int) -> tuple[float, float]:
    """Where the ring is on the screen after the sliders were moved to x and y."""
    for name, value in (("x", x), ("y", y)):
        page.get_by_label(name).fill(str(value))
    return middle(page.locator(".glid-ring"))


def opened(page: Page, file: Path) -> Page:
    page.goto(file.as_uri())
    page.locator(".glid-ring").wait_for()
    return page


def test_a_dragged_ring_moves_the_sliders_and_the_picture(browser: Browser, file: Path) -> None:
    page = opened(browser.new_page(viewport={"width": 1366, "height": 768}), file)
    picture = page.locator(".glid-frames img")
    far, near = place(page, 4, 3), place(page, 1, 1)
    picture.evaluate("(picture) => picture.decode()")
    before = picture.screenshot()
    page.mouse.move(near[0] + 6, near[1] - 5)
    page.mouse.down()
    page.mouse.move(far[0] + 9, far[1] - 8)  # the hand keeps its distance from the middle
    assert values(page) == ["4", "3"]
    assert middle(page.locator(".glid-ring")) == pytest.approx(far, abs=0.5)
    assert picture.get_attribute("alt") == "x = 4, y = 3"
    page.mouse.up()
    picture.evaluate("(picture) => picture.decode()")
    assert picture.screenshot() != before
    page.mouse.move(*near)
    assert values(page) == ["4", "3"], "a released ring does not follow"


def test_a_finger_drags_the_ring_on_a_phone_and_the_page_stays(
    browser: Browser, file: Path
) -> None:
    context = browser.new_context(
        viewport={"width": 390, "height": 300}, has_touch=True, is_mobile=True
    )
    page = opened(context.new_page(), file)
    page.evaluate("document.body.style.minHeight = '2000px'")
    (x1, y1), (x0, y0) = place(page, 1, 3), place(page, 3, 1)
    session = context.new_cdp_session(page)
    steps = [(x0, y0), ((x0 + x1) / 2, (y0 + y1) / 2), (x1, y1)]
    for kind, (x, y) in zip(("touchStart", "touchMove", "touchMove"), steps, strict=True):
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": x, "y": y}]})
    session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    assert values(page) == ["1", "3"]
    assert page.evaluate("window.scrollY") == 0
    context.close()


def in_planes(x: float, y: float) -> NotebookFigure:
    circle = np.exp(1j * np.linspace(0, 2 * np.pi, 60))
    return figures.planes(
        {"circle": 2 * circle, "z": x + 1j * y}, {"z circle": (x + 1j * y) * circle}
    )


def test_on_a_phone_panels_are_below_each_other_and_the_ring_stays_on_its_dot(
    browser: Browser, tmp_path: Path
) -> None:
    steps = [-1, 0, 1]
    drawn = figures.live(in_planes, 1, 1, point=lambda x, y: x + 1j * y, x=steps, y=steps)
    path = tmp_path / "planes.html"
    phone = '<meta name="viewport" content="width=device-width">'
    body = drawn._repr_mimebundle_()[0]["text/html"]
    path.write_text(f"<!doctype html><meta charset='utf-8'>{phone}{body}", encoding="utf-8")
    page = opened(browser.new_page(viewport={"width": 390, "height": 844}), path)
    picture = page.locator(".glid-frames img")
    narrow = picture.bounding_box()
    assert narrow is not None
    assert narrow["height"] > 1.2 * narrow["width"]
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    low, high = place(page, 0, 0), place(page, 2, 2)
    page.mouse.move(*high)
    page.mouse.down()
    page.mouse.move(*low)
    page.mouse.up()
    assert values(page) == ["-1", "-1"]
    picture.evaluate("(picture) => picture.decode()")
    shot = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
    at = tuple(round(one) for one in middle(page.locator(".glid-ring")))
    orange = np.array([230, 159, 0])  # mixed with the white of the ring's inside
    assert (np.array(shot.getpixel(at)) - orange <= [10, 60, 100]).all()
    page.set_viewport_size({"width": 800, "height": 600})
    page.wait_for_function("document.querySelector('.glid-frames img').clientWidth > 500")
    wide = picture.bounding_box()
    assert wide is not None
    assert wide["height"] < wide["width"]
    page.close()
