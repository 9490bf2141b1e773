"""Reading JSON that somebody else wrote: every surprise is an error that names the key."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from glid_nb._errors import InputFileError


def read_json_object(path: str | Path) -> dict[str, Any]:
    """The JSON object in a file.

    Raises
    ------
    InputFileError
        When the file is not UTF-8 text, not JSON, or not an object at the top.
    OSError
        When it cannot be read.
    """
    raw = Path(path).read_bytes()
    try:
        data = json.loads(raw.decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        raise InputFileError(f"{path} is not a JSON file: it is not UTF-8 text") from error
    except (ValueError, RecursionError) as error:
        raise InputFileError(f"{path} is not a JSON file: {error}") from error
    if not isinstance(data, dict):
        raise InputFileError(f"{path} must hold a JSON object {{...}}, not {_kind(data)}")
    return data


def require_keys(data: Mapping[str, Any], keys: Iterable[str]) -> None:
    """Raise for the keys that are missing."""
    missing = [f'"{key}"' for key in keys if data.get(key) is None]
    if missing:
        noun = "key" if len(missing) == 1 else "keys"
        raise InputFileError(f"the {noun} {', '.join(missing)} must be given")


def check_points(value: Any, key: str) -> None:
    """Raise unless ``value`` is a list of ``[x, y]`` pairs of finite numbers."""
    if not isinstance(value, list):
        raise InputFileError(f'"{key}" must be a list of [x, y] pairs, not {_kind(value)}')
    for i, point in enumerate(value):
        if not (isinstance(point, list) and len(point) == 2 and all(map(is_number, point))):
            raise InputFileError(f"{key}[{i}] must be a pair [x, y] of numbers, {_shown(point)}")
        if not all(map(_is_finite, point)):
            raise InputFileError(f"{key}[{i}] must be finite, {_shown(point)}")


def check_loops(value: Any, key: str, each: str = "loop") -> None:
    """Raise unless ``value`` is a list of loops (or strokes), each a list of ``[x, y]`` pairs."""
    if not isinstance(value, list):
        raise InputFileError(f'"{key}" must be a list of {each}s, not {_kind(value)}')
    for i, loop in enumerate(value):
        check_points(loop, f"{key}[{i}]")


def check_positive(value: Any, key: str) -> None:
    """Raise unless ``value`` is a finite number above 0."""
    if not is_number(value) or not _is_finite(value) or value <= 0:
        raise InputFileError(f'"{key}" must be a positive number, {_shown(value)}')


def is_number(value: Any) -> bool:
    """Whether a JSON value is a number (JSON's true and false are not)."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_finite(number: float) -> bool:
    """Whether floating point has such a number; JSON's integers may be too large for it."""
    try:
        return math.isfinite(number)
    except OverflowError:
        return False


def _shown(value: Any) -> str:
    text = json.dumps(value)
    return "not " + (text if len(text) <= 60 else text[:57] + "...")


def _kind(value: Any) -> str:
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true or false"
    names = {list: "a list", dict: "an object", str: "a string", int: "a number", float: "a number"}
    return names[type(value)]
