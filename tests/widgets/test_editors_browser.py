"""Several editors on a page, several views of one editor, and a page that is loaded again."""

from __future__ import annotations

import pytest

from .conftest import OpenNotebook
from .editor_page import EDITOR, SETUP, Hand, center, line

pytestmark = [pytest.mark.browser, pytest.mark.slow]


NAMED = "{name} = glid.Editor(picture, n_vertices=500, width=480, height=300)\n{name}"

# Remembers the page's canvases with WebGL, so that those with a living context can be counted.
COUNT_CONTEXTS = """
window.drawnOn = new Set();
const getContext = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
  const context = getContext.call(this, kind, ...rest);
  if (context && kind.includes('webgl')) window.drawnOn.add(context);
  return context;
};
"""
LIVING_CONTEXTS = "[...window.drawnOn].filter((context) => !context.isContextLost()).length"


FILLED = """
def filled(editor):
    measured = editor.canvas.pane.stage.drawing_time > 0
    return measured and all(box.children for box in editor._boxes.values())
def made():
    instances = __import__('ipywidgets').widgets.widget._instances
    # Where the page moves the vertices, a mesh has two attributes more.
    by_page = [e.canvas.pane.scene.evaluated_in == "page" for e in (one, two)]
    return len(instances) - 2 * sum(by_page)
"""
SOLVERS = """
import threading
solvers = [thread for thread in threading.enumerate() if thread.name == "live solver"]
"""


def test_two_editors_at_once_and_a_rerun(open_notebook: OpenNotebook) -> None:
    cells = [SETUP, NAMED.format(name="one"), NAMED.format(name="two")]
    book = open_notebook(cells, script=COUNT_CONTEXTS)
    one, two = Hand(book, 0, "one.canvas"), Hand(book, 1, "two.canvas")
    for hand in (one, two):
        hand.click((-6.0, 0.0))
        hand.click((6.0, 0.0))
        book.wait_for(f"len({hand.model}.pose) == 2")
        hand.settle()

    # Code moves one editor while a hand drags in the other. Neither affects the other.
    book.value("None", setup="one.drag(1, to=(4.0, 3.0))")
    two.drag(line((6.0, 0.0), (6.5, -2.0), 15))
    two.wait_for_target(1, [6.5, -2.0])
    one.settle()
    for hand, target in ((one, [4.0, 3.0]), (two, [6.5, -2.0])):
        hand.wait_until_drawn()
        assert hand.certified()
        (gap,) = book.value(f"abs({hand.model}.map([[6.0, 0.0]]) - {target}).max(axis=1).tolist()")
        assert gap < 0.15  # the hand placed the handle within a few pixels
    assert one.targets[1] == [4.0, 3.0]
    book.screenshot("editor-two-at-once")

    # A rerun of a cell closes its editor and not the other one. Nothing accumulates.
    widgets, threads = "made()", "len(__import__('threading').enumerate())"
    before, contexts = [0, 0], 0
    book.value("None", setup=FILLED)
    filled = "filled(one) and filled(two)"  # in the pads' thread
    for repetition in range(4):
        book.wait_for(filled)
        if repetition == 1:  # the first one has left work that the next editors offer
            before = book.value(f"[{widgets}, {threads}]")
            contexts = book.page.evaluate(LIVING_CONTEXTS)
        book.value("None", setup=f"old = two{SOLVERS}")
        book.run_cell(2)
        two = Hand(book, 1, "two.canvas")
        assert book.value("old is not two")
        assert book.value("[thread.is_alive() for thread in solvers].count(True)") == 1
        assert book.value("[any(v is e for v in Out.values()) for e in (old, two)]") == [
            False,
            True,
        ]
        book.page.wait_for_function("document.querySelectorAll('.glid-pad').length === 2")
    book.wait_for(filled)
    book.wait_for(f"{threads} <= {before[1]}")
    assert book.value(widgets) <= before[0]
    # pythreejs lends renderers from a pool. If a new editor asks before the old one has returned
    # its renderer, the pool grows by one, once.
    assert book.page.evaluate(LIVING_CONTEXTS) <= contexts + 1
    assert two.handles == []
    two.click((0.0, 0.0))
    book.wait_for("len(two.pose) == 1")
    assert one.targets[1] == [4.0, 3.0]
    one.drag(line(one.targets[0], [-6.0, 1.5], 5))
    one.wait_for_target(0, [-6.0, 1.5])
    one.wait_until_drawn()


