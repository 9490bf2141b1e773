"""Points and coefficients as complex numbers, from whatever they are given as."""

from typing import Any

import numpy as np

from glid_nb._arrays import Array, number_pairs
from glid_nb._errors import InputError


class MapError(InputError):
    """A harmonic map's coefficients, its file, or points to evaluate it at are not valid."""


def as_complex(points: Any) -> Array:
    """(k, 2) real points, or complex ones of any shape, as a (k,) complex array."""
    listed = [points] if isinstance(points, complex) else points
    if isinstance(listed, list | tuple) and any(isinstance(one, complex) for one in listed):
        points = np.asarray(listed)
    if hasattr(points, "dtype") and np.iscomplexobj(points):
        z = np.asarray(np.ma.filled(points, np.nan), dtype=complex).ravel()
    else:
        array = number_pairs(points, "points must be (k, 2) coordinates", MapError)
        z = array[:, 0] + 1j * array[:, 1]
    bad = np.flatnonzero(~np.isfinite(z))
    if bad.size:
        raise MapError(f"point {bad[0]} is {z[bad[0]]}; coordinates must be finite")
    return z


def complex_from_pairs(value: Any, name: str) -> Array:
    """[re, im] pairs as coefficients, bit for bit; the message of the MapError has the ``name``."""
    pairs = number_pairs(value, f"{name} must be a list of [re, im] pairs of numbers", MapError)
    return pairs.view(complex)[:, 0]  # keeps signed zeros and infinities
