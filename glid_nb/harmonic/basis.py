"""The basis of a domain, padded so that domains of similar size share compiled programs."""

import functools
from typing import NamedTuple

import numpy as np

from glid_nb._arrays import Array
from glid_nb._jax import Bool, Complex, Int
from glid_nb.geometry import Domain
from glid_nb.geometry._loops import next_index
from glid_nb.harmonic.cauchy import Singularities

_HOLE_BUCKETS = (0, 1, 2, 4, 8, 16, 32, 64)


def column_bucket(count: int) -> int:
    """The padded number of columns: at least 32, 48, 64, then multiples of 8, from 256 on of 16."""
    step = 16 if count <= 64 or count > 256 else 8
    return max(-(-count // step) * step, 32)


class Basis(NamedTuple):
    """Columns of the harmonic subspace on a domain (Section 5), padded by columns without unknowns.

    Domains with the same number of padded columns share compiled programs.
    """

    singularities: Singularities
    """The offset cage's vertices, then padding on a far circle; hole points, then padding."""
    columns: Int[Array, " n"]  # the padded columns of the domain's own coefficients
    phi_free: Bool[Array, " c"]
    """Which columns are unknowns: not the first two of each hole loop, nor padding."""
    psi_free: Bool[Array, " c"]
    """The same for psi, without the exterior's first and logarithms (``psi_j = conj(phi_j)``)."""

    @property
    def n_columns(self) -> int:
        return len(self.phi_free)

    @property
    def n_exterior(self) -> int:
        """Columns of the exterior loop, which come first."""
        return int(self.singularities.previous[0]) + 1

    @property
    def n_hole_columns(self) -> int:
        """Padded logarithm columns, which come last."""
        return len(self.singularities.hole_points)

    @property
    def n_unknowns(self) -> int:
        """Number of real unknowns, ``4 n - 10 N - 2``."""
        return 2 * int(self.phi_free.sum() + self.psi_free.sum())

    def pad(self, coefficients: Complex[Array, " n"]) -> Complex[Array, " c"]:
        """The domain's own coefficients in the padded columns, zeros elsewhere."""
        padded = np.zeros(self.n_columns, dtype=complex)
        padded[self.columns] = coefficients
        return padded


@functools.lru_cache(maxsize=64)
def basis_of(domain: Domain) -> Basis:
    """The basis of a domain, cached: Cauchy coordinates of the offset cage, logarithms of holes.

    The null space is removed as in Section 5: two coefficients of each hole loop are 0, and one
    ``psi`` of the exterior loop.
    """
    loops, rho = domain.offset_cage.loops_complex, domain.hole_points_complex
    sizes, vertices = [len(loop) for loop in loops], np.concatenate(loops)
    m, n_holes = len(vertices), len(rho)

    least = 4 if n_holes and m + 4 <= 64 else n_holes  # small domains share programs
    hole_padding = next(b for b in (*_HOLE_BUCKETS, n_holes) if b >= max(n_holes, least)) - n_holes
    own = m + n_holes + hole_padding
    padding = column_bucket(own) - own
    if padding in (1, 2):  # a loop has at least 3 vertices
        padding = column_bucket(own + 3) - own
    center = vertices.mean()
    far = 1e3 * np.abs(vertices - center).max()
    ring = center + far * np.exp(2j * np.pi * np.arange(padding) / max(padding, 1))
    outside = center + 2 * far * np.exp(2j * np.pi * np.arange(hole_padding) / 64)

    following = next_index(np.repeat(np.arange(len(sizes) + 1), [*sizes, padding]))
    phi_free = np.zeros(m + padding + n_holes + hole_padding, dtype=bool)
    phi_free[:m] = True
    for start in np.cumsum(sizes[:-1]):
        phi_free[start : start + 2] = False
    psi_free = phi_free.copy()
    psi_free[0] = False
    phi_free[m + padding : m + padding + n_holes] = True

    all_vertices, all_holes = np.concatenate([vertices, ring]), np.concatenate([rho, outside])
    singularities = Singularities(all_vertices, following, np.argsort(following), all_holes)
    columns = np.concatenate([np.arange(m), m + padding + np.arange(n_holes)])
    return Basis(singularities, columns, phi_free, psi_free)
