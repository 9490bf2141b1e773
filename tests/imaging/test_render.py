"""Warping a picture through a harmonic map: meshes, frames, views."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from glid_nb.geometry import Cage, Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.frame import PixelFrame
from glid_nb.imaging.mesh import DeformedMesh, deformed_mesh
from glid_nb.imaging.order import order_of
from glid_nb.imaging.progress import Stopped
from glid_nb.imaging.render import draw_mesh, frame_of, render, share_outside
from glid_nb.imaging.texture import Texture

pytestmark = pytest.mark.slow  # most of the time is compiling


def rectangle(width: float, height: float, parts: int = 1) -> NDArray[np.float64]:
    """Counter-clockwise loop around the origin, the long sides cut into ``parts``."""
    x = np.linspace(-width / 2, width / 2, parts + 1)
    lower, upper = np.full_like(x, -height / 2), np.full_like(x, height / 2)
    return np.concatenate([np.stack([x, lower], 1), np.stack([x[::-1], upper], 1)])


def conformal(domain: Domain, function) -> HarmonicMap:
    """Nearly the holomorphic function, interpolated at the offset cage's vertices."""
    start = HarmonicMap.identity(domain)
    phi = np.where(start.phi != 0, function(start.phi), 0)
    return HarmonicMap(domain, phi, start.psi)


def bent(domain: Domain, curvature: float) -> HarmonicMap:
    """Bends the x axis into a circle of this curvature."""
    return conformal(domain, lambda z: (np.exp(1j * curvature * z) - 1) / (1j * curvature))


def affine(domain: Domain, factor: complex, shift: complex) -> HarmonicMap:
    return conformal(domain, lambda z: factor * z + shift)


@pytest.fixture(scope="module")
def domain() -> Domain:
    """A rectangle of 12 x 8 with a square hole."""
    hole = 1.0 + 1.5 * np.array([[-1, -1], [-1, 1], [1, 1], [1, -1]])
    return Domain.from_cage(Cage(rectangle(12, 8), [hole]))


@pytest.fixture(scope="module")
def bar() -> Domain:
    return Domain.from_cage(Cage(rectangle(18, 1.6, 72)))


def coordinates_as_colours(width: int, height: int) -> NDArray[np.uint8]:
    """Red grows to the right, green downwards, blue is constant."""
    y, x = np.mgrid[:height, :width] + 0.5
    channels = [255 * x / width, 255 * y / height, np.full_like(x, 60), np.full_like(x, 255)]
    return np.rint(np.stack(channels, axis=2)).astype(np.uint8)


def covered(domain: Domain, width: int, height: int, margin: float) -> NDArray[np.bool_]:
    """Pixels whose centre lies in the cage, at least ``margin`` world units from its boundary."""
    y, x = np.mgrid[:height, :width] + 0.5
    world = PixelFrame(width, height).to_world(np.stack([x, y], axis=-1))
    shifts = margin * np.array([[0, 0], [1, 1], [1, -1], [-1, 1], [-1, -1]])
    return np.all([domain.cage.contains(world + shift) for shift in shifts], axis=0)


def test_the_identity_reproduces_the_picture_inside_the_cage(domain: Domain):
    image = np.random.default_rng(0).integers(0, 256, (128, 160, 4), dtype=np.uint8)
    image[..., 3] |= 128
    result = render(image, HarmonicMap.identity(domain))
    assert result.shape == image.shape
    assert result.dtype == np.uint8
    inside = covered(domain, 160, 128, 0.13)
    assert np.abs(result[inside].astype(int) - image[inside]).max() <= 2
    outside = ~covered(domain, 160, 128, -0.13)
    # The corners of a negative margin reach into the cage; what is left out is clear of it.
    y, x = np.mgrid[:128, :160] + 0.5
    world = PixelFrame(160, 128).to_world(np.stack([x, y], axis=-1))
    clear = outside & ~domain.cage.contains(world, tolerance=0.13)
    assert clear.any()
    assert not result[clear].any()


