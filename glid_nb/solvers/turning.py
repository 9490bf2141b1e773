"""Paths of the targets along which parts of a shape turn instead of being pulled straight through.

Handles hang together in the shortest tree of ways inside the shape. A map turns the line from each
to the one that it hangs at by an angle beyond 180 degrees too: ``f_z`` tells along the way inside.
Maps that turn all lines alike mostly lead to the same minimum. What turns cost is known exactly for
small ones, in which it is a quadratic form, and for large ones about so, relative to each other: so
it is known beforehand which lines may as well turn the other way round.
"""

import functools
import itertools
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.sparse import csgraph
from scipy.spatial.distance import cdist

from glid_nb._arrays import Array
from glid_nb._runtime import single_blas_thread
from glid_nb.geometry import Domain, as_points, triangulate
from glid_nb.harmonic import HarmonicMap, as_complex
from glid_nb.harmonic.basis import basis_of
from glid_nb.harmonic.cauchy import edge_coefficients, first_by_edges
from glid_nb.pose import DeformationMap, Pose
from glid_nb.solvers.discretisation import discretise
from glid_nb.solvers.problem import matrix_at, unknowns_of
from glid_nb.solvers.whitening import pulled_back

_VERTICES = 300
_LEAST_STRAIN, _SMALL = 1e-6, 1e-6  # so that rigid motions cost something; a time
_STAGE, _ALIKE = np.deg2rad(60), np.deg2rad(20)
_SQUEEZED, _STRAIGHT, _WOUND = 0.95, np.deg2rad(10), np.deg2rad(110)
_BENT = np.deg2rad(40)  # lines that turn by less, or nearly by half a circle, make no arc
MOST_TURNED = 3  # lines, or groups of them, that are turned the other way round
Stages = list[tuple[float, Pose]]  # times from 0 to 1, and targets on the way from the handles
_coarse_mesh = functools.lru_cache(maxsize=4)(triangulate)  # for all handles of a cage


class Link(NamedTuple):
    """From a handle to one that hangs at it; what a map does to the line between them."""

    child: int
    parent: int
    turn: float  # against the parent's line; at the root against the shape, or the other of two
    squeezed: bool  # its targets are closer than its handles, and what lies between stays straight
    curled: bool  # it ends free and turns, but its end is turned far from twice as much
    wound: float  # by how much more the shape is turned at its child, if that is far; else 0


class Turning(NamedTuple):
    """How a map turns the lines of the tree, which come after those that they hang at."""

    domain: Domain
    pose: Pose
    root: int
    whole: float  # the turn of the shape, or of the first of two lines at the root
    lines: list[Link]

    def reversals(self, least: float) -> dict[tuple[int, ...], float]:
        """Lines that turn by so much, alone or together, and what the other way round costs of the
        turns as they are, the cheapest first."""
        far = self._far(least)
        some = [sum(c, ()) for n in range(MOST_TURNED) for c in itertools.combinations(far, n + 1)]
        costs = {lines: self.cost(lines) / self.cost() for lines in some}
        return dict(sorted(costs.items(), key=lambda item: item[1]))

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

    def _angles(self, reversed: tuple[int, ...]) -> dict[int, float]:
        """The turns of lines by child, as of the root itself."""
        angles = {self.root: self.whole}
        for i, j, turn, *_ in self.lines:
            angles[i] = angles[j] + turn - 2 * np.pi * np.sign(turn) * (i in reversed)
        return angles

    def key(self, reversed: tuple[int, ...] = ()) -> tuple[float, ...]:
        """The lines' turns against the first, by which maps of a pose can be told apart."""
        turns = np.array([*self._angles(reversed).values()][1:])
        return tuple(np.round(turns - turns[:1], 3))

    def cost(self, reversed: tuple[int, ...] = ()) -> float:
        """What the turns would cost if that grew with their square, as it does in the beginning."""
        moved = as_points(self._at(_SMALL, self._angles(reversed))) - self.pose.handles
        moves = moved.T.ravel() / _SMALL
        form = _firmness(self.domain, self.pose.handles.tobytes())
        return max(float(moves @ form @ moves), _SMALL**2)

    def stages(
        self, reversed: tuple[int, ...] = (), bent: int | None = None, unwound: bool = False
    ) -> Stages:
        """The poses on the way, where nothing turns by over 60 degrees from one to the next; turned
        as a whole in the beginning, so that no line turns by more than it must. Unwound, ends that
        are wound up are held, turned the other way round."""
        angles, ends = self._angles(reversed), np.full(len(self.pose), np.nan)
        for i, *_, wound in self.lines:
            if unwound and wound:
                ends[i] = angles[i] + wound - 2 * np.pi * np.sign(wound)
        middle = (max(angles.values()) + min(angles.values())) / 2
        turns = [*angles.values(), *(middle + angles[i] - angles[j] for i, j, *_ in self.lines)]
        count = max(int(np.ceil(np.nanmax(np.abs(np.append(turns, ends) - middle)) / _STAGE)), 2)
        stages, free = Stages(), replace(self.pose, scales=None)
        for time in (i / count for i in range(1, count)):
            at = as_points(self._at(time, angles, middle, bent))
            held = replace(free, targets=at, angles=middle + time * (ends - middle))
            stages.append((time, held))
        return stages

    def _at(
        self, time: float, angles: dict[int, float], middle: float = 0, bent: int | None = None
    ) -> Array:
        z, w = as_complex(self.pose.handles), as_complex(self.pose.targets)
        at = z + time * (w[self.root] - z[self.root])
        turned = {i: np.exp(1j * (middle + time * (a - middle))) for i, a in angles.items()}
        for i, j, turn, *_ in self.lines:
            line, stretch = z[i] - z[j], abs((w[i] - w[j]) / (z[i] - z[j]))
            at[i] = at[j] + (1 + time * (stretch - 1)) * turned[i] * line
            if i == bent:  # as a bar bent to an arc: its end turns twice as far as its chord
                end = np.exp(2j * turn)
                pivot = line * (stretch * np.exp(1j * turn) - end) / (1 - end)
                at[i] = at[j] + turned[j] * (pivot + np.exp(2j * time * turn) * (line - pivot))
        return at


