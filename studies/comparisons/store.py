"""Measurements on disk, so that an interrupted comparison goes on where it stopped."""

from __future__ import annotations

import io
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb._files import write_bytes_atomically, write_text_atomically

Measurement = dict[str, Any]
"""Plain JSON values, and arrays under ``arrays``."""


_PROBLEM = "problem"


class Store:
    """A folder of measurements.

    Parameters
    ----------
    folder : Path
    fresh : bool
        Measure again what is there already.
    """

    def __init__(self, folder: Path, fresh: bool = False) -> None:
        self.folder, self.fresh = folder, fresh
        folder.mkdir(parents=True, exist_ok=True)

    def get(self, name: str, measure: Callable[[], Measurement], problem: str = "") -> Measurement:
        """The measurement of a name, made now if it is not there or of another problem.

        ``problem`` is a digest of what is measured: a shape that is traced or posed otherwise than
        before is another one.
        """
        kept = None if self.fresh else self.kept(name, problem)
        if kept is None:
            table, arrays = self._files(name)
            result = {**measure(), _PROBLEM: problem}
            images: dict[str, NDArray[Any]] = result.pop("arrays", {})
            buffer = io.BytesIO()
            np.savez_compressed(buffer, allow_pickle=False, **images)
            # Without the table the measurement counts as missing: it goes first and comes last.
            table.unlink(missing_ok=True)
            write_bytes_atomically(arrays, buffer.getvalue())
            write_text_atomically(table, json.dumps(_plain(result), allow_nan=False))
            kept = self.kept(name, problem)
            assert kept is not None
        return kept

    def kept(self, name: str, problem: str = "") -> Measurement | None:
        """The measurement of a name that is there, if it is of this problem."""
        table, arrays = self._files(name)
        if not (table.exists() and arrays.exists()):
            return None
        loaded = json.loads(table.read_text(encoding="utf-8"))
        if loaded.pop(_PROBLEM, "") != problem:
            return None
        with np.load(arrays, allow_pickle=False) as stored:
            loaded["arrays"] = {key: stored[key] for key in stored.files}
        return loaded

    def _files(self, name: str) -> tuple[Path, Path]:
        return self.folder / f"{name}.json", self.folder / f"{name}.npz"


def _plain(value: Any) -> Any:
    """Strict JSON: NaN and infinity become null."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    if isinstance(value, np.generic):
        return _plain(value.item())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
