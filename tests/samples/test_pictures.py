"""The bundled pictures have what a cage tracer and a teacher need."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image
from scipy import ndimage
from skimage.measure import label

from glid_nb import samples

HOLES = {"gecko": 0, "teapot": 1, "frog": 2, "monstera": 8, "gingerbread": 0, "bar": 0}


def distance_inside(mask: NDArray[np.bool_]) -> NDArray[np.float64]:
    """The distance from each pixel of a mask to the nearest pixel outside it, in pixels."""
    return np.asarray(ndimage.distance_transform_edt(mask), dtype=np.float64)


def components(mask: NDArray[np.bool_], connectivity: int) -> NDArray[np.int64]:
    return np.asarray(label(mask, connectivity=connectivity), dtype=np.int64)


class Silhouette(NamedTuple):
    """The shape's pixels inside a frame of background, and the labels of its holes."""

    shape: NDArray[np.bool_]
    holes: NDArray[np.int64]
    n_holes: int
    width: int


@pytest.fixture(params=samples.names())
def name(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture
def silhouette(name: str) -> Silhouette:
    shape = np.pad(samples.image(name)[..., 3] > 127, 1)
    ground = components(~shape, 1)
    holes = components(~shape & (ground != ground[0, 0]), 1)
    return Silhouette(shape, holes, int(holes.max()), shape.shape[1] - 2)


def test_the_table_covers_every_sample() -> None:
    assert set(HOLES) == set(samples.names())
    assert {0, 1, 2} < set(HOLES.values())
    assert max(HOLES.values()) >= 5


def test_size_and_file(name: str) -> None:
    path = samples.path(name)
    assert path.stat().st_size < 400_000
    with Image.open(path) as picture:
        assert picture.mode == "RGBA"
        assert 1000 <= max(picture.size) <= 2000


@pytest.mark.slow
def test_image_is_the_file(name: str) -> None:
    image = samples.image(name)
    assert image.dtype == np.uint8
    with Image.open(samples.path(name)) as picture:
        assert np.array_equal(image, np.asarray(picture))


@pytest.mark.slow
def test_one_piece_with_the_holes_it_promises(name: str, silhouette: Silhouette) -> None:
    assert components(silhouette.shape, 2).max() == 1
    assert silhouette.n_holes == HOLES[name]


@pytest.mark.slow
def test_holes_are_open_and_wide(silhouette: Silhouette) -> None:
    room = distance_inside(~silhouette.shape)
    for hole in range(1, silhouette.n_holes + 1):
        assert 2 * room[silhouette.holes == hole].max() >= 0.04 * silhouette.width


@pytest.mark.slow
def test_parts_are_thick(silhouette: Silhouette) -> None:
    """A disc of 3 % of the width reaches everything except the round ends of limbs."""
    radius = 0.015 * silhouette.width
    core = distance_inside(silhouette.shape) >= radius
    reached = distance_inside(~core) < radius + 1
    assert np.count_nonzero(silhouette.shape & ~reached) < 0.01 * silhouette.shape.sum()
    assert components(core, 2).max() == 1


@pytest.mark.slow
def test_limbs_keep_their_distance(silhouette: Silhouette) -> None:
    """No limbs touch if everything grows by 1.25 % of the width."""
    reach = 0.0125 * silhouette.width
    free = components(distance_inside(~silhouette.shape) > reach, 1)
    bays = np.count_nonzero(np.bincount(free.ravel())[1:] > reach**2)
    assert bays == 1 + silhouette.n_holes


@pytest.mark.slow
def test_margins_leave_room_to_move(name: str) -> None:
    rows, columns = np.nonzero(samples.image(name)[..., 3])
    height, width = samples.image(name).shape[:2]
    room = min(rows.min(), height - 1 - rows.max(), columns.min(), width - 1 - columns.max())
    assert room >= 0.115 * max(width, height)


@pytest.mark.slow
def test_edges_are_anti_aliased_and_dark(name: str) -> None:
    rgba = samples.image(name)
    alpha = rgba[..., 3]
    soft = (alpha > 0) & (alpha < 255)
    outline = (alpha == 255) & ndimage.binary_dilation(alpha == 0, iterations=3)
    assert soft.sum() > 0.3 * outline.sum()
    assert rgba[soft][:, :3].max(axis=1).mean() < 80, "the outline's ink reaches the soft edge"


def test_unknown_names_are_refused_with_the_list() -> None:
    with pytest.raises(samples.SampleError, match=r"no sample 'gekko': choose one of gecko, "):
        samples.path("gekko")
    with pytest.raises(samples.SampleError, match=r"no sample '\.\./secret'"):
        samples.image("../secret")


def test_a_sample_is_known_by_its_pixels() -> None:
    pixels = samples.image("frog")
    assert samples.name_of(pixels) == "frog"
    assert samples.name_of(pixels[::-1]) is None
    assert samples.name_of(pixels[:100]) is None
