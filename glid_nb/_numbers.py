"""Reading numbers strictly: what is text, a truth value or complex is not a coordinate."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def real_array(value: Any) -> NDArray[np.float64]:
    """``value`` as a new float64 array; a missing number (None) becomes NaN.

    Raises
    ------
    TypeError, ValueError
        For ragged nesting, or anything that is not a real number within floating point.
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
