"""The editor on a phone, in dark themes and in high contrast, and nothing of it cut off."""

from __future__ import annotations

import itertools
from io import BytesIO

import pytest
from playwright.sync_api import Locator
from skimage.io import imread

from ..support.browser import bring_into_view
from .conftest import OpenNotebook
from .editor_page import NEW_PICTURE, ROOMY_EDITOR, SETUP, Hand, choose_view, contrast

pytestmark = [pytest.mark.browser, pytest.mark.slow]

PAPER = (255, 255, 255)  # of Chromium's forced colours, in a light scheme
PINNED = "model.add_handles([(-6.0, 0.0), (6.0, 0.0)]); model.save_pose(); model.select([0])"

_BOX = """(one) => {
  const { x, y, width, height } = one.getBoundingClientRect();
  return [x, y, width, height];
}"""
# The contrasts of a colour with black and with white, by WCAG.
_CONTRASTS = """(one) => {
  const [r, g, b] = getComputedStyle(one).backgroundColor.match(/[0-9.]+/g).map(Number)
    .map((v) => v / 255).map((v) => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
  const luminance = 0.2126 * r + 0.7152 * g + 0.0722 * b;
  return [(luminance + 0.05) / 0.05, 1.05 / (luminance + 0.05)];
}"""
# The colour of the tracer's stage near the top left corner of the picture, once it is drawn.
_GROUND = """async (stage) => {
  for (let i = 0; i < 3; i++) await new Promise((go) => requestAnimationFrame(go));
  const canvas = stage.querySelector('canvas');
  const [, left, top] = stage.dataset.viewport.split(' ').map(Number);
  const dense = canvas.width / canvas.clientWidth;
  const at = [left + 3, top + 3].map((v) => Math.round(v * dense));
  return Array.from(canvas.getContext('2d').getImageData(...at, 1, 1).data);
}"""
# By how many pixels the longest row of a menu is wider than the menu's text.
_CUT_OFF = """(menu) => {
  const pen = document.createElement('canvas').getContext('2d');
  const style = getComputedStyle(menu);
  pen.font = `${style.fontSize} ${style.fontFamily}`;
  const padding = parseFloat(style.paddingLeft) + parseFloat(style.paddingRight);
  const longest = Math.max(...[...menu.options].map((one) => pen.measureText(one.text).width));
  return longest + padding - menu.clientWidth;
}"""


def box(of: Locator) -> list[float]:
    return of.evaluate(_BOX)


def overlap(a: list[float], b: list[float]) -> bool:
    return all(
        a[i] < b[i] + b[i + 2] and b[i] < a[i] + a[i + 2]  # along x, and along y
        for i in (0, 1)
    )


def test_on_a_phone_the_canvas_comes_first_and_the_tools_have_two_rows(
    open_notebook: OpenNotebook,
) -> None:
    book = open_notebook([SETUP, ROOMY_EDITOR])
    hand, page = Hand(book), book.page
    wide = box(hand.pad)
    book.value("None", setup=PINNED)
    hand.settle()
    book.value("None", setup="model.tell('hand')")
    page.get_by_label("Depth").wait_for()
    page.set_viewport_size({"width": 390, "height": 844})
    page.locator(".glid-editor.glid-narrow").wait_for()
    book.wait_for("canvas.pane.stage.room[0] < 300")
    hand.wait_until_still()
    root, pad = box(page.locator(".glid-editor")), box(hand.pad)
    assert pad[2] >= 0.93 * root[2]  # of the 274 pixels that JupyterLab leaves
    assert pad[3] >= 0.9 * pad[2]
    shell = page.locator(".glid-shell")
    rows = [
        shell.locator(part)
        for part in (".glid-tools", ".glid-bars .glid-pin:visible", ".glid-timeline")
    ]
    places = [box(row) for row in rows]
    assert pad[1] + pad[3] <= places[0][1]  # the canvas is above all of them
    for (_, above, _, height), (_, below, _, _) in itertools.pairwise(places):
        assert above + height <= below + 1
        assert height < 50  # one row
    assert box(page.locator(".glid-timeline .glid-bar"))[3] < 50
    # What has no room is scrolled to.
    for row in (".glid-tools", ".glid-timeline .glid-bar"):
        last = page.locator(f"{row} > :last-child")
        assert box(last)[0] > root[0] + root[2]
        bring_into_view(last)
        assert sum(box(last)[::2]) <= root[0] + root[2] + 1
    depth = page.get_by_label("Depth")
    bring_into_view(depth)
    assert sum(box(depth)[::2]) <= root[0] + root[2] + 1
    # No label of the ruler lies over another one.
    labels = [box(label) for label in page.locator(".glid-ruler span").all()]
    assert len(labels) > 1
    assert not any(overlap(a, b) for a, b in itertools.pairwise(labels))
    book.screenshot("editor-phone")
    # The wide window has its order and its size again.
    page.set_viewport_size({"width": 1366, "height": 768})
    page.locator(".glid-editor:not(.glid-narrow)").wait_for()
    book.wait_for("canvas.pane.stage.room[0] > 500")
    hand.wait_until_still()
    assert box(hand.pad)[2:] == wide[2:]
    assert sum(box(rows[0])[1::2]) <= box(hand.pad)[1]


