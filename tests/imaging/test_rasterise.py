"""Drawing a textured mesh: fidelity, filtering, outlines, seams, order, bad input."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial import Delaunay

from glid_nb.imaging import rasterise
from glid_nb.imaging.rasterise import ScanConverter, Tile, outline_edges, render_mesh
from glid_nb.imaging.texture import Texture

QUAD = np.array([[0, 1, 2], [0, 2, 3]])


def corners(width: float, height: float, x: float = 0, y: float = 0) -> NDArray[np.float64]:
    """The corners of a rectangle whose upper left corner is (x, y)."""
    return np.array([[x, y], [x + width, y], [x + width, y + height], [x, y + height]], dtype=float)


def noise(width: int, height: int, seed: int = 0) -> NDArray[np.uint8]:
    rng = np.random.default_rng(seed)
    return rng.integers(0, 256, (height, width, 4), dtype=np.uint8)


def irregular_mesh(
    width: float, height: float, n: int, seed: int = 0
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """A rectangle cut into triangles of all shapes."""
    rng = np.random.default_rng(seed)
    inner = rng.random((n, 2)) * [width, height]
    points = np.concatenate([corners(width, height), inner])
    return points, Delaunay(points).simplices.astype(np.int32)


def assert_pictures_agree(result: NDArray[np.uint8], expected: NDArray[np.uint8]) -> None:
    """Alpha agrees to one level. Visible colours agree to two."""
    difference = np.abs(result.astype(int) - expected.astype(int))
    assert difference[..., 3].max() <= 1
    seen = expected[..., 3] > 32
    assert difference[..., :3][seen].max() <= 2


def zone_plate(n: int) -> NDArray[np.float64]:
    """Rings whose frequency grows from 0 at the centre to 0.45 per pixel at the sides' middles."""
    y, x = np.mgrid[:n, :n] + 0.5 - n / 2
    return 0.5 + 0.5 * np.cos(0.9 * np.pi * (x**2 + y**2) / n)


def grey(values: NDArray[np.float64]) -> NDArray[np.uint8]:
    return np.rint(values * 255).astype(np.uint8)


def test_the_identity_reproduces_the_picture():
    image = noise(150, 97)
    points, triangles = irregular_mesh(150, 97, 300)
    assert_pictures_agree(render_mesh(image, points, points, triangles, (150, 97)), image)


def test_sixteen_bit_grey_and_float_pictures():
    image = noise(40, 30)[..., 0]
    for picture in (
        image,
        image.astype(np.uint16) * 257,
        image / 255,
        image[..., None].repeat(3, 2),
    ):
        result = render_mesh(picture, corners(40, 30), corners(40, 30), QUAD, (40, 30))
        assert (result[..., 3] == 255).all()
        assert np.abs(result[..., 0].astype(int) - image).max() <= 1


@pytest.mark.parametrize("turns", [1, 2, 3])
def test_quarter_turns_equal_rot90(turns: int):
    image = noise(64, 64)
    points, triangles = irregular_mesh(64, 64, 60)
    offset = points - 32
    for _ in range(turns):  # counter-clockwise on the screen, where y points down
        offset = np.stack([offset[:, 1], -offset[:, 0]], axis=1)
    result = render_mesh(image, points, offset + 32, triangles, (64, 64))
    assert_pictures_agree(result, np.ascontiguousarray(np.rot90(image, turns)))


def test_a_shift_by_half_a_pixel_interpolates():
    y, x = np.mgrid[:40, :60] + 0.5
    ramp = np.stack([3 * x + 20, 4 * y + 30, 2 * x + y, np.full_like(x, 255)], axis=2)
    points = corners(60, 40)
    result = render_mesh(np.rint(ramp).astype(np.uint8), points, points + 0.5, QUAD, (60, 40))
    expected = ramp - [1.5, 2.0, 1.5, 0]
    assert np.abs(result - expected)[4:-4, 4:-4].max() <= 1.01


def test_magnification_is_smooth():
    y, x = np.mgrid[:32, :32] + 0.5
    wave = 0.5 + 0.4 * np.sin(x / 2.5) * np.cos(y / 3)
    result = render_mesh(grey(wave), corners(32, 32), corners(256, 256), QUAD, (256, 256))
    y, x = (np.mgrid[:256, :256] + 0.5) / 8
    expected = 255 * (0.5 + 0.4 * np.sin(x / 2.5) * np.cos(y / 3))
    inner = slice(16, -16)
    assert np.abs(result[inner, inner, 0] - expected[inner, inner]).max() < 2.5


def test_a_zone_plate_minified_four_times_equals_area_averages():
    plate = zone_plate(480)
    result = render_mesh(grey(plate), corners(480, 480), corners(120, 120), QUAD, (120, 120))
    expected = 255 * plate.reshape(120, 4, 120, 4).mean(axis=(1, 3))
    assert np.abs(result[..., 0] - expected).max() < 1.5


