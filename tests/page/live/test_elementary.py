"""The page's own ``log`` and ``atan2`` against Arb (docs/proof.md, Lemma 21)."""

from __future__ import annotations

from typing import Any

import flint
import numpy as np
import pytest
from flint import arb

from .in_node import answers

pytestmark = pytest.mark.slow

Array = np.ndarray[Any, Any]
COUNT = 20_000


def moduli(seed: int) -> Array:
    """Positive numbers of all sizes, near 1, and near the places where `log` changes its way."""
    rng = np.random.default_rng(seed)
    tiny = rng.normal(size=COUNT) * 10.0 ** rng.uniform(-16, 0, COUNT)
    powers = 2.0 ** rng.integers(-60, 60, COUNT)
    near = np.abs(1 + tiny)
    return np.concatenate(
        [np.exp(rng.uniform(-300, 300, COUNT)), near, near * powers, near * np.sqrt(2) * powers]
    )


def vectors(seed: int) -> tuple[Array, Array]:
    """Of all directions and sizes, near the axes, and near the places where `atan` changes."""
    rng = np.random.default_rng(seed)
    tiny = rng.normal(size=COUNT) * 10.0 ** rng.uniform(-18, 0, COUNT)
    slopes = rng.choice([0.4375, 0.6875, 1.0, 1.1875, 2.4375], COUNT) * (1 + tiny)
    signs = rng.choice([-1.0, 1.0], (2, 3 * COUNT))
    x = np.concatenate([rng.normal(size=COUNT), tiny, np.ones(COUNT)])
    y = np.concatenate([rng.normal(size=COUNT), np.ones(COUNT), slopes])
    size = np.exp(rng.uniform(-100, 100, 3 * COUNT))
    return np.concatenate([x, y]) * np.tile(size * signs[0], 2), np.concatenate([y, x]) * np.tile(
        size * signs[1], 2
    )


def roundoffs(found: Array, exact: list[arb]) -> float:
    """The largest relative error, in roundoffs."""
    errors = [
        abs(arb(a) - b) / abs(b) for a, b in zip(found.tolist(), exact, strict=True) if b != 0
    ]
    return float(max(map(float, errors))) * 2.0**53


def test_the_logarithm_is_off_by_at_most_2_roundoffs() -> None:
    flint.ctx.prec = 120
    x = moduli(1)
    (found,) = answers([{"ask": "log", "x": x.tolist()}])
    assert roundoffs(np.array(found), [arb(value).log() for value in x.tolist()]) < 2


def test_the_angle_is_off_by_at_most_3_roundoffs() -> None:
    flint.ctx.prec = 120
    x, y = vectors(2)
    (found,) = answers([{"ask": "atan2", "x": x.tolist(), "y": y.tolist()}])
    pairs = zip(x.tolist(), y.tolist(), strict=True)
    assert roundoffs(np.array(found), [arb.atan2(arb(b), arb(a)) for a, b in pairs]) < 3
