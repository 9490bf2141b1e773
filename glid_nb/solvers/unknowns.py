"""Which coefficients are unknowns, and the tie of the logarithms (paper Section 5).

Real vectors ``[Re phi, Im phi, Re psi, Im psi]`` hold all padded columns, or the coordinates of
:mod:`glid_nb.solvers.whitening`. Entries that are not unknowns are masked: their gradient is 0 and
their rows and columns of the Hessian are those of the identity. The holes' ``psi_j = conj(phi_j)``
are folded onto ``phi_j``.
"""

from typing import Any as Array  # of NumPy or of JAX
from typing import NamedTuple

import numpy as np

from glid_nb._jax import AnyArray, Float, jnp
from glid_nb.harmonic import HarmonicMap
from glid_nb.harmonic.basis import Basis

Vector = Float[Array, " 4u"]
Square = Float[Array, "4u 4u"]


class Unknowns(NamedTuple):
    """The unknowns of one domain, as data for compiled programs."""

    free: Float[AnyArray, " 4u"]  # 1 for an unknown, 0 for padding and what is fixed or tied
    holes: Float[AnyArray, " N"]  # one entry per padded hole column: its length matters


def unknowns_of(basis: Basis, conformal: bool, whitening: Array | None = None) -> Unknowns:
    """Among all columns or the coordinates of a whitening (2, c, u); ``conformal`` drops psi."""
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
    return Unknowns(np.concatenate([phi, phi, psi, psi]).astype(float), np.ones(n_holes))


def restrict_gradient(g: Vector, unknowns: Unknowns) -> Vector:
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
    """Hessian with respect to the unknowns plus ``other``, restricted already; else the identity.
    Of ``h`` the columns of ``psi`` and the block of ``phi`` are read; below the diagonal blocks the
    result means nothing. The diagonal is raised by ``ridge`` times its mean."""
    phi, psi, sign = _hole_slices(h.shape[0], unknowns)
    if phi is not None:
        sign = sign.astype(h.dtype)
        tied = sign * h[:, psi]
        h = h.at[:, phi].add(tied)
        h = h.at[phi, :].add(tied.T)
        h = h.at[phi[:, None], phi].add(sign[:, None] * tied[psi])
    free = unknowns.free
    # One pass over the matrix, nothing that a compiled loop would keep.
    diagonal = jnp.diag(h) * free + (1 - free if other is None else jnp.diag(other))
    diagonal = diagonal + ridge * jnp.mean(diagonal)
    index = jnp.arange(len(free))
    masked = h * free[:, None] * free
    masked = masked if other is None else masked + other
    return jnp.where(index[:, None] == index, diagonal, masked)


def expand(step: Vector, unknowns: Unknowns) -> Vector:
    """A change of the unknowns as a change of all coefficients."""
    phi, psi, sign = _hole_slices(step.shape[0], unknowns)
    step = step * unknowns.free
    return step if phi is None else step.at[psi].set(sign * step[phi])


def _hole_slices(size: int, unknowns: Unknowns) -> tuple:
    """Positions of the holes' ``[Re phi, Im phi]`` and ``[Re psi, Im psi]``, and conj's signs."""
    n_holes = unknowns.holes.shape[0]
    if n_holes == 0:
        return None, None, None
    c, last = size // 4, np.arange(size // 4 - n_holes, size // 4)
    phi = np.concatenate([last, c + last])
    return phi, phi + 2 * c, np.repeat([1.0, -1.0], n_holes)


def canonical(map: HarmonicMap) -> HarmonicMap:
    """The same map with the redundant coefficients at zero (Section 5). Adding ``a z_j + b`` to a
    hole loop's coefficients changes no map (Cauchy's theorem): the loop's first two become zero. A
    constant moves from ``psi`` to ``phi`` to zero the exterior's first."""
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
