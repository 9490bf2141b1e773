"""The drawing kit: coverage, tints, outlines and curves."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from studies.samples.bezier import along, blend, brush, disc, mirrored, spline, symmetric, tube
from studies.samples.ink import Linear, Sheet

PIXELS_PER_UNIT = 10  # of the sheets below: 200 pixels are 20 units


def sheet() -> Sheet:
    return Sheet(200, 100)


def test_a_fill_covers_its_area_to_a_fraction_of_a_pixel() -> None:
    paper = sheet()
    shape = disc(1.3, -0.7, 2.0)
    paper.fill(shape, "#ff0000")
    alpha = paper.image("#000000")[..., 3] / 255
    assert alpha.sum() / PIXELS_PER_UNIT**2 == pytest.approx(shape.area, rel=2e-3)
    rows, columns = np.nonzero(alpha)
    weights = alpha[rows, columns]
    centre = np.average(columns + 0.5, weights=weights), np.average(rows + 0.5, weights=weights)
    assert centre == pytest.approx((100 + 13, 50 + 7), abs=0.02)


def test_a_hole_in_a_shape_stays_open() -> None:
    paper = sheet()
    paper.fill(disc(0, 0, 3).difference(disc(0, 0, 1)), "#ff0000")
    assert paper.image("#000000")[50, 100].tolist() == [0, 0, 0, 0]


def test_what_lies_off_the_sheet_is_cut_off() -> None:
    paper = sheet()
    paper.fill(disc(10, 5, 1), "#ff0000")
    paper.fill(disc(30, 0, 1), "#ff0000")
    alpha = paper.image("#000000")[..., 3] / 255
    assert alpha.sum() / PIXELS_PER_UNIT**2 == pytest.approx(np.pi / 4, rel=0.01)


def test_tints_shades_and_outlines_leave_the_silhouette_alone() -> None:
    paper = sheet()
    shape = disc(0, 0, 3)
    paper.fill(shape, "#ffffff")
    before = paper.image("#000000")
    paper.fill(disc(2, 0, 3), "#ff0000", blur=0.3, within=shape)
    paper.shade(shape, "#0000ff", depth=0.5, opacity=0.8)
    paper.outline(shape, "#000000", 0.3)
    after = paper.image("#000000")
    assert np.array_equal(before[..., 3], after[..., 3])
    assert not np.array_equal(before, after)


def test_the_outline_is_heavier_away_from_the_light() -> None:
    paper = sheet()
    shape = disc(0, 0, 4)
    paper.fill(shape, "#ffffff")
    paper.outline(shape, "#000000", 0.4)
    column = paper.image("#000000")[:, 100, :3].max(axis=1) < 128
    inside = paper.image("#000000")[:, 100, 3] > 127
    upper, lower = (column & inside)[:50].sum(), (column & inside)[50:].sum()
    assert lower > 1.5 * upper > 0


def test_no_pale_rim_is_left_outside_the_outline() -> None:
    paper = sheet()
    paper.fill(disc(0.03, 0.04, 4), "#ffffff")
    paper.outline(disc(0.03, 0.04, 4), "#000000", 0.4)
    rgba = paper.image("#000000")
    rim = (rgba[..., 3] > 0) & (rgba[..., 3] < 255)
    assert rim.any()
    assert rgba[rim][:, :3].max() <= 8


def test_a_gradient_runs_from_start_to_end() -> None:
    paper = sheet()
    paper.fill(shapely.box(-9, -4, 9, 4), Linear((-9, 0), (9, 0), ("#000000", "#ffffff")))
    row = paper.image("#000000")[50, 10:190, 0].astype(int)
    assert (np.diff(row) >= 0).all()
    assert row[0] < 3
    assert row[-1] > 252
    assert abs(row[len(row) // 2] - 128) < 3


def test_a_spline_passes_through_its_points() -> None:
    points = np.array([[0.0, 0.0], [1.0, 2.0], [4.0, 1.0], [5.0, -2.0]])
    for closed in (False, True):
        curve = spline(points, closed=closed, steps=8)
        gaps = np.linalg.norm(curve[:, None] - points[None], axis=-1).min(axis=0)
        assert gaps.max() < 1e-12
    assert len(spline(points, closed=True, steps=8)) == 4 * 8
    assert len(spline(points, steps=8)) == 3 * 8 + 1


def test_a_straight_tube_is_a_stadium() -> None:
    stadium = tube([(0, 0, 0.5), (2, 0, 0.5), (4, 0, 0.5)])
    assert stadium.area == pytest.approx(4 + np.pi * 0.25, rel=1e-3)


def test_a_brush_stroke_is_thickest_in_the_middle() -> None:
    stroke = brush([(0, 0), (2, 0), (4, 0)], 0.6, tip=0.2)
    widths = [
        stroke.intersection(shapely.LineString([(x, -1), (x, 1)])).length for x in (0.1, 2, 3.9)
    ]
    assert widths[1] == pytest.approx(0.6, rel=0.01)
    assert max(widths[0], widths[2]) < 0.35


def test_along_gives_a_right_handed_frame_at_arc_length() -> None:
    place, tangent, normal = along([(0, 0), (3, 0), (6, 0)], [0.0, 0.5, 1.0])
    assert place == pytest.approx(np.array([[0, 0], [3, 0], [6, 0]]), abs=1e-9)
    assert tangent == pytest.approx(np.tile([1.0, 0.0], (3, 1)), abs=1e-9)
    assert normal == pytest.approx(np.tile([0.0, 1.0], (3, 1)), abs=1e-9)


def test_blend_fills_the_inner_corner_and_keeps_the_rest() -> None:
    cross = [shapely.box(-3, -0.5, 3, 0.5), shapely.box(-0.5, -3, 0.5, 3)]
    sharp, soft = shapely.union_all(cross), blend(cross, 0.4)
    corner = 0.4**2 * (1 - np.pi / 4)
    assert soft.area - sharp.area == pytest.approx(4 * corner, rel=0.02)
    assert soft.buffer(1e-3).contains(sharp)


def test_symmetric_is_its_own_mirror_image() -> None:
    shape = symmetric([(0, 2), (1.5, 1), (1, -1), (0, -1.5)])
    assert shape.is_valid
    assert shape.symmetric_difference(mirrored(shape)).area < 1e-9
