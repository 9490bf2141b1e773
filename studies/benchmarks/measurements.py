"""Measurements on disk, each with the machine and the versions that it was taken with."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from glid_nb._errors import InputError
from glid_nb._files import write_text_atomically

Measurement = dict[str, Any]
"""Plain JSON values; ``taken`` is the machine, ``of`` what was measured."""

_TAKEN, _OF = "taken", "of"


class BenchmarkError(InputError):
    """A measurement is missing, or could not be taken."""


class Measurements:
    """A folder of measurements by name, one JSON file each.

    Parameters
    ----------
    folder : Path
    here : dict
        This machine and the versions of what is measured, plain JSON values.
    fresh : bool
        Measure again what is there already.
    """

    def __init__(self, folder: Path, here: Measurement, fresh: bool = False) -> None:
        self.folder, self.here, self.fresh = folder, here, fresh
        folder.mkdir(parents=True, exist_ok=True)

    def get(self, name: str, of: str, measure: Callable[[], Measurement]) -> Measurement:
        """The measurement of a name, taken now unless it is there.

        One that was taken on another machine, with other versions or of something else (``of``, a
        problem's digest and the settings) is taken again.
        """
        found = None if self.fresh else kept(self.folder, name)
        if found is not None and (found[_TAKEN], found[_OF]) == (self.here, of):
            return found
        result = {_TAKEN: self.here, _OF: of, **measure()}
        text = json.dumps(result, indent=1, allow_nan=False)
        write_text_atomically(self.folder / f"{name}.json", text + "\n")
        return result


def kept(folder: Path, name: str) -> Measurement | None:
    """The measurement of a name that lies in a folder, wherever it was taken; None without.

    Raises
    ------
    BenchmarkError
        When the file is not JSON; the message names it.
    """
    path = folder / f"{name}.json"
    if not path.exists():
        return None
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise BenchmarkError(f"{path} is not a JSON file: {error}") from error
    # Without its machine a number means nothing.
    return found if isinstance(found, dict) and {_TAKEN, _OF} <= found.keys() else None
