"""From a picture to a cage."""

from __future__ import annotations

import importlib
import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from PIL import Image
from scipy.ndimage import binary_fill_holes, gaussian_filter
from skimage import data

from glid_nb.geometry import Cage, Domain
from glid_nb.imaging import (
    PixelFrame,
    Scribbles,
    TraceError,
    TraceOptions,
    Tracer,
    Tracing,
    trace,
)

EXACT = {"offset": 0, "simplify": 0.1, "min_edge": 0, "max_edge": math.inf}


def field(size: int, centre: tuple[float, float] | None = None) -> NDArray[np.float64]:
    """(size, size) distances of the pixels' centres from a point (x, y)."""
    x0, y0 = centre if centre is not None else (size / 2, size / 2)
    y, x = np.mgrid[:size, :size] + 0.5
    return np.hypot(x - x0, y - y0)


def disc(radius: float, size: int, centre: tuple[float, float] | None = None):
    return np.clip(radius - field(size, centre) + 0.5, 0, 1)


def ring(outer: float, inner: float, size: int):
    return disc(outer, size) * (1 - disc(inner, size))


def with_alpha(coverage: NDArray) -> NDArray[np.float64]:
    """A grey picture whose alpha is the coverage."""
    return np.dstack([np.full(coverage.shape, 0.4), coverage.astype(float)])


def polygon(tracing: Tracing) -> shapely.Polygon:
    """The cage in pixel coordinates."""
    exterior, *holes = (tracing.frame.to_pixel(loop) for loop in tracing.cage.loops)
    return shapely.Polygon(exterior, holes)


def contained(tracing: Tracing, tolerance: float = 0.0) -> float:
    """The share of the mask's pixels whose centres lie in the cage, or this near to it."""
    rows, columns = np.nonzero(tracing.mask)
    region = polygon(tracing).buffer(tolerance) if tolerance else polygon(tracing)
    shapely.prepare(region)
    return float(shapely.contains_xy(region, columns + 0.5, rows + 0.5).mean())


def edges(cage: Cage) -> NDArray[np.float64]:
    return np.concatenate([np.hypot(*(np.roll(p, -1, axis=0) - p).T) for p in cage.loops])


