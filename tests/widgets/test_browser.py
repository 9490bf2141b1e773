"""The browser tests' own tools must not miss a fault."""

from __future__ import annotations

import pytest
from playwright.sync_api import Browser

from ..support.browser import LabNotebook, watched_page
from .conftest import OpenNotebook

pytestmark = [pytest.mark.browser, pytest.mark.slow]


@pytest.mark.parametrize(
    "script", ["console.error('broken')", "setTimeout(() => { throw new Error('broken') })"]
)
def test_an_error_in_the_console_fails(browser: Browser, script: str) -> None:
    def visit() -> None:
        with watched_page(browser) as page:
            page.goto("about:blank")
            with page.expect_event("console" if "console" in script else "pageerror"):
                page.evaluate(script)

    with pytest.raises(AssertionError, match="broken"):
        visit()


def test_a_notebook_runs_and_the_kernel_answers(open_notebook: OpenNotebook) -> None:
    book: LabNotebook = open_notebook(
        ["import ipywidgets\nslider = ipywidgets.IntSlider(3)\nslider", "print('se' + 'en')"]
    )
    assert book.value("slider.value + 1") == 4
    slider = book.page.locator(".widget-slider")
    slider.wait_for()
    assert "seen" in book.outputs().all_inner_texts()[-1]
    slider.locator(".noUi-handle").focus()
    book.page.keyboard.press("ArrowRight")
    book.wait_for("slider.value == 4")
    with pytest.raises(AssertionError, match="ZeroDivisionError"):
        book.value("1 / 0")
