"""A deformation problem as data for compiled programs (paper Sections 5 and 6).

Real vectors ``[Re phi, Im phi, Re psi, Im psi]`` hold all padded columns, or the coordinates of
:mod:`glid_nb.solvers.whitening`. Entries that are not unknowns are masked: their gradient is 0, and
their rows and columns of the Hessian are those of the identity. The coefficients ``psi_j`` of the
holes' logarithms are tied to ``phi_j``, so their derivatives are added to those of ``phi_j``.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glid_nb._jax import AnyArray, Array, Float, jax, jnp, once_loaded
from glid_nb.energies import Energy
from glid_nb.geometry import Domain
from glid_nb.harmonic import Basis, HarmonicMap, Singularities, as_complex, cauchy, rows_of
from glid_nb.harmonic.basis import basis_of
from glid_nb.pose import Pose, rigid_motion
from glid_nb.solvers.discretisation import Matrices, complex_basis

_HANDLE_BUCKET = 16
_TURN = 10.0  # weight of f_z at a handle, relative to the weight of the handle's image
# Larger weights of an image or of f_z would hide the distortion in rounding errors.
_MOST, _MOST_TURN = 2.5e10, 1e13
_FARTHEST_TURN = 1.0  # radians between two measurements
_SAME_DIRECTION = 1e-4  # radians

Vector = Float[Array, " 4u"]
Square = Float[Array, "4u 4u"]


@dataclass(frozen=True, eq=False)
class Unknowns:
    """The unknowns of one domain, as data for compiled programs: a pytree."""

    free: Float[AnyArray, " 4u"]  # 1 for an unknown, 0 for padding and fixed or tied entries
    n_holes: int  # padded hole columns; every number of them has a program of its own


once_loaded(
    lambda: jax.tree_util.register_pytree_node(
        Unknowns,
        lambda unknowns: ((unknowns.free,), unknowns.n_holes),
        lambda n_holes, leaves: Unknowns(*leaves, n_holes),
    )
)


class SubspaceProblem(NamedTuple):
    """The objective and its unknowns: a pytree, padded to buckets."""

    matrices: Matrices
    singularities: Singularities
    unknowns: Unknowns
    positional: Positional
    energy: Energy
    p2p_hessian: Any = None  # (4u, 4u), in whitened coordinates; for Newton's method
    anchor: Float[AnyArray, " 4c"] | float = 0.0
    """Coefficients of a constant map, subtracted before derivatives are computed. So a translation
    costs no accuracy."""


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


def positional_energy(
    map: HarmonicMap, pose: Pose, weight: float, damping: float = 1.0
) -> Positional:
    """The positional energy of a pose, its rows padded to a bucket.

    ``weight`` is the options' ``p2p_weight``, for lengths in the cage's ``unit``.

    Angles and scales add rows for ``f_z`` at their handles. The rows measure ``f_z`` along and
    across one direction: that of the map's own ``f_z``, turned towards the wanted angle by at most
    one radian. A scale without an angle constrains ``|f_z|`` only, whose level sets are curved. So
    the row across gets the weight of this curvature, enlarged by ``damping``.
    """
    domain, count, turned = map.domain, len(pose), np.flatnonzero(pose.turned)
    firm, unit = pose.weights, domain.cage.unit
    size = _HANDLE_BUCKET * max(1, -(-(count + len(turned)) // _HANDLE_BUCKET))
    aims, weights = np.zeros((2, size)), np.zeros((2, size))
    aims[:, :count] = pose.targets.T
    weights[:, :count] = np.minimum(weight, _MOST / firm) * firm / unit**2
    matrix = matrix_at(domain, pose.handles.tobytes(), size)
    if len(turned):
        basis, pinned = basis_of(domain), slice(count, count + len(turned))
        d = _basis_at(domain, pose.handles[turned].tobytes(), cauchy.first_derivatives)
        fz, angles, scales = d @ basis.pad(map.phi), pose.angles[turned], pose.scales[turned]
        left = np.angle(np.exp(1j * np.nan_to_num(angles - np.angle(fz))))
        d = d * np.exp(-1j * (np.angle(fz) + left.clip(-_FARTHEST_TURN, _FARTHEST_TURN)))[:, None]
        strain = 1 - scales / np.abs(fz)
        bends = np.maximum(damping * strain, (1 - damping) * strain).clip(0, 1)
        aims[0, pinned] = np.nan_to_num(scales)
        held = np.stack([~np.isnan(scales), np.where(np.isnan(angles), bends, 1)])
        weights[:, pinned] = (
            np.minimum(_TURN * weight, _MOST_TURN / firm[turned]) * firm[turned] * held
        )
        matrix = matrix.reshape(2, size, -1).copy()
        matrix[:, pinned, : 2 * basis.n_columns] = [
            np.hstack([np.real(d), -np.imag(d)]),
            np.hstack([np.imag(d), np.real(d)]),
        ]
        matrix = matrix.reshape(2 * size, -1)
    return Positional(matrix, aims.ravel(), weights.ravel())


def measured_apart(a: Positional, b: Positional) -> float:
    """The difference of two measurements of angles and scales, roughly in radians; 0 if small."""
    gaps, lengths = (np.linalg.norm(m, axis=1) for m in (a.matrix - b.matrix, a.matrix))
    apart = float((gaps / np.maximum(lengths, 1e-300)).max())
    alike = apart <= _SAME_DIRECTION and np.allclose(a.weights, b.weights, rtol=0.1, atol=0.1)
    return 0.0 if alike else apart or _SAME_DIRECTION


@functools.lru_cache(maxsize=32)
def _basis_at(domain: Domain, points: bytes, kernel: Any) -> NDArray[Any]:
    z = np.frombuffer(points).reshape(-1, 2) @ np.array([1, 1j])
    return complex_basis(kernel, z, basis_of(domain))


@functools.lru_cache(maxsize=32)
def matrix_at(domain: Domain, handles: bytes, size: int) -> NDArray[Any]:
    """The matrix (F.5) of the handles, padded to ``size`` rows for the real and imaginary part."""
    own = _basis_at(domain, handles, cauchy.cauchy_coordinates)
    rows = np.zeros((size, own.shape[1]), dtype=complex)
    rows[: len(own)] = own
    re, minus_im = np.real(rows), -np.imag(rows)
    return np.block([[re, minus_im, re, minus_im], [-minus_im, re, minus_im, -re]])


def aligned(map: HarmonicMap, pose: Pose) -> HarmonicMap:
    """The map followed by the rigid motion that brings its handles closest to their targets."""
    if not len(pose):
        return map
    rows = _basis_at(map.domain, pose.handles.tobytes(), cauchy.cauchy_coordinates)
    phi, psi = rows_of(map)
    images = rows @ phi + np.conj(rows @ psi)
    turn, middle, aim = rigid_motion(images, as_complex(pose.targets))
    return moved(map, turn, aim - turn * middle)


def moved(map: HarmonicMap, turn: complex, by: complex) -> HarmonicMap:
    """The map followed by a rotation ``turn``, of modulus 1, and a translation ``by``."""
    phi, psi = map.phi * turn, map.psi * np.conj(turn)
    phi[: len(map.domain.offset_cage.loops_complex[0])] += by
    return HarmonicMap(map.domain, phi, psi)


def real_coefficients(map: HarmonicMap) -> NDArray[Any]:
    """Padded ``[Re phi, Im phi, Re psi, Im psi]`` of a map (E.1)."""
    rows = rows_of(map)
    return np.stack([np.real(rows), np.imag(rows)], axis=1).ravel()


def anchor_of(basis: Basis, coefficients: NDArray[Any]) -> NDArray[Any]:
    """The coefficients of the constant map to the mean of the exterior's ``phi``."""
    c, first = basis.n_columns, basis.n_exterior
    anchor = np.zeros_like(coefficients)
    anchor[:first] = coefficients[:first].mean()
    anchor[c : c + first] = coefficients[c : c + first].mean()
    return anchor


