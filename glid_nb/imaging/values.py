"""Read and write numbers that must not be mixed, such as labels, exactly as they are stored."""

import io
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageOps

from glid_nb._files import read_file
from glid_nb.imaging.decode import opened, picture_pixels, tiff_pixels
from glid_nb.imaging.frame import TraceError

SUFFIXES = (".png", ".npy", ".tif", ".tiff")


class Values(NamedTuple):
    """Numbers (h, w) or (h, w, c) of any type, and a palette of their colours."""

    array: NDArray[Any]
    palette: list[int] | None = None  # red, green and blue of the number 0, then of 1, and so on


def read_values(path: Path) -> Values:
    """Read the numbers of a .npy file or a picture: palette indices, labels, measured values.

    Colours are not converted. Raises a TraceError when the file is damaged or no picture, or an
    OSError.
    """
    data = read_file(path)
    try:
        if path.suffix.lower() == ".npy":
            return Values(np.load(io.BytesIO(data), allow_pickle=False))
        picture = opened(data, str(path))
        if picture is None or picture.format == "TIFF":
            return Values(tiff_pixels(data, str(path), as_stored=True)[0])
        with picture:
            if picture.mode not in ("1", "L", "LA", "P", "RGB", "RGBA"):
                return Values(picture_pixels(picture, data, str(path)))
            if str(getattr(picture, "tile", [])[0].args).endswith(";16B"):
                return Values(picture_pixels(picture, data, str(path)))
            palette = picture.getpalette() if picture.mode == "P" else None
            return Values(np.array(ImageOps.exif_transpose(picture)), palette)
    except TraceError:
        raise
    except Exception as error:  # decoders raise errors of any type
        raise TraceError(f"{path} is damaged or cut short: {error}") from None


def values_file(values: Values, suffix: str) -> bytes:
    """The content of a file of numbers. Raises a TraceError for values that a PNG cannot hold."""
    array, file = values.array, io.BytesIO()
    if suffix == ".npy":
        np.save(file, array, allow_pickle=False)
        return file.getvalue()
    if suffix in (".tif", ".tiff"):
        import tifffile  # noqa: PLC0415  (slow to import and seldom needed; scikit-image brings it)

        colours = array.ndim == 3 and array.shape[2] in (3, 4) and array.dtype.kind == "u"
        stored = array.astype(np.uint8) if array.dtype == np.bool_ else array
        how: Any = {"photometric": "rgb" if colours else "minisblack", "planarconfig": "contig"}
        if array.ndim == 2:
            del how["planarconfig"]
        tifffile.imwrite(file, stored, **how)
        return file.getvalue()
    flat = array[..., 0] if array.ndim == 3 and array.shape[2] == 1 else array
    if not (
        (flat.dtype == np.uint16 and flat.ndim == 2)
        or (flat.dtype == np.bool_ and flat.ndim == 2)
        or (flat.dtype == np.uint8 and (flat.ndim == 2 or flat.shape[2] in (2, 3, 4)))
    ):
        what = f"a PNG cannot hold {array.dtype} values of the shape {array.shape}"
        raise TraceError(f"{what}; name a file that ends in .npy or .tif")
    picture = Image.fromarray(np.ascontiguousarray(flat))
    if values.palette is not None:
        picture.putpalette(values.palette)
    picture.save(file, "PNG")
    return file.getvalue()
