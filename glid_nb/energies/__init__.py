"""Isometric energies (paper Section 6, Table 1)."""

from glid_nb.energies.energy import ENERGIES as ENERGIES
from glid_nb.energies.energy import CustomEnergy, Energy, by_name
from glid_nb.energies.energy import Differentials as Differentials
from glid_nb.energies.energy import EnergyError as EnergyError
from glid_nb.energies.energy import as_energy as as_energy
from glid_nb.energies.energy import isometry_energy as isometry_energy
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
    "MIPS",
    "CustomEnergy",
    "Energy",
    "ExponentialSymmetricDirichlet",
    "SymmetricDirichlet",
    "by_name",
]
