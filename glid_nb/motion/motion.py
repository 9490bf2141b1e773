"""Motion through certified maps, as a value."""

import bisect
import functools
import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field
from numbers import Integral
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from glid_nb._arguments import plain
from glid_nb._arrays import Array, Rebuilt, frozen, number_pairs
from glid_nb._errors import about
from glid_nb._files import same_file, write_atomically
from glid_nb._runtime import single_blas_thread
from glid_nb.certificate.pieces import PieceCertificate, certify_pieces
from glid_nb.certificate.rounding import rounded_down
from glid_nb.geometry import Domain, place
from glid_nb.harmonic import HarmonicMap
from glid_nb.motion import file, settings
from glid_nb.motion.boundary import boundary_of
from glid_nb.motion.bounded import Bounded
from glid_nb.motion.curve import Curve, Piece, blend, linear_pieces, through_mended, through_solved
from glid_nb.motion.easing import Easing, checked_easings
from glid_nb.motion.errors import MotionError
from glid_nb.motion.settings import Between, Repeat, checked

_TOLERANCE = 0.002
_MOST_FRAMES = 100_000
_FINER = 2  # how often a piece without proof becomes three, which follow the curve more closely


@dataclass(frozen=True, eq=False)
class MotionCertificate:
    """What is proved of a motion at every instant."""

    certified: bool
    """Whether every map of the motion is proved locally injective on the closed domain."""
    sigma2_lower: float
    sigma1_upper: float
    k_upper: float
    until: float
    """The time before which everything is proved; the end of the motion where certified."""
    pieces: tuple[PieceCertificate, ...]
    """The same for each of :attr:`Motion.pieces`."""
    reason: str
    """One sentence: what is proved, or until when, and where the proof fails."""


