"""Linear baselines: one solve, no energy, and nothing that keeps them from folding."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from numpy.typing import NDArray

from glid_nb.geometry import signed_area
from glid_nb.harmonic import as_complex
from glid_nb.methods.linear import weights
from glid_nb.methods.linear.cauchy import cauchy_point_to_point
from glid_nb.methods.linear.mean_value import handle_polygon, mean_value_coordinates
from glid_nb.methods.linear.moving_least_squares import Kind, moving_least_squares
from glid_nb.methods.mesh.setup import MeshProblem
from glid_nb.methods.method import Inputs, Method, MethodError
from glid_nb.methods.recording import Ending, Run, record
from glid_nb.methods.result import MethodResult
from glid_nb.solvers import Status

Array = NDArray[Any]

_FLAT = 1e-12  # an area relative to the square of the shape's longer side: none


def _once(inputs: Inputs, images: Callable[[MeshProblem], Array]) -> MethodResult:
    problem = MeshProblem.of(inputs)

    def run() -> Run:
        yield problem.snapshot(problem.start, 0.0)
        began = time.perf_counter()
        w = images(problem)
        state = problem.snapshot(w, time.perf_counter() - began)
        yield state
        over = "no triangle is" if not state.flips else f"{state.flips} triangles are"
        return Ending(Status.CONVERGED, f"A linear method, solved at once: {over} turned over.")

    return record(inputs.method, run(), inputs.pose, inputs.max_iterations, inputs.callback)


def mls(inputs: Inputs, kind: Kind = "rigid", alpha: float = 1.0) -> MethodResult:
    if kind not in ("rigid", "similarity"):
        raise MethodError(f"kind must be rigid or similarity, got {kind!r}")

    def images(problem: MeshProblem) -> Array:
        rest = problem.operators.rest
        return moving_least_squares(rest, rest[problem.handles], problem.targets, kind, alpha)

    return _once(inputs, images)


def mean_value(inputs: Inputs) -> MethodResult:
    if len(inputs.pose) < 3:
        raise MethodError(
            f"mean value coordinates take the handles as their cage and need at least 3 of them; "
            f"there are {len(inputs.pose)}"
        )
    points = inputs.pose.handles
    order = handle_polygon(as_complex(points))
    if abs(signed_area(points[order])) <= _FLAT * inputs.domain.cage.longer_side**2:
        raise MethodError(
            "mean value coordinates take the handles as their cage, and these lie on one line; "
            "add a handle beside it"
        )

    def images(problem: MeshProblem) -> Array:
        rest = problem.operators.rest
        handles = rest[problem.handles]
        return mean_value_coordinates(rest, handles[order]) @ problem.targets[order]

    return _once(inputs, images)


def cauchy(inputs: Inputs) -> MethodResult:
    def images(problem: MeshProblem) -> Array:
        map_ = cauchy_point_to_point(inputs.domain, inputs.pose, inputs.p2p_weight)
        return as_complex(map_(problem.operators.mesh.vertices))

    return _once(inputs, images)


def _blended(problem: MeshProblem, w: Array) -> Array:
    """Linear blend skinning by translations."""
    rest = problem.operators.rest
    return rest + w @ (problem.targets - rest[problem.handles])


def bbw(inputs: Inputs, iterations: int = 20) -> MethodResult:
    inputs.need_handles()

    def images(problem: MeshProblem) -> Array:
        mesh, handles = problem.operators.mesh, problem.handles
        return _blended(problem, weights.bounded_biharmonic_weights(mesh, handles, iterations))

    return _once(inputs, images)


def harmonic(inputs: Inputs, power: int = 2) -> MethodResult:
    inputs.need_handles()
    if power not in (1, 2, 3):
        raise MethodError(f"power must be 1, 2 or 3, got {power!r}")

    def images(problem: MeshProblem) -> Array:
        mesh, handles = problem.operators.mesh, problem.handles
        return _blended(problem, weights.harmonic_weights(mesh, handles, power))

    return _once(inputs, images)


METHODS = (
    Method(
        "mls",
        "Moving least squares",
        "linear",
        "At each point the rigid motion that fits the handles best; it may fold.",
        mls,
        weighted=False,
    ),
    Method(
        "bbw",
        "Bounded biharmonic weights",
        "linear",
        "Translations blended by bounded biharmonic weights; it may fold (libigl).",
        bbw,
        weighted=False,
        package="igl",
    ),
    Method(
        "harmonic-weights",
        "Harmonic weights",
        "linear",
        "Translations blended by weights of which a power of the Laplacian vanishes: 1 harmonic, 2 "
        "(default) biharmonic, 3 triharmonic; it may fold (libigl).",
        harmonic,
        weighted=False,
        package="igl",
    ),
    Method(
        "mean-value",
        "Mean value coordinates",
        "linear",
        "Mean value coordinates with the handles as cage; it may fold.",
        mean_value,
        weighted=False,
    ),
    Method(
        "cauchy",
        "Cauchy coordinates",
        "linear",
        "The smoothest conformal map through the handles; it may fold.",
        cauchy,
    ),
)
