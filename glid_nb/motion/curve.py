"""The smooth motion through keyframes, also through maps solved on the way, and linear pieces."""

from __future__ import annotations

import bisect
import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from glid_nb._arrays import Array
from glid_nb.certificate import certificate_of
from glid_nb.geometry import triangulate
from glid_nb.harmonic import HarmonicMap
from glid_nb.motion.boundary import boundary_of
from glid_nb.motion.bounded import Bounded, Coefficients
from glid_nb.motion.settings import EASINGS, MotionError
from glid_nb.solvers import Options, Pose, solve

_SAMPLES = 24  # of each lap of an interval, to see how it bends
_MOST_PIECES = 8192  # of an interval
_STAGES = 5  # of each lap of an interval whose maps are solved for
_POINTS = 40


class Piece(NamedTuple):
    """Between its times the coefficients, and so all images, move on straight lines."""

    start: float
    end: float
    start_map: HarmonicMap
    end_map: HarmonicMap

    def at(self, time: float) -> HarmonicMap:
        if time in (self.start, self.end):
            return self.start_map if time == self.start else self.end_map
        s = (time - self.start) / (self.end - self.start)
        return HarmonicMap(self.start_map.domain, *blended((self.start_map, self.end_map), 0, s))


def linear_pieces(times: Sequence[float], maps: Sequence[HarmonicMap]) -> tuple[Piece, ...]:
    spans = zip(itertools.pairwise(times), itertools.pairwise(maps), strict=True)
    return tuple(Piece(*times, *maps) for times, maps in spans)


@dataclass(frozen=True, eq=False)
class Curve:
    """A motion before it is cut into linear pieces."""

    maps: tuple[HarmonicMap, ...]
    times: tuple[float, ...]
    easing: tuple[str, ...]
    between: Callable[[int, float], Coefficients]
    """Coefficients between keyframe i and the next, by the eased time in [0, 1]."""
    laps: tuple[int, ...]  # of each interval, see `Bounded.laps`
    known: dict[float, HarmonicMap] = field(default_factory=dict)

    def map(self, time: float) -> HarmonicMap:
        """The map at a time; at a keyframe's, that keyframe."""
        if time in self.times:
            return self.maps[self.times.index(time)]
        if time not in self.known:
            i = bisect.bisect_right(self.times, time) - 1
            s = (time - self.times[i]) / (self.times[i + 1] - self.times[i])
            coefficients = self.between(i, EASINGS[self.easing[i]](s))
            self.known[time] = HarmonicMap(self.maps[0].domain, *coefficients)
        return self.known[time]

    def breaks(self, interval: int, tolerance: float, finer: int = 1) -> list[float]:
        """Times from a keyframe to the next between which images move straight up to a distance.

        A piece of length h is off by ``h^2 / 8`` times the second derivative, so pieces are as
        short as the square root of that is large; each is divided into ``finer`` ones.
        """
        start, end = self.times[interval : interval + 2]
        samples = np.linspace(start, end, _SAMPLES * self.laps[interval] + 1)
        maps, boundary = map(self.map, samples.tolist()), boundary_of(self.maps[0].domain)
        images = np.stack([boundary.images(at.phi, at.psi) for at in maps])
        bend = np.abs(np.diff(images, 2, axis=0)).max(axis=1)
        needed = np.sqrt(np.concatenate([bend[:1], bend, bend[-1:]]) / (8 * tolerance))
        along = np.append(0, np.cumsum((needed[1:] + needed[:-1]) / 2))
        if along[-1] > _MOST_PIECES:
            raise MotionError(
                f"from {start:g} to {end:g} s the motion bends so much that the tolerance needs "
                f"{along[-1]:,.0f} straight pieces; {_MOST_PIECES:,} is the most. Choose a larger "
                "tolerance or fewer turns, or put keyframes between"
            )
        count = min(finer * int(np.ceil(max(along[-1], 1))), _MOST_PIECES)
        inside = np.interp(np.arange(1, count) / count * along[-1], along, samples)
        return np.unique([start, *inside, end]).tolist()


def blended(maps: Sequence[HarmonicMap], piece: int, s: float) -> Coefficients:
    """Coefficients on the straight line from a map to the next."""
    a, b = maps[piece], maps[piece + 1]
    return a.phi + s * (b.phi - a.phi), a.psi + s * (b.psi - a.psi)


def through_solved(
    follow: Bounded, handles: Array | None, closed: bool
) -> Callable[[int, float], Coefficients]:
    """Bounded interpolation through keyframes and solves on the way, whose handles ``follow``."""
    maps, times, domain = follow.maps, follow.times, follow.boundary.domain
    points = triangulate(domain.cage, _POINTS).vertices if handles is None else handles
    options = Options(align=False, restarts=0)
    all_maps, all_times = [maps[0]], [times[0]]
    for i, (start, end) in enumerate(itertools.pairwise(times)):
        count = _STAGES * follow.laps(i)
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
