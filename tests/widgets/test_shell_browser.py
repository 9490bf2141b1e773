"""The Deform tab is one screen: a bar, the stage, the inspector, the timeline, the state."""

from __future__ import annotations

import pytest
from playwright.sync_api import Locator, Page

from .conftest import OpenNotebook
from .editor_page import NEW_PICTURE, ROOMY_EDITOR, SETUP, Hand, choose_view

pytestmark = [pytest.mark.browser, pytest.mark.slow]

EDITOR = NEW_PICTURE + ROOMY_EDITOR
PINNED = "model.add_handles([(-6.0, 0.0), (6.0, 0.0)]); model.save_pose(); model.select([0])"
SIZES = (1366, 768), (1024, 768), (390, 844)
PARTS = (".glid-tools", ".glid-deform", ".glid-side", ".glid-timeline", ".glid-foot")

# Controls and texts that are not wholly seen, and parts that reach beyond the window.
_CUT = """(root) => {
  const around = document.querySelector('.jp-WindowedPanel-outer').getBoundingClientRect();
  root.scrollIntoView({block: 'start'});
  const beyond = (one, {left, right, top, bottom}) => {
    const seen = one.getBoundingClientRect();
    return seen.left < left - 1 || seen.right > right + 1
      || seen.top < top - 1 || seen.bottom > bottom + 1;
  };
  const says = (one) => `${one.tagName} ${one.className} ${one.title || one.textContent}`;
  const found = [];
  if (beyond(root, around)) found.push('the editor is larger than the window');
  const shown = (all) => [...root.querySelectorAll(all)].filter((one) => one.checkVisibility());
  const narrow = root.classList.contains('glid-narrow');
  for (const one of shown('button, select, input, canvas, .lm-TabBar-tab')) {
    const part = one.closest('.glid-tools, .glid-pin, .glid-bar, .glid-solver-panel');
    const scrolls = part && (narrow || part.matches('.glid-solver-panel'));
    if (!scrolls && beyond(one, around)) found.push(says(one));
  }
  for (const one of shown('.glid-said, .glid-timeline-note, .widget-label, .lm-TabBar-tabLabel')) {
    if (one.clientWidth && one.scrollWidth > one.clientWidth + 1) found.push(`cut: ${says(one)}`);
  }
  return found;
}"""

# By how much the inspector can be scrolled.
_SCROLLS = "(one) => one.scrollHeight - one.clientHeight"
# What the shells of both tabs share: of bar, stage, inspector, a head in it, and the foot.
_LOOKS = """([tab, bar, stage, side, head, foot]) => {
  const style = (what, ...names) => {
    const found = getComputedStyle(document.querySelector(`${tab} ${what}`));
    return names.map((name) => found[name]);
  };
  return {
    bar: style(bar, 'height', 'padding'),
    stage: style(stage, 'backgroundColor'),
    side: style(side, 'width', 'color', 'borderLeftColor'),
    head: style(head, 'fontSize', 'fontWeight', 'color', 'letterSpacing', 'textTransform'),
    foot: style(foot, 'height', 'borderTopColor'),
  };
}"""
_DEFORM = [
    ".glid-shell",
    ".glid-toolbar",
    ".glid-pane",
    ".glid-side",
    ".glid-heading h4",
    ".glid-foot",
]
_TRACE = [
    ".glid-tracer",
    ".glid-toolbar",
    ".glid-stage",
    ".glid-panel",
    ".glid-panel h4",
    ".glid-status",
]
_KNOB = """(one) => {
  const { width, height, borderRadius } = getComputedStyle(one);
  return [width, height, borderRadius];
}"""


def box(of: Locator) -> list[float]:
    return of.evaluate(
        "(one) => { const b = one.getBoundingClientRect(); return [b.x, b.y, b.width, b.height]; }"
    )


def fitted(page: Page, hand: Hand, size: tuple[int, int]) -> None:
    """Wait until the canvas fills the stage of a window of this size."""
    page.set_viewport_size({"width": size[0], "height": size[1]})
    page.wait_for_function(
        """() => {
          const [pad, stage] = ['.glid-pad', '.glid-deform'].map(
            (one) => document.querySelector(one).getBoundingClientRect());
          return Math.abs(pad.width - stage.width) < 3;
        }"""
    )
    hand.wait_until_still()


