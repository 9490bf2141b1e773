"""The part of a motion that plays over and over, set on the ruler, in a real browser."""

from __future__ import annotations

import pytest

from ..support.browser import bring_into_view
from .conftest import OpenNotebook
from .editor_page import center
from .test_ease_browser import posed_timeline

pytestmark = [pytest.mark.browser, pytest.mark.slow]

RANGE = "model.state.timeline.loop_range"
# The times that the playhead showed while this many frames were drawn.
PLAYED = """async ([track, count]) => {
  const times = [];
  while (times.length < count) {
    await new Promise((go) => requestAnimationFrame(go));
    times.push(Number(track.dataset.time));
  }
  return times;
}"""


def test_a_range_set_on_the_ruler_plays_over_and_over(open_notebook: OpenNotebook) -> None:
    timeline = posed_timeline(open_notebook)
    book, page, root = timeline.book, timeline.page, timeline.root
    start = root.get_by_role("slider", name="Start of the loop range")
    end = root.get_by_role("slider", name="End of the loop range")
    assert start.get_attribute("data-set") == "false"
    assert (start.get_attribute("aria-valuenow"), end.get_attribute("aria-valuenow")) == (
        "0.00",
        "2.00",
    )

    bring_into_view(timeline.root)
    # Drags of the marks, each one step; near a frame they land on it. Escape drops a drag.
    for mark, time in ((end, 1.4), (start, 0.6)):
        x, y = center(mark)
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(timeline.x(time) + 3, y, steps=5)
        page.mouse.up()
    book.wait_for(f"{RANGE} is not None and abs(np.subtract({RANGE}, (0.6, 1.4))).max() < 0.05")
    chosen = book.value(RANGE)
    assert [round(25 * time, 6) % 1 for time in chosen] == [0, 0]
    root.locator(".glid-range-mark[data-set=true]").nth(1).wait_for()
    book.screenshot("timeline-range")
    x, y = center(end)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(timeline.x(1.9), y, steps=5)
    page.keyboard.press("Escape")
    page.mouse.up()
    assert book.value(RANGE) == chosen
    assert book.value("all(s.status == 'proved' for s in editor.timeline.animation.spans)")

    # It plays between the marks, although the motion itself plays once.
    root.locator(".glid-ruler").focus()
    page.keyboard.press("Space")
    page.wait_for_function(
        f"([track, end]) => {{ const t = track.dataset.time; return t > {chosen[0] + 0.5}; }}",
        arg=[timeline.track.element_handle(), chosen[1]],
    )
    handle = timeline.track.element_handle()
    page.wait_for_function(f"track => track.dataset.time < {chosen[0] + 0.3}", arg=handle)
    times = page.evaluate(PLAYED, [handle, 20])
    page.keyboard.press("Space")
    assert min(times) >= chosen[0] - 1e-9
    assert max(times) <= chosen[1]

    # Keys: the playhead becomes an end; the same key there takes it away; Delete on a mark all.
    timeline.scrub([0.9, 1.0])
    page.locator(".glid-timeline[data-active='1/3'] .glid-track[data-time='1']").wait_for()
    page.keyboard.press("Shift+Home")
    book.wait_for(f"{RANGE} == (1.0, {chosen[1]})")
    page.locator(".glid-timeline[data-idle=true]").wait_for()
    page.keyboard.press("Shift+Home")
    book.wait_for(f"{RANGE} == (0.0, {chosen[1]})")
    end.press("ArrowRight")
    book.wait_for(f"abs({RANGE}[1] - {chosen[1]} - 1 / 25) < 1e-9")
    # An export can be of the range alone.
    page.get_by_role("tab", name="Files").click()
    only = page.get_by_title("Only the part between the two marks")
    book.value("None", setup="editor.files.show_motion()")
    only.click()
    book.wait_for("editor.files.motion.part.value")
    book.screenshot("timeline-range-export")
    end.press("Delete")
    book.wait_for(f"{RANGE} is None")
    only.wait_for(state="hidden")
    page.keyboard.press("Control+z")
    book.wait_for(f"{RANGE} is not None")

    # The menu plays all of it, in a loop, as one step.
    menu = root.get_by_label("Play once, in a loop, or there and back")
    menu.select_option("Loop")
    book.wait_for(f"{RANGE} is None and model.state.timeline.repeat == 'loop'")
    page.locator(".glid-timeline[data-idle=true]").wait_for()
    root.locator(".glid-ruler").focus()
    page.keyboard.press("Control+z")
    book.wait_for(f"{RANGE} is not None and model.state.timeline.repeat == 'once'")
    book.theme("JupyterLab Dark")
    page.set_viewport_size({"width": 390, "height": 844})
    bring_into_view(root)
    book.screenshot("timeline-range-phone-dark")
