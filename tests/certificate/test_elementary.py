"""Errors of NumPy's and XLA's elementary functions on this machine, compared with Arb.

The proof of a map rests on these numbers (docs/proof.md). If the machine has extended precision,
all 10^6 arguments are compared with it, and a tenth and the worst of them with Arb. Otherwise all
are compared with Arb.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import flint
import jax.numpy as jnp
import numpy as np
import pytest
from flint import acb, arb

from glid_nb._features import enable_x64, solver_jit
from glid_nb.certificate import rounding
from glid_nb.harmonic import cauchy
from glid_nb.harmonic.cauchy import Singularities

pytestmark = pytest.mark.slow

Array = np.ndarray[Any, Any]
COUNT, WORST = 10**6, 200
WIDER = np.finfo(np.longdouble).nmant > 52
SAMPLE = COUNT // 10 if WIDER else COUNT


def arguments(seed: int) -> Array:
    """(COUNT,) complex: of all sizes, near modulus 1, near 1 itself, near the cut and the axes."""
    rng = np.random.default_rng(seed)
    n = COUNT // 5

    def turned(r: Array) -> Array:
        return r * np.exp(1j * rng.uniform(-np.pi, np.pi, n))

    def tiny() -> Array:
        return rng.normal(size=n) * 10.0 ** rng.uniform(-18, 0, n)

    size = np.exp(rng.uniform(-150, 150, n))
    return np.concatenate(
        [
            turned(size),
            turned(1 + tiny()),
            1 + tiny() + 1j * tiny(),
            -np.exp(rng.uniform(-40, 40, n)) * (1 + 1j * tiny()),
            size * np.array([1, 1j, -1, -1j])[rng.integers(0, 4, n)] * (1 + 1e-3 * turned(size**0)),
        ]
    )


def exact_ratio(a: complex, b: complex) -> acb:
    return acb(a.real, a.imag) / acb(b.real, b.imag)


def compiled(function: Callable[..., Any], *args: Array) -> Array:
    with enable_x64():
        return np.asarray(solver_jit(function)(*args))


def check(
    computed: Array, estimate: Array, scale: Array, exact: Callable[[int], Any], allowed: float
) -> None:
    """``|computed - exact| <= allowed u scale`` in a sample, and wherever the estimate is worst."""
    off = np.abs(computed - estimate) / (rounding.UNIT_ROUNDOFF * scale)
    if WIDER:
        assert np.max(off) <= allowed, int(np.argmax(off))
    rng = np.random.default_rng(1)
    sample = rng.permutation(len(computed))[:SAMPLE]
    flint.ctx.prec = 120
    for i in map(int, [*sample, *np.argsort(off)[-WORST:]]):
        value = computed[i]
        ball = acb(value.real, value.imag) if np.iscomplexobj(computed) else arb(value)
        bound = allowed * rounding.UNIT_ROUNDOFF * float(scale[i])
        assert abs(ball - exact(i)) <= bound, (i, value)


def test_real_logarithms() -> None:
    x = np.abs(arguments(0))
    wide = np.log(x.astype(np.longdouble))
    scale = np.maximum(np.abs(np.log(x)), 1e-300)
    for computed in (np.log(x), compiled(jnp.log, x)):
        check(computed, wide, scale, lambda i: arb(x[i]).log(), rounding.ELEMENTARY)


def test_angles() -> None:
    z = arguments(1)
    wide = np.arctan2(z.imag.astype(np.longdouble), z.real.astype(np.longdouble))
    scale = np.maximum(np.abs(np.angle(z)), 1e-300)

    def exact(i: int) -> arb:
        return acb(z[i].real, z[i].imag).log().imag

    # On the negative axis, Arb takes the upper branch, whatever the sign of zero.
    z.imag[z.imag == 0] = 0.0
    for computed in (np.angle(z), compiled(jnp.angle, z)):
        check(computed, np.abs(wide) * np.sign(np.angle(z)), scale, exact, rounding.ELEMENTARY)


def test_complex_quotients_and_products() -> None:
    a, b = arguments(2), arguments(3)
    wide = a.astype(np.clongdouble) / b.astype(np.clongdouble)
    scale = np.abs(a) / np.abs(b)

    def quotient(i: int) -> acb:
        return exact_ratio(complex(a[i]), complex(b[i]))

    for computed in (a / b, compiled(lambda a, b: a / b, a, b)):
        check(computed, wide, scale, quotient, rounding.COMPLEX_QUOTIENT)
    wide = a.astype(np.clongdouble) * b.astype(np.clongdouble)

    def product(i: int) -> acb:
        return acb(a[i].real, a[i].imag) * acb(b[i].real, b[i].imag)

    for computed in (a * b, compiled(lambda a, b: a * b, a, b)):
        check(computed, wide, np.abs(a) * np.abs(b), product, np.sqrt(5.0))


def test_square_roots_are_rounded_correctly() -> None:
    x = np.abs(arguments(4))
    np.testing.assert_array_equal(compiled(jnp.sqrt, x), np.sqrt(x))


def test_the_logarithm_of_an_edge() -> None:
    """Log(B_{j+1} / B_j) as the basis computes it; XLA's own is off by 50 roundoffs."""
    b, q = arguments(5), arguments(6)
    after = b * q
    none = np.array([], dtype=complex)
    edge = Singularities(np.zeros(2, complex), np.array([1, 0]), np.array([1, 0]), none)
    pairs = np.stack([b, after], axis=1)
    computed = cauchy.edge_logarithms(pairs, edge)[:, 0]
    wide = np.log(after.astype(np.clongdouble) / b.astype(np.clongdouble))
    # Near the cut both branches are right. The certificate keeps away from it.
    away = np.abs(computed.imag) < np.pi * (1 - 2 * rounding.CUT)
    assert away.mean() > 0.7
    b, after, computed, wide = b[away], after[away], computed[away], wide[away]

    def exact(i: int) -> acb:
        return exact_ratio(complex(after[i]), complex(b[i])).log()

    # The rounding of B_j and B_{j+1} themselves takes two roundoffs of what is allowed.
    check(computed, wide, 1 + np.abs(wide).astype(float), exact, rounding.LOGARITHM - 2)
