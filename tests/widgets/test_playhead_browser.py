"""The playhead while keyframes are chosen, and the advice of the timeline, in a real browser."""

from __future__ import annotations

import numpy as np
import pytest

from .conftest import OpenNotebook
from .editor_page import NEW_PICTURE, SETUP, Hand, line
from .test_timeline_browser import Timeline

BOX = """(one) => {
  const { x, y, width, height } = one.getBoundingClientRect();
  return [x, y, width, height];
}"""

pytestmark = [pytest.mark.browser, pytest.mark.slow]

EDITOR = """
from glid_nb.session.first_minute import IN_THIS_SESSION
IN_THIS_SESSION._made = {"pin", "drag", "turn"}  # the hint is about keyframes
editor = glid.Editor(picture, n_vertices=600, width=560, height=300)
canvas, model = editor.canvas, editor.deformation
editor
"""
POSES = """
model.add_handles([(-6, 0), (6, 0)])
model.save_pose(); model.drag(1, (6.0, 2.0)); model.solve(60)
model.save_pose(); model.drag(1, (6.0, -2.0)); model.solve(60)
"""
# Every place at which the playhead is, one after the other.
RECORD = """(track) => {
  window.places = [Number(track.dataset.time)];
  window.recorder = new MutationObserver(() => {
    const time = Number(track.dataset.time);
    if (time !== window.places.at(-1)) window.places.push(time);
  });
  window.recorder.observe(track, { attributes: true, attributeFilter: ["data-time"] });
}"""
WHOSE = "(said) => getComputedStyle(said, '::before').content"
SHADOW = "(key) => getComputedStyle(key).boxShadow"
# As on a page that draws slowly: frames wait, and can be given up.
HOLD_FRAMES = """() => {
  const { requestAnimationFrame: next, cancelAnimationFrame: giveUp } = window;
  const waiting = new Map();
  let last = -1;
  window.requestAnimationFrame = (does) => { waiting.set(last, does); return last--; };
  window.cancelAnimationFrame = (number) => waiting.delete(number) || giveUp(number);
  window.runFrames = () => {
    Object.assign(window, { requestAnimationFrame: next, cancelAnimationFrame: giveUp });
    for (const does of waiting.values()) next(does);
  };
}"""
# How many hollow pins were drawn last: theirs are the only strokes of this width.
COUNT_HOLLOW = """() => {
  if (window.hollow !== undefined) return; // another test counts in this page
  window.hollow = 0;
  const { clearRect, stroke } = CanvasRenderingContext2D.prototype;
  CanvasRenderingContext2D.prototype.clearRect = function (...a) {
    if (this.canvas.matches('.glid-pad > .glid-paper')) window.hollow = 0;
    return clearRect.apply(this, a);
  };
  CanvasRenderingContext2D.prototype.stroke = function (...a) {
    if (this.canvas.matches('.glid-pad > .glid-paper') && this.lineWidth === 6) window.hollow += 1;
    return stroke.apply(this, a);
  };
}"""
RECORDED = "() => { window.recorder.disconnect(); return window.places; }"


def test_the_playhead_goes_to_a_chosen_keyframe_and_nowhere_else(
    open_notebook: OpenNotebook,
) -> None:
    book = open_notebook([SETUP, NEW_PICTURE + EDITOR])
    hand, page = Hand(book), book.page
    timeline = Timeline(hand)
    book.value("None", setup=POSES)
    timeline.settle()
    times = timeline.times
    track = timeline.track

    def wait_at(index: int) -> None:
        book.wait_for(f"model.state.active == {index}")
        page.wait_for_function(
            "([track, time]) => Number(track.dataset.time) === time"
            " && !track.querySelector('.glid-seen')",
            arg=[track.element_handle(), times[index]],
        )
        hand.settle()
        hand.wait_until_drawn()

    wait_at(2)

    # By a click, from the pose that is edited, and from a motion that is shown.
    for scrubbed in (None, 0.5 * times[1]):
        if scrubbed is not None:
            timeline.scrub([scrubbed])
        before = timeline.time
        track.evaluate(RECORD)
        timeline.keys.nth(1).click()
        wait_at(1)
        assert page.evaluate(RECORDED) == [before, times[1]]
        timeline.keys.nth(2).click()
        wait_at(2)

    # By a pointer that scrubs and is let go at a keyframe.
    track.evaluate(RECORD)
    timeline.scrub([0.4 * times[1], times[1]])
    wait_at(1)
    places = page.evaluate(RECORDED)
    assert places == [times[2], pytest.approx(0.4 * times[1], abs=0.02), times[1]]

    # A keyframe between two others is made where the playhead is.
    timeline.scrub([1.5 * times[1]])
    between = timeline.time
    track.evaluate(RECORD)
    hand.pad.focus()
    page.keyboard.press("k")
    book.wait_for("len(model.state.poses) == 4")
    hand.settle()
    hand.wait_until_drawn()
    places = page.evaluate(RECORDED)
    assert times[1] not in places, places
    assert places[-1] == pytest.approx(between, abs=0.006)


