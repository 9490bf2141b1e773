"""The minimum to which a method on a mesh descends, found by Newton's method on that mesh.

First-order methods approach it so slowly that their last map does not show where they go. Newton's
method, started from one of their maps, arrives after some tens of iterations. As in the harmonic
subspace, it uses the exact Hessian where that is positive definite, and elsewhere the Hessian
projected triangle by triangle (paper Section 7): the entries of ``K`` are the same.
"""

from typing import Any, Literal, NamedTuple

import jax
import numpy as np
import scipy.sparse
import scipy.sparse.linalg
from numpy.typing import NDArray
from scipy.spatial import KDTree

from glid_nb._runtime import double_precision
from glid_nb.energies import Energy
from glid_nb.geometry import MeshMap
from glid_nb.methods.mesh.aqp import largest_step
from glid_nb.methods.mesh.operators import MeshOperators
from glid_nb.pose import Pose
from glid_nb.solvers.hessian import LocalHessian, local_hessian, positive_part

Array = NDArray[Any]
Constraints = Literal["soft", "hard"]

_TOLERANCE = 1e-10
ITERATIONS = 150
_ARMIJO, _SAFETY, _LEAST_STEP = 1e-4, 0.9, 1e-12


class NoMinimumError(RuntimeError):
    """Newton's method on a mesh did not converge."""


class Minimum(NamedTuple):
    """A local minimum on a mesh: (v, 2) images of the vertices, and the total energy."""

    images: Array
    energy: float


@double_precision
def mesh_minimum(
    start: MeshMap, pose: Pose, energy: Energy, constraints: Constraints, p2p_weight: float = 1e5
) -> Minimum:
    """The minimum of a mesh method's own energy below one of its maps.

    Minimises ``E_iso + lambda / 2 sum |f(p_i) - q_i|^2`` with soft constraints, and ``E_iso`` with
    the handles at their targets with hard ones; ``E_iso`` is the mean over the mesh's area. The
    handles are vertices of the start; with hard constraints they are at their targets. Raises a
    NoMinimumError if the start has inverted triangles, or if the decrement stays above 1e-10.
    """
    problem = _Problem(start, pose, energy, constraints, p2p_weight)
    operators = problem.operators
    w = start.images @ np.array([1, 1j])
    fz, fzb = operators.wirtinger(w)
    total = problem.total(w, fz, fzb)
    if not np.isfinite(total):
        raise NoMinimumError("the start has inverted triangles")
    t, descent = 0.0, np.inf
    for _ in range(ITERATIONS):
        # Far from the minimum the exact Hessian is rarely definite, and t is below 1.
        direction, descent = problem.newton_step(w, fz, fzb, try_exact=t == 1)
        if descent / 2 <= _TOLERANCE * abs(total):
            return Minimum(np.stack([np.real(w), np.imag(w)], axis=-1), total)
        # Halve the step until it lowers the energy enough; no step inverts a triangle.
        dfz, dfzb = operators.wirtinger(direction)
        t = min(1.0, _SAFETY * largest_step(fz, fzb, dfz, dfzb))
        before = total
        while True:
            moved = w + t * direction, fz + t * dfz, fzb + t * dfzb
            total = problem.total(*moved)
            if total <= before - _ARMIJO * t * descent:
                break
            t /= 2
            if t <= _LEAST_STEP:
                raise NoMinimumError(
                    f"no step of Newton's method on the mesh lowers the energy {before:.6g}, "
                    f"whose decrement is {descent / 2:.2g}"
                )
        w, fz, fzb = moved
    raise NoMinimumError(
        f"Newton's method on the mesh has a decrement of {descent / 2:.2g} after {ITERATIONS} "
        "iterations"
    )


