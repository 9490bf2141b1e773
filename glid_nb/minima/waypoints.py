"""Stages: poses on the way to the targets, along which lines turn instead of being pulled straight.

Each line turns and stretches evenly in time, by the turns of a map
(:class:`glid_nb.minima.handle_turns.HandleTurns`) or by those the other way round.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from glid_nb._arrays import Array
from glid_nb.geometry import as_points
from glid_nb.harmonic import as_complex
from glid_nb.minima.handle_turns import HandleTurns
from glid_nb.pose import Pose

# No line turns by more from one waypoint to the next. With 60 degrees the results were as good as
# with 40, after fewer waypoints.
MOST_PER_WAYPOINT = np.deg2rad(60)


class Waypoint(NamedTuple):
    time: float
    """From 0, the handles, to 1, the targets; both excluded."""
    pose: Pose


def waypoints(
    turns: HandleTurns,
    reversed: tuple[int, ...] = (),
    *,
    arc: int | None = None,
    unwind: bool = False,
) -> list[Waypoint]:
    """The poses on the way, such that no line turns by over 60 degrees from one to the next.

    They begin with the shape turned as a whole, so that no line turns by more than it must.
    ``reversed`` names the children whose lines turn the other way round, ``arc`` the child whose
    line bends to an arc of a circle. With ``unwind``, the angles at ends that are wound up are
    held, turned the other way round.
    """
    angles = turns.angles(reversed)
    ends = np.full(len(turns.pose), np.nan)
    if unwind:
        for line in turns.lines:
            if line.wound:
                circle = 2 * np.pi * np.sign(line.overturn)
                ends[line.child] = angles[line.child] + line.overturn - circle
    middle = (max(angles.values()) + min(angles.values())) / 2
    against_parents = [middle + angles[line.child] - angles[line.parent] for line in turns.lines]
    every = [*angles.values(), *against_parents, *ends]
    furthest = np.nanmax(np.abs(np.array(every) - middle))
    count = max(int(np.ceil(furthest / MOST_PER_WAYPOINT)), 2)
    free = replace(turns.pose, scales=None)
    found = list[Waypoint]()
    for time in (i / count for i in range(1, count)):
        targets = as_points(targets_at(turns, time, angles, middle, arc))
        held = middle + time * (ends - middle)
        found.append(Waypoint(time, replace(free, targets=targets, angles=held)))
    return found


def targets_at(
    turns: HandleTurns,
    time: float,
    angles: dict[int, float],
    middle: float = 0,
    arc: int | None = None,
) -> Array:
    """(h,) complex targets at a time from 0 to 1.

    ``angles`` are the lines' turns at time 1; at time 0 all are turned by ``middle``.
    """
    z, w = as_complex(turns.pose.handles), as_complex(turns.pose.targets)
    root = turns.root
    at = z + time * (w[root] - z[root])
    turned = {i: np.exp(1j * (middle + time * (a - middle))) for i, a in angles.items()}
    for line in turns.lines:
        i, j = line.child, line.parent
        across = z[i] - z[j]
        at[i] = at[j] + (1 + time * (line.stretch - 1)) * turned[i] * across
        if i == arc:
            # The end of an arc turns twice as far as its chord, about a pivot that stays.
            end = np.exp(2j * line.turn)
            pivot = across * (line.stretch * np.exp(1j * line.turn) - end) / (1 - end)
            at[i] = at[j] + turned[j] * (pivot + np.exp(2j * time * line.turn) * (across - pivot))
    return at
