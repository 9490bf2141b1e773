"""Read and check JSON files. Every error names the key."""

import functools
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from glid_nb._arrays import is_finite
from glid_nb._errors import InputError, InputFileError, did_you_mean
from glid_nb._files import read_file, write_atomically

Check = Callable[[Any, str], None]
"""``check(value, key)`` raises InputFileError if the value is not valid for that key."""
Checks = Mapping[str, Check]

MOST_VALUES = 4_000_000
_EXACT_DIGITS = 300  # integers with fewer digits are in the range of floating point

_KINDS = {type(None): "null", bool: "true or false", int: "a number", float: "a number"}
_KINDS |= {list: "a list", dict: "an object", str: "a string"}


def parse_json(raw: bytes, name: str, kind: str = "a JSON file", *, nan: bool = True) -> Any:
    """Parse the bytes of a JSON file. Numbers beyond the range of floating point become infinite.

    With ``nan``, NaN and Infinity are accepted, so that a later check can name their key.
    """
    # Parsing more values takes seconds and gigabytes. The largest documents have half as many.
    if raw.count(b",") > MOST_VALUES:
        raise InputFileError(f"{name} is not {kind}: it has over {MOST_VALUES:,} values")
    try:
        return json.loads(
            raw.decode(json.detect_encoding(raw)),  # also UTF-16, with or without a byte order mark
            parse_int=lambda digits: (int if len(digits) < _EXACT_DIGITS else float)(digits),
            parse_constant=float if nan else _refuse_constant,
            object_pairs_hook=_object,
        )
    except UnicodeDecodeError:
        raise InputFileError(f"{name} is not {kind}: it is neither UTF-8 nor UTF-16 text") from None
    except (ValueError, RecursionError) as error:
        raise InputFileError(f"{name} is not {kind}: {error}") from None


def read_json(path: str | Path) -> Any:
    """The JSON value in a file. Raises an InputFileError for a folder or other content, an OSError
    for a missing file."""
    try:
        return parse_json(read_file(path), str(path))
    except IsADirectoryError:
        raise InputFileError(f"{path} is a folder; name a file") from None


def read_object(path: str | Path) -> dict[str, Any]:
    """Like :func:`read_json`, but raises an InputFileError if the value is not an object."""
    data = read_json(path)
    if not isinstance(data, dict):
        raise InputFileError(f"{path} must hold a JSON object {{...}}, not {_KINDS[type(data)]}")
    return data


def write_json(path: str | Path, data: Mapping[str, Any]) -> None:
    """Write an object to a file atomically, one line per key."""
    write_atomically(path, json_text(data))


def json_text(data: Mapping[str, Any]) -> str:
    """An object as JSON text: one line per key, arrays on one line."""
    lines = (f" {json.dumps(key)}: {json.dumps(value)}" for key, value in data.items())
    return "{\n" + ",\n".join(lines) + "\n}\n"


def check_fields(
    data: Any, name: str, required: Checks, optional: Checks | None = None, *, others: bool = False
) -> None:
    """Raise an InputFileError unless ``data`` is an object with valid keys and values.

    Messages call it ``name``. Optional keys may be missing or null. Other keys are refused unless
    ``others`` is true.
    """
    check_object(data, name)
    known = {**required, **(optional or {})}
    for key in () if others else sorted(data.keys() - known.keys()):
        raise InputFileError(f"{name} holds the unknown key {key!r:.60}{did_you_mean(key, known)}")
    missing = [f'"{key}"' for key in required if data.get(key) is None]
    if missing:
        noun = "key" if len(missing) == 1 else "keys"
        raise InputFileError(f"the {noun} {', '.join(missing)} must be given")
    for key, check in known.items():
        if data.get(key) is not None:
            check(data[key], key)


def keys(*names: str) -> Checks:
    """Keys without a check; their values are checked later."""
    return dict.fromkeys(names, lambda _value, _key: None)


def checked_version(
    data: Any, kind: str, newest: int = 1, error: type[InputError] = InputFileError
) -> int:
    """The version of data in the format ``glid_nb-kind``. Raises ``error`` for other data."""
    wanted, what = f"glid_nb-{kind}", f"this is not a glid_nb {kind}, which is a JSON object"
    if not isinstance(data, Mapping) or data.get("format") != wanted:
        raise error(f'{what}: the key "format" is not "{wanted}"')
    version = data.get("version")
    if type(version) is not int or not 1 <= version <= newest:
        known = f"{kind} version {version!r:.20} is not supported, only 1 to {newest}"
        raise error(f"{known}; a newer glid_nb may have written it: update this one")
    return version


def _check_kind(value: Any, key: str, kind: type) -> None:
    if type(value) is not kind:
        raise InputFileError(f"{key} must be {_KINDS[kind]}, not {_shown(value)}")


check_object: Check = functools.partial(_check_kind, kind=dict)
check_list: Check = functools.partial(_check_kind, kind=list)
check_text: Check = functools.partial(_check_kind, kind=str)


def check_positive(value: Any, key: str) -> None:
    """Check that the value is a finite number above 0."""
    if not _is_number(value) or not is_finite(value) or value <= 0:
        raise InputFileError(f'"{key}" must be a positive number, not {_shown(value)}')


def picture_size(value: Any, key: str) -> tuple[int, int]:
    """A picture's size, ``[width, height]`` in pixels: whole numbers above 0, also ``640.0``."""
    pair = isinstance(value, list) and len(value) == 2
    if not pair or not all(_is_number(n) and n > 0 and n % 1 == 0 for n in value):
        raise InputFileError(f"{key} must be [width, height] in pixels, not {_shown(value)}")
    return int(value[0]), int(value[1])


def check_points(value: Any, key: str) -> None:
    """Check that the value is a list of ``[x, y]`` pairs of finite numbers."""
    _check_list_of(value, key, "[x, y] pair")
    for i, point in enumerate(value):
        place = f"{key}[{i}] must be"
        if not (isinstance(point, list) and len(point) == 2 and all(map(_is_number, point))):
            raise InputFileError(f"{place} a pair [x, y] of numbers, not {_shown(point)}")
        if not all(map(is_finite, point)):
            raise InputFileError(f"{place} finite, not {_shown(point)}")


def check_loops(value: Any, key: str, each: str = "loop") -> None:
    """Check that the value is a list of loops, each a list of ``[x, y]`` pairs of finite
    numbers."""
    _check_list_of(value, key, each)
    for i, loop in enumerate(value):
        check_points(loop, f"{key}[{i}]")


check_strokes: Check = functools.partial(check_loops, each="stroke")


def _check_list_of(value: Any, key: str, each: str) -> None:
    if not isinstance(value, list):
        raise InputFileError(f'"{key}" must be a list of {each}s, not {_KINDS[type(value)]}')


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _shown(value: Any) -> str:
    text = json.dumps(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _refuse_constant(constant: str) -> None:
    raise ValueError(f"it holds {constant}, which is not a number")


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    data: dict[str, Any] = {}
    for key, value in pairs:
        if key in data:
            raise ValueError(f"the key {_shown(key)} is given twice")
        data[key] = value
    return data
