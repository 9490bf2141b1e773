"""The ring around a pin, its numbers, the lasso and the clipboard, in a real browser."""

from __future__ import annotations

import numpy as np
import pytest

from .conftest import OpenNotebook
from .editor_page import EDITOR, SETUP, Hand, contrast

pytestmark = [pytest.mark.browser, pytest.mark.slow]

_DIAL = 42  # CSS pixels from a pin to its ring


def test_a_ring_turns_and_scales_and_the_list_takes_numbers(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, EDITOR])
    hand, page = Hand(book), book.page
    for x in (-6, 6):
        hand.click((x, 0))
        book.wait_for(f"len(model.pose) == {1 + (x > 0)}")
    unit = book.value("canvas.pane.stage.view[2]")
    reach = _DIAL * unit

    # The ring turns, its knob scales. Each is a step of undo, and the map follows.
    turn = [(6 + reach * np.cos(a), reach * np.sin(a)) for a in np.linspace(0.6, 1.1, 9)]
    hand.drag(turn)
    book.wait_for("abs(model.pose.angles[1] - 0.5) < 0.05")
    angle = book.value("float(model.pose.angles[1])")
    knob = [(6 + r * np.cos(angle), r * np.sin(angle)) for r in reach * np.linspace(1, 1.3, 9)]
    hand.drag(knob)
    book.wait_for("abs(model.pose.scales[1] - 1.3) < 0.05")
    hand.settle()
    fz = "model.map.wirtinger(model.pose.handles[1:])[0][0]"
    wanted = "model.pose.scales[1] * np.exp(1j * model.pose.angles[1])"
    assert book.value(f"float(abs({fz} - {wanted}))") < 1e-3
    assert hand.certified()
    assert len(hand.handles) == 2
    book.screenshot("pins-ring")

    # Numbers are typed into the list. An empty field is free. Each field has a description.
    page.get_by_title(
        "By how much the shape is turned at the pin; empty: free (< and >, X)"
    ).hover()
    page.locator(".glid-tools [data-tool=stiff]").click()
    page.get_by_title("Of the brush").hover()
    assert not any(page.locator(".glid-side label[title=null]").all_inner_texts())
    page.keyboard.press("Escape")
    field = page.get_by_label("Angle °")
    field.fill("much")
    field.press("Enter")
    refusal = page.get_by_text("'much' is not a number")
    refusal.wait_for()
    refusal.click(trial=True)  # nothing covers it
    note = page.locator(".glid-timeline-note")
    note.evaluate("one => { one.dataset.tone = 'bad'; }")
    for theme in ("Dark", "Light"):
        book.theme(f"JupyterLab {theme}")
        seen = [contrast(text) for text in (refusal, note)]
        print(f"{theme}: refusal {seen[0]:.2f}, timeline {seen[1]:.2f}")
        assert min(seen) >= 4.5
    field.fill("-172.4")
    assert field.evaluate("one => one.scrollWidth <= one.clientWidth")  # nothing is cut off
    field.fill("-20")
    field.press("Enter")
    book.wait_for("abs(np.degrees(model.pose.angles[1]) + 20) < 1e-9")
    field.fill("")
    field.press("Enter")
    book.wait_for("np.isnan(model.pose.angles[1])")
    page.keyboard.press("Escape")
    hand.pad.focus()
    for _ in range(4):
        page.keyboard.press("Control+z")
    book.wait_for("not model.pose.oriented.any() and len(model.pose) == 2")

    # A box selects. A pin out of view is brought back. A pose goes through the clipboard.
    keys = page.locator(".glid-pane .glid-help")
    for width in (800, 1366):
        page.set_viewport_size({"width": width, "height": 768})
        hand.pad.focus()
        page.keyboard.press("?")
        keys.get_by_role("heading", name="Timeline").wait_for()
        place = keys.bounding_box()
        assert place is not None
        assert 0 <= place["x"] < place["x"] + place["width"] <= width
        assert keys.evaluate("one => one.scrollHeight <= one.clientHeight") or width < 1366
        book.screenshot(f"pins-help-{width}")
        page.keyboard.press("Escape")
        keys.wait_for(state="hidden")
    assert book.value("model.selection") != []
    page.keyboard.press("Escape")
    book.wait_for("model.selection == ()")
    page.keyboard.down("Shift")
    hand.drag([(-8.5, 3), (-7, 0), (-5, -3)])
    page.keyboard.up("Shift")
    book.wait_for("model.selection == (0,)")
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.keyboard.press("Control+c")
    book.wait_for("'clipboard' in canvas.pane.stage.notice")
    page.keyboard.press("Delete")
    book.wait_for("len(model.pose) == 1")
    page.keyboard.press("Control+v")
    book.wait_for("len(model.pose) == 2")
    book.value("None", "canvas.pane.stage.view = [-6, 0, 0.01]")
    hand.settle()
    hand.wait_until_still()
    book.screenshot("pins-lost")
    hand.click((-6 + 0.01 * (280 - 14), 0))  # the arrow at the right edge
    book.wait_for("abs(canvas.pane.stage.view[0] - 6) < 0.5")
    assert len(hand.handles) == 2
