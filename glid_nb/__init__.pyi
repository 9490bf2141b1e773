# The public face, by topic. Type checkers read this file, and so does __init__.py, which loads each
# name on first use from the module that stands here.

# Shapes
from .geometry import Cage as Cage
from .geometry import Domain as Domain
from .geometry import cut as cut
from .geometry import offset_cage as offset_cage
from .geometry import triangulate as triangulate

# Pictures
from .imaging import PixelFrame as PixelFrame
from .imaging import Scribbles as Scribbles
from .imaging import TraceOptions as TraceOptions
from .imaging import Tracer as Tracer
from .imaging import Tracing as Tracing
from .imaging import read_image as read_image
from .imaging import trace as trace
from .imaging.backdrop import filled_in as filled_in
from .imaging.matte import cut_out as cut_out
from .imaging.render import render as render

# Maps, and the proof that they do not fold
from .auditing import Audit as Audit
from .auditing import audit as audit
from .certificate import Certificate as Certificate
from .certificate import certify as certify
from .certificate import certify_step as certify_step
from .certificate import global_injectivity as global_injectivity
from .certificate import safe_radius as safe_radius
from .geometry import MeshMap as MeshMap
from .harmonic import HarmonicMap as HarmonicMap
from .harmonic import DisplacementField as DisplacementField
from .harmonic import Inverse as Inverse
from .harmonic import Preimages as Preimages
from .harmonic import Transported as Transported
from .landmarks import HarmonicTransform as HarmonicTransform
from .motion import Motion as Motion

# Solving
from . import energies as energies
from . import methods as methods
from .solvers import Iteration as Iteration
from .solvers import Options as Options
from .pose import Pose as Pose
from .solvers import Progress as Progress
from .solvers import Result as Result
from .solvers import Status as Status
from .minima import differentiable as differentiable
from .minima import refine as refine
from .minima import solve as solve
from .minima import solve_batch as solve_batch
from .many import solve_many as solve_many
from .session.suggest import suggest_pose as suggest_pose
from ._runtime import enable_compilation_cache as enable_compilation_cache

# Files, figures, and results for other programs
from . import export as export
from . import figures as figures
from . import io as io

# In the notebook
from . import session as session
from . import widgets as widgets
from .widgets import Editor as Editor

# Whatever is refused
from ._errors import InputError as InputError

# Bundled pictures
from . import samples as samples

__version__: str
