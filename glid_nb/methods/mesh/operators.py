"""A deformation problem on a triangle mesh: operators, energies, and the base class of methods."""

import functools
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np
import scipy

from glid_nb._arrays import Array
from glid_nb._jax import jit
from glid_nb._runtime import double_precision
from glid_nb.energies import Energy
from glid_nb.geometry import MeshMap, Triangulation, as_points, place, triangulate
from glid_nb.harmonic import as_complex
from glid_nb.pose import in_both, rigid_motion
from glid_nb.solvers import Inputs, Iteration, Method, MethodError, Result
from glid_nb.solvers.loop import GeneratedDescent, Reached, Steps, follow

_AT_VERTEX = 1e-9  # of the shape's longer side


class MeshOperators:
    """The differential operators of a mesh. Images are (v,) complex.

    On a triangle ``f_z = sum_i conj(G_i) w_i / 2`` and ``f_zbar = sum_i G_i w_i / 2``. ``G_i`` is
    the complex gradient of a corner's hat function.
    """

    def __init__(self, mesh: Triangulation) -> None:
        self.mesh = mesh
        z = mesh.vertices @ np.array([1, 1j])
        corners = z[mesh.triangles]
        opposite = np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)
        e1, e2 = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        area = 0.5 * np.imag(np.conj(e1) * e2)
        self.area, self.weights = float(area.sum()), area / area.sum()  # (t,) shares of the area
        hats = 1j * opposite / (2 * area[:, None])
        shape = (len(area), len(z))
        entries = (np.repeat(np.arange(len(area)), 3), mesh.triangles.ravel())
        self.to_fz = scipy.sparse.csr_matrix((np.conj(hats).ravel() / 2, entries), shape)
        self.to_fzb = scipy.sparse.csr_matrix((hats.ravel() / 2, entries), shape)
        self._back = tuple(a.conj().T.tocsr() for a in (self.to_fz, self.to_fzb))
        self.rest = z

    def wirtinger(self, w: Array) -> tuple[Array, Array]:
        return self.to_fz @ w, self.to_fzb @ w

    def adjoint(self, a: Array, b: Array) -> Array:
        """The adjoint of :meth:`wirtinger` with the area weights, (v,) complex."""
        return self._back[0] @ (self.weights * a) + self._back[1] @ (self.weights * b)

    @functools.cached_property
    def laplacian(self) -> Any:
        """(v, v) real: Hessian of the mean of ``|f_z|^2 + |f_zbar|^2``, the cotangent Laplacian."""
        m = scipy.sparse.diags(2 * self.weights)
        product = self._back[0] @ m @ self.to_fz + self._back[1] @ m @ self.to_fzb
        return product.real.tocsc()

    @double_precision
    def energy(self, energy: Energy, fz: Array, fzb: Array) -> float:
        """The area mean of the density; infinite if a triangle is flipped, except for ARAP."""
        x, y = np.abs(fz) ** 2, np.abs(fzb) ** 2
        if not (x > y).all() and energy.name != "arap":  # ARAP is finite with a signed sigma_2
            return np.inf
        return float(self.weights @ np.asarray(_density(energy, x, y)))

    @double_precision
    def gradient(self, energy: Energy, fz: Array, fzb: Array) -> Array:
        """(v,) complex ``g`` with ``dE = Re(conj(g) . dw)`` (compare (17))."""
        alpha1, alpha2 = _alphas(energy, np.abs(fz) ** 2, np.abs(fzb) ** 2)
        return 2 * self.adjoint(np.asarray(alpha1) * fz, np.asarray(alpha2) * fzb)


class Pinned:
    """The Laplacian with some vertices held, factored once."""

    def __init__(self, operators: MeshOperators, held: Array) -> None:
        free = np.ones(len(operators.rest), dtype=bool)
        free[held] = False
        self.free, self.held = np.flatnonzero(free), held
        k = operators.laplacian
        self._coupling = k[self.free][:, held]
        self._factor = scipy.sparse.linalg.splu(
            k[self.free][:, self.free].tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )

    def solve(self, right: Array, values: Array | None = None) -> Array:
        """``w`` with ``(K w)_free = right_free`` and the held vertices at ``values``, or at 0."""
        w = np.zeros(len(right), dtype=complex)
        b = right[self.free]
        if values is not None:
            w[self.held] = values
            b = b - self._coupling @ values
        columns = self._factor.solve(np.column_stack([np.real(b), np.imag(b)]))
        w[self.free] = columns[:, 0] + 1j * columns[:, 1]
        return w


