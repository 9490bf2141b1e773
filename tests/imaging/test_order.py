"""One order of the parts of a shape that overlaps itself: pictures, exports and picking agree."""

from __future__ import annotations

import functools
import io
from xml.etree import ElementTree

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from glid_nb.export import animation_bytes, cage_svg, picture_png, textured_mesh
from glid_nb.geometry import Cage, Domain, MeshMap, triangulate
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import PixelFrame
from glid_nb.imaging.mesh import deformed_loops
from glid_nb.imaging.order import Sheets, order_of
from glid_nb.pose import Pose, PoseError

from .test_render import bent, rectangle

pytestmark = pytest.mark.slow

Array = NDArray[np.float64]
HANDLES = np.array([[-8.0, 0.0], [0.0, 0.0], [8.0, 0.0]])
SIZE = (160, 160)


@functools.cache
def bar() -> Domain:
    return Domain.from_cage(Cage(rectangle(18, 1.6, 72)))


@functools.cache
def curled() -> HarmonicMap:
    """The bar beyond a full circle, so that its ends cover the same part of a ring."""
    return bent(bar(), 2 * np.pi / 15)


def posed(*depths: float) -> Pose:
    return Pose(HANDLES, curled()(HANDLES), depths)


def halves() -> NDArray[np.uint8]:
    """Red left, blue right."""
    image = np.full((400, 400, 4), 255, np.uint8)
    image[:, :200, 1:3] = image[:, 200:, :2] = 0
    return image


def source(sheets: Sheets, place: Array) -> Array:
    found = sheets.source(place)
    assert found is not None
    return found


def overlap() -> tuple[Array, Array]:
    """Points of the left end and of the right one with nearly the same images, (k, 2) each."""
    along, across = np.meshgrid(np.linspace(6.6, 8.4, 13), np.linspace(-0.6, 0.6, 5))
    right = np.stack([along, across], axis=-1).reshape(-1, 2)
    left = right - [15, 0]
    np.testing.assert_allclose(curled()(left), curled()(right), atol=0.05)
    return left, right


def in_front(picture: NDArray[np.uint8], frame: PixelFrame) -> Array:
    """For each point of the overlap, whether a picture shows the right end there."""
    x, y = frame.to_pixel(curled()(overlap()[1])).astype(int).T
    red, blue = picture[y, x, 0].astype(int), picture[y, x, 2].astype(int)
    assert (abs(red - blue) > 100).all()
    return blue > red


DEPTHS = [(0.0, 0.0, 0.0), (0.0, 0.0, -0.3), (2.0, 0.0, 1.0)]


@pytest.mark.parametrize("depths", DEPTHS)
def test_pictures_animations_meshes_and_picking_show_the_same_end(
    depths: tuple[float, float, float],
) -> None:
    map, pose, (left, right) = curled(), posed(*depths), overlap()
    wanted = depths[2] >= depths[0]  # without depths the right end is in front
    loop = deformed_loops(map)[0]
    frame = PixelFrame(*SIZE).showing([loop.min(axis=0), loop.max(axis=0)], 0.04)
    with Image.open(io.BytesIO(picture_png(halves(), map, SIZE, "fit", pose))) as picture:
        assert (in_front(np.array(picture), frame) == wanted).all()
    data = animation_bytes(halves(), [map], [pose], size=SIZE[0], marks=False)
    with Image.open(io.BytesIO(data)) as picture:
        frame = PixelFrame(*picture.size).showing([loop.min(axis=0), loop.max(axis=0)], 0.04)
        assert (in_front(np.array(picture.convert("RGBA")), frame) == wanted).all()
    order = order_of(bar().cage, pose)
    assert ((order(right) > order(left)) == wanted).all()
    sheets = Sheets(map, order, halves())
    for place, seen in zip(map(right), right if wanted else left, strict=True):
        np.testing.assert_allclose(source(sheets, place), seen, atol=0.06)
    assert (sheets.hidden(left) == wanted).all()
    assert (sheets.hidden(right) != wanted).all()
    mesh = textured_mesh(halves(), map, 1500, pose=pose)
    gap = np.linalg.norm(mesh.positions[:, :2] - map(right[32:33]), axis=1)
    of_right = mesh.texture_coordinates[:, 0] > 0.5
    low, high = (mesh.positions[np.argmin(gap + 1e3 * other), 2] for other in (of_right, ~of_right))
    assert (high > low) == wanted


