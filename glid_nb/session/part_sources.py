"""Where the parts of a session come from: several pictures, a folder, a Photoshop file."""

import os
from collections.abc import Mapping, Sequence
from pathlib import Path

from glid_nb.imaging import TraceError
from glid_nb.imaging.photoshop import SUFFIXES, photoshop_layers
from glid_nb.imaging.read import ImageSource, as_rgba8, read_image
from glid_nb.session.document import MOST_PARTS
from glid_nb.session.names import free_name

PartSources = Mapping[str, ImageSource] | Sequence[ImageSource]
"""Pictures by the names of their parts, or only pictures; the rearmost first."""


def parts_in(image: ImageSource | None) -> dict[str, ImageSource] | None:
    """The parts of a folder or of a Photoshop file; None for any other picture.

    The PNG files of a folder are parts in the order of their names, and the visible layers of a
    Photoshop file in theirs, the rearmost first. Pictures with nothing on them are left out. Raises
    a TraceError if nothing is left or something cannot be read.
    """
    if not isinstance(image, (str, os.PathLike)):
        return None
    path = Path(image)
    if path.is_dir():
        pictures = [(file.stem, as_rgba8(read_image(file))) for file in _png_files(path)]
        nothing = f"{path} holds no PNG with a shape; name a folder of PNG pictures"
    elif path.suffix.lower() in SUFFIXES:
        pictures = photoshop_layers(path)
        nothing = f"{path} holds no visible layer with a shape"
    else:
        return None
    named: dict[str, ImageSource] = {}
    for name, pixels in pictures:
        if pixels[..., 3].any():
            named[free_name(name.strip() or "Part", list(named))] = pixels
    if not named:
        raise TraceError(nothing)
    return named


def _png_files(folder: Path) -> list[Path]:
    return sorted(path for path in folder.glob("*") if path.suffix.lower() == ".png")


def named_parts(parts: PartSources) -> dict[str, ImageSource]:
    """The pictures of parts by their names. Raises a TraceError for no or too many parts."""
    if not 1 <= len(parts) <= MOST_PARTS:
        raise TraceError(f"there are {len(parts)} parts; a session holds 1 to {MOST_PARTS}")
    if isinstance(parts, Mapping):
        return dict(parts)
    named: dict[str, ImageSource] = {}
    for number, image in enumerate(parts, 1):
        name = Path(image).stem if isinstance(image, (str, os.PathLike)) else f"Part {number}"
        named[free_name(name, list(named))] = image
    return named
