"""Isometric energies (paper Section 6, Table 1)."""

from glid_nb.energies.energy import (
    ENERGIES,
    Differentials,
    Energy,
    as_energy,
    energy_by_name,
    isometry_energy,
)
from glid_nb.energies.energy import CustomEnergy as CustomEnergy
from glid_nb.energies.energy import EnergyError as EnergyError
from glid_nb.energies.table1 import AMIPS, ARAP, MIPS, SymmetricDirichlet
from glid_nb.energies.table1 import ExponentialSymmetricDirichlet as ExponentialSymmetricDirichlet
