"""The live page in a browser, opened from disk with the network off."""

from __future__ import annotations

import io
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, Download, Page, expect
from skimage.io import imread

import glid_check
from glid_nb import HarmonicMap, Motion
from glid_nb.export import live_page_html

from ..support import shapes
from ..support.browser import ARTEFACTS, wait_until, watched_page

pytestmark = [pytest.mark.browser, pytest.mark.slow]

# Collects every bound that the page shows, what it copies, and whether it asks for anything.
_WATCHED = """
window.bounds = [];
document.addEventListener("DOMContentLoaded", () => {
  const bound = document.getElementById("bound");
  new MutationObserver(() => window.bounds.push(bound.textContent))
    .observe(bound, { childList: true, characterData: true, subtree: true });
});
Object.defineProperty(navigator, "clipboard", {
  value: { writeText: async (text) => { window.copied = text; } },
});
"""
# A clock that stands still, so that every way to draw seems quick.
_QUICK = "performance.now = () => 0;"
_SETTLED = "() => document.documentElement.dataset.settled === 'true'"


def opened(page: Page, folder: Path, shown: Any = None, pose: Any = None) -> list[str]:
    """Open a live page of the ring. Returns a list of the requests that it makes."""
    path = folder / "ring.html"
    html = live_page_html(shapes.picture(), shown or shapes.domain(), pose, title="Ring")
    path.write_text(html, encoding="utf-8")
    requests: list[str] = []
    page.on("request", lambda request: requests.append(request.url))
    page.context.set_offline(True)
    page.goto(path.as_uri())
    page.wait_for_selector("html[data-ready=true]", state="attached")
    return [url for url in requests if not url.startswith(("file:", "data:", "blob:"))]


def on_screen(page: Page, x: float, y: float) -> tuple[float, float]:
    """Where a point of the world is in the window."""
    return tuple(page.evaluate("([x, y]) => window.glidPage.view.toScreen([x, y])", [x, y]))


def place(page: Page, x: float, y: float) -> None:
    page.mouse.move(*on_screen(page, x, y))


def pin(page: Page, x: float, y: float) -> None:
    page.mouse.click(*on_screen(page, x, y))
    page.wait_for_function(_SETTLED)


def drag(page: Page, start: tuple[float, float], end: tuple[float, float], moves: int = 8) -> None:
    place(page, *start)
    page.mouse.down()
    for share in np.linspace(1 / moves, 1, moves):
        place(page, *(np.array(start) + share * (np.array(end) - start)))
    page.mouse.up()
    page.wait_for_function(_SETTLED)


def status(page: Page) -> str:
    page.wait_for_function(_SETTLED)
    return page.locator("#status").inner_text()


def lowest_bound(page: Page) -> float:
    shown = page.evaluate("window.bounds")
    return min(float(re.findall(r"σ₂ ≥ ([\d.e-]+)", text)[0]) for text in shown)


def downloads(page: Page, label: str, count: int) -> list[Download]:
    """The files that an entry of the menu saves."""
    found: list[Download] = []
    page.on("download", lambda one: found.append(one))
    page.get_by_role("button", name="Copy, download, reset").click()
    page.get_by_role("button", name=label).click()
    wait_until(page, lambda: len(found) == count, f"{count} files are saved")
    return found


def shown(page: Page) -> np.ndarray:
    return imread(io.BytesIO(page.locator("#pad").screenshot()))[..., :3].astype(float)


def still(page: Page) -> np.ndarray:
    """What is shown, once nothing moves any more."""
    before = shown(page)
    while (now := shown(page)).tobytes() != before.tobytes():
        before = now
    return now


def test_pins_are_dragged_and_the_shape_follows_certified(browser: Browser, tmp_path: Path) -> None:
    """Whether it has followed is told by the saved map, and what is proved, by glid-check."""
    with watched_page(browser, _WATCHED) as page:
        requests = opened(page, tmp_path)
        pin(page, -6, 1)
        pin(page, 5.2, 0)
        assert status(page).startswith("Pin 2 of 2, at 5.2")
        drag(page, (5.2, 0), (6.5, 2.5))
        assert status(page) == "Pin 2 of 2, at 6.5, 2.5"
        assert lowest_bound(page) > 0
        map_file, proof_file = downloads(page, "Download the map and its proof", 2)
        assert (map_file.suggested_filename, proof_file.suggested_filename) == (
            "Ring.map.json",
            "Ring.proof.json",
        )
        assert glid_check.main([str(map_file.path()), str(proof_file.path())]) == 0
        map = HarmonicMap.from_dict(json.loads(map_file.path().read_text(encoding="utf-8")))
        page.get_by_role("button", name="Copy, download, reset").click()
        page.get_by_role("button", name="Copy the pose as Python").click()
        made: dict[str, Any] = {}
        exec(page.evaluate("window.copied"), made)
        assert made["domain"].cage.equals(map.domain.cage)
        np.testing.assert_allclose(map(made["pose"].handles), made["pose"].targets, atol=0.05)
        assert made["result"].certificate.certified
        assert not requests


