"""Telling the foreground from the background."""

from __future__ import annotations

import io
import re

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image
from skimage import data

from glid_nb import samples
from glid_nb.imaging import Scribbles, TraceError, TraceOptions, as_rgba, trace
from glid_nb.imaging.foreground import Foreground, find_foreground, smoothed
from glid_nb.imaging.measure import border_color, histogram, otsu
from glid_nb.imaging.options import ForegroundMethod

SIZE = 80
RNG = np.random.default_rng(3)


def disc(radius: float = 25.0, size: int = SIZE) -> NDArray[np.float64]:
    """Coverage in [0, 1] of the pixels by a disc in the middle of a picture, anti-aliased."""
    y, x = np.mgrid[:size, :size] + 0.5 - size / 2
    return np.clip(radius - np.hypot(x, y) + 0.5, 0, 1)


def blended(shape, background, coverage: NDArray[np.float64] | None = None):
    """A shape of one colour over a background of another, (h, w, 3) float."""
    a = (disc() if coverage is None else coverage)[..., np.newaxis]
    return a * np.array(shape) + (1 - a) * np.array(background)


def find(image, method: ForegroundMethod = "auto", **options) -> Foreground:
    smoothing = options.pop("smoothing", None)
    return smoothed(find_foreground(as_rgba(image), method, **options), smoothing)


def agreement(mask: NDArray[np.bool_], coverage: NDArray[np.float64] | None = None) -> float:
    return float(np.mean(mask == ((disc() if coverage is None else coverage) > 0.5)))


class TestAlpha:
    def test_the_score_is_alpha_itself(self):
        image = np.dstack([np.zeros_like(disc()), disc()])
        found = find(image, "alpha")
        np.testing.assert_allclose(found.score, disc(), atol=1e-5)
        assert (found.method, found.automatic_threshold, found.inverted) == ("alpha", 0.5, False)
        assert not found.score.flags.writeable

    def test_threshold_and_inversion(self):
        image = np.dstack([np.zeros_like(disc()), disc()])
        low, high = (find(image, "alpha").mask(t).sum() for t in (0.1, 0.9))
        assert high < find(image, "alpha").mask().sum() < low
        assert agreement(~find(image, "alpha", invert=True).mask()) > 0.999
        # A threshold means the same with and without inversion: alpha below it is foreground.
        inverted = find(image, "alpha", invert=True)
        np.testing.assert_allclose(inverted.mask(0.3).mean(), np.mean(disc() < 0.3), atol=1e-3)

    def test_opaque(self):
        with pytest.raises(
            TraceError, match="covers the whole image: its alpha channel is 1 every"
        ):
            find(blended([1, 0, 0], [1, 1, 1]), "alpha")

    def test_fully_transparent(self):
        image = RNG.random((9, 9, 4))
        image[..., 3] = 0
        with pytest.raises(TraceError, match="no foreground: it is fully transparent"):
            find(image, "alpha")

    def test_too_faint(self):
        found = find(np.dstack([np.zeros_like(disc()), 0.4 * disc()]), "alpha")
        with pytest.raises(TraceError, match=r"no foreground by alpha.*lower the threshold"):
            found.mask()


def faint(color: tuple[float, float, float] = (0, 0, 0), most: float = 0.47):
    """A disc whose alpha reaches ``most``, on a transparent ground."""
    return np.dstack([np.full((SIZE, SIZE, 3), color), most * disc()])


def half_seen():
    """A black picture, only partly transparent."""
    image = np.zeros((SIZE, SIZE, 4))
    image[..., 3] = 0.6 + 0.4 * disc()
    return image


