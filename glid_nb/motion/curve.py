"""The smooth motion through keyframes and maps solved on the way, and its linear pieces."""

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
from glid_nb.minima import solve
from glid_nb.motion.boundary import boundary_of
from glid_nb.motion.bounded import EXCESS, Bounded, Coefficients
from glid_nb.motion.easing import Easing, eased, sample_times
from glid_nb.motion.errors import MotionError
from glid_nb.pose import Pose
from glid_nb.solvers import Options

_SAMPLES = 24  # per lap of an interval, to measure how it bends
_MOST_PIECES = 8192  # of an interval
_STAGES = 5  # per lap of an interval with "solved"
_POINTS = 40
_SOFT = 1e-4  # weight of the handles of maps that mend a motion
_ROUNDS = 5  # most rounds of halving, to mend a motion
_PROGRESS = 0.7  # mending ends if two rounds leave a larger share of the excess

Between = Callable[[int, float], Coefficients]


class Piece(NamedTuple):
    """Between its times the coefficients move on straight lines, and so do all images."""

    start: float
    end: float
    start_map: HarmonicMap
    end_map: HarmonicMap

    def at(self, time: float) -> HarmonicMap:
        if time in (self.start, self.end):
            return self.start_map if time == self.start else self.end_map
        s = (time - self.start) / (self.end - self.start)
        return HarmonicMap(self.start_map.domain, *blend((self.start_map, self.end_map), 0, s))

    def within(self, start: float, end: float) -> "Piece":
        """What of it lies between two times."""
        start, end = max(start, self.start), min(end, self.end)
        return Piece(start, end, self.at(start), self.at(end))


def linear_pieces(times: Sequence[float], maps: Sequence[HarmonicMap]) -> tuple[Piece, ...]:
    spans = zip(itertools.pairwise(times), itertools.pairwise(maps), strict=True)
    return tuple(Piece(*times, *maps) for times, maps in spans)


@dataclass(frozen=True, eq=False)
class Curve:
    """A motion before it is cut into linear pieces."""

    maps: tuple[HarmonicMap, ...]
    times: tuple[float, ...]
    easing: tuple[Easing, ...]
    between: Between
    """Coefficients between keyframe i and the next, by the eased time in [0, 1]."""
    laps: tuple[int, ...]  # of each interval, see `Bounded.laps`
    ways: tuple[str, ...]  # likewise, see `Motion.ways`
    known: dict[float, HarmonicMap] = field(default_factory=dict)

    def map(self, time: float) -> HarmonicMap:
        """The map at a time; at a keyframe's, that keyframe."""
        if time in self.times:
            return self.maps[self.times.index(time)]
        if time not in self.known:
            i = bisect.bisect_right(self.times, time) - 1
            s = (time - self.times[i]) / (self.times[i + 1] - self.times[i])
            coefficients = self.between(i, eased(self.easing[i], s))
            self.known[time] = HarmonicMap(self.maps[0].domain, *coefficients)
        return self.known[time]

    def breaks(self, interval: int, tolerance: float) -> list[float]:
        """Times from a keyframe to the next: straight pieces between them keep to the tolerance.

        A straight piece of length h is off by ``h^2 / 8`` times the second derivative. So pieces
        are as short as the square root of the second derivative is large.
        """
        start, end = self.times[interval : interval + 2]
        easing = self.easing[interval]
        samples = sample_times(easing, start, end, _SAMPLES * self.laps[interval])
        images = self._images(samples)
        share = (np.diff(samples)[:-1] / (samples[2:] - samples[:-2]))[:, None]
        chords = images[:-2] + share * (images[2:] - images[:-2])
        off = np.abs(images[1:-1] - chords).max(axis=1)
        needed = np.sqrt(np.concatenate([off[:1], off, off[-1:]]) / (4 * tolerance))
        along = np.append(0, np.cumsum((needed[1:] + needed[:-1]) / 2))
        if along[-1] > _MOST_PIECES:
            raise _too_many(start, end, along[-1])
        count = int(np.ceil(max(along[-1], 1)))
        inside = np.interp(np.arange(count) / count * along[-1], along, samples)
        times = np.unique([start, *inside, end]).tolist()
        return times if isinstance(easing, str) else self._halved(times, tolerance)

    def _halved(self, times: list[float], tolerance: float) -> list[float]:
        """Halve the pieces that are off by more than the tolerance.

        A curve with an upright handle is so steep at its end that its samples do not show it.
        """
        kept, left = times[:1], list(itertools.pairwise(times))[::-1]
        while left:
            start, end = left.pop()
            images, middle = self._images(np.linspace(start, end, 5)), (start + end) / 2
            chord = images[0] + np.linspace(0, 1, 5)[:, None] * (images[-1] - images[0])
            if np.abs(images - chord).max() <= tolerance:
                kept.append(end)
            elif len(kept) + len(left) < _MOST_PIECES:
                left += [(middle, end), (start, middle)]
            else:
                raise _too_many(times[0], times[-1], 2 * _MOST_PIECES)
        return kept

    def _images(self, times: Array) -> Array:
        """The images of points of the boundary at these times."""
        boundary = boundary_of(self.maps[0].domain)
        return np.stack([boundary.images(at.phi, at.psi) for at in map(self.map, times.tolist())])


