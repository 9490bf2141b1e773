"""The harmonic map written out from the paper in plain NumPy: the yardstick of the numeric tests.

Nothing here is imported from the code under test. Points, vertices and coefficients are complex; a
cage is a list of loops, the exterior first, and every function also runs in extended precision when
its arguments are `numpy.clongdouble`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Points = NDArray[Any]
Loops = Sequence[Points]


def cauchy(z: Points, loops: Loops, rho: Points) -> Points:
    """(k, n) matrix of `C_j(z)`: Equations (8) and (D.1)."""
    columns = []
    for loop in loops:
        size = len(loop)
        for j in range(size):
            before, here, after = loop[j - 1], loop[j], loop[(j + 1) % size]
            b_before, b, b_after = before - z, here - z, after - z
            columns.append(
                b_after / (after - here) * np.log(b_after / b)
                - b_before / (here - before) * np.log(b / b_before)
            )
    columns = [column / (2j * np.pi) for column in columns]
    columns += [np.log(np.abs(z - point)).astype(z.dtype) for point in rho]
    return np.stack(columns, axis=1)


def cauchy_first(z: Points, loops: Loops, rho: Points) -> Points:
    """(k, n) matrix of `D_j(z)`: Equations (9) and (D.2)."""
    columns = []
    for loop in loops:
        size = len(loop)
        for j in range(size):
            before, here, after = loop[j - 1], loop[j], loop[(j + 1) % size]
            b_before, b, b_after = before - z, here - z, after - z
            columns.append(
                np.log(b / b_after) / (after - here) + np.log(b / b_before) / (here - before)
            )
    columns = [column / (2j * np.pi) for column in columns]
    columns += [1 / (z - point) for point in rho]
    return np.stack(columns, axis=1)


def cauchy_second(z: Points, loops: Loops, rho: Points) -> Points:
    """(k, n) matrix of `D'_j(z)`: Equation (D.4)."""
    columns = []
    for loop in loops:
        size = len(loop)
        for j in range(size):
            b_before, b, b_after = loop[j - 1] - z, loop[j] - z, loop[(j + 1) % size] - z
            columns.append((1 / (b_before * b) - 1 / (b * b_after)) / (2j * np.pi))
    columns += [-1 / (z - point) ** 2 for point in rho]
    return np.stack(columns, axis=1)


def holomorphic_derivative(
    function: Callable[[Points], Points], z: Points, order: int, radius: float, nodes: int = 64
) -> Points:
    """The `order`-th derivative at `z` by Cauchy's integral over circles of the given radius.

    Exact up to rounding where `function` is holomorphic on somewhat larger discs.
    """
    total = np.zeros(len(z), dtype=complex)
    for angle in 2 * np.pi * np.arange(nodes) / nodes:
        total += function(z + radius * np.exp(1j * angle)) * np.exp(-1j * order * angle)
    factorial = float(np.prod(np.arange(1, order + 1)))
    return total * factorial / (nodes * radius**order)


@dataclass(frozen=True)
class ReferenceMap:
    """`f` of Equation (8), with the conjugate that is missing there, and what follows from it."""

    loops: Loops
    rho: Points
    phi: Points
    psi: Points

    def f(self, z: Points) -> Points:
        c = cauchy(z, self.loops, self.rho)
        return c @ self.phi + (c @ self.psi).conj()

    def fz(self, z: Points) -> Points:
        return cauchy_first(z, self.loops, self.rho) @ self.phi

    def fzbar(self, z: Points) -> Points:
        return (cauchy_first(z, self.loops, self.rho) @ self.psi).conj()

    def sigma1(self, z: Points) -> Points:
        return np.abs(self.fz(z)) + np.abs(self.fzbar(z))

    def sigma2(self, z: Points) -> Points:
        return np.abs(self.fz(z)) - np.abs(self.fzbar(z))

    def k(self, z: Points) -> Points:
        return np.abs(self.fzbar(z)) / np.abs(self.fz(z))


@dataclass(frozen=True)
class DenseCheck:
    """`D` at many points of a domain, so that many maps on it can be measured."""

    loops: Loops
    rho: Points
    boundary: list[Points]
    inside: Points
    d_boundary: list[Points]
    d_inside: Points

    @classmethod
    def on(cls, cage: Loops, loops: Loops, rho: Points, count: int, seed: int = 0) -> DenseCheck:
        """About `count` points, one half on the boundary of `cage` and one half inside."""
        perimeter = sum(np.abs(np.diff(loop, append=loop[:1])).sum() for loop in cage)
        boundary = []
        for loop in cage:
            pieces = [
                start + (end - start) * np.arange(n) / n
                for start, end in zip(loop, np.roll(loop, -1), strict=True)
                for n in [int(np.ceil(count / 2 * abs(end - start) / perimeter))]
            ]
            boundary.append(np.concatenate(pieces))
        inside = points_inside(cage, count // 2, seed)
        return cls(
            loops,
            rho,
            boundary,
            inside,
            [cauchy_first(z, loops, rho) for z in boundary],
            cauchy_first(inside, loops, rho),
        )

    def measure(self, phi: Points, psi: Points) -> Measured:
        """The extremes are found in double precision, then computed in extended precision there."""
        fz, fzb = self.derivative(phi), self.derivative(psi)
        f, g = np.abs(np.concatenate(fz)), np.abs(np.concatenate(fzb))
        turns = [np.angle(np.roll(v, -1) / v).sum() / (2 * np.pi) for v in fz[:-1]]
        n_boundary = sum(len(v) for v in fz[:-1])
        extremes = [(f - g).argmin(), (f + g).argmax(), (g / f).argmax()]
        exact = ReferenceMap(*(_extended(v) for v in (self.loops, self.rho, phi, psi)))
        at = _extended(np.concatenate([*self.boundary, self.inside])[extremes])
        return Measured(
            float(exact.sigma2(at)[0]),
            float(exact.sigma1(at)[1]),
            float(exact.k(at)[2]),
            tuple(round(t) for t in turns),
            float((f - g)[:n_boundary].min()),
        )

    def derivative(self, coefficients: Points) -> list[Points]:
        """`D` times the coefficients, loop by loop and inside.

        A linear function's coefficients on a loop are its values, and its derivative is that of the
        exterior's alone. Without that part little is left to round: a motion is exact.
        """
        rest, slope, first = coefficients.copy(), 0.0 + 0.0j, 0
        for k, loop in enumerate(self.loops):
            part = slice(first, first + len(loop))
            ones = np.stack([loop - loop.mean(), np.ones(len(loop))], axis=1)
            fitted = np.linalg.lstsq(ones, rest[part])[0]
            rest[part] -= ones @ fitted
            slope = fitted[0] if k == 0 else slope
            first += len(loop)
        return [slope + d @ rest for d in [*self.d_boundary, self.d_inside]]


def _extended(values: Any) -> Any:
    if isinstance(values, np.ndarray):
        return values.astype(np.clongdouble)
    return [_extended(value) for value in values]


@dataclass(frozen=True)
class Measured:
    """Extremes over the dense points, and the turns of `f_z` along each loop."""

    sigma2: float
    sigma1: float
    k: float
    windings: tuple[int, ...]
    sigma2_boundary: float


def points_inside(cage: Loops, count: int, seed: int = 0) -> Points:
    """Random points of the domain between the loops, by the even-odd rule."""
    rng = np.random.default_rng(seed)
    low_x, high_x = cage[0].real.min(), cage[0].real.max()
    low_y, high_y = cage[0].imag.min(), cage[0].imag.max()
    found = np.empty(0, dtype=complex)
    while len(found) < count:
        z = rng.uniform(low_x, high_x, count) + 1j * rng.uniform(low_y, high_y, count)
        odd = np.zeros(count, dtype=bool)
        for loop in cage:
            for a, b in zip(loop, np.roll(loop, -1), strict=True):
                spans = (a.imag > z.imag) != (b.imag > z.imag)
                if a.imag != b.imag:
                    crossing = a.real + (b - a).real * (z.imag - a.imag) / (b.imag - a.imag)
                    odd ^= spans & (z.real < crossing)
        found = np.concatenate([found, z[odd]])
    return found[:count]
