"""The times of poses in an animation, with easing and repetition, as plain values."""

import bisect
import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from scipy.interpolate import CubicSpline

from glid_nb._arrays import Array
from glid_nb.harmonic import HarmonicMap
from glid_nb.motion import Motion, MotionError, settings
from glid_nb.motion.easing import Easing, checked_easings
from glid_nb.motion.settings import Repeat, checked

LATEST = 3600.0  # seconds; no keyframe is moved later than this

LEAST_GAP = 1e-3
"""Least seconds between a new keyframe and the others. Later keyframes move if there is no room."""

_USUAL = 1.0  # default seconds between keyframes
_GRID = 0.01  # seconds; keyframes moved by hand are at multiples of this
_JITTER = 0.1  # seconds; error of the recorded times of a drag


@dataclass(frozen=True)
class Timeline:
    """The keyframes of poses, one for each. A keyframe has a time and an easing to the next one.

    Raises a MotionError for times that do not increase, and for other settings that are not valid.
    """

    times: tuple[float, ...] = (0.0,)  # seconds, at least 0, increasing
    easing: tuple[Easing, ...] = ("linear",)
    """The easing from each keyframe to the next. The last one is for a loop's way back."""
    repeat: Repeat = "once"
    back: float = _USUAL  # seconds that a loop takes from the last keyframe to the first
    loop_range: tuple[float, float] | None = None
    """The part that plays over and over, from one time to a later one; None for the whole motion.
    It may reach beyond the keyframes, whose times change."""

    def __post_init__(self) -> None:
        if not self.times or not isinstance(self.times, list | tuple):
            raise MotionError("times must be a list of at least one number")
        times = settings.checked_times(self.times, len(self.times), False)
        checked("the first of times", float, times[0], most=1e9)
        easing = checked_easings(self.easing, len(times))
        checked("repeat", Repeat, self.repeat)
        back = checked("back", float, self.back, above=0, most=1e9)
        if self.repeat == "loop":
            settings.checked_times((*times, times[-1] + back), len(times) + 1, False)
        part = self.loop_range
        if part is not None:
            part = settings.checked_times(part, 2, False)
            checked("the first of loop_range", float, part[0])
        vars(self).update(times=times, easing=easing, back=back, loop_range=part)

    @classmethod
    def even(cls, count: int) -> Self:
        """``count`` keyframes, one second apart."""
        return cls(tuple(_USUAL * i for i in range(count)), ("linear",) * count)

    def __len__(self) -> int:
        return len(self.times)

    @property
    def closed_times(self) -> tuple[float, ...]:
        """The times of the keyframes, and of a loop's return."""
        return (*self.times, self.end) if self.repeat == "loop" else self.times

    @property
    def end(self) -> float:
        """The time of the last keyframe; in a loop, the time of the return to the first."""
        return self.times[-1] + (self.back if self.repeat == "loop" else 0.0)

    @property
    def played_range(self) -> tuple[float, float] | None:
        """The loop range within the motion; None if the whole motion is played."""
        if self.loop_range is None or len(self) < 2:
            return None
        start, end = max(self.loop_range[0], self.times[0]), min(self.loop_range[1], self.end)
        whole = (start, end) == (self.times[0], self.end)
        return None if whole or end - start < LEAST_GAP else (start, end)

    def motion(self, maps: Sequence[HarmonicMap]) -> Motion:
        """The motion through maps, one for each keyframe."""
        times = self.closed_times
        return Motion(maps, times, easing=self.easing[: len(times) - 1], repeat=self.repeat)

    def repeated(self, repeat: Repeat) -> Self:
        """Set the repetition. A loop whose return has no time of its own yet comes back as fast as
        the keyframes follow one another, on average."""
        back = self.back
        if repeat == "loop" and len(self) > 1 and back == _USUAL:
            mean = (self.times[-1] - self.times[0]) / (len(self) - 1)
            back = round(max(mean, _GRID), 2)
        return replace(self, repeat=repeat, back=back)

    def lasting(self, seconds: float) -> Self:
        """Rescale the times to run from 0 to ``seconds``. A ping-pong's way back takes as long."""
        share = seconds / (self.end - self.times[0])
        times = tuple(share * (time - self.times[0]) for time in self.times)
        part = self.played_range
        if part is not None:
            part = share * (part[0] - self.times[0]), share * (part[1] - self.times[0])
        return replace(self, times=times, back=share * self.back, loop_range=part)

    def inserted(self, index: int, time: float | None = None) -> Self:
        """Insert a keyframe at an index above 0, by default midway between its neighbours."""
        before, after = self.times[:index], self.times[index:]
        if time is None:
            mean = max((before[-1] - before[0]) / (index - 1), LEAST_GAP) if index > 1 else _USUAL
            gap = after[0] - before[-1] if after else 2 * mean
            if gap < 2 * LEAST_GAP:
                gap = 2 * _USUAL
                after = tuple(t + gap for t in after)
            time = before[-1] + gap / 2
        eased = self.easing[index - 1]
        easing = (*self.easing[:index], eased, *self.easing[index:])
        return replace(self, times=(*before, time, *after), easing=easing)

    def recorded(self, index: int, offsets: Sequence[float]) -> Self:
        """Insert keyframes behind ``index``, ``offsets`` seconds after it. The keyframes behind
        them move by the last offset."""
        times = (*self.times[: index + 1], *(t + offsets[-1] for t in self.times[index + 1 :]))
        new = replace(self.eased(index, "linear"), times=times)
        for i, offset in enumerate(offsets, index + 1):
            new = new.inserted(i, round(self.times[index] + offset, 6))
        return new.eased(index + len(offsets), self.easing[index])

    def without(self, index: int) -> Self:
        """Remove a keyframe."""
        times, easing = ((*each[:index], *each[index + 1 :]) for each in (self.times, self.easing))
        return replace(self, times=times, easing=easing)

    def moved(self, index: int, time: float) -> tuple[Self, list[int]]:
        """Move a keyframe, or a loop's return, to the nearest free time. Returns the new order
        too."""
        time = checked("time", float, time, least=-LATEST, most=2 * LATEST)
        if index == len(self):
            back = round(max(time - self.times[-1], _GRID), 2)
            return replace(self, back=back), list(range(len(self)))
        others = {round(t / _GRID) for i, t in enumerate(self.times) if i != index}
        wanted = round(min(max(time, 0.0), LATEST) / _GRID)
        near = (wanted + sign * step for step in itertools.count() for sign in (1, -1))
        time = round(next(t for t in near if t >= 0 and t not in others) * _GRID, 6)
        times = [*self.times[:index], time, *self.times[index + 1 :]]
        order = sorted(range(len(self)), key=times.__getitem__)
        times, easing = (tuple(each[i] for i in order) for each in (times, self.easing))
        return replace(self, times=times, easing=easing), order

    def eased(self, index: int, easing: Easing) -> Self:
        """Set the easing from a keyframe to the next."""
        return replace(self, easing=(*self.easing[:index], easing, *self.easing[index + 1 :]))


def on_grid(times: Array) -> Array:
    """Increasing times on the grid of keyframes, in seconds since the first."""
    steps = np.arange(len(times))
    return _GRID * (np.maximum.accumulate(np.rint((times - times[0]) / _GRID) - steps) + steps)


def thinned(times: Array, points: Array, tolerance: float) -> list[int]:
    """Indices of the places (n, h, 2) to keep. A smooth motion through them meets the others
    within ``tolerance``."""
    kept, around = sorted({0, len(times) - 1}), np.linspace(-_JITTER, _JITTER, 5)[:, None]
    while len(kept) < len(times):
        smooth = CubicSpline(times[kept], points[kept], bc_type="natural")
        near = smooth(np.clip(times + around, times[0], times[-1]))
        off = np.linalg.norm(near - points, axis=-1).max(axis=2, initial=0).min(axis=0)
        off[np.abs(times[kept][:, None] - times).min(axis=0) < _JITTER] = 0
        if off.max() <= tolerance:
            break
        bisect.insort(kept, int(np.argmax(off)))
    return kept
