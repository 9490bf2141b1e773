"""Isometric energies (paper Section 6, Table 1)."""

from glid_nb.energies.custom import CustomEnergy
from glid_nb.energies.energy import (
    ENERGIES,
    Differentials,
    Energy,
    EnergyError,
    as_energy,
    energy_by_name,
    register_energy,
)
from glid_nb.energies.table1 import (
    AMIPS,
    ARAP,
    MIPS,
    ExponentialSymmetricDirichlet,
    SymmetricDirichlet,
)

__all__ = [
    "AMIPS",
    "ARAP",
    "ENERGIES",
    "MIPS",
    "CustomEnergy",
    "Differentials",
    "Energy",
    "EnergyError",
    "ExponentialSymmetricDirichlet",
    "SymmetricDirichlet",
    "as_energy",
    "energy_by_name",
    "register_energy",
]
