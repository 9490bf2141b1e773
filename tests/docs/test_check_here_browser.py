"""The page "Check a proof here": the checker runs in a real browser, on a page opened as a file.

The tests marked `install` get Pyodide from npm and python-flint from the index of Python packages,
the versions that the page names, and serve them on this machine instead of the page's addresses.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tarfile
import threading
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import ClassVar

import pytest
from playwright.sync_api import Browser, Page

from docs.extensions import proof_form

from ..support.browser import launched_chromium
from ..support.documented import REPOSITORY

pytestmark = [pytest.mark.browser, pytest.mark.slow]

WORKER = (proof_form.PARTS / "worker.js").read_text(encoding="utf-8")
RUNTIME, FLINT = re.findall(r'"(https://[^"]+)"', WORKER)
FOLDER, _, WHEEL = FLINT.rpartition("/")


class Files(SimpleHTTPRequestHandler):
    """Files that other sites may read, as on the addresses of the page."""

    extensions_map: ClassVar = {
        **SimpleHTTPRequestHandler.extensions_map,
        ".mjs": "text/javascript",
        ".wasm": "application/wasm",
    }

    def end_headers(self) -> None:
        self.send_header("Access-Control-Allow-Origin", "*")
        super().end_headers()

    def log_message(self, *_: object) -> None:
        """Print nothing."""


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with launched_chromium() as found:
        yield found


@pytest.fixture(scope="module")
def form(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("form") / "form.html"
    page = f"<!doctype html><meta charset='utf-8'>{proof_form.markup()}"
    file.write_text(page, encoding="utf-8")
    return file


def opened(browser: Browser, file: Path) -> Iterator[Page]:
    page = browser.new_page()
    failed: list[str] = []
    page.on("pageerror", lambda error: failed.append(str(error)))
    page.goto(file.as_uri())
    page.locator(".check-here[aria-busy=false]").wait_for()
    yield page
    page.close()
    assert not failed


@pytest.fixture
def page(browser: Browser, form: Path) -> Iterator[Page]:
    yield from opened(browser, form)


def verdict(page: Page, timeout: float = 30_000) -> str:
    """The words of the form when the check has ended."""
    page.locator(".check-here[aria-busy=false][data-state^=code]").wait_for(timeout=timeout)
    return page.locator(".verdict").inner_text()


def test_nothing_is_fetched_before_somebody_checks(browser: Browser, form: Path) -> None:
    asked: list[str] = []
    page = browser.new_page()
    page.on("request", lambda request: asked.append(request.url))
    page.goto(form.as_uri())
    page.locator(".check-here[aria-busy=false]").wait_for()
    assert asked == [form.as_uri()]
    page.close()


def test_without_a_network_the_form_says_so_and_can_be_used_again(page: Page) -> None:
    page.context.set_offline(True)
    page.get_by_role("button", name="Check an example").click()
    assert "needs a network" in verdict(page)
    assert page.get_by_role("button", name="Check an example").is_enabled()


def test_one_file_is_not_enough(page: Page, tmp_path: Path) -> None:
    file = tmp_path / "map.json"
    file.write_text("{}", encoding="utf-8")
    page.locator("input").set_input_files(file)
    assert verdict(page).startswith("There must be two files.")


@pytest.fixture(scope="module")
def fetched(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Pyodide from npm and python-flint's wheel from the index, in one folder."""
    folder = tmp_path_factory.mktemp("fetched")
    name, _, version = RUNTIME.rstrip("/").rpartition("/")[2].partition("@")
    npm = ["tools/npm.sh", "pack", "--silent", f"{name}@{version}", "--pack-destination", folder]
    where = {"cwd": REPOSITORY, "env": {**os.environ, "VENV": sys.prefix}}
    subprocess.run(npm, check=True, capture_output=True, **where)
    with tarfile.open(folder / f"{name}-{version}.tgz") as archive:
        archive.extractall(folder, filter="data")
    distribution, of, python, _, platform = WHEEL.removesuffix(".whl").split("-")
    pip = [sys.executable, "-m", "pip", "download", "--no-deps", "--only-binary=:all:"]
    pip += ["--platform", platform, "--python-version", f"{python[2]}.{python[3:]}"]
    pip += ["--dest", str(folder / "package"), f"{distribution}=={of}"]
    subprocess.run(pip, check=True, capture_output=True)
    return folder / "package"


@pytest.fixture
def online(browser: Browser, form: Path, fetched: Path) -> Iterator[Page]:
    """The form, with the addresses of this machine instead of the network's."""
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(Files, directory=str(fetched))) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        here = f"http://127.0.0.1:{server.server_port}/"
        text = form.read_text(encoding="utf-8").replace(RUNTIME, here).replace(f"{FOLDER}/", here)
        file = form.with_name("online.html")
        file.write_text(text, encoding="utf-8")
        yield from opened(browser, file)
        server.shutdown()


@pytest.mark.install
def test_a_proof_is_verified_and_a_forged_one_refused(online: Page) -> None:
    online.get_by_role("button", name="Check an example").click()
    assert verdict(online, 300_000).startswith("Verified.")
    printed = online.locator(".check-here pre").inner_text()
    assert printed.startswith("VERIFIED: the map is locally injective on the closed domain")
    online.get_by_role("button", name="Check a forged proof").click()
    online.locator(".check-here[data-state=code-1]").wait_for(timeout=120_000)
    assert verdict(online).startswith("Not verified.")
    assert "The map folds. Its determinant is" in online.locator(".check-here pre").inner_text()


@pytest.mark.install
def test_the_readers_own_files_are_checked_in_any_order(online: Page, tmp_path: Path) -> None:
    files = []
    for name, text in zip(("map", "proof"), proof_form.examples()["right"], strict=True):
        files.append(tmp_path / f"{name}.json")
        files[-1].write_text(text, encoding="utf-8")
    online.locator("input").set_input_files(files[::-1])
    assert verdict(online, 300_000).startswith("Verified.")
    files[0].write_text("nothing", encoding="utf-8")
    online.locator("input").set_input_files(files)
    online.locator(".check-here[data-state=code-2]").wait_for(timeout=120_000)
    assert verdict(online) == "These files cannot be checked."
