"""The picture on a triangle mesh that another method has moved, and where that folds."""

from __future__ import annotations

from typing import Any

import numpy as np
import pythreejs as three
import scipy.sparse
from numpy.typing import NDArray

from glid_nb.figures.style import VERMILION
from glid_nb.harmonic import as_complex
from glid_nb.methods import MeshMap
from glid_nb.methods.mesh.operators import MeshOperators
from glid_nb.widgets.overlays import N_COLORS
from glid_nb.widgets.shader import glsl

Array = NDArray[Any]

_BLENDING: dict[str, Any] = {
    "transparent": True,
    "premultipliedAlpha": True,
    "depthTest": False,
    "depthWrite": False,
}


class ComparisonLayer:
    """A textured mesh; triangles that are turned over lie on top of it in one colour.

    Parameters
    ----------
    map : MeshMap
        The first map; those that follow are of the same triangulation.
    uniforms : dict
        Those of ``picture.frag``, the texture last.
    """

    def __init__(self, map: MeshMap, uniforms: dict[str, dict[str, Any]]) -> None:
        self.triangulation = mesh = map.triangulation
        self._operators = MeshOperators(mesh)
        self._mean = _mean_over_neighbours(mesh.triangles, self._operators.weights)
        flat = np.concatenate([mesh.vertices, np.zeros((len(mesh.vertices), 1))], axis=1)
        image, derivatives = self._evaluated(map)
        self._attributes = {
            name: three.BufferAttribute(values, normalized=False)
            for name, values in (
                ("position", flat.astype(np.float32)),
                ("index", map.layered.astype(np.uint32).ravel()),
                ("image", image),
                ("derivatives", derivatives),
            )
        }
        self._uniforms = uniforms
        vertex = glsl("image_buffer.glsl") + glsl("picture.vert")
        self._picture = three.ShaderMaterial(
            vertexShader=vertex,
            fragmentShader=f"#define N_COLORS {N_COLORS}\n" + glsl("picture.frag"),
            uniforms=uniforms,
            side="DoubleSide",
            **_BLENDING,
        )
        # Seen from their back, which is all that this material draws.
        color = [int(VERMILION[i : i + 2], 16) / 255 for i in (1, 3, 5)]
        self._mark = three.ShaderMaterial(
            vertexShader=vertex,
            fragmentShader=glsl("turned_over.frag"),
            uniforms={"mark": {"value": [*color, 0.9]}, "frame": uniforms["frame"]},
            side="BackSide",
            **_BLENDING,
        )
        self._geometry = three.BufferGeometry(attributes=self._attributes)
        # A mesh that grows out of its first bounding sphere would vanish.
        self.meshes = [
            three.Mesh(self._geometry, material, frustumCulled=False) for material in self.materials
        ]
        """What is drawn, the lowest first."""

    @property
    def materials(self) -> list[Any]:
        """Of the picture, and of what is turned over."""
        return [self._picture, self._mark]

    def show(self, map: MeshMap) -> None:
        """Another map of the same triangulation."""
        image, derivatives = self._evaluated(map)
        self._attributes["image"].array = image
        self._attributes["derivatives"].array = derivatives

    def set_uniforms(self, changes: dict[str, Any]) -> None:
        """Give some of the picture's uniforms other values."""
        self._uniforms = self._picture.uniforms = {
            name: {**u, "value": changes.get(name, u["value"])}
            for name, u in self._uniforms.items()
        }

    def close(self) -> None:
        """Free what the page holds of this layer."""
        for part in (*self._attributes.values(), self._geometry, *self.materials, *self.meshes):
            part.close()

    def _evaluated(self, map: MeshMap) -> tuple[Array, Array]:
        """Images of the vertices, and ``[f_z, conj(f_zbar)]`` averaged over their triangles."""
        fz, fzb = (self._mean @ d for d in self._operators.wirtinger(as_complex(map.images)))
        derivatives = np.stack([np.real(fz), np.imag(fz), np.real(fzb), -np.imag(fzb)], axis=1)
        return map.images.astype(np.float32), derivatives.astype(np.float32)


def _mean_over_neighbours(triangles: Array, areas: Array) -> Any:
    """(v, t) sparse: the mean over a vertex's triangles, weighted by their areas."""
    columns = np.repeat(np.arange(len(triangles)), 3)
    sums = scipy.sparse.csr_matrix((np.repeat(areas, 3), (triangles.ravel(), columns)))
    return scipy.sparse.diags(1 / np.asarray(sums.sum(axis=1)).ravel()) @ sums
