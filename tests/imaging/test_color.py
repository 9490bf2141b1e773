"""Colours are converted to sRGB on reading, and exports say that they are sRGB."""

from __future__ import annotations

import io
import struct
import zlib

import numpy as np
import pytest
import tifffile
from PIL import Image
from skimage.color import lab2rgb

from glid_nb.imaging import as_rgba8, png, read_image
from glid_nb.imaging.color import ColorWarning

from .formats import written
from .pngs import GREY, GREY_ALPHA, PALETTE, RGB, RGBA, chunk, png_file
from .profiles import ADOBE_RGB, DISPLAY_P3, cmyk_profile, grey_profile, matrix_profile

# (200, 30, 40) of Display P3, by its definition: SMPTE EG 432-1 primaries, D65, sRGB's curve.
P3_TO_SRGB = np.array(
    [[1.2249402, -0.2249402, 0], [-0.0420570, 1.0420570, 0], [-0.0196376, -0.0786361, 1.0982736]]
)
RNG = np.random.default_rng(5)


def linear(value: np.ndarray) -> np.ndarray:
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


def encoded(light: np.ndarray) -> np.ndarray:
    light = np.clip(light, 0, 1)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def from_p3(colours: np.ndarray, full: int = 255) -> np.ndarray:
    return full * encoded(linear(colours / full) @ P3_TO_SRGB.T)


def iccp(profile: bytes) -> bytes:
    return chunk(b"iCCP", b"test\0\0" + zlib.compress(profile))


def saved(picture: Image.Image, kind: str, **settings) -> bytes:
    file = io.BytesIO()
    picture.save(file, kind, **settings)
    return file.getvalue()


COLOURS = RNG.integers(0, 256, (6, 8, 3))
COLOURS[0, 0] = 200, 30, 40


