"""Figure 7's Lipschitz constants of bounded distortion harmonic mappings (Chen & Weber 2015).

On a segment, ``|f_z'| <= sum_j L_j |phi_j|`` with ``L_j = |z_{j+1} - z_{j-1}| / (2 pi d(z_{j-1})
d(z_j) d(z_{j+1}))``, a bound on ``|D_j'|``. Adding an affine function of ``z_j`` to a loop's
coefficients changes ``f_z`` by a constant at most, so on every loop the one through the vertex of
largest ``L_j`` and the larger of its neighbours is subtracted; a hole's logarithm has ``1 / d^2``.
"""

from typing import Any as Array  # of NumPy or of JAX
from typing import NamedTuple, Self

import numpy as np

from glid_nb._jax import Complex, Float, Int
from glid_nb.certificate import rounding
from glid_nb.certificate.panels import Ends, EndValues, PanelBounds, PerPanel, Rows, modulus
from glid_nb.certificate.paper import beside_by, clearance, segment_bounds
from glid_nb.harmonic.cauchy import Singularities


class BDHM(NamedTuple):
    """The proof by these constants, for ``n = m + N`` vertices and holes."""

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
