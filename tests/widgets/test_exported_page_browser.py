"""The exported page in a browser, from a file: the same picture as a rendering."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, Page
from skimage.io import imread

from glid_nb import Motion, samples
from glid_nb.certificate import certify
from glid_nb.export import animate, page_html
from glid_nb.export.moving import MovingMesh
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import PixelFrame, trace
from glid_nb.imaging.mesh import deformed_mesh
from glid_nb.imaging.render import draw_mesh, render
from glid_nb.imaging.texture import Texture
from glid_nb.pose import Pose

from ..support import shapes
from ..support.browser import ARTEFACTS, bring_into_view, watched_page

_LOW = ("header p", "main canvas", "#poses", "#play", "#time", "#clock", "#overlay", "#fit")
# Pauses in the frame in which the condition holds. A slow browser would have moved on.
_PAUSED_NEAR_POSE_2 = """() => {
    if (Math.abs(document.querySelector("#time").value - 1) > 0.6) return false;
    document.querySelector("#play").click();
    return true;
}"""


def shown(page: Page) -> np.ndarray:
    """The canvas as (h, w, 3) numbers."""
    return imread(io.BytesIO(page.locator("main canvas").screenshot()))[..., :3].astype(float)


def drawn(image: np.ndarray, motion: Motion, time: float, size: tuple[int, int]) -> np.ndarray:
    """The expected page: the map at a time, in the frame that holds the whole motion."""
    mesh = MovingMesh.of(motion, None, 4000, 0.004)
    corners = [mesh.images.min(axis=(0, 1)), mesh.images.max(axis=(0, 1))]
    frame = PixelFrame(*size).showing(corners, 0.04)
    exact = deformed_mesh(motion(time), 4000, 0.004)
    pixels = draw_mesh(Texture.from_image(image), exact, frame).astype(float)
    alpha = pixels[..., 3:] / 255
    return pixels[..., :3] * alpha + 255 * (1 - alpha)


@pytest.mark.browser
@pytest.mark.slow
@pytest.mark.parametrize(("repeat", "in_shader"), [("loop", True), ("ping-pong", False)])
def test_a_page_plays_scrubs_and_leads_to_poses(
    page: Page, tmp_path: Path, repeat: Any, in_shader: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With the network off. Pixels at a time are those of the map at that time."""
    if not in_shader:
        monkeypatch.setattr("glid_nb.export.page.LONGEST_CHAIN", 10)
    motion = Motion([HarmonicMap.identity(shapes.domain()), shapes.bent()], repeat=repeat)
    front = Pose(shapes.pose().handles, shapes.pose().targets, [1.0, -1.0])
    poses = [shapes.pose(), front]  # nothing overlaps, so their depths change no pixel
    (path,) = animate(tmp_path / "walk.html", shapes.picture(), motion, poses)
    page.emulate_media(reduced_motion="reduce", color_scheme="light")
    page.context.set_offline(True)
    page.goto(path.as_uri())
    page.wait_for_selector("html[data-ready=true]", state="attached")
    box = page.locator("main canvas").bounding_box()
    assert box is not None
    size = round(box["width"]), round(box["height"])
    slider = page.get_by_label("Time, seconds")
    for time in (0.35, 1.4):
        slider.evaluate("(e, t) => { e.value = t; e.dispatchEvent(new Event('input')); }", time)
        difference = np.abs(shown(page) - drawn(shapes.picture(), motion, time, size)).max(axis=2)
        assert difference.mean() < 1
        assert np.percentile(difference, 99) < 16
    page.keyboard.press("End")
    assert float(slider.input_value()) == pytest.approx(motion.end)
    assert page.locator("#poses button:first-child[aria-current=true]").count() == 1
    page.keyboard.press("Home")
    before = shown(page)
    page.keyboard.press("ArrowRight")
    assert float(slider.input_value()) == pytest.approx(0.04)
    page.keyboard.press("Space")
    page.wait_for_function(_PAUSED_NEAR_POSE_2)
    page.get_by_role("button", name="Play").wait_for()
    assert np.abs(shown(page) - before).max() > 30
    page.get_by_role("button", name="Pose 2").click()
    page.locator("#poses button:nth-child(2)[aria-current=true]").wait_for()
    assert float(slider.input_value()) == pytest.approx(1)
    assert "Now: σ₂ ≥ 0." in page.locator("#here").inner_text()


