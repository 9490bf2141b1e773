"""The editor's latency for a user: from the pointer to the drawn frame of the page, in Chromium.

    python -m studies.editor.editor_browser [SAMPLE or PROBLEM.json] [--moves N] [--vertices N ...]
        [--delays MS ...] [--only-drag]

Run it from the repository's root; it needs the extra `test` and Chromium. In JupyterLab it measures

- the time from running the cell ``Editor(image)`` to the first drawn canvas, and from there until
  the map follows the drag of a pin that is set at once, with an empty and with a filled cache of
  compiled programs (bundled samples only; medians of 5);
- a handle dragged with 60 moves a second, the plots beside the canvas: from each pointer event to
  the first drawn frame that was solved for it or for a later one, with the map evaluated in the
  vertex shader, in the page's script and in the kernel, at each number of display vertices; without
  and with the page's own solver, which goes ahead of the kernel; and with each delay of what the
  kernel sends, as on a network.

The kernel records each frame's target, the page the time when the frame was drawn. The frame's
numbers identify it in both records. Of the page's own maps the page knows the target.
"""

import argparse
import os
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from playwright.sync_api import Browser

from glid_nb import samples
from glid_nb.io import load_pose
from studies.editor.frame_log import N_SAMPLES
from studies.machine import machine
from tests.support.browser import JupyterServer, LabNotebook, launched_chromium, watched_page
from tests.widgets.editor_page import MANAGER, Hand

RATE = 60
"""Moves of the pointer per second."""

# Compiled programs are kept in the folder of this variable.
IMPORTS = """
import os
os.environ["GLID_NB_CACHE"] = {cache!r}
import glid_nb as glid
"""
IMAGE = "image = glid.samples.image({shape!r})"
EDITOR = """
import time
editor, followed = glid.Editor(image), []
def note(what):
    pose = editor.pose
    if what == "frame" and abs(pose.targets - pose.handles).max(initial=0) > 0.5:
        if abs(pose.targets - editor.map(pose.handles)).max() < 0.2:
            followed.append(1e3 * time.time())
editor.deformation.observe(note)
editor
"""

CANVAS = """
glid.enable_compilation_cache()
import ipywidgets
from studies.editor.frame_log import FrameLog, load
image, domain, pose = load({shape!r})
canvas = glid.widgets.DeformCanvas(
    image, domain, n_vertices={vertices}, evaluated_in={evaluated_in!r}
)
if not {ahead}:
    canvas._page_solver.follow = lambda moment: None
model = canvas.deformation
model.set_pose(pose.with_targets(pose.handles))
monitor = glid.widgets.SolverMonitor(model)
log = FrameLog(canvas)
ipywidgets.HBox([canvas, monitor])
"""

WATCH = f"""async ([identity, trait, count, widgets]) => {{
  const manager = await ({MANAGER})();
  window.glid.watch(await manager.get_model(identity), trait, count, widgets);
}}"""


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("shape", nargs="?", default="gecko")
    parser.add_argument("--moves", type=int, default=240)
    parser.add_argument("--vertices", type=int, nargs="+", default=[10_000])
    parser.add_argument("--delays", type=int, nargs="+", default=[0, 50, 150, 300])
    parser.add_argument("--only-drag", action="store_true")
    chosen = parser.parse_args()
    shape = str(Path(chosen.shape).resolve()) if chosen.shape.endswith(".json") else chosen.shape
    print(chosen.shape, *machine().values())
    # An installed package has bytecode. Without bytecode, each kernel compiles every module.
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    with tempfile.TemporaryDirectory() as folder, launched_chromium() as browser:
        print(f"Chromium {browser.version}, {RATE} moves a second wanted, plots on")
        server = JupyterServer(Path(folder) / "jupyter")
        cache = str(Path(folder) / "cache")
        try:
            if shape in samples.names() and not chosen.only_drag:
                empty = [f"{cache}{i}" for i in range(5)]
                for state, caches in {"empty": empty, "filled": empty[:1] * 5}.items():
                    rows = [first_use(browser, server, shape, one) for one in caches]
                    first, drag = np.median(rows, axis=0)
                    print(f"{state} cache: canvas after {first:.1f} s, drag {drag:.1f} s later")
            print(*(f"{name:>12}" for name in COLUMNS))
            for vertices, (where, ahead, delay) in product(chosen.vertices, rows_of(chosen.delays)):
                setup = IMPORTS.format(cache=cache) + CANVAS.format(
                    shape=shape, vertices=vertices, evaluated_in=where, ahead=ahead
                )
                numbers = dragged(browser, server, setup, chosen.moves, ahead, delay)
                first = f"{vertices:12,} {where:>12} {'page' if ahead else 'kernel':>12} {delay:12}"
                print(first, *(f"{number:12,.1f}" for number in numbers), flush=True)
        finally:
            server.close()


