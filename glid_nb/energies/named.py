"""Energies by their short names, as the command line and the editor offer them."""

from __future__ import annotations

from glid_nb.energies.amips import AMIPS
from glid_nb.energies.arap import ARAP
from glid_nb.energies.energy import Energy, EnergyError
from glid_nb.energies.exponential import ExponentialSymmetricDirichlet
from glid_nb.energies.mips import MIPS
from glid_nb.energies.parameters import checked_sharpness
from glid_nb.energies.symmetric_dirichlet import SymmetricDirichlet

ENERGY_NAMES: tuple[str, ...] = ("iso", "exp", "amips", "mips", "arap")
"""The names that :func:`energy_by_name` knows."""


def energy_by_name(name: str, s: float | None = None) -> Energy:
    """The energy called ``name``: one of :data:`ENERGY_NAMES`.

    ``s`` is the parameter of ``exp`` and ``amips`` (default 1); the others have
    none and ignore it, but it must be positive all the same.

    Raises
    ------
    EnergyError
        For an unknown name, or an ``s`` that is not positive.
    """
    sharpness = 1.0 if s is None else checked_sharpness(name, s)
    if name == "iso":
        return SymmetricDirichlet()
    if name == "exp":
        return ExponentialSymmetricDirichlet(sharpness)
    if name == "amips":
        return AMIPS(sharpness)
    if name == "mips":
        return MIPS()
    if name == "arap":
        return ARAP()
    raise EnergyError(f"unknown energy {name!r}; choose one of {', '.join(ENERGY_NAMES)}")


def as_energy(energy: Energy | str | None) -> Energy:
    """An energy, or the one of that name, or the symmetric Dirichlet energy for None.

    Raises
    ------
    EnergyError
        For an unknown name, or something that is no energy.
    """
    if energy is None:
        return SymmetricDirichlet()
    if isinstance(energy, str):
        return energy_by_name(energy)
    if not isinstance(energy, Energy):
        raise EnergyError(
            f"energy is {energy!r}; pass an energy, such as SymmetricDirichlet() or "
            f"CustomEnergy(function), or one of the names {', '.join(ENERGY_NAMES)}"
        )
    return energy
