"""Transparent parts of a file stay transparent, in every mode of PNG and in other formats."""

from __future__ import annotations

import io
import struct
from typing import Any

import numpy as np
import pytest
import tifffile
from PIL import Image

from glid_nb.imaging import TraceError, as_rgba8, read_image, trace
from glid_nb.imaging.color import ColorWarning

from .formats import written
from .pngs import CHANNELS, GREY, GREY_ALPHA, PALETTE, RGB, RGBA, chunk, png_file

RNG = np.random.default_rng(11)
KEYED = [(1, GREY), (2, GREY), (4, GREY), (8, GREY), (16, GREY), (8, RGB), (16, RGB)]


def samples(depth: int, color_type: int) -> np.ndarray:
    return RNG.integers(0, 1 << depth, (11, 13, CHANNELS[color_type]))


def in_full(values: np.ndarray, depth: int) -> np.ndarray:
    """Samples scaled to the 8 or 16 bits of the result."""
    return values * (255 // ((1 << depth) - 1)) if depth < 8 else values


@pytest.mark.parametrize("interlaced", [False, True])
@pytest.mark.parametrize(("depth", "color_type"), KEYED)
def test_one_transparent_colour(depth: int, color_type: int, interlaced: bool) -> None:
    values = samples(depth, color_type)
    key = values[4, 5]
    # Alike only in the high bytes, so they are visible.
    values[0, 0] = key ^ 1
    body = struct.pack(f">{len(key)}H", *key)
    image = read_image(png_file(values, depth, color_type, chunk(b"tRNS", body), interlaced))
    full = 65535 if depth == 16 else 255
    assert image.dtype == (np.uint16 if depth == 16 else np.uint8)
    expected = np.where((values == key).all(axis=2), 0, full)
    np.testing.assert_array_equal(image[..., 3], expected)
    assert image[4, 5, 3] == 0
    assert image[0, 0, 3] == full
    colours = np.broadcast_to(in_full(values, depth), (11, 13, 3))
    seen = expected > 0
    np.testing.assert_array_equal(image[..., :3][seen], colours[seen])


@pytest.mark.parametrize(("depth", "color_type"), KEYED)
def test_without_a_transparent_colour_all_is_seen(depth: int, color_type: int) -> None:
    values = samples(depth, color_type)
    image = read_image(png_file(values, depth, color_type))
    assert (image[..., 3] == (65535 if depth == 16 else 255)).all()
    np.testing.assert_array_equal(image[..., 0], in_full(values, depth)[..., 0])


@pytest.mark.parametrize("depth", [1, 2, 4, 8])
def test_transparent_entries_of_a_palette(depth: int) -> None:
    values = samples(depth, PALETTE)
    palette = RNG.integers(0, 256, (1 << depth, 3), dtype=np.uint8)
    alpha = np.full(1 << depth, 255, np.uint8)
    alpha[:2] = 0, 77
    chunks = chunk(b"PLTE", palette.tobytes()) + chunk(b"tRNS", alpha[:2].tobytes())
    image = read_image(png_file(values, depth, PALETTE, chunks))
    np.testing.assert_array_equal(image[..., 3], alpha[values[..., 0]])
    np.testing.assert_array_equal(image[..., :3], palette[values[..., 0]])


@pytest.mark.parametrize("interlaced", [False, True])
@pytest.mark.parametrize("color_type", [GREY_ALPHA, RGBA])
@pytest.mark.parametrize("depth", [8, 16])
def test_alpha_with_all_its_bits(depth: int, color_type: int, interlaced: bool) -> None:
    values = samples(depth, color_type)
    image = read_image(png_file(values, depth, color_type, interlaced=interlaced))
    assert image.dtype == (np.uint16 if depth == 16 else np.uint8)
    np.testing.assert_array_equal(image[..., 3], values[..., -1])
    np.testing.assert_array_equal(image[..., 2], values[..., -2])


def test_bits_of_the_key_beyond_the_depth_are_ignored() -> None:
    values = samples(8, RGB)
    key = values[2, 3] + 256
    data = png_file(values, 8, RGB, chunk(b"tRNS", struct.pack(">3H", *key)))
    assert read_image(data)[2, 3, 3] == 0


@pytest.mark.parametrize("orientation", [1, 3, 6, 8])
def test_sixteen_bit_pictures_are_turned_upright(orientation: int) -> None:
    values = samples(16, RGB)
    exif = Image.Exif()
    exif[0x0112] = orientation
    data = png_file(values, 16, RGB, chunk(b"eXIf", exif.tobytes()[6:]))
    turns = {1: 0, 3: 2, 6: 3, 8: 1}[orientation]
    np.testing.assert_array_equal(read_image(data)[..., :3], np.rot90(values, turns))


@pytest.mark.parametrize(("depth", "color_type"), [(2, GREY), (16, GREY), (16, RGB)])
def test_a_picture_that_pillow_opened_is_read_the_same(depth: int, color_type: int) -> None:
    values = samples(depth, color_type)
    key = struct.pack(f">{CHANNELS[color_type]}H", *values[1, 1])
    data = png_file(values, depth, color_type, chunk(b"tRNS", key))
    picture = Image.open(io.BytesIO(data))
    np.testing.assert_array_equal(read_image(picture), read_image(data))
    assert picture.getpixel((0, 0)) is not None  # it can still be used


def test_a_shape_on_a_transparent_colour_is_traced() -> None:
    """The background has almost the shape's colour, so only tRNS tells them apart."""
    values = np.full((60, 80, 3), 30000)
    values[15:45, 20:60] = 30001
    data = png_file(values, 16, RGB, chunk(b"tRNS", struct.pack(">3H", 30000, 30000, 30000)))
    tracing = trace(data, offset=0, simplify=0.1)
    assert tracing.method == "alpha"
    assert tracing.mask.sum() == 30 * 40


def tiff(values: np.ndarray, **settings) -> bytes:
    file = io.BytesIO()
    tifffile.imwrite(file, values, **settings)
    return file.getvalue()


class TestTiff:
    @pytest.mark.parametrize("compression", [None, "zlib"])
    @pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
    def test_straight_alpha(self, dtype, compression) -> None:
        values = RNG.integers(0, np.iinfo(dtype).max, (5, 7, 4), dtype=dtype)
        how = {"photometric": "rgb", "extrasamples": ["unassalpha"], "compression": compression}
        np.testing.assert_array_equal(read_image(tiff(values, **how)), values)

    @pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float32])
    def test_premultiplied_alpha(self, dtype) -> None:
        full = 1 if dtype == np.float32 else np.iinfo(dtype).max
        straight = RNG.random((5, 7, 4))
        straight[..., 3] = 0.2 + 0.8 * straight[..., 3]
        straight[0, 0] = 0
        stored = straight.copy()
        stored[..., :3] *= stored[..., 3:]
        data = tiff(
            (np.rint(stored * full) if full > 1 else stored).astype(dtype),
            photometric="rgb",
            extrasamples=["assocalpha"],
        )
        error = np.abs(read_image(data) / (255 if dtype == np.uint8 else 65535) - straight)
        assert error.max() < (0.015 if dtype == np.uint8 else 1e-4)

    def test_grey_and_alpha_of_16_bit(self) -> None:
        values = RNG.integers(0, 65536, (5, 7, 2), dtype=np.uint16)
        image = read_image(tiff(values, photometric="minisblack", extrasamples=["unassalpha"]))
        np.testing.assert_array_equal(image[..., 3], values[..., 1])
        np.testing.assert_array_equal(image[..., 1], values[..., 0])

    def test_a_sample_that_is_not_said_to_be_alpha_is_none(self) -> None:
        values = RNG.integers(0, 65536, (5, 7, 4), dtype=np.uint16)
        image = read_image(tiff(values, photometric="rgb", extrasamples=["unspecified"]))
        assert (image[..., 3] == 65535).all()
        np.testing.assert_array_equal(image[..., :3], values[..., :3])

    def test_white_is_zero(self) -> None:
        values = RNG.integers(0, 65536, (5, 7), dtype=np.uint16)
        image = read_image(tiff(values, photometric="miniswhite"))
        np.testing.assert_array_equal(image[..., 0], 65535 - values)

    def test_a_16_bit_tiff_is_turned_upright(self) -> None:
        values = RNG.integers(0, 65536, (5, 7, 3), dtype=np.uint16)
        tag = (274, "H", 1, 6, True)
        image = read_image(tiff(values, photometric="rgb", extratags=[tag]))
        np.testing.assert_array_equal(image[..., :3], np.rot90(values, 3))