class TestAccuracy:
    @pytest.mark.parametrize(
        "picture",
        [
            with_alpha(disc(40, 100)),
            1 - 0.8 * disc(40, 100),
            0.2 + 0.7 * disc(40, 100),
            np.rint(65535 * (1 - 0.8 * disc(40, 100))).astype(np.uint16),
            np.dstack([1 - 0.1 * disc(40, 100), 1 - disc(40, 100), 1 - disc(40, 100)]),
            np.rint(255 * np.dstack([np.zeros((100, 100, 3)), disc(40, 100)])).astype(np.uint8),
        ],
        ids=["grey + alpha", "dark", "bright", "16 bit", "colour", "RGBA"],
    )
    def test_area_of_a_disc(self, picture):
        tracing = trace(picture, **EXACT)
        area = tracing.cage.area / tracing.frame.units_per_pixel**2
        assert area == pytest.approx(np.pi * 40**2, rel=0.005)
        assert tracing.cage.n_holes == 0

    def test_a_mask_without_grey_values(self):
        tracing = trace(disc(40, 100) > 0.5, **EXACT)
        assert polygon(tracing).area == pytest.approx(np.pi * 40**2, rel=0.01)

    def test_area_of_a_ring(self):
        tracing = trace(with_alpha(ring(45, 20, 100)), **EXACT)
        assert polygon(tracing).area == pytest.approx(np.pi * (45**2 - 20**2), rel=0.003)
        assert tracing.cage.n_holes == 1

    @pytest.mark.parametrize("centre", [(50, 50), (50.3, 49.8), (47.75, 52.5)])
    def test_position_below_a_pixel(self, centre):
        tracing = trace(with_alpha(disc(30, 100, centre)), **EXACT)
        middle = polygon(tracing).centroid
        assert (middle.x, middle.y) == pytest.approx(centre, abs=0.02)
        expected = PixelFrame(100, 100).to_world(centre)
        world = shapely.Polygon(tracing.cage.exterior).centroid
        assert (world.x, world.y) == pytest.approx(expected, abs=0.005)

    def test_the_outline_before_simplification(self):
        tracing = trace(with_alpha(disc(30, 100)))
        radii = np.hypot(*(tracing.outline - 50).T)
        np.testing.assert_allclose(radii, 30, atol=0.1)

    @pytest.mark.parametrize("offset", [1.5, 4.0])
    def test_the_offset_is_a_distance(self, offset):
        options = EXACT | {"offset": offset}
        tracing = trace(with_alpha(ring(45, 20, 120)), **options)
        exterior, hole = (tracing.frame.to_pixel(loop) for loop in tracing.cage.loops)
        np.testing.assert_allclose(np.hypot(*(exterior - 60).T), 45 + offset, atol=0.15)
        np.testing.assert_allclose(np.hypot(*(hole - 60).T), 20 - offset, atol=0.15)
        assert tracing.offset == offset

    def test_a_shape_at_the_border_ends_at_the_border(self):
        picture = np.zeros((40, 60))
        picture[10:, :25] = 1
        tracing = trace(with_alpha(picture), **EXACT)
        assert polygon(tracing).bounds == pytest.approx((0, 10, 25, 40), abs=0.05)
        assert polygon(tracing).area == pytest.approx(30 * 25, rel=0.002)

    def test_all_four_sides(self):
        picture = np.ones((30, 50))
        picture[10:20, 10:30] = 0
        tracing = trace(with_alpha(picture), **EXACT)
        assert polygon(tracing).bounds == pytest.approx((0, 0, 50, 30), abs=0.05)
        assert tracing.cage.n_holes == 1
        np.testing.assert_array_equal(tracing.mask, picture > 0)

    def test_y_points_up(self):
        picture = np.zeros((50, 50))
        picture[5:15, 5:40] = 1
        assert trace(with_alpha(picture)).cage.exterior[:, 1].min() > 0

    def test_mirror_images(self):
        rng = np.random.default_rng(5)
        picture = gaussian_filter(rng.random((70, 90)), 5)
        picture = with_alpha((picture > np.median(picture)).astype(float))
        here, there = trace(picture, **EXACT), trace(picture[:, ::-1], **EXACT)
        assert there.cage.area == pytest.approx(here.cage.area, rel=1e-6)
        xmin, ymin, xmax, ymax = here.cage.bounds
        assert there.cage.bounds == pytest.approx((-xmax, ymin, -xmin, ymax))


