"""Running one method and keeping what figures and tables need of it.

Every method is run twice or more. The first run is watched, and its iterates are kept; the times
that count are those of the last, which nothing looks at and which finds its programs compiled and
in memory.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb.energies import Energy
from glid_nb.geometry import Triangulation, triangulate
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods import MeshMap, MethodProgress, MethodResult, run_method
from studies.comparisons.cases import Case

Array = NDArray[Any]

VISIBLE = 0.04
"""World units: one pixel of a picture whose longer side, 20 units, is 500 pixels."""
NEAR = 0.01
"""An energy this close to its minimum, relatively, is near it."""
CRITERIA = ("map", "energy", "rest")
"""When a method is there: its map is visibly at the minimum; its energy is near the minimum; no
iteration moves it visibly any more."""

P2P_WEIGHT = 1e5
"""``lambda`` throughout."""
LIGHT_WEIGHT = 20.0
"""``lambda`` of the published code, whose 1e5 is for a sum over 10^4 samples, without a half."""
MESH_VERTICES = 10_000
_DISPLAY_VERTICES = 1_500
_ALL_KEPT, _APART = 128, 1.01


class Watcher:
    """A callback that keeps the images of points: the first 128 iterates, then ones 1 % apart.

    It stops a method whose own steps have taken ``seconds`` together.
    """

    def __init__(self, points: Array, seconds: float = math.inf) -> None:
        self.points, self.seconds = points, seconds
        self.images: dict[int, Array] = {}
        self.moved: list[float] = []
        """Largest distance of a point from where the iterate before had it."""
        self._last: Array | None = None
        self._taken = 0.0

    def __call__(self, progress: MethodProgress) -> bool:
        map_, step = progress.map, progress.history[-1]
        images = map_.images if isinstance(map_, MeshMap) else map_(self.points)
        self.moved.append(apart(images, images if self._last is None else self._last))
        self._last = images
        if step.iteration < _ALL_KEPT or step.iteration >= _APART * max(self.images):
            self.images[step.iteration] = images
        self._taken += step.time
        return self._taken > self.seconds

    def distance(self, goal: Array) -> dict[int, float]:
        """How far the kept iterates are from a goal, images of the same points."""
        return {iteration: apart(images, goal) for iteration, images in self.images.items()}


def apart(images: Array, others: Array) -> float:
    """Largest distance between corresponding points, world units."""
    return float(np.linalg.norm(images - others, axis=1).max())


def display_mesh(case: Case, count: int = _DISPLAY_VERTICES) -> Triangulation:
    """The mesh on which a harmonic map is drawn."""
    return triangulate(case.problem.domain.cage, count, points=case.problem.pose.handles)


def run(method: str, case: Case, energy: Energy | None = None, **settings: Any) -> MethodResult:
    """One run, started at the identity unless ``align`` is set."""
    arguments = (method, case.problem.domain, case.problem.pose, energy)
    return run_method(*arguments, **{"align": False, "p2p_weight": P2P_WEIGHT, **settings})


def last_of(
    runs: int, method: str, case: Case, energy: Energy | None = None, **settings: Any
) -> MethodResult:
    """The last of so many runs, none of which is watched."""
    result = run(method, case, energy, **settings)
    for _ in range(runs - 1):
        result = run(method, case, energy, **settings)
    return result


def outcome(result: MethodResult) -> dict[str, Any]:
    """History and ending as plain values."""
    certificate = result.certificate if isinstance(result.map, HarmonicMap) else None
    flips = [step.flips for step in result.history if step.flips is not None]
    return {
        "status": result.status.value,
        "message": result.message,
        "iterations": result.iterations,
        "energy": [step.energy for step in result.history],
        "step": [step.step for step in result.history],
        "step_time": [step.time for step in result.history],
        "time": np.cumsum([step.time for step in result.history]).tolist(),
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
    """For each of :data:`CRITERIA` the iteration from which on it holds, or ``None``.

    Parameters
    ----------
    distance : dict
        Largest distance from the map of the minimum at some iterations.
    moved, energy : lists
        Of each iterate: largest distance from the iterate before, and energy.
    least : float
        The energy of the minimum.
    converged : bool
        Whether the method ended by itself, so that no movement comes after the last.
    """
    near = {i: e <= (1 + NEAR) * least for i, e in enumerate(energy)}
    visible = np.flatnonzero(np.array(moved) > VISIBLE)
    rest = int(visible[-1]) if visible.size else 0
    return {
        "map": _first_lasting({i: d <= VISIBLE for i, d in distance.items()}),
        "energy": _first_lasting(near),
        "rest": rest if converged or rest < len(moved) - 1 else None,
    }


def _first_lasting(holds: dict[int, bool]) -> int | None:
    """The first key from which on all values are true."""
    last = max((i for i, so in holds.items() if not so), default=-1)
    return min((i for i in holds if i > last), default=None)


def thumbnails(images: dict[int, Array], count: int) -> tuple[list[int], Array]:
    """A few iterations up to the last, the first ones closer together, and their images."""
    left = sorted(images)[1:] or sorted(images)
    chosen = []
    for wanted in left[-1] * np.linspace(0, 1, count + 1)[:0:-1] ** 2:
        if left:
            nearest = min(left, key=lambda i, w=wanted: (abs(i - w), -i))
            chosen.append(nearest)
            left = [i for i in left if i < nearest]
    chosen.reverse()
    return chosen, np.stack([images[i] for i in chosen])
