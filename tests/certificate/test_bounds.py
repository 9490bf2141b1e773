"""Bounds as text."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from glid_nb.certificate.rounding import rounded_down, rounded_up

POSITIVE = st.floats(1e-300, 1e300)


@given(value=POSITIVE | POSITIVE.map(lambda value: -value), digits=st.integers(1, 8))
def test_what_is_written_still_is_a_bound(value: float, digits: int) -> None:
    lower, upper = rounded_down(value, digits), rounded_up(value, digits)
    assert Fraction(lower) <= Fraction(value) <= Fraction(upper)
    unit, size = Fraction(10) ** (1 - digits), abs(Fraction(value))
    assert Fraction(value) - Fraction(lower) <= unit * size
    assert Fraction(upper) - Fraction(value) <= unit * max(size, Fraction(1, 10))


@pytest.mark.parametrize(
    ("value", "lower", "upper"),
    [
        (0.32846, "0.328", "0.329"),
        (1.2349, "1.23", "1.24"),
        (0.5, "0.5", "0.5"),
        (np.nextafter(0.29, 0), "0.289", "0.29"),
        (9.999, "9.99", "10"),
        (1.125e-10, "1.12e-10", "0.001"),
        (0.01234, "0.0123", "0.013"),
        (-9.5002, "-9.51", "-9.5"),
        (0.0, "0", "0"),
        (np.inf, "inf", "inf"),
        (np.nan, "nan", "nan"),
    ],
)
def test_three_digits(value: float, lower: str, upper: str) -> None:
    assert rounded_down(value) == lower
    assert rounded_up(value) == upper
