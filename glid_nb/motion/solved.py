"""Maps between keyframes that are solved for: handles follow a motion, the rest finds its place."""

import bisect
import itertools
from collections.abc import Callable, Sequence

from glid_nb._arrays import Array
from glid_nb.certificate import certificate_of
from glid_nb.geometry import triangulate
from glid_nb.harmonic import HarmonicMap
from glid_nb.motion.bounded import Bounded, Coefficients
from glid_nb.solvers import Options, Pose, solve

_STAGES = 5  # of an interval
_POINTS = 40


def through_solved(
    maps: Sequence[HarmonicMap],
    times: Sequence[float],
    turns: Sequence[int],
    handles: Array | None,
    closed: bool,
) -> Callable[[int, float], Coefficients]:
    """The bounded interpolation through keyframes and what is solved for on the way.

    Handles follow the bounded motion, along which parts turn as rigid bodies do. Each solve starts
    from its map, or where that is not certified from what the solve before has found.
    """
    domain, follow = maps[0].domain, Bounded.through(maps, times, turns, closed)
    points = triangulate(domain.cage, _POINTS).vertices if handles is None else handles
    options = Options(align=False, restarts=0)
    all_maps, all_times = [maps[0]], [times[0]]
    for i, (start, end) in enumerate(itertools.pairwise(times)):
        count = _STAGES * (1 + abs(turns[i]))
        for j in range(1, count):
            map = HarmonicMap(domain, *follow(i, j / count))
            first = map if certificate_of(map).certified else all_maps[-1]
            found = solve(domain, Pose(points, map(points)), options=options, start=first).map
            all_maps.append(found if isinstance(found, HarmonicMap) else first)
            all_times.append(start + (end - start) * j / count)
        all_maps.append(maps[i + 1])
        all_times.append(end)
    curve = Bounded.through(all_maps, all_times, [0] * (len(all_maps) - 1), closed)

    def between(piece: int, s: float) -> Coefficients:
        time = times[piece] + s * (times[piece + 1] - times[piece])
        i = min(bisect.bisect_right(all_times, time), len(all_times) - 1) - 1
        return curve(i, (time - all_times[i]) / (all_times[i + 1] - all_times[i]))

    return between
