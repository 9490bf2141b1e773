"""The warped picture as a PNG file."""

from __future__ import annotations

import io

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image

from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.render import View, render


def picture_png(
    image: ArrayLike,
    map: HarmonicMap,
    size: tuple[int, int] | None = None,
    view: View = "source",
) -> bytes:
    """Warp a picture through a map, as a PNG with an alpha channel.

    Parameters
    ----------
    image : (h, w, 4), (h, w, 3) or (h, w) array
        The picture that the map's cage was traced from.
    map : HarmonicMap
        The map.
    size : (w, h), optional
        Pixels of the result; by default the image's own.
    view : "source" or "fit"
        Show what the picture showed, or all of the deformed shape; see `glid_nb.render`.

    Raises
    ------
    ValueError
        When an argument is out of range; the message names it.
    """
    return png(render(image, map, size, view=view))


def png(pixels: NDArray[np.uint8], compress_level: int = 6) -> bytes:
    """The pixels as a PNG file."""
    buffer = io.BytesIO()
    Image.fromarray(pixels).save(buffer, format="PNG", compress_level=compress_level)
    return buffer.getvalue()
