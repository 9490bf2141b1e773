"""Solving a pose: one descent, and other ways to a minimum where that ends high."""

from glid_nb.minima.batch import solve_batch
from glid_nb.minima.differentiable import DifferentiableSolve as DifferentiableSolve
from glid_nb.minima.differentiable import differentiable as differentiable
from glid_nb.minima.solve import refine, solve
