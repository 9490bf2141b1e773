"""Read the layers of a Photoshop file, with the optional package psd-tools."""

import importlib
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb._files import read_file
from glid_nb.imaging.decode import check_size
from glid_nb.imaging.frame import TraceError

SUFFIXES = (".psd", ".psb")
_NEEDED = "the layers of a Photoshop file need the package psd-tools: pip install 'glid-nb[psd]'"


def photoshop_layers(path: str | os.PathLike[str]) -> list[tuple[str, NDArray[np.uint8]]]:
    """The visible pixel layers of a file with their names, the rearmost first.

    Each picture is (h, w, 4) RGBA of the document's size, transparent beside the layer. Layers of
    groups count like others. The layers' own masks are applied, but no masks of groups, no effects
    and no adjustments. Raises a TraceError if
    psd-tools is missing or the file cannot be read.
    """
    try:
        psd_tools: Any = importlib.import_module("psd_tools")  # an extra
    except ImportError:
        raise TraceError(_NEEDED) from None
    read_file(path)  # its errors name the file
    try:
        document = psd_tools.PSDImage.open(Path(path))
        width, height = document.size
        check_size(width, height)
        return [
            (str(layer.name), _drawn(layer, (width, height))) for layer in _pixel_layers(document)
        ]
    except TraceError:
        raise
    except Exception as error:  # decoders raise errors of any type
        raise TraceError(f"{path} is damaged or no Photoshop file: {error}") from None


def _pixel_layers(group: Any) -> Iterator[Any]:
    """The visible layers with pixels in a group, the rearmost first."""
    for layer in group:
        if not layer.visible:
            continue
        if layer.is_group():
            yield from _pixel_layers(layer)
        elif layer.has_pixels():
            yield layer


def _drawn(layer: Any, size: tuple[int, int]) -> NDArray[np.uint8]:
    """A layer with its mask on a transparent picture of the document's size."""
    picture = layer.topil()
    if picture is None:
        return np.zeros((size[1], size[0], 4), np.uint8)
    drawn = _placed(np.asarray(picture.convert("RGBA")), layer.offset, size)
    mask = layer.mask
    if mask is not None and not mask.disabled:
        around = np.full((size[1], size[0], 1), mask.background_color, np.uint8)
        if (shown := mask.topil()) is not None:
            around = _placed(np.asarray(shown.convert("L"))[..., None], mask.bbox[:2], size, around)
        alpha = drawn[..., 3].astype(np.uint16) * around[..., 0]
        drawn[..., 3] = (alpha + 127) // 255
    return drawn


def _placed(
    pixels: NDArray[np.uint8],
    offset: tuple[int, int],
    size: tuple[int, int],
    around: NDArray[np.uint8] | None = None,
) -> NDArray[np.uint8]:
    """Pixels (h, w, c) at a place of a picture of the document's size, by default of zeros."""
    (left, top), (width, height) = offset, size
    placed = np.zeros((height, width, pixels.shape[2]), np.uint8) if around is None else around
    rows = slice(max(top, 0), min(top + pixels.shape[0], height))
    columns = slice(max(left, 0), min(left + pixels.shape[1], width))
    if rows.start < rows.stop and columns.start < columns.stop:
        own_rows = slice(rows.start - top, rows.stop - top)
        own_columns = slice(columns.start - left, columns.stop - left)
        placed[rows, columns] = pixels[own_rows, own_columns]
    return placed
