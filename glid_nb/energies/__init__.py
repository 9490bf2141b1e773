"""Isometric energies (paper Section 6, Table 1)."""

from glid_nb.energies.amips import AMIPS
from glid_nb.energies.arap import ARAP
from glid_nb.energies.custom import CustomEnergy
from glid_nb.energies.energy import Differentials, Energy, EnergyError, register_energy
from glid_nb.energies.exponential import ExponentialSymmetricDirichlet
from glid_nb.energies.mips import MIPS
from glid_nb.energies.named import ENERGY_NAMES, as_energy, energy_by_name
from glid_nb.energies.symmetric_dirichlet import SymmetricDirichlet

__all__ = [
    "AMIPS",
    "ARAP",
    "ENERGY_NAMES",
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