def test_a_similarity_moves_every_pixel(domain: Domain):
    image = coordinates_as_colours(200, 200)
    factor, shift = 0.8 * np.exp(0.5j), 1.0 - 0.7j
    result = render(image, affine(domain, factor, shift))
    y, x = np.mgrid[:200, :200] + 0.5
    frame = PixelFrame(200, 200)
    world = frame.to_world(np.stack([x, y], axis=-1)) @ [1, 1j]
    source = (world - shift) / factor
    source = np.stack([source.real, source.imag], axis=-1)
    inside = domain.cage.contains(source)
    solid = (result[..., 3] == 255) & inside
    assert solid.sum() > 0.9 * inside.sum()
    expected = frame.to_pixel(source) * 255 / 200
    assert np.abs(result[solid][:, :2] - expected[solid]).max() < 1.6


def test_the_size_is_free_and_other_proportions_are_letter_boxed(domain: Domain):
    image = coordinates_as_colours(160, 128)
    identity = HarmonicMap.identity(domain)
    tall = render(image, identity, size=(80, 164))
    frame = frame_of(PixelFrame(160, 128), identity, (80, 164), "source")
    assert tall.shape == (164, 80, 4)
    assert frame.units_per_pixel == pytest.approx(20 / 80)
    np.testing.assert_allclose(frame.to_pixel([[0.0, 0.0]]), [[40, 82]])
    filled = tall[..., 3] > 0
    rows = np.flatnonzero(filled.any(axis=1))
    assert (rows[0], rows[-1]) == (82 - 16, 82 + 15)
    doubled = render(image, identity, size=(320, 256))
    np.testing.assert_allclose(doubled[128, 80, :2], [80 * 255 / 320, 128 * 255 / 256], atol=2)


def test_fit_shows_all_of_a_shape_that_left_the_picture(domain: Domain):
    image = coordinates_as_colours(160, 128)
    away = affine(domain, 1.7, 15 + 9j)
    source = PixelFrame(160, 128)
    assert share_outside(away, source) > 0.6
    assert share_outside(away, frame_of(source, away, None, "fit")) == 0.0
    alpha = render(image, away, view="fit")[..., 3]
    assert not alpha[0].any()
    assert not alpha[-1].any()
    assert not alpha[:, 0].any()
    assert not alpha[:, -1].any()
    columns = np.flatnonzero(alpha.any(axis=0))
    assert columns[-1] - columns[0] + 1 >= 0.9 * 160


def test_the_share_outside_is_an_area(domain: Domain):
    frame = PixelFrame(100, 100)
    # 12 x 8 with a hole of 3 x 3; the hole's and the shape's left parts are cut off at x = -10.
    lost = share_outside(affine(domain, 1, -7.0), frame)
    # The shape covers [-13, -1], the hole [-7.5, -4.5]: 3 x 8 units are lost.
    assert lost == pytest.approx(24 / (96 - 9), abs=1e-9)
    assert share_outside(HarmonicMap.identity(domain), frame) == 0.0


def bend(map: HarmonicMap, mesh: DeformedMesh) -> float:
    """Largest distance of the image of an edge's middle from the middle of the image edge."""
    edges = np.sort(mesh.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2))
    away = map(mesh.vertices[edges].mean(axis=1)) - mesh.images[edges].mean(axis=1)
    return float(np.linalg.norm(away, axis=1).max())


def test_straight_edges_follow_the_map_to_a_quarter_of_a_pixel(bar: Domain):
    map = bent(bar, 0.3)
    frame = frame_of(PixelFrame(400, 400), map, None, "fit")
    mesh = deformed_mesh(map, 1000, 0.25 * frame.units_per_pixel)
    assert 0 < bend(map, mesh) <= 0.25 * frame.units_per_pixel
    rng = np.random.default_rng(0)
    weights = rng.dirichlet([1, 1, 1], len(mesh.triangles))[:, :, None]
    points = (mesh.vertices[mesh.triangles] * weights).sum(axis=1)
    drawn = (mesh.images[mesh.triangles] * weights).sum(axis=1)
    error = np.linalg.norm(frame.to_pixel(map(points)) - frame.to_pixel(drawn), axis=1)
    assert error.max() < 0.5
    assert np.quantile(error, 0.99) < 0.25


