"""Settings of a motion, checked; every error names the culprit."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from typing import Any, Literal

import numpy as np

from glid_nb._arguments import unmet
from glid_nb._errors import InputError
from glid_nb.certificate import certificate_of
from glid_nb.geometry import loop_name
from glid_nb.harmonic import HarmonicMap

Easing = Literal["linear", "in", "out", "in-out"]
Between = Literal["bounded", "solved", "linear"]
Repeat = Literal["once", "loop", "ping-pong"]

EASINGS: dict[str, Callable[[float], float]] = {
    "linear": lambda s: s,
    "in": lambda s: s * s,
    "out": lambda s: s * (2 - s),
    "in-out": lambda s: s * s * (3 - 2 * s),
}
"""Monotone maps of [0, 1] to itself, so no map appears that the motion without them lacks."""


class MotionError(InputError):
    """Keyframes, times or settings that make no motion, or a file of one that is not valid."""


def checked(name: str, kind: Any, value: Any, **limits: float) -> Any:
    """The value, a number as a float; MotionError unless it is what `unmet` wants."""
    wanted = unmet(kind, value, limits)
    if wanted:
        raise MotionError(f"{name} is {value!r:.60}; it must be {wanted}")
    return float(value) if kind is float else value


def checked_keyframes(keyframes: Any) -> tuple[HarmonicMap, ...]:
    """Certified maps of one domain, of the first one's, whose ``f_z`` turn alike."""
    if not isinstance(keyframes, list | tuple) or len(keyframes) < 2:
        raise MotionError(f"a motion needs a list of at least 2 keyframes, not {keyframes!r:.60}")
    maps: list[HarmonicMap] = []
    for i, given in enumerate(keyframes):
        map = given if isinstance(given, HarmonicMap) else getattr(given, "map", given)
        if not isinstance(map, HarmonicMap):
            raise MotionError(
                f"keyframe {i} has no harmonic map but is a {type(given).__name__}; give a "
                "HarmonicMap, or a Result or Certificate of one"
            )
        domain = maps[0].domain if maps else map.domain
        if map.domain is not domain:
            if map.domain.to_dict() != domain.to_dict():
                raise MotionError(
                    f"keyframe {i} lives on another domain than keyframe 0; all keyframes of a "
                    "motion must be maps of the same cage and offset cage"
                )
            proof = certificate_of(map)
            map = HarmonicMap(domain, map.phi, map.psi)
            vars(map)["_proof"] = proof
        maps.append(map)
    windings = []
    for i, map in enumerate(maps):
        proof = certificate_of(map)
        if not proof.certified:
            raise MotionError(f"keyframe {i} is not certified. {proof.reason}")
        windings.append(proof.windings)
    for i, (before, after) in enumerate(itertools.pairwise(windings)):
        if before != after:
            loop = int(np.flatnonzero(np.array(before) != after)[-1])
            raise MotionError(
                f"keyframes {i} and {i + 1} cannot be joined without folding: along the "
                f"{loop_name(loop)} f_z turns {before[loop]} times in one and {after[loop]} times "
                "in the other, which no motion of locally injective maps can change, not even "
                "a solved one; choose poses that turn alike around the holes"
            )
    return tuple(maps)


def checked_times(times: Any, count: int, closed: bool) -> tuple[float, ...]:
    """Increasing times of the keyframes, and of a loop's return."""
    if times is None:
        times = range(count + closed)
    try:
        values = [checked(f"times[{i}]", float, t, least=-1e300) for i, t in enumerate(times)]
    except TypeError:
        raise MotionError(f"times must be a list of numbers, not {times!r:.60}") from None
    if len(values) not in (count, count + closed):
        wanted = f"{count} or {count + 1}" if closed else f"{count}"
        raise MotionError(f"there are {len(values)} times for {count} keyframes; give {wanted}")
    for i, (before, after) in enumerate(itertools.pairwise(values)):
        if not before < after:
            raise MotionError(
                f"times[{i + 1}] is {after:g} and times[{i}] is {before:g}; times must increase"
            )
    if len(values) < count + closed:
        values.append(values[-1] + (values[-1] - values[0]) / (count - 1))
    if not math.isfinite(2 * (values[-1] - values[0])):
        raise MotionError(f"times from {values[0]:g} to {values[-1]:g} are out of scale")
    return tuple(values)


def checked_easing(easing: Any, count: int) -> tuple[Easing, ...]:
    """One easing for each interval."""
    given = [easing] * count if isinstance(easing, str) else easing
    if not isinstance(given, list | tuple) or len(given) != count:
        raise MotionError(
            f"easing is {easing!r:.60}; it must be one name, or {count} for {count} intervals"
        )
    return tuple(checked(f"easing[{i}]", Easing, each) for i, each in enumerate(given))


def checked_turns(turns: Sequence[int] | None, count: int) -> tuple[int, ...]:
    """Whole turns added to each interval."""
    given = [0] * count if turns is None else turns
    if not isinstance(given, list | tuple) or len(given) != count:
        raise MotionError(f"turns is {turns!r:.60}; it must have {count} numbers for the intervals")
    limits = {"least": -100, "most": 100}
    return tuple(checked(f"turns[{i}]", int, each, **limits) for i, each in enumerate(given))
