"""One step of BDHM: a convex program with the frames ``f_z / |f_z|`` held fixed."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse
from numpy.typing import NDArray

from glid_nb.compare.bdhm.bounds import DistortionBounds

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Quadratic:
    """ARAP with fixed rotations plus the soft targets: ``u^T P u / 2 + q^T u`` over unknowns."""

    P: Array
    q: Array


@dataclass(frozen=True, eq=False)
class ActiveSet:
    """Samples at which each bound is imposed, as indices into the pool."""

    k: Array
    sigma1: Array
    sigma2: Array

    def __len__(self) -> int:
        return len(self.k) + len(self.sigma1) + len(self.sigma2)


@dataclass(frozen=True, eq=False)
class Rows:
    """``f_z = a u + a0`` and ``conj(f_zbar) = b u + b0`` at samples, all complex."""

    a: Array
    a0: Array
    b: Array
    b0: Array

    def at(self, index: Array) -> Rows:
        """The rows of some samples."""
        return Rows(self.a[index], self.a0[index], self.b[index], self.b0[index])


def solve_program(
    quadratic: Quadratic,
    rows: Rows,
    frames: Array,
    active: ActiveSet,
    bounds: DistortionBounds,
) -> tuple[Array | None, str]:
    """The unknowns that minimise the energy within the bounds, and Clarabel's status.

    With the frame ``r`` of a sample (a unit complex number) the bounds become second-order cones:
    ``|f_zbar| <= Re(conj(r) f_z) - sigma2``, ``|f_zbar| <= k Re(conj(r) f_z)``, and
    ``|f_z| <= s``, ``|f_zbar| <= sigma1 - s`` with one more unknown ``s``. The first two imply the
    true bounds, the third is exact.
    """
    clarabel: Any = importlib.import_module("clarabel")  # optional, and without type stubs

    n, n_slack = len(quadratic.q), len(active.sigma1)
    along = np.real(rows.a * frames.conj()[:, None])
    blocks, right = [], []
    for index, factor, shift in (
        (active.sigma2, 1.0, -bounds.sigma2),
        (active.k, bounds.k, 0.0),
    ):
        part = rows.at(index)
        head = factor * along[index]
        head0 = factor * np.real(frames[index].conj() * part.a0) + shift
        blocks.append((head, part.b, np.zeros((len(index), n_slack))))
        right.append((head0, part.b0))
    part, slack = rows.at(active.sigma1), np.eye(n_slack)
    zero = np.zeros((n_slack, n))
    blocks += [(zero, part.a, slack), (zero, part.b, -slack)]
    right += [(np.zeros(n_slack), part.a0), (np.full(n_slack, bounds.sigma1), part.b0)]

    # Clarabel wants b - A x in the cone; each cone is (head, Re, Im).
    matrix, offset = [], []
    for (head, body, s), (head0, body0) in zip(blocks, right, strict=True):
        three = np.stack([head, body.real, body.imag], axis=1).reshape(3 * len(head), n)
        tail = np.stack([s, 0 * s, 0 * s], axis=1).reshape(3 * len(s), n_slack)
        matrix.append(np.concatenate([three, tail], axis=1))
        offset.append(np.stack([head0, body0.real, body0.imag], axis=1).ravel())
    full_p = np.zeros((n + n_slack, n + n_slack))
    full_p[:n, :n] = np.triu(quadratic.P)
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    rows_matrix = np.concatenate(matrix)
    cones = [clarabel.SecondOrderConeT(3) for _ in range(len(rows_matrix) // 3)]
    solver = clarabel.DefaultSolver(
        scipy.sparse.csc_matrix(full_p),
        np.concatenate([quadratic.q, np.zeros(n_slack)]),
        scipy.sparse.csc_matrix(-rows_matrix),
        np.concatenate(offset),
        cones,
        settings,
    )
    solution = solver.solve()
    status = str(solution.status)
    if status not in ("Solved", "AlmostSolved"):
        return None, status
    return np.asarray(solution.x)[:n], status