class TestOthers:
    def test_a_transparent_entry_of_a_gif(self) -> None:
        picture = Image.new("P", (4, 3), 1)
        picture.putpalette([10, 20, 30, 200, 0, 0])
        picture.putpixel((2, 1), 0)
        file = io.BytesIO()
        picture.save(file, "GIF", transparency=0)
        image = read_image(file.getvalue())
        assert image[1, 2, 3] == 0
        assert (image[..., 3] == 255).sum() == 11

    @pytest.mark.parametrize("kind", written("WEBP", "AVIF", "ICO", "JPEG2000", "TIFF", "QOI"))
    def test_alpha_of_other_formats(self, kind: str) -> None:
        alpha = np.zeros((32, 32), np.uint8)
        alpha[8:24, 8:24] = 255
        pixels = np.dstack([np.full((32, 32, 3), 90, np.uint8), alpha])
        file = io.BytesIO()
        Image.fromarray(pixels).save(file, kind)
        assert np.mean(np.abs(read_image(file.getvalue())[..., 3].astype(int) - alpha)) < 3

    @pytest.mark.parametrize("mode", ["LA", "PA", "RGBA", "RGBa", "La"])
    def test_pillows_modes_with_alpha(self, mode: str) -> None:
        pixels = np.zeros((4, 6, 4), np.uint8)
        pixels[..., :3] = 60
        pixels[:2, :, 3] = 128
        pixels[2:, :, 3] = 255
        picture = Image.fromarray(pixels)
        for step in {"La": ["LA", "La"], "PA": ["P", "PA"]}.get(mode, [mode]):
            picture = picture.convert(step)
        if mode == "PA":
            picture.putalpha(Image.fromarray(np.ascontiguousarray(pixels[..., 3])))
        image = as_rgba8(read_image(picture))
        np.testing.assert_array_equal(image[..., 3], pixels[..., 3])
        assert np.abs(image[..., :3].astype(int) - 60).max() <= 1

    @pytest.mark.parametrize("mode", ["1", "L", "P", "RGB", "CMYK", "YCbCr", "HSV", "LAB", "I;16"])
    def test_pillows_modes_without_alpha_are_opaque(self, mode: str) -> None:
        image = as_rgba8(read_image(Image.new(mode, (3, 2))))
        assert (image[..., 3] == 255).all()


