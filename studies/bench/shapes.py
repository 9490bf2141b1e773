"""Shapes of any size, to see how things grow."""

from __future__ import annotations

import numpy as np

from glid_nb.geometry import Cage, Domain
from glid_nb.solvers import Pose


def flower(vertices: int, holes: int) -> Domain:
    """A flower of radius about 8 with so many vertices, and triangular holes on a grid inside."""
    t = np.linspace(0, 2 * np.pi, vertices, endpoint=False)
    radius = 8 + 1.2 * np.sin(5 * t)
    exterior = radius[:, None] * np.stack([np.cos(t), np.sin(t)], axis=1)
    side = int(np.ceil(np.sqrt(holes)))
    triangle = np.array([[0, 1], [0.87, -0.5], [-0.87, -0.5]])
    spacing = 8.0 / max(side, 1)
    places = [
        ((i - (side - 1) / 2) * spacing, (j - (side - 1) / 2) * spacing)
        for i in range(side)
        for j in range(side)
    ]
    return Domain.from_cage(
        Cage(exterior, [0.25 * spacing * triangle + place for place in places[:holes]])
    )


def ring_of_handles(count: int) -> Pose:
    """Handles spread over a ring inside a :func:`flower`, a tenth of them (at least one) moved."""
    t = np.linspace(0, 2 * np.pi, count, endpoint=False)
    handles = 6.2 * np.stack([np.cos(t), np.sin(t)], axis=1)
    targets = handles.copy()
    targets[::10] += [0.4, 0.2]
    return Pose(handles, targets)