def test_a_page_that_cannot_draw_claims_nothing(browser: Browser, tmp_path: Path) -> None:
    path = tmp_path / "ring.html"
    path.write_text(live_page_html(shapes.picture(), shapes.domain()), encoding="utf-8")
    with watched_page(browser, "HTMLCanvasElement.prototype.getContext = () => null;") as page:
        page.goto(path.as_uri())
        page.get_by_text("This page needs WebGL 2").wait_for()
        assert page.get_by_text("Never folds").is_hidden()
        assert page.get_by_text("Click the shape").is_hidden()
        page.screenshot(path=ARTEFACTS / "live-page-without-webgl.png")


def test_undo_redo_delete_and_keys(browser: Browser, tmp_path: Path) -> None:
    with watched_page(browser, _WATCHED) as page:
        opened(page, tmp_path)
        before = shown(page)
        pin(page, -6, 1)
        pin(page, 5.2, 0)
        drag(page, (5.2, 0), (5.2, 3))
        assert np.abs(shown(page) - before).max() > 30
        page.keyboard.press("Control+z")
        assert status(page) == "Pin 2 of 2, at 5.2, 0.0"
        page.keyboard.press("Control+Shift+Z")
        assert status(page) == "Pin 2 of 2, at 5.2, 3.0"
        page.keyboard.press("Shift+ArrowUp")
        page.keyboard.press("ArrowLeft")
        assert status(page) == "Pin 2 of 2, at 5.1, 3.5"
        page.keyboard.press(",")
        assert status(page).startswith("Pin 1 of 2")
        page.keyboard.press("Delete")
        page.keyboard.press(".")
        assert status(page).startswith("Pin 1 of 1")
        page.keyboard.press("<")  # turns the shape at the pin
        page.wait_for_function(_SETTLED)
        assert lowest_bound(page) > 0
        # Beside the shape a drag moves the view, and the wheel zooms.
        x, y, unit = page.evaluate("(({ x, y, unit }) => [x, y, unit])(window.glidPage.view)")
        page.mouse.move(1000, 600)
        page.mouse.down()
        page.mouse.move(1040, 610, steps=3)
        page.mouse.up()
        moved = page.evaluate("[window.glidPage.view.x, window.glidPage.view.y]")
        np.testing.assert_allclose(moved, [x - 40 * unit, y + 10 * unit])
        page.mouse.wheel(0, -200)
        page.wait_for_function("unit => window.glidPage.view.unit < unit", arg=unit)
        page.keyboard.press("f")
        # The keyboard alone: a cursor, and a pin there.
        page.keyboard.press("0")
        page.keyboard.press("Escape")
        page.keyboard.press("Enter")
        for _ in range(10):
            page.keyboard.press("Shift+ArrowLeft")
        page.keyboard.press("Enter")
        assert status(page).startswith("Pin 1 of 1, at -")


def test_a_pin_that_is_not_reached_says_so(browser: Browser, tmp_path: Path) -> None:
    """Three pins that the targets turn over, far apart: the shape stays behind, and unfolded.

    Each drag is one jump, so that the way does not depend on the time that a step takes.
    """
    with watched_page(browser, _WATCHED) as page:
        opened(page, tmp_path)
        for point in ((-7.2, -0.6), (-4, -0.6), (-5.6, 1.6)):
            pin(page, *point)
        drag(page, (-5.6, 1.6), (-5.6, -6), moves=1)
        drag(page, (-7.2, -0.6), (-12, -4), moves=1)
        assert lowest_bound(page) > 0
        assert "does not reach pin" in status(page)
        page.screenshot(path=ARTEFACTS / "live-missed.png")


def test_kept_poses_play_and_every_frame_is_certified(browser: Browser, tmp_path: Path) -> None:
    with watched_page(browser, _WATCHED) as page:
        opened(page, tmp_path)
        pin(page, -6, 1)
        pin(page, 5.2, 0)
        page.get_by_role("button", name="Keep pose").click()
        drag(page, (5.2, 0), (6.5, 2.5))
        page.get_by_role("button", name="Keep pose").click()
        marked = page.locator(".poses button[aria-current=true]")
        assert marked.get_attribute("title") == "Pose 2, at 1.00 s"
        play = page.get_by_role("button", name="Play")
        play.click()  # waits until the way between the poses is found
        page.wait_for_function("() => document.querySelector('.track input').value > 0.3")
        page.get_by_role("button", name="Pause").click()
        assert lowest_bound(page) > 0
        moving = shown(page)
        place(page, 0, 6.6)
        page.mouse.down()  # the first touch goes back to the pose that is edited
        page.mouse.up()
        gone_back = lambda: np.abs(shown(page) - moving).max() > 30  # noqa: E731
        wait_until(page, gone_back, "the edited pose is shown")
        page.get_by_role("button", name="Pose 1").click()
        page.wait_for_function(_SETTLED)
        page.get_by_role("button", name="Remove this pose").click()
        assert page.locator(".poses button").count() == 1
        assert play.is_hidden()


