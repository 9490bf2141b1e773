"""The page of several shapes without a solver, from a file: drawn as rendered, with one clock."""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, Page
from skimage.io import imread

from glid_nb.export import MovingPart, animate_parts
from glid_nb.export.moving import MovingMesh
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import PixelFrame
from glid_nb.imaging.backdrop import over
from glid_nb.imaging.mesh import deformed_mesh
from glid_nb.imaging.render import draw_mesh
from glid_nb.imaging.texture import Texture
from glid_nb.session.document_file import document_bytes, load_document
from glid_nb.session.editor_model import EditorModel
from glid_nb.session.posed_shapes import shapes_of
from glid_nb.widgets import exporting

from ..support.axe import faults
from ..support.browser import ARTEFACTS, watched_page
from ..support.two_disks import two_disks

pytestmark = [pytest.mark.browser, pytest.mark.slow]

_STILL = {"reduced_motion": "reduce", "color_scheme": "light"}
_SET = "(e, t) => { e.value = t; e.dispatchEvent(new Event('input')); }"


@pytest.fixture(scope="module")
def model() -> Iterator[EditorModel]:
    with two_disks() as made:
        yield made


@pytest.fixture(scope="module")
def parts(model: EditorModel, tmp_path_factory: pytest.TempPathFactory) -> list[MovingPart]:
    """The shapes of a session's file, as `glid-nb animate` reads them."""
    session = tmp_path_factory.mktemp("session") / "two.glid"
    session.write_bytes(document_bytes(model.document))
    return [shape.moving for shape in shapes_of(load_document(session))[0]]


def open_page(page: Page, path: Path) -> None:
    page.context.set_offline(True)
    page.goto(path.as_uri())
    page.wait_for_selector("html[data-ready=true]", state="attached")


def check_picture(
    page: Page, parts: list[MovingPart], maps: list[HarmonicMap], corners: np.ndarray
) -> None:
    """Compare the canvas with maps as they are rendered, the rearmost first."""
    seen = imread(io.BytesIO(page.locator("main canvas").screenshot()))[..., :3].astype(float)
    height, width = seen.shape[:2]
    frame = PixelFrame(width, height).showing([corners.min(axis=0), corners.max(axis=0)], 0.04)
    expected = np.full((height, width, 4), 255, np.uint8)
    for part, map in zip(parts, maps, strict=True):
        mesh = deformed_mesh(map, 4000, 0.004)
        expected = over(draw_mesh(Texture.from_image(part.image), mesh, frame), expected)
    difference = np.abs(seen - expected[..., :3]).max(axis=2)
    assert (expected[..., :3] < 250).any(axis=2).mean() > 0.2
    assert difference.mean() < 1
    assert np.percentile(difference, 99) < 16


def corners_of(parts: list[MovingPart]) -> np.ndarray:
    """The corners of what all shapes cover at all times."""
    images = [MovingMesh.of(one.motion, None, 4000, 0.004).images.reshape(-1, 2) for one in parts]
    return np.concatenate([[each.min(axis=0), each.max(axis=0)] for each in images])


def test_the_parts_play_together_in_their_order(
    parts: list[MovingPart], browser: Browser, tmp_path: Path
) -> None:
    (path,) = animate_parts(tmp_path / "walk.html", parts)
    corners = corners_of(parts)
    with watched_page(browser, **_STILL) as page:
        open_page(page, path)
        slider = page.get_by_label("Time, seconds")
        assert float(slider.get_attribute("max") or 0) == parts[0].motion.end
        told = set()
        for time in (0.0, 0.35, 0.8):
            slider.evaluate(_SET, time)
            check_picture(page, parts, [part.motion(time) for part in parts], corners)
            told.add(page.locator("#here").inner_text())
        assert all(text.startswith("Now: σ₂ ≥ 0.") for text in told)
        page.keyboard.press("End")
        assert page.locator("#poses button").count() == 2
        page.screenshot(path=ARTEFACTS / "page-parts.png")
        page.get_by_text("Each part").click()
        rows = page.locator("header li").all_inner_texts()
        assert [row.split()[0] for row in rows] == ["red", "blue"]
        for row, part in zip(rows, parts, strict=True):
            shown = float(row.split("σ₂ ≥ ")[1].split(",")[0])
            assert 0 < shown <= part.motion.certificate.sigma2_lower
        page.get_by_text("Each part").click()
        page.get_by_label("Undeformed").check()
        rest = [HarmonicMap.identity(part.motion.domain) for part in parts]
        around = np.concatenate([one.domain.cage.exterior for one in rest])
        check_picture(page, parts, rest, around)


def test_the_page_of_a_pose_shows_all_parts(
    model: EditorModel, parts: list[MovingPart], browser: Browser, tmp_path: Path
) -> None:
    (path,) = exporting.export(model, tmp_path / "pose.html")
    maps = [shape.state.map for shape in model.shapes]
    corners = np.concatenate([map(map.domain.cage.exterior) for map in maps])
    with watched_page(browser, **_STILL) as page:
        open_page(page, path)
        check_picture(page, parts, maps, corners)
        assert not page.locator("section").is_visible()
        page.get_by_text("Each part").click()
        assert "it does not overlap itself" in page.locator("header li").first.inner_text()
        page.screenshot(path=ARTEFACTS / "page-parts-pose.png")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_phone_plays_the_parts_without_a_fault(
    parts: list[MovingPart], browser: Browser, tmp_path: Path, scheme: str
) -> None:
    (path,) = animate_parts(tmp_path / "walk.html", parts)
    phone: Any = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}
    with watched_page(browser, **phone, color_scheme=scheme) as page:
        open_page(page, path)
        page.get_by_role("button", name="Pause").tap()
        page.get_by_role("button", name="Pose 2").tap()
        page.locator("#poses button:nth-child(2)[aria-current=true]").wait_for()
        page.get_by_text("Each part").tap()
        assert page.evaluate("document.documentElement.scrollWidth") == 390
        for row in page.locator("header li").all():
            box = row.bounding_box()
            assert box is not None
            assert box["x"] >= 0
            assert box["x"] + box["width"] <= 390
        page.screenshot(path=ARTEFACTS / f"page-parts-phone-{scheme}.png")
        assert faults(page) == []
        page.set_viewport_size({"width": 844, "height": 390})
        page.get_by_text("Each part").tap()
        page.screenshot(path=ARTEFACTS / f"page-parts-844x390-{scheme}.png")
        canvas = page.locator("main canvas").bounding_box()
        assert canvas is not None
        assert canvas["height"] >= 390 / 2
        summary = page.locator("summary").bounding_box()
        assert summary is not None
        assert summary["height"] <= 24
        assert summary["x"] + summary["width"] <= 844
