"""Pictures to cages, maps to pictures."""

from glid_nb.imaging.errors import RenderError as RenderError
from glid_nb.imaging.errors import TraceError as TraceError
from glid_nb.imaging.frame import PixelFrame as PixelFrame
from glid_nb.imaging.holes import Hole as Hole
from glid_nb.imaging.options import Scribbles as Scribbles
from glid_nb.imaging.options import TraceOptions as TraceOptions
from glid_nb.imaging.outline import Component as Component
from glid_nb.imaging.read import as_rgba as as_rgba
from glid_nb.imaging.read import as_rgba8 as as_rgba8
from glid_nb.imaging.read import read_image as read_image
from glid_nb.imaging.trace import Tracer as Tracer
from glid_nb.imaging.trace import Tracing as Tracing
from glid_nb.imaging.trace import trace as trace