@single_blas_thread()
def turning_of(map: DeformationMap, pose: Pose) -> Turning:
    """What a map does to the lines between a pose's handles, of which there is at least one."""
    assert isinstance(map, HarmonicMap)
    root, lines, rows = _tree(map.domain, pose.handles.tobytes())
    z, w = as_complex(pose.handles), as_complex(pose.targets)
    basis = basis_of(map.domain)
    fz = rows @ edge_coefficients(basis.pad(map.phi), basis.singularities)
    turns, angles, squeezed = {root: float(np.angle(fz[0]))}, dict[int, float](), list[bool]()
    for i, j, way in lines:
        along = turns[j] + np.cumsum(np.angle([1, *(fz[way][1:] / fz[way][:-1])]))
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
        more = turns[i] - angles[i]
        found.append(Link(i, j, turn, short, curled, more if abs(more) > _WOUND else 0.0))
    return Turning(map.domain, pose, root, whole, found)


@functools.lru_cache(maxsize=32)
def _tree(domain: Domain, handles: bytes) -> tuple[int, list[tuple[int, int, slice]], Array]:
    """The root; lines as child, parent and points on the way to it; the rows of ``f_z`` there.

    The ways follow the edges of a coarse mesh. Kept, for a drag asks for the same handles again.
    """
    points = np.frombuffer(handles).reshape(-1, 2)
    mesh = _coarse_mesh(domain.cage, _VERTICES)
    nearest = cdist(points, mesh.vertices).argmin(axis=1)
    lengths, before = csgraph.dijkstra(mesh.graph, indices=nearest, return_predecessors=True)
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


@functools.lru_cache(maxsize=32)
@single_blas_thread()
def _firmness(domain: Domain, handles: bytes) -> Array:
    """The least mean of ``(Re f_z)^2 + |f_zbar|^2`` for small moves of the handles, (Re, Im): the
    second term is the identity of whitened ``psi``."""
    matrices, points = discretise(domain).matrices, matrix_at(domain, handles, len(handles) // 16)
    free = unknowns_of(basis_of(domain), False, matrices.whitening).free
    phi, psi = np.hsplit(pulled_back(points, np.asarray(matrices.whitening)) * free, 2)
    rows = np.asarray(matrices.whitened, float) * np.sqrt(np.asarray(matrices.hessian_weights))
    strain = rows @ rows.T + _LEAST_STRAIN * np.eye(len(rows))
    return np.linalg.pinv(phi @ np.linalg.solve(strain, phi.T) + psi @ psi.T, hermitian=True)
