"""A domain's maps in single precision, for drawing: at fixed points, and as data for a shader."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from glid_nb._arrays import Array
from glid_nb.geometry import Domain
from glid_nb.harmonic.map import HarmonicMap, as_complex, basis_of

_CHUNK = 1 << 21  # numbers at a time
_MOST_KEPT = 1 << 26  # numbers, of 8 bytes each
_OTHER_VECTORS = 48  # for matrices, ranges, colours and the like


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

    def __call__(self, map: HarmonicMap) -> tuple[Array, Array]:
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
        size = max(1, _CHUNK // len(factors))
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
        if start * result.shape[1] + result.size <= _MOST_KEPT:
            self._kept[start] = result
        return result


class ShaderMap:
    """A domain as data for the shader ``harmonic.glsl``: its offset cage and hole points."""

    def __init__(self, domain: Domain) -> None:
        self.domain = domain
        loops = domain.offset_cage.loops_complex
        starts = np.cumsum([0, *map(len, loops)])
        # Each loop as a chain that begins with its last vertex.
        sizes = zip(starts, map(len, loops), strict=False)
        chains = [start + np.arange(-1, size) % size for start, size in sizes]
        self._index = np.concatenate(chains)
        inverse_edges = [np.concatenate([[0j], 1 / (p - np.roll(p, 1))]) for p in loops]
        vertices = np.concatenate(loops)[self._index]
        chain = _vectors(vertices, np.concatenate(inverse_edges))
        self.cage = _padded(chain, [*vertices[-1:].view(float), 0, 0])
        """(c, 4) float32: a vertex, and 1 over the edge that leads to it; 0 where none does."""
        self.n_chain = len(self.cage)  # vertices of the chain
        self._far = [1e3 * float(np.abs(vertices).max()), 0, 0, 0]
        self.n_holes = len(_padded(np.zeros((domain.n_holes, 4)), self._far))
        """Holes of the shader, also unused ones."""

    def fits(self, vectors: int) -> bool:
        """Whether a vertex shader with so many vectors of uniforms can hold the domain."""
        return 2 * self.n_chain + self.n_holes + _OTHER_VECTORS <= vectors

    def coefficients(self, map: HarmonicMap) -> tuple[Array, Array]:
        """The data of a frame: (c, 4) phi and psi, (h, 4) hole points and phi."""
        n = map.domain.n_coefficients
        chain = _vectors(map.phi[self._index], map.psi[self._index])
        holes = _vectors(self.domain.hole_points_complex, map.phi[n - self.domain.n_holes :])
        return _padded(chain, [0, 0, 0, 0]), _padded(holes, self._far)

    def wire(self, map: HarmonicMap) -> bytes:
        """The coefficients as bytes for the page: little-endian float32, one after the other."""
        parts = self.coefficients(map)
        return b"".join(part.astype("<f4").tobytes() for part in parts)

    def defines(self) -> str:
        """Definitions to put before ``harmonic.glsl``."""
        return f"#define N_CHAIN {self.n_chain}\n#define N_HOLES {self.n_holes}\n"

    def uniforms(self, map: HarmonicMap) -> dict[str, dict[str, Any]]:
        coefficients, holes = self.coefficients(map)
        values = {"cage": self.cage, "coefficients": coefficients, "holes": holes}
        return {name: {"value": value.ravel().tolist()} for name, value in values.items()}


def _padded(vectors: Array, filling: Any) -> Array:
    """At least two vectors, but not four: pythreejs misreads arrays of 4 and of 16 numbers."""
    wanted = {0: 2, 1: 2, 4: 5}.get(len(vectors), len(vectors))
    extra = np.tile(np.asarray(filling, dtype=np.float32), (wanted - len(vectors), 1))
    return np.concatenate([vectors.astype(np.float32), extra])


def _vectors(first: Array, second: Array) -> Array:
    """(n, 4) float32: real and imaginary parts of two complex arrays, which must be finite."""
    parts = [np.real(first), np.imag(first), np.real(second), np.imag(second)]
    return np.stack(parts, axis=1).astype(np.float32)
