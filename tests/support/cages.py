"""Cages for tests: simple ones, nasty ones and random ones."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from hypothesis import strategies as st
from numpy.typing import NDArray

from glid_nb.geometry import Cage, GeometryError

Points = NDArray[Any]

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def box(x: float, y: float, side: float) -> Points:
    """Axis-parallel square with the given lower left corner."""
    return SQUARE * side + [x, y]


def regular(n: int, radius: float = 1.0, centre: tuple[float, float] = (0.0, 0.0)) -> Points:
    angle = 2 * np.pi * np.arange(n) / n
    return np.array(centre) + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def comb(teeth: int, gap: float, width: float = 1.0, height: float = 6.0) -> Points:
    """Teeth upwards from a bar, with the given gaps between them."""
    points = [[0.0, -1.0], [teeth * width + (teeth - 1) * gap, -1.0]]
    for tooth in reversed(range(teeth)):
        left = tooth * (width + gap)
        points += [[left + width, height], [left, height]]
        if tooth:
            points += [[left, 0.0], [left - gap, 0.0]]
    return np.array(points)


def spiral(turns: float, gap: float, steps: int = 24) -> Points:
    """A band of width 1 wound into a spiral with the given gap between its turns."""
    angle = 2 * np.pi / steps * np.arange(int(steps * turns) + 1)
    inner = (1.0 + gap) * (1.0 + angle / (2 * np.pi))
    direction = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    # Vertices of neighbouring turns lie on common rays, so their chords never cross.
    return np.concatenate([direction * (inner + 1.0)[:, None], direction[::-1] * inner[::-1, None]])


def spiky_star(spikes: int, inner: float) -> Points:
    """A star with sharp tips; `inner` is the radius of its notches."""
    loop = regular(2 * spikes)
    loop[1::2] *= inner
    return loop


def pincer(gap: float) -> Points:
    """A long arm whose pointed hand nearly touches the middle of a block's long side."""
    return np.array(
        [
            *([0, 0], [10, 0], [10, 1], [1, 1], [1, 4], [4.5, 4]),
            *([5, 1 + gap], [5.5, 4], [6, 4.5], [6, 5], [0, 5]),
        ],
        dtype=float,
    )


def blunt_notch(bottom: float) -> Points:
    """A deep notch whose bottom is a tiny edge."""
    half = bottom / 2
    return np.array(
        [[-5, -5], [5, -5], [5, 5], [1, 5], [half, -4], [-half, -4], [-1, 5], [-5, 5]], dtype=float
    )


def needle(angle: float) -> Points:
    """A block with a spike of the given angle (radians) out of its side, and one into it."""
    half = 4 * np.tan(angle / 2)
    return np.array(
        [
            *([0, 0], [6, 0], [6, 2 - half], [10, 2], [6, 2 + half]),
            *([6, 4], [0, 4], [0, 2 + half], [4, 2], [0, 2 - half]),
        ],
        dtype=float,
    )


def with_vertices_on_edges(loop: Points, parts: int) -> Points:
    """Every edge cut into `parts` collinear ones."""
    share = np.arange(parts)[None, :, None] / parts
    return (loop[:, None] + share * (np.roll(loop, -1, axis=0) - loop)[:, None]).reshape(-1, 2)


