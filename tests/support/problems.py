"""Small poses that the tests of all methods share."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from glid_nb import methods
from glid_nb.energies import Energy
from glid_nb.geometry import Domain
from glid_nb.minima import solve
from glid_nb.pose import Pose
from glid_nb.solvers import Options, Result

from .domains import domain

_ELL = np.array([[-2.5, 2.5], [2.5, -2.5], [-2.0, -2.0]])
_RING = np.array([[2.2, 0.1], [-2.2, 0.0], [0.0, 2.1]])

POSES = {
    "ell": Pose(_ELL, [[-4.0, 1.5], [2.0, -0.5], [-2.0, -2.0]]),
    "ring": Pose(_RING, [[3.4, 0.8], [-2.2, -0.6], [0.3, 1.7]]),
    # Bent so far that the exact Hessian is indefinite on the way.
    "bent": Pose(_ELL, [[-5.0, -3.0], [2.5, 2.5], [-2.0, -2.0]]),
}
_OPTIONS = {field.name for field in dataclasses.fields(Options)}


def problem(name: str) -> tuple[Domain, Pose]:
    """The domain and pose of a name."""
    return domain("ring" if name == "ring" else "ell"), POSES[name]


def run_method(
    name: str, shape: Domain, pose: Pose, energy: Energy | str | None = None, **settings: Any
) -> Result:
    """A solve by the method of a name; its settings, options and the rest together as keywords.

    ``p2p_weight`` is lambda in the shape's own units."""
    own = methods.METHODS[name].kinds()
    chosen = {k: settings.pop(k) for k in [*settings] if k in own}
    options = {"p2p_weight": 1e5} | {k: settings.pop(k) for k in [*settings] if k in _OPTIONS}
    options["p2p_weight"] *= shape.cage.unit**2
    method = methods.by_name(name, **chosen)
    return solve(
        shape, pose, energy, Options(**{"restarts": 0, **options}), method=method, **settings
    )
