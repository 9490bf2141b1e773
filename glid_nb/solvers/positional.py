"""The energy of the handles (paper Section 6.1, Appendix F): their images, angles and scales."""

from __future__ import annotations

import functools
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glid_nb._jax import AnyArray, Array, Float, jnp
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap, cauchy
from glid_nb.harmonic.basis import basis_of
from glid_nb.pose import Pose
from glid_nb.solvers.discretisation import complex_basis

_BUCKET = 16  # the number of rows is padded to a multiple of this
_TURN = 10.0  # weight of f_z at a handle, relative to the weight of the handle's image
# Larger weights of an image or of f_z would hide the distortion in rounding errors.
_MOST, _MOST_TURN = 2.5e10, 1e13
_FARTHEST_TURN = 1.0  # radians between two measurements
_SAME_DIRECTION = 1e-4  # radians


class Positional(NamedTuple):
    """The energy of the handles (Section 6.1, (F.1)), ``1/2 |A y - b|^2`` with weights (20).

    ``A`` is the matrix (F.5), ``b`` the targets (F.8).
    """

    matrix: Float[AnyArray, "2h 4c"]  # all rows for the real parts, then for the imaginary
    aims: Float[AnyArray, " 2h"]
    weights: Float[AnyArray, " 2h"]  # lambda for a handle, 0 for padding

    def residual(self, coefficients: Float[Array, " 4c"]) -> Float[AnyArray, " 2h"]:
        return self.matrix @ coefficients - self.aims

    def energy(self, coefficients: Float[Array, " 4c"]) -> Float[Array, ""]:
        """The sum (F.2)."""
        return 0.5 * jnp.sum(self.weights * self.residual(coefficients) ** 2)

    def gradient(self, coefficients: Float[Array, " 4c"]) -> Float[AnyArray, " 4c"]:
        """The gradient (F.7), the sum of (F.4); (G.9) repeats it."""
        return self.matrix.T @ (self.weights * self.residual(coefficients))

    @property
    def free(self) -> int:
        """How many more handles, angles or scales the padding has room for."""
        return int(np.count_nonzero(np.asarray(self.weights).reshape(2, -1).max(axis=0) == 0))