class TestProfiles:
    def test_a_display_p3_png(self) -> None:
        image = read_image(png_file(COLOURS, 8, RGB, iccp(matrix_profile(DISPLAY_P3))))
        assert np.abs(image[..., :3] - from_p3(COLOURS)).max() <= 2
        assert np.abs(image[0, 0, :3].astype(int) - (200, 30, 40)).max() >= 15
        assert (image[..., 3] == 255).all()

    @pytest.mark.parametrize("kind", written("PNG", "JPEG", "TIFF", "WEBP", "AVIF", "JPEG2000"))
    def test_formats_that_embed_profiles(self, kind: str) -> None:
        flat = Image.new("RGB", (32, 32), (200, 60, 70))
        lossless = {"WEBP": {"lossless": True}, "JPEG": {"quality": 100, "subsampling": 0}}
        data = saved(flat, kind, icc_profile=matrix_profile(DISPLAY_P3), **lossless.get(kind, {}))
        if not Image.open(io.BytesIO(data)).info.get("icc_profile"):
            assert kind == "JPEG2000"  # Pillow does not write it
            return
        expected = from_p3(np.array([200, 60, 70]))
        assert np.abs(read_image(data)[16, 16, :3] - expected).max() <= 4

    def test_adobe_rgb(self) -> None:
        data = png_file(COLOURS, 8, RGB, iccp(matrix_profile(ADOBE_RGB, 2.19921875)))
        grey = np.full((2, 2, 3), 128)
        # Greys stay grey under another curve; a saturated green becomes more saturated.
        same = read_image(png_file(grey, 8, RGB, iccp(matrix_profile(ADOBE_RGB, 2.19921875))))
        assert np.ptp(same[0, 0, :3]) <= 1
        green = np.tile(np.array([100, 200, 100]), (2, 2, 1))
        wide = read_image(png_file(green, 8, RGB, iccp(matrix_profile(ADOBE_RGB, 2.19921875))))
        assert wide[0, 0, 0] < 60
        assert read_image(data).dtype == np.uint8

    def test_the_srgb_profile_changes_no_bit(self) -> None:
        from PIL import ImageCms

        profile = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
        np.testing.assert_array_equal(
            read_image(png_file(COLOURS, 8, RGB, iccp(profile)))[..., :3], COLOURS
        )
        wide = RNG.integers(0, 65536, (5, 7, 3))
        image = read_image(png_file(wide, 16, RGB, iccp(profile)))
        assert image.dtype == np.uint16
        np.testing.assert_array_equal(image[..., :3], wide)

    def test_sixteen_bit_colours_are_converted_in_eight(self) -> None:
        wide = COLOURS * 257
        image = read_image(png_file(wide, 16, RGB, iccp(matrix_profile(DISPLAY_P3))))
        assert image.dtype == np.uint8
        assert np.abs(image[..., :3] - from_p3(COLOURS)).max() <= 2

    def test_transparency_stays(self) -> None:
        values = np.dstack([COLOURS, np.arange(48).reshape(6, 8) * 5])
        image = read_image(png_file(values, 8, RGBA, iccp(matrix_profile(DISPLAY_P3))))
        np.testing.assert_array_equal(image[..., 3], values[..., 3])
        assert np.abs(image[..., :3] - from_p3(COLOURS)).max() <= 2
        key = chunk(b"tRNS", struct.pack(">3H", *COLOURS[0, 0]))
        keyed = read_image(png_file(COLOURS, 8, RGB, iccp(matrix_profile(DISPLAY_P3)) + key))
        assert keyed[0, 0, 3] == 0
        assert np.abs(keyed[1:, :, :3] - from_p3(COLOURS[1:])).max() <= 2

    def test_a_palette(self) -> None:
        palette = COLOURS.reshape(-1, 3)[:4].astype(np.uint8)
        chunks = iccp(matrix_profile(DISPLAY_P3)) + chunk(b"PLTE", palette.tobytes())
        image = read_image(png_file(np.arange(4).reshape(2, 2, 1), 2, PALETTE, chunks))
        assert np.abs(image.reshape(4, 4)[:, :3] - from_p3(palette)).max() <= 2

    @pytest.mark.parametrize(("depth", "kind"), [(8, GREY), (16, GREY), (8, GREY_ALPHA)])
    def test_grey_profiles(self, depth: int, kind: int) -> None:
        channels = 1 if kind == GREY else 2
        values = np.full((3, 4, channels), 100 * (257 if depth == 16 else 1))
        image = as_rgba8(read_image(png_file(values, depth, kind, iccp(grey_profile(1.0)))))
        # Linear light 100 of 255 is 168 in sRGB.
        assert np.abs(image[0, 0, :3].astype(int) - 168).max() <= 1
        assert image[0, 0, 3] == (100 if channels == 2 else 255)

    def test_a_cmyk_jpeg(self) -> None:
        inks = Image.new("CMYK", (16, 16), (255, 0, 0, 0))
        plain = read_image(saved(inks, "JPEG", quality=100))[8, 8]
        image = read_image(saved(inks, "JPEG", quality=100, icc_profile=cmyk_profile()))[8, 8]
        # L* = 195 of 255, a* = -30, b* = 0 by the profile; without a profile (0, 255, 255).
        expected = 255 * lab2rgb([195 / 2.55, -30.0, 0.0])
        assert np.abs(image[:3] - expected).max() <= 8
        assert np.abs(plain[:3].astype(int) - (0, 255, 255)).max() <= 4
        assert image[3] == 255

    def test_a_16_bit_tiff(self) -> None:
        values = (COLOURS * 257).astype(np.uint16)
        file = io.BytesIO()
        tifffile.imwrite(file, values, photometric="rgb", iccprofile=matrix_profile(DISPLAY_P3))
        image = read_image(file.getvalue())
        assert np.abs(image[..., :3] - from_p3(COLOURS)).max() <= 2
        assert np.abs(read_image(Image.open(file))[..., :3] - from_p3(COLOURS)).max() <= 2

    def test_a_picture_that_pillow_opened(self) -> None:
        picture = Image.open(
            io.BytesIO(png_file(COLOURS, 8, RGB, iccp(matrix_profile(DISPLAY_P3))))
        )
        picture.load()
        assert np.abs(read_image(picture)[..., :3] - from_p3(COLOURS)).max() <= 2


class TestDamaged:
    @pytest.mark.parametrize(
        "profile",
        [b"nonsense", matrix_profile(DISPLAY_P3)[:300], cmyk_profile(), b""],
        ids=["no profile", "cut short", "of other inks", "empty"],
    )
    def test_a_profile_that_cannot_be_used_is_told_and_ignored(self, profile: bytes) -> None:
        data = png_file(COLOURS, 8, RGB, iccp(profile))
        if profile:
            with pytest.warns(ColorWarning, match=r"^a\.png: its colour profile cannot be used"):
                image = read_image(data, "a.png")
        else:
            image = read_image(data, "a.png")
        np.testing.assert_array_equal(image[..., :3], COLOURS)

    def test_a_grey_profile_in_a_coloured_picture(self) -> None:
        data = png_file(COLOURS, 8, RGB, iccp(grey_profile(1.0)))
        with pytest.warns(ColorWarning, match="profile is for grey pictures"):
            image = read_image(data)
        np.testing.assert_array_equal(image[..., :3], COLOURS)

    def test_an_rgb_profile_in_a_grey_picture_is_used(self) -> None:
        values = np.full((3, 4, 1), 100)
        image = read_image(png_file(values, 8, GREY, iccp(matrix_profile(DISPLAY_P3, 1.0))))
        assert np.abs(image[0, 0, :3].astype(int) - 168).max() <= 1

    def test_a_cmyk_jpeg_with_a_damaged_profile(self) -> None:
        inks = Image.new("CMYK", (16, 16), (255, 0, 0, 0))
        data = saved(inks, "JPEG", quality=100, icc_profile=b"nonsense")
        with pytest.warns(ColorWarning, match="profile cannot be used"):
            image = read_image(data)
        assert np.abs(image[8, 8, :3].astype(int) - (0, 255, 255)).max() <= 4


