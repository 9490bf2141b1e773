"""Points and coefficients as complex numbers, from whatever they are given as."""

from numbers import Real
from typing import Any

import numpy as np

from glid_nb._arrays import Array, first_masked, number_pairs
from glid_nb._errors import InputError
from glid_nb._features import is_traced

FARTHEST = 1e100  # squares of larger coordinates, times those of the basis, overflow


class MapError(InputError):
    """A harmonic map's coefficients, its file, or points to evaluate it at are not valid."""


def as_complex(points: Any) -> Array:
    """(k, 2) real points, or complex ones of any shape, as a (k,) complex array."""
    listed = [points] if isinstance(points, complex) else points
    if isinstance(listed, list | tuple) and any(isinstance(one, complex) for one in listed):
        points = np.asarray(listed)
    _check_unmasked(points)
    if hasattr(points, "dtype") and np.iscomplexobj(points):
        z = np.asarray(points, dtype=complex).ravel()
    else:
        array = _pairs(points)
        z = array[:, 0] + 1j * array[:, 1]
    with np.errstate(over="ignore"):  # what overflows is too far
        bad = np.flatnonzero(~(abs(z) <= FARTHEST))
    if bad.size:
        first: Any = z[bad[0]]
        far = f"the largest distance is {FARTHEST:g}"
        wanted = far if np.isfinite(first) else "coordinates must be finite"
        raise MapError(f"point {bad[0]} is ({first.real:g}, {first.imag:g}); {wanted}")
    return z


def _pairs(points: Any) -> Array:
    """(k, 2) numbers; a MapError if they are something else, or if they cannot be read."""
    wanted = "points must be (k, 2) coordinates"
    if is_traced(points):
        raise MapError(f"{wanted} that are known, but JAX traces these; this runs outside of jit")
    try:
        return number_pairs(points, wanted, MapError)
    except MapError as error:
        one = isinstance(points, list | tuple | np.ndarray) and len(points) == 2
        if one and all(isinstance(number, Real) for number in points):
            raise MapError(f"{error}; write one point as [[x, y]]") from None
        raise
    except RuntimeError as error:  # such as PyTorch's, of a tensor that requires a gradient
        raise MapError(f"{wanted} ({error})") from error


def _check_unmasked(points: Any) -> None:
    """Raise a MapError for the first point of a masked array that is masked."""
    numbers = isinstance(points, np.ndarray) and np.iscomplexobj(points)
    if (masked := first_masked(points.ravel() if numbers else points)) is not None:
        what = f"point {masked} is masked, so it has no coordinates"
        raise MapError(f"{what}; leave it out, as np.ma.compress_rows does")


def complex_from_pairs(value: Any, name: str) -> Array:
    """[re, im] pairs as coefficients, bit for bit; the message of the MapError has the ``name``."""
    pairs = number_pairs(value, f"{name} must be a list of [re, im] pairs of numbers", MapError)
    return pairs.view(complex)[:, 0]  # keeps signed zeros and infinities
