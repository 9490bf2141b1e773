"""Section 8 of the paper, "Locally injective certification", in its order.

A segment of the boundary runs from ``v_i`` to ``v_{i+1}`` and has the length ``l``. On it ``f_z``
and ``f_zbar`` are Lipschitz continuous with constants ``L_fz`` and ``L_fzbar``. If Condition (27)
holds on all segments and the sum (30) is 0, the map is locally injective. The last class is the
proof that Figure 7 compares it with.
"""

import functools
import math
import operator
from typing import Any as Array  # of NumPy or of JAX
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from glid_nb._jax import Bool, Complex, Float, Int
from glid_nb.certificate import rounding
from glid_nb.certificate.panels import Ends, EndValues, PanelBounds, PerPanel, Rows, modulus
from glid_nb.harmonic.cauchy import Singularities, slope_jumps

Weights = Float[Array, "p n"]


def segment_bounds(
    fz: EndValues, fzb_conj: EndValues, variation: Float[Array, "2 p"] | list[Array]
) -> PanelBounds:
    """Bounds on each segment (Section 8), with ``variation`` = ``L_fz l`` and ``L_fzbar l``.

    ``|f_z|_min   = (|f_z(v_i)| + |f_z(v_{i+1})|) / 2 - L_fz l / 2``,
    ``|f_zbar|_max = (|f_zbar(v_i)| + |f_zbar(v_{i+1})|) / 2 + L_fzbar l / 2``.
    Condition (26) says that the first is at least the second. It is equivalent to
    ``sigma_2(v_i) + sigma_2(v_{i+1}) >= (L_fz + L_fzbar) l`` (27). (28) proves the turning.
    """
    variation_fz, variation_fzb = variation
    mean_fz = (modulus(fz.start) + modulus(fz.end)) / 2
    mean_fzb = (modulus(fzb_conj.start) + modulus(fzb_conj.end)) / 2
    fz_min = mean_fz - variation_fz / 2
    fzb_max = mean_fzb + variation_fzb / 2
    sigma1 = mean_fz + variation_fz / 2 + fzb_max
    xp = sigma1.__array_namespace__()
    finite = xp.isfinite(sigma1**2)
    return PanelBounds(
        sigma2_lower=xp.where(finite, fz_min - fzb_max, -xp.inf),
        sigma1_upper=xp.where(finite, sigma1, xp.inf),
        k_upper=xp.where(fz_min > 0, fzb_max / fz_min, xp.inf),
        turning_known=finite & (2 * mean_fz > variation_fz),
        turning=turning(fz.start, fz.end),
    )


class Lipschitz(NamedTuple):
    """The paper's proof, by its Lipschitz constants (Section 8, Appendix H)."""

    weights: Float[Array, "n p"]  # l^2 / 2 times L_j and L_j^h, and `beside`

    slack_share = 2  # half of the remainder is subtracted from each mean

    @classmethod
    def on(cls, start: Ends, end: Ends, singularities: Singularities) -> Self:
        weights = derivative_bound_weights(start, end, singularities, 2) / 2
        return cls((weights + beside(start, end, singularities)).T)

    def remainder(self, coefficients: Rows, singularities: Singularities) -> Float[Array, "k p"]:
        """``l^2/2 (sum_j L_j |s_j - s_{j+1}| + sum_j L_j^h |phi_j|)``, a part of ``L_fz l``."""
        return jumps(coefficients, singularities) @ self.weights

    @staticmethod
    def bounds(fz: EndValues, fzb_conj: EndValues, remainder: Float[Array, "2 p"]) -> PanelBounds:
        variations = [variation(fz, remainder[0]), variation(fzb_conj, remainder[1])]
        return segment_bounds(fz, fzb_conj, variations)


def variation(f: EndValues, remainder: PerPanel) -> PerPanel:
    """``L l``, with the Lipschitz constant of ``f_z`` or ``f_zbar`` per segment (Section 8, (H.1)).

    ``L_fz = (|f_z'(v_i)| + |f_z'(v_{i+1})|) / 2
    + l/2 (sum_j L_j |s_j - s_{j+1}| + sum_j L_j^h |phi_j|)``; ``remainder`` is the second term
    times ``l``.
    """
    return (modulus(f.slope_start) + modulus(f.slope_end)) / 2 + remainder