def map_from(domain: Domain, coefficients: Any) -> HarmonicMap:
    """The map of padded real coefficients ``[Re phi, Im phi, Re psi, Im psi]``."""
    columns = basis_of(domain).columns
    re_phi, im_phi, re_psi, im_psi = np.asarray(coefficients).reshape(4, -1)[:, columns]
    return HarmonicMap(domain, re_phi + 1j * im_phi, re_psi + 1j * im_psi)


def unknowns_of(basis: Basis, conformal: bool, whitening: AnyArray | None = None) -> Unknowns:
    """The unknowns among all columns, or among the coordinates of a whitening (2, c, u).

    ``conformal`` drops psi (Section 6).
    """
    n_holes = basis.n_hole_columns
    if whitening is None:
        phi, psi = np.array(basis.phi_free), np.array(basis.psi_free)
    else:
        phi = np.asarray(np.any(np.asarray(whitening), axis=(0, 1)))
        psi = phi.copy()
        psi[[0, *range(len(psi) - n_holes, len(psi))]] = False
    if conformal:
        psi[:] = False
        phi[len(phi) - n_holes :] = False
    return Unknowns(np.concatenate([phi, phi, psi, psi]).astype(float), n_holes)


def restrict_gradient(g: Vector, unknowns: Unknowns) -> Vector:
    """Gradient with respect to the unknowns, 0 elsewhere (Algorithm 1, line 6)."""
    phi, psi, sign = _hole_slices(g.shape[0], unknowns)
    if phi is not None:
        g = g.at[phi].add(sign * g[psi])
    return g * unknowns.free


