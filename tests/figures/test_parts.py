"""The parts of a figure that a narrow page shows below each other."""

from __future__ import annotations

import io
import json

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from glid_nb import figures
from glid_nb.figures.drawing import PARTS, notebook_png
from glid_nb.figures.parts import parts
from glid_nb.figures.style import CSS_DPI
from glid_nb.harmonic import HarmonicMap
from glid_nb.pose import Pose

from ..support.domains import domain

RING = HarmonicMap.identity(domain("ring"))
POSE = Pose([[6.0, 0.0], [-6.0, 0.0]], [[7.0, 0.0], [-7.0, 0.0]])
CIRCLE = np.exp(1j * np.linspace(0, 2 * np.pi, 40))


def drawn(*found: Figure) -> list[list[float]]:
    for figure in found:
        figure.draw_without_rendering()
    return parts(found)


def test_each_plane_is_a_part_inside_the_figure_with_its_title_and_legend() -> None:
    figure = figures.planes({"a": CIRCLE, "b": 1j}, {"c": CIRCLE}, titles=["one", "two"])
    left, right = np.array(drawn(figure))
    width, height = CSS_DPI * figure.get_size_inches()
    assert left[0] + left[2] <= right[0] + 8  # 4 pixels around each
    assert right[0] + right[2] <= width
    for axes, (x, y, wide, high) in zip(figure.axes, (left, right), strict=True):
        inside = axes.get_position()
        assert x < inside.x0 * width
        assert inside.x1 * width < x + wide
        assert y < (1 - inside.y1) * height - 9  # the title
        assert (1 - inside.y0) * height + 9 < y + high  # the ticks' numbers
    assert left[3] > right[3] + 9, "only the left plane has a legend"


def test_the_colour_bar_and_the_legend_are_parts_below_the_panels() -> None:
    found = np.array(drawn(figures.distortion([RING] * 3, pose=POSE, titles=["a", "b", "c"])))
    assert len(found) == 5
    panels, below = found[:3], found[3:]
    assert (np.diff(panels[:, 0]) > 0).all()
    assert (below[:, 1] > panels[:, 1:4:2].sum(axis=1).max() - 8).all()


def test_a_part_holds_its_panel_in_every_figure() -> None:
    small, large = (
        figures.planes({"a": CIRCLE}, {"b": CIRCLE}, titles=[title, ""])
        for title in ("short", "a title\nof two lines")
    )
    (low,), (high,), (both,) = (
        np.array(drawn(*found))[:1] for found in ((small,), (large,), (small, large))
    )
    assert both[1] == min(low[1], high[1])
    assert both[1] + both[3] == pytest.approx(max(low[1] + low[3], high[1] + high[3]), abs=0.2)


def test_panels_in_rows_are_parts_in_the_order_of_reading() -> None:
    rows = Figure(layout="constrained")
    rows.subplots(2, 2)
    (a, b, c, d) = drawn(rows)
    assert a[0] == c[0] < b[0] == d[0]
    assert a[1] == b[1] < c[1] == d[1]


def test_one_panel_and_panels_that_overlap_have_no_parts() -> None:
    assert drawn(figures.distortion(RING)) == []
    figure = Figure()
    figure.add_axes((0.1, 0.1, 0.5, 0.8))
    figure.add_axes((0.4, 0.1, 0.5, 0.8))
    assert drawn(figure) == []


def test_text_outside_of_the_panels_leaves_a_figure_whole() -> None:
    figure = Figure(layout="constrained")
    figure.subplots(1, 2)
    figure.suptitle("both")
    assert drawn(figure) == []


def test_a_notebooks_picture_names_its_parts() -> None:
    figure = figures.distortion([RING] * 2, titles=["a", "b"])
    with Image.open(io.BytesIO(notebook_png(figure)[0])) as picture:
        assert json.loads(picture.info[PARTS]) == parts([figure])
    with Image.open(io.BytesIO(notebook_png(figures.distortion(RING))[0])) as picture:
        assert PARTS not in picture.info


def test_matplotlibs_own_figures_have_parts() -> None:
    figure = Figure(layout="constrained")
    figure.subplots(1, 2)
    assert len(drawn(figure)) == 2
