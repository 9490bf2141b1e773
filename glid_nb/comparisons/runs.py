"""Running one method and keeping what figures and tables need of it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb.compare import MeshMap, MethodProgress, MethodResult, run_method
from glid_nb.comparisons.cases import Case
from glid_nb.energies import Energy
from glid_nb.geometry import Triangulation, triangulate
from glid_nb.harmonic import HarmonicMap

Array = NDArray[Any]

VISIBLE = 0.04
"""World units: one pixel of a picture whose longer side, 20 units, is 500 pixels."""

MESH_VERTICES = 10_000
_DISPLAY_VERTICES = 1_500
_THUMBNAILS = 4
_WARM = 3  # runs of a method that takes a fraction of a second; the last one counts


class Recorder:
    """A callback that keeps every iterate's images of the display points.

    It stops a method whose steps have taken ``seconds`` together.
    """

    def __init__(self, points: Array, seconds: float = math.inf) -> None:
        self.points, self.seconds = points, seconds
        self.images: list[Array] = []

    def __call__(self, progress: MethodProgress) -> bool:
        map_ = progress.map
        self.images.append(map_.images if isinstance(map_, MeshMap) else map_(self.points))
        return sum(step.time for step in progress.history) > self.seconds


def display_mesh(case: Case, count: int = _DISPLAY_VERTICES) -> Triangulation:
    """The mesh on which a harmonic map is drawn."""
    return triangulate(case.problem.domain.cage, count, points=case.problem.pose.handles)


def run_recorded(
    method: str,
    case: Case,
    display: Triangulation,
    mesh: Triangulation,
    energy: Energy | None = None,
    *,
    iterates: bool = True,
    seconds: float = math.inf,
    **settings: Any,
) -> tuple[MethodResult, list[Array]]:
    """The result, and its iterates on a mesh; without ``iterates`` only the last one.

    A method whose iterates are kept is stopped after so many ``seconds`` of its own.
    Newton's method is timed without a callback, for with one the host looks at every iteration,
    which costs time, and once its programs are compiled and in memory.
    """
    recorder = Recorder(display.vertices, seconds)
    arguments = (method, case.problem.domain, case.problem.pose, energy)
    common: dict[str, Any] = {"align": False, "triangulation": mesh, **settings}
    if iterates:
        result = run_method(*arguments, callback=recorder, **common)
    quick = method in ("newton", "newton-paper")
    if not iterates or quick:
        for _ in range(_WARM if quick else 1):
            result = run_method(*arguments, **common)
    if not iterates:
        map_ = result.map
        last = map_.images if isinstance(map_, MeshMap) else map_(display.vertices)
        return result, [last]
    return result, recorder.images


def summary(result: MethodResult, images: list[Array]) -> dict[str, Any]:
    """History, visual convergence and outcome as plain values.

    ``visible`` is the first iteration from which on no display point is further than
    :data:`VISIBLE` from where it ends.
    """
    last = images[-1]
    distance = [float(np.linalg.norm(w - last, axis=1).max()) for w in images]
    apart = np.flatnonzero(np.array(distance) > VISIBLE)
    visible = int(apart[-1]) + 1 if apart.size else 0
    if len(images) == 1:
        visible = result.iterations
    times = np.cumsum([step.time for step in result.history])
    certificate = result.certificate if isinstance(result.map, HarmonicMap) else None
    return {
        "status": result.status.value,
        "message": result.message,
        "iterations": result.iterations,
        "energy": [step.energy for step in result.history],
        "energy_iso": [step.energy_iso for step in result.history],
        "step_time": [step.time for step in result.history],
        "time": times.tolist(),
        "flips": result.flips,
        "distance": distance,
        "visible": visible,
        "visible_time": float(times[min(visible, len(times) - 1)]),
        "certified": certificate.certified if certificate else None,
        "bounds": [certificate.k_upper, certificate.sigma1_upper, certificate.sigma2_lower]
        if certificate
        else None,
    }


def thumbnails(images: list[Array], visible: int) -> tuple[list[int], Array]:
    """A few iterations spread over the way to visual convergence, and the images there."""
    end = min(max(visible, 1), len(images) - 1)
    share = np.linspace(0, 1, _THUMBNAILS)[1:] ** 2
    chosen = sorted({max(1, round(s * end)) for s in share} & set(range(len(images))))
    chosen = chosen or [len(images) - 1]
    return chosen, np.stack([images[i] for i in chosen]).astype(np.float32)
