"""Harmonic maps on multiply-connected domains (paper Sections 4 and 5)."""

from glid_nb.harmonic.basis import Basis, build_basis
from glid_nb.harmonic.fixed_points import FixedPoints
from glid_nb.harmonic.map import HarmonicMap, MapError, as_complex, basis_of

__all__ = [
    "Basis",
    "FixedPoints",
    "HarmonicMap",
    "MapError",
    "as_complex",
    "basis_of",
    "build_basis",
]
