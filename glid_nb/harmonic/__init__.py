"""Harmonic maps on multiply-connected domains (paper Sections 4 and 5)."""

from glid_nb.harmonic.basis import Basis, basis_of
from glid_nb.harmonic.cauchy import Singularities
from glid_nb.harmonic.fixed_points import FixedPoints
from glid_nb.harmonic.inverse import Inverse, Preimages
from glid_nb.harmonic.map import HarmonicMap, MapError, as_complex, images_under, rows_of, run_on
from glid_nb.harmonic.traced import TracedMap as TracedMap
from glid_nb.harmonic.transport import DisplacementField, Transported, TransportError
