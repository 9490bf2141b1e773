"""Pictures to cages, maps to pictures."""

from glid_nb.imaging.frame import PixelFrame, TraceError
from glid_nb.imaging.holes import Hole
from glid_nb.imaging.options import Scribbles, TraceOptions
from glid_nb.imaging.outline import Component
from glid_nb.imaging.read import as_rgba, as_rgba8, read_image
from glid_nb.imaging.trace import Tracer, Tracing, trace