def jumps(coefficients: Rows, singularities: Singularities) -> Float[Array, "k n"]:
    """``|s_j - s_{j+1}|``, and ``|phi_j|`` for the holes (Appendix H)."""
    return modulus(slope_jumps(coefficients, singularities))


def derivative_bound_weights(
    start: Ends, end: Ends, singularities: Singularities, order: int
) -> Float[Array, "p n"]:
    """Weights ``w`` with ``l^order |d^order f_z / dz^order| <= w @ jumps`` on each segment.

    For ``order`` 2 they are ``l^2`` times ``L_j = 1 / (2 pi d(z_j)^2)`` and ``L_j^h = 2 /
    d(rho_k)^3`` of Appendix H, which Appendix G precomputes. In general they are
    ``(order-1)! / (2 pi) (l/d)^order`` and ``order! (l/d)^order / d``. They also hold on the edge
    that the segment is a rounded part of.
    """
    d, ratio = clearance(start, end, singularities)
    m, xp = singularities.vertices.shape[0], start.__array_namespace__()
    power = rounding.UPWARD * functools.reduce(operator.mul, [ratio] * order)
    vertices = math.factorial(order - 1) / (2 * math.pi) * power[:, :m]
    return xp.concat([vertices, math.factorial(order) * power[:, m:] / d[:, m:]], axis=1)


def beside(start: Ends, end: Ends, singularities: Singularities) -> Float[Array, "p n"]:
    """Weights ``w``: ``w @ jumps`` bounds the effect of panel ends that lie beside their edge.

    An end that is off by ``delta`` changes the value there by ``delta |f_z'|``, and the slope along
    the panel by ``2 delta |f_z'| + delta l |f_z''|``. Each bound changes by at most twice the sum.
    """
    d, ratio = clearance(start, end, singularities)
    m, xp = singularities.vertices.shape[0], start.__array_namespace__()
    off = 4 * rounding.UPWARD * beside_by(singularities) / d * (1 + ratio)
    return xp.concat([off[:, :m] / (2 * math.pi), 2 * off[:, m:] / d[:, m:]], axis=1)


def clearance(start: Ends, end: Ends, singularities: Singularities) -> tuple[Weights, Weights]:
    """Lower bounds on :func:`distances` around each segment, and ``l / d``; 0 and inf without one.

    The computed nearest point is off by 16 roundoffs of the distance to ``start``, which is at most
    ``d + l``. The segment's ends are off by at most `rounding.BESIDE`.
    """
    d, length = distances(start, end, singularities), modulus(end - start)[:, None]
    u, off = 32 * rounding.UNIT_ROUNDOFF, beside_by(singularities)
    d = start.__array_namespace__().maximum(d * (1 - u) - u * length - off, 0)
    return d, (length + 2 * off) / d


def beside_by(singularities: Singularities) -> Float[Array, ""]:
    """How far the end of a panel may lie beside its edge: inside the offset cage's exterior."""
    vertices, xp = singularities.vertices, singularities.vertices.__array_namespace__()
    exterior = xp.arange(vertices.shape[0]) <= singularities.previous[0]
    return rounding.BESIDE * xp.max(xp.where(exterior, modulus(vertices), 0))


def distances(start: Ends, end: Ends, singularities: Singularities) -> Float[Array, "p n"]:
    """``d(z_j)`` and ``d(rho_k)``: the distance of each segment to each singularity."""
    xp = start.__array_namespace__()
    points = xp.concat([singularities.vertices, singularities.hole_points])
    along = (end - start)[:, None]
    relative = points - start[:, None]
    length_squared = xp.real(along) ** 2 + xp.imag(along) ** 2
    position = xp.real(relative * xp.conj(along)) / xp.where(length_squared > 0, length_squared, 1)
    return modulus(relative - xp.clip(position, 0, 1) * along)


def turning(fz_start: Ends, fz_end: Ends) -> PerPanel:
    """``Arg(f_z(v_{i+1}) / f_z(v_i))`` (29), the change of ``arg f_z`` along each segment if
    ``|f_z(v_i)| + |f_z(v_{i+1})| > L_fz l`` (28): Theorem 8.1."""
    xp = fz_end.__array_namespace__()
    return xp.angle(fz_end * xp.conj(fz_start))


