"""Pictures of an hour with the editor: the same moments in every host, window and look.

    python -m studies.editor.hour OUT [--hosts lab notebook voila] [--windows 1366x768 ...]
        [--looks light dark contrast] [--gpu-raster] [--chapters pins brush ...]

Run it from the repository's root; it needs the extra `test` and Chromium. A hand pins, drags,
turns, paints, sets keyframes, plays, traces and cuts (`studies.editor.moments`); at each moment a
picture is taken in each look. OUT gets HOST-WINDOW-NN-MOMENT-LOOK.png, to be looked at. A chapter
that fails is named at the end, with what its last picture was.
"""

from __future__ import annotations

import argparse
import functools
import itertools
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

from playwright.sync_api import Browser, Error, Page, ViewportSize, sync_playwright

from studies.editor.moments import CELL, ISLANDS, Chapters, PartsChapters
from tests.support.browser import (
    CHROMIUM_FLAGS,
    GPU_RASTER_FLAGS,
    JupyterServer,
    LabNotebook,
    NotebookPage,
    VoilaPage,
    chromium,
    watched_page,
)

HOSTS: dict[str, Callable[..., NotebookPage]] = {
    "lab": LabNotebook,
    "notebook": functools.partial(LabNotebook, interface="notebook"),
    "voila": VoilaPage,
}
LOOKS = "light", "dark", "contrast"
WINDOWS = "1366x768", "1920x1080", "1024x768", "390x844"
SCENES = {
    CELL: (Chapters, ["pins", "brush", "inspector", "views", "timeline", "refusals", "tracing"]),
    ISLANDS: (PartsChapters, ["parts"]),
}
FRAMES = """async () => {
  for (let i = 0; i < 3; i++) await new Promise((go) => requestAnimationFrame(go));
}"""


class Camera:
    """Takes a picture of the window in each look, in the order of the moments."""

    def __init__(self, book: NotebookPage, looks: list[str], name: Path) -> None:
        self.book, self.page, self.looks, self.name = book, book.page, looks, name
        self._taken, self._theme = itertools.count(1), "JupyterLab Light"

    def take(self, moment: str) -> None:
        """Picture a moment. The looks follow one another and end with the first one."""
        self.page.evaluate("document.querySelector('.glid-editor')?.scrollIntoView()")
        number = next(self._taken)
        for look in self.looks:
            self._wear(look)
            self.page.evaluate(FRAMES)
            self.page.screenshot(path=f"{self.name}-{number:02}-{moment}-{look}.png")
        self._wear(self.looks[0])

    def _wear(self, look: str) -> None:
        scheme = "dark" if look == "dark" else "light"
        forced = "active" if look == "contrast" else "none"
        self.page.emulate_media(color_scheme=scheme, forced_colors=forced)
        theme = f"JupyterLab {scheme.title()}"
        if isinstance(self.book, LabNotebook) and self._theme != theme:
            self.book.theme(theme)
            self._theme = theme


def main() -> None:
    """Take the pictures."""
    chosen = arguments()
    chosen.out.mkdir(parents=True, exist_ok=True)
    flags = GPU_RASTER_FLAGS if chosen.gpu_raster else CHROMIUM_FLAGS
    failures: list[str] = []
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium(), args=list(flags))
        server = JupyterServer(Path(folder) / "jupyter")
        try:
            for host, window in itertools.product(chosen.hosts, chosen.windows):
                failures += walk(browser, server, host, window, chosen)
        finally:
            server.close()
            browser.close()
    sys.exit("\n".join(failures) or None)


def arguments() -> argparse.Namespace:
    """What the command line says."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--hosts", nargs="+", choices=HOSTS, default=["lab"])
    parser.add_argument("--windows", nargs="+", default=list(WINDOWS))
    parser.add_argument("--looks", nargs="+", choices=LOOKS, default=list(LOOKS))
    parser.add_argument("--gpu-raster", action="store_true", help="draw as a user's browser does")
    parser.add_argument("--chapters", nargs="+", help="only these")
    return parser.parse_args()


def walk(
    browser: Browser, server: JupyterServer, host: str, window: str, chosen: argparse.Namespace
) -> Iterator[str]:
    """All chapters in one host and window. Yields a sentence for each that failed."""
    width, height = map(int, window.split("x"))
    size: ViewportSize = {"width": width, "height": height}
    raster = "-gpu" if chosen.gpu_raster else ""
    for cell, (chapters, names) in SCENES.items():
        wanted = [name for name in names if name in (chosen.chapters or names)]
        if not wanted:
            continue
        try:
            with watched_page(browser, viewport=size, service_workers="block") as page:
                book = opened(page, server, host, cell)
                name = chosen.out / f"{host}{raster}-{window}-{wanted[0]}"
                camera = Camera(book, chosen.looks, name)
                told = chapters(book)
                for chapter in wanted:
                    yield from pictured(camera, chapter, getattr(told, chapter)())
                book.shut_down()
        except AssertionError as problem:  # from the page's console
            yield f"{host} {window}: {problem}"


def opened(page: Page, server: JupyterServer, host: str, cell: str) -> NotebookPage:
    """A notebook with one editor, in a host."""
    return HOSTS[host](page, server, [cell])


def pictured(camera: Camera, chapter: str, moments: Iterator[str]) -> Iterator[str]:
    """Picture the moments of a chapter. Yields a sentence if it ended early."""
    last = "its beginning"
    try:
        for moment in moments:
            camera.take(moment)
            print(f"{camera.name.name}: {moment}", flush=True)
            last = moment
    except (AssertionError, Error) as problem:
        camera.take(f"failed-{chapter}")
        yield f"{camera.name.name}: {chapter} failed after {last}: {problem}"


if __name__ == "__main__":
    main()
