"""Small poses that the tests of all methods share."""

from __future__ import annotations

import numpy as np

from glid_nb.geometry import Domain
from glid_nb.solvers import Pose

from ..domains import domain

_ELL = np.array([[-2.5, 2.5], [2.5, -2.5], [-2.0, -2.0]])
_RING = np.array([[2.2, 0.1], [-2.2, 0.0], [0.0, 2.1]])

POSES = {
    "ell": Pose(_ELL, [[-4.0, 1.5], [2.0, -0.5], [-2.0, -2.0]]),
    "ring": Pose(_RING, [[3.4, 0.8], [-2.2, -0.6], [0.3, 1.7]]),
    # Bent so far that the exact Hessian is indefinite on the way.
    "bent": Pose(_ELL, [[-5.0, -3.0], [2.5, 2.5], [-2.0, -2.0]]),
}


def problem(name: str) -> tuple[Domain, Pose]:
    """The domain and pose of a name."""
    return domain("ring" if name == "ring" else "ell"), POSES[name]