@pytest.mark.parametrize("angle", [0.0, 0.3])
@pytest.mark.parametrize("factors", [(3.3, 3.3), (1.0, 6.0), (5.0, 1.5)])
def test_minification_does_not_alias(factors: tuple[float, float], angle: float):
    # Rings finer than the output can show must become grey. Coarser rings must stay.
    n = 480
    plate = zone_plate(n)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    centred = corners(n, n) - n / 2
    positions = (centred / factors) @ turn + 120
    result = render_mesh(grey(plate), corners(n, n), positions, QUAD, (240, 240))[..., 0] / 255.0
    y, x = np.mgrid[:240, :240] + 0.5 - 120
    source = np.stack([x, y], axis=-1) @ turn.T * factors
    # Frequency of the rings along each axis of the picture, cycles per output pixel.
    frequency = np.abs(0.9 * source / n * factors)
    inside = (np.abs(source) < n / 2 - 10).all(axis=-1)
    fine = inside & (frequency.max(axis=-1) > 1.1)
    assert fine.sum() > 500
    assert np.abs(result[fine] - 0.5).max() < 0.25  # 0.5 without a filter
    assert np.sqrt(np.mean((result[fine] - 0.5) ** 2)) < 0.07  # 0.35 without
    coarse = inside & (frequency.max(axis=-1) < 0.1)
    exact = 0.5 + 0.5 * np.cos(0.9 * np.pi * (source**2).sum(axis=-1) / n)
    assert coarse.sum() > 20
    assert np.abs(result[coarse] - exact[coarse]).max() < 0.25


@pytest.mark.parametrize("scale", [0.17, 0.6, 1.0, 3.7])
@pytest.mark.parametrize("hidden", [0, 255])
def test_hidden_colours_never_bleed(scale: float, hidden: int):
    y, x = np.mgrid[:80, :80] + 0.5 - 40
    image = np.full((80, 80, 4), hidden, np.uint8)
    image[..., :3][np.hypot(x, y) < 25] = (200, 40, 90)
    image[..., 3] = np.where(np.hypot(x, y) < 25, 255, 0)
    turn = scale * np.array([[0.8, 0.6], [-0.6, 0.8]])
    points, triangles = irregular_mesh(80, 80, 40)
    positions = (points - 40) @ turn + 60
    result = render_mesh(image, points, positions, triangles, (120, 120))
    seen = result[..., 3] > 4  # with less alpha, 8 bits leave the colour no precision
    assert seen.any()
    assert np.abs(result[seen][:, :3].astype(int) - (200, 40, 90)).max() <= 1


def test_outlines_show_the_exact_coverage():
    # The half plane below a line, for many slopes, against 256 samples per pixel.
    for angle in np.linspace(0.02, 1.5, 9):
        direction = np.array([np.cos(angle), np.sin(angle)])
        normal = np.array([-direction[1], direction[0]])
        middle = np.array([16.3, 15.8])
        a, b = middle - 200 * direction, middle + 200 * direction
        positions = np.array([a, b, b + 300 * normal, a + 300 * normal])
        alpha = render_mesh(
            np.full((4, 4), 255, np.uint8), corners(4, 4), positions, QUAD, (32, 32)
        )
        fine = (np.mgrid[:512, :512] + 0.5) / 16
        inside = (fine[1] - middle[0]) * normal[0] + (fine[0] - middle[1]) * normal[1] > 0
        exact = inside.reshape(32, 16, 32, 16).mean(axis=(1, 3))
        assert np.abs(alpha[..., 3] / 255 - exact).max() < 0.08
        assert abs(alpha[..., 3].mean() / 255 - exact.mean()) < 2e-3


def test_an_outline_that_ends_on_pixel_borders_is_sharp():
    positions = corners(10, 6, 3, 2)
    result = render_mesh(np.full((5, 5), 255, np.uint8), corners(5, 5), positions, QUAD, (16, 10))
    expected = np.zeros((10, 16))
    expected[2:8, 3:13] = 255
    np.testing.assert_array_equal(result[..., 3], expected)