def positional_energy(
    map: HarmonicMap, pose: Pose, weight: float, damping: float = 1.0
) -> Positional:
    """The positional energy of a pose, its rows padded to a bucket; its targets are those of (F.8).

    ``weight`` is the options' ``p2p_weight``, for lengths in the cage's ``unit``. Angles and scales
    add rows for ``f_z``, measured at ``map``; see :func:`_turns`.
    """
    n_handles, turned = len(pose), np.flatnonzero(pose.oriented)
    size = _BUCKET * max(1, -(-(n_handles + len(turned)) // _BUCKET))
    images, turns = slice(n_handles), slice(n_handles, n_handles + len(turned))
    matrix = matrix_at(map.domain, pose.handles.tobytes(), size)
    aims, weights = np.zeros((2, size)), np.zeros((2, size))
    aims[:, images] = pose.targets.T
    weights[:, images], _ = weights_of_images(map.domain, pose, weight)
    if len(turned):
        rows, aims[0, turns], held = _turns(map, pose, turned, damping)
        weights[:, turns] = held * turn_weights(pose, turned, weight)[0]
        matrix = matrix.copy()
        matrix.reshape(2, size, -1)[:, turns] = real_rows(rows, 0)
    return Positional(matrix, aims.ravel(), weights.ravel())


def wider(positional: Positional) -> Positional:
    """With rows of padding for one more bucket."""
    return Positional(*(_wider(np.asarray(a)) for a in positional))


def _wider(rows: NDArray[Any]) -> NDArray[Any]:
    parts = rows.reshape(2, -1, *rows.shape[1:])
    more = np.zeros((2, _BUCKET, *parts.shape[2:]))
    return np.concatenate([parts, more], axis=1).reshape(-1, *rows.shape[1:])


def weights_of_images(
    domain: Domain, pose: Pose, weight: float
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Weights (h,) of handles' images, with lambda of (20), and whether the pose raises them."""
    weights, grow = _weights(weight, _MOST, pose.weights)
    return weights / domain.cage.unit**2, grow


def turn_weights(
    pose: Pose, turned: NDArray[Any], weight: float
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Weights (t,) of ``f_z`` at the turned handles, and whether they grow with the pose's."""
    return _weights(_TURN * weight, _MOST_TURN, pose.weights[turned])


def _weights(weight: float, most: float, firm: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Weights (h,) of handles that are held ``firm``, at most ``most``; whether they are less."""
    return np.minimum(weight, most / firm) * firm, weight * firm < most


def _turns(
    map: HarmonicMap, pose: Pose, turned: NDArray[Any], damping: float
) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
    """Rows (t, c) that measure ``f_z`` at the turned handles, the wanted values (t,) along the
    measured direction, and (2, t) relative weights along and across it.

    The direction is that of the map's own ``f_z``, turned towards the wanted angle by at most one
    radian. A scale without an angle constrains ``|f_z|`` only, whose level sets are curved. So the
    row across gets the weight of this curvature, enlarged by ``damping``.
    """
    angles, scales = pose.angles[turned], pose.scales[turned]
    rows = basis_at(map.domain, pose.handles[turned].tobytes(), cauchy.first_derivatives)
    fz = rows @ basis_of(map.domain).pad(map.phi)
    left = np.angle(np.exp(1j * np.nan_to_num(angles - np.angle(fz))))
    direction = np.angle(fz) + left.clip(-_FARTHEST_TURN, _FARTHEST_TURN)
    strain = 1 - scales / np.abs(fz)
    curvature = np.maximum(damping * strain, (1 - damping) * strain).clip(0, 1)
    held = np.stack([~np.isnan(scales), np.where(np.isnan(angles), curvature, 1)])
    return rows * np.exp(-1j * direction)[:, None], np.nan_to_num(scales), held


def measured_apart(a: Positional, b: Positional) -> float:
    """The difference of two measurements of angles and scales, roughly in radians; 0 if small."""
    gaps, lengths = (np.linalg.norm(m, axis=1) for m in (a.matrix - b.matrix, a.matrix))
    apart = float((gaps / np.maximum(lengths, 1e-300)).max())
    alike = apart <= _SAME_DIRECTION and np.allclose(a.weights, b.weights, rtol=0.1, atol=0.1)
    return 0.0 if alike else apart or _SAME_DIRECTION


def handle_rows(domain: Domain, handles: bytes) -> NDArray[Any]:
    """The complex rows (h, c) of (G.4): ``phi`` and ``psi`` times them are the handles' images."""
    return basis_at(domain, handles, cauchy.cauchy_coordinates)


@functools.lru_cache(maxsize=32)
def basis_at(domain: Domain, points: bytes, kernel: Any) -> NDArray[Any]:
    """The complex rows (k, c) of a kernel of :mod:`glid_nb.harmonic.cauchy` at points."""
    z = np.frombuffer(points).reshape(-1, 2) @ np.array([1, 1j])
    return complex_basis(kernel, z, basis_of(domain))


@functools.lru_cache(maxsize=32)
def matrix_at(domain: Domain, handles: bytes, size: int) -> NDArray[Any]:
    """The matrix (F.5) of the handles, padded to ``size`` rows for the real and imaginary part."""
    own = handle_rows(domain, handles)
    rows = np.zeros((size, own.shape[1]), dtype=complex)
    rows[: len(own)] = own
    return real_rows(rows, size).reshape(2 * size, -1)


def real_rows(rows: NDArray[Any], n_images: int) -> NDArray[Any]:
    """(2, m, 4c): the rows of (F.5) for the real and the imaginary parts, from complex ones (m, c).

    The first ``n_images`` rows give images of points. The others give ``f_z``, which psi does not
    change.
    """
    re, im = np.real(rows), np.imag(rows)
    seen = (np.arange(len(re)) < n_images)[:, None].astype(float)
    return np.stack(
        [np.hstack([re, -im, seen * re, -seen * im]), np.hstack([im, re, -seen * im, -seen * re])]
    )
