"""Simplified loops stay the loops of a cage."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from glid_nb.geometry import Cage
from glid_nb.imaging.loops import significance
from glid_nb.imaging.simplify import simplify


def circle(radius: float, n: int = 400, centre=(0.0, 0.0)) -> NDArray[np.float64]:
    t = np.linspace(0, 2 * np.pi, n, endpoint=False)
    return radius * np.stack([np.cos(t), np.sin(t)], axis=1) + centre


def wave(radius: float, height: float, waves: int, n: int = 900) -> NDArray[np.float64]:
    t = np.linspace(0, 2 * np.pi, n, endpoint=False)
    r = radius + height * np.cos(waves * t)
    return r[:, np.newaxis] * np.stack([np.cos(t), np.sin(t)], axis=1)


def area(loop: NDArray[np.float64]) -> float:
    return shapely.Polygon(loop).area


def distance(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Largest distance of a vertex of one loop from the other loop."""
    there = shapely.distance(shapely.points(a), shapely.LinearRing(b)).max()
    return float(max(there, shapely.distance(shapely.points(b), shapely.LinearRing(a)).max()))


class TestSignificance:
    @pytest.mark.parametrize("tolerance", [0.01, 0.3, 2.0, 30.0])
    def test_keeps_within_the_tolerance(self, tolerance):
        loop = wave(100, 20, 5)
        kept = loop[significance(loop) > tolerance]
        assert distance(kept, loop) <= tolerance + 0.05

    def test_corners_matter_and_points_between_do_not(self):
        square = np.array(
            [[0, 0], [5, 0], [10, 0], [10, 10], [4, 10], [0, 10], [0, 1]], dtype=float
        )
        assert (significance(square) > 1e-9).tolist() == [
            True,
            False,
            True,
            True,
            False,
            True,
            False,
        ]

    @pytest.mark.slow
    def test_thresholding_is_the_algorithm_itself(self):
        from skimage.measure import approximate_polygon

        rng = np.random.default_rng(0)
        loop = wave(100, 20, 7, 300) + rng.normal(0, 2, (300, 2))
        values = significance(loop)
        ends = np.flatnonzero(np.isinf(values))
        assert len(ends) == 2
        for tolerance in (0.5, 3, 10):
            low, high = ends
            chains = [loop[low : high + 1], np.concatenate([loop[high:], loop[: low + 1]])]
            expected = np.concatenate([approximate_polygon(c, tolerance)[:-1] for c in chains])
            kept = np.roll(loop, -low, axis=0)[np.roll(values, -low) > tolerance]
            np.testing.assert_array_equal(kept, expected)


class TestTolerance:
    def test_automatic_gives_a_handy_number_of_vertices(self):
        for loop in (wave(200, 60, 5), wave(200, 20, 25), wave(500, 150, 9)):
            result = simplify((loop,), offset=4)
            assert 60 <= len(result.exterior) <= 130
            assert distance(result.exterior, loop) < 0.05 * np.sqrt(area(loop))

    def test_small_holes_keep_their_form(self):
        hole = circle(12, 100, (50, 20))
        result = simplify((wave(500, 150, 9), hole), offset=4)
        assert len(result.holes[0]) >= 6
        assert area(result.holes[0]) > 0.8 * area(hole)

    def test_given(self):
        loop = wave(200, 60, 5)
        counts = [
            len(simplify((loop,), t, min_edge=0, max_edge=np.inf).exterior) for t in (0.1, 1, 8)
        ]
        assert counts[0] > counts[1] > counts[2]
        assert simplify((loop,), 1.0).tolerance == 1

    def test_zero_keeps_all_that_is_not_on_a_line(self):
        loop = wave(100, 20, 5, 200)
        result = simplify((loop,), 0.0, min_edge=0, max_edge=np.inf)
        np.testing.assert_allclose(result.exterior, loop, atol=1e-9)

    @pytest.mark.parametrize("most", [4, 17, 60])
    def test_most_vertices(self, most):
        loop, hole = wave(200, 60, 5), circle(40)
        result = simplify((loop, hole), max_vertices=most + 3)
        assert len(result.exterior) + len(result.holes[0]) <= most + 3
        assert len(result.holes[0]) >= 3
        assert result.notes == ()

    def test_too_few_vertices_for_the_loops(self):
        loops = (circle(100), circle(10, 50, (40, 0)), circle(10, 50, (-40, 0)))
        result = simplify(loops, max_vertices=5)
        Cage(result.exterior, result.holes)
        assert sum(map(len, (result.exterior, *result.holes))) <= 12
        assert any("max_vertices=5 is too few: the loops need" in note for note in result.notes)