def test_a_motion_plays_in_the_live_page(browser: Browser, tmp_path: Path) -> None:
    motion = Motion([HarmonicMap.identity(shapes.domain()), shapes.bent()])
    start = shapes.pose().with_targets(shapes.pose().handles)
    with watched_page(browser, _WATCHED) as page:
        opened(page, tmp_path, motion, [start, shapes.pose()])
        assert page.locator(".poses button").count() == 2
        page.get_by_role("button", name="Play").click()
        page.wait_for_function("() => document.querySelector('.track input').value > 0.3")
        page.get_by_role("button", name="Pause").click()
        assert lowest_bound(page) > 0
        page.get_by_role("button", name="Pose 2").click()
        page.wait_for_function("() => document.querySelector('.track input').value > 0.99")
        page.wait_for_function(_SETTLED)
        page.keyboard.press(".")
        x, y = shapes.pose().targets[0]
        assert status(page) == f"Pin 1 of 2, at {x:.1f}, {y:.1f}"


def test_the_proof_of_a_motions_frame_is_that_of_the_map_that_is_shown(
    browser: Browser, tmp_path: Path
) -> None:
    bent, rest = shapes.bent(), HarmonicMap.identity(shapes.domain())
    with watched_page(browser, _WATCHED) as page:
        opened(page, tmp_path, Motion([rest, bent]), [shapes.pose()] * 2)
        slider = page.locator(".track input")
        bound = page.locator("#bound").text_content()
        slider.fill("0.5")
        changed = "before => document.getElementById('bound').textContent !== before"
        page.wait_for_function(changed, arg=bound)
        time = slider.input_value()
        map_file, proof_file = downloads(page, "Download the map and its proof", 2)
        shown = HarmonicMap.load(map_file.path())
        assert glid_check.main([str(map_file.path()), str(proof_file.path())]) == 0
        # Neither the pose that is edited nor that of the end.
        for end in (rest, bent):
            assert abs(shown.phi - end.phi).max() > 0.01
        assert slider.input_value() == time


def test_both_ways_to_draw_show_the_same(browser: Browser, tmp_path: Path) -> None:
    pictures, movers = [], []
    for script in (_WATCHED, _WATCHED + _QUICK):
        with watched_page(browser, script) as page:
            opened(page, tmp_path, shapes.bent())
            movers.append(page.evaluate("document.documentElement.dataset.mover"))
            page.get_by_label("What is shown").select_option("Grid")
            page.mouse.move(5, 760)
            pictures.append(still(page)[100:650, 50:1100])
    assert movers[1] == "shader"
    difference = np.abs(pictures[0] - pictures[1]).max(axis=2)
    assert np.percentile(difference, 99) < 40
    assert difference.mean() < 2


def test_the_colours_say_which_values_share_the_last_one(page: Page, tmp_path: Path) -> None:
    opened(page, tmp_path, shapes.bent())
    for colours, ends in (("Stretch σ₁", "1≥ 2"), ("Stretch σ₂", "1≤ 0.4")):
        page.get_by_label("What is shown").select_option(colours)
        assert page.locator("#legend").inner_text() == f"{colours} {ends}"


def test_a_phone_pins_by_taps_and_zooms_by_two_fingers(browser: Browser, tmp_path: Path) -> None:
    phone: Any = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}
    with watched_page(browser, _WATCHED, **phone) as page:
        opened(page, tmp_path)
        assert page.evaluate("document.documentElement.scrollWidth") == 390
        page.touchscreen.tap(*on_screen(page, -6, 1))
        assert status(page).startswith("Pin 1 of 1, at -6.0, 1.0")
        for name in ("Undo", "Redo", "Remove the selected pins", "Copy, download", "Keys and"):
            box = page.get_by_role("button", name=name).bounding_box()
            assert box is not None
            assert min(box["width"], box["height"]) >= 40
            assert box["x"] + box["width"] <= 390
        before = page.evaluate("window.glidPage.view.unit")
        touch = page.context.new_cdp_session(page)
        for apart, kind in ((40, "touchStart"), (60, "touchMove"), (90, "touchMove")):
            points = [{"x": 195 + side * apart, "y": 400, "id": i} for i, side in ((0, -1), (1, 1))]
            touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
        touch.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
        assert page.evaluate("window.glidPage.view.unit") < 0.7 * before
        assert status(page).startswith("Pin 1 of 1")
        # So soon after the fingers were lifted, Chromium may make no click of a tap; no event tells
        # when it does. A hand takes longer.
        lifted = page.evaluate("performance.now()")
        page.wait_for_function("lifted => performance.now() > lifted + 500", arg=lifted)
        remove = page.get_by_role("button", name="Remove the selected pins")
        remove.tap()
        expect(remove).to_be_disabled()
        page.screenshot(path=ARTEFACTS / "live-phone.png")
