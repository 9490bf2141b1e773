"""The wanted deformation (handles, targets, stiff areas) and the type of the resulting map."""

from glid_nb.geometry import MeshMap
from glid_nb.harmonic import HarmonicMap
from glid_nb.pose.naming import HANDLES, PINS, Naming, in_both
from glid_nb.pose.placement import misplaced
from glid_nb.pose.pose import DEEPEST, PER_HANDLE, SCALES, Pose, PoseError
from glid_nb.pose.rigid import rigid_motion
from glid_nb.pose.stiffness import FARTHEST, FULL_WEIGHT, Stiffness, StiffnessError

DeformationMap = HarmonicMap | MeshMap
"""A map in the harmonic subspace, or a piecewise linear one of a mesh."""
