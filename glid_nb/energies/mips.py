"""Most isometric parametrisations: the conformal energy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from glid_nb.energies.energy import Differentials, Energy, register_energy

if TYPE_CHECKING:
    from glid_nb.energies.energy import Scalars


@register_energy
@dataclass(frozen=True)
class MIPS(Energy):
    """``(sigma_1 / sigma_2 + sigma_2 / sigma_1) / 2`` [Hormann and Greiner 2000].

    In Wirtinger terms ``(x + y) / (x - y)``. It is 1 at every conformal map, whatever its scale,
    and infinite where the map degenerates.
    """

    name: ClassVar[str] = "mips"

    def density(self, x: Scalars, y: Scalars) -> Scalars:
        return (x + y) / (x - y)

    def differentials(self, x: Scalars, y: Scalars) -> Differentials:
        inverse = 1 / (x - y)
        square, cube = inverse**2, inverse**3
        return Differentials(
            -2 * y * square, 2 * x * square, 4 * y * cube, 4 * x * cube, -2 * (x + y) * cube
        )