COLUMNS = (
    "vertices", "map in", "solved in", "delay",
    "latency", "95 %", "solving", "95 %", "showing", "95 %",
    "frames/s", "moves/s", "canvas bytes", "all bytes",
)  # fmt: skip
"""Milliseconds; and transferred bytes per frame, of the canvas and in total."""


def first_use(browser: Browser, server: JupyterServer, shape: str, cache: str) -> list[float]:
    """Seconds from running ``Editor(image)`` to its first drawn canvas, and to a followed drag."""
    ends = load_pose(samples.pose_path(shape, "gentle")).handles[[0, -1]].tolist()
    cells = [IMPORTS.format(cache=cache) + IMAGE.format(shape=shape), "None"]
    with notebook(browser, server, cells) as book:
        page = book.page
        start = page.evaluate("code => window.glid.runCell(1, code)", EDITOR)
        page.wait_for_function("window.glid.firstFrame !== null", timeout=120_000)
        shown, origin = page.evaluate("[window.glid.firstFrame, performance.timeOrigin]")
        hand = Hand(book, canvas="editor.canvas", settle=False)
        (x, y), end = hand.places(ends)
        page.mouse.click(x, y)
        page.mouse.move(*end)
        page.mouse.down()
        for step in range(1, 13):
            page.mouse.move(end[0] + 4 * step, end[1] + 2 * step)
            page.wait_for_timeout(1000 / RATE)
        book.wait_for("followed", 180)
        page.mouse.up()
        book.wait_for("editor.deformation.solve(0.01)", 180)  # the cache is complete
        drag = book.value("followed[0]") - origin - shown
        return [(shown - start) / 1e3, drag / 1e3]


def rows_of(delays: list[int]) -> list[tuple[str, bool, int]]:
    """Where the map is evaluated, whether the page's solver goes ahead, and the delay in ms."""
    first = [(where, ahead, 0) for ahead in (False, True) for where in ("shader", "page")]
    late = [("page", ahead, delay) for delay in delays if delay for ahead in (False, True)]
    return [*first, ("kernel", False, 0), *late]


