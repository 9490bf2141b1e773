"""Cuts take a thin slit out of a cage, and nothing else."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import glid_nb as glid
from glid_nb.certificate import certify
from glid_nb.geometry import Cage, Domain, GeometryError, cut
from glid_nb.geometry._loops import subdivided
from glid_nb.harmonic import HarmonicMap

from ..support.cages import box, cages

RECTANGLE = Cage([[0, 0], [6, 0], [6, 4], [0, 4]])
HOLED = Cage(box(0, 0, 10), [box(2, 2, 1), box(6, 6, 2)])


def divided(loop: Any, length: float) -> Any:
    """A loop with edges of about a length."""
    z = loop @ np.array([1, 1j])
    parts = np.ceil(np.abs(np.roll(z, -1) - z) / length).astype(int)
    cut_up = subdivided(z, parts)
    return np.stack([cut_up.real, cut_up.imag], axis=1)


def places_in(cage: Cage, seed: int, count: int = 200) -> Any:
    """Random points inside a cage."""
    low, high = np.reshape(cage.bounds, (2, 2))
    points = low + (high - low) * np.random.default_rng(seed).random((count, 2))
    return points[cage.contains(points)]


def test_a_line_from_outside_makes_a_slit_with_four_new_vertices() -> None:
    (trousers,) = cut(RECTANGLE, [[3, -1], [3, 2]], 0.2)
    expected = [[0, 0], [2.9, 0], [2.9, 2], [3.1, 2], [3.1, 0], [6, 0], [6, 4], [0, 4]]
    got = np.roll(trousers.exterior, -np.abs(trousers.exterior).sum(axis=1).argmin(), axis=0)
    np.testing.assert_allclose(got, expected, atol=1e-12)


def test_the_width_is_by_default_a_small_share_of_the_shape() -> None:
    (trousers,) = cut(RECTANGLE, [[3, -1], [3, 2]])
    assert RECTANGLE.area - trousers.area == pytest.approx(2 * 0.004 * 6)


def test_a_line_inside_makes_a_thin_hole() -> None:
    (pierced,) = cut(RECTANGLE, [[2, 2], [4, 2]], 0.1)
    assert pierced.n_holes == 1
    assert Cage(pierced.holes[0]).bounds == pytest.approx((2, 1.95, 4, 2.05))
    assert Domain.from_cage(pierced).n_holes == 1


def test_a_line_across_the_shape_makes_pieces_the_largest_first() -> None:
    large, small = cut(RECTANGLE, [[2, 5], [2, -1]], 0.2)
    assert large.bounds == pytest.approx((2.1, 0, 6, 4))
    assert small.bounds == pytest.approx((0, 0, 1.9, 4))


def test_a_zigzag_makes_many_pieces() -> None:
    fork = Cage([[0, 0], [5, 0], [5, 4], [4, 4], [4, 1], [3, 1], [3, 4], [0, 4]])
    pieces = cut(fork, [[-1, 3], [6, 3]], 0.1)
    assert [round(piece.area, 2) for piece in pieces] == [12.8, 2.85, 0.95]


def test_a_closed_line_cuts_out_what_it_encloses() -> None:
    rim, disc = cut(RECTANGLE, [[2, 1], [4, 1], [4, 3], [2, 3], [2, 1]], 0.2)
    assert (rim.n_holes, disc.n_holes) == (1, 0)
    assert disc.bounds == pytest.approx((2.1, 1.1, 3.9, 2.9))


def test_a_line_between_two_holes_joins_them_and_a_line_to_the_rim_opens_one() -> None:
    (joined,) = cut(HOLED, [[2.5, 2.5], [7, 7]])
    assert joined.n_holes == 1
    (opened,) = cut(HOLED, [[2.5, 2.5], [-1, 2.5]])
    assert opened.n_holes == 1
    np.testing.assert_array_equal(np.sort(opened.holes[0], axis=0), np.sort(HOLED.holes[1], axis=0))


@pytest.mark.parametrize(
    "line",
    [
        [[3, 0.3], [3, 2]],  # short of the outline
        [[3, 0], [3, 2]],  # on it
        [[0.3, 0.3], [3, 2]],  # short of a corner
        [[1, 0.1], [0.9, 0.15], [3, 2]],  # short of it and turning away from it
    ],
)
def test_an_end_just_short_of_the_outline_leaves_no_bridge(line: Any) -> None:
    (opened,) = cut(RECTANGLE, line, 0.2)
    assert opened.n_holes == 0
    assert RECTANGLE.area - opened.area < 1.2 * 0.2 * 3.6


def test_a_vertex_beside_the_mouth_becomes_its_corner() -> None:
    cage = Cage([[0, 0], [3.11, 0], [6, 0], [6, 4], [0, 4]])
    (trousers,) = cut(cage, [[3, -1], [3, 2]], 0.2)
    assert trousers.n_vertices == 8
    assert [3.11, 0] in trousers.exterior.tolist()


@pytest.mark.parametrize(
    ("line", "culprit"),
    [
        ([[8, 0], [9, 1]], r"misses the shape.*begins at \(8, 0\)"),
        ([[6, -1], [6, 5]], "misses the shape"),  # along the outline
        ([[-1, 1], [5, 1], [3, 3], [3, -1]], r"crosses itself.*at \(3, 1\)"),
        ([[-1, 1], [5, 1], [2, 1]], "crosses itself"),
        ([[-1, 1], [np.nan, 1]], r"point 1 of the cut.*finite"),
        ([[np.inf, 1], [2, 1]], r"point 0 of the cut.*finite"),
        ([[1, 1]], "two different points"),
        ([[1, 1], [1, 1]], "two different points"),
        ([], "two different points"),
        ([[1, 1, 1]], "line of points"),
        (None, "line of points"),
    ],
)
def test_a_line_that_cuts_nothing_is_refused_by_name(line: Any, culprit: str) -> None:
    with pytest.raises(GeometryError, match=culprit):
        cut(RECTANGLE, line)


@pytest.mark.parametrize(
    ("width", "culprit"),
    [
        (1e-5, "too small for an offset cage.*use at least 0.0006"),
        (0, "positive number"),
        (-1, "positive number"),
        (np.nan, "positive number"),
        (np.inf, "positive number"),
        ("wide", "positive number"),
        (20, "leaves nothing of the shape"),
    ],
)
def test_a_width_that_does_not_work_is_refused_by_name(width: Any, culprit: str) -> None:
    with pytest.raises(GeometryError, match=culprit):
        cut(RECTANGLE, [[-1, 2], [7, 2]], width)


UNITS = st.floats(0, 1)


@given(cages(), st.tuples(UNITS, UNITS), st.tuples(UNITS, UNITS), st.floats(-3.5, -2))
@settings(max_examples=60)
def test_a_straight_cut_takes_the_strip_and_nothing_else(
    cage: Cage, start: tuple[float, float], turn: tuple[float, float], log_width: float
) -> None:
    """The line goes through the whole shape, so the slit is a strip without ends."""
    (x0, y0, x1, y1), width = cage.bounds, 10**log_width * cage.longer_side
    middle = np.array([x0 + start[0] * (x1 - x0), y0 + start[1] * (y1 - y0)])
    angle = np.pi * turn[0]
    along = 2 * cage.longer_side * np.array([np.cos(angle), np.sin(angle)])
    across = 0.5 * width / np.hypot(*along) * np.array([-along[1], along[0]])
    line = np.array([middle - along, middle + along])
    assume(cage.polygon.crosses(shapely.LineString(line)))
    pieces = cut(cage, line, width)

    strip = shapely.Polygon([*(line + across), *(line - across)[::-1]])
    rest = shapely.difference(shapely.Polygon(cage.exterior, cage.holes), strip)
    scraps = [part for part in shapely.get_parts(rest) if part.area <= width**2]
    expected = shapely.difference(rest, shapely.union_all(scraps))
    union = shapely.union_all([piece.polygon for piece in pieces])
    wrong = shapely.symmetric_difference(union, expected)
    # At a mouth, a vertex up to half a width beside the slit may have become its corner.
    near = shapely.LineString(line).buffer(1.01 * width)
    assert shapely.difference(wrong, near).area <= 1e-9 * cage.area
    mouths = len(shapely.get_parts(shapely.intersection(strip, cage.polygon)))
    assert wrong.area <= mouths * width * cage.perimeter / cage.n_vertices + 1e-9 * cage.area
    apart = [not shapely.LinearRing(hole).intersects(near) for hole in cage.holes]
    assert sum(piece.n_holes for piece in pieces) >= sum(apart)


@given(cages(), st.integers(0, 2**32 - 1), st.integers(2, 6), st.floats(-3.5, -2))
@settings(max_examples=60)
def test_points_off_the_slit_stay_inside_exactly_one_piece(
    cage: Cage, seed: int, count: int, log_width: float
) -> None:
    rng, width = np.random.default_rng(seed), 10**log_width * cage.longer_side
    low, high = np.reshape(cage.bounds, (2, 2))
    line = low - 0.1 * (high - low) + 1.2 * (high - low) * rng.random((count, 2))
    path = shapely.LineString(line)
    assume(path.is_simple and cage.polygon.crosses(path))
    pieces = cut(cage, line, width)
    points = places_in(cage, seed)
    # An end is led out by at most four widths.
    off = shapely.distance(path, shapely.points(points)) > 4 * width
    counts = np.sum([piece.contains(points[off]) for piece in pieces], axis=0)
    assert (counts <= 1).all()
    gone = shapely.points(points[off][counts == 0])
    away = shapely.get_parts(shapely.difference(cage.polygon, path.buffer(4 * width)))
    for part in away:
        if shapely.contains(part, gone).any():
            assert part.area <= width**2  # a scrap
    for piece in pieces:
        Domain.from_cage(piece)


def arm_and_body() -> Cage:
    """A body with an arm drawn along its side: one blob."""
    return Cage(divided(box(-5, -5, 10), 1.0))


@pytest.mark.parametrize("share", [1e-4, 4e-3, 2e-2])
@pytest.mark.parametrize("line", [[[2, -6], [2, 3]], [[-3, 0], [0, 1], [3, 0]]])
def test_maps_of_a_cut_shape_are_certified(line: Any, share: float) -> None:
    """Also for the narrowest slit: a bend of the whole shape is proved."""
    cage = arm_and_body()
    (piece,) = cut(cage, line, share * cage.longer_side)
    domain = Domain.from_cage(piece)
    identity = HarmonicMap.identity(domain)
    z = np.concatenate(domain.offset_cage.loops_complex)
    bent = identity.phi.copy()
    bent[: len(z)] += 0.02 * z**2
    assert certify(identity).certified
    assert certify(HarmonicMap(domain, bent, identity.psi)).certified


@pytest.mark.slow
def test_an_arm_that_was_cut_loose_moves_alone_and_is_certified() -> None:
    cage = arm_and_body()
    (piece,) = cut(cage, [[2, -6], [2, 3]])
    pins = [[3.5, -4.5], [-4, -4], [-4, 4], [4, 4.5]]
    targets = [[-1, -3.5], [-4, -4], [-4, 4], [4, 4.5]]
    pose = glid.Pose(pins, targets, depths=[1, 0, 0, 0])
    whole = glid.solve(Domain.from_cage(cage), pose)
    loose = glid.solve(Domain.from_cage(piece), pose)
    assert loose.certificate.certified
    assert loose.energy - 2 < 0.1 * (whole.energy - 2)  # 2 is an isometry's
    # The hand lies over the body, which has stayed where it was.
    np.testing.assert_allclose(loose.map([[3.5, -4.5]]), [[-1, -3.5]], atol=0.05)
    assert len(loose.map.inverse([[-1, -3.5]], all=True)) == 2