class TestDecoded:
    """Pictures that Pillow has decoded before they are read."""

    @staticmethod
    def decoded(depth: int, color_type: int, key: tuple[int, ...]) -> Image.Image:
        values = samples(depth, color_type)
        values[4, 5] = key
        body = struct.pack(f">{len(key)}H", *key)
        picture = Image.open(io.BytesIO(png_file(values, depth, color_type, chunk(b"tRNS", body))))
        picture.load()
        return picture.copy()

    def test_16_bit_grey(self) -> None:
        image = read_image(self.decoded(16, GREY, (300,)))
        assert image.dtype == np.uint16
        assert image[4, 5, 3] == 0
        assert (image[..., 3] == 65535).sum() == 11 * 13 - (image[..., 3] == 0).sum()

    def test_16_bit_colours_lose_bits_with_a_warning(self) -> None:
        picture = self.decoded(16, RGB, (300, 40000, 5))
        with pytest.warns(ColorWarning, match="decoded to 8 bit.*pass the file's path"):
            image = read_image(picture)
        assert image[4, 5, 3] == 0

    def test_a_grey_of_few_bits_that_no_pixel_has_is_told(self) -> None:
        picture = Image.fromarray(np.arange(0, 256, 85, dtype=np.uint8)[None].repeat(4, axis=0))
        picture.info["transparency"] = 1  # of 2 bits
        with pytest.warns(ColorWarning, match="transparent grey 1, but no pixel has"):
            read_image(picture)


def test_masked_pixels_are_transparent() -> None:
    masked_array: Any = np.ma.array  # its types have no masks
    grey = np.full((2, 3), 200, np.uint8)
    image = read_image(masked_array(grey, mask=[[1, 0, 0], [0, 0, 0]]))
    assert image[..., 3].tolist() == [[0, 255, 255], [255, 255, 255]]
    colours = masked_array(np.full((2, 2, 3), 9, np.uint8), mask=np.zeros((2, 2, 3)))
    colours[0, 1, 2] = np.ma.masked
    assert read_image(colours)[..., 3].tolist() == [[255, 0], [255, 255]]


@pytest.mark.parametrize("spot", [0, 1, 3])
def test_a_few_opaque_pixels_do_not_hide_a_faint_shape(spot: int) -> None:
    y, x = np.mgrid[:64, :64]
    image = np.zeros((64, 64, 4), np.uint8)
    image[(x - 32) ** 2 + (y - 32) ** 2 < 23**2, 3] = 100
    image[32 : 32 + spot, 32 : 32 + spot, 3] = 255
    with pytest.raises(TraceError, match=r"alpha up to 39 %; lower the threshold, to 0\.2"):
        trace(image)
    assert trace(image, threshold=0.2).cage.longer_side > 14
