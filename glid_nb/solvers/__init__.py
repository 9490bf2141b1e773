"""Minimise a deformation energy over certified harmonic maps (paper Sections 7 and 9)."""

from glid_nb.pose import DeformationMap, Pose, PoseError
from glid_nb.solvers.batch import solve_batch
from glid_nb.solvers.method import Inputs, Method, MethodError, StartError
from glid_nb.solvers.newton import Newton
from glid_nb.solvers.options import OptionError, Options
from glid_nb.solvers.result import Iteration, Progress, Result, Status
from glid_nb.solvers.solve import refine, solve
