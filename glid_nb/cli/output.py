"""Where results go: checked before the work starts, written when all of it is done."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from glid_nb._files import write_bytes_atomically, write_text_atomically
from glid_nb.cli.errors import BadFileError


def check_file(path: Path) -> Path:
    """Raise an OSError if a file cannot be made at ``path``, before hours are spent on it."""
    if path.is_dir():
        raise IsADirectoryError(21, "is a folder; name a file", str(path))
    if not path.parent.is_dir():
        raise FileNotFoundError(2, "there is no such folder to write to", str(path.parent))
    return path


def check_png(path: Path) -> Path:
    """:func:`check_file`, and a ValueError unless the name ends in .png."""
    if path.suffix.lower() != ".png":
        raise BadFileError(f"{path}: pictures are written as PNG; name a file that ends in .png")
    return check_file(path)


def check_folder(path: Path) -> Path:
    """Raise an OSError if a folder cannot be made at ``path``."""
    for part in (path, *path.parents):
        if part.is_dir():
            return path
        if part.exists():
            raise NotADirectoryError(20, "is a file; name a folder", str(part))
    return path


def png_bytes(rgba: NDArray[np.uint8]) -> bytes:
    """An (h, w, 4) picture as a PNG file."""
    buffer = io.BytesIO()
    Image.fromarray(rgba).save(buffer, format="PNG")
    return buffer.getvalue()


def json_text(data: dict[str, Any]) -> str:
    """JSON for files: readable at the top, arrays on one line."""
    lines = (f" {json.dumps(key)}: {json.dumps(value)}" for key, value in data.items())
    return "{\n" + ",\n".join(lines) + "\n}\n"


def write_all(files: dict[Path, bytes | str]) -> None:
    """Write several files, each atomically."""
    for path, data in files.items():
        if isinstance(data, str):
            write_text_atomically(path, data)
        else:
            write_bytes_atomically(path, data)
