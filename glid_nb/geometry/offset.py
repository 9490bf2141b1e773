"""The offset cage P^: the cage's loops moved outward, and one point inside every offset hole."""

import itertools
from dataclasses import dataclass
from numbers import Real

import numpy as np
import shapely
from numpy.typing import NDArray

from glid_nb._arrays import Array, read_only
from glid_nb.geometry._loops import GeometryError, Loops, loop_name, place
from glid_nb.geometry.cage import Cage

# Least distance of an offset edge from the cage, as a share of the smaller distance at its ends.
CLEARANCE = 0.3
MITRE_LIMIT = 4.0  # longest mitre at an acute convex corner, in distances

# Share of a passage's width that either side's offset may take, so that the clearance remains.
_PASSAGE_SHARE = 1.0 / (2.0 + CLEARANCE)
# Passages of at least this ratio of length to width are limited first. If offsets cross each other
# along a whole passage, later checks see them meet only at its ends.
_PASSAGE_LENGTH = 4.0
_SLOPE = 0.5  # greatest change of the distance per unit of arc length
_KEPT_LENGTH = 0.1  # least length of an offset edge, as a share of its cage edge
# Rounds of local shrinking before the whole offset is halved, and rounds of halving.
_LOCAL_ROUNDS = 60
_GLOBAL_ROUNDS = 30
_SHRINK = 0.8


@dataclass(frozen=True, eq=False)
class Offset:
    """An offset cage and how far it lies from its cage."""

    cage: Cage  # the offset cage P^, one vertex per vertex of the cage in the same order
    distances: tuple[NDArray[np.float64], ...]
    """Per loop, (n,) distances of vertex i of P^ from the lines of the two cage edges at vertex i.
    They are below the wanted distance in narrow places and at acute corners with a cut mitre."""
    notes: tuple[str, ...] = ()  # a sentence per loop whose distance was reduced


def offset_cage(cage: Cage, distance: float) -> Offset:
    """Move the exterior loop outward and every hole loop into its hole, in the cage's units.

    Every edge moves by `distance` along its normal, and neighbours meet in a mitre. So P^ has one
    vertex per cage vertex (Section 5). If that does not fit (a narrow passage, a small hole, short
    edges at a reflex corner), the distance is reduced, and `Offset.notes` says so. P^ encloses the
    cage strictly: each of its edges keeps a distance from the cage of at least 0.3 of the smaller
    of the distances at its ends.

    A GeometryError for a distance that is not positive, and for a passage too narrow for float64.
    """
    if not (isinstance(distance, Real) and 0 < distance <= 1e100):
        raise GeometryError(f"the offset must be a positive number, not {distance!r:.60} (≤ 1e100)")
    corners = _Corners(cage, distance)
    local = corners.smoothed(np.minimum(distance, corners.passage_limits(_PASSAGE_LENGTH)))
    for _ in range(1 + _GLOBAL_ROUNDS):
        local, fits = corners.shrunk(local)
        if fits:
            break
        local = 0.5 * local
    else:
        i = int(np.argmin(local))
        loop = int(corners.loop[i])
        plain = "this passage is too narrow; widen it, merge its two sides or remove the point"
        vertex = f"{loop_name(loop)}'s vertex {i - corners.loops.starts[loop]}"
        where = f"{vertex} at {place(corners.points[i])} lies in the passage"
        raise GeometryError(plain, corners.points[i], f"no offset cage fits: {where}")
    loops = corners.loops.split(corners.moved(local))
    try:
        outer = Cage(loops[0], loops[1:])
    except GeometryError as error:
        remedy = "widen the narrowest passage or use a smaller offset"
        plain = f"there is no room for an offset cage here; {remedy}"
        what = f"no valid offset cage at distance {distance:.6g}: {error}"
        raise GeometryError(plain, error.point, what) from error
    distances = tuple(map(read_only, corners.loops.split(local * corners.height)))
    return Offset(outer, distances, _notes(corners, local, distance))


def hole_points(cage: Cage) -> NDArray[np.float64]:
    """(N, 2) centres of the largest circles in holes; a GeometryError for too narrow a hole."""
    points = np.empty((cage.n_holes, 2))
    for i, hole in enumerate(cage.holes):
        region = shapely.Polygon(hole)
        # The default tolerance, a share of the bounding box, is too coarse for a slender hole: a
        # second search takes its tolerance from the radius found first.
        circle = shapely.maximum_inscribed_circle(region)
        radius = shapely.length(circle)
        if radius > 0:
            circle = shapely.maximum_inscribed_circle(region, tolerance=0.02 * radius)
        centre = shapely.get_point(circle, 0)
        candidates = [p for p in (centre, region.representative_point()) if region.contains(p)]
        if not candidates:
            where = f"{loop_name(i + 1)} of the offset cage near {place(hole[0])}"
            plain = "this hole is too narrow; widen it or remove it"
            raise GeometryError(plain, hole[0], f"no point inside {where}")
        best = max(candidates, key=region.exterior.distance)
        points[i] = best.x, best.y
    return points


