"""Paths of the targets along which parts of a shape turn instead of being pulled straight through.

Handles hang together in the shortest tree of ways inside the shape. A pose turns and stretches the
line from parent to child; a path does that evenly. A joint is a line that turns so far that either
way round may lead to the better minimum, or whose ends come so close that what lies between has to
turn.

Or the parts of a shape, handles that keep together, move rigidly against the largest: about the
fixed point of their motion, such as the joint of a limb, or where that is far away (a bar's end
that is led round) about their own middle, which moves straight on.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.sparse import csgraph
from scipy.spatial.distance import cdist

from glid_nb._arrays import Array
from glid_nb.geometry import Cage, as_points, triangulate
from glid_nb.harmonic import as_complex
from glid_nb.solvers.pose import Pose, rigid_motion

_VERTICES = 300
_RIGID = 0.02  # handles of one part stray by less than this share of the extent from a rigid motion
_LEAST_TURN = np.deg2rad(10)  # parts that turn by less are not led the other way round
_STAGE = np.deg2rad(40)
_JOINT, _BEND, _CLOSE = np.deg2rad(100), np.deg2rad(60), 0.5
_LEAST_STRETCH = 1e-3  # where two targets of one line nearly coincide, of its length
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


class Link(NamedTuple):
    """From a handle to one that hangs at it; what a pose does to the line between them."""

    child: int
    parent: int
    turn: float  # against the parent's line, in (-pi, pi]
    stretch: float


@dataclass(frozen=True)
class Turning:
    """What a pose does to the lines of the tree, which come after those that they hang at."""

    pose: Pose
    root: int
    whole: float  # the turn of the shape as a whole, radians
    lines: tuple[Link, ...]

    @property
    def joints(self) -> list[int]:
        """Places in the order of the lines that may as well turn the other way round: by over 100
        degrees against their parent's line, or by over 60 and so first to turn by over 100 against
        the shape; or those that shrink, or whose parent's shrink, to half."""
        total, stretches, found = {self.root: 0.0}, {self.root: 1.0}, list[int]()
        for k, (i, j, turn, stretch) in enumerate(self.lines):
            total[i], stretches[i] = total[j] + turn, stretch
            least = _BEND if abs(total[i]) > _JOINT >= abs(total[j]) else _JOINT
            if abs(turn) > least or min(stretch, stretches[j]) < _CLOSE:
                found.append(k)
        return found

    @property
    def ways(self) -> dict[str, list[Pose]]:
        """The stages of each way by name, from the shape at rest to the wanted pose."""
        lines = _WAYS[min(len(self.joints), 2)].items()
        tree = {self.root: self.root} | {line.child: line.parent for line in self.lines}
        return rigid_ways(self.pose, tree) | {name: self.stages(way) for name, way in lines}

    def stages(self, way: tuple[int, ...]) -> list[Pose]:
        """The poses between the shape at rest and the wanted one; joints turn left or right."""
        sides = {k: way[i % len(way)] for i, k in enumerate(self.joints)}
        turns = [_led(line.turn, sides.get(k, 0)) for k, line in enumerate(self.lines)]
        angles, root = {self.root: self.whole}, self.root
        for turn, (i, j, _, _) in zip(turns, self.lines, strict=True):
            angles[i] = angles[j] + turn
        z, w = as_complex(self.pose.handles), as_complex(self.pose.targets)

        def targets(time: float) -> Array:
            at = np.empty_like(z)
            at[root] = z[root] + time * (w[root] - z[root])
            for i, j, _, stretch in self.lines:
                turned = np.exp(1j * time * angles[i]) * (1 + time * (stretch - 1))
                at[i] = at[j] + turned * (z[i] - z[j])
            return at

        return _staged(self.pose, targets, [*angles.values(), *turns])


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
    angles, found = {root: whole}, list[Link]()
    for i, j in zip(order[1:].tolist(), before[order[1:]].tolist(), strict=True):
        ratio = (w[i] - w[j]) / (z[i] - z[j])
        turn = float(np.angle(ratio * np.exp(-1j * angles[j])))
        angles[i] = angles[j] + turn
        found.append(Link(i, j, turn, max(float(abs(ratio)), _LEAST_STRETCH)))
    return Turning(pose, root, whole, tuple(found))


def _led(angle: float, side: int) -> float:
    """A turn to the left (1), to the right (-1) or the short way (0)."""
    return side * (side * angle % (2 * np.pi)) if side else angle


def _distances(cage: Cage, points: Array) -> Array:
    """(k, k) lengths of ways between points along the edges of a coarse mesh of the shape."""
    mesh = triangulate(cage, _VERTICES)
    nearest = cdist(points, mesh.vertices).argmin(axis=1)
    ways = csgraph.dijkstra(mesh.graph, directed=False, indices=nearest)[:, nearest]
    return np.maximum(ways, cdist(points, points))


class _Motion(NamedTuple):
    """A turn of the handles of a part about a pivot that moves straight on."""

    part: list[int]
    angle: float
    pivot: complex
    shift: complex


def _staged(pose: Pose, targets: Callable[[float], Array], angles: Sequence[float]) -> list[Pose]:
    """Two stages or more at times between 0 and 1, where no angle changes by over 40 degrees."""
    count = max(int(np.ceil(np.abs(angles).max() / _STAGE)), 2)
    return [pose.with_targets(as_points(targets(k / count))) for k in range(1, count)]


def rigid_ways(pose: Pose, parents: dict[int, int]) -> dict[str, list[Pose]]:
    """The stages of the ways by name: parts turn the short way, or all to one side. ``parents``,
    which come first, tell which handle each hangs at; the root at itself."""
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

    def stages(side: int) -> list[Pose]:
        led = [side if abs(motion.angle) >= _LEAST_TURN else 0 for motion in motions]
        angles = [_led(motion.angle, way) for motion, way in zip(motions, led, strict=True)]

        def targets(time: float) -> Array:
            at = z.copy()
            for angle, (part, _, pivot, shift) in zip(angles, motions, strict=True):
                at[part] = pivot + np.exp(1j * time * angle) * (z[part] - pivot) + time * shift
            return aim + turn * (at - middle)

        return _staged(pose, targets, angles)

    return {name: stages(side) for name, side in ways.items()}


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
