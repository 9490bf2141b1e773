"""Fixtures of the tests that drive a real browser; see tests/browser.py."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import pytest
from playwright.sync_api import Browser, Page

from ..browser import JupyterServer, LabNotebook, NotebookPage, launched_chromium, watched_page

OpenNotebook = Callable[..., Any]


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """Chromium, one for all tests."""
    with launched_chromium() as browser:
        yield browser


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    """An empty page; an error in its console fails the test."""
    with watched_page(browser) as page:
        yield page


@pytest.fixture(scope="session")
def jupyter(tmp_path_factory: pytest.TempPathFactory) -> Iterator[JupyterServer]:
    """JupyterLab, one server for all tests."""
    server = JupyterServer(tmp_path_factory.mktemp("jupyter"))
    yield server
    server.close()


@pytest.fixture
def open_notebook(browser: Browser, jupyter: JupyterServer) -> Iterator[OpenNotebook]:
    """``open_notebook(cells, shown_by=LabNotebook, **context)``: a notebook with its cells run.

    ``shown_by`` makes it of a page, the server and the cells; by default it opens in JupyterLab.
    ``context`` is as for `watched_page`, for example ``has_touch=True``. One
    notebook per test; an error in the browser's console fails the test.
    """
    with contextlib.ExitStack() as stack:

        def open_one(
            cells: Sequence[str],
            shown_by: Callable[..., NotebookPage] = LabNotebook,
            **settings: Any,
        ) -> NotebookPage:
            page = stack.enter_context(watched_page(browser, **settings))
            book = shown_by(page, jupyter, cells)
            stack.callback(book.shut_down)
            return book

        yield open_one


@pytest.fixture
def sent(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """What widgets send to the page from now on: pairs of data and buffers."""
    from ipywidgets import Widget

    messages: list[Any] = []

    def send(_: Any, message: dict[str, Any], buffers: Any = None) -> None:
        messages.append((message, list(buffers or [])))

    monkeypatch.setattr(Widget, "_send", send)
    return messages