def test_nothing_is_cut_off_covered_or_askew(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, ROOMY_EDITOR])
    hand, page = Hand(book), book.page
    book.value("None", setup=PINNED)
    hand.settle()
    # The list of exports and the name have the whole row.
    page.get_by_role("tab", name="Files").click()
    formats = page.get_by_title("What to export")
    formats.wait_for()
    assert formats.evaluate(_CUT_OFF) <= 0
    # The second columns of all tables of keys are aligned, and so are the first headings.
    page.get_by_role("button", name="Keys and gestures").first.click()
    table = page.locator(".glid-help:popover-open")
    table.wait_for()
    left = {round(box(cell)[0]) for cell in table.locator("td").all()}
    assert len(left) == 2  # one place in each of the two columns
    headings = [box(one) for one in table.locator("h3").all()]
    first = {round(one[0]): one[1] for one in reversed(headings)}
    assert len(first) == 2
    assert len({round(y) for y in first.values()}) == 1
    book.screenshot("editor-help")
    # On a phone they are one column, which scrolls down and not sideways.
    desktop = page.viewport_size
    assert desktop is not None
    page.set_viewport_size({"width": 390, "height": 844})
    assert table.evaluate("(one) => one.scrollWidth - one.clientWidth") == 0
    assert table.evaluate("(one) => one.scrollHeight - one.clientHeight") > 0
    assert len({round(box(cell)[0]) for cell in table.locator("td").all()}) == 1
    page.set_viewport_size(desktop)
    table.get_by_role("button", name="Close").click()
    table.wait_for(state="hidden")
    # A notice and a refused number are both read.
    page.get_by_role("tab", name="Pin").click()
    book.value("None", setup="canvas.pane.stage.notice = 'So it is.'; model.tell('hand')")
    scale = page.get_by_label("Scale")
    scale.fill("-1")
    scale.press("Enter")
    refusal = page.get_by_text("'-1' is out of range")
    refusal.wait_for()
    notice = page.locator(".glid-notice", has_text="So it is.")
    notice.wait_for()
    book.screenshot("editor-two-notices")
    assert not overlap(box(notice), box(refusal))


def test_pale_and_dark_outlines_are_seen_in_dark_themes_and_high_contrast(
    open_notebook: OpenNotebook,
) -> None:
    book = open_notebook([SETUP, ROOMY_EDITOR])
    page = book.page
    Hand(book)
    pane = page.locator(".glid-pane").first
    try:
        for theme in ("JupyterLab Dark", "JupyterLab Dark High Contrast"):
            book.theme(theme)
            assert min(pane.evaluate(_CONTRASTS)) > 3  # with black and with white
            book.screenshot(f"editor-{theme.replace(' ', '-')}")
    finally:
        book.theme("JupyterLab Light")
    # Where the system forces its colours, pressed buttons still look pressed.
    choose_view(page, "Cage")
    book.wait_for("canvas.show_cage")
    page.emulate_media(forced_colors="active")
    try:
        color = "one => getComputedStyle(one).backgroundColor"
        pressed, other = (
            page.locator(f".glid-tools [data-tool={name}]").evaluate(color)
            for name in ("select", "stiff")
        )
        book.screenshot("editor-forced-colours")
        assert pressed != other
    finally:
        page.emulate_media(forced_colors="none")


