"""Methods in the harmonic subspace, with Newton's own line search and certificate."""

from glid_nb.methods.subspace.methods import METHODS
from glid_nb.methods.subspace.problem import SubspaceProblem

__all__ = ["METHODS", "SubspaceProblem"]