def nasty_cages() -> dict[str, Cage]:
    """Cages that each break a careless offset in another way."""
    sieve = [box(1.0 + 2.02 * (i % 7), 1.0 + 2.02 * (i // 7), 2.0) for i in range(49)]
    return {
        "comb with thin gaps": Cage(comb(8, 1e-3)),
        "comb with wide gaps": Cage(comb(5, 2.0)),
        "spiral": Cage(spiral(4, 0.05)),
        "sharp star": Cage(spiky_star(17, 0.1)),
        "limbs nearly touching": Cage(pincer(1e-6)),
        "notch with a tiny bottom": Cage(blunt_notch(1e-5)),
        "needles": Cage(needle(0.002)),
        "collinear vertices": Cage(with_vertices_on_edges(comb(3, 0.3), 9)),
        "49 holes, thin walls": Cage(box(0, 0, 16.2), sieve),
        "hole beside the exterior": Cage(box(0, 0, 10), [box(1e-7, 4, 3)]),
        "tiny hole": Cage(box(0, 0, 10), [regular(5, 1e-7, (5, 5))]),
        "slender triangle": Cage([[0, 0], [1, 0], [0.5, 1e-6]]),
        "far from the origin": Cage(comb(4, 0.1) + 1e5),
    }


def star_loop(rng: np.random.Generator, n: int, roughness: float) -> Points:
    """A random star-shaped loop about the origin, of radius at most 1."""
    weights = rng.random(n) + 0.3  # no gap of half a turn, which would let edges cross
    angle = 2 * np.pi * np.cumsum(weights) / weights.sum()
    radius = 1.0 - roughness * rng.random(n)
    return radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def random_walk_polygon(rng: np.random.Generator, steps: int, width: float) -> shapely.Polygon:
    """The outline of a thick random walk, with the holes that it happens to enclose."""
    turns = np.cumsum(rng.normal(0.0, 0.9, steps))
    path = np.cumsum(np.stack([np.cos(turns), np.sin(turns)], axis=1), axis=0)
    line = shapely.LineString(path)
    return line.buffer(width, quad_segs=1, join_style="mitre", mitre_limit=3.0)


def spanning_tree_polygon(
    rng: np.random.Generator, side: int, extra: int, width: float
) -> shapely.Polygon:
    """A thickened random spanning tree of a grid with `extra` edges closing loops (holes)."""
    cells = [(i, j) for i in range(side) for j in range(side)]
    links = [(c, (c[0] + 1, c[1])) for c in cells if c[0] + 1 < side]
    links += [(c, (c[0], c[1] + 1)) for c in cells if c[1] + 1 < side]
    root = {c: c for c in cells}

    def find(c: tuple[int, int]) -> tuple[int, int]:
        while root[c] != c:
            c = root[c]
        return c

    kept = []
    for k in rng.permutation(len(links)):
        a, b = links[k]
        if find(a) != find(b):
            root[find(a)] = find(b)
            kept.append(links[k])
        elif extra:
            extra -= 1
            kept.append(links[k])
    lines = shapely.MultiLineString([np.array(link, dtype=float) for link in kept])
    return lines.buffer(width, cap_style="square", join_style="mitre")


def _random_holes(
    rng: np.random.Generator, exterior: Points, holes: list[Points], count: int
) -> list[Points]:
    """Up to `count` more star-shaped holes at random places, some hugging their neighbours."""
    holes = list(holes)
    low, high = exterior.min(axis=0), exterior.max(axis=0)
    for _ in range(40 * count):
        if len(holes) >= count:
            break
        region = shapely.Polygon(exterior, holes)
        centre = low + (high - low) * rng.random(2)
        if not region.contains(shapely.Point(centre)):
            continue
        room = region.boundary.distance(shapely.Point(centre))
        radius = room * rng.choice([0.05, 0.5, 0.95, 0.9999])
        holes.append(centre + radius * star_loop(rng, int(rng.integers(3, 12)), 0.7))
    return holes


def random_cage(kind: str, seed: int, n_holes: int) -> Cage:
    """A random cage: "star", "walk", "tree", "comb" or "spiral", stretched, turned and moved."""
    rng = np.random.default_rng(seed)
    holes: list[Points] = []
    if kind == "star":
        exterior = star_loop(rng, int(rng.integers(3, 60)), rng.choice([0.1, 0.6, 0.95]))
    elif kind == "comb":
        exterior = comb(int(rng.integers(2, 7)), 10.0 ** rng.uniform(-4, 0.5))
    elif kind == "spiral":
        exterior = spiral(rng.uniform(1.1, 3), 10.0 ** rng.uniform(-3, 0), int(rng.integers(9, 30)))
    else:
        polygon = (
            random_walk_polygon(rng, int(rng.integers(3, 40)), rng.uniform(0.05, 0.5))
            if kind == "walk"
            else spanning_tree_polygon(
                rng, int(rng.integers(2, 6)), n_holes, rng.uniform(0.1, 0.49)
            )
        )
        exterior = shapely.get_coordinates(polygon.exterior)[:-1]
        holes = [shapely.get_coordinates(ring)[:-1] for ring in polygon.interiors][:n_holes]
    plain = [exterior, *_random_holes(rng, exterior, holes, n_holes)]

    angle, stretch = rng.uniform(0, 2 * np.pi), rng.choice([1.0, 3.0, 20.0])
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    affine = turn @ np.diag([stretch, 1.0]) * 10.0 ** rng.uniform(-3, 3)
    shift = rng.normal(size=2) * rng.choice([0.0, 10.0])
    jitter = rng.choice([0.0, 1e-6, 1e-3, 0.03])
    for strength in (jitter, jitter / 100, 0.0):
        moved = [loop + strength * rng.normal(size=loop.shape) for loop in plain]
        moved = [(loop + shift) @ affine.T for loop in moved]
        try:
            return Cage(moved[0], moved[1:])
        except GeometryError:
            if strength == 0.0:
                raise
    raise AssertionError("unreachable")


KINDS = ("star", "walk", "tree", "comb", "spiral")


def cages() -> st.SearchStrategy[Cage]:
    """Random cages with 0 to 6 holes."""
    return st.builds(
        random_cage, st.sampled_from(KINDS), st.integers(0, 2**32 - 1), st.integers(0, 6)
    )
