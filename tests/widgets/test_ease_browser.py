"""The easing of a segment of the timeline, changed by mouse, keys and touch, in a real browser."""

from __future__ import annotations

import pytest
from playwright.sync_api import Locator

from ..support.axe import faults
from ..support.browser import bring_into_view
from .conftest import OpenNotebook
from .editor_page import ROOMY_EDITOR, SETUP, Hand, center
from .test_timeline_browser import Timeline

pytestmark = [pytest.mark.browser, pytest.mark.slow]

POSES = """
model.add_handles([(-6.0, 0.0), (6.0, 0.0)]); model.save_pose(); model.drag(1, (6.0, 2.0))
model.save_pose(); model.drag(1, (6.0, -2.0)); model.move_pose(2, 2.0); model.go_to_pose(0)
"""
EASING = "list(model.state.timeline.easing)"


def posed_timeline(open_notebook: OpenNotebook) -> Timeline:
    """The timeline of an editor with three poses, the first of them edited."""
    book = open_notebook([SETUP, ROOMY_EDITOR])
    book.page.set_viewport_size({"width": 1366, "height": 768})
    timeline = Timeline(Hand(book))
    book.value("None", setup=POSES)
    timeline.settle()
    return timeline


def drawn(part: Locator) -> str:
    return part.locator("svg path").last.get_attribute("d") or ""


def test_each_segment_shows_its_curve_which_two_handles_change(open_notebook: OpenNotebook) -> None:
    timeline = posed_timeline(open_notebook)
    book, page, root = timeline.book, timeline.page, timeline.root
    segments, panel = root.locator(".glid-segment-ease"), root.locator(".glid-ease")
    segments.nth(1).wait_for()
    assert segments.count() == 2
    straight = drawn(segments.nth(1))

    # A preset. The panel stays open, and another segment's button shows that segment at once.
    segments.nth(0).click()
    panel.get_by_text("Pose 1 → Pose 2").wait_for()
    assert panel.get_by_role("button", name="Even").get_attribute("aria-pressed") == "true"
    # The numbers are seen whole: 0.33, not 0.3.
    cut = "all => all.map((one) => one.scrollWidth - one.clientWidth)"
    assert panel.locator("input").evaluate_all(cut) == [0, 0, 0, 0]
    segments.nth(1).click()
    panel.get_by_text("Pose 2 → Pose 3").wait_for()
    panel.get_by_role("button", name="Ease out").click()
    book.wait_for(f"{EASING}[1] == 'out'")
    segments.nth(1).locator(f"path:not([d='{straight}'])").wait_for()
    panel.locator("[aria-pressed=true]", has_text="Ease out").wait_for()

    # A handle: its whole way is one step for undo, which the keyboard reaches in the panel.
    leaving = panel.get_by_role("slider", name="How it leaves")
    x, y = center(leaving)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 20, y + 30, steps=4)
    assert book.value(f"{EASING}[1]") == "out"  # not before it is let go
    page.mouse.move(x + 42, y + 300, steps=4)
    page.mouse.up()
    book.wait_for(f"{EASING}[1] == (0.63, 0.0, 0.6666666666666666, 1.0)")
    assert leaving.get_attribute("aria-valuetext") == "time 63 %, way 0 %"
    book.screenshot("timeline-ease")
    assert faults(page, root) == []  # with the panel
    page.keyboard.press("Control+z")
    book.wait_for(f"{EASING}[1] == 'out'")
    panel.locator("[aria-pressed=true]", has_text="Ease out").wait_for()
    leaving.press("Shift+ArrowDown")
    book.wait_for(f"{EASING}[1] == (0.33, 0.57, 0.6666666666666666, 1.0)")
    timeline.settle()
    page.keyboard.press("Escape")
    panel.wait_for(state="hidden")
    assert segments.nth(1).evaluate("one => one === document.activeElement")

    # The page shows the motion as the kernel's value has it, eased.
    timeline.scrub([1.2, 1.37])
    timeline.assert_shows_the_motion()
    page.get_by_role("tab", name="Motion").click()
    timeline.keys.nth(1).click()
    page.get_by_title("How the motion leaves it").locator(
        "option:checked", has_text="Curve"
    ).wait_for(state="attached")

    # By keys alone: Enter on the ruler opens the easing that leaves the edited pose.
    root.locator(".glid-ruler").focus()
    page.keyboard.press("Enter")
    panel.get_by_text("Pose 2 → Pose 3").wait_for()
    panel.get_by_role("button", name="Hold").focus()
    page.keyboard.press("Space")
    book.wait_for(f"{EASING}[1] == 'hold'")
    leaving.wait_for(state="hidden")
    page.keyboard.press("Escape")
    panel.wait_for(state="hidden")
    timeline.settle()
    # A click on the button of the open panel closes it.
    segments.nth(0).click()
    panel.wait_for()
    segments.nth(0).click()
    panel.wait_for(state="hidden")
    book.theme("JupyterLab Dark")
    segments.nth(1).click()
    panel.wait_for()
    book.screenshot("timeline-ease-dark")
    page.keyboard.press("Escape")


def test_a_press_goes_on_while_the_kernel_changes_the_timeline(open_notebook: OpenNotebook) -> None:
    timeline = posed_timeline(open_notebook)
    book, page, root = timeline.book, timeline.page, timeline.root
    segment = root.locator(".glid-segment-ease").nth(1)
    segment.hover()
    page.mouse.down()
    book.value("None", setup="model.go_to_pose(2)")
    root.locator(".glid-key").nth(2).and_(root.locator("[aria-pressed=true]")).wait_for()
    page.mouse.up()
    root.locator(".glid-ease").get_by_text("Pose 2 → Pose 3").wait_for()
    # So does what has the focus.
    key = timeline.keys.nth(0)
    key.focus()
    book.value("None", setup="model.go_to_pose(1)")
    root.locator(".glid-key").nth(1).and_(root.locator("[aria-pressed=true]")).wait_for()
    assert key.evaluate("key => key === document.activeElement")


def test_a_finger_eases_where_segments_have_no_room_for_a_curve(
    open_notebook: OpenNotebook,
) -> None:
    book = open_notebook(
        [SETUP, ROOMY_EDITOR], has_touch=True, viewport={"width": 390, "height": 844}
    )
    hand, page = Hand(book), book.page
    book.value("None", setup=POSES)
    timeline = Timeline(hand)
    timeline.settle()
    root, session = timeline.root, page.context.new_cdp_session(page)
    panel = root.locator(".glid-ease")
    assert root.locator(".glid-segment-ease").nth(0).is_hidden()

    def touch(kind: str, *points: tuple[float, float]) -> None:
        at = [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)]
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": at})

    button = root.get_by_role("button", name="Easing of the motion")
    bring_into_view(button)
    button.tap()
    arriving = panel.get_by_role("slider", name="How it arrives")
    arriving.wait_for()
    x, y = center(arriving)
    touch("touchStart", (x, y))
    touch("touchMove", (x - 20, y - 20))
    touch("touchMove", (x - 42, y - 28))
    touch("touchEnd")
    book.wait_for(f"{EASING}[0] == (1 / 3, 1 / 3, 0.37, 0.87)")
    book.screenshot("timeline-ease-phone")
    box = panel.bounding_box()
    assert box is not None
    assert box["x"] >= 0
    assert box["x"] + box["width"] <= 390
    assert box["y"] >= 0
