"""Offset cages get more vertices where edges are long compared with the shape's width."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings

from glid_nb import samples
from glid_nb.geometry import Cage, Domain, GeometryError
from glid_nb.geometry.offset import offset_cage
from glid_nb.imaging import read_image, trace

from ..support.cages import box, cages


def bar(width: float) -> Cage:
    return Cage([[-10, -width / 2], [10, -width / 2], [10, width / 2], [-10, width / 2]])


def test_the_long_edges_of_a_bar_get_a_vertex_every_half_width() -> None:
    offset = Domain.from_cage(bar(2)).offset_cage.exterior
    assert len(offset) == 4 + 2 * 19
    long = offset[offset[:, 1] < 0]
    assert np.ptp(np.diff(long[:, 0])) < 1e-12
    assert np.diff(long[:, 0]).max() < 1.02


def test_no_piece_is_shorter_than_a_50th_of_the_shape() -> None:
    offset = Domain.from_cage(bar(1e-3)).offset_cage.exterior
    assert len(offset) == 4 + 2 * 49


def test_pieces_are_as_long_as_the_shape_is_wide_there() -> None:
    wedge = Domain.from_cage(Cage([[0, 0], [20, 0], [0, 4]])).offset_cage.exterior
    pieces = np.diff(wedge[: np.argmax(wedge[:, 0]) + 1, 0])
    assert len(pieces) > 8
    assert (np.diff(pieces) < 1e-9).all()
    assert pieces[0] > 3 * pieces[-1]


def test_a_long_slit_divides_the_shape_around_it_not_itself_alone() -> None:
    slit = Cage([[-10, -1], [10, -1], [10, 1], [-10, 1]], [[[-9, -0.1], [9, -0.1], [9, 0.1]]])
    outer, hole = Domain.from_cage(slit).offset_cage.loops
    assert len(outer) > 40
    assert len(hole) > 40


@pytest.mark.parametrize("cage", [Cage(box(0, 0, 1)), bar(8)])
def test_short_edges_stay_whole(cage: Cage) -> None:
    assert Domain.from_cage(cage).offset_cage.n_vertices == cage.n_vertices


@pytest.mark.slow
@pytest.mark.parametrize("name", samples.names())
def test_traced_cages_keep_what_they_have(name: str) -> None:
    cage = trace(read_image(samples.path(name))).cage
    assert Domain.from_cage(cage).offset_cage.n_vertices == cage.n_vertices


@given(cage=cages())
@settings(max_examples=25)
def test_the_vertices_of_the_whole_offset_cage_are_among_the_others(cage: Cage) -> None:
    try:
        whole = offset_cage(cage, 0.005 * cage.longer_side).cage
    except GeometryError:
        return
    for loop, more in zip(whole.loops, Domain.from_cage(cage).offset_cage.loops, strict=True):
        places: Any = [np.flatnonzero((more == point).all(axis=1)) for point in loop]
        assert np.concatenate(places).tolist() == sorted(np.concatenate(places))
        assert all(len(place) == 1 for place in places)
        # The pieces lie along each edge, in order: the loop is as long as before.
        lengths = [np.linalg.norm(np.roll(p, -1, axis=0) - p, axis=1).sum() for p in (loop, more)]
        assert lengths[0] == pytest.approx(lengths[1], rel=1e-12)