@dataclass(frozen=True, eq=False, init=False)
class Motion(Rebuilt):
    """What lies between certified maps of one domain, proved at every instant.

    The keyframes are at least two poses: a HarmonicMap, Result or Certificate each. Every one is
    certified, and ``f_z`` turns alike in all of them. Raises a MotionError where a keyframe is not
    certified or does not fit the others, or a setting is not valid.
    """

    keyframes: tuple[HarmonicMap, ...] = field(repr=False)
    times: tuple[float, ...]
    """Seconds, strictly increasing; by default 0, 1, 2 and so on. A loop may have one more time,
    for its return to the first keyframe; by default that takes as long as a mean interval."""
    easing: tuple[Easing, ...]
    """For all intervals or for each, "linear", "in", "out", "in-out", "hold", or the handles
    (x1, y1, x2, y2) of a cubic Bezier curve from (0, 0) to (1, 1), as in CSS, all from 0 to 1.
    "hold" stays for 99 % of the time, then moves evenly through all maps."""
    repeat: Repeat
    """Either "once"; "loop", back to the first keyframe after the last; or "ping-pong"."""
    between: Between
    """"bounded": bounded distortion interpolation. "solved": the same through maps solved on the
    way, with handles that move on rigid paths. "linear": coefficients are blended. "auto": bounded,
    or solved where bounded is worse than the worse keyframe and solved is better (:attr:`ways`)."""
    tolerance: float
    """Largest distance of images from the smooth motion, relative to the cage's longer side."""
    turns: tuple[int, ...]
    """Whole turns, counter-clockwise, that each interval adds to the short way round."""
    handles: Array | None = field(repr=False)
    """(h, 2) points of the domain that move on rigid paths for "solved"; by default even points."""
    image_size: tuple[int, int] | None
    """(w, h) pixels of the picture that moves, if known. Then exports refuse other sizes."""

    def __init__(
        self,
        keyframes: Sequence[Any],
        times: Sequence[float] | None = None,
        *,
        easing: Easing | Sequence[Easing] = "linear",
        repeat: Repeat = "once",
        between: Between = "auto",
        tolerance: float = _TOLERANCE,
        turns: int | Sequence[int] = 0,
        handles: ArrayLike | None = None,
        image_size: Sequence[int] | None = None,
    ) -> None:
        maps = settings.checked_keyframes(keyframes)
        all_times = settings.checked_times(times, len(maps), repeat == "loop")
        count = len(all_times) - 1
        if handles is not None:
            wanted = "handles must be a list of [x, y] pairs"
            handles = frozen(number_pairs(handles, wanted, MotionError))
        size: Any = {"least": 1, "form": "the picture's (width, height) in whole pixels"}
        vars(self).update(
            keyframes=maps,
            times=all_times,
            easing=checked_easings(easing, count),
            repeat=checked("repeat", Repeat, repeat),
            between=checked("between", Between, between),
            tolerance=checked("tolerance", float, tolerance, above=0),
            turns=settings.checked_each("turns", int, turns, count, least=-100, most=100),
            handles=handles,
            image_size=checked("image_size", tuple[int, int] | None, plain(image_size), **size),
        )
        if between == "linear" and any(self.turns):
            raise MotionError(f"turns are {self.turns}; linear blending allows no turns, so give 0")

    def __reduce__(self) -> tuple[Any, ...]:
        """A copy keeps the pieces that were made, and their proofs."""
        return *super().__reduce__(), {"_intervals": dict(self._intervals)}

    @property
    def settings(self) -> dict[str, Any]:
        """Plain values of the keywords that make this motion, with its keyframes and times."""
        known = {key: getattr(self, key) for key in file.SETTINGS}
        if self.handles is not None:
            known["handles"] = self.handles.tolist()
        return known if self.image_size is None else {**known, "image_size": list(self.image_size)}

    @property
    def domain(self) -> Domain:
        """The domain of all maps."""
        return self.keyframes[0].domain

    @property
    def start(self) -> float:
        """The first time, seconds."""
        return self.times[0]

    @property
    def end(self) -> float:
        """The last time, seconds: of the last keyframe, or of a loop's or ping-pong's return."""
        there = self.times[-1] - self.times[0]
        return self.times[-1] + (there if self.repeat == "ping-pong" else 0.0)

    @property
    def duration(self) -> float:
        """Seconds; once there and back for "ping-pong"."""
        return self.end - self.start

    @property
    def ways(self) -> tuple[str, ...]:
        """What lies between each keyframe and the next: "bounded", "solved" or "linear"."""
        return self.curve.ways

    @functools.cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """The linear pieces of the motion in order: what is shown, exported and proved.

        Raises MotionError if the tolerance needs more than 8,192 from a keyframe to the next.
        """
        forth = self.pieces_forth
        if self.repeat != "ping-pong":
            return forth
        turn = 2 * self.times[-1]
        back = (Piece(turn - p.end, turn - p.start, p.end_map, p.start_map) for p in forth[::-1])
        return (*forth, *back)

    @property
    def pieces_forth(self) -> tuple[Piece, ...]:
        """The pieces of the way there, without a ping-pong's way back."""
        return self._proved[0]

    @functools.cached_property
    def certificate(self) -> MotionCertificate:
        """What is proved for every instant; computed on first use, with the pieces."""
        forth, proofs = self._proved
        failing = next((i for i, proof in enumerate(proofs) if not proof.certified), None)
        until, reason = self.end, f"Proved locally injective at every time on {len(forth)} pieces."
        if failing is not None:
            piece, proof = forth[failing], proofs[failing]
            until = piece.start + proof.until * (piece.end - piece.start)
            fails = f"the panel near {place(proof.place)} fails"
            reason = f"Certified up to t = {rounded_down(until, 6)}; {fails}."
        back = proofs[::-1] if self.repeat == "ping-pong" else ()
        return MotionCertificate(
            certified=failing is None,
            sigma2_lower=min(proof.sigma2_lower for proof in proofs),
            sigma1_upper=max(proof.sigma1_upper for proof in proofs),
            k_upper=max(proof.k_upper for proof in proofs),
            until=until,
            pieces=(*proofs, *back),
            reason=reason,
        )

    def __call__(self, time: float) -> HarmonicMap:
        """The map at a time. A loop and a ping-pong repeat for ever.

        For other motions, a time outside ``start`` to ``end`` raises MotionError.
        """
        time = checked("time", float, time, least=-settings.LATEST)
        if self.repeat != "once":
            time = self.start + (time - self.start) % self.duration
        elif not self.start <= time <= self.end:
            span = f"from {self.start:g} to {self.end:g} s"
            raise MotionError(f"the time {time:g} is outside the motion, {span}")
        starts = [piece.start for piece in self.pieces]
        return self.pieces[max(bisect.bisect_right(starts, time) - 1, 0)].at(time)

    def frame_times(self, fps: float) -> Array:
        """(n,) evenly spaced times; at most 100,000.

        A motion that repeats leaves out its end, which equals its start.
        """
        fps = checked("fps", float, fps, above=0, most=10_000)
        count = max(round(self.duration * fps), 1)
        if count > _MOST_FRAMES:
            asked = f"{self.duration:g} s at {fps:g} frames per second are {count:,} frames"
            raise MotionError(f"{asked}; {_MOST_FRAMES:,} is the most, so choose fewer per second")
        times = self.start + np.arange(count + (self.repeat == "once")) * self.duration / count
        return np.minimum(times, self.end)

    def resample(self, fps: float) -> tuple[Array, tuple[HarmonicMap, ...]]:
        """:meth:`frame_times`, and the maps then."""
        times = self.frame_times(fps)
        return times, tuple(self(float(time)) for time in times)

    @single_blas_thread()
    def part(self, start: float, end: float) -> Self:
        """The motion from a time to a later one on the way forth, proved anew; it plays once.

        It moves as this motion does, on the same straight pieces, the first and the last shortened.
        Its keyframes are the maps at both times and the keyframes between.
        """
        start, end = (checked("time", float, t, least=-settings.LATEST) for t in (start, end))
        least = settings.least_gap(self.times)
        if not self.start <= start <= end - least < end <= self.times[-1]:
            asked = f"there is no motion from {start:g} to {end:g} s"
            raise MotionError(f"{asked}; choose times from {self.start:g} to {self.times[-1]:g} s")
        spans = enumerate(itertools.pairwise(self.times))
        across = [i for i, (before, after) in spans if before < end and after > start]
        pieces = [piece for i in across for piece in self.interval(i)[0]]
        inside = [time for time in self.times if start + least <= time <= end - least]
        times = [start, *inside, end]
        runs = [
            [piece.within(a, b) for piece in pieces if piece.start < b and piece.end > a]
            for a, b in itertools.pairwise(times)
        ]
        keyframes = [runs[0][0].start_map, *(run[-1].end_map for run in runs)]
        known = {key: value for key, value in self.settings.items() if key not in file.OF_INTERVALS}
        part = type(self)(keyframes, times, **{**known, "repeat": "once"})
        for i, run in enumerate(runs):
            maps = [run[0].start_map, *(piece.end_map for piece in run)]
            part._intervals[i] = tuple(run), tuple(certify_pieces(maps))
        return part

    @single_blas_thread()
    def interval(self, index: int) -> tuple[tuple[Piece, ...], tuple[PieceCertificate, ...]]:
        """The pieces from a keyframe to the next, and their proofs; computed on first use."""
        last = len(self.times) - 2
        if not isinstance(index, Integral) or not 0 <= index <= last:
            raise MotionError(f"there is no interval {index!r:.40}; give a number from 0 to {last}")
        if index not in self._intervals:
            self._intervals[index] = self._made(index)
        return self._intervals[index]

    @functools.cached_property
    def _intervals(self) -> dict[int, tuple[tuple[Piece, ...], tuple[PieceCertificate, ...]]]:
        return {}

    @functools.cached_property
    def curve(self) -> Curve:
        """The smooth motion, which the pieces follow within the tolerance."""
        closed, intervals = self.repeat == "loop", range(len(self.times) - 1)
        maps = self.keyframes + self.keyframes[:closed]
        through = maps, self.times, self.easing
        if self.between == "linear":
            ways = ("linear",) * len(intervals)
            return Curve(*through, functools.partial(blend, maps), (1,) * len(ways), ways)
        way = follow = Bounded.through(maps, self.times, self.turns, closed)
        ways = (self.between,) * len(intervals)
        if self.between == "auto":
            way, ways = through_mended(follow, closed)
        elif self.between == "solved":
            way = through_solved(follow, self.handles, closed)
        return Curve(*through, way, tuple(map(follow.laps, intervals)), ways)

    @functools.cached_property
    def _proved(self) -> tuple[tuple[Piece, ...], tuple[PieceCertificate, ...]]:
        """The pieces of the way there, and their proofs."""
        intervals = [self.interval(i) for i in range(len(self.times) - 1)]
        pieces, proofs = (itertools.chain(*each) for each in zip(*intervals, strict=True))
        return tuple(pieces), tuple(proofs)

    def _made(self, index: int) -> tuple[tuple[Piece, ...], tuple[PieceCertificate, ...]]:
        """The pieces of an interval, shorter ones where they are not proved, and their proofs."""
        curve, boundary = self.curve, boundary_of(self.domain)
        times = curve.breaks(index, self.tolerance * self.domain.cage.longer_side)
        maps = [curve.map(time) for time in times]
        proofs = list(certify_pieces(maps))
        for _ in range(0 if self.between == "linear" else _FINER):
            failing = [i for i, proof in enumerate(proofs) if not proof.certified]
            if any(boundary.worst(map.phi, map.psi)[0] >= 0 for map in maps):
                break  # no piece through a map that folds is ever proved
            for i in reversed(failing):
                times[i + 1 : i + 1] = np.linspace(times[i], times[i + 1], 4)[1:-1].tolist()
                maps[i + 1 : i + 1] = [curve.map(time) for time in times[i + 1 : i + 3]]
                proofs[i : i + 1] = certify_pieces(maps[i : i + 4])
        return linear_pieces(times, maps), tuple(proofs)

    def save(self, path: str | Path, proof: str | Path | None = None) -> None:
        """Write keyframes, settings and pieces as JSON, and the proof that ``glid-check`` reads.

        If the motion is not certified, or both names are the same file, MotionError is raised and
        nothing is written.
        """
        paths = [path] if proof is None else [path, proof]
        if proof is not None and same_file(Path(path), Path(proof)):
            raise MotionError(f"the proof would overwrite the motion in {path}; name another file")
        for to, text in zip(paths, self.texts(proof is not None), strict=True):
            write_atomically(to, text)

    def texts(self, proof: bool = True, image_size: Sequence[int] | None = None) -> tuple[str, ...]:
        """What :meth:`save` writes; MotionError if there is no proof.

        ``image_size`` is the picture's, for a motion that does not know it.
        """
        if proof and not self.certificate.certified:
            raise MotionError(f"there is no proof to write: {self.certificate.reason}")
        known = {"times": self.times, **self.settings}
        known.setdefault("image_size", image_size)
        return file.texts(self.pieces_forth, known, self._proved[1] if proof else ())

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """The motion that :meth:`save` wrote, the same pieces bit for bit, proved anew.

        Raises MotionError, which names the file and what is wrong there.
        """
        with about(path, MotionError), single_blas_thread():
            keyframes, known, times, maps = file.read(path)
            motion = cls(keyframes, **known)
            knots = [times.index(time) for time in motion.times]
            for i, (first, last) in enumerate(itertools.pairwise(knots)):
                made = linear_pieces(times[first : last + 1], maps[first : last + 1])
                motion._intervals[i] = made, certify_pieces(maps[first : last + 1])
            return motion
