"""Distances and crossings of many segments, against shapely."""

from __future__ import annotations

import numpy as np
import shapely
from hypothesis import given
from hypothesis import strategies as st

from glid_nb.geometry.panels import segment_distance, segments_cross

# Small integers make parallel, touching and degenerate segments frequent.
_ENDS = st.lists(st.integers(-4, 4), min_size=8, max_size=8)


@given(_ENDS)
def test_agree_with_shapely(numbers: list[int]) -> None:
    x = np.array(numbers, dtype=float)
    a, b, c, d = (x[:4] + 1j * x[4:])[:, None]
    lines = [
        shapely.LineString([[p[0].real, p[0].imag] for p in ends]) for ends in ((a, b), (c, d))
    ]
    assert np.isclose(segment_distance(a, b, c, d)[0], lines[0].distance(lines[1]), atol=1e-12)
    # Crossing, no end on either: what DE-9IM calls "crosses", unless an end lies on a segment.
    ends_on = any(
        line.distance(shapely.Point(end[0].real, end[0].imag)) == 0
        for line, ends in ((lines[0], (c, d)), (lines[1], (a, b)))
        for end in ends
    )
    assert segments_cross(a, b, c, d)[0] == (lines[0].intersects(lines[1]) and not ends_on)
