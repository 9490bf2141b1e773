"""The page's own solver goes ahead of the kernel in a drag, and the kernel's map follows."""

from __future__ import annotations

import numpy as np
import pytest

import glid_nb as glid
from glid_nb.page import ShaderMap

from .conftest import OpenNotebook
from .editor_page import SETUP, Hand, line

pytestmark = [pytest.mark.browser, pytest.mark.slow]

CANVAS = """
domain = glid.Domain.from_cage(glid.trace(picture).cage)
canvas = glid.widgets.DeformCanvas(picture, domain, 560, 300, n_vertices=600)
model = canvas.deformation
canvas
"""

# Messages from the kernel can be held back, and the worker's maps are kept.
HELD = """
window.glid = {held: null, maps: [], ready: 0};
window.WebSocket = class extends WebSocket {
  set onmessage(act) {
    super.onmessage = (e) => {
      const pass = () => act.call(this, e);
      if (window.glid.held) window.glid.held.push(pass);
      else pass();
    };
  }
};
window.Worker = class extends Worker {
  constructor(...rest) {
    super(...rest);
    this.addEventListener('message', ({data}) => {
      if (data.type === 'ready') window.glid.ready++;
      if (data.type !== 'map') return;
      const coefficients = Array.from(data.coefficients);
      window.glid.maps.push({settled: data.settled, coefficients});
    });
  }
};
window.glid.release = () => {
  const {held} = window.glid;
  window.glid.held = null;
  for (const pass of held) pass();
};
"""
PINS = [[-6.0, 0.0], [0.0, 0.0], [6.0, 0.0]]


def _pinned(open_notebook: OpenNotebook) -> Hand:
    """A hand on a bar with three pins, whose page's own solver is ready."""
    book = open_notebook([SETUP, CANVAS], script=HELD)
    book.value("None", setup=f"model.set_pose(glid.Pose({PINS}, {PINS}))")
    hand = Hand(book)
    hand.page.wait_for_function("window.glid.ready > 0")
    number = book.value("canvas.pane.stage.rest['number']")
    assert number > 0
    return hand


def _maps(hand: Hand, domain: glid.Domain) -> list[glid.HarmonicMap]:
    """The maps that the page's own solver has found."""
    rows = [one["coefficients"] for one in hand.page.evaluate("window.glid.maps")]
    return [
        glid.HarmonicMap(domain, *(np.reshape(row, (2, 2, -1)).transpose(0, 2, 1) @ [1, 1j]))
        for row in rows
    ]


def test_a_drag_goes_on_while_nothing_comes_from_the_kernel(open_notebook: OpenNotebook) -> None:
    hand = _pinned(open_notebook)
    domain = glid.Domain.from_dict(hand.book.value("domain.to_dict()"))
    unit = hand.book.value("canvas.pane.stage.view[2]")
    places = hand.places(line(PINS[2], [5.0, 3.0], 12))
    mouse, picture = hand.page.mouse, hand.picture()
    hand.page.evaluate("window.glid.held = []")
    mouse.move(*places[0])
    mouse.down()
    for place in places[1:]:
        mouse.move(*place)
    mouse.up()
    hand.page.wait_for_function("window.glid.maps.at(-1)?.settled")
    maps = _maps(hand, domain)
    shown = hand.drawn(picture)
    assert hand.page.evaluate("window.glid.held.length") > 0
    hand.page.evaluate("window.glid.release()")
    # The shape has followed, by maps that the package proves too.
    assert np.allclose(maps[-1]([PINS[2]]), [[5.0, 3.0]], atol=0.1)
    assert all(glid.certify(one).certified for one in maps)
    wanted = np.ravel(ShaderMap(domain).coefficients(maps[-1])[0])
    np.testing.assert_allclose(shown, wanted, atol=1e-5)
    # Then the kernel's map is drawn, less than two pixels away.
    hand.wait_for_target(2, [5.0, 3.0])
    hand.wait_until_drawn()
    boundary = np.array(domain.cage.polygon.exterior.segmentize(0.5).coords)
    kernels = np.array(hand.book.value(f"model.map({boundary.tolist()}).tolist()"))
    jump = np.linalg.norm(kernels - maps[-1](boundary), axis=1).max() / unit
    assert jump < 2.0
    assert hand.certified()


def test_the_drag_of_a_new_pin_goes_on_while_nothing_comes_from_the_kernel(
    open_notebook: OpenNotebook,
) -> None:
    hand = _pinned(open_notebook)
    domain = glid.Domain.from_dict(hand.book.value("domain.to_dict()"))
    places = hand.places(line([3.0, 0.0], [3.0, 1.5], 12))
    mouse, maps = hand.page.mouse, "window.glid.maps.length"
    known = hand.page.evaluate(maps)
    mouse.move(*places[0])
    mouse.down()
    for place in places[1:4]:
        mouse.move(*place)
    # The kernel has made the pin, and the page follows it from there.
    hand.book.wait_for("len(model.pose) == 4")
    mouse.move(*places[4])
    hand.page.wait_for_function(f"{maps} > {known}")
    hand.page.evaluate("window.glid.held = []")
    for place in places[5:]:
        mouse.move(*place)
    mouse.up()
    hand.page.wait_for_function("window.glid.maps.at(-1)?.settled")
    shown = _maps(hand, domain)[-1]
    hand.page.evaluate("window.glid.release()")
    hand.wait_for_target(3, [3.0, 1.5])
    handle = hand.book.value("model.pose.handles[3].tolist()")
    assert np.allclose(shown([handle]), [[3.0, 1.5]], atol=0.1)
    assert glid.certify(shown).certified
    hand.wait_until_drawn()
    assert hand.certified()


# Ends when undo has come, before the cell would end by itself.
WAIT_FOR_UNDO = """
import time
end = time.monotonic() + 20
while abs(model.pose.targets[2, 1]) > 1e-6 and time.monotonic() < end:
    time.sleep(0.01)
undone_in_time = time.monotonic() < end
"""


def test_a_drag_is_undone_while_a_cell_runs(open_notebook: OpenNotebook) -> None:
    hand = _pinned(open_notebook)
    hand.drag(line(PINS[2], [6.0, 2.0], 8))
    hand.wait_for_target(2, [6.0, 2.0])
    hand.settle()
    with hand.book.running(WAIT_FOR_UNDO):
        hand.page.keyboard.press("Control+z")
    assert hand.book.value("undone_in_time")
    assert np.allclose(hand.targets[2], PINS[2])
    hand.wait_until_drawn()
    assert hand.certified()
