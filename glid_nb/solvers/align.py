"""The rigid motion that brings handles closest to their targets."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb.harmonic import HarmonicMap, as_complex
from glid_nb.solvers.pose import Pose


def aligned(map: HarmonicMap, pose: Pose, images: NDArray[Any] | None = None) -> HarmonicMap:
    """The map followed by the rigid motion that brings its handles closest to their targets.

    A rigid motion changes neither the isometric energy nor the certificate. ``images`` (h, 2) are
    the handles' images under the map, when they are known.
    """
    if not len(pose):
        return map
    known = map(pose.handles) if images is None else images
    z, targets = as_complex(known), as_complex(pose.targets)
    middle, aim = z.mean(), targets.mean()
    correlation = np.vdot(z - middle, targets - aim)
    turn = correlation / abs(correlation) if abs(correlation) > 0 else 1.0
    phi, psi = map.phi * turn, map.psi * np.conj(turn)
    phi[: len(map.domain.offset_loops_complex[0])] += aim - turn * middle
    return HarmonicMap(map.domain, phi, psi)
