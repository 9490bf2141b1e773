"""Point-to-point deformation by Cauchy coordinates (Weber, Ben-Chen & Gotsman 2009)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb._runtime import double_precision
from glid_nb.geometry import Domain, graded_panels
from glid_nb.harmonic import HarmonicMap, basis_of, cauchy
from glid_nb.solvers import Pose
from glid_nb.solvers.discretisation import complex_basis

Array = NDArray[Any]


@double_precision
def cauchy_point_to_point(domain: Domain, pose: Pose, p2p_weight: float) -> HarmonicMap:
    """The holomorphic map of least ``|f'' |^2`` along the boundary with soft targets.

    Linear: one solve, ``psi = 0`` and no logarithms. Nothing keeps ``f'`` from vanishing.
    """
    basis = basis_of(domain)
    panels = graded_panels(domain)
    columns = np.flatnonzero(basis.phi_free)[: int(basis.phi_free.sum()) - domain.n_holes]
    slopes = complex_basis(cauchy.second_derivatives, panels.middle, basis)[:, columns]
    share = panels.length / panels.length.sum()
    normal = slopes.conj().T @ (share[:, None] * slopes)
    right = np.zeros(len(columns), dtype=complex)
    if len(pose):
        z = pose.handles @ np.array([1, 1j])
        rows = complex_basis(cauchy.cauchy_coordinates, z, basis)[:, columns]
        normal = normal + p2p_weight / 2 * rows.conj().T @ rows
        right = p2p_weight / 2 * rows.conj().T @ (pose.targets @ np.array([1, 1j]))
    identity = HarmonicMap.identity(domain)
    base = basis.pad(identity.phi)[columns]
    # Relative to the identity, so that what the handles leave open stays as it is.
    change = np.linalg.lstsq(normal, right - normal @ base, rcond=1e-14)[0]
    padded = basis.pad(identity.phi)
    padded[columns] = base + change
    return HarmonicMap(domain, padded[basis.columns], np.zeros(domain.n_coefficients))
