"""Arrays: aliases of their types, arrays of numbers from untrusted values, immutable arrays."""

import math
from collections.abc import Iterator
from dataclasses import fields
from typing import Any, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[Any]
Floats: TypeAlias = NDArray[np.float64]
A = TypeVar("A", bound=Array)


def real_array(value: Any) -> NDArray[np.float64]:
    """``value`` as a new float64 array; a missing number (None, or masked) becomes NaN.

    A TypeError or ValueError for anything but real numbers in range, and for ragged nesting.
    """
    value = list(value) if isinstance(value, Iterator) else value
    if _holds_truth_value(value):
        raise TypeError("true and false are not numbers")
    if isinstance(value, np.ma.MaskedArray) and value.dtype.kind in "iuf":
        return np.ma.filled(value.astype(np.float64), np.nan)
    array = np.asarray(value)
    if array.dtype.kind in "iuf":
        return array.astype(np.float64, order="C")
    if array.dtype.kind != "O" or array.ndim == 0:
        raise TypeError(f"{array.dtype.name} values are not real numbers")
    try:
        return np.array([_number(v) for v in array.ravel()]).reshape(array.shape)
    except OverflowError as error:
        raise ValueError("a number is too large for floating point") from error


def number_pairs(value: Any, wanted: str, error: type[Exception]) -> NDArray[np.float64]:
    """(n, 2) new numbers, NaN and infinity too; else an ``error`` that begins with ``wanted``."""
    try:
        pairs = real_array(value)
    except (TypeError, ValueError) as problem:
        raise error(f"{wanted} ({problem})") from problem
    pairs = pairs.reshape(-1, 2) if pairs.shape == (0,) else pairs
    if pairs.ndim != 2 or pairs.shape[1] != 2:
        raise error(f"{wanted}; the shape is {pairs.shape}")
    return pairs


def is_finite(number: Any) -> bool:
    """Whether a real number, of Python's long ones too, is a finite float."""
    try:
        return math.isfinite(number)
    except OverflowError:
        return False


def read_only(array: A) -> A:
    """The array itself, which nobody can write to from now on."""
    array.setflags(write=False)
    return array


class _Frozen(bytes):
    """What nobody can write to; an array that comes from a pickle lies in writable bytes."""


def frozen(array: A) -> A:
    """A copy whose bytes nobody can write to, whatever flags are set; of such a copy, itself."""
    if type(array) is np.ndarray and isinstance(array.base, _Frozen):
        return array
    return np.ndarray(array.shape, array.dtype, _Frozen(array.tobytes()))  # type: ignore[return-value]


class Rebuilt:
    """A dataclass whose copies are made by its constructor, without what it keeps beside fields.

    So arrays are read-only again where they come from a pickle, and what was checked is checked.
    """

    def __reduce__(self) -> tuple[Any, ...]:
        values = {one.name: getattr(self, one.name) for one in fields(self)}  # type: ignore[arg-type]
        return _made, (type(self), values)


def _made(cls: type, values: dict[str, Any]) -> Any:
    return cls(**values)


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
