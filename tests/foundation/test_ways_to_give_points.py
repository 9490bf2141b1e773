"""Loops, points and handles as people give them: accepted as meant, or refused with the remedy."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely

from glid_nb import figures
from glid_nb.geometry import Cage, Domain, GeometryError
from glid_nb.harmonic import HarmonicMap
from glid_nb.harmonic.map import MapError
from glid_nb.imaging import PixelFrame
from glid_nb.pose import Pose, PoseError
from glid_nb.session.problem import Problem

RING = [[-10, -3], [10, -3], [10, 3], [-10, 3]]
HOLE = [[-1, -1], [-1, 1], [1, 1], [1, -1]]
CLOSED = [*RING, RING[0]]
WITH_HOLE = Cage(RING, [HOLE])
FILE = {"cage": RING, "handles": [[-8, 0], [8, 0]], "targets": [[-8, 0], [8, 1]]}


@pytest.mark.parametrize(
    "given",
    [
        lambda: Cage(CLOSED, [[*HOLE, HOLE[0]]]),
        lambda: Cage([RING, HOLE]),
        lambda: Cage([np.array(CLOSED), np.array(HOLE)]),
        lambda: Cage(shapely.Polygon(RING, [HOLE])),
        lambda: Cage(shapely.MultiPolygon([shapely.Polygon(RING, [HOLE])])),
        lambda: Cage(shapely.LinearRing(RING), [shapely.LinearRing(HOLE)]),
        lambda: Cage(shapely.Polygon(RING), [HOLE]),
        lambda: Cage(RING, np.array(HOLE)),
        lambda: Cage(zip(*np.transpose(RING), strict=True), [iter(HOLE)]),
        lambda: Cage(np.asfortranarray(RING), [np.asfortranarray(HOLE)]),
        lambda: Cage(np.ma.array(RING), (tuple(map(tuple, HOLE)),)),
    ],
)
def test_a_cage_is_made_of_rings_in_every_common_form(given: Callable[[], Cage]) -> None:
    cage = given()
    assert cage.equals(WITH_HOLE) or shapely.equals(cage.polygon, WITH_HOLE.polygon)
    assert [len(loop) for loop in cage.loops] == [4, 4]


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (lambda: Cage([RING, RING]), "Hole 1 touches the outline"),
        (lambda: Cage(shapely.Point(1, 2)), "one polygon, not of a Point"),
        (lambda: Cage(shapely.Polygon()), "the polygon is empty"),
        (
            lambda: Cage(shapely.MultiPolygon([shapely.box(0, 0, 1, 1), shapely.box(2, 0, 3, 1)])),
            "not of a MultiPolygon of 2 parts; give one part",
        ),
        (lambda: Cage(shapely.Polygon(RING, [HOLE]), [HOLE]), "1 holes come with the exterior and"),
        (lambda: Cage(WITH_HOLE), "it is a cage already"),
        (lambda: Cage(np.ma.masked_where(np.eye(4, 2) > 0, RING)), "vertex 0 is .nan"),
        (lambda: Cage([[0, 0], [1, 0], [0, 0]]), "the last vertex 2 repeats vertex 0"),
    ],
)
def test_what_makes_no_cage_is_refused(given: Callable[[], Cage], message: str) -> None:
    with pytest.raises(GeometryError, match=message):
        given()


def test_masked_points_are_missing_points() -> None:
    masked = np.ma.masked_equal([[0.0, 2], [5, 0]], 5)
    with pytest.raises(PoseError, match=r"handles\[1\] is \(nan, 0\)"):
        Pose(masked, [[0, 0], [1, 1]])
    angles = np.ma.array([0.5, 9e9], mask=[False, True])
    assert Pose(RING[:2], RING[:2], angles=angles).oriented.tolist() == [True, False]
    assert WITH_HOLE.contains(masked).tolist() == [True, False]
    map = HarmonicMap.identity(Domain.from_cage(Cage(RING)))
    for points in (masked, np.ma.array([1 + 1j], mask=[True])):
        with pytest.raises(MapError, match=r"point [01] is masked"):
            map(points)


@pytest.mark.parametrize(
    "encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "utf-32"]
)
def test_files_of_every_unicode_encoding_are_read(tmp_path: Path, encoding: str) -> None:
    path = tmp_path / "problem.json"
    path.write_bytes(json.dumps({**FILE, "names": ["é", "ü"]}).encode(encoding))
    assert Problem.load(path).pose.targets.tolist() == FILE["targets"]
    path.write_bytes('{"note": "é"}'.encode("latin-1"))
    with pytest.raises(ValueError, match="neither UTF-8 nor UTF-16"):
        Problem.load(path)


def refused(handles: Any, cage: Cage = WITH_HOLE) -> str:
    with pytest.raises(PoseError) as caught:
        Pose(handles, handles).check_inside(Domain.from_cage(cage))
    return str(caught.value)


def test_a_handle_just_outside_is_told_with_its_distance() -> None:
    text = refused([[5, 0], [10 + 1e-9, 0]])
    assert text.startswith("handle 1 at (10.000000001, 0) lies outside the domain, by 1e-09 units")
    assert text.endswith("move it inside and out of its holes, or remove it")
    assert "by 1 units" in refused([[0, 0.0]])


@pytest.mark.parametrize(
    ("handles", "hint"),
    [
        (
            [[120, 200], [400, 210]],
            "PixelFrame(width, height).to_world(handles), (row",
        ),
        (
            [[2, -8], [2, 8]],
            "x and y look swapped, because all handles would lie inside as handles[:, ::-1]",
        ),
        ([[50, -80], [20, 80]], "and y from -3 to 3"),
    ],
)
def test_handles_in_other_coordinates_are_recognised(handles: Any, hint: str) -> None:
    text = refused(handles)
    assert "world coordinates, x right and y up: the shape spans x from -10 to 10 and y" in text
    assert hint in text


def test_handles_upside_down_are_recognised() -> None:
    low = Cage([[-10, -6], [10, -6], [10, -1], [-10, -1]])
    assert (
        "y looks upside down, because all handles would lie inside as handles * [1, -1]"
        in refused([[-5, 2], [5, 3]], low)
    )


@pytest.mark.parametrize(("order", "index"), [((0, 1), ""), ((1, 0), "[:, ::-1]")])
def test_pixels_of_a_problem_with_a_picture_are_recognised(
    order: tuple[int, int], index: str
) -> None:
    frame = PixelFrame(640, 480)
    pixels = frame.to_pixel(FILE["handles"])[:, order]
    data = {**FILE, "handles": pixels.tolist(), "image_size_px": [640, 480]}
    with pytest.raises(PoseError) as caught:
        Problem.from_dict(data)
    assert "the picture of 640 x 480 pixels spans x from -10 to 10" in str(caught.value)
    assert str(caught.value).endswith(f"PixelFrame(640, 480).to_world(handles{index})")
    call = str(caught.value).rpartition(": ")[2]
    handles = eval(call, {"PixelFrame": PixelFrame, "handles": pixels})
    np.testing.assert_allclose(handles, FILE["handles"])


def test_convergence_takes_a_result_or_several() -> None:
    class Other:
        pass

    for wrong in (Other(), [Other()], {"a": Other()}, "ab"):
        with pytest.raises(TypeError, match="Result"):
            figures.convergence(wrong)  # type: ignore[arg-type]