class TestAwkwardPictures:
    """For any picture, the result is a valid cage or a refusal in one sentence."""

    def test_a_bridge_one_pixel_wide(self):
        picture = np.zeros((40, 80))
        picture[10:30, 5:30] = picture[10:30, 50:75] = 1
        picture[20, 30:50] = 1
        for offset in (0, None):
            tracing = trace(with_alpha(picture), offset=offset, simplify=0.3)
            assert tracing.n_components == 1
            assert tracing.mask.sum() == picture.sum()
            assert contained(tracing) > 0.99

    def test_values_next_to_the_threshold_leave_no_hairline(self):
        # A bridge of pixels just above the threshold. Without care its outline is 1e-6 pixels wide.
        picture = np.zeros((40, 80))
        picture[10:30, 5:30] = picture[10:30, 50:75] = 1
        picture[20, 30:50] = 0.5 + 1 / 65535
        tracing = trace(with_alpha(picture), **(EXACT | {"simplify": 0}))
        assert tracing.n_components == 1
        assert shapely.minimum_clearance(polygon(tracing)) > 0.01

    def test_pixels_that_touch_at_corners_are_connected(self):
        tracing = trace(with_alpha(np.eye(20)), offset=0, simplify=0)
        assert tracing.n_components == 1
        assert polygon(tracing).bounds == pytest.approx((0, 0, 20, 20), abs=0.1)
        assert contained(tracing) == 1

    def test_a_loop_of_corners_has_a_hole(self):
        picture = np.zeros((30, 30))
        y, x = np.mgrid[:30, :30]
        picture[np.abs(x - 15) + np.abs(y - 15) == 10] = 1
        tracing = trace(with_alpha(picture), offset=0, simplify=0)
        assert tracing.n_components == tracing.cage.n_holes == 1

    def test_checkerboards(self):
        board = (np.indices((40, 40)).sum(axis=0) % 2).astype(float)
        for squares in (board, np.kron(board[:9, :9], np.ones((5, 5)))):
            tracing = trace(with_alpha(squares), min_hole_area=0)
            assert tracing.n_components == 1
            assert contained(tracing) > 0.95

    @pytest.mark.slow
    @pytest.mark.parametrize("seed", range(6))
    def test_noise(self, seed):
        rng = np.random.default_rng(seed)
        picture = rng.random((60, 70, 3)) if seed % 2 else with_alpha(rng.random((60, 70)) > 0.4)
        assert trace(picture).cage.n_vertices >= 3

    def test_a_very_rough_outline_is_traced_coarsely(self, monkeypatch):
        monkeypatch.setattr("glid_nb.imaging.outline.ROUGH", 300)
        picture = disc(60, 150) * (np.random.default_rng(1).random((150, 150)) > 0.35)
        tracing = trace(with_alpha(picture))
        assert any("very rough: it was traced in blocks of" in note for note in tracing.notes)
        assert polygon(tracing).area == pytest.approx(np.pi * 62**2, rel=0.1)
        assert tracing.mask.shape == (150, 150)
        assert contained(tracing) > 0.99

    def test_many_holes(self):
        picture = np.ones((150, 150))
        for i in range(5, 145, 10):
            for j in range(5, 145, 10):
                picture[i : i + 4, j : j + 4] = 0
        tracing = trace(with_alpha(picture), min_hole_area=0)
        assert tracing.cage.n_holes == 100
        assert any("96 small holes were filled" in note for note in tracing.notes)

    @pytest.mark.parametrize("bits", [0b000010000, 0b111010010, 0b101010101, 0b111101111, 0b1])
    def test_three_by_three(self, bits):
        picture = np.array([bits >> k & 1 for k in range(9)], dtype=float).reshape(3, 3)
        tracing = trace(with_alpha(picture))
        assert contained(tracing) == 1
        assert tracing.mask.sum() >= picture.sum() / 2

    @pytest.mark.parametrize("shape", [(1, 2), (2, 1), (1, 40), (1, 1)])
    def test_thin_pictures(self, shape):
        picture = np.zeros(shape)
        picture.flat[0] = 1
        if shape == (1, 1):
            with pytest.raises(TraceError, match="one colour only"):
                trace(with_alpha(picture))
        else:
            assert trace(with_alpha(picture)).cage.n_vertices >= 3

    @pytest.mark.slow
    @settings(max_examples=60)
    @given(
        st.integers(0, 10**6),
        st.sampled_from([0.6, 1.5, 4.0]),
        st.floats(0.2, 0.8),
        st.sampled_from([None, 0.0, 0.4, 3.0, 25.0]),
        st.sampled_from([None, 0.0, 0.5, 4.0, 40.0]),
        st.sampled_from([None, 0.0, 30.0]),
        st.sampled_from([None, 3, 25]),
        st.booleans(),
    )
    def test_blobs(self, seed, blur, level, offset, tolerance, min_hole_area, most, smooth):
        rng = np.random.default_rng(seed)
        height, width = rng.integers(4, 70, 2)
        values = gaussian_filter(rng.random((height, width)), blur)
        values = (values - values.min()) / np.ptp(values)
        coverage = values if smooth else (values > np.quantile(values, level)).astype(float)
        tracing = trace(
            with_alpha(coverage),
            method="alpha",
            threshold=level if smooth else None,
            offset=offset,
            simplify=tolerance,
            min_hole_area=min_hole_area,
            max_vertices=most,
        )
        # Checked by the constructor: loops simple, apart and rightly nested.
        Cage(tracing.cage.exterior, tracing.cage.holes)
        Domain.from_cage(tracing.cage)
        assert tracing.mask.shape == (height, width)
        assert tracing.mask.sum() >= tracing.component.area
        if most is not None and not any("max_vertices" in note for note in tracing.notes):
            assert tracing.cage.n_vertices <= most
        if tolerance in (None, 0.0, 0.5) and most is None:
            # Half a pixel: the outline of a smooth field may pass right beside a pixel's centre.
            missing = 1 - contained(tracing, 0.5)
            assert missing < 0.02 or any("cut off" in note for note in tracing.notes)


