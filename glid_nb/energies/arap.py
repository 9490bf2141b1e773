"""As-rigid-as-possible energy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from glid_nb._jax import jnp
from glid_nb.energies.energy import Differentials, Energy, register_energy

if TYPE_CHECKING:
    from glid_nb.energies.energy import Scalars


@register_energy
@dataclass(frozen=True)
class ARAP(Energy):
    """``E_ARAP = (sigma_1 - 1)^2 + (sigma_2 - 1)^2`` (Section 6).

    For an orientation-preserving map ``2 (x + y) - 4 sqrt(x) + 2``. It stays finite where the
    map degenerates, so it is no barrier: the certificate alone keeps a solve from folding.
    """

    name: ClassVar[str] = "arap"
    is_barrier: ClassVar[bool] = False
    indefinite_across_f_only: ClassVar[bool] = True

    def density(self, x: Scalars, y: Scalars) -> Scalars:
        return 2 * (x + y) - 4 * jnp.sqrt(x) + 2

    def differentials(self, x: Scalars, y: Scalars) -> Differentials:  # noqa: ARG002
        root = 1 / jnp.sqrt(x)
        zero = jnp.zeros_like(x)
        return Differentials(2 - 2 * root, zero + 2, root**3, zero, zero)
