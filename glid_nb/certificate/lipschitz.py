"""The paper's certificate: Lipschitz constants on segments (Section 8, Appendix H)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from glid_nb._jax import jnp
from glid_nb.certificate.bounds import EndValues, PanelBounds, modulus, turning

if TYPE_CHECKING:
    from jaxtyping import Array, Float

DERIVATIVE_ORDER = 2


def remainder_factor(length: Float[Array, " p"]) -> Float[Array, " p"]:
    """``l^2 / 2``: turns the bound on ``f_z''`` into that on ``|f_z'| l`` beyond its mean."""
    return length**2 / 2


def panel_bounds(
    values: EndValues,
    remainder_fz: Float[Array, " p"],
    remainder_fzb: Float[Array, " p"],
) -> PanelBounds:
    """Bounds on each segment by Equation (26).

    With ``L l = (|f_z'(v_i)| + |f_z'(v_{i+1})|) l / 2 + remainder``, ``|f_z|`` is at least the
    mean of its end values less ``L l / 2``, and likewise ``|f_zbar|`` at most.
    """
    variation_fz = (modulus(values.dfz_start) + modulus(values.dfz_end)) / 2 + remainder_fz
    variation_fzb = (modulus(values.dfzb_start) + modulus(values.dfzb_end)) / 2 + remainder_fzb
    return bounds_from_variation(values, variation_fz, variation_fzb)


def bounds_from_variation(
    values: EndValues, variation_fz: Float[Array, " p"], variation_fzb: Float[Array, " p"]
) -> PanelBounds:
    """Bounds on each segment by Equation (26), ``variation`` being ``L l``."""
    mean_fz = (modulus(values.fz_start) + modulus(values.fz_end)) / 2
    mean_fzb = (modulus(values.fzb_start) + modulus(values.fzb_end)) / 2
    fz_least = mean_fz - variation_fz / 2
    fzb_most = mean_fzb + variation_fzb / 2
    return PanelBounds(
        fz_least - fzb_most,
        mean_fz + variation_fz / 2 + fzb_most,
        jnp.where(fz_least > 0, fzb_most / fz_least, jnp.inf),
        2 * mean_fz > variation_fz,
        turning(values),
    )