@pytest.mark.browser
@pytest.mark.slow
def test_a_phone_shows_a_page_that_plays_by_itself(browser: Browser, tmp_path: Path) -> None:
    motion = Motion([HarmonicMap.identity(shapes.domain()), shapes.bent()], repeat="loop")
    (path,) = animate(tmp_path / "walk.html", shapes.picture(), motion)
    phone: Any = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}
    with watched_page(browser, **phone) as page:
        page.goto(path.as_uri())
        page.get_by_role("button", name="Pause").tap()
        page.get_by_role("button", name="Play").wait_for()
        page.get_by_role("button", name="Pose 2").tap()
        page.locator("#poses button:nth-child(2)[aria-current=true]").wait_for()
        page.get_by_label("Show").select_option("Dilatation k")
        assert page.evaluate("document.documentElement.scrollWidth") == 390
        for part in ("main canvas", "#poses", "#play", "#time", "#overlay", "#here"):
            box = page.locator(part).bounding_box()
            assert box is not None
            assert box["y"] + box["height"] <= 844
            assert min(box["width"], box["height"]) >= 20
        page.screenshot(path=ARTEFACTS / "page-phone.png")
        # On its side, and in a small frame of another page: the picture takes most of it.
        for width, height in ((844, 390), (640, 360), (320, 360)):
            page.set_viewport_size({"width": width, "height": height})
            places: Any = {name: page.locator(name).bounding_box() for name in _LOW}
            assert all(places.values())
            assert places["main canvas"]["height"] >= height / 2
            row = [places[name] for name in ("#poses", "#play", "#time", "#clock")]
            middles = [box["y"] + box["height"] / 2 for box in row]
            assert max(middles) - min(middles) < 10
            assert max(box["y"] + box["height"] for box in places.values()) <= height
            assert max(box["x"] + box["width"] for box in places.values()) <= width
            assert places["header p"]["height"] <= 20
            assert not page.locator("#here, footer small").locator("visible=true").count()
            page.screenshot(path=ARTEFACTS / f"page-{width}x{height}.png")


@pytest.mark.browser
@pytest.mark.slow
def test_thumbnails_are_drawn_when_they_come_into_sight(page: Page, tmp_path: Path) -> None:
    """After the picture, and as the picture alone, whatever the canvas shows at that time."""
    motion = Motion([HarmonicMap.identity(shapes.domain()), shapes.bent()] * 20)
    (path,) = animate(tmp_path / "long.html", shapes.picture(), motion)
    page.emulate_media(reduced_motion="reduce", color_scheme="light")
    page.set_viewport_size({"width": 400, "height": 700})
    page.goto(path.as_uri())
    page.wait_for_selector("html[data-ready=true]", state="attached")
    page.get_by_label("Show").select_option("Dilatation k")
    page.get_by_label("Undeformed").check()
    drawn = "() => [...document.querySelectorAll('#poses canvas')].map((c) => c.width === 56)"
    page.wait_for_function(f"() => ({drawn})()[5]")
    assert not any(page.evaluate(drawn)[10:])
    before, second = shown(page), page.get_by_role("button", name="Pose 2,").screenshot()
    bring_into_view(page.get_by_role("button", name="Pose 40"))
    page.wait_for_function(f"() => ({drawn})()[39]")
    last = page.get_by_role("button", name="Pose 40").screenshot()
    a, b = (imread(io.BytesIO(one))[..., :3].astype(float) for one in (second, last))
    assert np.abs(a - b).mean() < 2
    assert a.std() > 20
    np.testing.assert_array_equal(shown(page), before)


@pytest.mark.browser
@pytest.mark.slow
def test_the_browser_shows_what_a_rendering_shows(page: Page, tmp_path: Path) -> None:
    """From a file, with the network off.

    Compared on white, at the canvas's size: the mean difference is below 1 of 255, and 99 of 100
    pixels differ by less than 16. The others lie on edges, which the two smooth differently.
    """
    image = samples.image("gecko")
    domain = Domain.from_cage(trace(image).cage)
    start = HarmonicMap.identity(domain)
    phi = np.where(start.phi != 0, start.phi + 0.03j * start.phi**2, 0)
    map = HarmonicMap(domain, phi, start.psi)
    path = tmp_path / "gecko.html"
    path.write_text(page_html(image, map, certify(map), title="A bent gecko"), encoding="utf-8")
    page.context.set_offline(True)
    page.goto(path.as_uri())
    page.wait_for_selector("html[data-ready=true]", state="attached")
    assert page.locator("h1").inner_text() == "A bent gecko"
    canvas = page.locator("canvas")
    box = canvas.bounding_box()
    assert box is not None
    size = round(box["width"]), round(box["height"])
    ARTEFACTS.mkdir(exist_ok=True)
    page.screenshot(path=ARTEFACTS / "page.png")
    canvas.screenshot(path=tmp_path / "canvas.png")
    seen = imread(tmp_path / "canvas.png")[..., :3].astype(float)
    rendered = render(image, map, size, view="fit").astype(float)
    alpha = rendered[..., 3:] / 255
    expected = rendered[..., :3] * alpha + 255 * (1 - alpha)
    assert seen.shape == expected.shape
    difference = np.abs(seen - expected).max(axis=2)
    shape = alpha[..., 0] > 0
    assert shape.mean() > 0.1
    assert difference.mean() < 1
    assert np.percentile(difference[shape], 90) < 16
    assert np.percentile(difference, 99) < 16

    # The controls: colours, the undeformed shape, and back.
    before = canvas.screenshot()
    for overlay in ("Picture and grid", "Stretch σ₁", "Stretch σ₂", "Dilatation k"):
        page.get_by_label("Show").select_option(overlay)
        assert canvas.screenshot() != before
    page.get_by_label("Show").select_option("Picture")
    page.get_by_label("Undeformed").check()
    assert canvas.screenshot() != before
    page.get_by_label("Undeformed").uncheck()
    page.mouse.move(600, 400)
    page.mouse.wheel(0, -400)
    page.mouse.down()
    page.mouse.move(650, 420)
    page.mouse.up()
    moved = canvas.screenshot()
    assert moved != before
    page.get_by_role("button", name="Fit").click()
    assert canvas.screenshot() == before
