"""The editor in a page in which each widget loads slowly."""

from __future__ import annotations

import pytest

from .conftest import OpenNotebook
from .editor_page import ROOMY_EDITOR, SETUP, Hand

pytestmark = [pytest.mark.browser, pytest.mark.slow]

# anywidget waits two seconds for a widget's module; here no module comes in time.
NO_TIME = """
AbortSignal.timeout = () => {
  const controller = new AbortController();
  queueMicrotask(() => controller.abort());
  return controller.signal;
};
"""


def test_widgets_that_anywidget_has_given_up_hear_the_kernel(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, ROOMY_EDITOR], script=NO_TIME)
    hand, page = Hand(book), book.page
    undo = page.get_by_role("button", name="Undo").first
    assert undo.is_disabled()
    hand.click((-6.0, 0.0))
    hand.click((6.0, 0.0))
    book.wait_for("len(model.pose) == 2")
    page.locator(".glid-tools button[title^='Undo']:enabled").wait_for()
    page.get_by_role("button", name="Lock Pin 2").wait_for()
    hand.drag([(6.0, 0.0), (6.0, 1.0), (6.0, 2.0)])
    hand.wait_for_target(1, (6.0, 2.0))
    book.value("None", setup="model.save_pose()")
    page.locator(".glid-key").nth(1).wait_for()
    page.keyboard.press("Control+z")
    page.locator(".glid-key").nth(1).wait_for(state="detached")
