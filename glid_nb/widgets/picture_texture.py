"""A picture as a texture of the graphics card."""

from __future__ import annotations

from typing import Any

import numpy as np
import pythreejs as three
from numpy.typing import NDArray
from PIL import Image

LARGEST_SIDE = 1600
"""Pixels of a texture's side at most: more than a canvas has, and little enough to send."""


def picture_texture(image: NDArray[np.uint8]) -> Any:
    """A texture of a picture (h, w, 4), premultiplied by alpha."""
    height, width = image.shape[:2]
    scale = min(1.0, LARGEST_SIDE / max(height, width))
    picture = Image.fromarray(image).convert("RGBa")
    if scale < 1:
        size = (max(1, round(scale * width)), max(1, round(scale * height)))
        picture = picture.resize(size, Image.Resampling.LANCZOS)
    # The bytes are those of RGBa; a DataTexture begins at the bottom.
    pixels = np.frombuffer(picture.tobytes(), dtype=np.uint8)
    pixels = pixels.reshape(picture.height, picture.width, 4)
    return three.DataTexture(
        data=np.ascontiguousarray(pixels[::-1]),
        format="RGBAFormat",
        type="UnsignedByteType",
        minFilter="LinearMipMapLinearFilter",
        magFilter="LinearFilter",
        generateMipmaps=True,
        anisotropy=4,
    )