def dragged(
    browser: Browser,
    server: JupyterServer,
    setup: str,
    n_moves: int,
    ahead: bool = False,
    delay: int = 0,
) -> list[float]:
    """Drag the last handle on a spiral, once to warm up and once for the measurement.

    Returns the numbers of :data:`COLUMNS`. The latency is the time from a pointer event until a
    frame solved for it or for a later event was drawn. Latency, solves and the kernel's other work
    for a frame have a median and a 95th percentile. Then come rates and bytes.
    """
    with notebook(browser, server, [setup]) as book:
        hand = Hand(book)
        identity, trait, widgets = book.value("[*log.source, log.widgets]")
        if ahead:
            book.page.wait_for_function("window.glid.solvers > 0")
        else:
            book.page.evaluate(WATCH, [identity, trait, N_SAMPLES, widgets])
        book.page.evaluate("delay => { window.glid.delay = delay; }", delay)
        for count in (n_moves // 4, n_moves):
            hand.settle()
            book.page.evaluate("window.glid.clear()")
            book.value("None", setup="log.clear()")
            start, seconds = spiral(hand, count)
            book.wait_for("not model.dragged", 60)
            hand.settle()
            if not ahead:
                last = book.value("log.frames[-1]['sample']")
                drawn_last = "last => window.glid.drawn(last)"
                book.page.wait_for_function(drawn_last, arg=last, timeout=60_000)
        seen = book.page.evaluate("window.glid.seen()")
        known = book.value("[log.frames, log.solving, log.showing]")
        unit = book.value("canvas.pane.stage.view[2]")
    moves = np.array(seen["moves"])
    targets = start + unit * (moves[:, 1:] - seen["press"]) * [1, -1]
    latencies, drawn = joined(moves[:, 0], targets, seen["frames"], known[0])
    return [
        *np.percentile(latencies, [50, 95]),
        *(1e3 * np.percentile(known[1], [50, 95])),
        *(1e3 * np.percentile(known[2], [50, 95])),
        drawn / seconds,
        len(moves) / seconds,
        seen["canvasBytes"] / drawn,
        seen["bytes"] / drawn,
    ]


def spiral(hand: Hand, count: int) -> tuple[np.ndarray, float]:
    """Drag the last handle; returns its target before the drag, and the seconds of the drag."""
    start = np.array(hand.targets[-1])
    side = hand.book.value("float(canvas.deformation.state.domain.cage.longer_side)")
    turns = np.arange(1, count + 1) / RATE
    # On a spiral, all targets differ.
    radius = 0.08 * side * (0.5 + 0.5 * turns / turns[-1])
    angles = 2 * np.pi * turns
    points = start + radius[:, None] * np.stack([np.cos(angles) - 0.5, np.sin(angles)], axis=1)
    places = hand.places(np.vstack([start, points]).tolist())
    mouse = hand.page.mouse
    mouse.move(*places[0])
    mouse.down()
    began = time.perf_counter()
    for k, place in enumerate(places[1:]):
        ahead = began + k / RATE - time.perf_counter()
        if ahead > 0:
            hand.page.wait_for_timeout(1e3 * ahead)
        mouse.move(*place)
    seconds = time.perf_counter() - began
    mouse.up()
    return start, seconds


def joined(
    times: np.ndarray, targets: np.ndarray, drawn: list[Any], known: list[dict[str, Any]]
) -> tuple[np.ndarray, int]:
    """Milliseconds from each move to its frame, and the number of drawn frames.

    ``times`` and ``targets`` belong to the pointer's moves. ``drawn`` holds times and samples of
    the frames in the page, or their targets if the page solved them; ``known`` samples and targets
    of the frames in the kernel.
    """
    solved_for = {tuple(frame["sample"]): frame["targets"][-1] for frame in known}
    latest = -1  # the last move that a frame has shown
    waits: list[float] = []
    for time_drawn, sample in drawn:
        target = sample if len(sample) == 2 else solved_for.get(tuple(sample))
        if target is None:  # a frame from before the drag
            continue
        gaps = np.linalg.norm(targets - target, axis=1)
        move = int(np.argmin(gaps))
        if gaps[move] > 1e-4:
            continue
        waits += [time_drawn - t for t in times[latest + 1 : move + 1]]
        latest = max(latest, move)
    if latest < len(times) - 1:
        raise RuntimeError(f"no frame was drawn for the last of {len(times)} moves")
    return np.array(waits), len(drawn)


@contextmanager
def notebook(browser: Browser, server: JupyterServer, cells: list[str]) -> Iterator[LabNotebook]:
    """A notebook in a page that records events; its kernel is shut down at the end."""
    script = Path(__file__).with_suffix(".js").read_text(encoding="utf-8")
    with watched_page(browser, script) as page:
        book = LabNotebook(page, server, cells)
        try:
            yield book
        finally:
            book.shut_down()


if __name__ == "__main__":
    main()
