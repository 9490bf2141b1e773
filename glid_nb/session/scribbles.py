"""Scribbles from a file."""

from __future__ import annotations

from pathlib import Path

from glid_nb.imaging import Scribbles, TraceError
from glid_nb.session.json_file import InputFileError, check_loops, read_json_object, require_keys


def load_scribbles(path: str | Path) -> Scribbles:
    """Read strokes from a JSON file.

    The file is an object with the keys ``foreground`` and, optionally, ``background``, each a list
    of strokes, a stroke being a list of ``[x, y]`` pixels from the picture's top left corner.

    Raises
    ------
    InputFileError
        When the file holds something else; the message names the file and the culprit.
    OSError
        When it cannot be read.
    """
    data = read_json_object(path)
    try:
        require_keys(data, ("foreground",))
        strokes = {key: data.get(key) or [] for key in ("foreground", "background")}
        for key, value in strokes.items():
            check_loops(value, key, each="stroke")
        return Scribbles(**strokes)
    except (InputFileError, TraceError) as error:
        raise InputFileError(f"{path}: {error}") from error
