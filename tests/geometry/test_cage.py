"""What a cage accepts, how it refuses the rest, and how it orients its loops."""

from __future__ import annotations

import json
import time

import numpy as np
import pytest
from hypothesis import given, settings

from glid_nb.geometry import Cage, GeometryError, loop_name

from ..support.cages import (
    SQUARE,
    box,
    cages,
    comb,
    nasty_cages,
    regular,
    star_loop,
    with_vertices_on_edges,
)


def doubled_area(loop: np.ndarray) -> float:
    x, y = loop.T
    return float(np.dot(x, np.roll(y, -1)) - np.dot(np.roll(x, -1), y))


def test_a_square_with_a_hole_knows_its_measures() -> None:
    cage = Cage([[0, 0], [4, 0], [4, 2], [0, 2]], [[[1, 0.5], [1, 1.5], [2, 1.5], [2, 0.5]]])
    assert cage.area == pytest.approx(7.0)
    assert cage.perimeter == pytest.approx(16.0)
    assert cage.bounds == (0.0, 0.0, 4.0, 2.0)
    assert cage.longer_side == 4.0
    assert (cage.n_vertices, cage.n_holes) == (8, 1)
    assert [loop_name(i) for i in range(3)] == ["exterior loop", "hole 1", "hole 2"]
    assert cage.loops_complex[0].tolist() == [0, 4, 4 + 2j, 2j]


@pytest.mark.parametrize("flip_exterior", [False, True])
@pytest.mark.parametrize("flip_hole", [False, True])
def test_orientation_is_normalised_and_vertex_0_stays_first(
    flip_exterior: bool, flip_hole: bool
) -> None:
    exterior, hole = box(0, 0, 4), box(1, 1, 1)[::-1]
    given_exterior = np.roll(exterior[::-1], 1, axis=0) if flip_exterior else exterior
    given_hole = np.roll(hole[::-1], 1, axis=0) if flip_hole else hole
    cage = Cage(given_exterior, [given_hole])
    np.testing.assert_array_equal(cage.exterior, exterior)
    np.testing.assert_array_equal(cage.holes[0], hole)


@pytest.mark.slow
@given(cages())
@settings(max_examples=40)
def test_any_cage_is_oriented_and_survives_json(cage: Cage) -> None:
    assert doubled_area(cage.exterior - cage.exterior[0]) > 0
    assert all(doubled_area(hole - hole[0]) < 0 for hole in cage.holes)
    again = Cage.from_dict(json.loads(json.dumps(cage.to_dict())))
    for loop, copy in zip(cage.loops, again.loops, strict=True):
        np.testing.assert_array_equal(loop, copy)


def test_a_cage_cannot_be_changed() -> None:
    vertices = SQUARE.copy()
    cage = Cage(vertices, [box(0.25, 0.25, 0.5)])
    vertices[0] = 100.0
    assert cage.exterior[0].tolist() == [0.0, 0.0]
    for array in (*cage.loops, *cage.loops_complex):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 7.0
    with pytest.raises(AttributeError):
        cage.exterior = vertices  # pyright: ignore[reportAttributeAccessIssue]


def test_nasty_but_valid_cages_are_accepted() -> None:
    for name, cage in nasty_cages().items():
        assert cage.area > 0, name


BOWTIE = [[0, 0], [2, 2], [2, 0], [0, 2]]

