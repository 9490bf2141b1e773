"""Fixtures of the tests that drive a real browser; see tests/support/browser.py."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import pytest
from playwright.sync_api import Browser, Page

from ..support.browser import (
    JupyterServer,
    LabNotebook,
    NotebookPage,
    SharedLab,
    launched_chromium,
    watched_page,
)

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


@pytest.fixture(scope="session")
def lab(browser: Browser, jupyter: JupyterServer) -> Iterator[SharedLab]:
    """A page of JupyterLab and a kernel, which tests use one after the other."""
    lab = SharedLab(browser, jupyter)
    yield lab
    lab.close()


@pytest.fixture
def open_notebook(
    browser: Browser, jupyter: JupyterServer, lab: SharedLab
) -> Iterator[OpenNotebook]:
    """``open_notebook(cells, shown_by=LabNotebook, **context)``: a notebook with its cells run.

    It opens in the page that tests share. With ``context``, which is as for `watched_page` (for
    example ``has_touch=True``), or with ``shown_by``, which makes it of a page, the server and the
    cells, it gets a page of its own. One notebook per test; an error in the browser's console fails
    the test.
    """
    with contextlib.ExitStack() as stack:

        def open_one(
            cells: Sequence[str],
            shown_by: Callable[..., NotebookPage] | None = None,
            **settings: Any,
        ) -> NotebookPage:
            shared = shown_by is None and not settings
            if shown_by is None:
                stack.callback(lab.clear)  # after the page was checked
            page = lab.page if shared else stack.enter_context(watched_page(browser, **settings))
            if shown_by is None:
                book: NotebookPage = LabNotebook(page, jupyter, cells, lab=lab)
            else:
                book = shown_by(page, jupyter, cells)
                stack.callback(book.shut_down)
            if shared:
                stack.callback(lab.check)
            return book

        yield open_one


@pytest.fixture
def sent(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The messages that widgets send to the page from now on: pairs of data and buffers."""
    from comm import DummyComm

    messages: list[Any] = []

    def publish(_: Any, kind: str, data: Any = None, buffers: Any = None, **__: Any) -> None:
        if kind == "comm_msg":
            messages.append((data, list(buffers or [])))

    monkeypatch.setattr(DummyComm, "publish_msg", publish)
    return messages
