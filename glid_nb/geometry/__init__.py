"""Polygons with holes: validation, offsets, hole points, sampling and triangulation."""

from glid_nb.geometry._loops import GeometryError, as_points, loop_name, place, places, signed_area
from glid_nb.geometry.cage import Cage
from glid_nb.geometry.cutting import cut
from glid_nb.geometry.domain import Domain
from glid_nb.geometry.meshes import MeshMap, Overlay, Triangulation, triangulate
from glid_nb.geometry.offset import Offset, hole_points, offset_cage
from glid_nb.geometry.panels import Panels, graded_panels, uniform_panels