class TestRepair:
    def test_a_bent_slit_does_not_cross_itself(self):
        crossings = 0
        t = np.linspace(0, 1, 60)
        for seed in range(20):
            phase, turns = np.random.default_rng(seed).uniform(1, 4, 2)
            bend = 50 + 12 * np.sin(turns * np.pi * t + phase)
            down, up = np.stack([bend, 100 - 90 * t], 1), np.stack([bend + 3, 100 - 90 * t], 1)
            loop = np.concatenate([[[0, 100]], down, up[::-1], [[100, 100], [100, 0], [0, 0]]])
            crossings += not shapely.LinearRing(loop[significance(loop) > 8]).is_simple
            result = simplify((loop,), 8.0, room=3.0, min_edge=0)
            Cage(result.exterior)
        assert crossings > 0, "the loops were too easy"

    def test_the_exterior_does_not_jump_over_a_hole(self):
        # A hole in a bump that the tolerance would flatten.
        t = np.linspace(0, np.pi, 40)
        bump = np.stack([50 + 8 * np.cos(t), 50 + 8 * np.sin(t)], axis=1)
        loop = np.concatenate([[[100, 50]], bump, [[0, 50], [0, 0], [100, 0]]])
        hole = circle(2, 20, (50, 54))
        result = simplify((loop, hole), 10.0, min_edge=0)
        Cage(result.exterior, result.holes)
        assert "would have made the cage meet itself" in result.notes[0]
        assert "kept, for example near (5" in result.notes[0]

    def test_a_thin_ring_stays_a_ring(self):
        result = simplify((circle(100), circle(98)), 15.0, room=1.0)
        Cage(result.exterior, result.holes)
        assert distance(result.exterior, circle(100)) < 4

    @pytest.mark.slow
    @settings(max_examples=40)
    @given(
        st.integers(0, 10**6),
        st.floats(0.01, 60),
        st.one_of(st.none(), st.integers(3, 80)),
        st.floats(0, 5),
    )
    def test_random_loops(self, seed, tolerance, most, offset):
        rng = np.random.default_rng(seed)
        t = np.sort(rng.random(rng.integers(8, 200))) * 2 * np.pi
        t = t[np.diff(t, append=7) > 1e-6]
        spokes = np.stack([np.cos(t), np.sin(t)], axis=1)
        outer = rng.uniform(40, 100, len(t))[:, np.newaxis] * spokes
        # Chords of the spokes' inner ends stay inside, because only the angle between spokes
        # matters.
        inner = 0.2 * outer
        loops = (outer, inner)
        if not (shapely.LinearRing(outer).is_simple and shapely.Polygon(outer, [inner]).is_valid):
            return
        result = simplify(loops, tolerance, offset=offset, max_vertices=most)
        cage = Cage(result.exterior, result.holes)
        if most is not None and not result.notes:
            assert cage.n_vertices <= max(most, 6)


class TestEdges:
    def test_short_edges_are_merged(self):
        square = np.array([[0, 0], [100, 0], [100, 100], [99, 101], [0, 100]], dtype=float)
        square = np.concatenate([square, [[0, 50]]])
        result = simplify((square,), 0.0, min_edge=5, max_edge=np.inf)
        lengths = np.hypot(*(np.roll(result.exterior, -1, axis=0) - result.exterior).T)
        assert lengths.min() > 5
        assert area(result.exterior) == pytest.approx(10_000, rel=0.02)

    def test_no_merging_where_a_hole_is_in_the_way(self):
        # The exterior has a short edge at a tip whose removal would uncover the hole in it.
        tip = np.array([[0, 0], [100, 0], [100, 40], [150, 52], [150, 58], [100, 70], [0, 100]])
        hole = np.array([[147, 54.5], [148, 55], [147, 55.5]])
        result = simplify((tip.astype(float), hole), 0.0, min_edge=10, max_edge=np.inf)
        Cage(result.exterior, result.holes)
        assert area(result.exterior) == pytest.approx(area(tip))

    def test_long_edges_are_divided_evenly(self):
        bar = np.array([[0, 0], [90, 0], [90, 10], [0, 10]], dtype=float)
        result = simplify((bar,), 1.0, max_edge=20)
        lengths = np.hypot(*(np.roll(result.exterior, -1, axis=0) - result.exterior).T)
        np.testing.assert_allclose(np.sort(lengths), [10] * 2 + [18] * 10)
        assert area(result.exterior) == 900

    def test_dividing_respects_most_vertices(self):
        bar = np.array([[0, 0], [90, 0], [90, 10], [0, 10]], dtype=float)
        for most in (4, 7, 10):
            result = simplify((bar,), 1.0, max_edge=2, max_vertices=most)
            assert most - 2 <= len(result.exterior) <= most


class TestEnclosing:
    @pytest.mark.parametrize("tolerance", [1.0, 5.0, 20.0])
    def test_a_circle_is_not_cut_off(self, tolerance):
        loop = circle(100)
        result = simplify((loop,), tolerance)
        cage = shapely.Polygon(result.exterior)
        outside = shapely.Polygon(loop).difference(cage.buffer(0.02)).area
        assert outside < 1e-3 * area(loop)
        assert cage.area < (1 + 0.05 * tolerance) * area(loop)

    def test_holes_are_not_covered_by_less(self):
        outer, hole = circle(100), circle(50)
        result = simplify((outer, hole), 5.0)
        # The cage's hole lies in the picture's hole, so nothing of the shape around it is cut off.
        kept = shapely.Polygon(result.holes[0])
        assert shapely.Polygon(hole).buffer(0.02).contains(kept)

    def test_half_of_the_offset_may_be_used(self):
        loop = circle(100)
        moved = simplify((loop,), 2.0, offset=0.0).exterior
        still = simplify((loop,), 2.0, offset=10.0).exterior
        assert np.hypot(*still.T).max() == pytest.approx(100)
        assert np.hypot(*moved.T).max() > 100.5

    def test_a_spike_moves_by_no_more_than_twice_what_was_cut(self):
        t = np.linspace(-1, 1, 41)
        spike = np.stack([100 - 3 * np.abs(t) ** 0.5 * 20, 2 * t], axis=1)
        loop = np.concatenate([spike, [[0, 60], [-80, 0], [0, -60]]])
        result = simplify((loop,), 2.0)
        assert result.exterior[:, 0].max() < 100 + 2 * 2
