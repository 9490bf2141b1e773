"""Painting stiff areas in a real browser."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from .conftest import OpenNotebook
from .editor_page import EDITOR, SETUP, Hand, line

pytestmark = [pytest.mark.browser, pytest.mark.slow]

RATIO = """
places = np.stack(np.meshgrid(np.linspace(4.2, 7.7, 40), np.linspace(-1.8, 1.8, 40)), -1)
def ratio():
    fz, fzb = (abs(part) for part in model.map.wirtinger(places.reshape(-1, 2)))
    return float(((fz + fzb) / (fz - fzb)).max())
"""

# All in one task of the page, so that no message of the kernel comes in between.
CLICK_AND_PAINT = """([[x, y], [end, _]]) => {
  const pad = document.querySelector('.glid-pad');
  const point = (type, clientX) => pad.dispatchEvent(new PointerEvent(type, {
    bubbles: true, pointerId: 1, pointerType: 'mouse', clientX, clientY: y }));
  document.querySelector('.glid-tools [data-tool=stiff]').click();
  point('pointerdown', x);
  for (let at = x; at < end; at += 4) point('pointermove', at);
  point('pointerup', end);
}"""

# Likewise, by a key and on a pin; the shape of the pointer while it moves.
PRESS_AND_PAINT = """([key, [[x, y], [end, _]]]) => {
  const pad = document.querySelector('.glid-pad');
  const point = (type, clientX) => pad.dispatchEvent(new PointerEvent(type, {
    bubbles: true, pointerId: 1, pointerType: 'mouse', clientX, clientY: y }));
  pad.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true, cancelable: true }));
  point('pointerdown', x);
  for (let at = x; at < end; at += 4) point('pointermove', at);
  const { cursor } = pad.style;
  point('pointerup', end);
  return cursor;
}"""

PURPLE = """() => {
  const paper = document.querySelector('.glid-paper');
  const { data } = paper.getContext('2d').getImageData(0, 0, paper.width, paper.height);
  let count = 0;
  for (let i = 0; i < data.length; i += 4) {
    const [r, g, b] = data.subarray(i, i + 3);
    count += data[i + 3] > 60 && b > r + 20 && r > g + 20;
  }
  return count;
}"""


def test_a_hand_paints_a_stiff_head_erases_undoes_and_clears(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, EDITOR, RATIO])
    hand, page = Hand(book), book.page
    for point in [(-6.0, 0.0), (0.0, 0.0), (6.5, 0.0)]:
        hand.click(point)
    book.wait_for("len(model.pose) == 3")
    hand.drag(line([6.5, 0.0], [3.5, 5.0], 10))
    hand.wait_for_target(2, [3.5, 5.0])
    free = book.value("ratio()")
    before = hand.targets

    # A stroke counts even if it begins before the kernel has answered the click.
    page.evaluate(CLICK_AND_PAINT, hand.places([[-1.0, 0.5], [1.0, 0.5]]))
    book.wait_for("len(model.pose.stiffness.strokes) == 1")
    assert book.value("model.pose.stiffness([[-0.9, 0.5], [0.9, 0.5]]).tolist()") == [1, 1]
    page.keyboard.press("Control+z")
    book.wait_for("not model.pose.stiffness and canvas.brush.tool == 'stiff'")
    # So does one after a key, also on a pin: the page does not drag it.
    page.keyboard.press("Escape")
    book.wait_for("canvas.brush.tool == ''")
    page.get_by_text("Esc when done").wait_for(state="hidden")
    on_a_pin = hand.places([[0.0, 0.0], [1.5, 0.0]])
    assert page.evaluate(PRESS_AND_PAINT, ["b", on_a_pin]) == "crosshair"
    book.wait_for("len(model.pose.stiffness.strokes) == 1 and canvas.brush.tool == 'stiff'")
    assert page.evaluate(PRESS_AND_PAINT, ["e", on_a_pin]) == "crosshair"
    book.wait_for("canvas.brush.tool == 'erase'")
    book.wait_for("model.pose.stiffness([[0.1, 0.0]]).tolist() == [0]")
    assert hand.targets == before
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+z")
    page.keyboard.press("b")
    book.wait_for("not model.pose.stiffness and canvas.brush.tool == 'stiff'")
    page.get_by_text("Esc when done").wait_for()
    book.value("canvas.brush.set_trait('radius', 2.2)")
    ends = book.value("model.map([[4.6, 0.3], [7.4, 0.3], [7.4, -0.3], [4.6, -0.3]]).tolist()")
    path = [p for a, b in itertools.pairwise(ends) for p in line(a, b, 8)]
    hand.drag(path)
    book.wait_for("len(model.pose.stiffness.strokes) == 1 and model.moment.solved", 90)
    hand.settle()
    assert hand.targets == before
    assert book.value("ratio()") < 1.1 < 1.2 < free
    assert hand.certified()
    hand.wait_until_drawn()
    book.screenshot("editor-stiff")
    # A faint outline stays after the brush is put away.
    drawn = page.evaluate(PURPLE)
    page.keyboard.press("Escape")
    book.wait_for("canvas.brush.tool == ''")
    page.get_by_text("Esc when done").wait_for(state="hidden")
    page.wait_for_function(f"drawn => 0 < ({PURPLE})() && ({PURPLE})() < drawn / 2", arg=drawn)
    book.screenshot("editor-stiff-faint")

    page.keyboard.press("e")
    book.wait_for("canvas.brush.tool == 'erase'")
    hand.drag(line(ends[1], ends[2], 4))
    book.wait_for("len(model.pose.stiffness.strokes) == 2")
    assert book.value("model.pose.stiffness([[7.4, 0], [4.5, 0]]).tolist()") == [0, 1]
    book.screenshot("editor-stiff-erased")
    page.keyboard.press("Control+z")
    book.wait_for("len(model.pose.stiffness.strokes) == 1")
    page.get_by_title("Erase all stiff areas").click()
    book.wait_for("not model.pose.stiffness")
    hand.settle()
    np.testing.assert_allclose(book.value("ratio()"), free, rtol=1e-3)
    hand.pad.focus()
    page.keyboard.press("Escape")
    book.wait_for("canvas.brush.tool == ''")
    hand.click([-3.0, 0.5])
    book.wait_for("len(model.pose) == 4")