def test_a_depth_spreads_around_its_pin_and_leaves_other_limbs_alone() -> None:
    order = order_of(bar().cage, posed(0.0, 0.0, -1.0))
    np.testing.assert_allclose(order.depths(HANDLES), [0, 0, -1], atol=1e-3)
    along = np.stack([np.linspace(0, 8, 30), np.zeros(30)], axis=1)
    assert (np.diff(order.depths(along)) < 1e-9).all()
    assert order.depths([[9.0, 0.8]])[0] < -0.7
    # Without depths the order stays as it was.
    trunk = np.stack([np.linspace(-9, -3, 30), np.zeros(30)], axis=1)
    assert abs(order.depths(trunk)).max() < 0.005
    np.testing.assert_allclose(order(trunk), order_of(bar().cage)(trunk), atol=0.005)


def test_transparent_parts_hide_nothing_and_are_not_picked() -> None:
    left, right = overlap()
    clear = halves()
    clear[:, 200:, 3] = 0
    order = order_of(bar().cage)
    assert Sheets(curled(), order).hidden(left).all()
    sheets = Sheets(curled(), order, clear)
    assert not sheets.hidden(left).any()
    np.testing.assert_allclose(source(sheets, curled()(right[:1])[0]), left[0], atol=0.06)
    nothing = Sheets(curled(), order, 0 * clear)
    np.testing.assert_allclose(source(nothing, curled()(right[:1])[0]), right[0], atol=1e-6)
    assert sheets.source([0.0, 2.4]) is None


def test_a_click_is_answered_by_the_inverse() -> None:
    """To the last bit: one of the preimages that a script gets, and none beside the shape."""
    _, right = overlap()
    sheets = Sheets(curled(), order_of(bar().cage))
    for place in [*curled()(right[::9]), *curled()([[0.0, 0.0], [-9.9, 0.9]]), [0.0, 2.4]]:
        found = curled().inverse([place], all=True).points
        seen = sheets.source(place)
        assert (seen is None) == (not len(found))
        assert seen is None or (found == seen).all(axis=1).any()


def test_maps_of_meshes_are_layered_by_the_same_order() -> None:
    mesh = triangulate(bar().cage, 1500)
    map, (left, right) = MeshMap(mesh, curled()(mesh.vertices)), overlap()
    for depth, front, back in ((0.0, right, left), (-1.0, left, right)):
        sheets = Sheets(map, order_of(bar().cage, posed(0.0, 0.0, depth)))
        np.testing.assert_allclose(source(sheets, map(front)[7]), front[7], atol=1e-6)
        assert sheets.hidden(back).all()
        assert not sheets.hidden(front).any()


def test_a_drawing_of_the_cage_shows_what_is_in_sight() -> None:
    def drawn(pose: Pose) -> dict[str, list[Array]]:
        tree = ElementTree.fromstring(cage_svg(curled(), (400, 400), pose=pose))
        paths = {part.get("id"): part.get("d", "") for part in tree.iter() if part.get("id")}
        parts = {str(name): d.replace("Z", "").replace(",", " ") for name, d in paths.items()}
        return {
            name: [np.array(p.split(), float).reshape(-1, 2) for p in d.split("M")[1:]]
            for name, d in parts.items()
        }

    frame = PixelFrame(400, 400)
    for depth, front in ((0.0, [9.0, 0.0]), (-1.0, [-9.0, 0.0])):
        parts = drawn(posed(0.0, 0.0, depth))
        seen = np.concatenate(parts["in-sight"])
        for end in ([9.0, 0.0], [-9.0, 0.0]):
            gap = np.linalg.norm(seen - frame.to_pixel(curled()([end])), axis=1).min()
            assert (gap < 1) == (end == front)
        assert len(parts["cage"]) == 1
        assert "covered" in parts
    still = cage_svg(HarmonicMap.identity(bar()), (400, 400), pose=Pose(HANDLES, HANDLES))
    assert "in-sight" not in still
    assert "covered" not in still


def test_depths_are_checked() -> None:
    for depths in ([1.0], "ab", [0.0, float("nan"), 0.0], [0.0, 0.0, 101.0], [[0.0, 0.0, 0.0]]):
        with pytest.raises(PoseError, match="depths must be 3 numbers from -100 to 100, one per"):
            Pose(HANDLES, HANDLES, depths)  # type: ignore[arg-type]