def _too_many(start: float, end: float, count: float) -> MotionError:
    return MotionError(
        f"from {start:g} to {end:g} s the motion bends so much that the tolerance needs "
        f"{count:,.0f} straight pieces; {_MOST_PIECES:,} is the most. Choose a larger "
        "tolerance or fewer turns, or put keyframes between"
    )


def blend(maps: Sequence[HarmonicMap], piece: int, s: float) -> Coefficients:
    """Coefficients on the straight line from a map to the next."""
    a, b = maps[piece], maps[piece + 1]
    return a.phi + s * (b.phi - a.phi), a.psi + s * (b.psi - a.psi)


def through_solved(follow: Bounded, handles: Array | None, closed: bool) -> Between:
    """Bounded interpolation through keyframes and maps solved with handles on ``follow``."""
    every = range(len(follow.turns))
    pose = Pose(*[_even_points(follow) if handles is None else handles] * 2)
    return _by_time(follow, _divided(follow, every, every, _STAGES, pose, closed)[0])


def through_mended(follow: Bounded, closed: bool) -> tuple[Between, tuple[str, ...]]:
    """Bounded interpolation, mended where it is worse than the worse keyframe.

    There it runs through a map solved halfway, and so on for each half, unless that is even worse.
    The second value names the way of each interval.
    """
    curve, points = follow, _even_points(follow)
    pose = Pose(points, points, weights=np.full(len(points), _SOFT))
    owners = every = range(len(follow.turns))
    alone = excess = [follow.excess(i).max() for i in every]
    mending, course = set(every), [alone]  # the largest excess of each interval after each round
    for _ in range(_ROUNDS):
        over = [i for i, share in enumerate(excess) if share > EXCESS and owners[i] in mending]
        if not over:
            break
        curve, owners = _divided(curve, owners, over, 2, pose, closed)
        excess = [curve.excess(i).max() for i in range(len(owners))]
        course.append([max(np.compress(np.equal(owners, i), excess)) for i in every])
        if len(course) > 2:
            mending = {i for i in mending if course[-1][i] < _PROGRESS * course[-3][i]}
    reached = course[-1]
    ways = [
        follow if reached[i] > max(alone[i], EXCESS) else _by_time(follow, curve) for i in every
    ]
    solved = [owners.count(i) > 1 and ways[i] is not follow for i in every]
    return (lambda i, s: ways[i](i, s)), tuple("solved" if s else "bounded" for s in solved)


def _even_points(curve: Bounded) -> Array:
    return triangulate(curve.boundary.domain.cage, _POINTS).vertices


def _divided(
    curve: Bounded, owners: Sequence[int], over: Sequence[int], parts: int, pose: Pose, closed: bool
) -> tuple[Bounded, list[int]]:
    """The curve through further maps, solved on some of its pieces, with ``parts`` for each lap."""
    maps, times, turns, of = [], [], [], []
    for i, (start, end) in enumerate(itertools.pairwise(curve.times)):
        count = parts * curve.laps(i) if i in over else 1
        shares = np.arange(count) / count
        maps += [solved_between(curve, i, s, pose) if s else curve.maps[i] for s in shares]
        times += (start + shares * (end - start)).tolist()
        turns += [curve.turns[i] if count == 1 else 0] * count
        of += [i] * count
    through = [*maps, curve.maps[-1]], [*times, curve.times[-1]], turns, closed, curve.worse[of]
    return Bounded.through(*through), [owners[i] for i in of]


def solved_between(curve: Bounded, piece: int, s: float, pose: Pose) -> HarmonicMap:
    """The map of least distortion whose handles are where the curve carries them."""
    map = HarmonicMap(curve.boundary.domain, *curve(piece, s))
    ends = sorted(curve.maps[piece : piece + 2], key=lambda end: certificate_of(end).sigma2_lower)
    first = map if certificate_of(map).certified else ends[-1]
    asked = pose.with_targets(map(pose.handles))
    found = solve(map.domain, asked, options=Options(restarts=0), start=first).map
    return found if isinstance(found, HarmonicMap) else first


def _by_time(follow: Bounded, curve: Bounded) -> Between:
    """The curve as a function of the pieces of ``follow``, from which it was made."""
    if curve is follow:
        return follow

    def between(piece: int, s: float) -> Coefficients:
        time = follow.times[piece] + s * (follow.times[piece + 1] - follow.times[piece])
        i = min(bisect.bisect_right(curve.times, time), len(curve.turns)) - 1
        return curve(i, (time - curve.times[i]) / (curve.times[i + 1] - curve.times[i]))

    return between
