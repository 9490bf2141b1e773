"""Geometries through a map and back."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from glid_nb.geometry import Cage, Domain
from glid_nb.harmonic import HarmonicMap, TransportError
from glid_nb.imaging import PixelFrame

from ..support.domains import NAMES, random_map
from .test_inverse import curled, gentle, inside


def blobs(map: HarmonicMap, count: int, radius: float) -> np.ndarray:
    turn = np.exp(2j * np.pi * np.arange(24) / 24)
    z = inside(map.domain, count + 60, 4)[-count:] @ np.array([1, 1j])
    rings = z[:, None] + radius * turn
    return np.asarray(shapely.polygons(np.stack([rings.real, rings.imag], axis=-1)))


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("tolerance", [1e-2, 1e-4])
def test_edges_follow_the_curves_within_the_tolerance(name: str, tolerance: float) -> None:
    map = random_map(name, 0.02, 5)
    line = shapely.LineString(map.domain.cage.exterior)
    made = map.transport(line, tolerance=tolerance).geometry
    dense = shapely.get_coordinates(shapely.segmentize(line, 1e-3))
    assert shapely.distance(made, shapely.points(map(dense))).max() <= tolerance
    back = gentle(name)
    ring = shapely.LineString(back(inside(back.domain, 40)[-2:]))
    ring = shapely.intersection(ring, shapely.Polygon(back(back.domain.cage.exterior)).buffer(-0.1))
    carried = back.inverse.transport(ring, tolerance=tolerance)
    dense = shapely.get_coordinates(shapely.segmentize(ring, 1e-2))
    found = back.inverse.locate(dense)
    gaps = shapely.distance(carried.geometry, shapely.points(found.points))
    assert gaps.max(initial=0) <= tolerance


def test_polygons_go_and_come_back_and_what_lies_outside_is_counted() -> None:
    map = gentle("twin")
    shapes = np.append(blobs(map, 60, 0.2), [shapely.box(90, 90, 91, 91), shapely.Point(-3.5, 0)])
    there = map.transport(shapes)
    assert there.outside.tolist() == [60]
    assert shapely.is_valid(there.geometry).all()
    assert not len(there.overlapping)
    clipped = shapely.intersection(shapes, map.domain.cage.polygon)
    beside = np.flatnonzero(shapely.area(clipped) < shapely.area(shapes) - 1e-6)
    assert there.cut.tolist() == [i for i in beside if i != 60]
    back = map.inverse.transport(there.geometry)
    gap = shapely.hausdorff_distance(back.geometry[:60], clipped[:60])
    assert gap.max() < 10 * there.tolerance
    assert not len(back.outside[back.outside != 60])


def test_geojson_stays_geojson() -> None:
    map = gentle("ring")
    square = shapely.geometry.mapping(shapely.box(1.6, -0.3, 2.2, 0.3))
    data = {
        "type": "FeatureCollection",
        "features": [
            {"type": "Feature", "properties": {"name": "cell"}, "geometry": square},
            {"type": "Feature", "properties": {}, "geometry": None},
        ],
    }
    made = map.transport(data)
    assert made.geometry["features"][0]["properties"] == {"name": "cell"}
    assert shapely.geometry.shape(made.geometry["features"][0]["geometry"]).is_valid
    assert made.geometry["features"][1]["geometry"] is None
    collection = shapely.GeometryCollection(
        [shapely.Point(2, 0), shapely.MultiLineString([[(2, 0), (2.1, 0.1)], [(2, 0), (2, 0.3)]])]
    )
    assert [one.geom_type for one in map.transport(collection).geometry.geoms] == [
        "Point",
        "MultiLineString",
    ]
    assert len(map.transport([np.array([[2, 0], [2.2, 0], [2, 0.2]])]).geometry) == 1


@pytest.mark.parametrize("corner", [(0.3, 0.0), (-0.3, 0.1), (0.02, -0.3)])
def test_holes_that_touch_the_rim_stay_valid(corner: tuple[float, float]) -> None:
    x, y = corner  # on an edge of the square, not at a vertex of it
    bent = curled(2)
    square = shapely.box(-0.3, -0.3, 0.3, 0.3).exterior
    hole = shapely.Polygon(square, [[(x, y), (0.05, 0.1), (-0.05, -0.1)]])
    several = shapely.MultiPolygon([hole, shapely.box(0.6, 0, 0.7, 0.1)])
    assert shapely.is_valid([hole, several]).all()
    there = bent.transport([hole, several])
    assert shapely.is_valid(there.geometry).all()
    assert not len(there.overlapping)
    assert len(there.geometry[0].interiors) == 1
    back = bent.inverse.transport(there.geometry)
    assert shapely.hausdorff_distance(back.geometry[0], hole) < 10 * back.tolerance


def test_an_overlap_is_named() -> None:
    map = curled(2.2 * np.pi)
    whole = map.transport([map.domain.cage.polygon, shapely.box(-1, -0.2, 1, 0.2)])
    assert whole.overlapping.tolist() == [0]


def test_labels_follow_the_picture() -> None:
    map, frame = gentle("ell"), PixelFrame(80, 60)
    rows, columns = np.mgrid[:60, :80]
    labels = (rows // 6 * 14 + columns // 6 + 1).astype(np.uint8)
    made = map.transport(labels, frame=frame).geometry
    place = inside(map.domain, 100)[-30:]
    x, y = np.floor(frame.to_pixel(map(place))).astype(int).T
    u, v = np.floor(frame.to_pixel(place)).astype(int).T
    assert (made[y, x] == labels[v, u]).mean() > 0.7
    back = map.inverse.transport(made, frame=frame).geometry
    assert (back[v, u] == labels[v, u]).mean() > 0.7
    assert (map.transport(np.asfortranarray(labels), frame=frame).geometry == made).all()
    assert (map.transport(labels.tolist(), frame=frame).geometry == made).all()
    with pytest.raises(TransportError, match="the label image is masked"):
        map.transport(np.ma.masked_equal(labels, 3), frame=frame)
    with pytest.raises(TransportError, match="whole numbers, not float64 values"):
        map.transport(labels / 2, frame=frame)
    with pytest.raises(TransportError, match="frame must be the place of pixels"):
        map.transport(labels, frame="here")
    with pytest.raises(TransportError, match="swapped"):
        map.transport(labels, frame=PixelFrame(60, 80))
    with pytest.raises(TransportError, match="needs its place"):
        map.transport(labels)


@pytest.mark.parametrize("inverse", [False, True])
def test_a_field_interpolates_within_its_error(inverse: bool) -> None:
    map, frame = gentle("ell"), PixelFrame(100, 100)
    field = map.displacement_field(frame, (50, 40), inverse=inverse)
    assert np.isfinite(field.values).all()
    assert 0 < field.error < 1
    rng = np.random.default_rng(1)
    z = rng.uniform(-2.4, -0.6, (300, 2))
    pixels = frame.to_pixel(z)
    true = frame.to_pixel(map.inverse(z) if inverse else map(z)) - pixels
    assert np.linalg.norm(field.at(pixels) - true, axis=1).max() <= field.error
    assert field.vectors.shape == (field.known.sum(), 2, 2)


def test_bad_input_is_named() -> None:
    map = HarmonicMap.identity(Domain.from_cage(Cage([[0, 0], [1, 0], [1, 1], [0, 1]])))
    with pytest.raises(TransportError, match="tolerance must be a positive number"):
        map.transport(shapely.Point(0, 0), tolerance=-1)
    with pytest.raises(TransportError, match="polygon 0 must be"):
        map.transport([[[0, 0]]])
    with pytest.raises(TransportError, match="is no geometry"):
        map.transport(3)
    for nothing, told in (
        (shapely.Point(np.nan, 0), r"geometry 0 has a corner at \(nan, 0\)"),
        ([[[0, 0], [np.inf, 0], [0, 1]]], "polygon 0 has coordinates that are not finite"),
        ([np.zeros((4, 3))], r"polygon 0 must be .* the shape is \(4, 3\)"),
        ([np.ma.masked_equal([[0, 1], [2, 1], [0, 5]], 2)], "point 1 of polygon 0 is masked"),
        ({}, 'a geometry is a mapping with a "type"'),
        ({"type": "FeatureCollection", "features": [3]}, "feature 0 .* must be a mapping, not int"),
    ):
        with pytest.raises(TransportError, match=told):
            map.transport(nothing)
    bow = shapely.Polygon([[0, 0], [2, 2], [2, 0], [0, 2]])
    with pytest.raises(TransportError, match="geometry 0 is not valid"):
        map.transport(bow)
    with pytest.raises(TransportError, match="frame must be the place of pixels"):
        map.displacement_field(None)
    with pytest.raises(TransportError, match="shape must be"):
        map.displacement_field(PixelFrame(10, 10), 5)
    with pytest.raises(TransportError, match="shape must be"):
        map.displacement_field(PixelFrame(10, 10), (1, 5))