def test_refinement_is_conforming_and_keeps_the_domain(bar: Domain):
    map = bent(bar, 0.3)
    coarse, fine = deformed_mesh(map, 300), deformed_mesh(map, 300, tolerance=2e-3)
    assert len(fine.vertices) > 2 * len(coarse.vertices)
    assert bend(map, fine) <= 2e-3 < bend(map, coarse)
    for mesh in (coarse, fine):
        e = mesh.vertices[mesh.triangles][:, 1:] - mesh.vertices[mesh.triangles][:, :1]
        area = (e[:, 0, 0] * e[:, 1, 1] - e[:, 0, 1] * e[:, 1, 0]) / 2
        assert (area > 0).all()
        assert area.sum() == pytest.approx(bar.cage.area)
        # Conforming: every edge inside has two triangles, once in each direction.
        edges = mesh.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
        directed = {tuple(edge) for edge in edges.tolist()}
        assert len(directed) == len(edges)
        middle = mesh.vertices[[e for e in directed if e[::-1] not in directed]].mean(axis=1)
        assert bar.cage.contains(middle).all()
        assert not bar.cage.contains(middle * 1.001).any()


def test_a_tolerance_that_cannot_be_met_has_its_limit(bar: Domain, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("glid_nb.imaging.mesh.MOST_VERTICES", 600)
    map = bent(bar, 0.3)
    mesh = deformed_mesh(map, 300, tolerance=1e-6)
    assert len(mesh.vertices) <= 600
    assert bend(map, mesh) > 1e-6


def test_where_the_shape_overlaps_itself_one_end_lies_on_the_other(bar: Domain):
    # The bar is bent beyond a full circle, so that its ends cover the same part of a ring.
    image = coordinates_as_colours(400, 400)
    map = bent(bar, 2 * np.pi / 15)
    frame = frame_of(PixelFrame(400, 400), map, None, "fit")
    angle = np.array([-8.9, 8.9, -6.2, 6.2])
    places = frame.to_pixel(map(np.stack([angle, np.zeros(4)], axis=1)))
    # The middle of the overlap is 7.5 from the centre along either end.
    middle = frame.to_pixel(map([[7.5, 0.0], [-7.5, 0.0]]))
    assert np.abs(middle[0] - middle[1]).max() < 3
    low, high = np.sort(places[:, 1])[[0, -1]]
    x, y = middle[0]
    patch = render(image, map, view="fit")[
        round(y) - 25 : round(y) + 25, round(x) - 6 : round(x) + 6
    ]
    assert low < high
    assert (patch[..., 3] == 255).all()
    red = patch[..., 0]
    assert red.max() < 100 or red.min() > 155


def test_heights_grow_from_the_trunk_to_the_limbs(domain: Domain):
    mesh = deformed_mesh(HarmonicMap.identity(domain), 800)
    heights = order_of(domain.cage)(mesh.vertices)
    np.testing.assert_array_equal(heights, mesh.heights)
    # The innermost part of the rectangle with a hole near its top right is its left half.
    lowest, highest = mesh.vertices[np.argmin(heights)], mesh.vertices[np.argmax(heights)]
    assert -4 < lowest[0] < 0
    assert abs(highest[0]) == 6
    # Triangles come in that order, for programs that paint them without heights.
    means = heights[mesh.triangles].mean(axis=1)
    assert (np.diff(means) >= 0).all()


def test_bad_input(domain: Domain):
    image, identity = coordinates_as_colours(20, 20), HarmonicMap.identity(domain)
    with pytest.raises(ValueError, match="unknown view 'front'; choose one of source, fit"):
        render(image, identity, view="front")  # type: ignore[arg-type]
    for size in ((3,), (10.5, 20), (10.0, 20), (3, 4, 5), (True, 5), 5, "ab", [[1, 2], [3, 4]]):
        with pytest.raises(ValueError, match=r"size must be \(width, height\) in whole pixels"):
            render(image, identity, size=size)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="size is 0 x 5 pixels"):
        render(image, identity, size=(0, 5))
    with pytest.raises(ValueError, match=r"at most 2\^30 pixels"):
        render(image, identity, size=(1 << 15, 1 << 15))
    with pytest.raises(ValueError, match="at least 3 vertices"):
        render(image, identity, n_vertices=2)
    with pytest.raises(ValueError, match="image must have the shape"):
        render(np.zeros(5, np.uint8), identity)
    with pytest.raises(ValueError, match="tolerance is 0"):
        deformed_mesh(identity, tolerance=0)