@pytest.mark.parametrize("theme", ["JupyterLab Light", "JupyterLab Dark"])
def test_everything_is_on_one_screen(open_notebook: OpenNotebook, theme: str) -> None:
    book = open_notebook([SETUP, EDITOR])
    hand, page = Hand(book), book.page
    book.value("None", setup=f"{PINNED}; model.tell('hand')")
    hand.settle()
    page.get_by_label("Depth").wait_for()
    root = page.locator(".glid-editor")
    book.theme(theme)
    try:
        for size in SIZES:
            fitted(page, hand, size)
            name = f"shell-{size[0]}-{theme.rpartition(' ')[2]}"
            for section in ("Motion", "Files", "Proof", "Pin"):
                page.get_by_role("tab", name=section, exact=True).click()
                if section == "Pin" or size[0] > 600:
                    cut = root.evaluate(_CUT) if section == "Pin" else []
                    assert cut == [], "\n".join([name, *cut])
                    contents = page.locator(".glid-side > .widget-tab-contents")
                    assert contents.evaluate(_SCROLLS) == 0, f"{name}-{section}"
                book.screenshot(f"{name}-{section}")
            bar, stage, side, timeline, foot = (box(page.locator(part)) for part in PARTS)
            assert bar[3] == 44
            assert foot[3] >= 28
            assert timeline[3] < (115 if size[0] > 600 else 165)
            if size[0] > 600:
                assert foot[3] == 28
                assert side[2] == 280
                # As high as stage and timeline, which lies under the stage only.
                assert (side[1], side[1] + side[3]) == (stage[1], timeline[1] + timeline[3])
                assert side[1] + side[3] == foot[1]
                assert sum(stage[::2]) == sum(timeline[::2]) == side[0]
                assert stage[2] > 500
            else:
                assert stage[1] < bar[1] < side[1] < timeline[1] < foot[1]
    finally:
        book.theme("JupyterLab Light")
        page.set_viewport_size({"width": 1366, "height": 768})


def test_the_state_is_said_in_plain_words_and_plots_come_with_one_click(
    open_notebook: OpenNotebook,
) -> None:
    book = open_notebook([SETUP, EDITOR])
    hand, page = Hand(book), book.page
    book.value("None", setup=PINNED)
    hand.settle()
    foot = page.locator(".glid-foot")
    foot.get_by_text("Proved: never folds, worst squeeze ").wait_for()
    page.get_by_role("tab", name="Proof").click()
    said = page.locator(".glid-verdict").locator("b").inner_text()
    assert said == foot.locator("b").inner_text()

    # Beside the canvas, and the whole editor is still within the window.
    plots = page.locator(".glid-plots")
    assert not plots.is_visible()
    page.get_by_role("button", name="Plots").click()
    plots.wait_for()
    page.locator(".glid-shell.glid-beside").wait_for()
    book.wait_for("canvas.pane.stage.room[0] < 500")
    hand.wait_until_still()
    assert page.locator(".glid-editor").evaluate(_CUT) == []
    assert sum(box(hand.pad)[::2]) <= box(plots)[0]
    assert sum(box(plots)[::2]) <= box(page.locator(".glid-side"))[0]
    book.wait_for("editor.monitor.image.format == 'png'")
    book.screenshot("shell-plots")
    choose_view(page, "Plots")
    plots.wait_for(state="hidden")
    book.wait_for("canvas.pane.stage.room[0] > 800")


