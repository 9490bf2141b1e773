"""A drag of ten seconds in the exported page, recorded in Chromium: every map, and every frame.

The mouse presses the pin. The page itself makes the moves, because Playwright's wait for frames.
"""

import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from glid_nb import samples
from glid_nb.export import live_page_html
from studies.cases import Case
from studies.live.timings import POSITIONS, circled
from studies.store import Measurement
from studies.study import Plan, Study, Task
from studies.tables import Row, digits
from tests.support.browser import launched_chromium, watched_page

SECONDS = 10.0
RATE = 60  # moves of the pointer per second, at most
RUNS = (("desktop", 1366, 768, 1), ("phone", 390, 844, 4))
"""Names, window sizes, and how many times slower page and worker are."""
SETTLED = "() => document.documentElement.dataset.settled === 'true'"


def measure(case: Case, run: tuple[str, int, int, int], seconds: float) -> Measurement:
    """Drag the last pin on a circle."""
    name, width, height, slowness = run
    domain, pose = case.problem.domain, case.problem.pose
    image = samples.image(case.name.rpartition("-")[0])
    html = live_page_html(image, domain, pose.with_targets(pose.handles))
    script = Path(__file__).with_suffix(".js").read_text(encoding="utf-8")
    path = circled(pose, domain.cage.longer_side, POSITIONS)[:, -1]
    with tempfile.TemporaryDirectory() as folder, launched_chromium() as browser:
        file = Path(folder, "page.html")
        file.write_text(html, encoding="utf-8")
        size: Any = {"width": width, "height": height}
        with watched_page(
            browser, f"window.slowness = {slowness};\n{script}", viewport=size
        ) as page:
            throttle = page.context.new_cdp_session(page)
            throttle.send("Emulation.setCPUThrottlingRate", {"rate": slowness})
            began = time.perf_counter()
            page.goto(file.as_uri())
            page.wait_for_selector("html[data-ready=true]", state="attached")
            ready = time.perf_counter() - began
            page.wait_for_function(SETTLED)
            places = [
                page.evaluate("(at) => window.glidPage.view.toScreen(at)", point.tolist())
                for point in path
            ]
            page.mouse.move(*places[0])
            page.mouse.down()
            drag = {"places": places, "seconds": seconds, "rate": RATE}
            record = page.evaluate("(drag) => window.recorded(drag)", drag)
            page.mouse.up()
            page.wait_for_function(SETTLED)
    start, stop = record["start"], record["stop"]
    maps = [one for one in record["maps"] if start <= one["at"] <= stop]
    return {
        "name": f"{case.name.rpartition('-')[0]}, {name}",
        "ready": ready,
        "seconds": (stop - start) / 1e3,
        "moves": record["moves"],
        "maps": len(maps),
        "uncertified": sum(not one["certified"] for one in maps),
        "refused": sum(one["outcome"] == "refused" for one in maps),
        "steps": sum(one["steps"] for one in maps),
        "gap": float(np.diff([start, *(one["at"] for one in maps), stop]).max()),
        "frames": len({round(at) for at in record["frames"] if start <= at <= stop}),
    }


def tasks(plan: Plan) -> list[Task]:
    """Two shapes, one with a hole, in each window."""
    seconds = 2.0 if plan.quick else SECONDS

    def task(case: Case, run: tuple[str, int, int, int]) -> Task:
        name = f"{case.name}-{run[0]}"
        return Task(name, f"{case.digest} {run} {seconds}", lambda: measure(case, run, seconds))

    cases = [plan.case(f"{name}-gentle") for name in ("gecko", "teapot")]
    return [task(case, run) for case in cases for run in RUNS]


def tables(found: list[Measurement]) -> dict[str, list[Row]]:
    """One row for each recorded drag."""
    return {"recorded": [row(one) for one in found]}


def row(data: Measurement) -> Row:
    """What was recorded, per second."""
    seconds = data["seconds"]
    return {
        "shape, window": data["name"],
        "open to ready, s": digits(data["ready"], 2),
        "moves / s": digits(data["moves"] / seconds, 2),
        "maps": data["maps"],
        "not certified": data["uncertified"],
        "refused steps": data["refused"],
        "maps / s": digits(data["maps"] / seconds, 2),
        "steps / s": digits(data["steps"] / seconds, 2),
        "longest wait for a map, ms": digits(data["gap"], 2),
        "frames / s": digits(data["frames"] / seconds, 2),
    }


STUDY = Study("recorded", tasks, tables)
