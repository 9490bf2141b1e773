"""Minimising a deformation energy over certified harmonic maps (paper Sections 7 and 9)."""

from glid_nb.solvers.batch import solve_batch as solve_batch
from glid_nb.solvers.method import Method as Method
from glid_nb.solvers.method import MethodError as MethodError
from glid_nb.solvers.newton import Newton as Newton
from glid_nb.solvers.options import OptionError as OptionError
from glid_nb.solvers.options import Options as Options
from glid_nb.solvers.pose import Pose as Pose
from glid_nb.solvers.pose import PoseError as PoseError
from glid_nb.solvers.refinement import refine as refine
from glid_nb.solvers.result import DeformationMap as DeformationMap
from glid_nb.solvers.result import Iteration as Iteration
from glid_nb.solvers.result import Progress as Progress
from glid_nb.solvers.result import Result as Result
from glid_nb.solvers.solve import solve as solve
from glid_nb.solvers.status import Status as Status
from glid_nb.solvers.subspace import StartError as StartError
