"""An outline, pins and a map as the page's scripts take them."""

from typing import Any

import numpy as np

from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.pose import Pose


def coefficients_of(map: HarmonicMap) -> list[float]:
    """Real and imaginary parts of phi, then of psi, as the page takes them."""
    parts = [part(one) for one in (map.phi, map.psi) for part in (np.real, np.imag)]
    return np.concatenate(parts).tolist()


def outline_of(domain: Domain) -> dict[str, Any]:
    """The cage, the offset cage and the hole points, as the page takes them."""
    return {key: value for key, value in domain.to_dict().items() if key != "notes"}


def pins_of(pose: Pose | None) -> list[dict[str, Any]]:
    """The pins of a pose as the page takes them."""
    if pose is None:
        return []
    return [
        {
            "handle": pose.handles[i].tolist(),
            "target": pose.targets[i].tolist(),
            "angle": _number(pose.angles[i]),
            "scale": _number(pose.scales[i]),
            "weight": float(pose.weights[i]),
            "depth": float(pose.depths[i]),
            "name": str(pose.names[i]),
        }
        for i in range(len(pose))
    ]


def _number(value: float) -> float | None:
    """A wanted angle or scale; None where it is free."""
    return float(value) if np.isfinite(value) else None
