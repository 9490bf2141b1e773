"""Paths of the targets along which parts of a shape turn instead of being pulled straight through.

Handles hang together in the shortest tree of ways inside the shape. A map turns the line from each
to the one that it hangs at by an angle beyond 180 degrees too: ``f_z`` tells along the way inside.
Maps that turn all lines alike lead to the same minimum, and what a shape costs grows with the
square of its turns. So the other minimum worth looking for is where a line that turns by about half
a circle turns the other way round.
"""

import functools
import itertools
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.sparse import csgraph
from scipy.spatial.distance import cdist

from glid_nb._arrays import Array
from glid_nb.geometry import Domain, as_points, triangulate
from glid_nb.harmonic import HarmonicMap, as_complex
from glid_nb.harmonic.basis import basis_of
from glid_nb.harmonic.cauchy import edge_coefficients, first_by_edges
from glid_nb.solvers.pose import Pose

_VERTICES = 300
_STAGE, _ALIKE = np.deg2rad(40), np.deg2rad(20)
_SQUEEZED, _STRAIGHT = 0.95, np.deg2rad(10)
_BENT = np.deg2rad(40)  # lines that turn by less, or nearly by half a circle, make no arc
MOST_TURNED = 3  # lines, or groups of them, that are turned the other way round


class Link(NamedTuple):
    """From a handle to one that hangs at it; what a map does to the line between them."""

    child: int
    parent: int
    turn: float  # against the parent's line; at the root against the shape, or the other of two
    squeezed: bool
    """Whether its targets are closer than its handles, and what lies between stays straight."""
    curled: bool
    """Whether it ends free and turns, but its end is turned far from twice as much."""


class Stage(NamedTuple):
    """Targets on the way from the handles, at a time from 0 to 1."""

    time: float
    pose: Pose


class Turning(NamedTuple):
    """How a map turns the lines of the tree, which come after those that they hang at."""

    pose: Pose
    root: int
    whole: float  # the turn of the shape, or of the first of two lines at the root
    lines: list[Link]

    def ways(self, least: float) -> dict[str, list[Stage]]:
        """The stages from the shape at rest to the wanted pose, by name.

        Lines that turn by at least so much go the other way round, alone or together, where that
        bends the shape no more than it would a single one; curled lines along an arc.
        """
        far = self._far(least)
        some = [sum(c, ()) for n in range(MOST_TURNED) for c in itertools.combinations(far, n + 1)]
        bends, allowed = {s: self._bend(s) for s in some}, (2 * np.pi / least - 1) ** 2
        kept = [
            s for s in sorted(some, key=bends.__getitem__) if bends[s] <= allowed * self._bend()
        ]
        ways = {f"the other way round at {', '.join(map(str, s))}": self.stages(s) for s in kept}
        curled = [line.child for line in self.lines if line.curled]
        return ways | {f"along an arc at {i}": self.stages(bent=i) for i in curled}

    def _far(self, least: float) -> list[tuple[int, ...]]:
        """The lines that turn most; of many, those at one handle that turn alike are one."""
        far = [line for line in self.lines if abs(line.turn) >= least]
        alike, groups = _ALIKE if len(far) > MOST_TURNED else 0, list[tuple[int, ...]]()
        while far:
            most = max(far, key=lambda line: abs(line.turn))
            group = [i for i in far if i.parent == most.parent and abs(i.turn - most.turn) < alike]
            groups.append(tuple(line.child for line in group or [most]))
            far = [line for line in far if line.child not in groups[-1]]
        return groups[:MOST_TURNED]

    def _turned(self, reversed: tuple[int, ...]) -> tuple[list[float], dict[int, float]]:
        """Turns against the parents' lines, and those of lines by child, as of the root itself."""
        angles, turns = {self.root: self.whole}, list[float]()
        for i, j, turn, *_ in self.lines:
            turns.append(turn - 2 * np.pi * np.sign(turn) * (i in reversed))
            angles[i] = angles[j] + turns[-1]
        return turns, angles

    def _bend(self, reversed: tuple[int, ...] = ()) -> float:
        turns, angles = self._turned(reversed)
        whole = np.median([*angles.values()])
        return float(np.square([*turns, *(angle - whole for angle in angles.values())]).sum())

    def stages(self, reversed: tuple[int, ...] = (), bent: int | None = None) -> list[Stage]:
        """The poses on the way, where nothing turns by over 40 degrees from one to the next."""
        free = replace(self.pose, angles=None, scales=None)
        z, w = as_complex(free.handles), as_complex(free.targets)
        turns, angles = self._turned(reversed)
        count = max(int(np.ceil(np.abs([*angles.values(), *turns]).max() / _STAGE)), 2)
        stages = []
        for time in np.arange(1, count) / count:
            at = z + time * (w[self.root] - z[self.root])
            for i, j, turn, *_ in self.lines:
                line, stretch = z[i] - z[j], abs((w[i] - w[j]) / (z[i] - z[j]))
                if i == bent:  # as a bar bent to an arc: its end turns twice as far as its chord
                    end = np.exp(2j * turn)
                    pivot = line * (stretch * np.exp(1j * turn) - end) / (1 - end)
                    arc = pivot + np.exp(2j * time * turn) * (line - pivot)
                    at[i] = at[j] + np.exp(1j * time * angles[j]) * arc
                    continue
                at[i] = at[j] + (1 + time * (stretch - 1)) * np.exp(1j * time * angles[i]) * line
            stages.append(Stage(float(time), free.with_targets(as_points(at))))
        return stages


