"""Draws the README's pictures of the editor, in use in JupyterLab and Chromium.

    python -m studies.draw_screenshots [NAME ...]

Run it from the repository's root; it needs the extra `test` and Chromium. The pictures are written
to docs/, with few colours, so that the files are small.
"""

import argparse
import io
import os
import tempfile
from collections.abc import Callable
from pathlib import Path

from PIL import Image
from playwright.sync_api import Browser

import glid_nb
from tests.support.browser import JupyterServer, LabNotebook, launched_chromium, watched_page
from tests.widgets.editor_page import Hand, line

DOCS = Path(__file__).parent.parent / "docs"
DENSITY = 1.5  # pixels of the screenshot per CSS pixel
CELL = """
import glid_nb as glid
editor = glid.Editor(glid.samples.image({sample!r}), plots={plots})
canvas, model = editor.canvas, editor.deformation
editor
"""


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help="by default all pictures")
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, launched_chromium() as browser:
        os.environ["GLID_NB_DATA"] = folder  # so that no kept work is offered
        server = JupyterServer(Path(folder) / "jupyter")
        try:
            for name in chosen.names or PICTURES:
                path = DOCS / f"{name}.png"
                path.write_bytes(small(PICTURES[name](browser, server)))
                print(f"{path}: {path.stat().st_size:,} bytes")
        finally:
            server.close()


def trace_tab(browser: Browser, server: JupyterServer) -> bytes:
    """A leaf with eight holes, one of them removed."""

    def use(book: LabNotebook) -> None:
        book.page.locator(".lm-TabBar-tabLabel", has_text="Trace").click()
        stage = book.page.locator(".glid-stage[data-viewport]")
        stage.wait_for()
        book.page.locator(".glid-hole input").first.click()
        book.wait_for("editor.tracer.cage.n_holes == 7")
        box = stage.bounding_box()
        assert box is not None
        scale, left, top = map(float, (stage.get_attribute("data-viewport") or "").split())
        x, y = book.value("editor.tracer.tracing.holes[4].pixel")
        book.page.mouse.move(box["x"] + left + scale * x, box["y"] + top + scale * y)

    return pictured(browser, server, "monstera", use)


def deform_tab(browser: Browser, server: JupyterServer) -> bytes:
    """A frog after a drag, coloured by its compression."""

    def use(book: LabNotebook) -> None:
        hand = posed(book, "frog")
        book.value("None", "canvas.overlay, canvas.show_panels = 'sigma2', True")
        dragged(hand, 0.75)

    return pictured(browser, server, "frog", use, plots=True)


def deform_tab_dark(browser: Browser, server: JupyterServer) -> bytes:
    """A gecko beside its undeformed shape, with poses on the timeline, in the dark theme."""

    def use(book: LabNotebook) -> None:
        book.theme("JupyterLab Dark")
        book.value("None", "canvas.overlay, canvas.show_source = 'mesh', True")
        book.page.locator(".glid-pad").nth(1).wait_for()
        hand = posed(book, "gecko", pad=1)
        for share in (0.0, 0.6):
            moved = f"pose.handles + {share} * (pose.targets - pose.handles)"
            book.value("None", f"model.set_pose(pose.with_targets({moved}))\nmodel.solve()")
            book.value("None", "model.save_pose()")
        dragged(hand, 1.0)
        proved = "all(s.status == 'proved' for s in editor.timeline.animation.spans)"
        book.wait_for(f"not model.dragged and editor.timeline.animation.wait(0.1) and {proved}", 60)
        book.page.locator(".glid-computing").wait_for(state="detached")

    return pictured(browser, server, "gecko", use)


PICTURES: dict[str, Callable[[Browser, JupyterServer], bytes]] = {
    "editor-trace": trace_tab,
    "editor-deform": deform_tab,
    "editor-dark": deform_tab_dark,
}


def pictured(
    browser: Browser,
    server: JupyterServer,
    sample: str,
    use: Callable[[LabNotebook], None],
    plots: bool = False,
) -> bytes:
    """A PNG of the editor with a bundled sample, after ``use`` acted on it."""
    settings = {"viewport": {"width": 1360, "height": 860}, "device_scale_factor": DENSITY}
    with watched_page(browser, **settings) as page:
        book = LabNotebook(page, server, [CELL.format(sample=sample, plots=plots)])
        try:
            editor = page.locator(".glid-editor")
            editor.wait_for()
            book.wait_for("editor.deformation.solve(0.01)", 120)
            # Hide the cell's code, which would fill a third of the picture.
            page.evaluate("document.querySelector('.jp-Cell-inputWrapper').style.display = 'none'")
            use(book)
            book.wait_for("editor.monitor.refresh(0.01)", 30)
            page.wait_for_load_state("networkidle")
            return editor.screenshot()
        finally:
            page.mouse.up()
            book.shut_down()


def posed(book: LabNotebook, sample: str, pad: int = 0) -> Hand:
    """A hand on the canvas, with a bundled pose's handles at rest."""
    path = glid_nb.samples.pose_path(sample, "extreme")
    load = f"pose = glid.io.load_pose({str(path)!r})"
    book.value("None", f"{load}\nmodel.set_pose(pose)\ncanvas.fit()")
    book.value("None", "model.set_pose(pose.with_targets(pose.handles))")
    return Hand(book, pad)


def dragged(hand: Hand, share: float) -> None:
    """Move all handles by ``share`` of the way to the pose; the hand drags the last one there."""
    setup = (
        f"to = pose.handles + {share} * (pose.targets - pose.handles)\nto[-1] = pose.handles[-1]"
    )
    hand.book.value("None", f"{setup}\nmodel.set_pose(pose.with_targets(to))")
    hand.settle()
    start, end = hand.book.value("[pose.handles[-1].tolist(), pose.targets[-1].tolist()]")
    stop = [s + share * (e - s) for s, e in zip(start, end, strict=True)]
    places = hand.places(line(start, stop, 20))
    hand.page.mouse.move(*places[0])
    hand.page.mouse.down()
    for place in places[1:]:
        hand.page.mouse.move(*place)
        hand.page.wait_for_timeout(1000 / 60)
    hand.book.wait_for(f"abs(model.pose.targets[-1] - {stop}).max() < 0.1", 300)
    hand.settle()
    hand.page.mouse.up()  # until then the page's own solver leads
    hand.book.wait_for("not model.dragged")
    hand.settle()
    hand.wait_until_drawn()
    # Made at rest: the numbers of the pins.
    hand.page.locator(".glid-side .glid-entry[aria-selected=true]").wait_for()


def small(png: bytes) -> bytes:
    """The same picture with 256 colours, including rare ones."""
    image = Image.open(io.BytesIO(png)).convert("RGB")
    method, dither = Image.Quantize.MAXCOVERAGE, Image.Dither.NONE
    quantised = image.quantize(256, method=method, kmeans=1, dither=dither)
    buffer = io.BytesIO()
    quantised.save(buffer, format="PNG", optimize=True)
    return buffer.getvalue()


if __name__ == "__main__":
    main()
