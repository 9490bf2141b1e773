"""A picture exported by hand in a real browser."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
import pytest
from skimage.io import imread

from glid_nb.imaging import PixelFrame

from .conftest import OpenNotebook
from .editor_page import EDITOR, SETUP, Hand, line

pytestmark = [pytest.mark.browser, pytest.mark.slow]


def test_the_exported_picture_is_the_rendering_and_what_the_canvas_shows(
    open_notebook: OpenNotebook, tmp_path: Path
) -> None:
    """The file equals a headless rendering in every pixel.

    In the middles of the bar's checks, the canvas has its colours to 6 of 255, because the mesh and
    the textures' filters differ. The lines that make the file are copied.
    """
    book = open_notebook([SETUP, EDITOR], permissions=["clipboard-read", "clipboard-write"])
    hand = Hand(book)
    for point in ((-6.0, 0.0), (6.0, 0.0)):
        hand.click(point)
    book.wait_for("len(model.pose) == 2")
    hand.drag(line((6.0, 0.0), (5.0, 2.0), 10))
    hand.wait_for_target(1, (5.0, 2.0))
    page = book.page
    page.locator(".lm-TabBar-tabLabel", has_text="Files").click()
    files = page.locator(".glid-files")
    name = files.get_by_placeholder("Name.glid")
    name.fill(str(tmp_path / "bent.glid"))
    name.press("Enter")
    _background, what, view = files.locator("select").all()
    what.select_option(label="Picture (PNG)")
    width = files.locator("input[type=number]").first
    width.fill("300")
    width.press("Enter")
    files.get_by_role("button", name="Write here").click()
    files.get_by_text("Wrote").wait_for()
    whole = np.array(book.value("glid.render(picture, model.map, (300, 150), view='fit').tolist()"))
    np.testing.assert_array_equal(imread(tmp_path / "bent.png"), whole)

    # The same through the browser. Files that belong together are sent as one.
    for label, stem in (("Picture (PNG)", "bent.png"), ("Mesh and texture (OBJ)", "bent.obj.zip")):
        what.select_option(label=label)
        with page.expect_download() as download:
            files.get_by_role("button", name="Download").click()
        assert download.value.suggested_filename == stem
        saved = tmp_path / f"downloaded-{stem}"
        download.value.save_as(saved)
        if stem == "bent.png":
            assert saved.read_bytes() == (tmp_path / stem).read_bytes()
        else:
            assert zipfile.is_zipfile(saved)
    what.select_option(label="Picture (PNG)")

    # The lines that make it, with and without access to the clipboard.
    for stem, forbidden in (("allowed", False), ("forbidden", True)):
        if forbidden:
            page.evaluate("() => { navigator.clipboard.writeText = () => Promise.reject(); }")
        name.fill(str(tmp_path / f"{stem}.glid"))
        name.press("Enter")
        files.get_by_role("button", name="Copy as Python").click()
        files.get_by_text(f"in the clipboard. They read {tmp_path / stem}-source.png").wait_for()
        pasted = page.evaluate("navigator.clipboard.readText()")
        assert pasted == files.locator("textarea").input_value()
        assert f"{stem}-source.png" in pasted
    book.screenshot("files")

    name.fill(str(tmp_path / "bent.glid"))
    name.press("Enter")
    width.fill("200")
    width.press("Enter")
    view.select_option(label="Original frame")
    files.get_by_role("button", name="Write here").click()
    book.wait_for(f"glid.read_image({str(tmp_path / 'bent.png')!r}).shape[1] == 200")
    exported = imread(tmp_path / "bent.png")
    rendered = np.array(book.value("glid.render(picture, model.map).tolist()"))
    np.testing.assert_array_equal(exported, rendered)

    hand.wait_until_drawn()
    middles = [(x, y) for x in range(-7, 8, 2) for y in (-1.5, 0, 1.5)]
    images = book.value(f"model.map({middles}).tolist()")
    frame = PixelFrame(width=200, height=100)
    inside = 0
    for place in images:
        column, row = np.floor(frame.to_pixel(place)).astype(int)
        if 0 <= row < 100 and 0 <= column < 200:
            seen = hand.color_at(place)
            np.testing.assert_allclose(seen, exported[row, column], atol=6, err_msg=str(place))
            inside += 1
    assert inside >= 18
