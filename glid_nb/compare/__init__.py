"""Other methods on the same problems: each takes the same inputs and returns the same result."""

from glid_nb.compare.choice import OURS, MethodChoice
from glid_nb.compare.mesh.map import MeshMap
from glid_nb.compare.method import Method, MethodError
from glid_nb.compare.registry import methods, run_method
from glid_nb.compare.result import DeformationMap, MethodProgress, MethodResult, Step

__all__ = [
    "OURS",
    "DeformationMap",
    "MeshMap",
    "Method",
    "MethodChoice",
    "MethodError",
    "MethodProgress",
    "MethodResult",
    "Step",
    "methods",
    "run_method",
]
