"""Meshes: orientations against rational numbers, slivers, and turns round vertices."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import glid_nb as glid

TRIANGLE = [[0, 1, 2]]
UNIT = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]


def exact(points: Any) -> Fraction:
    (ax, ay), (bx, by), (cx, cy) = [[Fraction(one) for one in p] for p in points]
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)


def verdict_of(value: Fraction) -> str:
    return "folds" if value < 0 else ("collapses" if value == 0 else "proved")


NUMBER = st.floats(allow_nan=False, allow_infinity=False) | st.integers(-3, 3).map(float)


@given(st.lists(st.tuples(NUMBER, NUMBER), min_size=3, max_size=3))
@settings(max_examples=80)
def test_every_sign_is_that_of_rational_numbers(points: list[tuple[float, float]]) -> None:
    audit = glid.audit(points, source=UNIT, triangles=TRIANGLE)
    assert audit.verdict == verdict_of(exact(points))


def test_slivers_whose_floating_signs_are_wrong() -> None:
    """Kettner et al. (2008): points near a line, a few units of the last place apart."""
    wrong, seen = 0, set()
    b, c = np.array([12.0, 12.0]), np.array([24.0, 24.0])
    for i in range(32):
        for j in range(32):
            a = np.array([0.5 + i * 2.0**-53, 0.5 + j * 2.0**-53])
            truth = verdict_of(exact([a, b, c]))
            naive = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
            wrong += verdict_of(Fraction(naive)) != truth
            audit = glid.audit([a, b, c], source=UNIT, triangles=TRIANGLE)
            assert audit.verdict == truth
            seen.add(truth)
    assert wrong > 50
    assert seen == {"proved", "folds", "collapses"}


@pytest.mark.parametrize("scale", [5e-324, 1e-308, 1e-200, 1e-8, 1.0, 1e8, 1e150, 1e300])
def test_at_every_scale(scale: float) -> None:
    points = np.array([[0, 0], [3, 1], [1, 2]]) * scale
    assert glid.audit(points, source=UNIT, triangles=TRIANGLE).proved
    assert glid.audit(points[::-1], source=UNIT, triangles=TRIANGLE).verdict == "folds"
    audit = glid.audit(points, source=points, triangles=TRIANGLE)
    assert audit.smallest == pytest.approx(1.0)


def test_integers_are_exact() -> None:
    big = 2**60
    points = np.array([[0, 0], [big, big + 1], [big - 1, big]])
    audit = glid.audit(points, source=np.array(UNIT).astype(int), triangles=TRIANGLE)
    assert audit.verdict == verdict_of(exact(points.tolist())) == "proved"


def test_the_determinant_is_a_quotient_and_clockwise_sources_are_fine() -> None:
    source = np.array(UNIT)[::-1]
    audit = glid.audit(3 * source, source=source, triangles=TRIANGLE)
    assert (audit.verdict, audit.smallest) == ("proved", 9.0)
    assert audit.lower_bound == pytest.approx(9.0)
    mirrored = glid.audit(source * [-1, 1], source=source, triangles=TRIANGLE)
    assert mirrored.determinant == -1.0


def fan(n: int) -> tuple[Any, Any, Any]:
    """A wheel of n triangles, and the same wound twice round its centre."""
    angle = 2 * np.pi * np.arange(n) / n
    once, twice = ([np.cos(k * angle), np.sin(k * angle)] for k in (1, 2))
    centre = np.zeros((1, 2))
    triangles = [[0, 1 + k, 1 + (k + 1) % n] for k in range(n)]
    return (
        np.vstack([centre, np.transpose(once)]),
        triangles,
        np.vstack([centre, np.transpose(twice)]),
    )


@pytest.mark.parametrize("n", [5, 6, 9])
def test_images_that_wind_twice_round_a_vertex(n: int) -> None:
    source, triangles, images = fan(n)
    audit = glid.audit(images, source=source, triangles=triangles)
    assert audit.verdict == "folds"
    assert (audit.folded, audit.determinant) == (0, None)
    assert "wind 2 times" in audit.message
    assert glid.audit(2 * source, source=source, triangles=triangles).proved
    # Cut open, the same images are those of a strip that overlaps itself.
    assert glid.audit(images, source=source, triangles=triangles[1:]).proved


def test_a_whole_mesh_that_is_mirrored_says_so() -> None:
    source, triangles, _ = fan(6)
    audit = glid.audit(source * [-1, 1], source=source, triangles=triangles)
    assert "mirrored" in audit.message


def test_one_turned_triangle_is_found() -> None:
    source, triangles, _ = fan(6)
    images = source.copy()
    images[2] *= -0.1
    audit = glid.audit(images, source=source, triangles=triangles)
    assert audit.folded == 2
    assert audit.folded_area == pytest.approx(np.sqrt(3) / 2)
    np.testing.assert_array_equal(audit.signs, [-1, -1, 1, 1, 1, 1])


def test_a_map_of_this_package() -> None:
    mesh = glid.triangulate(glid.Cage([[0, 0], [4, 0], [4, 2], [0, 2]]), 30)
    assert glid.audit(glid.MeshMap(mesh, 2 * mesh.vertices)).proved


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"source": [[0, 0], [1, 1], [2, 2]]}, "triangle 0 of the source.* has no area"),
        ({"triangles": [[0, 1, 3]]}, r"triangles\[0, 2\] is 3; the mesh has the vertices 0 to 2"),
        ({"triangles": [[0, 1, -1]]}, r"triangles\[0, 2\] is -1"),
        ({"triangles": [[0.0, 1.0, 2.0]]}, "whole numbers"),
        ({"triangles": np.zeros((0, 3), int)}, "no triangles"),
        ({"triangles": None}, "a mesh needs triangles, too"),
        ({"source": [[0, 0], [1, 0], [0, 1], [5, 5]]}, "4 vertices, and there are 3 images"),
        ({"source": [[0, 0], [1, 0], [0, np.nan]]}, r"source\[2, 1\] is nan"),
        ({"source": np.ma.masked_equal(UNIT, 1)}, "source must be .* but row 1 is masked"),
        ({"source": [[0, 0, 0]] * 3}, r"source must be \(n, 2\)"),
    ],
)
def test_what_cannot_be_read(given: dict[str, Any], message: str) -> None:
    with pytest.raises(glid.InputError, match=message):
        glid.audit(UNIT, **{"source": UNIT, "triangles": TRIANGLE, **given})
