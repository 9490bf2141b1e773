"""Paths of the targets along which parts of a shape, handles that keep together, move rigidly.

A part turns about the fixed point of its motion, such as the joint of a limb, or where that is far
away (a bar's end that is led round) about its own middle, which moves straight on. Turns are
against the largest part, in whose place all stages are.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from glid_nb._arrays import Array
from glid_nb.geometry import as_points
from glid_nb.harmonic import as_complex
from glid_nb.solvers.pose import Pose, rigid_motion

# Handles of one part stray by less than this share of the extent from a rigid motion.
_RIGID = 0.02
# Parts that turn by less are not led the other way round.
_LEAST_TURN = np.deg2rad(10)
_STAGE = np.deg2rad(40)


class _Motion(NamedTuple):
    """A turn of the handles of a part about a pivot that moves straight on."""

    part: list[int]
    angle: float
    pivot: complex
    shift: complex


def stage_times(angles: Sequence[float]) -> list[float]:
    """Times between 0 and 1 of two stages or more, where nothing turns by over 40 degrees."""
    count = max(int(np.ceil(np.abs(angles).max() / _STAGE)), 2)
    return [k / count for k in range(1, count)]


def rigid_ways(pose: Pose, parents: dict[int, int]) -> dict[str, list[Pose]]:
    """The stages of the ways by name: parts turn the short way, or all to one side.

    ``parents`` tell which handle each hangs at, in an order that has parents first; the root is its
    own.
    """
    z, w = as_complex(pose.handles), as_complex(pose.targets)
    extent = float(np.abs(z - z.mean()).max())
    largest, *others = sorted(_parts(z, w, parents, _RIGID * extent), key=len, reverse=True)
    turn, middle, aim = rigid_motion(z[largest], w[largest])
    at_rest = middle + (w - aim) / turn
    motions = [_motion(part, z[part], at_rest[part], extent) for part in others]
    sides = {np.sign(m.angle) for m in motions if abs(m.angle) > _LEAST_TURN}
    ways = {"rigid parts": 0} if motions and len(sides) != 1 else {}
    if sides:
        ways |= {"rigid parts, left": 1, "rigid parts, right": -1}
    return {
        name: [
            pose.with_targets(as_points(aim + turn * (stage - middle)))
            for stage in _stages(z, [_sided(motion, side) for motion in motions])
        ]
        for name, side in ways.items()
    }


def _parts(z: Array, w: Array, parents: dict[int, int], tolerance: float) -> list[list[int]]:
    """Handles that move rigidly together and hang together, or of which two are left alone."""
    parts, part_of = list[list[int]](), dict[int, list[int]]()
    for i, j in parents.items():
        near = [part_of[j]] if i != j else []
        for part in [*near, *(part for part in parts if len(part) == 1), []]:
            wider = [*part, i]
            turn, middle, aim = rigid_motion(z[wider], w[wider])
            if np.abs(aim + turn * (z[wider] - middle) - w[wider]).max() <= tolerance:
                break
        if not part:
            parts.append(part)
        part.append(i)
        part_of[i] = part
    return parts


def _motion(part: list[int], z: Array, w: Array, extent: float) -> _Motion:
    turn, middle, aim = rigid_motion(z, w)
    angle, shift = float(np.angle(turn)), aim - middle
    if abs(shift) < extent * abs(1 - turn):
        return _Motion(part, angle, middle + shift / (1 - turn), 0j)
    return _Motion(part, angle, middle, shift)


def _sided(motion: _Motion, side: int) -> _Motion:
    """The same motion, turning left (1), right (-1) or the short way (0)."""
    if not side or abs(motion.angle) < _LEAST_TURN:
        return motion
    return motion._replace(angle=side * (side * motion.angle % (2 * np.pi)))


def _stages(z: Array, motions: list[_Motion]) -> list[Array]:
    stages = []
    for time in stage_times([motion.angle for motion in motions]):
        stage = z.copy()
        for part, angle, pivot, shift in motions:
            stage[part] = pivot + np.exp(1j * time * angle) * (z[part] - pivot) + time * shift
        stages.append(stage)
    return stages