REFUSED = {
    "NaN": (
        [[0, 0], [1, 0], [1, np.nan]],
        [],
        r"^exterior loop: vertex 2 is \(1.0, nan\); replace the NaN or infinite coordinate",
    ),
    "infinity in a hole": (
        SQUARE,
        [[[0.2, 0.2], [np.inf, 0.4], [0.4, 0.2]]],
        r"^hole 1: vertex 1 is \(inf, 0.4\)",
    ),
    "overflow": (
        [[0, 0], [1e200, 0], [0, 1]],
        [],
        r"^exterior loop: vertex 1 at \(1e\+200, 0\) is too large .*rescale",
    ),
    "wrong shape": (
        [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
        [],
        r"^exterior loop: vertices must be pairs of numbers .*; the shape is \(3, 3\)",
    ),
    "ragged": ([[0, 0], [1], [0, 1]], [], r"^exterior loop: vertices must be pairs of numbers"),
    "words": ([["a", "b"]] * 3, [], r"^exterior loop: vertices must be pairs of numbers"),
    "nothing": ([], [], r"^exterior loop: 0 vertices given, a loop needs at least 3"),
    "two vertices": (
        SQUARE,
        [[[0.2, 0.2], [0.4, 0.4]]],
        r"^hole 1: 2 vertices given, a loop needs at least 3",
    ),
    "consecutive repetition": (
        [[0, 0], [1, 0], [1, 0], [0, 1]],
        [],
        r"^The outline has two points in one place; leave one .*\(exterior loop: vertices 1 and 2 "
        r"coincide at \(1, 0\)\)$",
    ),
    "repetition": (
        [[0, 0], [1, 1], [2, 0], [2, 2], [1, 1], [0, 2]],
        [],
        r"^The outline touches itself; move .*vertices 1 and 4 coincide at \(1, 1\)\)$",
    ),
    "repetition within rounding": (
        [[0, 0], [1, 0], [1, 1e-14], [0, 1]],
        [],
        r"^The outline has two points in one place.*vertices 1 and 2 coincide",
    ),
    "zero area": (
        [[0, 0], [1, 1], [3, 3], [2, 2]],
        [],
        r"^The outline is flat, .*area is zero; .*all 4 vertices .*vertex 2 at \(3, 3\)",
    ),
    "self-crossing": (
        BOWTIE,
        [],
        r"^The outline crosses itself; move its points, .* \(exterior loop: the edges 0-1 and 2-3 "
        r"cross at \(1, 1\)\)$",
    ),
    "self-crossing at the closing edge": (
        [[2, 0], [0, 2], [0, 0], [2, 2]],
        [],
        r"^The outline crosses itself.*the edges 0-1 and 2-3 cross at \(1, 1\)",
    ),
    "self-crossing hole": (
        box(-1, -1, 5),
        [BOWTIE],
        r"^Hole 1 crosses itself; .*\(hole 1: the edges 0-1 and 2-3 cross at \(1, 1\)",
    ),
    "vertex on an edge": (
        [[0, 0], [4, 0], [4, 4], [2, 0], [0, 4]],
        [],
        r"^The outline touches itself; move the points apart.*edges 0-1 and 2-3 touch at \(2, 0\)",
    ),
    "spike without width": (
        [[0, 0], [2, 0], [2, 2], [2, 3], [2, 2.5], [0, 2]],
        [],
        r"^The outline has a spike .*; leave out .*edges 2-3 and 3-4 .*vertex 3 at \(2, 3\)",
    ),
    "hole crosses the exterior": (
        box(0, 0, 4),
        [box(3, 1, 2)],
        r"^Hole 1 crosses the outline; move it away or .*\(edge 0-1 of hole 1 and edge 1-2 of the "
        r"exterior loop cross at \(4, 1\)\)$",
    ),
    "hole touches the exterior": (
        box(0, 0, 4),
        [[[4, 2], [3, 3], [3, 1]]],
        r"^Hole 1 touches the outline; .*edge 0-1 of hole 1 and edge 1-2 of the exterior loop "
        r"touch at \(4, 2\)",
    ),
    "holes touch along an edge": (
        box(0, 0, 9),
        [box(1, 1, 2), box(3, 1, 2)],
        r"^Hole 2 touches hole 1; .*at \(3, ",
    ),
    "holes cross": (box(0, 0, 9), [box(1, 1, 3), box(2, 2, 3)], r"^Hole 2 crosses hole 1"),
    "hole outside": (
        box(0, 0, 4),
        [box(1, 1, 1), box(7, 1, 1)],
        r"^Hole 2 lies outside the outline; remove it or move it .*vertex 0 of hole 2 at \(7, 1\)",
    ),
    "hole within a hole": (
        box(0, 0, 9),
        [box(2, 2, 1), box(1, 1, 4)],
        r"^Hole 1 lies within hole 2, .*remove the inner one \(vertex 0 of hole 1 is at \(2, 2\)\)",
    ),
    "hole around the exterior": (
        box(1, 1, 1),
        [box(0, 0, 4)],
        r"^Hole 1 lies around the outline; swap .*vertex 0 of the exterior loop at \(1, 1\)",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_bad_cage_is_refused_with_its_own_message(name: str) -> None:
    exterior, holes, message = REFUSED[name]
    with pytest.raises(GeometryError, match=message):
        Cage(exterior, holes)


def test_indices_in_messages_are_those_of_the_input() -> None:
    # Clockwise loops are reversed inside, but the message must count the caller's vertices.
    loop = [[0, 0], [0, 4], [2, 1], [2, -1], [4, 4], [4, 0]]
    with pytest.raises(GeometryError, match=r"edges 2-3 and 5-0 cross at \(2, 0\)"):
        Cage(loop)


def test_a_missing_key_is_named() -> None:
    with pytest.raises(GeometryError, match="'cage' is missing"):
        Cage.from_dict({"holes": []})
    with pytest.raises(GeometryError, match="'holes' must be a list of loops, not str"):
        Cage.from_dict({"cage": SQUARE, "holes": "none"})
    assert Cage.from_dict({"cage": SQUARE.tolist()}).n_holes == 0


def test_errors_are_value_errors() -> None:
    with pytest.raises(ValueError, match="cross"):
        Cage(BOWTIE)


def test_a_thousand_vertices_are_accepted() -> None:
    assert Cage(star_loop(np.random.default_rng(0), 1000, 0.1)).n_vertices == 1000


# --- contains -------------------------------------------------------------------------------------


def crossing_number(cage: Cage, points: np.ndarray) -> np.ndarray:
    """Inside by the even-odd rule, for points that are not on the boundary."""
    inside = np.zeros(len(points), dtype=bool)
    for loop in cage.loops:
        for (ax, ay), (bx, by) in zip(loop, np.roll(loop, -1, axis=0), strict=True):
            spans = (ay > points[:, 1]) != (by > points[:, 1])
            if ay != by:
                x = ax + (points[:, 1] - ay) / (by - ay) * (bx - ax)
                inside ^= spans & (points[:, 0] < x)
    return inside


@pytest.mark.slow
@given(cages())
@settings(max_examples=15)
def test_contains_agrees_with_the_crossing_number(cage: Cage) -> None:
    xmin, ymin, xmax, ymax = cage.bounds
    share = np.random.default_rng(1).uniform(-0.1, 1.1, (21_000, 2))
    points = np.array([xmin, ymin]) + share * [xmax - xmin, ymax - ymin]
    expected = crossing_number(cage, points)
    inside = cage.contains(points)  # enough points for the grid
    few = cage.contains(points[:500])
    np.testing.assert_array_equal(inside, expected)
    np.testing.assert_array_equal(few, expected[:500])


@pytest.mark.slow
@pytest.mark.parametrize("n", [7, 20_001])
@given(cages())
@settings(max_examples=10)
def test_the_boundary_counts_as_inside(n: int, cage: Cage) -> None:
    rng = np.random.default_rng(2)
    for loop in cage.loops:
        edge = rng.integers(len(loop), size=n)
        share = rng.random((n, 1))
        points = loop[edge] + (np.roll(loop, -1, axis=0)[edge] - loop[edge]) * share
        assert cage.contains(points).all()
        assert cage.contains(loop).all()


@pytest.mark.slow
@pytest.mark.parametrize("copies", [1, 30_000])
def test_tolerance_widens_the_domain_by_that_much(copies: int) -> None:
    cage = Cage(box(0, 0, 4), [box(1, 1, 2)])
    points = np.array([[4.09, 2], [4.11, 2], [1.09, 2], [1.11, 2], [2, 2], [3.5, 2], [9, 9]])
    many = np.tile(points, (copies, 1))
    assert cage.contains(many)[-7:].tolist() == [False] * 5 + [True, False]
    assert cage.contains(many, 0.1)[-7:].tolist() == [True, False, True, False, False, True, False]


def test_contains_keeps_the_shape_and_refuses_other_ones() -> None:
    cage = Cage(SQUARE)
    assert cage.contains([0.5, 0.5]).shape == ()
    assert cage.contains(np.full((2, 3, 2), 0.5)).shape == (2, 3)
    assert cage.contains(np.empty((0, 2))).shape == (0,)
    assert not cage.contains([[np.nan, 0.5], [0.5, np.inf]]).any()
    with pytest.raises(GeometryError, match=r"shape \(\.\.\., 2\), not \(3,\)"):
        cage.contains([1.0, 2.0, 3.0])
    with pytest.raises(GeometryError, match="tolerance must be at least 0, not -1"):
        cage.contains([0.5, 0.5], -1)


@pytest.mark.slow
def test_a_million_points_are_answered() -> None:
    cage = Cage(with_vertices_on_edges(comb(20, 0.3), 10), [regular(30, 0.4, (0.5, 3.0))])
    xmin, ymin, xmax, ymax = cage.bounds
    share = np.random.default_rng(3).random((1_000_000, 2))
    points = np.array([xmin, ymin]) + share * [xmax - xmin, ymax - ymin]
    inside = cage.contains(points)
    box_area = (xmax - xmin) * (ymax - ymin)
    assert inside.mean() == pytest.approx(cage.area / box_area, abs=0.005)


@pytest.mark.parametrize("kind", ["tangled", "in one place"])
def test_thousands_of_faults_are_refused_at_the_first(kind: str) -> None:
    points = np.random.default_rng(0).normal(size=(4000, 2))
    points = points if kind == "tangled" else np.repeat(points[:4], 1000, axis=0)
    began = time.process_time()
    with pytest.raises(GeometryError, match=r"crosses itself|two points in one place"):
        Cage(points)
    assert time.process_time() - began < 2.0
