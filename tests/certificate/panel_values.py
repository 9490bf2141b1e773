"""Polynomials on a panel, as the certificates see them, and their values on the whole panel."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

from glid_nb.certificate import EndValues

Array = NDArray[Any]

PANELS = 8
T = np.linspace(0, 1, 401)

# Coefficients of f_z and conj(f_zbar) over t in [0, 1]; f_z is mostly the larger one.
seeds = st.tuples(
    st.integers(0, 10**6), st.floats(0.05, 3), st.integers(0, 200).map(lambda i: i / 100)
)


def polynomials(drawn: tuple[int, float, float], degree: int) -> tuple[Array, Array]:
    """(PANELS, degree + 1) power-basis coefficients of two complex polynomials."""
    seed, wobble, second = drawn
    rng = np.random.default_rng(seed)

    def random(size: float) -> Array:
        shape = (PANELS, degree + 1)
        return size * (rng.normal(size=shape) + 1j * rng.normal(size=shape))

    f, g = random(wobble / (degree + 1)), random(0.3 * second)
    f[:, 0] += np.exp(1j * rng.uniform(0, 2 * np.pi, PANELS))
    g[PANELS // 2 :] = 0 if seed % 7 == 0 else g[PANELS // 2 :]
    return f, g


def values(coefficients: Array, t: Array = T) -> Array:
    """(PANELS, t) values."""
    return coefficients @ t ** np.arange(coefficients.shape[1])[:, None]


def derivative(coefficients: Array) -> Array:
    return coefficients[:, 1:] * np.arange(1, coefficients.shape[1])


def end_values(f: Array) -> EndValues:
    """Panels of length 1: derivatives along the panel are those in t."""
    ends = (np.zeros(1), np.ones(1))
    return EndValues(*(values(c, t)[:, 0] for c in (f, derivative(f)) for t in ends))


def change_of_argument(path: Array) -> Array:
    """Continuous change of the argument along densely sampled paths (PANELS, t)."""
    return np.angle(path[:, 1:] / path[:, :-1]).sum(axis=1)
