"""Paths of the targets along which parts of a shape turn instead of being pulled straight through.

Handles hang together in the shortest tree of ways inside the shape. From parent to child a pose
turns and stretches the line between them; a path does that evenly, so that handles that move
rigidly together do so all the way. A joint is a line that turns so far that either way round may
lead to the better minimum, or one whose ends come so close that what lies between has to turn.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csgraph
from scipy.spatial.distance import cdist

from glid_nb._arrays import Array
from glid_nb.geometry import Cage, as_points, triangulate
from glid_nb.harmonic import as_complex
from glid_nb.solvers.pose import Pose, rigid_motion
from glid_nb.solvers.rigid_parts import rigid_ways, stage_times

_VERTICES = 300
_JOINT, _BEND, _CLOSE = np.deg2rad(100), np.deg2rad(60), 0.5
# Where two targets of one line nearly coincide, of its length.
_LEAST_STRETCH = 1e-3
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
        """Places in the order of the lines that may as well turn the other way round.

        They turn by over 100 degrees against their parent's line, or by over 60 and so are the
        first to turn by over 100 against the shape; or they or their parent's shrink to half.
        """
        place = {i: k for k, i in enumerate(self.order)}
        total, found = [0.0], list[int]()
        for k, turn in enumerate(self.turns[1:], start=1):
            j = place[self.parents[k]]
            total.append(total[j] + turn)
            least = _BEND if abs(total[k]) > _JOINT >= abs(total[j]) else _JOINT
            if abs(turn) > least or min(self.stretches[k], self.stretches[j]) < _CLOSE:
                found.append(k)
        return found

    @property
    def ways(self) -> dict[str, list[Pose]]:
        """The stages of each way by name, from the shape at rest to the wanted pose."""
        lines = _WAYS[min(len(self.joints), 2)].items()
        tree = dict(zip(self.order, self.parents, strict=True))
        return rigid_ways(self.pose, tree) | {name: self.stages(way) for name, way in lines}

    def stages(self, way: tuple[int, ...]) -> list[Pose]:
        """The poses between the shape at rest and the wanted one; joints turn left or right."""
        turns = list(self.turns)
        for i, k in enumerate(self.joints):
            side = way[i % len(way)]
            turns[k] = side * (side * turns[k] % (2 * np.pi))
        angles = np.full(len(self.pose), self.whole)
        for k, (i, j) in enumerate(zip(self.order[1:], self.parents[1:], strict=True), start=1):
            angles[i] = angles[j] + turns[k]
        return [self._at(time, angles) for time in stage_times([*angles, *turns])]

    def _at(self, time: float, angles: Array) -> Pose:
        z, w = as_complex(self.pose.handles), as_complex(self.pose.targets)
        at, root = np.empty_like(z), self.order[0]
        at[root] = z[root] + time * (w[root] - z[root])
        for k, (i, j) in enumerate(zip(self.order[1:], self.parents[1:], strict=True), start=1):
            turned = np.exp(1j * time * angles[i]) * (1 + time * (self.stretches[k] - 1))
            at[i] = at[j] + turned * (z[i] - z[j])
        return self.pose.with_targets(as_points(at))


def turning_of(pose: Pose, cage: Cage) -> Turning:
    """The tree of a pose's handles, of which there is at least one, and how its lines turn."""
    z, w = as_complex(pose.handles), as_complex(pose.targets)
    whole = float(np.angle(rigid_motion(z, w)[0]))
    i, j = np.triu_indices(len(z), 1)
    lines = (w[i] - w[j]) / (z[i] - z[j]) * np.exp(-1j * whole)
    calm = np.all(np.abs(np.angle(lines)) < _BEND / 2) and np.all(np.abs(lines) > _CLOSE)
    # Where no line can be a joint, any tree will do.
    distances = cdist(pose.handles, pose.handles) if calm else _distances(cage, pose.handles)
    tree = csgraph.minimum_spanning_tree(distances)
    root = int(np.argmin(distances.sum(axis=0)))
    order, before = csgraph.breadth_first_order(tree, root, directed=False)
    parents, turns, stretches = [root], [0.0], [1.0]
    angles = np.full(len(z), whole)
    for i in order[1:]:
        j = int(before[i])
        ratio = (w[i] - w[j]) / (z[i] - z[j])
        turn = float(np.angle(ratio * np.exp(-1j * angles[j])))
        angles[i] = angles[j] + turn
        parents.append(j)
        turns.append(turn)
        stretches.append(max(abs(ratio), _LEAST_STRETCH))
    return Turning(
        pose, tuple(order.tolist()), tuple(parents), whole, tuple(turns), tuple(stretches)
    )


def _distances(cage: Cage, points: Array) -> Array:
    """(k, k) lengths of ways between points along the edges of a coarse mesh of the shape."""
    mesh = triangulate(cage, _VERTICES)
    nearest = cdist(points, mesh.vertices).argmin(axis=1)
    ways = csgraph.dijkstra(mesh.graph, directed=False, indices=nearest)[:, nearest]
    return np.maximum(ways, cdist(points, points))