class TestRemedies:
    """The advice of a refusal works."""

    @pytest.mark.parametrize(
        ("image", "options"),
        [
            (faint(), {}),
            (faint((1, 1, 1)), {}),
            (faint((0.5, 0, 0), 0.02), {}),
            (faint(), {"method": "alpha"}),
            (faint(), {"threshold": 0.9}),
            (faint(), {"invert": True, "threshold": 0.0}),
            (half_seen(), {}),
            (half_seen(), {"method": "alpha"}),
            (half_seen(), {"method": "threshold"}),
            *(
                (0.3 + 0.5 * disc(), {"method": "threshold", "threshold": t, "invert": i})
                for t in (0.0, 0.1, 0.95, 1.0)
                for i in (True, False)
            ),
            (0.5 + 0.001 * disc(), {"method": "threshold", "threshold": 0.9}),
            (blended([0, 0, 0.2], [0, 0, 0]), {"method": "color", "threshold": 0.5}),
            (blended([1, 0, 0], [0.9, 0, 0]), {"method": "color", "threshold": 0.99}),
        ],
    )
    def test_the_threshold_that_is_recommended_finds_the_disc(self, image, options) -> None:
        with pytest.raises(TraceError) as caught:
            trace(image, **options)
        told = str(caught.value)
        wanted = re.search(r"(?:threshold=|the threshold, to )([0-9.e-]+\d)", told)
        assert wanted, told
        changed = {**options, "threshold": float(wanted[1])}
        if method := re.search("method='(.*?)'", told):
            changed["method"] = method[1]
        mask = trace(image, **changed).mask
        assert agreement(mask) > 0.97 or agreement(~mask) > 0.97

    def test_a_faint_drawing_is_told_by_its_alpha(self) -> None:
        with pytest.raises(TraceError, match=r"has alpha up to 47 %; lower the threshold, to 0.2"):
            trace(faint())
        with pytest.raises(TraceError, match=r"has alpha up to 49\.9 %;"):
            trace(faint(most=0.4991))

    def test_colours_behind_no_alpha_at_all(self) -> None:
        image = faint(most=0)
        image[..., 0] = disc()
        with pytest.raises(TraceError, match="fully transparent; remove its alpha channel"):
            trace(image)
        assert agreement(trace(image[..., :3]).mask) > 0.97

    def test_an_even_veil_changes_nothing(self) -> None:
        image = np.dstack([blended([0.9, 0.2, 0.1], [1, 1, 1]), np.full((SIZE, SIZE), 0.4)])
        assert agreement(trace(image).mask) > 0.97


class TestThreshold:
    @pytest.mark.parametrize(("shape", "ground"), [(0.1, 0.8), (0.9, 0.3), (0.45, 0.55)])
    def test_otsu_with_the_border_as_background(self, shape, ground):
        found = find(blended([shape], [ground])[..., 0], "threshold")
        assert agreement(found.mask()) > 0.995
        assert found.inverted == (shape < ground)
        assert any("than the border counts as foreground" in note for note in found.notes)
        # If all values in between separate two colours equally well, the middle is best.
        assert abs(found.automatic_threshold - (shape + ground) / 2) < 0.01

    def test_manual_value(self):
        ramp = np.tile(np.linspace(0, 1, 101), (20, 1))
        for threshold in (0.25, 0.6):
            bright = find(ramp, "threshold", invert=False, smoothing=0).mask(threshold)
            dark = find(ramp, "threshold", invert=True, smoothing=0).mask(threshold)
            assert bright.mean() == pytest.approx(1 - threshold, abs=0.02)
            assert dark.mean() == pytest.approx(threshold, abs=0.02)

    def test_transparent_pixels_are_background_whatever_their_colour(self):
        for hidden in (0, 1):
            image = np.zeros((SIZE, SIZE, 4))
            image[..., :3] = hidden
            image[20:60, 20:60] = [0.2, 0.2, 0.2, 1]
            image[30:50, 30:50, :3] = 0.9
            dark = find(image, "threshold", invert=True).mask()
            assert dark.sum() == 1600 - 400
            bright = find(image, "threshold", invert=False).mask()
            assert bright.sum() == 400

    def test_brightness_is_weighted_as_the_eye_does(self):
        image = np.zeros((10, 30, 3))
        image[:, :10, 0] = image[:, 10:20, 1] = image[:, 20:, 2] = 1
        score = find(image, "threshold", invert=False, smoothing=0).score
        np.testing.assert_allclose(score[5, [5, 15, 25]], [0.2125, 0.7154, 0.0721], atol=1e-4)

    def test_nothing_passes(self):
        found = find(blended([0.5], [0.3])[..., 0], "threshold", invert=False)
        with pytest.raises(TraceError, match=r"no foreground by brightness.*threshold 0\.9"):
            found.mask(0.9)
        with pytest.raises(TraceError, match=r"covers the whole image by brightness"):
            found.mask(0.1)


