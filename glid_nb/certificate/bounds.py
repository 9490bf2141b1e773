"""What a certificate says of each panel, and the bounds on derivatives that it rests on."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from glid_nb._jax import jnp
from glid_nb.harmonic.cauchy import Singularities

if TYPE_CHECKING:
    from jaxtyping import Array, Bool, Complex, Float

UNIT_ROUNDOFF = 2.0**-53


class EndValues(NamedTuple):
    """``f_z``, ``conj(f_zbar)`` and their derivatives at the two ends of each panel.

    Derivatives are along the panel: the complex derivative times ``end - start``.
    """

    fz_start: Complex[Array, " p"]
    fz_end: Complex[Array, " p"]
    fzb_start: Complex[Array, " p"]
    fzb_end: Complex[Array, " p"]
    dfz_start: Complex[Array, " p"]
    dfz_end: Complex[Array, " p"]
    dfzb_start: Complex[Array, " p"]
    dfzb_end: Complex[Array, " p"]


class PanelBounds(NamedTuple):
    """Proved on the whole panel, ends included; ``turning_known`` is part of the proof."""

    sigma2_lower: Float[Array, " p"]
    sigma1_upper: Float[Array, " p"]
    k_upper: Float[Array, " p"]
    turning_known: Bool[Array, " p"]
    """Whether the change of ``arg f_z`` along the panel is proved to be ``turning`` (29)."""
    turning: Float[Array, " p"]
    """The principal ``Arg`` of the quotient of the end values of ``f_z``."""

    @property
    def injective(self) -> Bool[Array, " p"]:
        """Where ``|f_z| > |f_zbar|`` is proved and the turning is known (Conditions 4a, 5)."""
        return (self.sigma2_lower > 0) & self.turning_known


def modulus(z: Complex[Array, " *k"]) -> Float[Array, " *k"]:
    """``|z|`` without care for overflow, which no value here is near; it compiles to much less."""
    return jnp.sqrt(jnp.real(z) ** 2 + jnp.imag(z) ** 2)


def turning(values: EndValues) -> Float[Array, " p"]:
    """Principal ``Arg(f_z(v_{i+1}) / f_z(v_i))`` of each panel, a term of (30)."""
    return jnp.angle(values.fz_end * jnp.conj(values.fz_start))


def distances(
    start: Complex[Array, " p"], end: Complex[Array, " p"], singularities: Singularities
) -> Float[Array, "p n"]:
    """Distance of each panel to each singularity (``d(z_j)`` and ``d(rho_k)`` of Section 8)."""
    points = jnp.concatenate([singularities.vertices, singularities.hole_points])
    along = (end - start)[:, None]
    relative = points - start[:, None]
    length_squared = jnp.real(along) ** 2 + jnp.imag(along) ** 2
    position = jnp.real(relative * jnp.conj(along)) / jnp.where(
        length_squared > 0, length_squared, 1
    )
    return modulus(relative - jnp.clip(position, 0, 1) * along)


def derivative_bound_weights(
    start: Complex[Array, " p"],
    end: Complex[Array, " p"],
    singularities: Singularities,
    order: int,
) -> Float[Array, "p n"]:
    """Weights ``w`` with ``|d^order f_z / dz^order| <= w @ |slope jumps|`` on each panel.

    Appendix H bounds ``f_z''`` so, ``1 / (2 pi d^2)`` for vertices and ``2 / d^3`` for holes;
    the ``order``-th derivative has ``(order-1)! / (2 pi d^order)`` and ``order! / d^(order+1)``.
    """
    d = distances(start, end, singularities)
    m = singularities.vertices.shape[0]
    vertices = math.factorial(order - 1) / (2 * math.pi) * d[:, :m] ** -order
    holes = math.factorial(order) * d[:, m:] ** -(order + 1)
    return jnp.concatenate([vertices, holes], axis=1)
