"""The offset cage keeps its promises, on orderly, nasty and random cages."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb.geometry import Cage, GeometryError, Offset, hole_points, offset_cage
from glid_nb.geometry.offset import CLEARANCE, MITRE_LIMIT

from ..support.cages import (
    SQUARE,
    blunt_notch,
    box,
    cages,
    comb,
    nasty_cages,
    needle,
    regular,
    spiral,
    star_loop,
)


def closed(loop: np.ndarray) -> np.ndarray:
    return np.vstack([loop, loop[:1]])


def check_promises(cage: Cage, offset: Offset, distance: float) -> None:
    """Everything that the docstring of offset_cage promises, checked by other means."""
    domain = shapely.Polygon(cage.exterior, cage.holes)
    around = shapely.Polygon(offset.cage.exterior, offset.cage.holes)
    assert around.is_valid
    assert around.contains_properly(domain)
    assert len(offset.distances) == len(cage.loops)
    for loop, moved, reached in zip(cage.loops, offset.cage.loops, offset.distances, strict=True):
        assert moved.shape == loop.shape
        assert (reached > 0).all()
        assert (reached <= distance * (1 + 1e-9)).all()
        edges = shapely.linestrings(np.stack([moved, np.roll(moved, -1, axis=0)], axis=1))
        clearance = shapely.distance(edges, domain.boundary)
        needed = CLEARANCE * np.minimum(reached, np.roll(reached, -1))
        assert (clearance >= needed * (1 - 1e-6)).all()
        # Mitres of outer corners have a limited length.
        before, after = loop - np.roll(loop, 1, axis=0), np.roll(loop, -1, axis=0) - loop
        outer = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0] > 0
        far = np.hypot(*(moved - loop).T)
        assert (far[outer] <= MITRE_LIMIT * distance * (1 + 1e-9)).all()
    points = hole_points(offset.cage)
    for point, hole in zip(points, offset.cage.holes, strict=True):
        region = shapely.Polygon(hole)
        room = region.boundary.distance(shapely.Point(point))
        assert region.contains(shapely.Point(point))
        widest = shapely.length(shapely.maximum_inscribed_circle(region))
        assert room >= 0.9 * widest


def test_a_square_moves_outward_and_its_hole_inward() -> None:
    cage = Cage(box(0, 0, 10), [box(3, 3, 4)])
    offset = offset_cage(cage, 0.5)
    np.testing.assert_allclose(offset.cage.exterior, box(-0.5, -0.5, 11), atol=1e-14)
    np.testing.assert_allclose(
        offset.cage.holes[0], np.array([[3.5, 3.5], [3.5, 6.5], [6.5, 6.5], [6.5, 3.5]])
    )
    assert offset.notes == ()
    for distances in offset.distances:
        np.testing.assert_allclose(distances, 0.5, rtol=1e-12)


def test_a_regular_polygon_grows_by_the_distance() -> None:
    n, d = 12, 0.1
    offset = offset_cage(Cage(regular(n)), d)
    grown = regular(n, 1 + d / np.cos(np.pi / n))
    np.testing.assert_allclose(offset.cage.exterior, grown, atol=1e-14)


def test_a_comfortable_offset_is_an_exact_mitre_everywhere() -> None:
    cage = Cage(comb(4, 2.0))
    offset = offset_cage(cage, 0.3)
    for loop, moved in zip(cage.loops, offset.cage.loops, strict=True):
        for a, b, p, q in zip(
            loop, np.roll(loop, -1, axis=0), moved, np.roll(moved, -1, axis=0), strict=True
        ):
            direction = (b - a) / np.hypot(*(b - a))
            outward = np.array([direction[1], -direction[0]])
            np.testing.assert_allclose([(p - a) @ outward, (q - a) @ outward], 0.3, atol=1e-12)
    assert offset.notes == ()


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.0005, 0.005, 0.1])
@pytest.mark.parametrize("name", nasty_cages())
def test_nasty_cages(name: str, share: float) -> None:
    cage = nasty_cages()[name]
    distance = share * cage.longer_side
    check_promises(cage, offset_cage(cage, distance), distance)


@pytest.mark.slow
@given(cages(), st.sampled_from([1e-4, 0.005, 0.05, 0.5, 3.0]))
@settings(max_examples=80)
def test_random_cages(cage: Cage, share: float) -> None:
    distance = share * cage.longer_side
    check_promises(cage, offset_cage(cage, distance), distance)


def test_a_passage_is_shared_between_its_two_sides() -> None:
    gap = 0.02
    cage = Cage(comb(2, gap))
    offset = offset_cage(cage, 0.05)
    facing = offset.cage.exterior[3:7]  # down one side of the gap and up the other
    assert facing[0, 0] - facing[3, 0] > 0.2 * gap
    assert facing[1, 0] - facing[2, 0] > 0.2 * gap
    # ... and the far side of the comb keeps all of it.
    np.testing.assert_allclose(offset.distances[0][[0, 1]], 0.05)


def test_a_narrow_place_shrinks_the_offset_there_only_and_is_reported() -> None:
    cage = Cage(comb(3, 0.2, width=2.0))
    offset = offset_cage(cage, 0.3)
    assert len(offset.notes) == 1
    note = offset.notes[0]
    least = int(np.argmin(offset.distances[0]))
    assert note.startswith("exterior loop: the offset 0.3 was reduced at ")
    assert f"at vertex {least} " in note
    reduced = int(np.sum(offset.distances[0] < 0.9 * 0.3))
    assert f"reduced at {reduced} of {cage.n_vertices} vertices" in note
    assert 0.05 < offset.distances[0].min() < 0.1


def test_a_hole_too_small_shrinks_its_own_offset_only() -> None:
    cage = Cage(box(0, 0, 10), [box(2, 2, 0.1), box(6, 6, 2)])
    offset = offset_cage(cage, 0.2)
    assert [note.split(":")[0] for note in offset.notes] == ["hole 1"]
    assert "reduced everywhere" in offset.notes[0]
    assert 0.01 < offset.distances[1].max() < 0.05
    np.testing.assert_allclose(offset.distances[2], 0.2)


def test_neighbouring_holes_do_not_narrow_each_other() -> None:
    cage = Cage(box(0, 0, 10), [box(1, 1, 2), box(3.001, 1, 2), box(1e-3, 5, 2)])
    offset = offset_cage(cage, 0.2)
    assert offset.notes == ()


def test_the_mitre_of_a_spike_is_cut_back() -> None:
    cage = Cage(needle(0.01))
    offset = offset_cage(cage, 0.1)
    tip = 3
    assert cage.exterior[tip].tolist() == [10.0, 2.0]
    np.testing.assert_allclose(offset.cage.exterior[tip], [10 + MITRE_LIMIT * 0.1, 2], atol=1e-12)


def test_a_tiny_edge_at_the_bottom_of_a_notch_shrinks_the_offset_there_only() -> None:
    cage = Cage(blunt_notch(0.01))
    distances = offset_cage(cage, 0.1).distances[0]
    assert (distances[[4, 5]] < 0.01).all()
    np.testing.assert_allclose(distances[[0, 1, 2, 3, 6, 7]], 0.1)


def test_long_passages_are_seen_along_their_whole_length() -> None:
    # If offsets of neighbouring turns passed through each other, they would meet only at the ends.
    cage = Cage(spiral(6, 0.05, 48))
    distance = 0.12
    offset = offset_cage(cage, distance)
    check_promises(cage, offset, distance)
    assert offset.distances[0].min() > 0.2 * 0.05


@pytest.mark.parametrize("loop", [star_loop(np.random.default_rng(0), 1000, 0.9), comb(250, 0.05)])
def test_a_thousand_vertices(loop: np.ndarray) -> None:
    cage = Cage(loop)
    distance = 0.005 * cage.longer_side
    check_promises(cage, offset_cage(cage, distance), distance)


def test_moving_turning_and_scaling_commute_with_the_offset() -> None:
    cage = Cage(comb(3, 0.1), [box(0.2, 2, 0.3)])
    turn = 1e3 * np.array([[0.6, -0.8], [0.8, 0.6]])
    shift = np.array([500.0, -200.0])
    other = Cage(cage.exterior @ turn.T + shift, [cage.holes[0] @ turn.T + shift])
    plain, turned = offset_cage(cage, 0.2), offset_cage(other, 200.0)
    for loop, moved in zip(plain.cage.loops, turned.cage.loops, strict=True):
        np.testing.assert_allclose(loop @ turn.T + shift, moved, atol=1e-8)


@pytest.mark.parametrize("distance", [0, -1.0, np.nan, np.inf, "wide", None])
def test_the_distance_must_be_a_positive_number(distance: object) -> None:
    with pytest.raises(GeometryError, match="offset must be a positive number, not"):
        offset_cage(Cage(SQUARE), distance)  # pyright: ignore[reportArgumentType]


def test_a_passage_below_rounding_is_refused_with_its_place() -> None:
    cage = Cage(comb(2, 2e-11, height=1.0))
    with pytest.raises(GeometryError, match=r"offset cage.*passage"):
        offset_cage(cage, 0.1)


@pytest.mark.slow
@given(cages())
@settings(max_examples=30)
def test_offset_cages_can_be_offset_again(cage: Cage) -> None:
    distance = 0.002 * cage.longer_side
    once = offset_cage(cage, distance)
    check_promises(once.cage, offset_cage(once.cage, distance), distance)


def test_closed_form_hole_point() -> None:
    cage = Cage(box(0, 0, 10), [regular(40, 1.0, (3, 4)), [[6, 1], [9, 1], [9, 1.001]]])
    points = hole_points(cage)
    np.testing.assert_allclose(points[0], [3, 4], atol=0.05)
    assert shapely.Polygon(cage.holes[1]).contains(shapely.Point(points[1]))
    assert hole_points(Cage(SQUARE)).shape == (0, 2)