class TestColor:
    @pytest.mark.parametrize(
        ("shape", "ground"),
        [
            ([0.8, 0.1, 0.1], [1, 1, 1]),
            ([0.2, 0.6, 0.3], [0.6, 0.3, 0.2]),  # equally bright, nearly
            ([1, 1, 0.6], [1, 1, 1]),
        ],
    )
    def test_background_estimated_from_the_border(self, shape, ground):
        found = find(blended(shape, ground), "color")
        assert agreement(found.mask()) > 0.995
        assert any("estimated from the border" in note for note in found.notes)

    def test_the_middle_of_an_anti_aliased_edge(self):
        # Half covered pixels score half, so that the outline is accurate below a pixel.
        found = find(blended([0.8, 0.1, 0.1], [1, 1, 1]), "color")
        half = found.score.max() / 2
        assert found.automatic_threshold == pytest.approx(half, rel=0.1)

    def test_noise_in_the_background(self):
        noisy = blended([0.7, 0.3, 0.2], [0.5, 0.6, 0.7]) + RNG.normal(0, 0.03, (SIZE, SIZE, 3))
        found = find(noisy.clip(0, 1), "color")
        assert agreement(found.mask()) > 0.99

    def test_parts_that_resemble_the_background(self):
        image = blended([0.1, 0.1, 0.1], [1, 1, 1])
        image[30:50, 30:50] = [0.85, 0.85, 0.8]
        mask = find(image, "color").mask()
        assert mask[30:50, 30:50].all()
        assert agreement(mask) > 0.98

    def test_picked_colour_and_picked_pixel(self):
        image = blended([1, 0, 0], [0, 0, 1])
        image[:, :10] = [0, 1, 0]
        by_color = find(image, "color", background=(0, 0, 1))
        by_pixel = find(image, "color", background_at=(70, 5))
        np.testing.assert_allclose(by_color.score, by_pixel.score, atol=1e-4)
        mask = by_color.mask()
        assert mask[:, :10].all()
        assert not mask[:, 70:].any()

    def test_inverted_the_picked_colour_is_the_shape(self):
        image = blended([1, 0.5, 0], [0.2, 0.2, 0.2])
        found = find(image, "color", background_at=(40, 40), invert=True)
        assert agreement(found.mask()) > 0.995

    def test_picked_pixel_outside(self):
        with pytest.raises(TraceError, match=r"background_at: the pixel \(80, 3\) lies outside"):
            find(blended([1, 0, 0], [0, 0, 1]), "color", background_at=(80, 3))

    def test_a_transparent_border_shows_no_colour(self):
        image = np.dstack([blended([1, 0, 0], [0, 0, 1]), disc()])
        with pytest.raises(TraceError, match="border of the image is transparent"):
            find(image, "color")

    def test_16_bit_is_not_rounded_to_8(self):
        values = np.where(disc() > 0.5, 0.2005, 0.2)  # a difference of a third of an 8 bit step
        found = find(values, "color", background=(0.2, 0.2, 0.2), smoothing=0)
        assert agreement(found.mask(0.0003)) == 1


class TestBorderColor:
    def test_a_shape_that_covers_a_third_of_the_border(self):
        image = np.full((60, 60, 3), [0.9, 0.8, 0.2])
        image[:, :20] = [0.1, 0.1, 0.3]
        found = border_color(as_rgba(image))
        assert found is not None
        np.testing.assert_allclose(found.color, [0.9, 0.8, 0.2], atol=1e-4)
        assert 0.5 < found.share < 0.7

    def test_a_colour_on_the_edge_of_two_bins(self):
        image = np.full((60, 60, 3), 0.5) + RNG.normal(0, 0.01, (60, 60, 3))
        found = border_color(as_rgba(image.clip(0, 1)))
        assert found is not None
        np.testing.assert_allclose(found.color, 0.5, atol=0.003)
        assert found.share == 1
        assert found.spread < 0.05


