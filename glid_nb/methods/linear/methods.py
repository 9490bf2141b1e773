"""Linear baselines: one solve, no energy, and nothing that keeps them from folding."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from glid_nb._arrays import Array
from glid_nb.geometry import signed_area
from glid_nb.harmonic import as_complex
from glid_nb.methods.linear import coordinates
from glid_nb.methods.mesh.operators import flips
from glid_nb.methods.mesh.setup import MeshMethod, MeshProblem
from glid_nb.solvers import MethodError, Status
from glid_nb.solvers.loop import Ending, Steps
from glid_nb.solvers.method import Inputs

_FLAT = 1e-12  # an area relative to the square of the shape's longer side: none


@dataclass(frozen=True)
class LinearMethod(MeshMethod):
    """A method that solves once; its images are shown on a mesh."""

    family = "linear"
    options = ("align", "max_iterations")

    def images(self, problem: MeshProblem) -> Array:
        """(v,) complex images of the mesh's vertices."""
        raise NotImplementedError

    def steps(self, problem: MeshProblem) -> Steps:
        """The one solve."""
        yield problem.at(problem.start)
        w = self.images(problem)
        yield problem.at(w)
        count = flips(*problem.operators.wirtinger(w))
        over = f"{count} triangles are" if count else "no triangle is"
        return Ending(Status.CONVERGED, f"A linear method, solved at once: {over} turned over.")


@dataclass(frozen=True)
class MovingLeastSquares(LinearMethod):
    """At each point the rigid motion that fits the handles best; it may fold.

    Schaefer, McPhail & Warren 2006.
    """

    name = "mls"
    label = "Moving least squares"

    kind: coordinates.Kind = "rigid"
    alpha: float = 1.0

    def images(self, problem: MeshProblem) -> Array:
        z, targets = problem.operators.rest, problem.targets
        handles = z[problem.handles]
        return coordinates.moving_least_squares(z, handles, targets, self.kind, self.alpha)


@dataclass(frozen=True)
class BoundedBiharmonicWeights(LinearMethod):
    """Translations blended by bounded biharmonic weights; it may fold (libigl).

    Jacobson et al. 2011.
    """

    name = "bbw"
    label = "Bounded biharmonic weights"
    package = "igl"
    needs_handles = True

    iterations: int = 20

    def images(self, problem: MeshProblem) -> Array:
        return _blended(problem, coordinates.bounded_biharmonic_weights, self.iterations)


@dataclass(frozen=True)
class HarmonicWeights(LinearMethod):
    """Translations blended by weights of which a power of the Laplacian vanishes: 1 harmonic, 2
    (default) biharmonic, 3 triharmonic; it may fold (libigl)."""

    name = "harmonic-weights"
    label = "Harmonic weights"
    package = "igl"
    needs_handles = True

    power: Literal[1, 2, 3] = 2

    def images(self, problem: MeshProblem) -> Array:
        return _blended(problem, coordinates.harmonic_weights, self.power)


@dataclass(frozen=True)
class MeanValueCoordinates(LinearMethod):
    """Mean value coordinates with the handles as cage; it may fold.

    Floater 2003.
    """

    name = "mean-value"
    label = "Mean value coordinates"

    def check_handles(self, inputs: Inputs) -> None:
        """They must make a polygon."""
        points = inputs.pose.handles
        if len(points) < 3:
            raise MethodError(
                f"mean value coordinates take the handles as their cage and need at least 3 of "
                f"them; there are {len(points)}"
            )
        polygon = points[_around(as_complex(points))]
        if abs(signed_area(polygon)) <= _FLAT * inputs.domain.cage.longer_side**2:
            raise MethodError(
                "mean value coordinates take the handles as their cage, and these lie on one line; "
                "add a handle beside it"
            )

    def images(self, problem: MeshProblem) -> Array:
        rest = problem.operators.rest
        order = _around(as_complex(problem.inputs.pose.handles))
        polygon = rest[problem.handles][order]
        return coordinates.mean_value_coordinates(rest, polygon) @ problem.targets[order]


@dataclass(frozen=True)
class CauchyCoordinates(LinearMethod):
    """The smoothest conformal map through the handles; it may fold.

    Point to point by Cauchy coordinates (Weber, Ben-Chen & Gotsman 2009).
    """

    name = "cauchy"
    label = "Cauchy coordinates"
    options = ("p2p_weight", "align", "max_iterations")

    def images(self, problem: MeshProblem) -> Array:
        domain, pose = problem.inputs.domain, problem.inputs.pose
        map_ = coordinates.cauchy_point_to_point(domain, pose, problem.p2p_weight)
        return as_complex(map_(problem.operators.mesh.vertices))


def _blended(problem: MeshProblem, weights: Callable[..., Array], *settings: int) -> Array:
    """Linear blend skinning by translations."""
    rest, handles = problem.operators.rest, problem.handles.astype(np.int64)
    w = weights(problem.operators.mesh, handles.tobytes(), *settings)
    return rest + w @ (problem.targets - rest[handles])


def _around(handles: Array) -> Array:
    """(h,) indices that order the handles by their angle about their mean: a simple polygon."""
    return np.argsort(np.angle(handles - handles.mean()), kind="stable")
