"""Neighbouring panels that one panel could replace."""

import numpy as np
import pytest

from glid_nb.geometry import graded_panels
from glid_nb.geometry.panels import paired, point_distance

from ..support.domains import NAMES, domain


@pytest.mark.parametrize("ratio", [0.5, 1.4, 3.0])
@pytest.mark.parametrize("name", NAMES)
def test_pairs_are_halves_of_one_straight_piece_far_enough_away(name: str, ratio: float) -> None:
    d = domain(name)
    panels = graded_panels(d)
    first = np.flatnonzero(paired(panels, d, ratio))
    second = first + 1
    np.testing.assert_array_equal(panels.next[first], second)
    assert not np.intersect1d(first, second).size
    chords = panels.end - panels.start
    np.testing.assert_allclose(chords[first], chords[second], rtol=1e-8)
    singular = np.concatenate([*d.offset_cage.loops_complex, d.hole_points @ [1, 1j]])
    nearest = point_distance(singular, panels.start[first][:, None], panels.end[second][:, None])
    whole = np.abs(panels.end[second] - panels.start[first])
    assert (whole <= ratio * nearest.min(axis=1, initial=np.inf)).all()


@pytest.mark.parametrize("name", NAMES)
def test_a_larger_ratio_leaves_fewer_panels(name: str) -> None:
    d = domain(name)
    panels = graded_panels(d)
    counts = [paired(panels, d, ratio).sum() for ratio in (0.1, 1.4, 100.0)]
    assert counts[0] <= counts[1] <= counts[2]
    assert counts[2] > 0
