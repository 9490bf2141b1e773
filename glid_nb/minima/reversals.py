"""Which lines may as well turn the other way round, and what that would cost.

What turns cost is known exactly while they are small: then the energy is a quadratic form of the
handles' moves. For large turns the form still tells roughly how costs compare. Of 57 poses that
another turn improves by over 2% it names all but one.
"""

import functools
import itertools

import numpy as np

from glid_nb._arrays import Array
from glid_nb._runtime import single_blas_thread
from glid_nb.geometry import Domain, as_points
from glid_nb.harmonic.basis import basis_of
from glid_nb.minima.handle_turns import HandleTurns, Line
from glid_nb.minima.waypoints import targets_at
from glid_nb.solvers.discretisation import discretise
from glid_nb.solvers.positional import matrix_at
from glid_nb.solvers.problem import unknowns_of
from glid_nb.solvers.whitening import pulled_back

# So many lines, or groups of lines, are combined: 7 combinations.
MOST_TURNED = 3
# Where more lines turn far, those at one handle whose turns differ by less are one group. A frog
# ends at 10.40 instead of 14.35 with that. Where fewer do, groups lose minima: the gecko upside
# down ends at 3.842 instead of 3.693.
_ALIKE = np.deg2rad(20)
# Added to the strain's quadratic form, so that rigid motions cost something.
_LEAST_STRAIN = 1e-6
# The time at which the handles' moves are measured, and the root of the least cost.
_SMALL = 1e-6


def reversals(turns: HandleTurns, least: float) -> dict[tuple[int, ...], float]:
    """Lines that may turn the other way round, alone or together, each named by its child.

    They turn by at least ``least`` radians. The values are costs, relative to that of the turns as
    they are; the cheapest comes first."""
    far = _far(turns, least)
    chosen = [sum(c, ()) for n in range(MOST_TURNED) for c in itertools.combinations(far, n + 1)]
    costs = {lines: cost(turns, lines) / cost(turns) for lines in chosen}
    return dict(sorted(costs.items(), key=lambda item: item[1]))


def cost(turns: HandleTurns, reversed: tuple[int, ...] = ()) -> float:
    """What the turns would cost if costs grew with their squares, as they do for small turns."""
    moved = as_points(targets_at(turns, _SMALL, turns.angles(reversed))) - turns.pose.handles
    moves = moved.T.ravel() / _SMALL
    form = _quadratic_form(turns.domain, turns.pose.handles.tobytes())
    return max(float(moves @ form @ moves), _SMALL**2)


def _far(turns: HandleTurns, least: float) -> list[tuple[int, ...]]:
    """The lines that turn most, or the groups of lines that turn alike."""
    far = [line for line in turns.lines if abs(line.turn) >= least]
    alike = _ALIKE if len(far) > MOST_TURNED else 0
    groups = list[tuple[int, ...]]()
    while far:
        most = max(far, key=lambda line: abs(line.turn))
        group = [line for line in far if _goes_with(line, most, alike)]
        groups.append(tuple(line.child for line in group or [most]))
        far = [line for line in far if line.child not in groups[-1]]
    return groups[:MOST_TURNED]


def _goes_with(line: Line, most: Line, alike: float) -> bool:
    return line.parent == most.parent and abs(line.turn - most.turn) < alike


@functools.lru_cache(maxsize=32)
@single_blas_thread()
def _quadratic_form(domain: Domain, handles: bytes) -> Array:
    """(2h, 2h) form of small moves of the handles, (Re, Im): the least mean of
    ``(Re f_z)^2 + |f_zbar|^2``.

    Whitened ``psi`` turns the second term into the identity.
    """
    matrices, points = discretise(domain).matrices, matrix_at(domain, handles, len(handles) // 16)
    free = unknowns_of(basis_of(domain), False, matrices.whitening).free
    phi, psi = np.hsplit(pulled_back(points, np.asarray(matrices.whitening)) * free, 2)
    rows = np.asarray(matrices.whitened, float) * np.sqrt(np.asarray(matrices.hessian_weights))
    strain = rows @ rows.T + _LEAST_STRAIN * np.eye(len(rows))
    return np.linalg.pinv(phi @ np.linalg.solve(strain, phi.T) + psi @ psi.T, hermitian=True)
