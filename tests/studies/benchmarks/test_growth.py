"""Exponents of powers."""

from __future__ import annotations

import math

import pytest

from studies.benchmarks.growth import exponent, local_exponents


def test_exponents_of_a_power() -> None:
    x = [10, 20, 80]
    y = [3 * value**2.5 for value in x]
    assert exponent(x, y) == pytest.approx(2.5)
    assert local_exponents(x, y) == pytest.approx([2.5, 2.5])


def test_one_size_has_no_exponent() -> None:
    assert math.isnan(exponent([10], [1.0]))
    assert local_exponents([10], [1.0]) == []


def test_what_noise_outweighs_has_no_exponent() -> None:
    first, second = local_exponents([10, 20, 40], [1.0, -0.1, 16.0])
    assert math.isnan(first)
    assert math.isnan(second)
    assert exponent([10, 20, 40], [1.0, -0.1, 16.0]) == pytest.approx(2)