def restrict_rows(rows: Float[np.ndarray, "h 4u"], unknowns: Unknowns) -> Float[np.ndarray, "h 4u"]:
    """:func:`restrict_gradient` for each row, on the host."""
    phi, psi, sign = _hole_slices(rows.shape[1], unknowns)
    if phi is not None:
        rows = rows.copy()
        rows[:, phi] += sign * rows[:, psi]
    return rows * unknowns.free


def restrict_hessian(
    h: Square,
    unknowns: Unknowns,
    other: Square | None = None,
    ridge: Float[AnyArray, ""] | float = 0.0,
) -> Square:
    """Hessian with respect to the unknowns (Algorithm 1, line 6), plus ``other``.

    ``other`` is already restricted. Without it, entries that are no unknowns get the identity's
    rows. Only the columns of ``psi`` and the block of ``phi`` of ``h`` are read. Below the diagonal
    blocks the result is meaningless. The diagonal is raised by ``ridge`` times its mean, except for
    translations that ``other`` holds, so that a single handle moves the shape freely."""
    phi, psi, sign = _hole_slices(h.shape[0], unknowns)
    if phi is not None:
        sign = sign.astype(h.dtype)
        tied = sign * h[:, psi]
        h = h.at[:, phi].add(tied)
        h = h.at[phi, :].add(tied.T)
        h = h.at[phi[:, None], phi].add(sign[:, None] * tied[psi])
    free = unknowns.free
    # One pass over the matrix, without temporaries that a compiled loop would keep.
    diagonal = jnp.diag(h) * free + (1 - free if other is None else jnp.diag(other))
    index = jnp.arange(len(free))
    raised = ridge * jnp.mean(diagonal)
    if other is not None:
        translations = np.isin(np.arange(len(free)), (0, len(free) // 4))
        raised = jnp.where(translations & (jnp.diag(other) > 0), 0.0, raised)
    diagonal = diagonal + raised
    masked = h * free[:, None] * free
    masked = masked if other is None else masked + other
    return jnp.where(index[:, None] == index, diagonal, masked)


def expand(step: Vector, unknowns: Unknowns) -> Vector:
    """Expand a change of the unknowns to a change of all coefficients."""
    phi, psi, sign = _hole_slices(step.shape[0], unknowns)
    step = step * unknowns.free
    return step if phi is None else step.at[psi].set(sign * step[phi])


def _hole_slices(size: int, unknowns: Unknowns) -> tuple:
    """Positions of the holes' ``[Re phi, Im phi]`` and ``[Re psi, Im psi]``, and the signs of the
    conjugation that ties them."""
    n_holes = unknowns.n_holes
    if n_holes == 0:
        return None, None, None
    c, last = size // 4, np.arange(size // 4 - n_holes, size // 4)
    phi = np.concatenate([last, c + last])
    return phi, phi + 2 * c, np.repeat([1.0, -1.0], n_holes)


def canonical(map: HarmonicMap) -> HarmonicMap:
    """The same map with the redundant coefficients at zero (Section 5).

    Adding ``a z_j + b`` to a hole loop's coefficients does not change the map (Cauchy's theorem).
    This makes the loop's first two coefficients zero. A constant moves from ``psi`` to ``phi``,
    which makes the exterior's first ``psi`` zero."""
    phi, psi = map.phi.copy(), map.psi.copy()
    loops = map.domain.offset_cage.loops_complex
    first = len(loops[0])
    phi[:first] += np.conj(psi[0])
    psi[:first] -= psi[0]
    for loop in loops[1:]:
        part = slice(first, first + len(loop))
        for values in (phi, psi):
            a = (values[first + 1] - values[first]) / (loop[1] - loop[0])
            values[part] -= values[first] + a * (loop - loop[0])
            values[first : first + 2] = 0
        first += len(loop)
    return HarmonicMap(map.domain, phi, psi)