@settings(max_examples=25)
@given(seed=st.integers(0, 10_000), resolved=st.booleans())
def test_every_sample_belongs_to_exactly_one_triangle(seed: int, resolved: bool):
    # Coordinates on a coarse grid put many samples on edges and vertices.
    rng = np.random.default_rng(seed)
    inner = rng.integers(1, [160, 120], (60, 2)) / 4
    points = np.concatenate([corners(40, 30), np.unique(inner, axis=0)])
    turn = rng.uniform(-1e-3, 1e-3)
    triangles = Delaunay(points).simplices
    points = 20 + (points - 20) @ [[1, turn], [-turn, 1]] * (1 + 1e-3)
    n = 8 if resolved else 1
    samples = ScanConverter(points[triangles]).samples(
        Tile(0, 2, 40, 26), np.ones(26 * 40, dtype=bool), n
    )
    at = 2 * 40 + samples.place // n**2
    np.testing.assert_array_equal(np.floor(samples.y) * 40 + np.floor(samples.x), at)
    count = np.bincount(samples.place, minlength=26 * 40 * n**2).reshape(26, 40, -1)
    assert (count[:, 2:38] == 1).all()
    assert (count <= 1).all()


def bent_mesh(seed: int) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int32]]:
    """A jittered grid on [0, 50]^2, its image under a random quadratic map, its triangles."""
    rng = np.random.default_rng(seed)
    points = np.stack(np.meshgrid(*[np.linspace(0, 50, 9)] * 2), axis=-1)
    points[1:-1, 1:-1] += rng.uniform(-2, 2, (7, 7, 2))
    points = points.reshape(-1, 2)
    a, b, c = rng.uniform(-1, 1, 3)
    x, y = (points / 50 - 0.5).T
    bent = np.stack([x + 0.4 * a * y * y + 0.3 * b * x * y, y + 0.4 * c * x * x], axis=1)
    return points, bent * 40 + 35, Delaunay(points).simplices.astype(np.int32)


@pytest.mark.slow
@settings(max_examples=15)
@given(seed=st.integers(0, 10_000))
def test_a_deformed_mesh_has_no_seams_and_keeps_its_area(seed: int):
    points, positions, triangles = bent_mesh(seed)
    image = np.full((8, 8), 255, np.uint8)
    alpha = render_mesh(image, points / 6.25, positions, triangles, (70, 70))[..., 3]
    outline = positions[outline_edges(triangles, positions[triangles])]
    (shape,) = shapely.polygonize([shapely.LineString(edge) for edge in outline]).geoms
    assert alpha.sum() / 255 == pytest.approx(shape.area, rel=1e-3)
    x, y = np.mgrid[:70, :70]
    pixels = shapely.box(x, y, x + 1, y + 1).T
    coverage = shapely.area(shapely.intersection(pixels, shape))
    assert (alpha[coverage > 1 - 1e-9] == 255).all()
    assert (alpha[coverage == 0] == 0).all()
    assert np.abs(alpha / 255 - coverage).max() < 0.1


def test_later_triangles_cover_earlier_ones():
    image = np.zeros((10, 20, 4), np.uint8)
    image[:, :10], image[:, 10:] = (255, 0, 0, 255), (0, 0, 255, 255)
    left, right = corners(8, 10, 1, 0), corners(8, 10, 11, 0)
    under, over = corners(20, 20, 4, 4), corners(20, 20, 13.5, 13.5)
    vertices, positions = np.concatenate([left, right]), np.concatenate([under, over])
    both = np.concatenate([QUAD, QUAD + 4])
    result = render_mesh(image, vertices, positions, both, (40, 40))
    assert tuple(result[20, 20]) == (0, 0, 255, 255)
    assert tuple(result[8, 8]) == (255, 0, 0, 255)
    # The outline of the upper sheet is anti-aliased against the lower one.
    assert np.abs(result[20, 13].astype(int) - (128, 0, 128, 255)).max() <= 1
    swapped = render_mesh(image, vertices, positions, both[::-1], (40, 40))
    assert tuple(swapped[20, 20]) == (255, 0, 0, 255)


def test_sheets_with_heights_cut_through_one_another_along_a_line():
    image = np.zeros((10, 20, 4), np.uint8)
    image[:, :10], image[:, 10:] = (255, 0, 0, 255), (0, 0, 255, 255)
    triangles = np.concatenate([QUAD, QUAD + 4])
    vertices = np.concatenate([corners(8, 8) + 1, corners(8, 8, 11, 1)])
    positions = np.concatenate([corners(30, 30) + 5, corners(30, 30) + 5])
    # The red sheet lies flat at height 1, the blue one rises from 0 to 3 along x: they meet at
    # a third of the way.
    heights = np.array([1, 1, 1, 1, 0, 3, 3, 0])
    for order in (triangles, triangles[::-1]):
        result = render_mesh(image, vertices, positions, order, (40, 40), heights)
        assert (result[5:35, 5:15] == (255, 0, 0, 255)).all()
        assert (result[5:35, 15:35] == (0, 0, 255, 255)).all()


