"""Polygons with holes: validation, offsets, hole points, sampling and triangulation."""

from glid_nb.geometry._loops import GeometryError as GeometryError
from glid_nb.geometry._loops import as_points as as_points
from glid_nb.geometry._loops import loop_name as loop_name
from glid_nb.geometry._loops import place as place
from glid_nb.geometry._loops import places as places
from glid_nb.geometry._loops import signed_area as signed_area
from glid_nb.geometry.cage import Cage as Cage
from glid_nb.geometry.domain import Domain as Domain
from glid_nb.geometry.meshes import MeshMap as MeshMap
from glid_nb.geometry.meshes import Triangulation as Triangulation
from glid_nb.geometry.meshes import triangulate as triangulate
from glid_nb.geometry.offset import Offset as Offset
from glid_nb.geometry.offset import hole_points as hole_points
from glid_nb.geometry.offset import offset_cage as offset_cage
from glid_nb.geometry.panels import Panels as Panels
from glid_nb.geometry.panels import graded_panels as graded_panels
from glid_nb.geometry.panels import uniform_panels as uniform_panels
