"""Long sessions: neither the kernel nor the page grows, and no message is lost or delayed.

Left out unless ``--minutes`` says how long. `make leaks` takes ten minutes for the first test.
"""

import time
from collections.abc import Callable

import numpy as np
import pytest
from playwright.sync_api import CDPSession

from ..support.browser import WINDOW, JupyterServer, NotebookPage
from .conftest import OpenNotebook
from .editor_page import EDITOR, SETUP, Hand, line

SETTLING = 0.2  # of the time; after that nothing may grow to more than
GROWTH = 1.05

_MEASURE = """
import ctypes, gc, psutil
gc.collect()
ctypes.CDLL("libc.so.6").malloc_trim(0)  # what is free counts for nobody
"""


def heap(session: CDPSession) -> float:
    """MB of JavaScript objects that are still referenced."""
    session.send("HeapProfiler.collectGarbage")
    return session.send("Runtime.getHeapUsage")["usedSize"] / 1e6


def memory(book: NotebookPage) -> float:
    """MB of the kernel."""
    return book.value("psutil.Process().memory_info().rss / 1e6", _MEASURE)


def check_growth(
    book: NotebookPage, act: Callable[[], None], minutes: float, jupyter: JupyterServer
) -> None:
    """Act until the time is over. Compare the end with the state after a fifth of the time."""
    session = book.page.context.new_cdp_session(book.page)
    begin, seen = time.monotonic(), list[tuple[float, float]]()
    for share in np.linspace(SETTLING, 1, 5):
        while time.monotonic() < begin + share * 60 * minutes:
            act()
        seen.append((memory(book), heap(session)))
        print(f"{share * minutes:.1f} min: kernel {seen[-1][0]:.0f} MB, page {seen[-1][1]:.1f} MB")
    (kernel, page), *_, (kernel_at_end, page_at_end) = seen
    assert kernel_at_end < GROWTH * kernel
    assert page_at_end < GROWTH * page
    assert "No such comm" not in jupyter.log


@pytest.mark.browser
@pytest.mark.long
@pytest.mark.timeout(3600)
def test_editing_for_long_leaves_nothing_behind(
    open_notebook: OpenNotebook, jupyter: JupyterServer, minutes: float
) -> None:
    book = open_notebook([SETUP, EDITOR], viewport=WINDOW)
    hand, rng = Hand(book), np.random.default_rng(0)
    tabs = book.page.get_by_role("tab", name="Trace"), book.page.get_by_role("tab", name="Deform")

    def act() -> None:
        targets = hand.targets
        what = rng.choice(["drag", "drag", "drag", "pin", "keys", "wheel", "tabs"])
        if what == "pin" or not targets:
            hand.click(rng.uniform([-7, -1.5], [7, 1.5]).tolist())
        elif what == "drag":
            chosen = targets[rng.integers(len(targets))]
            to = np.add(chosen, rng.normal(size=2)).clip([-8, -4], [8, 4])
            hand.drag(line(chosen, to.tolist(), 12))
        elif what == "keys":
            many = "Delete" if len(targets) > 6 else "ArrowUp"
            for key in ("Control+z", "Control+z", "Control+Shift+z", many):
                book.page.keyboard.press(key)
        elif what == "wheel":
            book.page.mouse.move(*hand.place((0, 0)))
            book.page.mouse.wheel(0, float(rng.choice([-200, 200])))
            book.page.keyboard.press("f")
        else:
            for tab in tabs:
                tab.click()
            hand.wait_until_still()
        hand.settle()

    check_growth(book, act, minutes, jupyter)
    assert hand.certified()


@pytest.mark.browser
@pytest.mark.long
@pytest.mark.timeout(3600)
def test_running_the_cell_again_leaves_nothing_behind(
    open_notebook: OpenNotebook, jupyter: JupyterServer
) -> None:
    """30 times, with a pin and a drag in each."""
    book = open_notebook([SETUP, EDITOR], viewport=WINDOW)
    session = book.page.context.new_cdp_session(book.page)
    seen = []
    for count in range(36):
        if count:
            book.run_cell(1)
        hand = Hand(book)
        hand.click((6.0, 0.0))
        book.wait_for("len(model.pose) == 1")
        hand.drag(line((6.0, 0.0), [6.5, 1.0], 6))
        hand.settle()
        if count in (5, 35):
            seen.append((memory(book), heap(session)))
            print(f"{count + 1} runs: kernel {seen[-1][0]:.0f} MB, page {seen[-1][1]:.1f} MB")
    for before, after in zip(*seen, strict=True):
        assert after < GROWTH * before
    assert "No such comm" not in jupyter.log


# A disk with a wavy rim and eight such holes: 800 vertices or so. Nothing is compiled for it yet.
BUSY = """
import os
os.environ["GLID_NB_CACHE"] = __import__("tempfile").mkdtemp()
import numpy as np
import glid_nb as glid
def wavy(x, y, radius, waves, height):
    return np.hypot(x, y) < radius * (1 + height * np.cos(waves * np.arctan2(y, x)))
y, x = np.mgrid[:1200, :1200] - 599.5
image = np.zeros((1200, 1200, 4), np.uint8)
image[wavy(x, y, 540, 110, 0.04)] = 255
for turn in np.arange(8) * np.pi / 4:
    image[wavy(x - 330 * np.cos(turn), y - 330 * np.sin(turn), 100, 20, 0.15)] = 0
"""
BUSY_EDITOR = "editor = glid.Editor(image)\neditor.trace(simplify=2.0)\neditor"

# Runs a cell; returns the seconds until there is another canvas.
CANVAS_SHOWN = """(cell) => new Promise((done) => {
  for (const pad of document.querySelectorAll('.glid-pad')) pad.dataset.old = '';
  const shown = ".glid-pane:has(.glid-pad:not([data-old])) .jupyter-threejs canvas";
  const start = performance.now();
  const look = () => document.querySelector(shown) ? done((performance.now() - start) / 1e3)
    : requestAnimationFrame(look);
  window.jupyterapp.shell.currentWidget.content.activeCellIndex = cell;
  window.jupyterapp.commands.execute('notebook:run-cell');
  look();
})"""


@pytest.mark.browser
@pytest.mark.long
@pytest.mark.parametrize("wait", [0, 5])
def test_a_cell_that_is_run_again_does_not_wait_for_its_first_editor(
    open_notebook: OpenNotebook, wait: float
) -> None:
    """The first editor's solver compiles for these seconds, for a complex picture."""
    book = open_notebook([BUSY, ""], viewport=WINDOW)
    book.page.evaluate(
        "code => window.jupyterapp.shell.currentWidget.content.model.cells.get(1)"
        ".sharedModel.setSource(code)",
        BUSY_EDITOR,
    )
    first = book.page.evaluate(CANVAS_SHOWN, 1)
    book.page.wait_for_timeout(1e3 * wait)
    again = book.page.evaluate(CANVAS_SHOWN, 1)
    print(f"first {first:.1f} s, again {again:.1f} s")
    assert again < first + 1
