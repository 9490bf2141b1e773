"""Linear baselines: one solve, no energy, no protection against folds."""

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from glid_nb._arrays import Array
from glid_nb._runtime import double_precision
from glid_nb.geometry import Domain, Triangulation, graded_panels, signed_area
from glid_nb.harmonic import HarmonicMap, as_complex, basis_of, cauchy
from glid_nb.methods.mesh.operators import MeshMethod, MeshProblem, flips
from glid_nb.pose import Pose, in_both
from glid_nb.solvers import Inputs, MethodError, Status
from glid_nb.solvers.discretisation import complex_basis
from glid_nb.solvers.loop import Ending, Steps

Kind = Literal["rigid", "similarity"]

# A point counts as on an edge if it is this close, relative to its distances from the edge's ends.
_ON_EDGE = 1e-12
_TAKEN = "mean value coordinates use the {}s as their cage"
_FLAT = 1e-12  # smaller areas, relative to the square of the shape's longer side, count as 0


@dataclass(frozen=True)
class LinearMethod(MeshMethod):
    """A method that solves once. A mesh shows its images."""

    family = "linear"
    options = ("align", "max_iterations")

    def images(self, problem: MeshProblem) -> Array:
        """(v,) complex images of the mesh's vertices."""
        raise NotImplementedError

    def steps(self, problem: MeshProblem) -> Steps:
        yield problem.at(problem.start)
        w = self.images(problem)
        yield problem.at(w)
        count = flips(*problem.operators.wirtinger(w))
        over = f"{count} triangles are" if count else "no triangle is"
        return Ending(Status.CONVERGED, f"A linear method, solved in one step: {over} turned over.")


@dataclass(frozen=True)
class MovingLeastSquares(LinearMethod):
    """The rigid motion that fits the targets best; it may fold (Schaefer et al. 2006)."""

    name = "mls"
    label = "Moving least squares"

    kind: Kind = "rigid"
    alpha: float = 1.0

    def images(self, problem: MeshProblem) -> Array:
        z, targets = problem.operators.rest, problem.targets
        handles = z[problem.handles]
        return moving_least_squares(z, handles, targets, self.kind, self.alpha)


@dataclass(frozen=True)
class BoundedBiharmonicWeights(LinearMethod):
    """Translations blended by bounded biharmonic weights (Jacobson 2011); it may fold (libigl)."""

    name = "bbw"
    label = "Bounded biharmonic weights"
    package = "igl"
    needs_handles = True

    iterations: int = 20

    def images(self, problem: MeshProblem) -> Array:
        return _blended(problem, bounded_biharmonic_weights, self.iterations)


@dataclass(frozen=True)
class HarmonicWeights(LinearMethod):
    """Translations blended by harmonic (power 1), biharmonic (2, the default) or triharmonic (3)
    weights; it may fold (libigl)."""

    name = "harmonic-weights"
    label = "Harmonic weights"
    package = "igl"
    needs_handles = True

    power: Literal[1, 2, 3] = 2

    def images(self, problem: MeshProblem) -> Array:
        return _blended(problem, harmonic_weights, self.power)


@dataclass(frozen=True)
class MeanValueCoordinates(LinearMethod):
    """Mean value coordinates with the pinned points as cage; it may fold (Floater 2003)."""

    name = "mean-value"
    label = "Mean value coordinates"

    def check_handles(self, inputs: Inputs) -> None:
        points = inputs.pose.handles
        taken = in_both(lambda named: _TAKEN.format(named.word))
        if len(points) < 3:
            few = f"and need at least 3 of them; there are {len(points)}"
            raise MethodError(*(f"{text} {few}" for text in taken))
        polygon = points[_around(as_complex(points))]
        if abs(signed_area(polygon)) <= _FLAT * inputs.domain.cage.longer_side**2:
            line = ", and these lie on one line; add another beside it"
            raise MethodError(*(text + line for text in taken))

    def images(self, problem: MeshProblem) -> Array:
        rest, order = problem.operators.rest, _around(as_complex(problem.inputs.pose.handles))
        polygon = rest[problem.handles][order]
        return mean_value_coordinates(rest, polygon) @ problem.targets[order]


@dataclass(frozen=True)
class CauchyCoordinates(LinearMethod):
    """The smoothest conformal map through the targets; it may fold (Weber et al. 2009)."""

    name = "cauchy"
    label = "Cauchy coordinates"
    options = ("p2p_weight", "align", "max_iterations")

    def images(self, problem: MeshProblem) -> Array:
        domain, pose = problem.inputs.domain, problem.inputs.pose
        map_ = cauchy_point_to_point(domain, pose, problem.p2p_weight)
        return as_complex(map_(problem.operators.mesh.vertices))


def _blended(problem: MeshProblem, weights: Callable[..., Array], *settings: int) -> Array:
    rest, handles = problem.operators.rest, problem.handles.astype(np.int64)
    w = weights(problem.operators.mesh, handles.tobytes(), *settings)
    return rest + w @ (problem.targets - rest[handles])


def _around(handles: Array) -> Array:
    """(h,) indices that sort the handles by their angle about their mean, to a simple polygon."""
    return np.argsort(np.angle(handles - handles.mean()), kind="stable")


