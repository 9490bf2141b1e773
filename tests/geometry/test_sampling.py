"""The paper's uniform boundary samples."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb.geometry import Cage, GeometryError, uniform_panels

from ..support.cages import cages


def test_a_triangle_with_a_hole_counted_by_hand() -> None:
    # Perimeters 12 and 4, so of 16 samples the loops get ceil(12) = 12 and ceil(4) = 4; the edges
    # 3, 4, 5 get 4 * 12 / 12 and so on, the unit edges one each.
    cage = Cage([[0, 0], [4, 0], [0, 3]], [[[0.5, 0.5], [0.5, 1.5], [1.5, 1.5], [1.5, 0.5]]])
    samples = uniform_panels(cage, 16)
    exterior = [0, 1, 2, 3, 4, 3.2 + 0.6j, 2.4 + 1.2j, 1.6 + 1.8j, 0.8 + 2.4j, 3j, 2j, 1j]
    hole = [0.5 + 0.5j, 0.5 + 1.5j, 1.5 + 1.5j, 1.5 + 0.5j]
    np.testing.assert_allclose(samples.start, exterior + hole, atol=1e-15)
    assert samples.loop.tolist() == [0] * 12 + [1] * 4
    assert samples.next.tolist() == [*range(1, 12), 0, 13, 14, 15, 12]
    assert len(samples) == 16


def test_both_counts_are_rounded_up() -> None:
    # Perimeter 10 + 1: loops get ceil(100 / 11) = 10 and ceil(10 / 11) = 1; edges of length 4 and 1
    # get ceil(4) and ceil(1), every edge of the hole at least one sample.
    hole = np.array([[1, 0.25], [1.25, 0.25], [1.25, 0.5], [1, 0.5]])
    samples = uniform_panels(Cage([[0, 0], [4, 0], [4, 1], [0, 1]], [hole]), 10)
    assert np.bincount(samples.loop).tolist() == [4 + 1 + 4 + 1, 4]
    # A little more: ceil(10 / 11 * 12) = 11 and edges ceil(4.4), ceil(1.1).
    samples = uniform_panels(Cage([[0, 0], [4, 0], [4, 1], [0, 1]], [hole]), 12)
    assert np.bincount(samples.loop).tolist() == [5 + 2 + 5 + 2, 4]


@given(cages(), st.integers(1, 3000))
@settings(max_examples=60)
def test_samples_cover_every_loop(cage: Cage, n: int) -> None:
    samples = uniform_panels(cage, n)
    assert n <= len(samples) <= n + cage.n_vertices + len(cage.loops)
    step = np.abs(samples.start[samples.next] - samples.start)
    assert step.sum() == pytest.approx(cage.perimeter)
    assert step.max() <= cage.perimeter / n * (1 + 1e-9)
    np.testing.assert_array_equal(samples.loop[samples.next], samples.loop)
    np.testing.assert_array_equal(np.sort(samples.next), np.arange(len(samples)))
    assert np.isin(np.concatenate(cage.loops_complex), samples.start).all()


def test_samples_cannot_be_changed() -> None:
    samples = uniform_panels(Cage([[0, 0], [4, 0], [0, 3]]), 100)
    for array in (samples.start, samples.loop, samples.next):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1


def test_the_number_must_be_positive() -> None:
    with pytest.raises(GeometryError, match="at least 1, not 0"):
        uniform_panels(Cage([[0, 0], [4, 0], [0, 3]]), 0)
