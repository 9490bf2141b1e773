"""The track of the timeline reads as animation, in a real browser."""

from __future__ import annotations

import pytest

from .conftest import OpenNotebook
from .editor_page import center
from .test_ease_browser import EASING, posed_timeline
from .test_timeline_browser import Timeline

pytestmark = [pytest.mark.browser, pytest.mark.slow]

TIMES = "list(model.state.timeline.times)"
RANGE = "model.state.timeline.loop_range"


def test_diamonds_curves_proof_and_ruler(open_notebook: OpenNotebook) -> None:
    timeline = posed_timeline(open_notebook)
    book, page, root = timeline.book, timeline.page, timeline.root
    diamonds, segments = root.locator(".glid-diamonds i"), root.locator(".glid-segment-ease")
    page.mouse.move(3, 3)
    book.screenshot("timeline-track")

    # Each keyframe has a diamond at its exact time; that of the edited pose is filled.
    for i, time in enumerate((0.0, 1.0, 2.0)):
        assert center(diamonds.nth(i))[0] == pytest.approx(timeline.x(time), abs=1)
    assert diamonds.evaluate_all("all => all.map((one) => one.dataset.selected)") == [
        "true",
        "false",
        "false",
    ]

    # The ruler is high enough for a finger, and neither the playhead's label nor a mark of a range
    # that is not set lies over its numbers.
    ruler, head = timeline.box(root.locator(".glid-ruler")), root.locator(".glid-playhead")
    assert ruler["height"] >= 24
    numbers = timeline.box(root.locator(".glid-ruler b").first)
    assert numbers["y"] + numbers["height"] <= timeline.box(head)["y"] + 1
    assert root.locator(".glid-ruler span > *").all_inner_texts()[:2] == ["0", "0 s"]
    for mark in root.locator(".glid-range-mark").all():
        assert mark.evaluate("(one) => getComputedStyle(one).opacity") == "0"
    assert head.evaluate("(one) => getComputedStyle(one).borderLeftColor") == root.locator(
        ".glid-diamonds [data-selected=true]"
    ).evaluate("(one) => getComputedStyle(one, '::before').borderLeftColor")

    # The proof is a line without gaps, directly below the pictures.
    strip, key = timeline.box(root.locator(".glid-strip")), timeline.box(timeline.keys.nth(0))
    assert strip["height"] == 6
    assert 0 <= strip["y"] - key["y"] - key["height"] <= 1
    assert timeline.longest_gap() <= 2  # the playhead

    # A curve reaches from picture to picture, with its name; its panel leaves the bar free.
    curve = timeline.box(segments.nth(0).locator("svg"))
    assert curve["x"] - timeline.x(0) < 40
    assert timeline.x(1) - curve["x"] - curve["width"] < 40
    assert segments.nth(0).inner_text() == "Even"
    root.evaluate("(one) => one.scrollIntoView({block: 'end'})")
    segments.nth(0).click()
    panel = root.locator(".glid-ease")
    shown, around = panel.bounding_box(), root.bounding_box()
    assert shown is not None
    assert around is not None
    assert shown["y"] + shown["height"] <= around["y"]
    panel.get_by_label("How it arrives: share of the way").fill("0.25")
    page.keyboard.press("Enter")
    book.wait_for(f"{EASING}[0][3] == 0.25")
    page.keyboard.press("Escape")
    segments.nth(0).get_by_text("Curve", exact=True).wait_for()

    _assert_a_diamond_is_dragged(timeline)


def _assert_a_diamond_is_dragged(timeline: Timeline) -> None:
    book, page = timeline.book, timeline.page
    x, y = center(timeline.root.locator(".glid-diamonds i").nth(1))
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(timeline.x(1.4), y, steps=4)
    page.mouse.up()
    book.wait_for(f"abs({TIMES}[1] - 1.4) < 0.03")
    page.keyboard.press("Control+z")
    book.wait_for(f"{TIMES} == [0, 1, 2]")


def test_the_menu_says_that_a_range_loops(open_notebook: OpenNotebook) -> None:
    timeline = posed_timeline(open_notebook)
    book, menu = timeline.book, timeline.root.locator("select")
    assert menu.locator("option:checked").inner_text() == "Once"
    book.value("None", setup="model.set_loop_range((0.4, 1.2))")
    menu.locator("option:checked", has_text="Loop range").wait_for(state="attached")
    menu.select_option("once")
    book.wait_for(f"{RANGE} is None")
    menu.locator("option[value=range]").wait_for(state="detached")
    assert menu.input_value() == "once"
