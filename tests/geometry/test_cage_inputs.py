"""What a cage can be made of: pairs, complex numbers, shapely, GeoJSON."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import shapely

from glid_nb.geometry import Cage
from glid_nb.geometry._loops import GeometryError

RING = np.array([[-10.0, -3.0], [10.0, -3.0], [10.0, 3.0], [-10.0, 3.0]])
HOLE = 0.2 * RING
POLYGON = shapely.Polygon(RING, [HOLE])
GEOJSON = POLYGON.__geo_interface__


@pytest.mark.parametrize(
    "given",
    [
        (RING, [HOLE]),
        (RING, HOLE),
        (RING, shapely.Polygon(HOLE)),
        ([RING, HOLE],),
        ([RING.tolist(), HOLE.tolist()],),
        (RING @ [1, 1j], [HOLE @ [1, 1j]]),
        (POLYGON,),
        (shapely.force_3d(POLYGON, 7.0),),
        (GEOJSON,),
        ({"type": "Feature", "properties": {}, "geometry": GEOJSON},),
        (np.vstack([RING, RING[:1] + 1e-9]), [HOLE]),
    ],
    ids=range(11),
)
def test_all_give_the_same_cage(given: tuple[Any, ...]) -> None:
    cage = Cage(*given)
    assert cage.n_holes == 1
    assert cage.n_vertices == 8
    assert cage.area == pytest.approx(120 * (1 - 0.04))


def test_no_holes() -> None:
    assert Cage(RING, None).n_holes == 0


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (shapely.Polygon(), "the polygon is empty"),
        (
            shapely.MultiPolygon([POLYGON, shapely.Point(40, 0).buffer(1)]),
            "MultiPolygon of 2 parts",
        ),
        ({"type": "Feature", "geometry": None}, "not of a None"),
        (shapely.Point(0, 0), "not of a Point"),
    ],
    ids=range(4),
)
def test_other_shapes_are_refused_by_name(given: Any, message: str) -> None:
    with pytest.raises(GeometryError, match=message):
        Cage(given)