def moving_least_squares(
    z: Array, handles: Array, targets: Array, kind: Kind = "rigid", alpha: float = 1.0
) -> Array:
    """(k,) images by motions that fit the handles with the weights ``|p_i - z|^(-2 alpha)``.

    Handles map exactly to their targets.
    """
    if not len(handles):
        return z.copy()
    distance = np.abs(z[:, None] - handles)
    at = distance.argmin(axis=1)
    exact = distance[np.arange(len(z)), at] == 0
    w = np.where(distance > 0, distance, 1.0) ** (-2 * alpha)
    w /= w.sum(axis=1, keepdims=True)
    middle, aim = w @ handles, w @ targets
    p, q = handles - middle[:, None], targets - aim[:, None]
    turn = (w * p.conj() * q).sum(axis=1)
    size = np.abs(turn) if kind == "rigid" else (w * np.abs(p) ** 2).sum(axis=1)
    turn = np.where(size > 0, turn / np.where(size > 0, size, 1), 1)
    return np.where(exact, targets[at], aim + turn * (z - middle))


def mean_value_coordinates(z: Array, polygon: Array) -> Array:
    """(k, n) coordinates with respect to a simple polygon (Hormann & Floater 2006)."""
    s = polygon - z[:, None]
    after = np.roll(s, -1, axis=1)
    r, r_after = np.abs(s), np.abs(after)
    cross, dot = np.imag(s.conj() * after), np.real(s.conj() * after)
    scale = r * r_after
    flat = np.abs(cross) <= _ON_EDGE * scale
    tangent = np.where(flat, 0, (scale - dot) / np.where(flat, 1, cross))
    total = tangent + np.roll(tangent, 1, axis=1)
    w = total / np.where(r > 0, r, 1)
    w = w / w.sum(axis=1, keepdims=True)
    # On an edge the coordinates are linear. At a vertex its two edges give the same values.
    rows, edges = np.nonzero(flat & (dot <= 0))
    span = r[rows, edges] + r_after[rows, edges]
    w[rows] = 0
    w[rows, edges] = r_after[rows, edges] / span
    w[rows, (edges + 1) % len(polygon)] = r[rows, edges] / span
    return w


@double_precision
def cauchy_point_to_point(domain: Domain, pose: Pose, p2p_weight: float) -> HarmonicMap:
    """The map with ``psi = 0`` and no logarithms that has the least ``|f''|^2`` along the boundary.

    Lengths are in the cage's ``unit``; ``p2p_weight`` is ``lambda`` in the cage's own units.
    """
    basis = basis_of(domain)
    panels = graded_panels(domain)
    columns = np.flatnonzero(basis.phi_free)[: int(basis.phi_free.sum()) - domain.n_holes]
    slopes = complex_basis(cauchy.second_derivatives, panels.middle, basis)[:, columns]
    share = panels.length / panels.length.sum()
    normal = domain.cage.unit**2 * slopes.conj().T @ (share[:, None] * slopes)
    right = np.zeros(len(columns), dtype=complex)
    if len(pose):
        handles, targets = as_complex(pose.handles), as_complex(pose.targets)
        rows = complex_basis(cauchy.cauchy_coordinates, handles, basis)[:, columns]
        normal = normal + p2p_weight / 2 * rows.conj().T @ rows
        right = p2p_weight / 2 * rows.conj().T @ targets
    padded = basis.pad(HarmonicMap.identity(domain).phi)
    base = padded[columns]
    # Solve for the change from the identity, so that degrees of freedom without data do not change.
    padded[columns] = base + np.linalg.lstsq(normal, right - normal @ base, rcond=1e-14)[0]
    return HarmonicMap(domain, padded[basis.columns], np.zeros(domain.n_coefficients))


@functools.lru_cache(maxsize=2)
def bounded_biharmonic_weights(mesh: Triangulation, handles: bytes, iterations: int = 20) -> Array:
    """(v, h) weights in [0, 1] that add up to 1 (Jacobson et al. 2011). They are cached.

    Each column minimises ``w K M^-1 K w`` within its bounds, where ``K`` is the cotangent Laplacian
    and ``M`` the Voronoi areas. Then rows are divided by their sums. If ``iterations`` ends
    libigl's active-set method early, the bounds hold up to about 1e-4. ``handles`` are the bytes of
    an (h,) int64 array.
    """
    import igl  # noqa: PLC0415

    index = np.frombuffer(handles, np.int64)
    w = np.asarray(igl.bbw(*_flat(mesh), index, np.eye(len(index)), max_iter=iterations))
    return w / w.sum(axis=1, keepdims=True)


@functools.lru_cache(maxsize=2)
def harmonic_weights(mesh: Triangulation, handles: bytes, power: int = 2) -> Array:
    """(v, h) weights whose Laplacian (``power = 1``) or bi-Laplacian (2) is 0. They are cached.

    ``handles`` are the bytes of an (h,) int64 array.
    """
    import igl  # noqa: PLC0415

    index = np.frombuffer(handles, np.int64)
    return np.asarray(igl.harmonic(*_flat(mesh), index, np.eye(len(index)), power))


def _flat(mesh: Triangulation) -> tuple[Array, Array]:
    """Vertices and triangles for libigl, scaled to a longer side of 20 units, because libigl's
    tolerances are absolute."""
    scaled = mesh.vertices / (np.ptp(mesh.vertices, axis=0).max() / 20)
    vertices = np.column_stack([scaled, np.zeros(len(scaled))])
    return np.ascontiguousarray(vertices), np.ascontiguousarray(mesh.triangles, dtype=np.int64)