def turning_of(map: HarmonicMap, pose: Pose) -> Turning:
    """What a map does to the lines between a pose's handles, of which there is at least one."""
    root, lines, rows = _tree(map.domain, pose.handles.tobytes())
    z, w = as_complex(pose.handles), as_complex(pose.targets)
    basis = basis_of(map.domain)
    fz = rows @ edge_coefficients(basis.pad(map.phi), basis.singularities)
    turns, angles, squeezed = {root: float(np.angle(fz[0]))}, dict[int, float](), list[bool]()
    for i, j, way in lines:
        along = turns[j] + np.cumsum(np.angle(fz[way][1:] / fz[way][:-1]))
        along = np.concatenate([[turns[j]], along])
        turns[i] = float(along[-1])
        # Where a line turns smoothly its ends turn by about the mean of what lies between.
        ratio = (w[i] - w[j]) / (z[i] - z[j])
        short, mean = float(np.angle(ratio)), float(along.mean())
        angles[i] = short + 2 * np.pi * round((mean - short) / (2 * np.pi))
        squeezed.append(bool(np.ptp(along) < _STRAIGHT and abs(ratio) < _SQUEEZED))
    # Most of the shape turns alike; where but two lines meet, one turns against the other.
    ends = [angles[i] for i, j, _ in lines if j == root]
    whole = float(np.median([turns[root], *angles.values()]))
    angles[root] = whole = ends[0] if len(ends) == 2 else whole
    found, parents = list[Link](), {j for _, j, _ in lines}
    for (i, j, _), short in zip(lines, squeezed, strict=True):
        turn = angles[i] - angles[j]
        off = abs(turns[i] - angles[j] - 2 * turn) > np.pi
        curled = i not in parents and _BENT < abs(turn) < np.pi - _BENT and off
        found.append(Link(i, j, turn, short, curled))
    return Turning(pose, root, whole, found)


@functools.lru_cache(maxsize=32)
def _tree(domain: Domain, handles: bytes) -> tuple[int, list[tuple[int, int, slice]], Array]:
    """The root; lines as child, parent and points on the way to it; the rows of ``f_z`` there.

    The ways follow the edges of a coarse mesh. Kept, for a drag asks for the same handles again.
    """
    points = np.frombuffer(handles).reshape(-1, 2)
    mesh = triangulate(domain.cage, _VERTICES)
    nearest = cdist(points, mesh.vertices).argmin(axis=1)
    lengths, before = csgraph.dijkstra(
        mesh.graph, directed=False, indices=nearest, return_predecessors=True
    )
    distances = np.maximum(lengths[:, nearest], cdist(points, points))
    root = int(np.argmin(distances.sum(axis=0)))
    tree = csgraph.minimum_spanning_tree(distances)
    order, parents = csgraph.breadth_first_order(tree, root, directed=False)
    along, lines = [points[root]], list[tuple[int, int, slice]]()
    for i, j in zip(order[1:].tolist(), parents[order[1:]].tolist(), strict=True):
        back, at = [points[i]], before[j, nearest[i]]
        while at >= 0 and at != nearest[j]:
            back.append(mesh.vertices[at])
            at = before[j, at]
        lines.append((i, j, slice(len(along), len(along) + len(back) + 1)))
        along += [points[j], *back[::-1]]
    return root, lines, first_by_edges(as_complex(along), basis_of(domain).singularities)
