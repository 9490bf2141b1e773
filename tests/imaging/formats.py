"""The picture formats that the installed Pillow writes. The oldest one allowed lacks AVIF and
QOI."""

from __future__ import annotations

from PIL import Image

Image.init()


def written(*kinds: str) -> list[str]:
    """The formats among ``kinds`` that this Pillow can write. The newest writes all."""
    return [kind for kind in kinds if kind.upper() in Image.SAVE]
