"""Running one method and keeping the results that figures and tables need.

Every method is run twice or more. The first run is watched, and its iterates are kept. Times are
those of the last run: nothing watches it, and its programs are compiled and in memory.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb import methods
from glid_nb.energies import Energy
from glid_nb.geometry import MeshMap, Triangulation, triangulate
from glid_nb.harmonic import HarmonicMap
from glid_nb.minima import solve
from glid_nb.solvers import Iteration, Options, Progress, Result
from studies.cases import Case

Array = NDArray[Any]

VISIBLE = 0.04
"""World units: one pixel, if the picture's longer side (20 units) has 500 pixels."""
NEAR = 0.01
"""Relative distance of an energy from its minimum that counts as near."""
CRITERIA = ("energy", "rest", "map")
"""When a method has arrived: its energy is near the minimum; no later iteration moves the map
visibly; the map is not visibly away from the minimum."""
ENDED = ("converged", "stationary")
"""The status of a run that reached its minimum."""

P2P_WEIGHT = 1e5
"""``lambda`` throughout."""
LIGHT_WEIGHT = 20.0
"""``lambda`` of the published code: its 1e5 weights a sum over 10^4 samples, without the 1/2."""
MESH_VERTICES = 10_000
_DISPLAY_VERTICES = 1_500
_DEFAULTS = {"newton-staged": {"sampling": "uniform", "certificate": "lipschitz"}}
_ALL_KEPT, _APART = 128, 1.01


class Watcher:
    """A callback that keeps the images of points: of the first 128 iterates, then in steps of 1 %.

    It stops a method when its steps have taken ``seconds`` in total.
    """

    def __init__(self, points: Array, seconds: float = math.inf) -> None:
        self.points, self.seconds = points, seconds
        self.images: dict[int, Array] = {0: points}
        self.moved = [0.0]
        """The largest movement of a point in each iteration."""
        self._last = points
        self._taken = 0.0

    def __call__(self, progress: Progress) -> bool:
        count = len(progress.history)
        if 0 < count < len(self.moved):  # only panels were split
            return False
        map_, step = progress.map, (progress.initial, *progress.history)[-1]
        images = map_.images if isinstance(map_, MeshMap) else map_(self.points)
        if count:
            self.moved.append(apart(images, self._last))
        if count < _ALL_KEPT or count >= _APART * max(self.images):
            self.images[count] = images
        self._last = images
        self._taken += step.time
        return self._taken > self.seconds

    def distance(self, goal: Array) -> dict[int, float]:
        """Distances of the kept iterates from a goal, which holds images of the same points."""
        return {iteration: apart(images, goal) for iteration, images in self.images.items()}


def apart(images: Array, others: Array) -> float:
    """Largest distance between corresponding points, world units."""
    return float(np.linalg.norm(images - others, axis=1).max())


def display_mesh(case: Case, count: int = _DISPLAY_VERTICES) -> Triangulation:
    """The mesh for drawing a harmonic map."""
    return triangulate(case.problem.domain.cage, count, points=case.problem.pose.handles)


def run(
    method: str,
    case: Case,
    energy: Energy | None = None,
    *,
    mesh: Triangulation | None = None,
    callback: Callable[[Progress], bool | None] | None = None,
    runs: int = 1,
    **settings: Any,
) -> Result:
    """The last of ``runs`` runs, started at the identity unless ``align`` is set.

    ``settings`` are settings of the method and fields of the options. Methods on a mesh work on
    ``mesh``. The callback is called after every iteration.
    """
    own = methods.METHODS[method].kinds()
    value = methods.by_name(method, **{k: v for k, v in settings.items() if k in own})
    options = {"align": False, "p2p_weight": P2P_WEIGHT, "restarts": 0, **_DEFAULTS.get(method, {})}
    options |= {k: v for k, v in settings.items() if k not in own}
    options["p2p_weight"] *= case.problem.domain.cage.unit**2  # the paper's is in world units
    if callback is not None:
        options["iterations_per_call"] = 1
    start = None if mesh is None or value.certified else MeshMap(mesh, mesh.vertices)
    arguments = (case.problem.domain, case.problem.pose, energy, Options(**options), start)
    return [solve(*arguments, callback, method=value) for _ in range(runs)][-1]


def entries(result: Result) -> tuple[Iteration, ...]:
    """The entry of the start, then one per iteration."""
    return (result.initial, *result.history)


def outcome(result: Result) -> dict[str, Any]:
    """A run's history and status as plain values."""
    certificate = result.certificate if isinstance(result.map, HarmonicMap) else None
    flips = [step.flips for step in entries(result) if step.flips is not None]
    return {
        "status": result.status.value,
        "iterations": result.iterations,
        "energy": [step.energy for step in entries(result)],
        "step_time": [step.time for step in entries(result)],
        "time": np.cumsum([step.time for step in entries(result)]).tolist(),
        "most_flips": max(flips) if flips else None,
        "certified": certificate.certified if certificate else None,
        "bounds": [certificate.k_upper, certificate.sigma1_upper, certificate.sigma2_lower]
        if certificate
        else None,
    }


def reached(
    distance: dict[int, float],
    moved: list[float],
    energy: list[float],
    least: float,
    converged: bool,
) -> dict[str, int | None]:
    """For each of :data:`CRITERIA`, the first iteration from which on it holds, or ``None``.

    ``distance`` holds, for some iterates, the largest distance from the minimum's map. ``moved``
    holds for each iterate the largest distance from the iterate before, and ``energy`` its energy;
    ``least`` is the energy of the minimum. A method that has ``converged`` moves no further.
    """
    near = {i: e <= (1 + NEAR) * least for i, e in enumerate(energy)}
    visible = np.flatnonzero(np.array(moved) > VISIBLE)
    rest = int(visible[-1]) if visible.size else 0
    return {
        "energy": _first_lasting(near),
        "rest": rest if converged or rest < len(moved) - 1 else None,
        "map": _first_lasting({i: d <= VISIBLE for i, d in distance.items()}),
    }


def _first_lasting(holds: dict[int, bool]) -> int | None:
    """The first key such that its value and all later values are true."""
    last = max((i for i, so in holds.items() if not so), default=-1)
    return min((i for i in holds if i > last), default=None)


def thumbnails(images: dict[int, Array], count: int) -> tuple[list[int], Array]:
    """Some iterations up to the last, denser at the beginning, and their images."""
    # In descending order, so that argmin takes the later one of two equally near iterations.
    kept = np.array(sorted(images)[1:] or sorted(images))[::-1]
    wanted = kept[0] * np.linspace(0, 1, count + 1)[1:] ** 2
    nearest = np.abs(kept[:, None] - wanted).argmin(axis=0)
    chosen = [int(i) for i in np.unique(kept[nearest])]
    return chosen, np.stack([images[i] for i in chosen])
