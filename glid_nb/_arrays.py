"""Arrays: type aliases, arrays of numbers from untrusted values, immutable arrays."""

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
    """``value`` as a new float64 array. A missing number (None or masked) becomes NaN.

    Raises a TypeError or ValueError for ragged nesting, and for values that are not real numbers in
    the range of float64.
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


def first_masked(value: Any) -> int | None:
    """The first row of a masked array that is masked, at least in part; None if there is none."""
    if not isinstance(value, np.ma.MaskedArray):
        return None
    masked = np.argwhere(np.atleast_1d(np.ma.getmaskarray(value)))
    return int(masked[0][0]) if len(masked) else None


def number_pairs(value: Any, wanted: str, error: type[Exception]) -> NDArray[np.float64]:
    """(n, 2) array of numbers, NaN and infinity allowed; also from (n,) complex numbers. Otherwise
    raises an ``error`` whose message begins with ``wanted``."""
    try:
        if isinstance(value, list | tuple | np.ndarray) and np.iscomplexobj(value):
            z = np.ma.filled(value, np.nan)
            value = np.stack([np.real(z), np.imag(z)], axis=-1) if z.ndim == 1 else value
        pairs = real_array(value)
    except (TypeError, ValueError) as problem:
        raise error(f"{wanted} ({problem})") from problem
    pairs = pairs.reshape(-1, 2) if pairs.shape == (0,) else pairs
    if pairs.ndim != 2 or pairs.shape[1] != 2:
        raise error(f"{wanted}; the shape is {pairs.shape}")
    return pairs


def is_finite(number: Any) -> bool:
    """Whether a real number is finite as a float. Python's long integers may be too large."""
    try:
        return math.isfinite(number)
    except OverflowError:
        return False


def read_only(array: A) -> A:
    """Make the array read-only. Returns the same array."""
    array.setflags(write=False)
    return array


class _Frozen(bytes):
    """Memory that nobody can write to. Arrays from a pickle lie in writable memory instead."""


def frozen(array: A) -> A:
    """A copy that can never be written to, whatever flags are set. A frozen array is returned
    itself."""
    if type(array) is np.ndarray and isinstance(array.base, _Frozen):
        return array
    return np.ndarray(array.shape, array.dtype, _Frozen(array.tobytes()))  # type: ignore[return-value]


class Rebuilt:
    """A dataclass whose copies are made by its constructor from its fields alone.

    So arrays from a pickle become read-only again, and all checks run again.
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
