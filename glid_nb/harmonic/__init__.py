"""Harmonic maps on multiply-connected domains (paper Sections 4 and 5)."""

from glid_nb.harmonic.basis import basis_of as basis_of
from glid_nb.harmonic.fixed_points import FixedPoints as FixedPoints
from glid_nb.harmonic.map import HarmonicMap as HarmonicMap
from glid_nb.harmonic.map import MapError as MapError
from glid_nb.harmonic.map import as_complex as as_complex
from glid_nb.harmonic.map import images_under as images_under
from glid_nb.harmonic.map import run_on as run_on