class TestScribbles:
    image = blended([0.8, 0.2, 0.2], [0.3, 0.6, 0.3])

    def test_strokes(self):
        scribbles = Scribbles([[(30, 40), (50, 42)]], [[(3, 3), (77, 4)], [(5, 76)]])
        found = find(self.image, "scribbles", scribbles=scribbles)
        assert agreement(found.mask()) > 0.99
        assert found.automatic_threshold == 0.5

    def test_masks_do_the_same(self):
        inner, outer = np.zeros((2, SIZE, SIZE), dtype=bool)
        inner[38:42, 30:50] = outer[:3] = True
        found = find(self.image, "scribbles", scribbles=Scribbles(inner, outer))
        assert agreement(found.mask()) > 0.99

    def test_the_border_stands_in_for_the_background(self):
        found = find(self.image, "scribbles", scribbles=Scribbles([[(40, 40)]]))
        assert agreement(found.mask()) > 0.99
        assert any("border counts as background" in note for note in found.notes)

    def test_a_large_picture_is_scaled_down_and_the_result_up(self):
        coverage = disc(250, 800)
        image = blended([0.8, 0.2, 0.2], [0.3, 0.6, 0.3], coverage)
        found = find(image, "scribbles", scribbles=Scribbles([[(350, 400), (450, 400)]]))
        assert found.score.shape == (800, 800)
        assert agreement(found.mask(), coverage) > 0.99

    def test_a_photograph(self):
        # Strokes over the cup and its saucer. The outline must follow the picture's edges.
        strokes = [[(230, 150), (420, 180)], [(250, 250), (400, 250)], [(150, 230), (200, 330)]]
        around = [[(10, 10), (590, 10), (590, 390), (10, 390), (10, 10)]]
        found = find(data.coffee(), "scribbles", scribbles=Scribbles(strokes, around))
        mask = found.mask()
        for x, y in [(300, 30), (300, 350), (120, 180), (450, 250), (370, 300)]:
            assert mask[y, x], f"({x}, {y}) is cup or saucer"
        for x, y in [(60, 60), (560, 200), (520, 60), (80, 330), (480, 380)]:
            assert not mask[y, x], f"({x}, {y}) is table"

    def test_a_stroke_may_leave_the_picture(self):
        scribbles = Scribbles([[(40, 40)]], [[(-1e9, 2), (1e9, 2)]])
        assert agreement(find(self.image, "scribbles", scribbles=scribbles).mask()) > 0.99

    def test_labels_everywhere(self):
        inner = disc() > 0.5
        found = find(self.image, "scribbles", scribbles=Scribbles(inner, ~inner))
        np.testing.assert_array_equal(found.mask(), inner)

    @pytest.mark.parametrize(
        ("foreground", "background", "message"),
        [
            ([], [[(3, 3)]], "no foreground strokes"),
            ([[(300, 3)]], [], "foreground strokes lie outside the image of 80 x 80"),
            ([[(30, 30)]], [[(-5, -5)]], "background strokes lie outside"),
            ([[(3, 3)]], [[(3, 3)]], "all foreground strokes are covered"),
            (np.ones((80, 80), dtype=bool), [], "cover the whole border"),
            (
                np.ones((8, 9), dtype=bool),
                [],
                r"mask has the shape \(8, 9\) and the image \(80, 80\)",
            ),
        ],
    )
    def test_strokes_that_do_not_do(self, foreground, background, message):
        with pytest.raises(TraceError, match=message):
            find(self.image, "scribbles", scribbles=Scribbles(foreground, background))

    @pytest.mark.parametrize("stroke", [[], [(1, 2, 3)], [(1, np.nan)], (1.0, 2.0)])
    def test_strokes_of_a_wrong_shape(self, stroke):
        with pytest.raises(TraceError, match="foreground stroke 0 must be"):
            Scribbles([stroke])

    def test_a_mask_of_a_wrong_shape(self):
        with pytest.raises(TraceError, match="background mask must have the shape"):
            Scribbles([[(1, 1)]], np.zeros(3, dtype=bool))

    def test_none_at_all(self):
        with pytest.raises(TraceError, match="needs scribbles"):
            TraceOptions(method="scribbles")


class TestAuto:
    def method(self, image, **options) -> str:
        found = find(image, **options)
        assert found.notes[0].startswith("foreground by ")
        return found.method

    def test_alpha_where_it_tells_something(self):
        assert self.method(np.dstack([blended([1, 0, 0], [0, 0, 1]), disc()])) == "alpha"

    def test_colour_where_the_border_is_uniform(self):
        assert self.method(blended([1, 0, 0], [0, 0, 1])) == "color"
        opaque = np.dstack([blended([1, 0, 0], [0, 0, 1]), np.ones_like(disc())])
        assert self.method(opaque) == "color"
        opaque[3, 3, 3] = 0  # a speck
        assert self.method(opaque) == "color"

    def test_otsu_otherwise(self):
        ramp = np.tile(np.linspace(0.5, 1, SIZE), (SIZE, 1))
        found = find(np.where(disc() > 0.5, 0.1, ramp))
        assert found.method == "threshold"
        assert agreement(found.mask()) > 0.99

    def test_what_the_user_gave(self):
        image = np.dstack([blended([1, 0, 0], [0, 0, 1]), disc()])
        assert self.method(image, background=(0, 0, 1)) == "color"
        assert self.method(image, scribbles=Scribbles([[(40, 40)]])) == "scribbles"