class TestPictures:
    def test_the_horse(self):
        tracing = trace(data.horse())
        assert 60 <= tracing.cage.n_vertices <= 120
        assert tracing.cage.n_holes == 0
        assert contained(tracing) > 0.999
        # The tail hangs free, and so do the legs: no bay was closed for the offset's sake.
        shape = int(tracing.mask.sum())
        assert polygon(tracing).area < 1.06 * shape
        assert Domain.from_cage(tracing.cage).n_holes == 0
        assert edges(tracing.cage).min() > 0.15

    def test_one_of_the_coins(self):
        tracing = trace(
            data.coins(), method="threshold", threshold=0.55, invert=False, component_at=(355, 45)
        )
        x, y = tracing.component.pixel
        assert math.hypot(x - 357, y - 45) < 45
        assert polygon(tracing).contains(shapely.Point(355, 45))
        assert 1_000 < tracing.component.area < 5_000

    def test_the_camera_man(self):
        tracing = trace(data.camera())
        region = polygon(tracing)
        for x, y in [(180, 100), (120, 300), (225, 180)]:
            assert region.contains(shapely.Point(x, y)), (x, y)
        for x, y in [(60, 60), (450, 200), (400, 400)]:
            assert not region.contains(shapely.Point(x, y)), (x, y)

    @pytest.mark.slow
    @pytest.mark.parametrize("name", ["astronaut", "chelsea", "rocket", "coffee", "page", "text"])
    def test_photographs_and_print_do_not_crash(self, name):
        tracing = trace(getattr(data, name)())
        assert tracing.notes
        Domain.from_cage(tracing.cage)

    def test_a_file(self, tmp_path):
        path = tmp_path / "disc.png"
        picture = np.rint(255 * with_alpha(disc(30, 80))).astype(np.uint8)
        Image.fromarray(picture).save(path)
        from_file, from_array = trace(path, **EXACT), trace(picture, **EXACT)
        np.testing.assert_array_equal(from_file.cage.exterior, from_array.cage.exterior)
        from_bytes = trace(path.read_bytes(), **EXACT)
        np.testing.assert_array_equal(from_bytes.cage.exterior, from_array.cage.exterior)


