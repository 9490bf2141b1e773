"""The exported page in a browser, from a file: the same picture as a rendering."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Page
from skimage.io import imread

from glid_nb import samples
from glid_nb.certificate import certify
from glid_nb.export import page_html
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import trace
from glid_nb.imaging.render import render

from ..browser import ARTEFACTS


@pytest.mark.browser
@pytest.mark.slow
def test_the_browser_shows_what_a_rendering_shows(page: Page, tmp_path: Path) -> None:
    """From a file, with the network off. Compared on white, at the canvas' size: the mean
    difference is below 1 of 255, and 99 of 100 pixels differ by less than 16; the others lie on
    edges, which the two smooth differently."""
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

    # The controls: the mesh, the undeformed shape, and back.
    before = canvas.screenshot()
    page.get_by_label("Mesh").check()
    assert canvas.screenshot() != before
    page.get_by_label("Mesh").uncheck()
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