def test_pins_are_seen_and_dragged_between_keyframes(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, NEW_PICTURE + EDITOR])
    hand, page = Hand(book), book.page
    timeline = Timeline(hand)
    book.value("None", setup=POSES + "model.set_repeat('ping-pong')")  # which plays on
    timeline.settle()
    between = 1.5 * timeline.times[1]
    page.evaluate(COUNT_HOLLOW)

    def wait_for_hollow(count: int) -> None:
        page.wait_for_function("(count) => window.hollow === count", arg=count)

    wait_for_hollow(0)
    timeline.scrub([between])
    still, place = book.value(f"editor.timeline.animation.pins({timeline.time}).tolist()")
    wait_for_hollow(2)
    said = page.locator(".glid-foot .glid-said")
    assert said.evaluate(WHOSE) == '"Pose 3:"'  # the footer's proof
    assert timeline.keys.nth(2).evaluate(SHADOW) == "none"
    book.screenshot("pins-between")

    # None while it plays; all when it stands still again.
    timeline.button("Play, pause")
    wait_for_hollow(0)
    timeline.button("Play, pause")
    wait_for_hollow(2)
    timeline.scrub([between])

    # A pin takes the pointer, tells what a drag does, and goes where the hand goes.
    hand.page.mouse.move(*hand.place(place))
    page.wait_for_function("document.querySelector('.glid-pad').style.cursor === 'grab'")
    assert "Pin 2: where it is at this time" in (hand.pad.get_attribute("title") or "")
    end = [place[0] - 1, place[1] + 1]
    hand.drag(line(place, end, 8))
    book.wait_for("len(model.state.poses) == 4")
    hand.wait_for_target(1, end)
    np.testing.assert_allclose(hand.targets[0], still, atol=0.01)
    assert said.evaluate(WHOSE) == "none"
    wait_for_hollow(0)  # the keyframe is edited, with its own pins

    # After the last keyframe they are where its pins should be.
    timeline.settle()
    timeline.scrub([1.25 * timeline.times[-1]])
    wait_for_hollow(2)
    hand.page.mouse.move(*hand.place([6, -2]))
    page.wait_for_function("document.querySelector('.glid-pad').style.cursor === 'grab'")


@pytest.mark.parametrize("key", ["Shift", "Control"])
def test_what_is_selected_between_keyframes_is_seen(open_notebook: OpenNotebook, key: str) -> None:
    """A box or a lasso shows the pose that is edited, whose pins it selects; a click does not."""
    book = open_notebook([SETUP, NEW_PICTURE + EDITOR])
    hand, page = Hand(book), book.page
    timeline = Timeline(hand)
    book.value("None", setup=POSES)
    timeline.settle()
    between = 1.5 * timeline.times[1]
    page.evaluate(COUNT_HOLLOW)
    timeline.scrub([between])
    page.wait_for_function("window.hollow === 2")
    places = hand.places([(3.5, 3.5), (7.6, 3.6), (7.5, -3.5), (3.4, -3.6)])

    page.keyboard.down(key)
    page.mouse.move(*places[0])
    page.mouse.down()
    page.mouse.up()
    hand.pad.and_(page.locator("[data-idle=true]")).wait_for()
    assert page.evaluate("window.hollow") == 2
    assert timeline.time == pytest.approx(between, abs=0.01)

    # Pin 2 of pose 3 is at (6, -2).
    page.mouse.down()
    for place in places[1:] if key == "Control" else places[2:3]:
        page.mouse.move(*place, steps=6)
    page.wait_for_function("window.hollow === 0")
    assert timeline.time == pytest.approx(timeline.times[2], abs=0.01)
    book.screenshot(f"select-between-{key}")
    page.mouse.up()
    page.keyboard.up(key)
    book.wait_for("model.selection == (1,)")
    assert len(timeline.times) == 3  # no keyframe was made


