"""The picture formats that the installed Pillow writes: the oldest allowed lacks AVIF and QOI."""

from __future__ import annotations

from PIL import Image

Image.init()


def written(*kinds: str) -> list[str]:
    """Those of ``kinds`` that this Pillow can write; the newest writes all."""
    return [kind for kind in kinds if kind.upper() in Image.SAVE]