def test_two_views_and_a_reload(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, EDITOR, "canvas"])
    hand, other = Hand(book), Hand(book, pad=1)
    book.wait_for("model.moment.solved")  # the solver begins by itself, once the canvas is drawn
    hand.click((-6.0, 0.0))
    book.wait_for("len(model.pose) == 1")
    hand.settle()
    other.click((6.0, 0.0))
    book.wait_for("len(model.pose) == 2")
    hand.settle()
    other.drag(line((6.0, 0.0), [6.0, 2.0], 10))
    hand.wait_for_target(1, [6.0, 2.0])
    state = hand.targets
    hand.wait_until_drawn()
    # Both views show the same.
    for point in ([-6.0, 0.9], [0.0, -1.0], [3.1, 1.0]):
        (image,) = book.value(f"model.map([{point}]).tolist()")
        first, second = hand.color_at(image), other.color_at(image)
        assert max(abs(a - b) for a, b in zip(first, second, strict=True)) <= 8
    book.screenshot("editor-two-views")
    book.reload()
    again = Hand(book)
    assert again.targets == state
    again.wait_until_drawn()
    again.drag(line(state[1], [6.0, 1.0], 5))
    again.wait_for_target(1, [6.0, 1.0])


def test_an_opened_session_and_another_picture_are_seen(open_notebook: OpenNotebook) -> None:
    other = "other = np.ascontiguousarray(picture[:, 40:160])"
    book = open_notebook([SETUP, f"{other}\n{EDITOR}"])
    hand = Hand(book, canvas="editor.canvas")
    hand.click((-6.0, 0.0))
    book.wait_for("len(editor.pose) == 1")
    hand.settle()
    handles, page = hand.handles, book.page
    page.get_by_role("tab", name="Files").click()
    page.get_by_placeholder("Name.glid").fill("seen.glid")
    page.get_by_title("Write the session file").click()
    page.get_by_text("Saved", exact=False).first.wait_for()
    book.value("None", setup="before = editor.canvas")
    page.get_by_title("Continue with the session file").click()
    book.wait_for("editor.canvas is not before")
    again = Hand(book, canvas="editor.canvas")
    assert again.handles == handles
    bar = page.locator(".glid-editor .lm-TabBar").first
    selected = bar.locator(".lm-mod-current .lm-TabBar-tabLabel")
    assert selected.all_inner_texts() == ["Deform"]
    # Every tab has content.
    page.get_by_role("tab", name="Files").click()
    page.get_by_title("Write the session file").wait_for()
    page.get_by_role("tab", name="Trace").click()
    page.locator(".glid-tracer canvas").first.wait_for()
    # Another picture is deformed as soon as its tab is opened.
    book.value("None", setup="before = editor.canvas; editor.model.tracing.open(other)")
    page.get_by_role("tab", name="Deform").click()
    book.wait_for("editor.canvas is not before")
    page.get_by_text("comes back with Undo in the Trace tab").wait_for()
    Hand(book, canvas="editor.canvas").click((1.0, 0.0))
    book.wait_for("len(editor.pose) == 1")
    assert selected.all_inner_texts() == ["Deform"]
    book.screenshot("editor-another-picture")
    # Undo brings back the picture before, with the work on it.
    page.get_by_role("tab", name="Trace").click()
    page.locator(".glid-tracer").get_by_role("button", name="Undo (Ctrl+Z)").click()
    book.wait_for("editor.tracer.image.shape == picture.shape")
    book.value("None", setup="before = editor.canvas")
    page.get_by_role("tab", name="Deform").click()
    book.wait_for("editor.canvas is not before")
    back = Hand(book, canvas="editor.canvas")
    back.wait_until_drawn()
    assert back.handles == handles
    page.get_by_text("comes back with Redo in the Trace tab").wait_for()
    book.screenshot("editor-picture-back")


RESTART = """() => window.jupyterapp.shell.currentWidget.sessionContext.session.kernel.restart()
  .then(() => null)"""


def test_work_survives_a_restart_of_the_kernel(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, EDITOR], service_workers="block")
    page, root = book.page, book.page.locator(".glid-editor")
    page.locator(".glid-pad").wait_for()
    book.value("None", setup="model.paused = True")
    page.locator(".glid-pad").click(position={"x": 280, "y": 200})
    kept = "editor.model.saving and editor.model.saving.path.exists()"
    book.wait_for(f"len(editor.pose) == 1 and {kept}")
    page.evaluate(RESTART)
    page.locator(".glid-editor.jupyter-widgets-disconnected").wait_for()
    said = "element => getComputedStyle(element, '::after').content"
    assert "Run the cell again; your work is kept." in root.evaluate(said)
    icons = """() => [...document.querySelectorAll('.glid-editor .jupyter-widgets-disconnected')]
      .filter((element) => getComputedStyle(element, '::before').display !== 'none').length"""
    assert page.evaluate(icons) == 0
    # Nothing below it gets a click or raises an error.
    page.mouse.click(*center(page.locator(".glid-pad")))
    page.locator(".glid-pad").focus()
    page.keyboard.press("ArrowLeft")
    book.screenshot("editor-restarted")
    book.run_all()
    page.get_by_text("work on this picture is kept").wait_for()
    book.screenshot("editor-kept-work")
    page.get_by_role("button", name="Restore it").click()
    book.wait_for("len(editor.pose) == 1")
    assert not page.get_by_role("button", name="Discard").is_visible()
