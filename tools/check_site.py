"""Checks a built site: ``python tools/check_site.py site``.

Every link and anchor between its pages must resolve. In Chromium, every page must open at the width
of a phone and of a desktop, without an error in the console, a request outside the folder, or
sideways scrolling. Displayed formulas, and the figures and printed sentences of chapters, must be
visible as a whole. A live page must start, and every slider of a figure must change the picture.
Searching must find a page. Pages are opened as files, without a server.
``--links`` checks only the links.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

from playwright.sync_api import Browser, ConsoleMessage, Request

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from tests.support.browser import launched_chromium, still_sliders

WIDTHS = {390: 844, 1280: 800}
SEARCH = "winding"

_OVERFLOW = """() => {
  const width = document.documentElement.clientWidth;
  if (document.documentElement.scrollWidth <= width) return [];
  const clipped = (e) => {
    for (let p = e.parentElement; p && p !== document.body; p = p.parentElement)
      if (getComputedStyle(p).overflowX !== 'visible') return true;
    return false;
  };
  return [...document.querySelectorAll('body *')]
    .filter((e) => e.getBoundingClientRect().right > width + 1 && !clipped(e))
    .slice(0, 3).map((e) => e.outerHTML.slice(0, 120));
}"""

# What a reader would have to scroll sideways, though it can break or be drawn narrow. Printed
# tables (docs/extensions/printed.py) may scroll.
_CUT = """() => {
  const right = (e) => e.getBoundingClientRect().left + e.clientWidth;
  const output = '.cell_output img, .cell_output pre';
  const seen = `.equation .broken, .equation :not(.broken) > math, ${output}`;
  const table = (e) => e.closest('.columns') !== null; // of docs/extensions/printed.py
  return [...document.querySelectorAll(seen)]
    .filter((e) => !table(e))
    .filter((e) => {
      const box = e.closest('.equation, .cell_output');
      return e.scrollWidth > e.clientWidth + 1 || e.getBoundingClientRect().right > right(box) + 1;
    })
    .map((e) => e.textContent.slice(0, 60) || e.outerHTML.slice(0, 120));
}"""


class Links(HTMLParser):
    """The anchors of a page, and its links."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.anchors = {"", "top"}
        self.targets: list[str] = []
        self.feed(text)

    def handle_starttag(self, _tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        self.anchors |= {value for key in ("id", "name") if (value := given.get(key))}
        self.targets += [value for key in ("href", "src") if (value := given.get(key))]


def html_pages(site: Path) -> list[Path]:
    """All pages except the theme's own templates."""
    return sorted(p for p in site.rglob("*.html") if "_static" not in p.parts)


def broken_links(site: Path) -> Iterator[str]:
    """One sentence for every link whose file or anchor does not exist."""
    pages = {path.resolve(): Links(path.read_text(encoding="utf-8")) for path in html_pages(site)}
    for page, links in pages.items():
        for target in links.targets:
            parts = urlsplit(target)
            if parts.scheme or parts.netloc:
                continue
            path = (page.parent / unquote(parts.path)).resolve() if parts.path else page
            name = page.relative_to(site.resolve())
            if not path.is_file():
                yield f"{name}: {target} is not a file"
            elif path in pages and unquote(parts.fragment) not in pages[path].anchors:
                yield f"{name}: {target} has no such anchor"


class Visitor:
    """A page of the browser that records errors."""

    def __init__(self, browser: Browser, home: str, width: int, height: int) -> None:
        self.page = browser.new_page(viewport={"width": width, "height": height})
        self.home, self.notes = home, list[str]()
        self.page.on("console", self._console)
        self.page.on("pageerror", lambda error: self.notes.append(str(error)))
        self.page.on("request", self._request)

    def _console(self, message: ConsoleMessage) -> None:
        if message.type == "error":
            self.notes.append(message.text)

    def _request(self, request: Request) -> None:
        if not request.url.startswith((self.home, "data:", "blob:")):
            self.notes.append(f"asks for {request.url}")

    def visit(self, name: str) -> list[str]:
        """The faults of a page."""
        self.notes.clear()
        self.page.goto(self.home + name)
        if name == "index.html":  # leads on to the start page
            self.page.wait_for_url(f"{self.home}docs/**")
        for live in self.page.locator("iframe.live").all():
            live.content_frame.locator("html[data-ready=true]").wait_for(state="attached")
        figures = self.page.locator("figure.glid-frames").all()
        still = [fault for figure in figures for fault in still_sliders(figure)]
        wide = self.page.evaluate(_OVERFLOW)
        cut = self.page.evaluate(_CUT)
        return [
            *self.notes,
            *still,
            *(f"wider than the page: {element}" for element in wide),
            *(f"a formula, figure or sentence is cut off: {element}" for element in cut),
        ]

    def search(self, word: str) -> list[str]:
        """The faults of searching for an existing word; raises an error if nothing is found."""
        self.notes.clear()
        self.page.goto(f"{self.home}search.html?q={word}")
        self.page.wait_for_selector("#search-results li a", timeout=20_000)
        return list(self.notes)


def faults_in_browser(site: Path) -> Iterator[str]:
    """One sentence for every page that does not open well."""
    with launched_chromium() as browser:
        for width, height in WIDTHS.items():
            visitor = Visitor(browser, f"{site.resolve().as_uri()}/", width, height)
            for path in html_pages(site):
                name = path.relative_to(site).as_posix()
                yield from (f"{name} at {width} px: {fault}" for fault in visitor.visit(name))
            yield from (f"search at {width} px: {fault}" for fault in visitor.search(SEARCH))
            visitor.page.close()


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("site", type=Path)
    parser.add_argument("--links", action="store_true", help="do not start the browser")
    given = parser.parse_args(arguments)
    found = list(broken_links(given.site))
    if not given.links:
        found += faults_in_browser(given.site)
    print(*found, sep="\n" if found else "", file=sys.stderr)
    pages = len(html_pages(given.site))
    print(f"{pages} pages, {len(found)} faults")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