def floats(kind: bytes, *values: float) -> bytes:
    numbers = [round(100000 * value) for value in values]
    return chunk(kind, struct.pack(f">{len(numbers)}I", *numbers))


P3_CHROMATICITIES = floats(b"cHRM", 0.3127, 0.3290, 0.680, 0.320, 0.265, 0.690, 0.150, 0.060)
SRGB_CHROMATICITIES = floats(b"cHRM", 0.3127, 0.3290, 0.64, 0.33, 0.30, 0.60, 0.15, 0.06)


class TestPngChunks:
    @pytest.mark.parametrize("depth", [8, 16])
    def test_cicp_of_display_p3(self, depth: int) -> None:
        full = (1 << depth) - 1
        values = COLOURS * (full // 255)
        image = read_image(png_file(values, depth, RGB, chunk(b"cICP", bytes([12, 13, 0, 1]))))
        assert image.dtype == (np.uint8 if depth == 8 else np.uint16)
        error = np.abs(image[..., :3] - from_p3(values, full)).max() / full
        assert error < (0.003 if depth == 8 else 3e-4)

    def test_cicp_comes_before_a_profile(self) -> None:
        both = chunk(b"cICP", bytes([1, 13, 0, 1])) + iccp(matrix_profile(DISPLAY_P3))
        np.testing.assert_array_equal(read_image(png_file(COLOURS, 8, RGB, both))[..., :3], COLOURS)

    def test_an_unknown_cicp_is_told(self) -> None:
        hdr = chunk(b"cICP", bytes([9, 16, 0, 1]))
        with pytest.warns(ColorWarning, match=r"space \(cICP 9, 16, 0, 1\) is not known"):
            image = read_image(png_file(COLOURS, 8, RGB, hdr))
        np.testing.assert_array_equal(image[..., :3], COLOURS)

    def test_a_linear_picture(self) -> None:
        image = read_image(png_file(COLOURS, 8, RGB, floats(b"gAMA", 1.0)))
        assert np.abs(image[..., :3] - 255 * encoded(COLOURS / 255)).max() <= 1

    def test_gamma_and_primaries(self) -> None:
        chunks = floats(b"gAMA", 0.45455) + P3_CHROMATICITIES
        image = read_image(png_file(COLOURS, 8, RGB, chunks))
        assert np.abs(image[..., :3] - from_p3(COLOURS)).max() <= 2

    @pytest.mark.parametrize(
        "chunks",
        [
            floats(b"gAMA", 0.45455),
            floats(b"gAMA", 0.45455) + SRGB_CHROMATICITIES,
            chunk(b"sRGB", b"\0") + floats(b"gAMA", 1.0) + P3_CHROMATICITIES,
            P3_CHROMATICITIES,  # nothing without gAMA
            floats(b"gAMA", 0.0),
            chunk(b"cICP", bytes([1, 13, 0, 1])),
            b"",
        ],
    )
    def test_what_says_srgb_changes_no_bit(self, chunks: bytes) -> None:
        image = read_image(png_file(COLOURS, 8, RGB, chunks))
        np.testing.assert_array_equal(image[..., :3], COLOURS)

    def test_impossible_primaries_are_told(self) -> None:
        chunks = floats(b"gAMA", 0.6) + floats(b"cHRM", *(0.3, 0.3) * 4)
        with pytest.warns(ColorWarning, match="its primaries"):
            image = read_image(png_file(COLOURS, 8, RGB, chunks))
        np.testing.assert_array_equal(image[..., :3], COLOURS)


def test_a_png_says_that_it_is_srgb() -> None:
    for pixels in (np.zeros((3, 4), np.uint8), np.zeros((3, 4, 3), np.uint8), COLOURS.astype("u1")):
        data = png(pixels)
        assert Image.open(io.BytesIO(data)).info["srgb"] == 0
        np.testing.assert_array_equal(as_rgba8(read_image(data)), as_rgba8(pixels))
