"""Symmetric Dirichlet energy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from glid_nb.energies.energy import Differentials, Energy, register_energy

if TYPE_CHECKING:
    from glid_nb.energies.energy import Scalars


@register_energy
@dataclass(frozen=True)
class SymmetricDirichlet(Energy):
    """``E_iso = (sigma_1^2 + sigma_1^-2 + sigma_2^2 + sigma_2^-2) / 2`` (Equation (10a)).

    In Wirtinger terms ``(x + y) (1 + (x - y)^-2)`` (Table 1, first row). It is 2 at an isometry
    and infinite where the map degenerates.
    """

    name: ClassVar[str] = "iso"
    indefinite_across_f_only: ClassVar[bool] = True

    def density(self, x: Scalars, y: Scalars) -> Scalars:
        return (x + y) * (1 + (x - y) ** -2)

    def differentials(self, x: Scalars, y: Scalars) -> Differentials:
        inverse = 1 / (x - y)
        cube, fourth = inverse**3, inverse**4
        return Differentials(
            1 - (x + 3 * y) * cube,
            1 + (3 * x + y) * cube,
            2 * (x + 5 * y) * fourth,
            2 * (5 * x + y) * fourth,
            -6 * (x + y) * fourth,
        )
