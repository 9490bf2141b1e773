"""The unknowns written out densely from Section 5, for comparison."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb.geometry import Domain


def dense_expansion(domain: Domain, conformal: bool = False) -> NDArray[Any]:
    """T with [Re phi, Im phi, Re psi, Im psi] = constants + T u, one column per real unknown.

    Columns are ordered Re phi, Im phi, Re psi, Im psi, each in the order of the coefficients. Fixed
    are the first two phi and psi of each hole loop, the first psi of the exterior loop, and the
    holes' psi, which are conj(phi).
    """
    n = domain.n_coefficients
    sizes = [len(loop) for loop in domain.offset_cage.loops_complex]
    m = sum(sizes)
    fixed = {first + k for first in np.cumsum(sizes)[:-1] for k in (0, 1)}
    phi = [j for j in range(m) if j not in fixed] + ([] if conformal else list(range(m, n)))
    psi = [] if conformal else [j for j in range(1, m) if j not in fixed]
    columns = []
    for part, which in enumerate((phi, phi, psi, psi)):
        for j in which:
            column = np.zeros(4 * n)
            column[part * n + j] = 1
            if part < 2 and j >= m:
                column[(part + 2) * n + j] = 1 if part == 0 else -1
            columns.append(column)
    return np.stack(columns, axis=1)
