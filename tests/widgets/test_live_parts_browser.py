"""The live page of several shapes in a browser, opened from disk with the network off."""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser, Page
from skimage.io import imread

import glid_check
from glid_nb import HarmonicMap
from glid_nb.imaging import PixelFrame
from glid_nb.imaging.backdrop import over
from glid_nb.imaging.render import draw_mesh, mesh_in
from glid_nb.imaging.texture import Texture
from glid_nb.session.editor_model import EditorModel
from glid_nb.widgets import exporting

from ..support.axe import faults
from ..support.browser import ARTEFACTS, watched_page
from ..support.two_disks import two_disks
from .test_live_page_browser import (
    _SETTLED,
    _WATCHED,
    downloads,
    drag,
    lowest_bound,
    on_screen,
    pin,
    status,
)

pytestmark = [pytest.mark.browser, pytest.mark.slow]

_CARDS = "main > :not(#pad), .paper { visibility: hidden }"


@pytest.fixture(scope="module")
def model() -> Iterator[EditorModel]:
    with two_disks() as made:
        yield made


def opened(page: Page, model: EditorModel, folder: Path) -> None:
    (path,) = exporting.export(model, folder / "two.html", live=True)
    page.context.set_offline(True)
    page.goto(path.as_uri())
    page.wait_for_selector("html[data-ready=true]", state="attached")


def saved_maps(page: Page) -> list[HarmonicMap]:
    """The maps that are shown, after `glid-check` has read their proofs."""
    files = downloads(page, "Download the maps and their proofs", 4)
    names = [one.suggested_filename for one in files]
    assert names == [f"two-{part}.{kind}.json" for part in ("red", "blue") for kind in _KINDS]
    paths = [str(one.path()) for one in files]
    for map_file, proof_file in zip(paths[::2], paths[1::2], strict=True):
        assert glid_check.main([map_file, proof_file]) == 0
    return [HarmonicMap.load(path) for path in paths[::2]]


_KINDS = "map", "proof"


def check_picture(page: Page, model: EditorModel, maps: list[HarmonicMap]) -> None:
    """Compare the page with its maps as they are rendered, the rearmost first."""
    cards = page.add_style_tag(content=_CARDS)
    view = page.evaluate("(({ x, y, unit }) => [x, y, unit])(window.glidPage.view)")
    seen = imread(io.BytesIO(page.locator("#pad").screenshot()))[..., :3].astype(float)
    cards.evaluate("style => style.remove()")
    height, width = seen.shape[:2]
    x, y, unit = view
    middle = np.array([x, y])
    half = np.array([width, height]) * unit / 2
    frame = PixelFrame(width, height).showing([middle - half, middle + half], 0)
    expected = np.full((height, width, 4), 255, np.uint8)
    for shape, map in zip(model.shapes, maps, strict=True):
        texture = Texture.from_image(shape.layers.image)
        drawn = draw_mesh(texture, mesh_in(frame, map, None), frame)
        expected = over(drawn, expected)
    difference = np.abs(seen - expected[..., :3]).max(axis=2)
    assert (expected[..., :3] < 250).any(axis=2).mean() > 0.2
    assert difference.mean() < 2
    assert np.percentile(difference, 95) < 16


def test_two_parts_are_dragged_and_each_is_proved(
    model: EditorModel, browser: Browser, tmp_path: Path
) -> None:
    with watched_page(browser, _WATCHED) as page:
        opened(page, model, tmp_path)
        before = saved_maps(page)
        pin(page, 2, 1)
        assert status(page).startswith("Pin 3 of 3, at 2.0, 1.0")
        drag(page, (5, -1), (6.5, -2))
        assert status(page) == "Pin 4 of 4, at 6.5, -2.0"
        x, y = model.shapes[0].state.poses[0].pose.targets[1]
        drag(page, (x, y), (x - 0.8, y - 0.4))
        assert status(page).startswith(f"Pin 2 of 4, at {x - 0.8:.1f}")
        assert lowest_bound(page) > 0
        page.mouse.move(5, 760)
        page.screenshot(path=ARTEFACTS / "live-parts.png")
        maps = saved_maps(page)
        for old, new in zip(before, maps, strict=True):
            assert abs(old.phi - new.phi).max() > 0.01
        check_picture(page, model, maps)
        # Undo goes back over both, the last change first.
        page.keyboard.press("Control+z")
        assert status(page).startswith(f"Pin 2 of 4, at {x:.1f}")
        page.keyboard.press("Control+z")
        page.keyboard.press("Control+z")
        page.keyboard.press("Control+z")
        page.wait_for_function(_SETTLED)
        assert page.evaluate("window.glidPage.editing.pins.length") == 2
        check_picture(page, model, before)