class _Problem:
    """The energy and its derivatives; images are complex numbers."""

    def __init__(
        self,
        start: MeshMap,
        pose: Pose,
        energy: Energy,
        constraints: Constraints,
        p2p_weight: float,
    ) -> None:
        self.operators, self.energy = MeshOperators(start.triangulation), energy
        count = len(start.images)
        handles = KDTree(start.triangulation.vertices).query(pose.handles)[1]
        self.goal = np.zeros(count, dtype=complex)
        self.goal[handles] = pose.targets @ np.array([1, 1j])
        free = np.ones(count, dtype=bool)
        self.weights = np.zeros(count)
        if constraints == "hard":
            free[handles] = False
        else:
            self.weights[handles] = p2p_weight
        self.unknowns = np.flatnonzero(np.concatenate([free, free]))

    def total(self, w: Array, fz: Array, fzb: Array) -> float:
        """The energy of a map."""
        p2p = float(self.weights @ np.abs(w - self.goal) ** 2) / 2
        return self.operators.energy(self.energy, fz, fzb) + p2p

    def newton_step(self, w: Array, fz: Array, fzb: Array, try_exact: bool) -> tuple[Array, float]:
        """The direction, and the energy's rate of decrease along it, twice the decrement."""
        count = len(w)
        gradient = self.operators.gradient(self.energy, fz, fzb)
        gradient = gradient + self.weights * (w - self.goal)
        slope = np.concatenate([gradient.real, gradient.imag])[self.unknowns]
        p2p = scipy.sparse.diags(np.concatenate([self.weights, self.weights]))
        for exact in (True, False) if try_exact else (False,):
            hessian = _hessian(self.operators, self.energy, fz, fzb, exact) + p2p
            factor = _definite_factor(hessian.tocsr()[self.unknowns][:, self.unknowns])
            if factor is not None:
                step = np.zeros(2 * count)
                step[self.unknowns] = -factor.solve(slope)
                return step[:count] + 1j * step[count:], -float(slope @ step[self.unknowns])
        raise NoMinimumError("the projected Hessian on the mesh is singular")


def _hessian(operators: MeshOperators, energy: Energy, fz: Array, fzb: Array, exact: bool) -> Any:
    """(2v, 2v) ``sum_t B_t^T K_t B_t``, or with K+; real parts first, then imaginary parts."""
    k = _local(energy, fz, fzb)
    k = k if exact else positive_part(k)
    along_f, across_f = _components(operators.to_fz, fz)
    along_g, across_g = _components(operators.to_fzb, fzb)

    def product(left: Any, entries: Any, right: Any) -> Any:
        return left.T @ scipy.sparse.diags(operators.weights * np.asarray(entries)) @ right

    mixed = product(along_f, k.along_fg, along_g)
    return (
        product(along_f, k.along_ff, along_f)
        + product(across_f, k.across_f, across_f)
        + product(along_g, k.along_gg, along_g)
        + product(across_g, k.across_g, across_g)
        + mixed
        + mixed.T
    )


def _components(rows: Any, values: Array) -> tuple[Any, Any]:
    """The components along and across ``values`` of the derivatives, as real rows."""
    size = np.abs(values)
    frame = np.where(size > 0, values / np.where(size > 0, size, 1), 1)
    turned = scipy.sparse.diags(frame.conj()) @ rows
    along = scipy.sparse.hstack([turned.real, -turned.imag], format="csr")
    across = scipy.sparse.hstack([turned.imag, turned.real], format="csr")
    return along, across


@jax.jit
def _local(energy: Energy, fz: Any, fzb: Any) -> LocalHessian:
    x, y = abs(fz) ** 2, abs(fzb) ** 2
    return local_hessian(energy.differentials(x, y), x, y)


def _definite_factor(matrix: Any) -> Any | None:
    """The factorisation of a symmetric matrix; ``None`` if it is not positive definite.

    With all pivots on the diagonal it is ``L D L^T``, and ``D`` has the signs of the matrix.
    """
    options = {"SymmetricMode": True}
    try:
        factor = scipy.sparse.linalg.splu(
            matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options
        )
    except RuntimeError:  # exactly singular
        return None
    on_diagonal = (factor.perm_r == factor.perm_c).all()
    return factor if on_diagonal and (factor.U.diagonal() > 0).all() else None