class TestLevels:
    def test_otsu_takes_the_middle_of_a_plateau(self):
        values = np.array([[0.1] * 30 + [0.9] * 10], dtype=np.float32)
        assert otsu(histogram(values)) == pytest.approx(0.5, abs=0.01)

    def test_otsu_agrees_with_scikit_image(self):
        from skimage.filters import threshold_otsu

        for image in (data.camera(), data.coins(), data.moon()):
            values = (image / 255).astype(np.float32)
            assert otsu(histogram(values)) == pytest.approx(threshold_otsu(values), abs=0.01)

    def test_a_large_picture_is_sampled(self):
        values = np.tile(np.linspace(0, 0.999, 2000, dtype=np.float32), (2000, 1))
        shares = histogram(values)
        assert shares.sum() == pytest.approx(1)
        np.testing.assert_allclose(shares, 1 / 256, rtol=0.3)


def test_smoothing_by_default_leaves_a_thin_bar():
    bar = np.pad(np.zeros((3, 3000), np.uint8), 5, constant_values=255)
    assert find(bar, "color").mask().sum() == 9000
    with pytest.raises(TraceError, match="no foreground"):
        find(bar, "color", smoothing=3).mask()


def test_smoothing_removes_noise():
    noisy = (blended([0.35], [0.65])[..., 0] + RNG.normal(0, 0.15, (SIZE, SIZE))).clip(0, 1)
    rough = find(noisy, "threshold", smoothing=0)
    smooth = find(noisy, "threshold", smoothing=2)
    assert agreement(smooth.mask()) > 0.98 > agreement(rough.mask())


@pytest.mark.parametrize("image", [np.zeros((5, 5)), np.full((50, 90, 4), 0.3)])
def test_one_colour(image):
    with pytest.raises(TraceError, match="the image has one colour only"):
        find(image)


@pytest.mark.parametrize(
    ("image", "colours"),
    [
        (np.full((9, 9, 3), 255, np.uint8), "red 255, green 255, blue 255, alpha 255 (of 255)"),
        (np.full((9, 9), 128, np.uint8), "red 128, green 128, blue 128, alpha 255 (of 255)"),
        (np.full((9, 9), 32896, np.uint16), "red 128, green 128, blue 128, alpha 255 (of 255)"),
    ],
)
def test_the_one_colour_is_told_as_elsewhere(image, colours):
    with pytest.raises(TraceError) as caught:
        find(image)
    assert colours in str(caught.value)


def test_one_odd_pixel_is_found_anywhere():
    image = np.zeros((90, 91))
    image[41, 3] = 1
    assert find(image, smoothing=0).mask().sum() == 1


class TestDoubt:
    @pytest.mark.parametrize("name", ["cat", "coffee", "rocket", "astronaut", "moon", "brick"])
    def test_on_a_photograph_the_foreground_is_a_guess(self, name: str):
        tracing = trace(getattr(data, name)())
        assert tracing.doubt
        assert trace(getattr(data, name)(), threshold=0.5, method="threshold").doubt == ""

    @pytest.mark.parametrize("quality", [40, 90])
    def test_a_cut_out_on_one_colour_is_none(self, quality: int):
        picture = Image.fromarray(samples.image("gecko"))
        white = Image.new("RGBA", picture.size, "white")
        file = io.BytesIO()
        Image.alpha_composite(white, picture).convert("RGB").save(file, "JPEG", quality=quality)
        tracing = trace(file.getvalue())
        assert (tracing.method, tracing.doubt) == ("color", "")
        assert trace(picture).doubt == ""

    def test_two_tones_up_to_the_border_are_clear(self):
        assert trace(np.tri(60) > 0).doubt == ""

    def test_the_counts_of_holes_and_components_agree_with_the_notes(self):
        tracing = trace(data.cat())
        notes = " ".join(tracing.notes)
        assert f"{tracing.n_filled} small holes were filled" in notes
        assert f"{tracing.n_components - 1} smaller components" in notes