class TestComponents:
    picture = with_alpha(
        np.maximum(disc(20, 120, (30, 30)), disc(12, 120, (90, 30))) + disc(8, 120, (60, 90))
    )

    def test_the_largest_comes_first(self):
        tracing = trace(self.picture)
        assert tracing.n_components == len(tracing.components) == 3
        areas = [component.area for component in tracing.components]
        np.testing.assert_allclose(areas, np.pi * np.array([20, 12, 8]) ** 2, rtol=0.05)
        assert [component.rank for component in tracing.components] == [0, 1, 2]
        assert tracing.components[1].bounds == pytest.approx((78, 18, 102, 42), abs=1)
        assert tracing.component is tracing.components[0]
        assert polygon(tracing).contains(shapely.Point(30, 30))
        assert any("2 smaller components, 34% of the foreground" in n for n in tracing.notes)

    def test_by_rank_and_by_pixel(self):
        by_rank = trace(self.picture, component=2)
        by_pixel = trace(self.picture, component_at=(60, 90))
        assert by_rank.component == by_pixel.component
        np.testing.assert_array_equal(by_rank.cage.exterior, by_pixel.cage.exterior)
        assert by_rank.mask.sum() == by_rank.component.area
        for component in by_rank.components:
            again = trace(self.picture, component_at=component.pixel)
            assert again.component == component

    def test_rank_out_of_range(self):
        with pytest.raises(
            TraceError, match="component 3 does not exist: the foreground has 3 comp"
        ):
            trace(self.picture, component=3)

    def test_picked_pixel_on_the_background(self):
        with pytest.raises(TraceError, match=r"component_at: the pixel \(60, 60\) is background"):
            trace(self.picture, component_at=(60, 60))

    def test_picked_pixel_outside(self):
        with pytest.raises(TraceError, match=r"component_at: the pixel \(-1, 5\) lies outside"):
            trace(self.picture, component_at=(-1, 5))

    def test_beyond_the_fifty_that_are_listed(self):
        picture = np.zeros((60, 60))
        picture[::5, ::5] = 1
        picture[40, 41] = 1
        tracing = trace(with_alpha(picture), component=100)
        assert tracing.n_components == 144
        assert len(tracing.components) == 50
        assert tracing.component.area == 1
        assert tracing.components[0].area == 2


class TestHoles:
    @staticmethod
    def cheese() -> NDArray[np.float64]:
        """A disc with holes of radius 12, 5 and 2."""
        solid = disc(70, 160)
        for radius, centre in [(12, (60, 60)), (5, (110, 70)), (2, (80, 120))]:
            solid = solid * (1 - disc(radius, 160, centre))
        return with_alpha(solid)

    def test_the_largest_come_first_and_small_ones_are_filled(self):
        tracing = trace(self.cheese())
        areas = [hole.area for hole in tracing.holes]
        np.testing.assert_allclose(areas, np.pi * np.array([12, 5, 2]) ** 2, rtol=0.05)
        assert [hole.kept for hole in tracing.holes] == [True, True, False]
        assert tracing.cage.n_holes == 2
        assert any("1 small hole was filled" in note for note in tracing.notes)

    def test_least_area(self):
        counts = [trace(self.cheese(), min_hole_area=a).cage.n_holes for a in (0, 50, 200, 1000)]
        assert counts == [3, 2, 1, 0]

    def test_by_colour_a_hole_must_be_larger(self):
        solid = self.cheese()[..., 1]
        tracing = trace(np.dstack([1 - 0.8 * solid, 1 - solid, 1 - solid]))
        assert tracing.method == "color"
        assert [hole.kept for hole in tracing.holes] == [True, False, False]

    def test_exceptions_by_pixel(self):
        first, second, third = (hole.pixel for hole in trace(self.cheese()).holes)
        tracing = trace(self.cheese(), keep_holes=[third], drop_holes=[first])
        assert [hole.kept for hole in tracing.holes] == [False, True, True]
        both = trace(self.cheese(), keep_holes=[second], drop_holes=[second])
        assert [hole.kept for hole in both.holes] == [True, False, False]

    def test_no_hole_there(self):
        tracing = trace(self.cheese(), drop_holes=[(80, 80)])
        assert any("drop_holes: there is no hole at the pixel (80, 80)" in n for n in tracing.notes)

    def test_the_mask_is_filled_where_the_cage_is(self):
        everything = binary_fill_holes(self.cheese()[..., 1] > 0.5)
        all_filled = trace(self.cheese(), min_hole_area=1e9).mask
        np.testing.assert_array_equal(all_filled, everything)
        none_filled = trace(self.cheese(), min_hole_area=0).mask
        np.testing.assert_array_equal(none_filled, self.cheese()[..., 1] > 0.5)

    def test_a_narrow_hole_gets_a_smaller_offset_and_a_note(self):
        tracing = trace(self.cheese(), min_hole_area=50, offset=6)
        assert tracing.cage.n_holes == 2
        note = next(note for note in tracing.notes if "too narrow" in note)
        assert "the hole at (110, 70) is too narrow for an offset of 6 px; it got 1.5 px" in note
        radius = math.sqrt(shapely.Polygon(tracing.cage.holes[1]).area / np.pi)
        assert radius / tracing.frame.units_per_pixel == pytest.approx(3.5, abs=0.6)

    def test_the_offset_divides_a_hole(self):
        solid = np.ones((80, 120))
        solid[20:60, 15:50] = solid[20:60, 70:105] = 0
        solid[38:42, 50:70] = 0
        tracing = trace(with_alpha(solid), offset=4)
        assert tracing.cage.n_holes == 2
        assert any("divided the hole" in note and "into 2" in note for note in tracing.notes)

    def test_an_offset_that_closes_a_bay(self):
        # A ring with a gap of 5 px.
        solid = ring(45, 25, 120)
        solid[57:62, 60:] = 0
        open_ring = trace(with_alpha(solid))
        assert open_ring.cage.n_holes == 0
        assert open_ring.offset < 2
        closed = trace(with_alpha(solid), offset=6)
        assert closed.cage.n_holes == 1
        assert any("closed a bay at (" in note for note in closed.notes)
        assert closed.holes[-1].by_offset
        filled = trace(with_alpha(solid), offset=6, drop_holes=[closed.holes[-1].pixel])
        assert filled.cage.n_holes == 0

    def test_no_hole_outlives_its_wall(self):
        # Walls between holes, one pixel thin. Simplification must not move across them.
        solid = np.ones((61, 61))
        for i in range(1, 60, 10):
            for j in range(1, 60, 10):
                solid[i : i + 9, j : j + 9] = 0
        for tolerance in (0.0, 1.0, 6.0):
            tracing = trace(with_alpha(solid), offset=0, simplify=tolerance)
            assert tracing.cage.n_holes == 36


