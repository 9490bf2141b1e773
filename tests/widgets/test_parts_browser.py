"""Two islands of a picture as parts of one session, by hand: kept, dragged, passed in front of each
other, played, saved, opened again and exported."""

from __future__ import annotations

import base64
import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from ..support.axe import faults
from ..support.browser import ARTEFACTS
from . import editor_page
from .conftest import OpenNotebook
from .test_timeline_browser import Timeline

pytestmark = [pytest.mark.browser, pytest.mark.slow]

# A red disk at the left and a blue square at the right.
ISLANDS = """
import numpy as np
import glid_nb as glid
glid.enable_compilation_cache()
rows, columns = np.mgrid[:160, :240]
picture = np.zeros((160, 240, 4), np.uint8)
picture[np.hypot(columns - 60, rows - 80) < 42] = (220, 40, 40, 255)
picture[50:110, 150:210] = (40, 80, 220, 255)
editor = glid.Editor(picture, n_vertices=2000)
canvas, model, tracer = editor.canvas, editor.deformation, editor.tracer
editor
"""
CENTRES = "[part.domain.cage.exterior.mean(axis=0).tolist() for part in model.state.parts]"
EXPORTS = """
import base64, tempfile, pathlib
folder = pathlib.Path(tempfile.mkdtemp())
written = {name: base64.b64encode(editor.export(folder / name, size)[0].read_bytes()).decode()
           for name, size in (("two.png", None), ("two.gif", (240, 240)))}
editor.save(folder / "two.glid")
"""
OPENED = """
again = glid.Editor(path=folder / "two.glid")
assert again.certificate.certified
again.close()
"""


def red(pixel: list[int]) -> bool:
    return pixel[0] > pixel[2] + 60


def blue(pixel: list[int]) -> bool:
    return pixel[2] > pixel[0] + 60