def test_what_the_kernel_says_before_the_first_frame_does_not_stop_the_playing(
    open_notebook: OpenNotebook,
) -> None:
    book = open_notebook([SETUP, NEW_PICTURE + EDITOR])
    hand, page = Hand(book), book.page
    timeline = Timeline(hand)
    book.value("None", setup=POSES + "model.set_repeat('ping-pong')")
    timeline.settle()
    hand.wait_until_drawn()
    page.evaluate(HOLD_FRAMES)
    timeline.button("Play, pause")
    book.value("None", setup="model.rename_pose(0, 'rest')")
    page.wait_for_function("document.querySelector('.glid-key').title.startsWith('rest at')")
    page.evaluate("window.runFrames()")
    page.wait_for_function("document.querySelector('.glid-track .glid-seen')")
    there = timeline.time
    page.wait_for_function(
        "(there) => Number(document.querySelector('.glid-track').dataset.time) !== there", arg=there
    )
    timeline.button("Play, pause")


def test_one_place_of_the_editor_gives_advice(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, NEW_PICTURE + EDITOR])
    hand, page = Hand(book), book.page
    timeline = Timeline(hand)
    note = timeline.root.locator(".glid-timeline-note")
    hint = page.locator(".glid-foot .glid-next")
    hint.get_by_text("Keep this pose as a keyframe").wait_for()
    assert not note.is_visible()
    book.screenshot("one-advice")

    timeline.button("Record")
    note.get_by_text("Recording").wait_for()
    hint.wait_for(state="hidden")
    book.screenshot("one-advice-recording")
    timeline.button("Record")
    hint.wait_for()
    note.wait_for(state="hidden")

    # What is pointed at and what is refused is told all the same.
    timeline.button("Key this pose")
    book.wait_for("len(model.state.poses) == 2")
    timeline.settle()
    note.get_by_text("Proved at every instant").wait_for()
    assert note.get_attribute("aria-live") == "off"  # the footer speaks
    timeline.root.locator(".glid-piece").first.hover()
    note.get_by_text("σ₂ ≥").wait_for()


def test_the_footer_says_whose_proof_it_is_before_it_gives_a_hint(
    open_notebook: OpenNotebook,
) -> None:
    book = open_notebook([SETUP, NEW_PICTURE + EDITOR])
    hand, page = Hand(book), book.page
    desktop = page.viewport_size
    assert desktop is not None
    page.set_viewport_size({"width": 1024, "height": 768})
    try:
        timeline = Timeline(hand)
        book.value("None", setup="model.add_handles([(-6, 0), (6, 0)])")
        hand.settle()
        timeline.button("Key this pose")
        book.wait_for("len(model.state.poses) == 2")
        timeline.settle()
        page.locator(".glid-foot .glid-next").get_by_text("Change the new pose").wait_for()
        timeline.scrub([timeline.times[1] / 2])
        page.locator(".glid-timeline[data-elsewhere]").wait_for()
        book.screenshot("footer-between-keyframes")
        foot = page.locator(".glid-foot")
        proof = foot.locator("b").get_by_text("Proved: never folds")
        (_, top, _, high), (_, y, _, tall) = (one.evaluate(BOX) for one in (foot, proof))
        assert top <= y
        assert y + tall <= top + high  # on the line that is seen
        assert proof.evaluate("one => one.scrollWidth <= one.clientWidth")
    finally:
        page.set_viewport_size(desktop)
