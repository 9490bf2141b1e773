"""A domain's maps as a shader takes them, in single precision."""

from typing import Any

import numpy as np

from glid_nb._arrays import Array
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap

_OTHER_VECTORS = 48  # matrices, ranges, colours and the like, beside the arrays counted below


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
