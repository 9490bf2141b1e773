"""Advanced MIPS energy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from glid_nb._jax import jnp
from glid_nb.energies.energy import Differentials, Energy, register_energy
from glid_nb.energies.parameters import checked_sharpness

if TYPE_CHECKING:
    from glid_nb.energies.energy import Scalars


@register_energy
@dataclass(frozen=True)
class AMIPS(Energy):
    """``exp(s (sigma_1/sigma_2 + sigma_2/sigma_1) + sigma_1 sigma_2 + 1/(sigma_1 sigma_2))``.

    In Wirtinger terms ``exp((2 s (x + y) + 1) / (x - y) + x - y)`` (Table 1, third row); the
    parameter ``s`` balances angle preservation against area preservation [Fu et al. 2015].

    Parameters
    ----------
    s : float
        Weight of the angles, positive.

    Raises
    ------
    EnergyError
        When ``s`` is not a positive finite number.
    """

    s: float = 1.0

    name: ClassVar[str] = "amips"

    def __post_init__(self) -> None:
        object.__setattr__(self, "s", checked_sharpness(self.name, self.s))

    def density(self, x: Scalars, y: Scalars) -> Scalars:
        det = x - y
        return jnp.exp((2 * self.s * (x + y) + 1) / det + det)

    def differentials(self, x: Scalars, y: Scalars) -> Differentials:
        s = self.s
        inverse = 1 / (x - y)
        square, cube = inverse**2, inverse**3
        a1 = 1 - (4 * s * y + 1) * square
        a2 = -1 + (4 * s * x + 1) * square
        energy = self.density(x, y)
        return Differentials(
            a1 * energy,
            a2 * energy,
            (a1**2 + 2 * (4 * s * y + 1) * cube) * energy,
            (a2**2 + 2 * (4 * s * x + 1) * cube) * energy,
            (a1 * a2 - (4 * s * (x + y) + 2) * cube) * energy,
        )