def test_a_lower_sheet_shows_through_transparent_parts_of_an_upper_one():
    image = np.zeros((20, 40, 4), np.uint8)
    image[:, :20] = (255, 0, 0, 255)
    image[5:15, 25:35] = (0, 0, 255, 255)
    image[5:15, 35:37] = (0, 0, 255, 128)
    lower, upper = corners(20, 20), corners(20, 20, 20, 0)
    # The upper sheet's outline runs through the lower sheet, its corners between pixels.
    positions = np.concatenate([corners(30, 30) + 5, corners(20, 20, 10, 10.4)])
    result = render_mesh(
        image, np.concatenate([lower, upper]), positions, np.concatenate([QUAD, QUAD + 4]), (40, 40)
    )
    assert (result[6:34, 6:34, 3] == 255).all()
    ring = np.zeros((40, 40), dtype=bool)
    ring[6:34, 6:34], ring[13:28, 13:29] = True, False
    assert (result[ring] == (255, 0, 0, 255)).all()
    assert tuple(result[20, 20]) == (0, 0, 255, 255)
    assert np.abs(result[20, 26].astype(int) - (127, 0, 128, 255)).max() <= 1


def test_nothing_is_shown_beyond_the_picture():
    image = np.full((10, 10, 4), 255, np.uint8)
    points = corners(30, 30) - 10
    result = render_mesh(image, points, points + 10, QUAD, (30, 30))
    expected = np.zeros((30, 30))
    expected[10:20, 10:20] = 255
    ring = np.zeros((30, 30), dtype=bool)
    ring[9:21, 9:21] = True
    ring[10:20, 10:20] = False
    np.testing.assert_array_equal(result[..., 3][~ring], expected[~ring])
    assert (result[..., 3][ring] <= 128).all()


def test_bands_change_nothing(monkeypatch: pytest.MonkeyPatch):
    image = noise(60, 50)
    points, triangles = irregular_mesh(60, 50, 100)
    positions = (points - 25) @ [[0.9, 0.5], [-0.4, 0.8]] + 40
    whole = render_mesh(image, points, positions, triangles, (90, 80))
    monkeypatch.setattr(rasterise, "TILE", 31 * 7)
    monkeypatch.setattr(rasterise, "TILE_WIDTH", 31)
    pieces = render_mesh(image, points, positions, triangles, (90, 80))
    np.testing.assert_array_equal(pieces, whole)


def test_vertices_far_away_leave_the_rest_exact():
    image = noise(32, 32)
    far = corners(4e7, 4e7) - 2e7
    result = render_mesh(image, far, far, QUAD, (32, 32))
    assert_pictures_agree(result, image)
    assert not render_mesh(image, corners(32, 32), far[:4] * 1e9 + 1e30, QUAD, (32, 32)).any()


def test_triangles_without_area_are_skipped():
    image = noise(16, 16)
    points = np.concatenate([corners(16, 16), [[8, 8], [8, 8]]])
    triangles = np.concatenate([[[0, 4, 5], [0, 2, 4]], QUAD])
    assert_pictures_agree(render_mesh(image, points, points, triangles, (16, 16)), image)


def test_a_prepared_texture_draws_the_same():
    image = noise(33, 21)
    args = (corners(33, 21), corners(50, 40), QUAD, (50, 40))
    np.testing.assert_array_equal(
        render_mesh(Texture.from_image(image), *args), render_mesh(image, *args)
    )


@pytest.mark.parametrize("n", [2, 5, 16, 40])
def test_strong_minification_shows_area_averages(n: int):
    image = noise(8 * n, 4 * n)
    alpha = image[..., 3:] / 255
    premultiplied = np.concatenate([image[..., :3] / 255 * alpha, alpha], axis=2)
    average = premultiplied.reshape(4, n, 8, n, 4).mean(axis=(1, 3))
    texels = Texture.from_image(image).reduced(n) / 65535
    assert np.abs(texels - average).max() < 1e-4
    result = render_mesh(image, corners(8 * n, 4 * n), corners(8, 4), QUAD, (8, 4)) / 255
    shown = np.concatenate([result[..., :3] * result[..., 3:], result[..., 3:]], axis=2)
    assert np.abs(shown - average).max() < 1.5 / 255


@pytest.mark.parametrize(
    ("image", "message"),
    [
        (np.zeros((0, 3, 4), np.uint8), "image is empty"),
        (np.zeros((2, 2, 4), np.int64), "image has the type int64"),
    ],
)
def test_bad_pictures(image: NDArray, message: str):
    with pytest.raises(ValueError, match=message):
        render_mesh(image, corners(4, 4), corners(4, 4), QUAD, (4, 4))


def test_no_triangles_give_an_empty_picture():
    result = render_mesh(
        noise(4, 4), np.zeros((0, 2)), np.zeros((0, 2)), np.zeros((0, 3), int), (5, 3)
    )
    assert result.shape == (3, 5, 4)
    assert not result.any()
