"""What somebody sees who opens the editor for the first time, and the inspector out of the way."""

from __future__ import annotations

import pytest

from glid_nb.session.first_minute import HINTS, Step

from ..support.browser import bring_into_view
from .conftest import OpenNotebook
from .editor_page import NEW_PICTURE, ROOMY_EDITOR, SETUP, Hand

pytestmark = [pytest.mark.browser, pytest.mark.slow]

EDITOR = NEW_PICTURE + ROOMY_EDITOR
# Groups of columns of the canvas over the picture in which something is drawn.
_GROUPS = """(paper) => {
  const {width, height} = paper;
  const {data} = paper.getContext('2d').getImageData(0, 0, width, height);
  const drawn = new Set();
  data.forEach((value, i) => { if (i % 4 === 3 && value > 60) drawn.add((i >> 2) % width); });
  return [...drawn].filter((x) => !drawn.has(x - 1)).length;
}"""


def test_pale_pins_invite_a_drag_until_there_is_a_pin(open_notebook: OpenNotebook) -> None:
    # A page of its own, where nobody has pinned anything yet.
    book = open_notebook([SETUP, EDITOR], viewport={"width": 1366, "height": 768})
    hand, page = Hand(book), book.page
    paper = page.locator(".glid-paper").first

    def wait_for_groups(count: int) -> None:
        page.wait_for_function(
            f"([paper, count]) => ({_GROUPS})(paper) === count", arg=[paper.element_handle(), count]
        )

    wait_for_groups(3)
    bring_into_view(hand.pad)
    book.screenshot("first-minute")
    assert book.value("len(model.pose)") == 0
    hand.drag([(-6.0, 0.0), (-6.0, 0.5), (-6.0, 1.0)])
    book.wait_for("len(model.pose) == 1 and not model.dragged")
    hand.settle()
    wait_for_groups(1)
    page.keyboard.press("Delete")
    book.wait_for("len(model.pose) == 0")
    hand.settle()
    wait_for_groups(0)  # they are not shown again


def test_the_footer_gives_one_hint_at_a_time(open_notebook: OpenNotebook) -> None:
    """Each is gone once its step was made, also for the next editor of this session."""
    fresh = "from glid_nb.session import first_minute\nfirst_minute.IN_THIS_SESSION._made.clear()\n"
    book = open_notebook([SETUP + fresh, EDITOR])
    hand, page = Hand(book), book.page
    hint = page.locator(".glid-foot .glid-next")
    bring_into_view(page.locator(".glid-editor"))

    def wait_for_hint(step: Step) -> None:
        hint.get_by_text(HINTS[step], exact=True).wait_for()
        assert hint.count() == 1

    def look(name: str) -> None:
        for width, height in ((390, 844), (1366, 768)):
            page.set_viewport_size({"width": width, "height": height})
            bring_into_view(hint)
            hand.wait_until_still()
            assert hint.is_visible()
            book.screenshot(f"hint-{name}-{width}")

    wait_for_hint("pin")
    look("pin")
    assert hand.pad.locator(".glid-notice").is_hidden()
    hand.click((-6.0, 0.0))
    wait_for_hint("drag")
    # A status that changes leaves the hint alone: a screen reader does not say it once more.
    hint.evaluate("(hint) => { hint.dataset.same = ''; }")
    book.value("None", setup="editor.monitor.line.said.value = 'Something else.'")
    page.locator(".glid-foot").get_by_text("Something else.").wait_for()
    assert hint.get_attribute("data-same") == ""
    hand.drag([(-6.0, 0.0), (-6.0, 0.5), (-6.0, 1.0)])
    wait_for_hint("turn")
    look("turn")
    page.keyboard.press(">")
    wait_for_hint("keep")
    page.keyboard.press("k")
    book.wait_for("len(editor.poses) == 2")
    wait_for_hint("play")
    hand.click((6.0, 0.0))
    book.wait_for("editor.timeline.animation.spans[0].status == 'proved'", 60)
    page.get_by_role("button", name="Play").first.click()
    hint.wait_for(state="detached")
    book.value("None", setup="from IPython.display import display\nother = glid.Editor(picture)")
    assert book.value("other.monitor.line.next.value", "other.monitor.refresh(20)") == ""


def test_the_inspector_gives_its_room_to_the_canvas(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, EDITOR])
    hand, page = Hand(book), book.page
    side, pad = page.locator(".glid-side"), hand.pad
    before = pad.bounding_box()
    assert before is not None

    def wait_for_width(least: float, most: float) -> None:
        book.wait_for(f"{least} < canvas.pane.stage.room[0] <= {most}")
        hand.wait_until_still()

    pad.focus()
    page.keyboard.press("i")
    side.wait_for(state="hidden")
    wait_for_width(before["width"] + 270, 2000)
    hand.click((0.0, 0.0))  # lands where it should
    book.wait_for("len(model.pose) == 1 and abs(model.pose.handles[0]).max() < 0.1")
    hand.settle()
    page.get_by_role("button", name="Hide the inspector").click()
    side.wait_for()
    wait_for_width(0, before["width"] + 1)

    # On the whole screen the canvas has all of it; the timeline's export shows its section.
    page.keyboard.press("w")
    page.wait_for_function("document.fullscreenElement?.classList.contains('glid-editor')")
    side.wait_for(state="hidden")
    wait_for_width(1300, 2000)
    book.screenshot("inspector-away")
    book.value("None", setup="model.save_pose()")
    page.get_by_role("button", name="Export the motion", exact=True).first.click()
    side.wait_for()
    page.get_by_role("button", name="Download").wait_for()
    page.evaluate("document.exitFullscreen()")
    page.wait_for_function("!document.fullscreenElement")
    wait_for_width(0, before["width"] + 1)
    assert side.is_visible()
