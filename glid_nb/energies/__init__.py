"""Isometric energies (paper Section 6, Table 1)."""

from glid_nb.energies.custom import CustomEnergy as CustomEnergy
from glid_nb.energies.energy import ENERGIES as ENERGIES
from glid_nb.energies.energy import Differentials as Differentials
from glid_nb.energies.energy import Energy as Energy
from glid_nb.energies.energy import EnergyError as EnergyError
from glid_nb.energies.energy import as_energy as as_energy
from glid_nb.energies.energy import energy_by_name as energy_by_name
from glid_nb.energies.energy import register_energy as register_energy
from glid_nb.energies.table1 import AMIPS as AMIPS
from glid_nb.energies.table1 import ARAP as ARAP
from glid_nb.energies.table1 import MIPS as MIPS
from glid_nb.energies.table1 import ExponentialSymmetricDirichlet as ExponentialSymmetricDirichlet
from glid_nb.energies.table1 import SymmetricDirichlet as SymmetricDirichlet
