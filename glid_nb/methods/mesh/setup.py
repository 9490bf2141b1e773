"""A deformation problem on a mesh, and the methods that solve it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from glid_nb._arrays import Array
from glid_nb.geometry import MeshMap, Triangulation, as_points, place, triangulate
from glid_nb.harmonic import as_complex
from glid_nb.methods.mesh.operators import MeshOperators, flips
from glid_nb.solvers import Iteration, Method, MethodError, Result
from glid_nb.solvers.loop import GeneratedDescent, Reached, Steps, follow
from glid_nb.solvers.method import Inputs
from glid_nb.solvers.pose import rigid_motion

_AT_VERTEX = 1e-9  # of the shape's longer side


@dataclass(frozen=True, eq=False)
class MeshProblem:
    """The mesh, its handles and targets, the energy."""

    inputs: Inputs
    operators: MeshOperators
    handles: Array
    """(h,) vertex indices."""
    targets: Array
    """(h,) complex."""
    p2p_weight: float
    start: Array
    """(v,) complex: the images to start from, rigidly moved if that was asked for."""

    @classmethod
    def of(cls, inputs: Inputs, n_vertices: int) -> MeshProblem:
        """The problem on the start's mesh, or on a new one of about ``n_vertices`` vertices.

        Raises
        ------
        MethodError
            When a handle is no vertex of the start's mesh.
        """
        pose, start = inputs.pose, inputs.start_map
        if isinstance(start, MeshMap):
            mesh = start.triangulation
        else:
            mesh = triangulate(inputs.domain.cage, n_vertices, points=pose.handles)
        handles = _vertices_at(mesh, pose.handles, _AT_VERTEX * inputs.domain.cage.longer_side)
        operators = MeshOperators(mesh)
        targets = pose.targets @ np.array([1, 1j])
        if isinstance(start, MeshMap):
            images = as_complex(start.images)
        else:
            images = operators.rest if start is None else as_complex(start(mesh.vertices))
        if inputs.options.align and len(handles):
            turn, middle, aim = rigid_motion(images[handles], targets)
            images = aim + turn * (images - middle)
        weight = inputs.options.p2p_weight
        return cls(inputs, operators, handles, targets, weight, images)

    def at(self, w: Array, step: float | None = None) -> Callable[[], Reached]:
        """What tells where a method is that has come to the images ``w``."""

        def reached() -> Reached:
            fz, fzb = self.operators.wirtinger(w)
            miss = w[self.handles] - self.targets
            entry = Iteration(
                iteration=0,
                energy_iso=self.operators.energy(self.inputs.energy, fz, fzb),
                energy_p2p=self.p2p_weight / 2 * float((np.abs(miss) ** 2).sum()),
                time=0.0,
                step=step,
                flips=flips(fz, fzb),
            )
            return Reached(entry, lambda: MeshMap(self.operators.mesh, as_points(w)))

        return reached


def _vertices_at(mesh: Triangulation, points: Array, tolerance: float) -> Array:
    """(h,) indices of the vertices at points."""
    if not len(points):
        return np.empty(0, dtype=np.int32)
    gap = np.linalg.norm(mesh.vertices[:, None] - points, axis=2)
    index = gap.argmin(axis=0)
    missing = np.flatnonzero(gap.min(axis=0) > tolerance)
    if missing.size:
        i = int(missing[0])
        raise MethodError(
            f"handle {i} at {place(points[i])} is no vertex of the triangulation of the map to "
            "start from; make it with triangulate(cage, points=handles), or give no start"
        )
    return index.astype(np.int32)


@dataclass(frozen=True)
class MeshMethod(Method):
    """A method on a triangle mesh of about ``n_vertices`` vertices, handles among them.

    To choose the mesh, start from a map of it: ``MeshMap(triangulation, triangulation.vertices)``.
    What it returns has no certificate.
    """

    family = "mesh"
    needs_handles = False

    n_vertices: int = field(default=10_000, kw_only=True, metadata={"least": 3})

    def check_handles(self, inputs: Inputs) -> None:
        """Raise :class:`MethodError` where these handles do not do."""
        if self.needs_handles and not len(inputs.pose):
            raise MethodError(f"the method {self.name!r} needs at least one handle")

    def steps(self, problem: MeshProblem) -> Steps:
        """The method itself, as the start and each step."""
        raise NotImplementedError

    def run(self, inputs: Inputs) -> Result:
        self.check_handles(inputs)
        problem = MeshProblem.of(inputs, self.n_vertices)
        return follow(lambda: GeneratedDescent(self, inputs, self.steps(problem)))