def test_two_islands_are_kept_dragged_played_saved_and_exported(
    open_notebook: OpenNotebook,
) -> None:
    book = open_notebook([ISLANDS], viewport={"width": 1366, "height": 768})
    page = book.page
    parts = page.locator(".glid-parts")
    parts.wait_for(state="hidden")
    page.get_by_role("tab", name="Trace").click()
    page.locator(".glid-panel").get_by_role("button", name="Keep all as parts").click()
    book.wait_for("len(model.state.parts) == 2")
    parts.wait_for()
    hand = editor_page.Hand(book)
    assert faults(page, parts) == []
    round_one, square = book.value(CENTRES)
    hand.wait_for_color(round_one, red)
    hand.wait_for_color(square, blue)

    # A press on another part edits it, and pins it there.
    hand.click(square)
    book.wait_for("model.state.part == 1 and len(model.pose) == 1")
    hand.settle()
    page.keyboard.press("k")
    book.wait_for("len(model.state.poses) == 2")
    hand.settle()
    half = [(a + b) / 2 for a, b in zip(round_one, square, strict=True)]
    hand.drag(editor_page.line(square, half, 15))
    hand.wait_for_target(0, half)
    assert hand.certified()
    edge = [half[0] - 1.6, half[1]]  # where both parts are, once the other has come too
    hand.wait_for_color(edge, blue)
    hand.click(round_one)
    book.wait_for("model.state.part == 0 and len(model.pose) == 1")
    near = [round_one[0] + 2.0, round_one[1]]
    hand.drag(editor_page.line(round_one, near, 15))
    hand.wait_for_target(0, near)
    assert hand.certified()
    hand.wait_for_color(edge, blue)  # the square is in front
    book.screenshot("parts-blue-in-front")
    page.get_by_role("button", name="Bring the part forward").click()
    book.wait_for("[part.name for part in model.state.parts] == ['Part 2', 'Part 1']")
    hand.wait_for_color(edge, red)
    rim = _rim(book.screenshot("parts-red-in-front", of=hand.pad))
    assert rim.max() < 450, "the white of the page is seen between the parts"

    # Both motions are proved, and both play.
    book.wait_for("editor.timeline.animation.wait(60)")
    spans = "[editor.timeline.animation.spans_of(k)[0].status for k in model.state.keys]"
    assert book.value(spans) == ["proved", "proved"]
    timeline = Timeline(hand)
    # The strip shows the worst of both, and says whose that is.
    pieces = timeline.root.locator(".glid-piece.glid-proved")
    pieces.first.wait_for()
    bounds = book.value(
        "{part.name: min(editor.timeline.animation.spans_of(part.key)[0].sigma2)"
        " for part in model.state.parts}"
    )
    worst = min(bounds, key=bounds.get)
    told = pieces.evaluate_all("all => all.map((one) => one.title)")
    assert any(f"{bounds[worst]:.3f}" in text and worst in text for text in told), (bounds, told)
    note = timeline.root.locator(".glid-timeline-note")
    note.get_by_text(f"σ₂ ≥ {bounds[worst]:.3f} ({worst}).").wait_for()
    model_part = book.value("model.state.part")
    book.value("None", setup=f"model.select_part({1 - model_part})")
    note.get_by_text(f"σ₂ ≥ {bounds[worst]:.3f} ({worst}).").wait_for()  # whichever is edited
    book.value("None", setup=f"model.select_part({model_part})")
    book.screenshot("parts-strip")
    timeline.keys.nth(0).click()
    book.wait_for("model.state.active == 0")
    hand.wait_for_color(square, blue)
    hand.pad.focus()
    page.keyboard.press("Space")
    hand.wait_for_color(edge, red)
    page.keyboard.press("Escape")

    # The files show the same.
    written = book.value("written", EXPORTS)
    still = _opened(written["two.png"])
    assert red(still[80, 60].tolist())
    frames = Image.open(io.BytesIO(_bytes(written["two.gif"])))
    assert getattr(frames, "n_frames", 1) > 10
    _keep(still, "parts-exported")
    frames.seek(frames.n_frames - 1)  # type: ignore[attr-defined]
    last = np.asarray(frames.convert("RGB"))
    _keep(last, "parts-gif-last")
    middle = last[last.shape[0] // 2].astype(int)
    kinds = "".join("r" if red(p) else "b" if blue(p) else "." for p in middle.tolist())
    assert kinds.strip(".").replace("rr", "r") != ""
    assert kinds.index("r") < kinds.index("b")
    assert set(kinds[kinds.index("r") : kinds.rindex("b")]) == {"r", "b"}  # they overlap now

    # Opened again, it is the same session.
    names = book.value("[part.name for part in again.deformation.state.parts]", OPENED)
    assert names == ["Part 2", "Part 1"]


def _rim(path: Path) -> np.ndarray:
    """The brightness (red, green and blue together) of the canvas's pixels between both parts."""
    with Image.open(path) as picture:
        pixels = np.asarray(picture.convert("RGB")).astype(int)
    middle = pixels[len(pixels) // 2 - 60 : len(pixels) // 2 + 60]
    is_red = middle[..., 0] > middle[..., 2] + 60
    is_blue = middle[..., 2] > middle[..., 0] + 60
    first = is_red.shape[1] - 1 - is_red[:, ::-1].argmax(axis=1)  # the last red pixel of each row
    rows = np.flatnonzero(is_blue.any(axis=1) & is_red.any(axis=1))
    return np.array([middle[row, first[row] : first[row] + 5].sum(axis=1).max() for row in rows])


def _bytes(text: str) -> bytes:
    return base64.b64decode(text)


def _opened(text: str) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(_bytes(text))).convert("RGBA"))


def _keep(pixels: np.ndarray, name: str) -> None:
    Path(ARTEFACTS).mkdir(exist_ok=True)
    Image.fromarray(pixels).save(Path(ARTEFACTS) / f"{name}.png")
