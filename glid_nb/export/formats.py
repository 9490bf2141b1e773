"""Tables of the export formats, one for maps and one for motions, by the endings of file names."""

import itertools
import re
import unicodedata
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from glid_nb._errors import InputError
from glid_nb._files import portable_name


class ExportError(InputError):
    """A file cannot be exported with this name or format."""


class Format(NamedTuple):
    label: str
    beside: tuple[str, ...] = ()
    """Endings of the additional files; each replaces the ending of the name."""


FORMATS = {
    ".png": Format("Picture (PNG)"),
    ".obj": Format("Mesh and texture (OBJ)", (".mtl", "-texture.png")),
    ".glb": Format("Mesh and texture (glTF)"),
    ".svg": Format("Cage (SVG)"),
    ".live.html": Format("Live page, to be dragged (HTML)"),
    ".html": Format("Page with the shape (HTML)"),
    ".py": Format("Python script", ("-source.png",)),
    ".proof.json": Format("Proof for glid-check (JSON)", (".map.json",)),
    ".glid": Format("Session (GLID)"),
}
MOTION_FORMATS = {  # a motion's name without one of these is a folder of frames
    ".gif": Format("Animation (GIF)"),
    ".apng": Format("Transparent animation (PNG)"),
    ".mp4": Format("Video (MP4)"),
    ".webm": Format("Video (WebM)"),
    ".html": Format("Page with a player (HTML)"),
    ".glb": Format("Moving mesh (glTF)"),
    ".sheet.png": Format("Sprite sheet (PNG, JSON)", (".sheet.json",)),
    ".zip": Format("Frames (PNG in a zip)"),
    ".motion.json": Format("Proof for glid-check (JSON)", (".motion.proof.json",)),
}


OF_ONE_SHAPE = frozenset({".svg", ".py", ".proof.json", ".motion.json"})
"""Formats that hold one shape. A session with several parts exports a file for each."""


def part_names(name: str, suffix: str, parts: Sequence[str]) -> tuple[str, ...]:
    """The names of the parts' files: that of the export, with a part's name before the suffix.

    Parts whose names no file system tells apart are numbered: names that differ only in case, or in
    how an accent is written.
    """
    stem, ending = name[: len(name) - len(suffix)], name[len(name) - len(suffix) :]
    taken: set[str] = set()
    names = []
    for part in parts:
        plain = portable_name(part) or "part"
        tries = itertools.chain([plain], (f"{plain}-{n}" for n in itertools.count(2)))
        free = next(one for one in tries if _folded(one) not in taken)
        taken.add(_folded(free))
        names.append(f"{stem}-{free}{ending}")
    return tuple(names)


def _folded(name: str) -> str:
    return unicodedata.normalize("NFC", name).casefold()


def obj_names(name: str, parts: Sequence[str]) -> tuple[str, ...]:
    """The files of an OBJ with several parts: the named one, its materials, and their textures.

    Materials have the names of their textures, which are single words.
    """
    stem = name[: -len(".obj")]
    textures = (f"{_word(stem)}-{part}-texture.png" for part in object_names(parts))
    return (name, f"{stem}.mtl", *textures)


def object_names(parts: Sequence[str]) -> tuple[str, ...]:
    """The names of parts in an OBJ file: single words, all different."""
    names = part_names("", "", [_word(part) for part in parts])
    return tuple(name.removeprefix("-") for name in names)


def _word(text: str) -> str:
    """A text without spaces, which end a name in an OBJ file, and "#", which begins a comment."""
    return re.sub(r"[\s#]+", "_", text.strip())


def suffix_of(name: str, formats: Mapping[str, Format] = MOTION_FORMATS) -> str:
    """The ending of a name among the formats, or "" for a folder. Raises an ExportError for other
    names."""
    found = next((suffix for suffix in formats if name.lower().endswith(suffix)), "")
    folder = formats is MOTION_FORMATS and not Path(name).suffix
    if len(name) == len(found) or not (found or folder):
        ends = ", ".join(formats)
        ends += ", or have no suffix for a folder of frames" if formats is MOTION_FORMATS else ""
        raise ExportError(f"{name!r:.200} cannot be written: its name must end in {ends}")
    return found


def file_names(name: str, formats: Mapping[str, Format] = MOTION_FORMATS) -> tuple[str, ...]:
    """The name and the names of the additional files."""
    suffix = suffix_of(name, formats)
    stem, beside = name[: len(name) - len(suffix)], formats[suffix].beside if suffix else ()
    return (name, *(stem + ending for ending in beside))


def names_for_parts(
    name: str, parts: Sequence[str], formats: Mapping[str, Format] = MOTION_FORMATS
) -> tuple[str, ...]:
    """The names of all files of an export of parts with these names, of which there is at least
    one."""
    suffix = suffix_of(name, formats)
    if len(parts) == 1 or suffix not in OF_ONE_SHAPE | {".obj"}:
        return file_names(name, formats)
    if suffix == ".obj":
        return obj_names(name, parts)
    each = part_names(name, suffix, parts)
    return tuple(own for one in each for own in file_names(one, formats))
