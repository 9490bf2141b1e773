"""The timeline's ruler in frames, its zoom, and names on the thumbnails, in a real browser."""

from __future__ import annotations

import pytest

from .conftest import OpenNotebook
from .editor_page import ROOMY_EDITOR, SETUP, Hand, center

pytestmark = [pytest.mark.browser, pytest.mark.slow]

POSES = """
model.add_handles([(-6.0, 0.0), (6.0, 0.0)]); model.save_pose(); model.drag(1, (6.0, 2.0))
model.save_pose(); model.drag(1, (6.0, -2.0)); model.move_pose(2, 2.0); model.go_to_pose(0)
"""


def test_a_timeline_is_read_in_frames_zoomed_and_named(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, ROOMY_EDITOR])
    hand, page = Hand(book), book.page
    book.value("None", setup=POSES)
    hand.settle()
    book.wait_for("editor.timeline.animation.wait(60)", 90)
    root = page.locator(".glid-timeline")
    track, view = root.locator(".glid-track"), root.locator(".glid-track-view")
    keys, ruler = root.locator(".glid-key:not(.glid-return)"), root.locator(".glid-ruler")
    keys.nth(2).wait_for()

    def labels() -> list[tuple[str, str]]:
        return ruler.locator("span").evaluate_all(
            "all => all.map(s => ['small', 'b'].map(one => s.querySelector(one)?.textContent))"
        )

    # A label has the export's frame and its second, which follow the frame rate in Files.
    assert ["1 s", "25"] in labels()
    book.value("None", setup="editor.files.motion.rate.value = 10")
    ruler.get_by_text("20", exact=True).wait_for()
    assert ["1 s", "10"] in labels()
    ruler.focus()
    page.keyboard.press("ArrowRight")
    assert float(track.get_attribute("data-time") or "nan") == pytest.approx(0.1)
    page.keyboard.press("Escape")

    # Ctrl and the wheel zoom about the pointer, where a keyframe stays; the page does not scroll.
    x, y = center(keys.nth(1))
    page.mouse.move(x, y)
    page.keyboard.down("Control")
    for _ in range(3):
        page.mouse.wheel(0, -120)
    page.keyboard.up("Control")
    page.wait_for_function(
        "one => one.offsetWidth > 3 * one.parentElement.clientWidth", arg=track.element_handle()
    )
    assert center(keys.nth(1))[0] == pytest.approx(x, abs=2)
    assert len(labels()) > 20
    assert ruler.locator(".glid-frames").is_visible()
    book.screenshot("timeline-zoomed")
    # A wheel alone moves along; the playhead is brought back into sight.
    left = view.evaluate("one => one.scrollLeft")
    page.mouse.wheel(0, 200)
    page.wait_for_function(
        "([one, left]) => one.scrollLeft > left", arg=[view.element_handle(), left]
    )
    ruler.focus()
    page.keyboard.press("End")
    page.locator(".glid-timeline[data-active='2/3']").wait_for()
    page.keyboard.press("ArrowLeft")
    root.locator(".glid-playhead.glid-seen").wait_for()
    box, seen = root.locator(".glid-playhead").bounding_box(), view.bounding_box()
    assert box is not None
    assert seen is not None
    assert seen["x"] <= box["x"] <= seen["x"] + seen["width"]
    page.keyboard.press("Escape")
    for _ in range(9):
        root.get_by_role("button", name="See more of the timeline").click()
    page.wait_for_function(
        "one => one.offsetWidth === one.parentElement.clientWidth", arg=track.element_handle()
    )

    # A double click opens a field for the name; Escape leaves it as it was.
    field = root.locator(".glid-name-field")
    keys.nth(1).dblclick()
    field.wait_for()
    book.screenshot("timeline-name")
    page.keyboard.type("up")
    page.keyboard.press("Enter")
    book.wait_for("model.state.poses[1].name == 'up'")
    field.wait_for(state="detached")
    keys.nth(2).focus()
    page.keyboard.press("F2")
    field.wait_for()
    page.keyboard.type("nothing")
    page.keyboard.press("Escape")
    field.wait_for(state="detached")
    assert book.value("model.state.poses[2].name") == "Pose 3"
    page.keyboard.press("Control+z")
    book.wait_for("model.state.poses[1].name == 'Pose 2'")