class TestOptions:
    def test_more_vertices_by_a_smaller_tolerance(self):
        counts = [trace(data.horse(), simplify=t).cage.n_vertices for t in (0.3, 1, 4, 15)]
        assert counts == sorted(counts, reverse=True)
        assert counts[0] > 2 * counts[-1]

    @pytest.mark.parametrize("most", [12, 40, 80])
    def test_most_vertices(self, most):
        tracing = trace(data.horse(), max_vertices=most)
        assert 0.6 * most <= tracing.cage.n_vertices <= most

    def test_edges(self):
        tracing = trace(data.horse(), min_edge=8, max_edge=30)
        pixels = edges(tracing.cage) / tracing.frame.units_per_pixel
        assert pixels.max() <= 30.001
        # Moving edges outwards and dividing long ones may leave some shorter than requested.
        assert np.quantile(pixels, 0.05) > 7

    def test_what_is_cut_off_is_said(self):
        values = gaussian_filter(np.random.default_rng(53).random((60, 60)), 2)
        blob = with_alpha((values > np.quantile(values, 0.4)).astype(float))
        tracing = trace(blob, offset=0, max_vertices=12)
        assert tracing.cage.n_vertices <= 12
        note = next(note for note in tracing.notes if "outside the cage and is cut off" in note)
        stated = float(note.partition("%")[0]) / 100
        assert stated > 0.1
        assert 1 - contained(tracing) == pytest.approx(stated, abs=0.03)

    def test_the_values_used_are_reported(self):
        picture = 1 - 0.8 * disc(40, 100)
        tracing = trace(picture, method="threshold", threshold=0.7, offset=3, simplify=2)
        assert (tracing.method, tracing.threshold) == ("threshold", 0.7)
        assert (tracing.offset, tracing.simplify) == (3, 2)
        automatic = trace(picture)
        assert automatic.method == "color"
        assert automatic.notes[0].startswith("foreground by colour distance")
        assert 1 <= automatic.offset <= 3

    def test_a_given_object_and_changes(self):
        options = TraceOptions(offset=5, simplify=1)
        picture = with_alpha(disc(30, 80))
        assert trace(picture, options).offset == 5
        changed = trace(picture, options, offset=2)
        assert (changed.offset, changed.simplify) == (2, 1)

    def test_an_unknown_option(self):
        with pytest.raises(TraceError, match="trace has no argument 'glue'; there are method"):
            trace(with_alpha(disc(30, 80)), glue=0.5)
        with pytest.raises(TraceError, match="did you mean 'threshold'"):
            trace(with_alpha(disc(30, 80)), treshold=0.5)

    @pytest.mark.parametrize(
        ("name", "value", "message"),
        [
            ("method", "magic", "method must be one of auto, alpha, threshold, color, scribbles"),
            (
                "threshold",
                1.2,
                "threshold must be a finite number of at least 0 and at most 1, not 1.2",
            ),
            (
                "threshold",
                math.nan,
                "threshold must be a finite number of at least 0 and at most 1, not nan",
            ),
            ("threshold", "0.5", "threshold must be a finite number .*, not '0.5'"),
            ("invert", "yes", "invert must be True or False, not 'yes'"),
            (
                "background",
                (0.5, 2, 0),
                r"background must be \(red, green, blue\), each in \[0, 1\]",
            ),
            ("background", (0.5, 0.5), r"background must be \(red, green, blue\), each in"),
            ("background", 0.5, r"background must be \(red, green, blue\), each in .*, not 0.5"),
            ("background_at", (3, math.inf), r"background_at must be a pixel \(x, y\) of finite"),
            ("scribbles", [[(1, 1)]], "scribbles must be a Scribbles, not"),
            ("smoothing", -1, "smoothing must be a finite number of at least 0, not -1"),
            ("component", -1, "component must be a whole number of at least 0, not -1"),
            ("component", 1.5, "component must be a whole number"),
            ("component_at", (1, 2, 3), r"component_at must be a pixel \(x, y\)"),
            ("min_hole_area", -0.1, "min_hole_area must be a finite number of at least 0"),
            ("keep_holes", 5, r"keep_holes must be a list of pixels \(x, y\)"),
            (
                "drop_holes",
                [(1, "a")],
                r"drop_holes must be a list of pixels \(x, y\) .*, not \[\(1, 'a'\)\]",
            ),
            ("offset", -2, "offset must be a finite number of at least 0, not -2"),
            ("offset", math.inf, "offset must be a finite number of at least 0, not inf"),
            ("simplify", math.nan, "simplify must be a finite number"),
            ("max_vertices", 2, "max_vertices must be a whole number of at least 3, not 2"),
            ("max_vertices", True, "max_vertices must be a whole number"),
            ("min_edge", -1, "min_edge must be a finite number"),
            ("max_edge", 0.1, "max_edge must be a number at least 0.5, not 0.1"),
        ],
    )
    def test_out_of_range(self, name, value, message):
        with pytest.raises(TraceError, match=message):
            TraceOptions(**{name: value})

    def test_two_backgrounds(self):
        with pytest.raises(TraceError, match="background and background_at are both given"):
            TraceOptions(background=(1, 1, 1), background_at=(0, 0))

    def test_options_are_values(self):
        assert TraceOptions(drop_holes=[(1, 2)]) == TraceOptions(drop_holes=((1.0, 2.0),))
        assert hash(TraceOptions(offset=np.float64(3))) == hash(TraceOptions(offset=3))
        with pytest.raises(AttributeError):
            TraceOptions().offset = 3  # pyright: ignore[reportAttributeAccessIssue]