def test_the_frame_converts_to_pixels():
    frame = PixelFrame(200, 100).showing((-9, -3, 11, 7))
    np.testing.assert_allclose(frame.to_pixel([[1, 2], [2, 3]]), [[100, 50], [110, 40]])
    assert (frame.zoom, frame.centre) == (1.0, (1.0, 2.0))
    assert frame.bounds == (-9.0, -3.0, 11.0, 7.0)


def test_what_lies_far_outside_the_picture_is_not_refined(bar: Domain) -> None:
    curved = bent(bar, 0.2)
    large = HarmonicMap(bar, 1e4 * curved.phi, 1e4 * curved.psi)
    frame = PixelFrame(200, 20)
    seen = deformed_mesh(large, 1000, 0.25 * frame.units_per_pixel, seen=frame.bounds)
    assert len(seen.vertices) < 5000
    # Visible parts are as fine as in any mesh.
    moderate = HarmonicMap(bar, 20 * curved.phi, 20 * curved.psi)
    image = coordinates_as_colours(200, 20)
    whole = deformed_mesh(moderate, 1000, 0.25 * frame.units_per_pixel)
    expected = draw_mesh(Texture.from_image(image), whole, frame)
    np.testing.assert_array_equal(render(image, moderate), expected)
    assert expected[..., 3].any()


LABELS = (
    7 * np.random.default_rng(3).integers(0, 11, (25, 20)).repeat(8, 0).repeat(8, 1)[:128, :160]
)


@pytest.mark.parametrize(
    "dtype", ["u1", "i1", "u2", "i4", "i8", "f2", "f4", "f8", "?", "c16", ">i4"]
)
def test_nearest_invents_no_value(bar: Domain, dtype: str):
    values = LABELS.astype(dtype)
    result = render(values, bent(bar, 0.2), interpolation="nearest", view="fit")
    assert (result.dtype, result.shape) == (values.dtype, values.shape)
    assert set(np.unique(result)) <= {*np.unique(values), values.dtype.type(0)}
    assert len(np.unique(result)) == len(np.unique(values))


@pytest.mark.parametrize("channels", [1, 2, 3, 4, 5, 12])
def test_nearest_keeps_channels_together(bar: Domain, channels: int):
    values = np.stack([LABELS + 1000 * c for c in range(channels)], axis=2).astype(np.int32)
    result = render(values, bent(bar, 0.2), size=(100, 90), interpolation="nearest", view="fit")
    assert result.shape == (90, 100, channels)
    seen = result.any(axis=2)
    assert 0.02 < seen.mean() < 1
    np.testing.assert_array_equal(
        result[seen] - result[seen][:, :1], [np.arange(channels) * 1000] * seen.sum()
    )


def test_nearest_under_the_identity_is_the_picture(domain: Domain):
    values = LABELS + 1
    result = render(values, HarmonicMap.identity(domain), interpolation="nearest", fill=-5)
    inside = covered(domain, 160, 128, 0.0)
    np.testing.assert_array_equal(result[inside], values[inside])
    assert (result[~covered(domain, 160, 128, -0.13)] == -5).any()
    assert set(np.unique(result)) <= {*np.unique(values), -5}


