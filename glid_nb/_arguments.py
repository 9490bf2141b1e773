"""Strict checks of arguments, refused by name, and arrays as immutable values."""

from __future__ import annotations

from collections.abc import Iterable
from numbers import Integral
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from glid_nb._errors import did_you_mean

A = TypeVar("A", bound=NDArray[Any])


def check_type(
    name: str, value: Any, wanted: Any, hint: str, error: type[Exception] = TypeError
) -> None:
    """Raise ``error`` unless ``value`` is an instance of ``wanted``, a class or a union of classes.

    The message calls the argument ``name`` and ends with ``hint``: what to give instead.
    """
    if not isinstance(value, wanted):
        known = getattr(wanted, "__args__", (wanted,))
        *others, last = ("None" if kind is type(None) else kind.__name__ for kind in known)
        text = f"{', '.join(others)} or {last}" if others else last
        raise error(f"{name} must be {text}, not {type(value).__name__}; {hint}")


def check_count(name: str, value: Any, least: int, unit: str) -> int:
    """``value`` as an int.

    Raises
    ------
    TypeError
        It is not a whole number.
    ValueError
        It is less than ``least``.
    """
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise TypeError(f"{name} must be a whole number of {unit}, not {value!r:.60}")
    if value < least:
        raise ValueError(f"{name} is {value}; it must be at least {least} {unit}")
    return int(value)


def check_keywords(
    name: str, given: Iterable[str], known: Iterable[str], error: type[Exception] = TypeError
) -> None:
    """Raise ``error`` for a keyword that ``name``, such as a class, does not have."""
    known = list(known)
    for keyword in given:
        if keyword not in known:
            hint = did_you_mean(keyword, known) or f"; there are {', '.join(known)}"
            raise error(f"{name} has no argument {keyword!r:.60}{hint}")


def real_array(value: Any) -> NDArray[np.float64]:
    """``value`` as a new float64 array; a missing number (None) becomes NaN.

    Raises
    ------
    TypeError, ValueError
        For ragged nesting and for anything but real numbers in floating-point range, such as
        text, truth values and complex numbers.
    """
    if _holds_truth_value(value):
        raise TypeError("true and false are not numbers")
    array = np.asarray(value)
    if array.dtype.kind in "iuf":
        return array.astype(np.float64)
    if array.dtype.kind != "O" or array.ndim == 0:
        raise TypeError(f"{array.dtype.name} values are not real numbers")
    try:
        return np.array([_number(v) for v in array.ravel()]).reshape(array.shape)
    except OverflowError as error:
        raise ValueError("a number is too large for floating point") from error


def number_pairs(
    value: Any, wanted: str, error: type[Exception], shape: str = ""
) -> NDArray[np.float64]:
    """(n, 2) numbers as a new float64 array, also for an empty list; NaN and infinity pass.

    The message of the ``error`` begins with ``wanted``, "handles must be a list of [x, y] pairs",
    for another shape with ``shape`` if that is given.
    """
    try:
        pairs = real_array(value)
    except (TypeError, ValueError) as problem:
        raise error(f"{wanted} ({problem})") from problem
    pairs = pairs.reshape(-1, 2) if pairs.shape == (0,) else pairs
    if pairs.ndim != 2 or pairs.shape[1] != 2:
        raise error(f"{shape or wanted + '; the shape is'} {pairs.shape}")
    return pairs


def read_only(array: A) -> A:
    """The array itself, which nobody can write to from now on."""
    array.setflags(write=False)
    return array


def _number(value: Any) -> float:
    if value is None:
        return float("nan")
    if isinstance(value, int | float):
        return float(value)
    raise TypeError(f"{type(value).__name__} is not a number")


def _holds_truth_value(value: Any) -> bool:
    if isinstance(value, list | tuple):
        return any(_holds_truth_value(v) for v in value)
    return isinstance(value, bool)
