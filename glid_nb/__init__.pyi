# The public face, by topic. Type checkers read this file, and so does __init__.py, which loads each
# name on first use from the module that stands here.

# Shapes
from .geometry import Cage as Cage
from .geometry import Domain as Domain
from .geometry import Triangulation as Triangulation
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
from .imaging.render import render as render

# Energies
from .energies import AMIPS as AMIPS
from .energies import ARAP as ARAP
from .energies import CustomEnergy as CustomEnergy
from .energies import MIPS as MIPS
from .energies import Energy as Energy
from .energies import ExponentialSymmetricDirichlet as ExponentialSymmetricDirichlet
from .energies import SymmetricDirichlet as SymmetricDirichlet
from .energies import energy_by_name as energy_by_name

# Maps, and the proof that they do not fold
from .certificate import Certificate as Certificate
from .certificate import GlobalInjectivity as GlobalInjectivity
from .certificate import PieceCertificate as PieceCertificate
from .certificate import certify as certify
from .certificate import certify_step as certify_step
from .certificate import global_injectivity as global_injectivity
from .harmonic import HarmonicMap as HarmonicMap

# Solving
from .solvers import Iteration as Iteration
from .solvers import Options as Options
from .pose import Pose as Pose
from .solvers import Progress as Progress
from .solvers import Result as Result
from .solvers import Status as Status
from .minima import refine as refine
from .minima import solve as solve
from .minima import solve_batch as solve_batch
from ._runtime import enable_compilation_cache as enable_compilation_cache

# Other methods on the same problems
from .geometry import MeshMap as MeshMap
from . import methods as methods

# What lies between maps
from .motion import Motion as Motion

# Files and reports
from .session.document import Document as Document
from .session.document import NamedPose as NamedPose
from .session.problem import Problem as Problem
from .session.report import build_report as build_report
from .session.document_file import load_document as load_document
from .session.problem import load_pose as load_pose
from .session.script import python_code as python_code
from .session.document_file import save_document as save_document
from .session.suggest import suggest_pose as suggest_pose

# Figures, and results for other programs
from . import export as export
from . import figures as figures

# In the notebook
from .session.tracing import TracingModel as TracingModel
from .session.deformation import Deformation as Deformation
from .widgets import CageTracer as CageTracer
from .widgets import DeformCanvas as DeformCanvas
from .widgets import Editor as Editor
from .widgets import SolverMonitor as SolverMonitor
from .widgets import SolverPanel as SolverPanel

# Whatever is refused
from ._errors import InputError as InputError

# Bundled pictures
from . import samples as samples

__version__: str
