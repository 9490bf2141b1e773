"""Settings of a motion, checked; every error names the culprit."""

import itertools
from collections.abc import Sequence
from typing import Any, Literal

import numpy as np

from glid_nb._arguments import unmet
from glid_nb.certificate import Certificate, certificate_of
from glid_nb.geometry import loop_name
from glid_nb.harmonic import HarmonicMap
from glid_nb.motion.errors import MotionError

Between = Literal["auto", "bounded", "solved", "linear"]
Repeat = Literal["once", "loop", "ping-pong"]

LATEST = 1e9  # seconds
_LEAST_GAP = 1e-9  # of the largest time, or of 1 s if that is more: room for thousands of pieces


def checked(name: str, kind: Any, value: Any, **limits: float) -> Any:
    """The value, a number as a float; MotionError unless `unmet` accepts it."""
    wanted = unmet(kind, value, limits)
    if wanted:
        raise MotionError(f"{name} is {value!r:.60}; it must be {wanted}")
    return float(value) if kind is float else value


def checked_each(name: str, kind: Any, given: Any, count: int, **limits: float) -> tuple[Any, ...]:
    """One value for each interval; a single value holds for all."""
    values = given if isinstance(given, list | tuple) else [given] * count
    if len(values) != count:
        raise MotionError(f"{name} has {len(values)} values for {count} intervals; give {count}")
    return tuple(checked(f"{name}[{i}]", kind, each, **limits) for i, each in enumerate(values))


def checked_keyframes(keyframes: Any) -> tuple[HarmonicMap, ...]:
    """Certified maps of one domain whose ``f_z`` turn alike, all with the first one's domain."""
    listed = isinstance(keyframes, list | tuple)
    if not listed or len(keyframes) < 2:
        given = f"{len(keyframes)}" if listed else f"{keyframes!r:.60}"
        least = "at least 2 keyframes"
        raise MotionError(
            f"a motion needs a list of {least}, not {given}", f"a motion needs {least}; keep a pose"
        )
    maps: list[HarmonicMap] = []
    for i, given in enumerate(keyframes):
        map = given if isinstance(given, HarmonicMap) else getattr(given, "map", None)
        if not isinstance(map, HarmonicMap):
            what = f"keyframe {i} has no harmonic map but is a {type(given).__name__}"
            raise MotionError(f"{what}; give a HarmonicMap, or a Result or Certificate of one")
        proof, domain = certificate_of(map), maps[0].domain if maps else map.domain
        if not proof.certified:
            raise MotionError(f"keyframe {i} is not certified. {proof.reason}")
        if map.domain is not domain:
            if not map.domain.equals(domain):
                what = f"keyframe {i} lives on another domain than keyframe 0"
                raise MotionError(f"{what}; give maps of the same cage and offset cage")
            map = HarmonicMap(domain, map.phi, map.psi)
        maps.append(map)
        if reason := unlike_turns(certificate_of(maps[0]), proof):
            raise MotionError(f"keyframes 0 and {i} {reason}")
    return tuple(maps)


def unlike_turns(first: Certificate, last: Certificate) -> str:
    """Why no motion joins two maps; empty where their ``f_z`` turn alike along every loop."""
    turns = list(zip(first.windings, last.windings, strict=True))
    loop = max((j for j, (a, b) in enumerate(turns) if a != b), default=None)
    if loop is None:
        return ""
    return (
        f"cannot be joined without folding: along the {loop_name(loop)} f_z turns "
        f"{turns[loop][0]} times in one and {turns[loop][1]} times in the other, which no motion "
        "of locally injective maps can change; choose poses that turn alike around the holes"
    )


def least_gap(times: Sequence[float]) -> float:
    """The least seconds between keyframes at about these times."""
    return _LEAST_GAP * max(map(abs, [1.0, *times]))


def checked_times(times: Any, count: int, closed: bool) -> tuple[float, ...]:
    """Increasing times of the keyframes, and of a loop's return."""
    times = range(count + closed) if times is None else times
    if not isinstance(times, list | tuple | range | np.ndarray):
        raise MotionError(f"times must be a list of numbers, not {times!r:.60}")
    ends = {"least": -LATEST, "most": LATEST}
    values = [checked(f"times[{i}]", float, t, **ends) for i, t in enumerate(times)]
    if len(values) not in (count, count + closed):
        wanted = f"{count} or {count + 1}" if closed else f"{count}"
        raise MotionError(f"there are {len(values)} times for {count} keyframes; give {wanted}")
    least = least_gap(values)
    for i, (before, after) in enumerate(itertools.pairwise(values)):
        if after - before < least:
            given = f"times[{i + 1}] is {after:.16g} and times[{i}] is {before:.16g}"
            raise MotionError(f"{given}; times must increase, here by {least:.1g} s at least")
    if len(values) < count + closed:
        values.append(values[-1] + (values[-1] - values[0]) / (count - 1))
    return tuple(values)