def flips(fz: Array, fzb: Array) -> int:
    return int((~(np.abs(fz) > np.abs(fzb))).sum())


_density = jit(lambda energy, x, y: energy.density(x, y))
_alphas = jit(lambda energy, x, y: energy.differentials(x, y)[:2])


@dataclass(frozen=True, eq=False)
class MeshProblem:
    inputs: Inputs
    operators: MeshOperators
    handles: Array  # (h,) vertex indices
    targets: Array  # (h,) complex
    p2p_weight: float  # lambda of (20), in the cage's own units
    start: Array  # (v,) complex images, rigidly moved to the targets with the option align

    @classmethod
    def of(cls, inputs: Inputs, n_vertices: int) -> Self:
        """The problem on the start's mesh, or on a new one of about ``n_vertices`` vertices."""
        pose, start = inputs.pose, inputs.start_map
        if isinstance(start, MeshMap):
            mesh, images = start.triangulation, as_complex(start.images)
        else:
            mesh = triangulate(inputs.domain.cage, n_vertices, points=pose.handles)
            images = as_complex(mesh.vertices if start is None else start(mesh.vertices))
        handles = _vertices_at(mesh, pose.handles, _AT_VERTEX * inputs.domain.cage.longer_side)
        operators = MeshOperators(mesh)
        targets = pose.targets @ np.array([1, 1j])
        if inputs.options.align and len(handles):
            turn, middle, aim = rigid_motion(images[handles], targets)
            images = aim + turn * (images - middle)
        weight = inputs.options.lambda_on(inputs.domain.cage)
        return cls(inputs, operators, handles, targets, weight, images)

    def at(self, w: Array, step: float | None = None) -> Callable[[], Reached]:
        def reached() -> Reached:
            fz, fzb = self.operators.wirtinger(w)
            miss = w[self.handles] - self.targets
            entry = Iteration(
                energy_distortion=self.operators.energy(self.inputs.energy, fz, fzb),
                energy_p2p=self.p2p_weight / 2 * float((np.abs(miss) ** 2).sum()),
                step=step,
                flips=flips(fz, fzb),
            )
            return Reached(entry, lambda: MeshMap(self.operators.mesh, as_points(w)))

        return reached


def _vertices_at(mesh: Triangulation, points: Array, tolerance: float) -> Array:
    gap, index = scipy.spatial.KDTree(mesh.vertices).query(points)
    missing = np.flatnonzero(gap > tolerance)
    if missing.size:
        i = int(missing[0])
        what = f"handle {i} at {place(points[i])} is not a vertex of the start's triangulation"
        raise MethodError(f"{what}; make it with triangulate(cage, points=handles), or give none")
    return index.astype(np.int32)


@dataclass(frozen=True)
class MeshMethod(Method):
    """A method on a triangle mesh of about ``n_vertices`` vertices. The handles are vertices.

    To choose the mesh, start from a map of it: ``MeshMap(triangulation, triangulation.vertices)``.
    The result has no certificate.
    """

    family = "mesh"
    needs_handles = False

    n_vertices: int = field(default=10_000, kw_only=True, metadata={"least": 3})

    def check_handles(self, inputs: Inputs) -> None:
        if self.needs_handles and not len(inputs.pose):
            needs = f"the method {self.name!r} needs at least one"
            raise MethodError(*in_both(lambda named: f"{needs} {named.word}"))

    def steps(self, problem: MeshProblem) -> Steps:
        """The method as a generator: yields the start and then each step."""
        raise NotImplementedError

    def run(self, inputs: Inputs) -> Result:
        self.check_handles(inputs)
        problem = MeshProblem.of(inputs, self.n_vertices)
        return follow(lambda: GeneratedDescent(self, inputs, self.steps(problem)))
