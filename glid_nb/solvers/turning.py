"""Paths of the targets along which parts of a shape turn instead of being pulled straight through.

Handles hang together in a tree, each at the nearest one that is in it already. From parent to child
a pose turns and stretches the line between them; a path does that evenly, so that handles that move
rigidly together do so all the way. A joint is a line that turns, against that of its parent, by so
much that either way round may lead to the better minimum, or one whose ends come so close that what
lies between has to turn.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from glid_nb._arrays import Array
from glid_nb.harmonic import as_complex
from glid_nb.solvers.pose import Pose, rigid_motion

_JOINT, _CLOSE = np.deg2rad(100), 0.5
# Where two targets of one line nearly coincide, of its length.
_LEAST_STRETCH = 1e-3
# Greatest turn of a stage.
_STAGE = np.deg2rad(40)
_WAYS = {
    0: {"staged targets": (1,)},
    1: {"staged targets, left": (1,), "staged targets, right": (-1,)},
    2: {
        "staged targets, left and right": (1, -1),
        "staged targets, right and left": (-1, 1),
        "staged targets, left": (1,),
        "staged targets, right": (-1,),
    },
}
"""By the number of joints, or more: what a way is called, and how joints turn, in turn."""


@dataclass(frozen=True)
class Turning:
    """What a pose does to the lines of the tree, in its order, the first handle being the root."""

    pose: Pose
    order: tuple[int, ...]
    parents: tuple[int, ...]
    whole: float
    """The turn of the shape as a whole, radians."""
    turns: tuple[float, ...]
    """Against the parent's line, in (-pi, pi]."""
    stretches: tuple[float, ...]

    @property
    def joints(self) -> list[int]:
        """Places in the order of the lines that turn by over 100 degrees or shrink to half."""
        lines = enumerate(zip(self.turns, self.stretches, strict=True))
        return [k for k, (turn, stretch) in lines if abs(turn) > _JOINT or stretch < _CLOSE]

    @property
    def ways(self) -> dict[str, tuple[int, ...]]:
        """Which joints turn left (1) and which right (-1), in turn."""
        return _WAYS[min(len(self.joints), 2)]

    def stages(self, way: tuple[int, ...], least: int = 2) -> list[Pose]:
        """The poses between the shape at rest and the wanted one; joints turn the short way for ().

        They are one less than the stages, of which there are at least so many.
        """
        turns = list(self.turns)
        for i, k in enumerate(self.joints if way else ()):
            side = way[i % len(way)]
            turns[k] = side * (side * turns[k] % (2 * np.pi))
        angles = np.full(len(self.pose), self.whole)
        for k, (i, j) in enumerate(zip(self.order[1:], self.parents[1:], strict=True), start=1):
            angles[i] = angles[j] + turns[k]
        count = max(int(np.ceil(max(np.abs(angles).max(), np.abs(turns).max()) / _STAGE)), least)
        return [self._at(k / count, angles) for k in range(1, count)]

    def _at(self, time: float, angles: Array) -> Pose:
        z, w = as_complex(self.pose.handles), as_complex(self.pose.targets)
        at, root = np.empty_like(z), self.order[0]
        at[root] = z[root] + time * (w[root] - z[root])
        for k, (i, j) in enumerate(zip(self.order[1:], self.parents[1:], strict=True), start=1):
            turned = np.exp(1j * time * angles[i]) * (1 + time * (self.stretches[k] - 1))
            at[i] = at[j] + turned * (z[i] - z[j])
        return self.pose.with_targets(np.stack([np.real(at), np.imag(at)], axis=1))


def turning_of(pose: Pose) -> Turning:
    """The tree of a pose's handles, of which there is at least one, and how its lines turn."""
    z, w = as_complex(pose.handles), as_complex(pose.targets)
    root = int(np.argmin(np.abs(z - z.mean())))
    nearest, parent = np.abs(z - z[root]), np.full(len(z), root)
    order, parents, turns, stretches = [root], [root], [0.0], [1.0]
    whole = float(np.angle(rigid_motion(z, w)[0]))
    angles = np.full(len(z), whole)
    nearest[root] = np.inf
    for _ in range(len(z) - 1):
        i = int(np.argmin(nearest))
        j = int(parent[i])
        ratio = (w[i] - w[j]) / (z[i] - z[j])
        turn = float(np.angle(ratio * np.exp(-1j * angles[j])))
        angles[i] = angles[j] + turn
        order.append(i)
        parents.append(j)
        turns.append(turn)
        stretches.append(max(abs(ratio), _LEAST_STRETCH))
        closer = (np.abs(z - z[i]) < nearest) & (nearest < np.inf)
        nearest[closer], parent[closer] = np.abs(z - z[i])[closer], i
        nearest[i] = np.inf
    return Turning(pose, tuple(order), tuple(parents), whole, tuple(turns), tuple(stretches))