def test_a_motion_of_two_parts_shows_proved_frames_of_both(
    model: EditorModel, browser: Browser, tmp_path: Path
) -> None:
    with watched_page(browser, _WATCHED) as page:
        opened(page, model, tmp_path)
        assert page.locator(".poses button").count() == 2
        page.get_by_role("button", name="Play").click()
        page.wait_for_function("() => document.querySelector('.track input').value > 0.5")
        page.get_by_role("button", name="Pause").click()
        assert lowest_bound(page) > 0
        check_picture(page, model, saved_maps(page))
        page.get_by_role("button", name="Pose 2").click()
        page.wait_for_function("() => document.querySelector('.track input').value > 0.99")
        page.wait_for_function(_SETTLED)
        check_picture(page, model, saved_maps(page))
        # A pose of the reader's joins the motion: the solvers of both parts find the way.
        pin(page, 2, 1)
        drag(page, (2, 1), (3, 2))
        x, y = model.shapes[0].state.poses[1].pose.targets[1]
        drag(page, (x, y), (x - 1, y))
        page.get_by_role("button", name="Keep pose").click()
        assert page.locator(".poses button").count() == 3
        slider = page.locator(".track input")
        page.wait_for_function("() => document.querySelector('.track input').max === '4'")
        bound = page.locator("#bound").text_content()
        slider.fill("1.52")
        changed = "before => document.getElementById('bound').textContent !== before"
        page.wait_for_function(changed, arg=bound)
        check_picture(page, model, saved_maps(page))
        assert lowest_bound(page) > 0


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_phone_drags_both_parts_without_a_fault(
    model: EditorModel, browser: Browser, tmp_path: Path, scheme: str
) -> None:
    phone = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}
    with watched_page(browser, _WATCHED, **phone, color_scheme=scheme) as page:
        opened(page, model, tmp_path)
        assert page.evaluate("document.documentElement.scrollWidth") == 390
        assert faults(page) == []
        page.touchscreen.tap(*on_screen(page, 3, 0))
        assert status(page).startswith("Pin 3 of 3")
        finger(page, (3, 0), (4.2, -0.8))
        assert status(page).startswith("Pin 3 of 3, at 4.2, -0.8")
        x, y = model.shapes[0].state.poses[0].pose.targets[1]
        finger(page, (x, y), (x - 0.8, y - 0.4))
        assert status(page).startswith(f"Pin 2 of 3, at {x - 0.8:.1f}")
        page.screenshot(path=ARTEFACTS / f"live-parts-phone-{scheme}.png")
        assert lowest_bound(page) > 0
        for button in ("Copy, download, reset", "Keys and gestures"):
            page.get_by_role("button", name=button).first.tap()
            page.locator(":popover-open").first.wait_for()
            page.screenshot(path=ARTEFACTS / f"live-parts-phone-{scheme}-{button[:4]}.png")
            assert faults(page) == []
            page.keyboard.press("Escape")
            page.locator(":popover-open").wait_for(state="hidden")
        check_picture(page, model, saved_maps(page))


def finger(page: Page, start: tuple[float, float], end: tuple[float, float]) -> None:
    """Drag with a finger, in eight moves."""
    touch = page.context.new_cdp_session(page)
    way = np.linspace(start, end, 9)
    for point, kind in zip(way, ["touchStart", *["touchMove"] * 8], strict=True):
        x, y = on_screen(page, *point)
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": x, "y": y}]})
    touch.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    page.wait_for_function(_SETTLED)