def test_the_bar_does_what_the_keys_do(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, EDITOR])
    hand, page = Hand(book), book.page
    tools = page.locator(".glid-tools")
    for tool in ("stiff", "erase", ""):
        button = tools.locator(f"[data-tool={tool or 'select'}]")
        button.click()
        book.wait_for(f"canvas.brush.tool == {tool!r}")
        assert button.get_attribute("aria-pressed") == "true"
    hand.pad.focus()
    page.keyboard.press("b")
    book.wait_for("canvas.brush.tool == 'stiff'")
    page.wait_for_function("document.querySelector('[data-tool=stiff]').ariaPressed === 'true'")
    page.keyboard.press("Escape")
    book.wait_for("canvas.brush.tool == ''")

    # The view is fitted. The keys are shown, over the bar where the window is small; their own
    # button and Escape hide them.
    book.value("None", setup="canvas.pane.stage.view = [3.0, 2.0, 0.01]")
    tools.get_by_role("button", name="See everything (F)").click()
    book.wait_for("abs(np.array(canvas.pane.stage.view[:2])).max() < 0.1")
    keys = page.locator(".glid-help:popover-open")
    for hide in (
        keys.get_by_role("button", name="Close").click,
        lambda: page.keyboard.press("Escape"),
    ):
        tools.get_by_role("button", name="Keys and gestures (?)").click()
        keys.wait_for()
        hide()
        keys.wait_for(state="hidden")

    # Arrow keys walk through the menu; Escape closes it and changes nothing else.
    hand.click((-6.0, 0.0))
    book.wait_for("model.selection == (0,)")
    page.locator(".glid-view-button").focus()
    page.keyboard.press("Enter")
    page.locator(".glid-view-menu [aria-checked=true]:focus").wait_for()
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")
    book.wait_for("canvas.overlay == 'mesh'")
    page.keyboard.press("Escape")
    page.locator(".glid-view-menu").wait_for(state="hidden")
    assert book.value("model.selection") == [0]
    assert page.locator(".glid-view-button").inner_text() == "Picture and grid"


def test_the_menu_has_groups_with_names_and_buttons_zoom(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, EDITOR])
    hand, page = Hand(book), book.page
    tools, menu = page.locator(".glid-tools"), page.locator(".glid-view-menu")
    page.locator(".glid-view-button").click()
    shows = menu.get_by_role("group", name="Show")
    assert shows.get_by_role("menuitemradio").first.inner_text() == "Picture"
    overlays = menu.get_by_role("group", name="Overlays")
    assert overlays.get_by_role("menuitemcheckbox").first.inner_text() == "Cage"
    assert menu.get_by_role("group").count() == 2
    book.screenshot("shell-view-menu")
    page.keyboard.press("Escape")

    book.wait_for("canvas.pane.stage.drawn")
    before = book.value("canvas.pane.stage.view[2]")
    tools.get_by_role("button", name="Zoom in (wheel)").click()
    book.wait_for(f"abs(canvas.pane.stage.view[2] - {before} / 1.25) < 1e-9")
    tools.get_by_role("button", name="Zoom out (wheel)").click()
    book.wait_for(f"abs(canvas.pane.stage.view[2] - {before}) < 1e-9")
    hand.wait_until_still()


@pytest.mark.parametrize("theme", ["JupyterLab Light", "JupyterLab Dark"])
def test_both_tabs_are_one_shell(open_notebook: OpenNotebook, theme: str) -> None:
    book = open_notebook([SETUP, EDITOR])
    hand, page = Hand(book), book.page
    book.value("None", setup=f"{PINNED}; model.tell('hand')")
    hand.settle()
    book.theme(theme)
    try:
        page.get_by_role("tab", name="Files").click()
        page.locator(".glid-heading h4").get_by_text("Session").wait_for()
        deform = page.evaluate(_LOOKS, _DEFORM)
        page.get_by_role("tab", name="Proof").click()
        knob = page.locator(".glid-side .noUi-handle:visible").first
        assert knob.evaluate(_KNOB) == ["14px", "14px", "7px"]
        page.get_by_role("tab", name="Trace").click()
        slider = page.locator(".glid-tracer .glid-slider").first
        slider.wait_for()
        assert slider.evaluate("(one) => getComputedStyle(one).appearance") == "none"
        assert page.evaluate(_LOOKS, _TRACE) == deform
        assert deform["side"][0] == "280px"
    finally:
        book.theme("JupyterLab Light")