def test_the_table_of_keys_fits_or_shows_where_it_goes_on(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, ROOMY_EDITOR])
    hand, page = Hand(book), book.page
    desktop = page.viewport_size
    assert desktop is not None
    table = page.locator(".glid-help:popover-open")

    def shaded(row: int) -> bool:
        """Whether the paper is darker in a row of the table than in the heading's."""
        pixels = imread(BytesIO(table.screenshot())).astype(int)[:, 12]
        return bool((pixels[10] - pixels[row]).max() > 40)

    try:
        for size, fits in (((1024, 768), True), ((390, 844), False)):
            page.set_viewport_size({"width": size[0], "height": size[1]})
            hand.wait_until_still()
            hand.pad.focus()
            page.keyboard.press("?")
            table.wait_for()
            assert table.evaluate("one => one.scrollHeight <= one.clientHeight") == fits
            assert shaded(-4) == (not fits)
            assert not shaded(40)
            book.screenshot(f"editor-keys-{size[0]}")
            table.evaluate("one => { one.scrollTop = one.scrollHeight; }")
            assert shaded(40) == (not fits)
            assert not shaded(-4)
            page.keyboard.press("Escape")
            table.wait_for(state="detached")
    finally:
        page.set_viewport_size(desktop)


def test_high_contrast_keeps_what_is_drawn(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, ROOMY_EDITOR])
    page = book.page
    Hand(book)
    book.value("None", setup="model.add_handles([(-6.0, 0.0)]); model.save_pose()")
    page.locator(".glid-segment-ease").first.click()
    handle = page.locator(".glid-ease").get_by_role("slider", name="How it leaves")
    handle.wait_for()

    def filled() -> float:
        """The part of the handle's middle, 9 x 9 pixels, that differs from its corner."""
        pixels = imread(BytesIO(handle.screenshot())).astype(int)
        y, x = pixels.shape[0] // 2, pixels.shape[1] // 2
        middle = pixels[y - 4 : y + 5, x - 4 : x + 5]
        return float((abs(middle - pixels[0, 0]).sum(axis=-1) > 60).mean())

    try:
        page.emulate_media(forced_colors="active")
        assert filled() > 0.7  # the curve alone covers less
        page.emulate_media(forced_colors="none")
        page.keyboard.press("Escape")
        page.get_by_role("tab", name="Trace", exact=True).click()
        stage = page.locator(".glid-stage[data-viewport]")
        stage.wait_for()
        ground = stage.evaluate(_GROUND)
        page.emulate_media(forced_colors="active")
        # What lies outside the cage fades and is not hidden.
        assert stage.evaluate(_GROUND) == ground
        book.screenshot("tracer-forced-colours")
    finally:
        page.emulate_media(forced_colors="none")


def test_one_item_of_the_menu_is_marked_and_read_in_high_contrast(
    open_notebook: OpenNotebook,
) -> None:
    book = open_notebook([SETUP, ROOMY_EDITOR])
    hand, page = Hand(book), book.page
    book.value("None", setup=PINNED)
    hand.settle()
    menu = page.locator(".glid-pane .glid-menu")
    marked = menu.locator("button:focus")

    def ground(of: Locator) -> str:
        return of.evaluate("(one) => getComputedStyle(one).backgroundColor")

    try:
        for theme, least in (("JupyterLab Light", 4.5), ("JupyterLab Dark High Contrast", 7)):
            if theme != "JupyterLab Light":
                book.theme(theme)
            hand.click((-6, 0), button="right")
            menu.get_by_text("Lock").hover()
            assert marked.inner_text().startswith("Lock")  # and no longer the first one
            assert contrast(marked) >= least
            assert contrast(marked.locator("kbd")) >= least
            others = menu.locator("button:not(:focus)")
            assert {ground(one) for one in others.all()}.isdisjoint({ground(marked)})
            page.keyboard.press("Escape")
        # The system's colours also reach what lies over the picture, which keeps its own.
        page.emulate_media(forced_colors="active")
        hand.click((-6, 0), button="right")
        assert ground(menu) == f"rgb{PAPER}"
        assert ground(marked) != ground(menu)
        book.screenshot("editor-menu-forced-colours")
        page.keyboard.press("Escape")
    finally:
        page.emulate_media(forced_colors="none")
        book.theme("JupyterLab Light")


def test_sliders_are_seen_in_high_contrast(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, ROOMY_EDITOR])
    page = book.page
    Hand(book)
    book.value("None", setup=PINNED)
    weight = page.locator(".glid-pin .widget-slider").filter(has_text="Weight")
    threshold = page.locator(".glid-tracer .glid-slider").first
    try:
        page.emulate_media(forced_colors="active")
        weight.locator(".noUi-handle").wait_for()
        assert drawn(weight.locator(".noUi-target")) > 0.7  # the groove, from end to end
        book.screenshot("editor-sliders-forced-colours")
        page.get_by_role("tab", name="Trace", exact=True).click()
        threshold.wait_for()
        assert drawn(threshold) > 0.7
        book.screenshot("tracer-sliders-forced-colours")
    finally:
        page.emulate_media(forced_colors="none")


