"""Where a method starts: the identity or a given map, proved and moved rigidly to the targets."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb._errors import InputError
from glid_nb.certificate import certify
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap, as_complex
from glid_nb.solvers.pose import Pose


class StartError(InputError):
    """The map to start from cannot be used."""


def check_belongs(map: HarmonicMap, domain: Domain) -> None:
    """Raise :class:`StartError` for a map of another domain; equal domains are the same."""
    if map.domain is not domain and map.domain.to_dict() != domain.to_dict():
        raise StartError(
            "the map to start from belongs to another domain; start from a map of this one"
        )


def check_proved(map: HarmonicMap) -> None:
    """Raise :class:`StartError` for a map that is not proved locally injective."""
    certificate = certify(map)
    if not certificate.certified:
        raise StartError(f"the map to start from is not certified: {certificate.reason}")


def check_conformal(map: HarmonicMap) -> None:
    """Raise :class:`StartError` for a map that is not conformal."""
    if np.abs(map.psi - map.psi[0]).max() > 0:
        raise StartError(
            "the map to start from is not conformal (psi is not constant); start from a conformal "
            "map or turn the option conformal off"
        )


def rigid_motion(z: NDArray[Any], targets: NDArray[Any]) -> tuple[complex, complex, complex]:
    """``z -> aim + turn (z - middle)`` that brings (h,) complex points closest to their targets.

    Returns turn, middle and aim.
    """
    middle, aim = z.mean(), targets.mean()
    correlation = np.vdot(z - middle, targets - aim)
    turn = correlation / abs(correlation) if abs(correlation) > 0 else 1.0
    return turn, middle, aim


def aligned(map: HarmonicMap, pose: Pose, images: NDArray[Any] | None = None) -> HarmonicMap:
    """The map followed by the rigid motion that brings its handles closest to their targets.

    A rigid motion changes neither the isometric energy nor the certificate. ``images`` (h, 2) are
    the handles' images under the map, when they are known.
    """
    if not len(pose):
        return map
    known = map(pose.handles) if images is None else images
    turn, middle, aim = rigid_motion(as_complex(known), as_complex(pose.targets))
    phi, psi = map.phi * turn, map.psi * np.conj(turn)
    phi[: len(map.domain.offset_loops_complex[0])] += aim - turn * middle
    return HarmonicMap(map.domain, phi, psi)
