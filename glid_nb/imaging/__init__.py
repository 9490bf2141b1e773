"""Trace cages from pictures, and draw pictures through maps."""

from glid_nb.imaging.frame import PixelFrame, TraceError
from glid_nb.imaging.holes import Hole
from glid_nb.imaging.mesh import DeformedMesh, deformed_loops, deformed_mesh, fine_mesh
from glid_nb.imaging.options import Scribbles, TraceOptions
from glid_nb.imaging.order import Order, Sheets, order_of
from glid_nb.imaging.read import ImageSource, as_rgba, as_rgba8, png, read_image
from glid_nb.imaging.trace import Tracer, Tracing, trace