class _Corners:
    """The vertices of all loops in one array, with directions and mitres at each."""

    def __init__(self, cage: Cage, distance: float) -> None:
        loops = self.loops = Loops.of(cage.loops)
        self.distance, self.points, self.loop = distance, loops.points, loops.number
        self.next, self.previous, self.length = loops.after, loops.before, loops.lengths
        self.position = np.cumsum(self.length) - self.length  # along the loop, up to a constant
        self.along = loops.edges / self.length[:, None]
        self.normal = np.stack([self.along[:, 1], -self.along[:, 0]], axis=1)  # away from P
        self.tree = shapely.STRtree(loops.segments)
        before, after = self.along[self.previous], self.along
        bulge = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
        self.convex = bulge > 0
        # n_before + n_after and +-(before - after) both point along the bisector. The longer one is
        # accurate, also at corners of almost 0 or 180 degrees.
        normals = self.normal[self.previous] + self.normal
        tangents = np.where(self.convex, 1.0, -1.0)[:, None] * (before - after)
        cosine = 0.5 * np.hypot(*normals.T)
        use_normals = cosine > 0.5
        axis = np.where(use_normals[:, None], normals, tangents)
        axis /= np.hypot(*axis.T)[:, None]
        mitre = 1.0 / np.maximum(cosine, 1e-15)
        mitre = np.where(self.convex, np.minimum(mitre, MITRE_LIMIT), mitre)
        self.step = mitre[:, None] * axis  # displacement per unit of distance
        self.height = mitre * cosine  # distance from the edges' lines per unit of distance
        # By how much an offset edge gets longer per unit of distance, at its start and at its end.
        self.gain_start = -np.sum(self.step * after, axis=1)
        self.gain_end = np.sum(self.step[self.next] * after, axis=1)

    def moved(self, local: Array) -> Array:
        return self.points + local[:, None] * self.step

    def passage_limits(self, min_ratio: float) -> Array:
        """(n,) greatest distances at vertices that face an edge of their loop across the outside.

        The way between them along the loop must be at least `min_ratio` times their gap.
        """
        points, reach = shapely.points(self.points), self.distance / _PASSAGE_SHARE
        w, e = self.tree.query(points, predicate="dwithin", distance=reach)
        apart = (e != w) & (self.next[e] != w) & (self.loop[e] == self.loop[w])
        w, e = w[apart], e[apart]
        arm = self.points[w] - self.points[e]
        # The nearest point of the edge, as a share of its length.
        t = np.clip(np.sum(arm * self.along[e], axis=1) / self.length[e], 0.0, 1.0)
        across = (t * self.length[e])[:, None] * self.along[e] - arm  # from the vertex to the edge
        gap = np.hypot(*across.T)
        towards = across / gap[:, None]
        # They face each other if the line between them is on the outer side of both.
        off_edge = -np.sum(towards * self.normal[e], axis=1) > -1e-9
        off_after = np.sum(towards * self.normal[w], axis=1) > -1e-9
        off_before = np.sum(towards * self.normal[self.previous[w]], axis=1) > -1e-9
        off_vertex = np.where(self.convex[w], off_after | off_before, off_after & off_before)
        around = self.loops.perimeters[self.loop[e]]
        ahead = (self.position[w] - self.position[e]) % around
        way = np.minimum(ahead - t * self.length[e], around - ahead)
        chosen = off_edge & off_vertex & (way >= min_ratio * gap)
        w, e, t, room = w[chosen], e[chosen], t[chosen], _PASSAGE_SHARE * gap[chosen]
        advance = np.maximum(np.sum(self.step[w] * towards[chosen], axis=1), 1.0)
        limits = np.full(len(self.points), np.inf)
        np.minimum.at(limits, w, room / advance)
        np.minimum.at(limits, e, room / np.maximum(1.0 - t, 1e-9))
        np.minimum.at(limits, self.next[e], room / np.maximum(t, 1e-9))
        return limits

    def smoothed(self, local: Array) -> Array:
        """The largest distances up to `local` whose change per arc length is at most the slope."""
        result = local.copy()
        for a, b in itertools.pairwise(self.loops.starts):
            n = b - a
            s = _SLOPE * np.concatenate([[0.0], np.cumsum(np.tile(self.length[a:b], 3))[:-1]])
            d = np.tile(local[a:b], 3)
            up = np.minimum.accumulate(d - s) + s
            down = (np.minimum.accumulate((d + s)[::-1]))[::-1] - s
            smooth = np.minimum(up, down)[n : 2 * n]
            # Where nothing is reduced, keep the exact value.
            result[a:b] = np.where(smooth < local[a:b] * (1 - 1e-9), smooth, local[a:b])
        return result

    def shrunk(self, local: Array) -> tuple[Array, bool]:
        """Distances shrunk where the offset does not fit, and whether it fits then."""
        limits = None
        for _ in range(_LOCAL_ROUNDS):
            factors = self._edge_factors(local)
            if (factors == 1.0).all():
                factors = self._meeting_factors(local)
                if (factors == 1.0).all():
                    return local, self._encloses(local)
                if limits is None:
                    limits = self.passage_limits(0.0)
                local = np.where(factors < 1.0, np.minimum(local, limits), local)
            local = self.smoothed(local * factors)
        return local, False

    def _edge_factors(self, local: Array) -> Array:
        """(n,) factors that make offset edges longer which are too short or reversed."""
        gain = local * self.gain_start + local[self.next] * self.gain_end
        loss = (1.0 - _KEPT_LENGTH) * self.length
        edge = np.flatnonzero(gain < -loss * (1 + 1e-9))
        factors = np.ones(len(local))
        factor = np.clip(loss[edge] / -gain[edge], 0.25, 0.95)
        # Only the ends that shorten the edge shrink.
        start, end = self.gain_start[edge] < 0, self.gain_end[edge] < 0
        np.minimum.at(factors, edge[start], factor[start])
        np.minimum.at(factors, self.next[edge[end]], factor[end])
        return factors

    def _meeting_factors(self, local: Array) -> Array:
        """(n,) factors for offset edges too close to the cage or to each other."""
        factors = np.ones(len(local))
        moved, height = Loops(self.moved(local), self.loop), local * self.height
        reach = CLEARANCE * np.minimum(height, height[self.next])
        edges = moved.segments

        e, f = self.tree.query(edges, predicate="dwithin", distance=reach)
        self._shrink_ends(factors, edges, e, self.loops.segments[f])

        e, f = shapely.STRtree(edges).query(edges, predicate="dwithin", distance=reach)
        neighbours = (e == f) | (self.next[e] == f) | (self.next[f] == e)
        apart = (self.loop[e] == self.loop[f]) & ~neighbours
        e, f = e[apart], f[apart]
        gap = shapely.distance(edges[e], edges[f])
        # A short edge is always close to its neighbours, so compare the gap with the way between.
        way = moved.way_between(e, f)
        close = gap < np.minimum(np.minimum(reach[e], reach[f]), CLEARANCE * way)
        self._shrink_ends(factors, edges, e[close], edges[f[close]])
        return factors

    def _shrink_ends(self, factors: Array, edges: Array, e: Array, others: Array) -> None:
        """Lower the factors at the ends of the edges `e`, more at the end nearer to `others`."""
        meeting = shapely.get_point(shapely.shortest_line(edges[e], others), 0)
        t = shapely.line_locate_point(edges[e], meeting, normalized=True)
        np.minimum.at(factors, e, np.where(t < 0.75, _SHRINK, 0.9))
        np.minimum.at(factors, self.next[e], np.where(t > 0.25, _SHRINK, 0.9))

    def _encloses(self, local: Array) -> bool:
        """Whether the offset loops, known not to meet the cage, lie outside the domain."""
        pairs = zip(self.loops.split(self.points), self.loops.split(self.moved(local)), strict=True)
        around = [(b, a) if i == 0 else (a, b) for i, (a, b) in enumerate(pairs)]
        return all(shapely.contains_xy(shapely.Polygon(a), *b[0]) for a, b in around)


def _notes(corners: _Corners, local: Array, distance: float) -> tuple[str, ...]:
    notes: list[str] = []
    for loop, distances in enumerate(corners.loops.split(local)):
        reduced = int((distances < 0.9 * distance).sum())
        if reduced:
            least, count = int(np.argmin(distances)), len(distances)
            share = "everywhere" if reduced == count else f"at {reduced} of {count} vertices"
            where = f"vertex {least} {place(corners.points[corners.loops.starts[loop] + least])}"
            notes.append(
                f"{loop_name(loop)}: the offset {distance:.4g} was reduced {share}, to "
                f"{distances[least]:.4g} at {where}, because there is no room for more."
            )
    return tuple(notes)