class TestBadPictures:
    @pytest.mark.parametrize(
        ("picture", "message"),
        [
            (np.zeros((0, 5)), "the image is empty"),
            (np.ones((30, 30)), "one colour only"),
            (np.full((30, 30, 3), np.nan), "holds nan in row 0, column 0"),
            (np.zeros((30, 30), dtype=int), "has the type int64"),
            (np.zeros(30), "must have the shape"),
            ("no/such/file.png", "The folder .*no/such does not exist"),
            (b"GIF89a", "damaged|not in a picture format"),
        ],
    )
    def test_messages(self, picture, message):
        with pytest.raises(TraceError, match=message):
            trace(picture)

    def test_no_foreground(self):
        with pytest.raises(TraceError, match="the image has no foreground by alpha"):
            trace(with_alpha(0.3 * disc(30, 80)), method="alpha")

    def test_foreground_everywhere(self):
        with pytest.raises(TraceError, match="the foreground covers the whole image"):
            trace(np.dstack([disc(30, 80)] * 3 + [np.ones((80, 80))]), method="alpha")

    def test_they_are_value_errors(self):
        assert issubclass(TraceError, ValueError)


class TestTracer:
    """Only the stages that depend on the changed option run again, and the result is the same."""

    @pytest.fixture
    def calls(self, monkeypatch) -> list[str]:
        """The names of the stages, as they run."""
        names: list[str] = []
        module = importlib.import_module("glid_nb.imaging.trace")  # the function has the same name

        def watch(name):
            function = getattr(module, name)

            def watched(*args, **kwargs):
                names.append(name)
                return function(*args, **kwargs)

            monkeypatch.setattr(module, name, watched)

        for name in ("find_foreground", "smoothed", "find_components", "find_outline"):
            watch(name)
        for name in ("choose_holes", "dilate", "simplify"):
            watch(name)
        return names

    @pytest.mark.parametrize(
        ("change", "stages"),
        [
            ({}, ""),
            ({"simplify": 2.0}, "simplify"),
            ({"offset": 3.0}, "dilate simplify"),
            ({"min_hole_area": 900.0}, "choose_holes dilate simplify"),
            ({"component": 1}, "find_outline choose_holes dilate simplify"),
            ({"threshold": 0.3}, "find_components find_outline choose_holes dilate simplify"),
            (
                {"smoothing": 1.0},
                "smoothed find_components find_outline choose_holes dilate simplify",
            ),
            (
                {"method": "threshold"},
                "find_foreground smoothed find_components find_outline choose_holes dilate "
                "simplify",
            ),
        ],
    )
    def test_stages(self, calls, change, stages):
        picture = np.dstack(
            [1 - ring(45, 20, 140), np.maximum(ring(45, 20, 140), disc(9, 140, (15, 15)))]
        )
        tracer = Tracer(picture)
        tracer.trace(TraceOptions())
        calls.clear()
        again = tracer.trace(TraceOptions(**change))
        assert calls == stages.split()
        fresh = trace(picture, **change)
        for ours, theirs in zip(again.cage.loops, fresh.cage.loops, strict=True):
            np.testing.assert_array_equal(ours, theirs)
        np.testing.assert_array_equal(again.mask, fresh.mask)
        assert again.notes == fresh.notes

    def test_new_scribbles_are_noticed(self):
        picture = np.dstack([disc(20, 90, (25, 45)), np.zeros((90, 90)), disc(15, 90, (70, 45))])
        tracer = Tracer(picture)
        places = [(25.0, 45.0), (70.0, 45.0)]
        for place in places:
            tracing = tracer.trace(TraceOptions(scribbles=Scribbles([[place]])))
            assert polygon(tracing).contains(shapely.Point(place))

    def test_an_error_leaves_the_tracer_usable(self):
        tracer = Tracer(with_alpha(disc(30, 80)))
        before = tracer.trace()
        with pytest.raises(TraceError):
            tracer.trace(TraceOptions(component=7))
        after = tracer.trace()
        np.testing.assert_array_equal(before.cage.exterior, after.cage.exterior)

    def test_results_cannot_be_changed(self):
        tracing = trace(with_alpha(ring(45, 20, 120)))
        arrays = [tracing.mask, tracing.outline, *(hole.loop for hole in tracing.holes)]
        assert not any(array.flags.writeable for array in arrays)
        with pytest.raises(AttributeError):
            tracing.offset = 1  # pyright: ignore[reportAttributeAccessIssue]
