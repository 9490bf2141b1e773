"""The Lipschitz constants of bounded distortion harmonic mappings (Chen & Weber 2015).

The paper replaces them by far smaller ones (Section 8); they are kept for Figure 7. On a segment,
``|f_z'| <= sum_j L_j |phi_j|`` with ``L_j = |z_{j+1} - z_{j-1}| / (2 pi d(z_{j-1}) d(z_j)
d(z_{j+1}))``, a bound on ``|D_j'|``. Adding an affine function of ``z_j`` to a loop's coefficients
changes ``f_z`` by a constant at most, so the affine function through the vertex of largest ``L_j``
and the larger of its neighbours is subtracted first. The original has simply-connected domains;
here every loop has its affine function, and a hole's logarithm the constant ``1 / d^2``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from glid_nb._jax import jax, jnp
from glid_nb.certificate.bounds import distances, modulus
from glid_nb.certificate.lipschitz import bounds_from_variation as panel_bounds
from glid_nb.harmonic.cauchy import Singularities

if TYPE_CHECKING:
    from jaxtyping import Array, Complex, Float, Int

__all__ = ["SegmentWeights", "constants", "panel_bounds", "segment_weights"]


class SegmentWeights(NamedTuple):
    """What depends on the segments alone; ``m`` vertices, then ``N`` holes make ``n``."""

    constants: Float[Array, "p n"]
    """``L_j``."""
    first: Int[Array, "p m"]
    """The vertex of the loop of ``z_j`` at which ``L`` is largest on this segment."""
    second: Int[Array, "p m"]
    """The neighbour of ``first`` with the larger ``L``."""
    vertices: Complex[Array, " m"]


def segment_weights(
    start: Complex[Array, " p"], end: Complex[Array, " p"], singularities: Singularities
) -> SegmentWeights:
    """Constants of the basis functions on each segment, and where to subtract."""
    vertices, following, preceding, _ = singularities
    vertices, following, preceding = map(jnp.asarray, (vertices, following, preceding))
    m = vertices.shape[0]
    d = distances(start, end, singularities)
    near = d[:, :m]
    chord = modulus(vertices[following] - vertices[preceding])
    constants = chord / (2 * np.pi * near[:, preceding] * near * near[:, following])
    loop = _loops(following)
    largest = jax.ops.segment_max(constants.T, loop, m)[loop].T
    candidates = jnp.where(constants == largest, jnp.arange(m), -1)
    first = jax.ops.segment_max(candidates.T, loop, m)[loop].T
    value = jnp.take_along_axis
    after = value(constants, following[first], 1) >= value(constants, preceding[first], 1)
    second = jnp.where(after, following[first], preceding[first])
    return SegmentWeights(
        jnp.concatenate([constants, d[:, m:] ** -2], axis=1), first, second, vertices
    )


def constants(coefficients: Complex[Array, "k n"], weights: SegmentWeights) -> Float[Array, "k p"]:
    """Lipschitz constants on each segment, one row per row of coefficients."""
    z, m = weights.vertices, weights.vertices.shape[0]
    z1, z2 = z[weights.first], z[weights.second]

    def one(row: Complex[Array, " n"]) -> Float[Array, " p"]:
        phi = row[:m]
        phi1 = phi[weights.first]
        slope = (phi[weights.second] - phi1) / (z2 - z1)
        rest = modulus(phi - phi1 - slope * (z - z1))
        vertices = jnp.sum(weights.constants[:, :m] * rest, axis=1)
        return vertices + weights.constants[:, m:] @ modulus(row[m:])

    return jnp.stack([one(row) for row in coefficients])


def _loops(following: Int[Array, " m"]) -> Int[Array, " m"]:
    """The least index on the loop of each vertex, by pointer doubling."""
    label = jnp.arange(following.shape[0])
    for _ in range(following.shape[0].bit_length()):
        label = jnp.minimum(label, label[following])
        following = following[following]
    return label
