"""Other methods on the same problems: each takes the same inputs and returns the same result."""

from glid_nb.methods.choice import OURS, MethodChoice
from glid_nb.methods.mesh.map import MeshMap
from glid_nb.methods.method import Method, MethodError
from glid_nb.methods.registry import methods, run_method
from glid_nb.methods.result import DeformationMap, MethodProgress, MethodResult, Step

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