def test_nearest_shows_what_smooth_shows(bar: Domain):
    image = coordinates_as_colours(400, 400)
    map = bent(bar, 2 * np.pi / 15)  # it overlaps itself
    smooth = render(image, map, view="fit").astype(int)
    nearest = render(image, map, view="fit", interpolation="nearest")
    both = (smooth[..., 3] == 255) & (nearest[..., 3] == 255)
    assert both.sum() > 0.9 * (nearest[..., 3] == 255).sum()
    assert np.quantile(np.abs(smooth - nearest)[both], 0.99) <= 2


def test_what_is_fill_covers_nothing(bar: Domain):
    map = bent(bar, 2 * np.pi / 15)
    values = np.full((400, 400), 3, np.uint8)
    values[:, :100] = 0
    ends = render(values, map, view="fit", interpolation="nearest")
    values[:, :100], values[:, 100:] = 3, 0
    others = render(values, map, view="fit", interpolation="nearest")
    whole = render(np.full((400, 400), 3, np.uint8), map, view="fit", interpolation="nearest")
    np.testing.assert_array_equal((ends == 3) | (others == 3), whole == 3)


def test_nearest_refuses_what_it_cannot_hold(domain: Domain):
    identity, values = HarmonicMap.identity(domain), LABELS.astype(np.uint8)
    for fill in (-1, 256, 0.5, "a", None):
        with pytest.raises(ValueError, match=r"fill is .*image's type uint8 cannot hold"):
            render(values, identity, interpolation="nearest", fill=fill)  # type: ignore[arg-type]
    holed = render(values / 2, identity, interpolation="nearest", fill=np.nan)
    assert 0.1 < np.isnan(holed).mean() < 0.9
    with pytest.raises(
        ValueError, match="unknown interpolation 'cubic'; choose one of smooth, near"
    ):
        render(values, identity, interpolation="cubic")  # type: ignore[arg-type]
    for wrong in (np.zeros((3, 0)), np.zeros(4), np.array([["a"]]), [[1], [2, 3]]):
        with pytest.raises(ValueError, match=r"the image (must be|is not an array)"):
            render(wrong, identity, interpolation="nearest")
    with pytest.raises(ValueError, match="a Texture has been prepared"):
        render(Texture.from_image(values), identity, interpolation="nearest")


def test_a_large_picture_is_drawn_in_tiles_on_threads_as_in_one(domain, monkeypatch):
    image = coordinates_as_colours(320, 256)
    image[::3, ::5, 3] = 90
    map = affine(domain, 0.9 * np.exp(0.4j), 0.3)
    whole = render(image, map)
    told: list[tuple[int, int]] = []
    monkeypatch.setattr("glid_nb.imaging.rasterise.TILE", 64 * 32)
    monkeypatch.setattr("glid_nb.imaging.rasterise.TILE_WIDTH", 64)
    monkeypatch.setattr("os.cpu_count", lambda: 3)
    pieces = render(image, map, progress=lambda *at: told.append(at))
    np.testing.assert_array_equal(pieces, whole)
    assert told == [(i, 40) for i in range(41)]


@pytest.mark.parametrize("cores", [1, 3])
@pytest.mark.parametrize("interpolation", ["smooth", "nearest"])
def test_progress_ends_a_drawing(domain, monkeypatch, interpolation, cores):
    monkeypatch.setattr("glid_nb.imaging.rasterise.TILE", 32 * 32)
    monkeypatch.setattr("glid_nb.imaging.rasterise.TILE_WIDTH", 32)
    monkeypatch.setattr("os.cpu_count", lambda: cores)
    told: list[int] = []

    def progress(done: int, total: int) -> bool:
        told.append(done)
        return done == 3 < total

    image = coordinates_as_colours(320, 256)
    with pytest.raises(Stopped):
        render(image, affine(domain, 1, 0), interpolation=interpolation, progress=progress)
    assert told == [0, 1, 2, 3]
