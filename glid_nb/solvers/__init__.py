"""Minimise a deformation energy from one certified map (paper Sections 7 and 9)."""

from glid_nb.pose import DeformationMap, Pose, PoseError
from glid_nb.solvers.method import Inputs, Method, MethodError, StartError
from glid_nb.solvers.newton import Newton
from glid_nb.solvers.options import OptionError, Options
from glid_nb.solvers.result import Iteration, Progress, Result, Status
from glid_nb.solvers.sensitivity import Sensitivity as Sensitivity
from glid_nb.solvers.sensitivity import SensitivityError as SensitivityError
