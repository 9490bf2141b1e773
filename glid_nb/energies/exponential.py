"""Exponential symmetric Dirichlet energy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from glid_nb._jax import jnp
from glid_nb.energies.energy import Differentials, Energy, register_energy
from glid_nb.energies.parameters import checked_sharpness
from glid_nb.energies.symmetric_dirichlet import SymmetricDirichlet

if TYPE_CHECKING:
    from glid_nb.energies.energy import Scalars


@register_energy
@dataclass(frozen=True)
class ExponentialSymmetricDirichlet(Energy):
    """``E_exp = exp(s E_iso)`` (Table 1, second row).

    Parameters
    ----------
    s : float
        Sharpness, positive: the larger, the lower the greatest distortion and the higher the
        average one (Figure 6).

    Raises
    ------
    EnergyError
        When ``s`` is not a positive finite number.
    """

    s: float = 1.0

    name: ClassVar[str] = "exp"
    indefinite_across_f_only: ClassVar[bool] = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "s", checked_sharpness(self.name, self.s))

    def density(self, x: Scalars, y: Scalars) -> Scalars:
        return jnp.exp(self.s * SymmetricDirichlet().density(x, y))

    def differentials(self, x: Scalars, y: Scalars) -> Differentials:
        s = self.s
        a1, a2, b1, b2, b3 = SymmetricDirichlet().differentials(x, y)
        factor = s * self.density(x, y)
        return Differentials(
            factor * a1,
            factor * a2,
            factor * (b1 + s * a1**2),
            factor * (b2 + s * a2**2),
            factor * (b3 + s * a1 * a2),
        )
