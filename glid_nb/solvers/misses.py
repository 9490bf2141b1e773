"""How far handles are from their targets, and which conflict between targets may be the cause."""

import itertools
from typing import Any

import numpy as np
from scipy.spatial import Delaunay, QhullError

from glid_nb._arrays import Array, frozen
from glid_nb.geometry import MeshMap
from glid_nb.harmonic import HarmonicMap, as_complex
from glid_nb.pose import HANDLES, Naming, Pose

NOTABLE = 0.01  # in twentieths of the cage's longer side; a smaller distance is not visible
# A similarity explains the targets if its residual is below two limits.
# _FITS: the first limit, as a share of the targets' spread.
# _BETTER: the second limit, as a share of the residual of the targets in their given order.
_FITS, _BETTER = 0.1, 0.1
# Two targets count as one place if their distance is below this share of their handles' distance.
# The same holds with handles and targets exchanged.
_TOGETHER = 1e-3
_MOST = 12  # handles that are compared in pairs: the worst one and others that miss


def misses_of(map: HarmonicMap | MeshMap, pose: Pose) -> Array:
    """(h,) distances of the handles' images from their targets, world units."""
    if not len(pose):
        return frozen(np.zeros(0))
    return frozen(np.linalg.norm(map(pose.handles) - pose.targets, axis=1))


def unit_of(map: HarmonicMap | MeshMap) -> float:
    """The unit of a map's cage. A mesh has no cage: its unit is 1/20 of its longer side."""
    if isinstance(map, HarmonicMap):
        return map.domain.cage.unit
    return float(np.ptp(map.triangulation.vertices, axis=0).max()) / 20


def told(pose: Pose, misses: Array, unit: float, named: Naming = HANDLES) -> str:
    """The largest miss and its likely cause, as part of a sentence; empty if no miss is notable.

    ``misses`` are (h,) distances, ``unit`` is that of the cage.
    ``named`` gives the handles their names.
    """
    if not len(misses) or not misses.max() > NOTABLE * unit:
        return ""
    worst = int(misses.argmax())
    text = f"{named(worst)} is {misses[worst]:.2g} units from its target"
    why = conflict(pose, misses > NOTABLE * unit, worst, named)
    return f"{text}: {why}" if why else text


def conflict(pose: Pose, missing: Array, worst: int, named: Naming = HANDLES) -> str:
    """A conflict between targets that a map without folds can hardly satisfy; empty if none.

    ``missing`` (h,) marks the handles that miss; the handle ``worst`` misses most. A long shape
    that bends far can reach some of these targets, but then it overlaps itself.
    """
    z, w = as_complex(pose.handles), as_complex(pose.targets)
    first = np.flatnonzero(missing)
    chosen = [worst, *first[first != worst][: _MOST - 1].tolist()]
    for i, j in sorted({(min(i, j), max(i, j)) for i in chosen for j in range(len(z)) if i != j}):
        before, after = abs(z[i] - z[j]), abs(w[i] - w[j])
        if after <= _TOGETHER * before:
            return f"the targets of {named(i, j)} are the same place"
        if before <= _TOGETHER * after:
            gap = f"their targets are {after:.2g} apart"
            return f"{named(i, j)} are nearly the same place, but {gap}"
    if len(z) > 2:
        left = _left(z, w)
        if _left(z.conj(), w) < min(_FITS, _BETTER * left):
            return f"the targets mirror the {named.word}s, and maps without folds cannot mirror"
        for i, j in itertools.combinations(sorted(chosen), 2):
            swapped = w.copy()
            swapped[[i, j]] = w[[j, i]]
            if _left(z, swapped) < min(_FITS, _BETTER * left):
                return f"the targets of {named(i, j)} are swapped"
    return _turned_over(z, w, worst, named)


def _left(z: Array, w: Array) -> float:
    """The residual of the best similarity from ``z`` to ``w``, relative to the spread of ``w``."""
    z, w = z - z.mean(), w - w.mean()
    spread = np.sum(np.abs(z) ** 2) * np.sum(np.abs(w) ** 2)
    return float(1 - abs(np.vdot(z, w)) ** 2 / spread) if spread > 0 else 0.0


def _turned_over(z: Any, w: Any, worst: int, named: Naming) -> str:
    """Name a triangle of neighbouring handles, the worst among them, whose targets flip it."""
    if len(z) < 3:
        return ""
    try:
        triangles = Delaunay(np.column_stack([z.real, z.imag])).simplices
    except QhullError:  # all on one line
        return ""
    a, b, c = triangles.T
    areas = [np.imag(np.conj(x[b] - x[a]) * (x[c] - x[a])) for x in (z, w)]
    sizes = np.abs(w[b] - w[a]) * np.abs(w[c] - w[a])
    over = (areas[0] * areas[1] < 0) & (np.abs(areas[1]) > _FITS * sizes)
    over &= (triangles == worst).any(axis=1)
    if not over.any():
        return ""
    corners = sorted(triangles[over][0].tolist())
    return f"the targets turn over the triangle of {named(*corners)}"
