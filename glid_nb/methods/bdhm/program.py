"""One step of BDHM: a convex program with the frames ``f_z / |f_z|`` held fixed."""

from __future__ import annotations

import importlib
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse
from numpy.typing import NDArray

from glid_nb.methods.bdhm.samples import ActiveSet

Array = NDArray[Any]


class Step(NamedTuple):
    """The solution of a program."""

    change: Array | None
    """What to add to the unknowns; None where the program was not solved."""
    decrease: float
    """No point that the program admits lowers its energy by more: by weak duality."""
    status: str
    """Clarabel's; "Solved" to the accuracy that was asked for."""


def solve_program(gradient: Array, active: ActiveSet, v: Array, gap: float) -> Step:
    """Minimise ``|d|^2 / 2 + gradient^T d`` over ``d`` such that ``v + d`` keeps the bounds.

    With the frame ``r`` of a sample (a unit complex number) the bounds become second-order cones:
    ``|f_zbar| <= k Re(conj(r) f_z)``, ``|f_zbar| <= Re(conj(r) f_z) - sigma2``, and
    ``|f_z| <= s``, ``|f_zbar| <= sigma1 - s`` with one more unknown ``s``. The first two imply the
    true bounds, the third is exact. The duality gap is to be at most ``gap``, or
    1e-8 of the decrease where that is more.
    """
    i, j, m = (np.flatnonzero(row) for row in active.chosen)
    if not len(i) + len(j) + len(m):
        return Step(-gradient, float(gradient @ gradient) / 2, "Solved")
    k, sigma1, sigma2 = active.bounds.at(active.levels(v))
    samples = active.samples
    f, g = samples.values(v)
    size = np.abs(f)
    along = [np.real(samples.a[at] * (f[at].conj() / size[at])[:, None]) for at in (i, m)]
    nothing = np.zeros((len(j), len(v)))
    # Each cone is a head and a complex body, (of d, constant) each.
    cones = [
        (k[i, None] * along[0], k[i] * size[i], samples.b[i], g[i]),
        (along[1], size[m] - sigma2[m], samples.b[m], g[m]),
        (nothing, size[j], samples.a[j], f[j]),
        (nothing, sigma1[j] - size[j], samples.b[j], g[j]),
    ]
    rows = np.concatenate([_triples(head, body) for head, _, body, _ in cones])
    offset = np.concatenate([_triples(head, body) for _, head, _, body in cones])
    # s is counted from where the map is now, and only heads have it.
    of_s = np.kron(np.eye(len(j)), np.array([[1.0], [0.0], [0.0]]))
    without = np.zeros((3 * (len(i) + len(m)), len(j)))
    return _solved(gradient, rows, np.concatenate([without, of_s, -of_s]), offset, gap)


def _triples(head: Array, body: Array) -> Array:
    """Head, real and imaginary part of each cone, one after the other."""
    three = np.stack([head, np.real(body), np.imag(body)], axis=1)
    return three.reshape(3 * len(head), *head.shape[1:])


def _solved(gradient: Array, rows: Array, slack: Array, offset: Array, gap: float) -> Step:
    """Only what the rows see of ``d`` is left to Clarabel; across them it is minus the gradient."""
    q, r = np.linalg.qr(rows.T)
    seen = q.T @ gradient
    across = gradient - q @ seen
    n, n_slack = len(seen), slack.shape[1]
    clarabel: Any = importlib.import_module("clarabel")  # optional, and without type stubs
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.tol_gap_abs = gap
    # Relative to 1 at least, so that the smaller of the two gaps ends a small program.
    settings.tol_gap_rel = min(settings.tol_gap_rel, gap)
    # Clarabel wants b - A x in the cones.
    solution = clarabel.DefaultSolver(
        scipy.sparse.diags_array(np.repeat([1.0, 0.0], [n, n_slack])).tocsc(),
        np.concatenate([seen, np.zeros(n_slack)]),
        scipy.sparse.csc_matrix(-np.concatenate([r.T, slack], axis=1)),
        offset,
        [clarabel.SecondOrderConeT(3)] * (len(rows) // 3),
        settings,
    ).solve()
    status = str(solution.status)
    solved = status in ("Solved", "AlmostSolved")
    change = q @ np.asarray(solution.x)[:n] - across if solved else None
    return Step(change, float(across @ across) / 2 - float(solution.obj_val_dual), status)
