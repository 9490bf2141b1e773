"""Measurements on disk, one JSON file each, so that an interrupted study can continue."""

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from glid_nb._files import write_atomically
from studies.processes import StudyError

Measurement = dict[str, Any]
"""Plain JSON values, and NumPy arrays under ``arrays``.

On disk, ``taken`` is the machine, and ``of`` names the problem's digest and the settings.
"""


class Store:
    """A folder of measurements; ``here`` is this machine with its versions.

    With ``fresh``, existing measurements are repeated.
    """

    def __init__(self, folder: Path, here: Measurement, fresh: bool = False) -> None:
        self.folder, self.here, self.fresh = folder, here, fresh

    def get(self, name: str, of: str, measure: Callable[[], Measurement]) -> Measurement:
        """The measurement of a name; taken now if it does not exist.

        If it was taken on another machine or with another ``of``, it is repeated.
        """
        found = None if self.fresh else self.kept(name)
        if found is None or (found["taken"], found["of"]) != (self.here, of):
            result = _plain({"taken": self.here, "of": of, **measure()})
            self.folder.mkdir(parents=True, exist_ok=True)
            text = json.dumps(result, indent=1, allow_nan=False)
            write_atomically(self.folder / f"{name}.json", text + "\n")
            found = self.kept(name)
            assert found is not None
        return found

    def kept(self, name: str) -> Measurement | None:
        """The existing measurement of a name, taken on any machine; None if there is none.

        Raises a StudyError that names the file if it is not JSON.
        """
        path = self.folder / f"{name}.json"
        if not path.exists():
            return None
        try:
            found = json.loads(path.read_text(encoding="utf-8"))
        except ValueError as error:
            raise StudyError(f"{path} is not a JSON file: {error}") from error
        # A number without its machine is useless.
        if not isinstance(found, dict) or not {"taken", "of"} <= found.keys():
            return None
        if "arrays" in found:
            found["arrays"] = {key: np.array(value) for key, value in found["arrays"].items()}
        return found

    def all(self, prefix: str) -> list[Measurement]:
        """All measurements whose names begin with ``prefix`` and a hyphen, sorted by name."""
        names = (path.stem for path in sorted(self.folder.glob(f"{prefix}-*.json")))
        return [found for name in names if (found := self.kept(name)) is not None]


def _plain(value: Any) -> Any:
    """Strict JSON: NaN and infinity become null."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
