"""Maps between two keyframes that are solved for, with handles that move on rigid paths."""

from __future__ import annotations

import numpy as np

from glid_nb._arrays import Array
from glid_nb.certificate import certificate_of
from glid_nb.geometry import triangulate
from glid_nb.harmonic import HarmonicMap
from glid_nb.solvers import Options, Pose, solve
from glid_nb.solvers.turning import turning_of

_LEAST_STAGES = 4
_POINTS = 40


def solved_on_the_way(
    first: HarmonicMap, last: HarmonicMap, handles: Array | None = None
) -> list[HarmonicMap]:
    """Certified maps at even times between two maps, and the last one.

    Solves go from both ends, each from the one before, and are blended; where a blend is not
    certified, the nearer one of the two stands.
    """
    points = _even_points(first) if handles is None else np.asarray(handles)
    paths = turning_of(Pose(first(points), last(points)), first.domain.cage, points)
    stages = paths.stages((), _LEAST_STAGES)
    poses = [Pose(points, stage.targets) for stage in stages]
    forth, back = _chain(first, poses), _chain(last, poses[::-1])[::-1]
    blends = []
    for i, (a, b) in enumerate(zip(forth, back, strict=True), start=1):
        s = i / (len(poses) + 1)
        blend = HarmonicMap(first.domain, a.phi + s * (b.phi - a.phi), a.psi + s * (b.psi - a.psi))
        blends.append(blend if certificate_of(blend).certified else (a if s <= 0.5 else b))
    return [*blends, last]


def _chain(start: HarmonicMap, poses: list[Pose]) -> list[HarmonicMap]:
    maps, at = [], start
    for pose in poses:
        result = solve(start.domain, pose, options=Options(align=False, restarts=0), start=at)
        at = result
        maps.append(result.map)
    return maps


def _even_points(map: HarmonicMap) -> Array:
    return triangulate(map.domain.cage, _POINTS).vertices
