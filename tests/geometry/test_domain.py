"""The parts of a domain must fit together; if not, the error says so."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings

from glid_nb.geometry import Cage, Domain, GeometryError

from ..support.cages import box, cages, comb

CAGE = Cage(box(0, 0, 10), [box(2, 2, 2), box(6, 6, 2)])
AROUND = Cage(box(-1, -1, 12), [box(2.5, 2.5, 1), box(6.5, 6.5, 1)])
POINTS = [[3, 3], [7, 7]]


def as_given() -> dict[str, Any]:
    return {
        "cage": CAGE.exterior.tolist(),
        "holes": [hole.tolist() for hole in CAGE.holes],
        "offset": 0.25,
        "offset_cage": AROUND.exterior.tolist(),
        "offset_holes": [hole.tolist() for hole in AROUND.holes],
        "hole_points": POINTS,
    }


def test_the_default_offset_is_a_200th_of_the_longer_side() -> None:
    domain = Domain.from_cage(Cage(box(0, 0, 20)))
    np.testing.assert_allclose(domain.offset_cage.exterior, box(-0.1, -0.1, 20.2), atol=1e-13)
    assert domain.notes == ()


def test_a_wanted_offset_and_its_notes() -> None:
    domain = Domain.from_cage(CAGE, offset=0.5)
    np.testing.assert_allclose(domain.offset_cage.exterior, box(-0.5, -0.5, 11), atol=1e-13)
    assert Domain.from_cage(Cage(comb(3, 0.01)), offset=0.5).notes


def test_sizes_and_complex_views() -> None:
    domain = Domain(CAGE, AROUND, POINTS)
    assert domain.n_holes == 2
    assert domain.n_coefficients == 12 + 2
    assert domain.hole_points_complex.tolist() == [3 + 3j, 7 + 7j]
    for loops, cage in (
        (domain.cage.loops_complex, CAGE),
        (domain.offset_cage.loops_complex, AROUND),
    ):
        assert isinstance(loops, tuple)
        for z, loop in zip(loops, cage.loops, strict=True):
            assert z.dtype == np.complex128
            np.testing.assert_array_equal(np.stack([z.real, z.imag], axis=1), loop)


def test_a_domain_cannot_be_changed_and_keys_a_cache() -> None:
    points = np.array(POINTS, dtype=float)
    domain = Domain(CAGE, AROUND, points)
    points[0] = 100.0
    assert domain.hole_points[0].tolist() == [3.0, 3.0]
    with pytest.raises(ValueError, match="read-only"):
        domain.hole_points[0] = 1.0
    assert {domain: 1}[domain] == 1
    assert domain != Domain(CAGE, AROUND, POINTS)


@pytest.mark.slow
@given(cages())
@settings(max_examples=30)
def test_any_cage_makes_a_domain_that_survives_json(cage: Cage) -> None:
    domain = Domain.from_cage(cage)
    again = Domain.from_dict(json.loads(json.dumps(domain.to_dict())))
    for part in ("cage", "offset_cage"):
        for loop, copy in zip(getattr(domain, part).loops, getattr(again, part).loops, strict=True):
            np.testing.assert_array_equal(loop, copy)
    np.testing.assert_array_equal(domain.hole_points, again.hole_points)
    assert domain.notes == again.notes


# --- from_dict ------------------------------------------------------------------------------------


def test_given_parts_are_used_as_given() -> None:
    domain = Domain.from_dict(as_given())
    for loop, copy in zip(AROUND.loops, domain.offset_cage.loops, strict=True):
        np.testing.assert_array_equal(loop, copy)
    assert domain.hole_points.tolist() == POINTS


def test_missing_parts_are_chosen() -> None:
    data = as_given()
    del data["offset_cage"], data["offset_holes"], data["hole_points"]
    domain = Domain.from_dict(data)
    np.testing.assert_allclose(domain.offset_cage.exterior, box(-0.25, -0.25, 10.5), atol=1e-13)
    assert AROUND.n_holes == domain.n_holes
    del data["offset"]
    domain = Domain.from_dict(data)
    np.testing.assert_allclose(domain.offset_cage.exterior, box(-0.05, -0.05, 10.1), atol=1e-13)


def test_only_hole_points_missing() -> None:
    data = as_given()
    del data["hole_points"]
    np.testing.assert_allclose(Domain.from_dict(data).hole_points, POINTS, atol=0.05)


def test_orientation_of_the_offset_loops_is_normalised_on_its_own() -> None:
    data = as_given()
    data["offset_cage"] = data["offset_cage"][:1] + data["offset_cage"][:0:-1]
    domain = Domain.from_dict(data)
    np.testing.assert_array_equal(domain.offset_cage.exterior, AROUND.exterior)
    np.testing.assert_array_equal(domain.cage.exterior, CAGE.exterior)


def test_vertex_counts_of_the_two_cages_may_differ() -> None:
    data = as_given()
    data["offset_cage"].insert(1, [5, -1.5])
    assert Domain.from_dict(data).n_coefficients == 13 + 2


def test_a_single_note_is_read_as_one() -> None:
    assert Domain.from_dict(as_given() | {"notes": "by hand"}).notes == ("by hand",)
    with pytest.raises(GeometryError, match="'notes' must be a list of sentences, not 3"):
        Domain.from_dict(as_given() | {"notes": 3})


def changed(**changes: Any) -> dict[str, Any]:
    return as_given() | changes


REFUSED = {
    "offset cage through the cage": (
        changed(offset_cage=box(-1, -1, 10.5).tolist()),
        r"the offset of the exterior loop meets the exterior loop itself at \(",
    ),
    "offset cage touches the cage": (
        changed(offset_cage=box(0, -1, 12).tolist()),
        r"the offset of the exterior loop meets the exterior loop itself at \(0, ",
    ),
    "offset cage within the cage": (
        changed(offset_cage=box(1, 1, 8).tolist()),
        r"exterior loop does not enclose the cage: vertex 0 of the exterior loop at \(0, 0\)",
    ),
    "offset cage elsewhere": (
        changed(offset_cage=box(50, 0, 12).tolist(), holes=[], offset_holes=[], hole_points=[]),
        r"exterior loop does not enclose the cage",
    ),
    "offset hole crosses": (
        changed(offset_holes=[box(3, 3, 2).tolist(), box(6.5, 6.5, 1).tolist()]),
        r"the offset of hole 1 meets hole 1 itself",
    ),
    "offset hole around its hole": (
        changed(offset_holes=[box(1, 1, 4).tolist(), box(6.5, 6.5, 1).tolist()]),
        r"offset hole 1 does not lie in hole 1: its vertex 0 at \(1, 1\) is outside",
    ),
    "offset holes in the wrong order": (
        changed(offset_holes=[hole.tolist() for hole in AROUND.holes[::-1]]),
        r"offset hole 1 does not lie in hole 1.*in the order of the holes",
    ),
    "an offset hole is missing": (
        changed(offset_holes=[AROUND.holes[0].tolist()]),
        r"the offset cage has 1 holes and the cage 2; give one offset hole per hole",
    ),
    "the offset cage crosses itself": (
        changed(offset_cage=[[-1, -1], [11, 11], [11, -1], [-1, 11]]),
        r"^offset cage: The outline crosses itself.*the edges 0-1 and 2-3 cross at \(5, 5\)",
    ),
    "offset holes alone": (
        {k: v for k, v in as_given().items() if k != "offset_cage"},
        r"'offset_holes' is given without 'offset_cage'",
    ),
    "a hole point is missing": (
        changed(hole_points=[[3, 3]]),
        r"1 hole points given for a cage with 2 holes; give one per hole",
    ),
    "a hole point without a hole": (
        changed(holes=[], offset_holes=[], hole_points=[[3, 3]]),
        r"1 hole points given for a cage with 0 holes",
    ),
    "a hole point outside": (
        changed(hole_points=[[3, 3], [5, 5]]),
        r"the point of hole 2 at \(5, 5\) does not lie strictly inside offset hole 2",
    ),
    "a hole point between hole and offset hole": (
        changed(hole_points=[[3, 3], [6.25, 7]]),
        r"the point of hole 2 at \(6.25, 7\) does not lie strictly inside",
    ),
    "a hole point on the offset hole": (
        changed(hole_points=[[2.5, 3], [7, 7]]),
        r"the point of hole 1 at \(2.5, 3\) does not lie strictly inside",
    ),
    "NaN": (changed(hole_points=[[3, 3], [np.nan, 7]]), r"the point of hole 2 at \(nan, 7\)"),
    "wrong shape": (
        changed(hole_points=[3, 3]),
        r"hole points must be pairs .*; the shape is \(2,\)",
    ),
    "words": (changed(hole_points=["a", "b"]), r"hole points must be pairs of numbers"),
    "no cage": ({"holes": []}, r"'cage' is missing"),
    "offset": (
        {"cage": CAGE.exterior.tolist(), "offset": -0.5},
        r"offset must be a positive number, not -0.5",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_parts_that_do_not_fit_are_refused(name: str) -> None:
    data, message = REFUSED[name]
    with pytest.raises(GeometryError, match=message):
        Domain.from_dict(data)
