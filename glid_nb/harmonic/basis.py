"""The basis of a domain: its singularities, padded to a bucket so that shapes share programs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glid_nb.geometry._loops import next_index
from glid_nb.harmonic.cauchy import Singularities

if TYPE_CHECKING:
    from jaxtyping import Bool, Complex, Int

    from glid_nb.geometry import Domain

Array = NDArray[Any]

_BUCKET = 8
_HOLE_BUCKETS = (0, 1, 2, 4, 8, 16, 32, 64)


class Basis(NamedTuple):
    """Columns of the harmonic subspace on a domain (paper Section 5).

    ``singularities`` holds the offset cage's vertices, then padding vertices on a far circle,
    and the hole points, then padding points beside that circle. Padding columns always carry
    zero coefficients, so they change no map; they exist so that domains whose sizes fall into
    the same bucket run the same compiled program.

    ``columns`` maps the domain's own ``n = m + N`` coefficients to padded columns. ``phi_free``
    and ``psi_free`` say which padded columns are unknowns: the first two of each hole loop are
    fixed to zero (Section 5), as is the first ``psi`` of the exterior loop; the hole columns of
    ``psi`` are tied to ``phi_j = conj(psi_j)`` and so are not unknowns of their own.
    """

    singularities: Singularities
    columns: Int[Array, " n"]
    phi_free: Bool[Array, " c"]
    psi_free: Bool[Array, " c"]

    @property
    def unknown_columns(self) -> Int[Array, " u"]:
        """The columns with unknowns, in order, and -1 for padding: to a bucket, and of the holes.

        Those that only pad the basis and those that are fixed to zero are not among them.
        """
        first_hole = self.n_columns - self.n_hole_columns
        own = np.flatnonzero(self.phi_free[:first_hole])
        padding = np.full(-(len(own) + self.n_hole_columns) % _BUCKET, -1)
        holes = np.arange(first_hole, self.n_columns)
        return np.concatenate([own, padding, np.where(self.phi_free[holes], holes, -1)])

    @property
    def n_columns(self) -> int:
        """Number of padded columns."""
        return len(self.phi_free)

    @property
    def n_exterior(self) -> int:
        """Number of columns of the exterior loop; they are the first ones."""
        return int(self.singularities.previous[0]) + 1

    @property
    def n_hole_columns(self) -> int:
        """Number of padded logarithm columns; they are the last ones."""
        return len(self.singularities.hole_points)

    @property
    def n_unknowns(self) -> int:
        """Number of real unknowns, ``4 n - 10 N - 2``."""
        return 2 * int(self.phi_free.sum() + self.psi_free.sum())

    def pad(self, coefficients: Complex[Array, " n"]) -> Complex[Array, " c"]:
        """Coefficients of the domain's own columns, spread over the padded columns."""
        padded = np.zeros(self.n_columns, dtype=complex)
        padded[self.columns] = coefficients
        return padded


def build_basis(domain: Domain) -> Basis:
    """The basis of ``domain``: Cauchy coordinates of its offset cage plus one log per hole."""
    loops = domain.offset_loops_complex
    sizes = [len(loop) for loop in loops]
    vertices = np.concatenate(loops)
    rho = domain.hole_points_complex
    m, n_holes = len(vertices), len(rho)

    hole_padding = next(b for b in (*_HOLE_BUCKETS, n_holes) if b >= n_holes) - n_holes
    padding = _padding_size(m + n_holes + hole_padding, _BUCKET)
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

    return Basis(
        Singularities(
            np.concatenate([vertices, ring]),
            following,
            np.argsort(following),
            np.concatenate([rho, outside]),
        ),
        np.concatenate([np.arange(m), m + padding + np.arange(n_holes)]),
        phi_free,
        psi_free,
    )


def _padding_size(count: int, bucket: int) -> int:
    """The least padding to a multiple of ``bucket`` that is 0 or can form a loop (3 or more)."""
    padding = -count % bucket
    return padding + bucket if padding in (1, 2) else padding
