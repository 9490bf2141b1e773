"""Signs of 2 x 2 determinants of differences, proved: a floating-point filter, then integers.

The determinants are those of two edges, from p to q and from r to s,

    det = (bx + xq - xp) (by + ys - yr) - (yq - yp) (xs - xr),

of real numbers. The base (bx, by) is (0, 0) for points, and the distance between pixels for the
displacements of a grid. All inputs are floats or integers, which are taken as they are.
"""

import math
import sys
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glid_nb._arrays import Array, Floats

UNIT_ROUNDOFF = 2.0**-53
_UPWARD = 1 + 1e-10  # larger than the rounding of the bound itself
# Covers underflow, also where a processor flushes subnormal numbers to zero.
_UNDERFLOW = 1e-290
_WHOLE = 2**53  # integers up to here are floats
_TINIEST = math.ulp(0.0)
_BATCH = 65536  # of integers with one common exponent
Pair = tuple[float, float]


class Edges(NamedTuple):
    """Two edges for each determinant: (k, 2) arrays of their ends."""

    p: Array
    q: Array
    r: Array
    s: Array

    def taken(self, which: Array) -> "Edges":
        return Edges(*(points[which] for points in self))


class Determinants(NamedTuple):
    """Determinants as floats, whose signs are those of the real numbers."""

    values: Floats
    errors: Floats
    """No value is farther from its determinant."""
    doubtful: int
    """How many needed integers."""


def determinants(edges: Edges, base: Pair = (0.0, 0.0)) -> Determinants:
    """The determinants. Every sign is right; the values are rounded."""
    values, errors = _filtered(edges, base)
    with np.errstate(invalid="ignore"):
        sure = np.abs(values) > errors
    doubtful = np.flatnonzero(~(sure & np.isfinite(values)))
    for first in range(0, len(doubtful), _BATCH):
        some = doubtful[first : first + _BATCH]
        whole, exponent = exactly(edges.taken(some), base)
        values[some] = [as_float(number, exponent) for number in whole]
        sizes = np.abs(values[some])
        errors[some] = np.where(sizes == 0, 0.0, 2.0**-50 * sizes + 4 * _TINIEST)
    return Determinants(values, errors, len(doubtful))


def smallest(edges: Edges, base: Pair = (0.0, 0.0)) -> tuple[int, float]:
    """The index of the smallest determinant, compared exactly, and its value rounded."""
    whole, exponent = exactly(edges, base)
    least = min(range(len(whole)), key=whole.__getitem__)
    return least, as_float(whole[least], exponent)


def exactly(edges: Edges, base: Pair) -> tuple[NDArray[np.object_], int]:
    """Integers and one exponent e: the determinants are the integers times 2**e."""
    columns = [points[:, i] for points in edges for i in (0, 1)]
    whole, exponent = integers([*columns, np.array(base, dtype=np.float64)])
    xp, yp, xq, yq, xr, yr, xs, ys, (bx, by) = whole
    return (xq - xp + bx) * (ys - yr + by) - (yq - yp) * (xs - xr), 2 * exponent


def integers(arrays: Sequence[Array]) -> tuple[list[NDArray[np.object_]], int]:
    """Python's integers, and one exponent e: the arrays' numbers are the integers times 2**e."""
    split = [_split(array) for array in arrays]
    lowest = [exponents[mantissas != 0] for mantissas, exponents in split]
    least = min((int(one.min()) for one in lowest if len(one)), default=0)
    whole = []
    for mantissas, exponents in split:
        shifts = np.where(mantissas != 0, exponents - least, 0)
        whole.append(mantissas.astype(object) << shifts.astype(object))
    return whole, least


def as_float(number: int, exponent: int) -> float:
    """number * 2**exponent, rounded. The sign is kept where it underflows, and the largest float
    stands for what overflows."""
    if not number:
        return 0.0
    spare = max(number.bit_length() - 1000, 0)
    try:
        value = math.ldexp(float(number >> spare), exponent + spare)
    except OverflowError:
        return sys.float_info.max if number > 0 else -sys.float_info.max
    return value or (_TINIEST if number > 0 else -_TINIEST)


def as_floats(array: Array) -> Floats:
    """The numbers as float64. Integers above 2**53 become NaN, because they would be rounded."""
    floats = array.astype(np.float64)
    if array.dtype.kind in "iu" and array.dtype.itemsize == 8:
        floats[np.abs(floats) > _WHOLE - 1] = np.nan
    return floats


def _split(array: Array) -> tuple[Array, NDArray[np.int64]]:
    """Integers m and exponents e of the numbers m * 2**e."""
    if array.dtype.kind in "iu":
        return array, np.zeros(array.shape, dtype=np.int64)
    fractions, exponents = np.frexp(array.astype(np.float64))
    mantissas = np.ldexp(fractions, 53).astype(np.int64)
    return mantissas, exponents.astype(np.int64) - 53


def _filtered(edges: Edges, base: Pair) -> tuple[Floats, Floats]:
    """The determinants in double precision, and bounds on their errors.

    A sum or difference has an error of at most u times its computed value, u = 2**-53. With the
    errors ea, eb, ec and ed of the entries, that of a d - b c is at most
    |a| ed + |d| ea + ea ed + |b| ec + |c| eb + eb ec + u (|a d| + |b c| + |a d - b c|).
    """
    (xp, yp), (xq, yq), (xr, yr), (xs, ys) = (as_floats(points).T for points in edges)
    u = UNIT_ROUNDOFF
    with np.errstate(over="ignore", invalid="ignore", under="ignore"):
        along, up = xq - xp, ys - yr
        a, d, b, c = along + base[0], up + base[1], yq - yp, xs - xr
        ea, ed = u * (np.abs(along) + np.abs(a)), u * (np.abs(up) + np.abs(d))
        size_a, size_b, size_c, size_d = (np.abs(one) for one in (a, b, c, d))
        eb, ec = u * size_b, u * size_c
        values = a * d - b * c
        bounds = size_a * ed + size_d * ea + ea * ed + size_b * ec + size_c * eb + eb * ec
        bounds += u * (size_a * size_d + size_b * size_c + np.abs(values))
        bounds = _UPWARD * bounds + _UNDERFLOW * (1 + size_a + size_b + size_c + size_d)
    return values, bounds
