"""A deformation problem as data for compiled programs (paper Sections 5 and 6).

Real vectors ``[Re phi, Im phi, Re psi, Im psi]`` hold all padded columns, or the coordinates of
:mod:`glid_nb.solvers.whitening`. Entries that are not unknowns are masked: their gradient is 0, and
their rows and columns of the Hessian are those of the identity. The coefficients ``psi_j`` of the
holes' logarithms are tied to ``phi_j``, so their derivatives are added to those of ``phi_j``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glid_nb._jax import AnyArray, Array, Float, jax, jnp, once_loaded
from glid_nb.energies import Energy
from glid_nb.geometry import Domain
from glid_nb.harmonic import Basis, HarmonicMap, Singularities, as_complex, rows_of
from glid_nb.harmonic.basis import basis_of
from glid_nb.pose import Pose, rigid_motion
from glid_nb.solvers.discretisation import Matrices
from glid_nb.solvers.positional import Positional, handle_rows

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


def aligned(map: HarmonicMap, pose: Pose) -> HarmonicMap:
    """The map followed by the rigid motion that brings its handles closest to their targets."""
    if not len(pose):
        return map
    rows = handle_rows(map.domain, pose.handles.tobytes())
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


def expand_rows(steps: Float[np.ndarray, "k 4u"], unknowns: Unknowns) -> NDArray[Any]:
    """:func:`expand` for each row, on the host."""
    phi, psi, sign = _hole_slices(steps.shape[1], unknowns)
    steps = steps * unknowns.free
    if phi is not None:
        steps[:, psi] = sign * steps[:, phi]
    return steps


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
