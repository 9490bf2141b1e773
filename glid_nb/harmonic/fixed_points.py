"""A domain's maps at fixed points, in single precision, for drawing."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from glid_nb._arrays import Array
from glid_nb.geometry import Domain
from glid_nb.harmonic.basis import basis_of
from glid_nb.harmonic.points import as_complex

if TYPE_CHECKING:
    from glid_nb.harmonic.map import HarmonicMap

CHUNK = 1 << 21  # numbers at a time
MOST_KEPT = 1 << 26  # numbers, of 8 bytes each


class FixedPoints:
    """Images and derivatives of fixed points under many maps.

    With the slope s_e of phi along the edge from z_e, (D.1) is the sum over the offset cage's edges
    ``1/(2 pi i) sum_e (phi_e + (z - z_e) s_e) L_e``, its derivative ``1/(2 pi i) sum_e s_e L_e``:
    one matrix product for each map. Up to half a GB of L_e is kept, in single precision.
    """

    def __init__(self, domain: Domain, points: ArrayLike) -> None:
        self._domain, self._z = domain, as_complex(points)
        vertices, following, *_ = basis_of(domain).singularities
        own = slice(domain.n_coefficients - domain.n_holes)  # without padding
        self._vertices, self._next = np.asarray(vertices)[own], np.asarray(following)[own]
        self._kept: dict[int, Array] = {}

    def __call__(self, map: "HarmonicMap") -> tuple[Array, Array]:
        """(k, 2) images, and (k, 4) real and imaginary parts of f_z and conj(f_zbar); float32."""
        columns = np.stack([map.phi, map.psi], axis=1)
        m = len(self._vertices)
        values, holes = columns[:m] / (2j * np.pi), columns[m:]
        edges = self._vertices[self._next] - self._vertices
        slopes = (values[self._next] - values) / edges[:, None]
        nothing = np.zeros_like(holes)
        rows = [values - slopes * self._vertices[:, None], slopes, np.zeros_like(values)]
        rows = [rows, [holes, nothing, nothing], [nothing, nothing, holes]]
        factors = np.block(rows).astype(np.complex64)
        size = max(1, CHUNK // len(factors))
        images, derivatives = [], []
        for start in range(0, len(self._z), size):
            z = self._z[start : start + size, None]
            fixed, by_edges, by_holes = np.split(self._matrix(start, z) @ factors, 3, axis=1)
            value = fixed + z * by_edges
            images.append(value[:, 0] + np.conj(value[:, 1]))
            derivatives.append(by_edges + by_holes)
        image = np.concatenate(images).astype(np.complex64).view(np.float32).reshape(-1, 2)
        return image, np.concatenate(derivatives).view(np.float32)

    def _matrix(self, start: int, z: Array) -> Array:
        """Columns ``L_e = Log(B_{e+1} / B_e)``, ``ln|z - rho|``, ``1 / (z - rho)`` of a chunk."""
        if (known := self._kept.get(start)) is not None:
            return known
        b = self._vertices - z
        # Round after the division, so that a ratio near 1 keeps its logarithm's absolute accuracy.
        ratio = (b[:, self._next] / b).astype(np.complex64)
        logarithms = np.log(np.abs(ratio)) + 1j * np.arctan2(ratio.imag, ratio.real)
        away = z - self._domain.hole_points_complex
        parts = [logarithms, np.log(np.abs(away)), 1 / away]
        result = np.concatenate([part.astype(np.complex64) for part in parts], axis=1)
        if start * result.shape[1] + result.size <= MOST_KEPT:
            self._kept[start] = result
        return result
