"""The exact energy of the handles at a map, and how its gradient depends on the pose.

The solver measures a free angle's direction and keeps it during a descent. Here the direction turns
with the map: a scale alone costs ``w/2 (|f_z| - scale)^2``, whose second derivative across ``f_z``
is ``w (1 - scale / |f_z|)``. It may be negative.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from glid_nb._arrays import Array
from glid_nb.harmonic import HarmonicMap, cauchy
from glid_nb.harmonic.basis import basis_of
from glid_nb.pose import Pose
from glid_nb.solvers.positional import (
    basis_at,
    handle_rows,
    real_rows,
    turn_weights,
    weights_of_images,
)
from glid_nb.solvers.problem import real_coefficients


class HandleEnergy(NamedTuple):
    """``1/2 sum w r^2`` of (F.1): rows for the images, then for ``f_z`` at the turned handles.

    Each complex row ``a`` is measured as ``Re u`` and ``Im u`` of ``u = a . phi + conj(a . psi)``,
    a row for ``f_z`` without psi. For ``f_z`` the row is turned to the wanted direction.
    """

    map: HarmonicMap
    pose: Pose
    own: Array
    """(m,) the handle that each row belongs to."""
    wanted: Array  # (t,) the wanted directions of f_z, of modulus 1
    complex_rows: Array  # (m, c)
    rows: Array  # (2, m, 4c)
    weights: Array
    """(2, m) second derivatives along ``Re u`` and ``Im u``."""
    pull: Array  # (2, m) first derivatives
    per_weight: Array
    """(h,) and (t,) joined: ``d log w / d weight`` of the handle; 0 where ``w`` is at its limit."""

    @property
    def hessian_rows(self) -> tuple[Array, Array]:
        """The rows (2m, 4c) and their weights (2m,)."""
        return self.rows.reshape(self.weights.size, -1), self.weights.ravel()

    def gradient(self) -> Array:
        """(4c,) gradient with respect to the coefficients (F.7)."""
        rows, _ = self.hessian_rows
        return self.pull.ravel() @ rows

    def by_targets(self) -> Array:
        """(2 h, 4c) derivatives of the gradient: x and y of each handle in turn."""
        h = len(self.pose)
        made = -self.weights[:, :h, None] * self.rows[:, :h]
        return made.transpose(1, 0, 2).reshape(2 * h, -1)

    def by_weights(self) -> Array:
        """(h, 4c) derivatives of the gradient."""
        parts = np.einsum("km,kmc->mc", self.pull * self.per_weight, self.rows)
        return self._summed(parts)

    def by_handles(self) -> Array:
        """(2 h, 4c) derivatives of the gradient along x and y of each handle's place."""
        h, domain = len(self.pose), self.map.domain
        turned = self.own[h:]
        first = basis_at(domain, self.pose.handles.tobytes(), cauchy.first_derivatives)
        second = basis_at(domain, self.pose.handles[turned].tobytes(), cauchy.second_derivatives)
        moved = np.concatenate([first, second / self.wanted[:, None]])
        both = [self._summed(self._by_rows(step * moved)) for step in (1, 1j)]
        return np.stack(both, axis=1).reshape(2 * h, -1)

    def by_angles(self) -> Array:
        """(h, 4c) derivatives of the gradient; NaN where the angle is free."""
        h = len(self.pose)
        turns = np.concatenate([np.zeros_like(self.complex_rows[:h]), -1j * self.complex_rows[h:]])
        made = self._summed(self._by_rows(turns))
        made[np.isnan(self.pose.angles)] = np.nan
        return made

    def by_scales(self) -> Array:
        """(h, 4c) derivatives of the gradient; NaN where the scale is free."""
        h = len(self.pose)
        parts = -self.weights[0, :, None] * self.rows[0]
        parts[:h] = 0
        made = self._summed(parts)
        made[np.isnan(self.pose.scales)] = np.nan
        return made

    def _by_rows(self, changes: Array) -> Array:
        """(m, 4c) derivatives of the gradient if each complex row changes by these."""
        rows = real_rows(changes, len(self.pose))
        values = rows @ real_coefficients(self.map)
        return np.einsum("km,kmc->mc", self.pull, rows) + np.einsum(
            "km,kmc->mc", self.weights * values, self.rows
        )

    def _summed(self, parts: Array) -> Array:
        """(h, 4c) sums of the rows (m, 4c) of each handle."""
        made = np.zeros((len(self.pose), parts.shape[1]))
        np.add.at(made, self.own, parts)
        return made


def handle_energy(map: HarmonicMap, pose: Pose, weight: float) -> HandleEnergy:
    """The energy at a map. ``weight`` is the options' ``p2p_weight``."""
    h, turned = len(pose), np.flatnonzero(pose.oriented)
    angles, scales = pose.angles[turned], pose.scales[turned]
    plain = basis_at(map.domain, pose.handles[turned].tobytes(), cauchy.first_derivatives)
    fz = plain @ basis_of(map.domain).pad(map.phi)
    wanted = np.exp(1j * np.where(np.isnan(angles), np.angle(fz), angles))
    turns = plain * np.conj(wanted)[:, None]
    complex_rows = np.concatenate([handle_rows(map.domain, pose.handles.tobytes()), turns])
    rows = real_rows(complex_rows, h)
    aims = np.concatenate([pose.targets.T, np.stack([np.nan_to_num(scales), 0 * scales])], axis=1)
    aims = np.nan_to_num(aims)
    images, images_grow = weights_of_images(map.domain, pose, weight)
    firm, turns_grow = turn_weights(pose, turned, weight)
    along = np.where(np.isnan(scales), 0.0, firm)
    across = np.where(np.isnan(angles), firm * (1 - scales / np.abs(fz)), firm)
    weights = np.concatenate([np.stack([images, images]), np.stack([along, across])], axis=1)
    residual = rows @ real_coefficients(map) - aims
    own = np.concatenate([np.arange(h), turned])
    grow = np.concatenate([images_grow, turns_grow]) / pose.weights[own]
    return HandleEnergy(
        map=map,
        pose=pose,
        own=own,
        wanted=wanted,
        complex_rows=complex_rows,
        rows=rows,
        weights=weights,
        pull=weights * residual,
        per_weight=grow,
    )