def windings(turning: NDArray[np.float64], loop: NDArray[np.intp], n_loops: int) -> tuple[int, ...]:
    """Turns of ``f_z`` along each loop: the integrals of (4a), as the inner sums of (30)."""
    turns = np.bincount(loop, weights=turning, minlength=n_loops) / (2 * np.pi)
    return tuple(int(w) for w in np.round(np.nan_to_num(turns)))


def fz_vanishes(turning: PerPanel) -> Bool[Array, ""]:
    """Whether ``f_z`` has zeros in the domain, so that (4a) fails (Corollary 8.2).

    Then the sum (30) of all turnings is not 0. It is a multiple of ``2 pi`` up to rounding if all
    are known.
    """
    return abs(turning.sum()) > 1


class BDHMLipschitz(NamedTuple):
    """The proof by the larger constants of bounded distortion harmonic mappings (Figure 7).

    On a segment, ``|f_z'| <= sum_j L_j |phi_j|`` with ``L_j = |z_{j+1} - z_{j-1}| / (2 pi
    d(z_{j-1}) d(z_j) d(z_{j+1}))``, a bound on ``|D_j'|`` (Chen & Weber 2015). A hole's logarithm
    has ``1 / d^2``.

    An affine function of ``z_j`` that is added to a loop's coefficients changes ``f_z`` by a
    constant. So one is subtracted on every loop: the one through the vertex of largest ``L_j`` and
    the larger of its neighbours. There are ``n = m + N`` vertices and holes.
    """

    length: PerPanel  # l, and what ends beside their edge add
    weights: Float[Array, "n p"]  # L_j
    first: Int[Array, "m p"]  # the vertex with the largest L on the loop of z_j
    second: Int[Array, "m p"]  # the neighbour of first with the larger L

    slack_share = 2

    @classmethod
    def on(cls, start: Ends, end: Ends, singularities: Singularities) -> Self:
        vertices, following, preceding, _ = map(np.asarray, singularities)
        m = len(vertices)
        d, _ = clearance(start, end, singularities)
        near = d[:, :m]
        chord = modulus(vertices[following] - vertices[preceding])
        weights = chord / (2 * np.pi * near[:, preceding] * near * near[:, following])
        begins = np.roll(following <= np.arange(m), 1)
        loop = np.cumsum(begins) - 1

        def largest(values: Array) -> Array:
            return np.maximum.reduceat(values, np.flatnonzero(begins), axis=1)[:, loop]

        first = largest(np.where(weights == largest(weights), np.arange(m), -1))
        take = np.take_along_axis
        after = take(weights, following[first], 1) >= take(weights, preceding[first], 1)
        second = np.where(after, following[first], preceding[first])
        weights = np.concatenate([weights, 1 / d[:, m:] ** 2], axis=1)
        # An end that is off by delta changes the value there by delta L.
        length = rounding.UPWARD * (modulus(end - start) + 4 * beside_by(singularities))
        return cls(length, weights.T, first.T, second.T)

    def constants(self, coefficients: Rows, singularities: Singularities) -> Float[Array, "k p"]:
        """Lipschitz constants on each segment, one row per row of coefficients."""
        z, m = singularities.vertices, self.first.shape[0]
        first, second, weights = self.first.T, self.second.T, self.weights.T
        z1, z2 = z[first], z[second]

        def one(row: Complex[Array, " n"]) -> PerPanel:
            phi = row[:m]
            phi1 = phi[first]
            slope = (phi[second] - phi1) / (z2 - z1)
            rest = modulus(phi - phi1 - slope * (z - z1))
            return (weights[:, :m] * rest).sum(axis=1) + weights[:, m:] @ modulus(row[m:])

        return coefficients.__array_namespace__().stack([one(row) for row in coefficients])

    def remainder(self, coefficients: Rows, singularities: Singularities) -> Float[Array, "k p"]:
        return self.length * self.constants(coefficients, singularities)

    @staticmethod
    def bounds(fz: EndValues, fzb_conj: EndValues, remainder: Float[Array, "2 p"]) -> PanelBounds:
        return segment_bounds(fz, fzb_conj, remainder)
