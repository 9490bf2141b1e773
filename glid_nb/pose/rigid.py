"""The rigid motion that brings points closest to given targets."""

import numpy as np

from glid_nb._arrays import Array


def rigid_motion(z: Array, targets: Array) -> tuple[complex, complex, complex]:
    """Turn, middle and aim. ``aim + turn (z - middle)`` brings ``z`` closest to the targets."""
    middle, aim = z.mean(), targets.mean()
    correlation = np.vdot(z - middle, targets - aim)
    turn = correlation / abs(correlation) if abs(correlation) > 0 else 1.0
    return complex(turn), complex(middle), complex(aim)
