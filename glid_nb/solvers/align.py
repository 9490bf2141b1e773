"""The rigid motion that brings handles closest to their targets."""

from __future__ import annotations

import numpy as np

from glid_nb.harmonic import HarmonicMap, as_complex
from glid_nb.solvers.pose import Pose


def aligned(map: HarmonicMap, pose: Pose) -> HarmonicMap:
    """The map followed by the rigid motion that brings its handles closest to their targets.

    A rigid motion changes neither the isometric energy nor the certificate.
    """
    if not len(pose):
        return map
    images, targets = as_complex(map(pose.handles)), as_complex(pose.targets)
    middle, aim = images.mean(), targets.mean()
    correlation = np.vdot(images - middle, targets - aim)
    turn = correlation / abs(correlation) if abs(correlation) > 0 else 1.0
    phi, psi = map.phi * turn, map.psi * np.conj(turn)
    phi[: len(map.domain.offset_loops_complex[0])] += aim - turn * middle
    return HarmonicMap(map.domain, phi, psi)
