"""All kinds of pictures become the same RGBA array."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
import tifffile
from PIL import Image

from glid_nb.imaging import TraceError, as_rgba, as_rgba8, read_image
from glid_nb.imaging.read import MAX_SIDE

from .formats import written

RNG = np.random.default_rng(7)


def encoded(picture: Image.Image, kind: str, **options) -> bytes:
    buffer = io.BytesIO()
    picture.save(buffer, kind, **options)
    return buffer.getvalue()


@pytest.fixture
def colors() -> np.ndarray:
    """(5, 7, 4) uint8, no two channels alike."""
    return RNG.integers(0, 256, (5, 7, 4), dtype=np.uint8)


class TestArrays:
    def test_rgba_is_passed_on(self, colors):
        assert as_rgba(colors) is colors

    @pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
    @pytest.mark.parametrize("channels", [None, 1, 2, 3, 4])
    def test_channels(self, dtype, channels):
        full = np.iinfo(dtype).max
        shape = (5, 7) if channels is None else (5, 7, channels)
        image = RNG.integers(0, full + 1, shape, dtype=dtype)
        rgba = as_rgba(image)
        assert rgba.dtype == dtype
        planes = image[..., np.newaxis] if channels is None else image
        for channel in range(3):
            expected = planes[..., channel if channels in (3, 4) else 0]
            np.testing.assert_array_equal(rgba[..., channel], expected)
        if channels in (2, 4):
            np.testing.assert_array_equal(rgba[..., 3], planes[..., -1])
        else:
            assert (rgba[..., 3] == full).all()

    @pytest.mark.parametrize("dtype", [np.float16, np.float32, np.float64])
    def test_floats_fill_16_bit(self, dtype):
        rgba = as_rgba(np.array([[0, 0.5, 1]], dtype=dtype))
        assert rgba.dtype == np.uint16
        assert rgba[0, :, 0].tolist() == [0, 32768, 65535]

    def test_rounding_beyond_the_range_is_forgiven(self):
        rgba = as_rgba(np.array([[-1e-9, 1 + 1e-9]]))
        assert rgba[0, :, 1].tolist() == [0, 65535]

    def test_masks(self):
        assert as_rgba(np.array([[True, False]]))[0].tolist() == [[255] * 4, [0, 0, 0, 255]]

    def test_lists_and_foreign_byte_order(self):
        assert as_rgba([[0.0, 1.0]]).shape == (1, 2, 4)
        big = np.array([[1, 258]], dtype=">u2")
        assert as_rgba(big)[0, :, 0].tolist() == [1, 258]
        assert as_rgba(big).dtype.isnative

    def test_8_bit(self, colors):
        assert as_rgba8(colors).dtype == np.uint8
        np.testing.assert_array_equal(as_rgba8(colors), colors)
        np.testing.assert_array_equal(as_rgba8(colors.astype(np.uint16) * 257), colors)
        every = np.arange(65536, dtype=np.uint16).reshape(256, 256)
        expected = np.rint(every / 257)
        np.testing.assert_array_equal(as_rgba8(every)[..., 0], expected)


class TestFormats:
    @pytest.mark.parametrize(
        "kind", written("png", "jpeg", "gif", "tiff", "webp", "bmp", "ppm", "jpeg2000", "avif")
    )
    def test_formats_of_pixels_are_read(self, kind):
        data = encoded(Image.new("RGB", (7, 5), (250, 0, 0)), kind)
        assert read_image(data).shape == (5, 7, 4)

    def test_no_program_is_started(self, monkeypatch):
        """Pillow hands EPS to Ghostscript."""
        data = encoded(Image.new("RGB", (7, 5)), "eps")
        monkeypatch.setattr("PIL.EpsImagePlugin.Ghostscript", None)
        with pytest.raises(TraceError, match="not in a picture format that can be read"):
            read_image(data)

    def test_a_session_is_no_picture(self):
        says = r"^a\.glid is a session or another zip file; .* glid_nb\.Editor\(path=\.\.\.\)$"
        with pytest.raises(TraceError, match=says):
            read_image(b"PK\x03\x04 and so on", "a.glid")


class TestNames:
    def test_a_picture_is_called_by_the_name_that_was_given(self):
        with pytest.raises(TraceError, match=r"^mine\.png is not in a picture format"):
            read_image(b"nothing", "mine.png")
        with pytest.raises(TraceError, match=r"^the picture is not in a picture format"):
            read_image(b"nothing")
        wide = Image.new("L", (MAX_SIDE + 1, 1))
        with pytest.raises(TraceError, match=r"^mine\.png is too large"):
            read_image(encoded(wide, "png"), "mine.png")
        far = Image.fromarray(np.full((3, 3), 7, np.float32))
        with pytest.raises(TraceError, match=r"^mine\.tif: a float image"):
            read_image(encoded(far, "tiff"), "mine.tif")


class TestWrongArrays:
    @pytest.mark.parametrize("shape", [(0, 5), (5, 0), (5, 0, 3), (0, 0, 4), (5, 5, 0)])
    def test_empty(self, shape):
        with pytest.raises(TraceError, match="the image is empty"):
            as_rgba(np.zeros(shape))

    @pytest.mark.parametrize("shape", [(), (5,), (5, 5, 5), (2, 5, 5, 3)])
    def test_shape(self, shape):
        with pytest.raises(TraceError, match=r"must have the shape \(h, w\) or \(h, w, c\)"):
            as_rgba(np.zeros(shape))

    @pytest.mark.parametrize(
        "dtype", [np.int64, np.int16, np.uint32, complex, object, "datetime64[s]"]
    )
    def test_type(self, dtype):
        with pytest.raises(TraceError, match="the image has the type"):
            as_rgba(np.zeros((3, 3)).astype(dtype))

    def test_ragged_rows(self):
        with pytest.raises(TraceError, match="the image is not an array"):
            as_rgba([[1.0, 2.0], [3.0]])

    @pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
    def test_not_finite(self, value):
        image = np.full((300, 4, 3), 0.5)
        image[280, 2, 1] = value
        with pytest.raises(TraceError, match=r"holds -?(nan|inf) in row 280, column 2"):
            as_rgba(image)

    @pytest.mark.parametrize("value", [-0.01, 1.01, 255.0])
    def test_range(self, value):
        with pytest.raises(TraceError, match=rf"must lie in \[0, 1\], this one holds {value:g}"):
            as_rgba(np.array([[0.5, value]]))

    def test_too_large(self):
        image = np.broadcast_to(np.uint8(3), (2, MAX_SIDE + 1))
        with pytest.raises(TraceError, match=f"too large, {MAX_SIDE + 1} x 2 .* most {MAX_SIDE}"):
            as_rgba(image)


class TestFiles:
    def test_png_by_path_bytes_and_image(self, colors, tmp_path):
        picture = Image.fromarray(colors)
        path = tmp_path / "p.png"
        picture.save(path)
        for source in (path, str(path), path.read_bytes(), picture):
            np.testing.assert_array_equal(read_image(source), colors)
        np.testing.assert_array_equal(read_image(colors), colors)

    @pytest.mark.parametrize(
        ("mode", "kind"),
        [
            ("L", "PNG"),
            ("LA", "PNG"),
            ("RGB", "PNG"),
            ("1", "PNG"),
            ("RGB", "BMP"),
            ("CMYK", "TIFF"),
        ],
    )
    def test_modes(self, colors, mode, kind):
        picture = Image.fromarray(colors).convert(mode)
        expected = np.asarray(Image.fromarray(np.asarray(picture.convert("RGBA"))))
        np.testing.assert_array_equal(read_image(encoded(picture, kind)), expected)

    def test_palette_with_transparency(self):
        picture = Image.fromarray(np.array([[0, 1, 2]], dtype=np.uint8), mode=None).convert("P")
        picture.putpalette([10, 20, 30, 40, 50, 60, 70, 80, 90])
        picture.putdata([0, 1, 2])
        data = encoded(picture, "PNG", transparency=1)
        expected = [[10, 20, 30, 255], [40, 50, 60, 0], [70, 80, 90, 255]]
        assert read_image(data)[0].tolist() == expected

    @pytest.mark.parametrize("orientation", range(1, 9))
    def test_exif_orientation(self, orientation):
        # One bright quarter shows the orientation, with any compression.
        stored = np.zeros((16, 32, 3), dtype=np.uint8)
        stored[:8, :16] = 255
        exif = Image.Exif()
        exif[0x0112] = orientation
        data = encoded(Image.fromarray(stored), "JPEG", quality=95, exif=exif)
        image = read_image(data)
        shape = (16, 32) if orientation <= 4 else (32, 16)
        assert image.shape == (*shape, 4)
        bright = image[..., 0] > 128
        rows, columns = (s // 2 for s in shape)
        expected = np.zeros(shape, dtype=bool)
        corners = [(0, 0), (0, 1), (1, 1), (1, 0)]  # of orientations 1 to 4, and again of 5 to 8
        i, j = corners[(orientation - 1) % 4]
        expected[i * rows : (i + 1) * rows, j * columns : (j + 1) * columns] = True
        assert np.mean(bright == expected) > 0.99

    def test_the_first_frame_of_a_gif(self):
        frames = [Image.new("RGB", (4, 3), color) for color in ("red", "blue")]
        data = encoded(frames[0], "GIF", save_all=True, append_images=frames[1:])
        assert (read_image(data) == [255, 0, 0, 255]).all()

    def test_16_bit_grey_png(self):
        values = np.array([[0, 300, 65535]], dtype=np.uint16)
        image = read_image(encoded(Image.fromarray(values), "PNG"))
        assert image.dtype == np.uint16
        assert image[0, :, 2].tolist() == [0, 300, 65535]

    @pytest.mark.parametrize("planar", [False, True])
    def test_16_bit_color_tiff(self, planar):
        values = RNG.integers(0, 65536, (5, 7, 3), dtype=np.uint16)
        buffer = io.BytesIO()
        stored = np.moveaxis(values, -1, 0) if planar else values
        config = "separate" if planar else "contig"
        tifffile.imwrite(buffer, stored, photometric="rgb", planarconfig=config)
        image = read_image(buffer.getvalue())
        assert image.dtype == np.uint16
        np.testing.assert_array_equal(image[..., :3], values)
        assert (image[..., 3] == 65535).all()

    @pytest.mark.parametrize("channels", [3, 4])
    def test_a_compression_that_only_pillow_knows_keeps_16_bit(self, channels, monkeypatch):
        """LZW needs a package beside tifffile."""
        values = RNG.integers(0, 65536, (5, 7, channels), dtype=np.uint16)
        buffer = io.BytesIO()
        more = {"extrasamples": ["unassalpha"]} if channels == 4 else {}
        tifffile.imwrite(buffer, values, photometric="rgb", compression="zlib", **more)

        def refuse(*_):
            raise ValueError("<COMPRESSION.LZW: 5> requires the 'imagecodecs' package")

        monkeypatch.setattr("glid_nb.imaging.decode.tiff_pixels", refuse)
        image = read_image(buffer.getvalue())
        assert image.dtype == np.uint16
        np.testing.assert_array_equal(image[..., :channels], values)

    def test_16_bit_grey_under_lzw(self):
        values = RNG.integers(0, 65536, (5, 7), dtype=np.uint16)
        image = read_image(encoded(Image.fromarray(values), "TIFF", compression="tiff_lzw"))
        np.testing.assert_array_equal(image[..., 0], values)

    def test_float_tiff(self):
        buffer = io.BytesIO()
        tifffile.imwrite(buffer, np.array([[0, 0.25, 1]], dtype=np.float32))
        assert read_image(buffer.getvalue())[0, :, 0].tolist() == [0, 16384, 65535]


class TestWrongFiles:
    def test_missing(self, tmp_path):
        with pytest.raises(TraceError, match=r"nothing\.png does not exist"):
            read_image(tmp_path / "nothing.png")

    @pytest.mark.parametrize(
        "address", ["https://example.com/a.png", "HTTP://x.y/", "file:///tmp/a b.png"]
    )
    def test_an_address(self, address):
        with pytest.raises(TraceError) as caught:
            read_image(address)
        assert str(caught.value).startswith(f"{address} is an address")
        assert "download" in str(caught.value)

    def test_an_address_that_became_a_path(self):
        with pytest.raises(TraceError, match=r"^https://example\.com/a\.png is an address"):
            read_image(Path("https://example.com/a.png"))

    def test_a_colon_makes_no_address(self):
        with pytest.raises(TraceError, match="nowhere/12: does not exist"):
            read_image("nowhere/12:/a.png")

    @pytest.mark.parametrize("name", ["a\0b.png", "\ud800.png"])
    def test_a_name_that_no_file_can_have(self, name):
        with pytest.raises(TraceError, match="has a character that file names cannot have"):
            read_image(name)

    def test_a_name_that_is_too_long(self):
        with pytest.raises(TraceError, match="x cannot be read: File name too long"):
            read_image(300 * "x")

    def test_a_folder(self, tmp_path):
        with pytest.raises(TraceError, match="cannot be read"):
            read_image(tmp_path)

    def test_empty(self, tmp_path):
        path = tmp_path / "empty.png"
        path.write_bytes(b"")
        with pytest.raises(TraceError, match=r"empty\.png is empty"):
            read_image(path)

    def test_no_picture(self, tmp_path):
        path = tmp_path / "notes.png"
        path.write_text("these are notes")
        with pytest.raises(TraceError, match=r"notes\.png is not in a picture format"):
            read_image(path)

    @pytest.mark.parametrize("kind", ["PNG", "JPEG", "GIF", "TIFF"])
    def test_cut_short(self, kind):
        noise = Image.fromarray(RNG.integers(0, 256, (60, 60, 3), dtype=np.uint8))
        data = encoded(noise, kind)
        with pytest.raises(TraceError, match="damaged or cut short"):
            read_image(data[: len(data) // 2])

    def test_every_length_of_a_file_is_read_or_refused(self):
        data = encoded(Image.fromarray(RNG.integers(0, 256, (9, 9, 4), dtype=np.uint8)), "PNG")
        whole = read_image(data)
        refused = 0
        for length in range(len(data)):
            try:
                image = read_image(data[:length])
            except TraceError:
                refused += 1
            else:
                np.testing.assert_array_equal(image, whole)
        assert refused > 0.8 * len(data)

    def test_a_damaged_color_tiff(self):
        buffer = io.BytesIO()
        values = RNG.integers(0, 65536, (50, 50, 3), dtype=np.uint16)
        tifffile.imwrite(buffer, values, photometric="rgb")
        data = buffer.getvalue()
        with pytest.raises(TraceError, match="damaged or cut short"):
            read_image(data[: len(data) // 2])

    def test_too_large_is_noticed_before_decoding(self):
        data = bytearray(encoded(Image.new("L", (10, 10)), "PNG"))
        # Width and height in the header. Its checksum is repaired.
        import zlib

        data[16:24] = (9000).to_bytes(4) + (20).to_bytes(4)
        data[29:33] = zlib.crc32(data[12:29]).to_bytes(4)
        with pytest.raises(TraceError, match="too large, 9000 x 20"):
            read_image(bytes(data))
        data[16:24] = (12000).to_bytes(4) + (8000).to_bytes(4)
        data[29:33] = zlib.crc32(data[12:29]).to_bytes(4)
        with pytest.raises(TraceError, match="too large, 12000 x 8000"):  # without Pillow's warning
            read_image(bytes(data))
        data[16:24] = (60000).to_bytes(4) + (60000).to_bytes(4)
        data[29:33] = zlib.crc32(data[12:29]).to_bytes(4)
        with pytest.raises(TraceError, match="too large"):
            read_image(bytes(data))

    def test_32_bit_integers(self):
        values = np.array([[0, 70000]], dtype=np.int32)
        with pytest.raises(TraceError, match="from 0 to 70000"):
            read_image(encoded(Image.fromarray(values), "TIFF"))

    def test_eight_bit_values_in_32_bit_integers(self):
        values = np.array([[0, 200, 255]], dtype=np.int32)
        assert read_image(Image.fromarray(values))[0, :, 0].tolist() == [0, 200, 255]
        assert read_image(Image.fromarray(values + 1))[0, :, 0].tolist() == [1, 201, 256]