def drawn(slider: Locator) -> float:
    """The part of a slider's middle line that differs from the paper of high contrast."""
    pixels = imread(BytesIO(slider.screenshot())).astype(int)[..., :3]
    middle = pixels[pixels.shape[0] // 2]
    return float((abs(middle - PAPER).sum(axis=-1) > 60).mean())


def test_on_a_phone_sections_leave_the_timeline_on_the_screen_or_are_whole(
    open_notebook: OpenNotebook,
) -> None:
    book = open_notebook([SETUP, NEW_PICTURE, ROOMY_EDITOR])
    hand, page = Hand(book), book.page
    book.value("None", setup=PINNED)
    hand.settle()
    desktop = page.viewport_size
    assert desktop is not None
    page.set_viewport_size({"width": 390, "height": 844})
    try:
        page.locator(".glid-editor.glid-narrow").wait_for()
        book.wait_for("canvas.pane.stage.room[0] < 300")
        contents = page.locator(".glid-side > .widget-tab-contents")
        timeline = page.locator(".glid-timeline")
        bottom = 844 - 24  # above JupyterLab's own line
        for section in ("Motion", "Files", "Proof", "Pin"):
            page.get_by_role("tab", name=section, exact=True).click()
            page.locator(".glid-editor").evaluate("one => one.scrollIntoView()")
            hand.wait_until_still()
            book.screenshot(f"editor-phone-{section.lower()}")
            assert box(contents)[3] > 70
            if section in ("Files", "Proof"):  # for which the whole page is scrolled
                assert contents.evaluate("one => one.scrollHeight <= one.clientHeight")
                continue
            assert sum(box(timeline)[1::2]) <= bottom
            # The section's end is scrolled to.
            contents.evaluate("one => { one.scrollTop = one.scrollHeight; }")
            last = page.locator(".glid-side .widget-tab-contents > :visible")
            assert sum(box(last)[1::2]) <= sum(box(contents)[1::2]) + 1

        # The colour bars hide nothing of the canvas, and nothing hides them.
        book.value("None", setup="canvas.overlay, canvas.show_panels = 'sigma1', True")
        legend = page.locator(".glid-legend")
        legend.wait_for()
        page.locator(".glid-legend-part").nth(1).wait_for()
        hand.wait_until_still()
        book.screenshot("editor-phone-legend")
        for other in (hand.pad.locator(".glid-paper"), page.locator(".glid-tools")):
            assert not overlap(box(legend), box(other))
        pads, foot = box(hand.pad), page.locator(".glid-foot")
        assert pads[0] <= box(legend)[0]
        assert box(legend)[2] <= pads[2]
        page.locator(".glid-editor").evaluate("one => one.scrollIntoView()")
        hand.wait_until_still()
        assert foot.locator(".glid-next").evaluate("one => one.clientHeight") > 30  # of two lines
        assert sum(box(foot)[1::2]) <= bottom

        # The whole screen, without the inspector, is filled.
        hand.pad.focus()
        page.keyboard.press("w")
        page.wait_for_function("!!document.fullscreenElement")
        book.wait_for("canvas.pane.stage.room[2] and canvas.pane.stage.height > 450")
        hand.wait_until_still()
        book.screenshot("editor-phone-full-screen")
        assert 838 < sum(box(foot)[1::2]) <= 844
        assert box(foot.locator(".glid-said"))[2] > 300
        page.evaluate("document.exitFullscreen()")
        page.wait_for_function("!document.fullscreenElement")
    finally:
        page.set_viewport_size(desktop)


def test_a_refusal_is_seen_below_a_long_list_of_pins(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, NEW_PICTURE, ROOMY_EDITOR])
    page = book.page
    Hand(book)
    pins = [(float(x), 0.0) for x in range(-6, 7, 2)]
    book.value("None", setup=f"model.add_handles({pins}); model.select([0])")
    angle = page.get_by_label("Angle °")
    angle.fill("much")
    angle.press("Enter")
    refusal = page.get_by_text("is not a number")
    refusal.wait_for()
    book.screenshot("editor-refusal")
    contents = page.locator(".glid-side > .widget-tab-contents")
    assert contents.evaluate("one => one.scrollHeight > one.clientHeight")
    assert sum(box(refusal)[1::2]) <= sum(box(contents)[1::2])
