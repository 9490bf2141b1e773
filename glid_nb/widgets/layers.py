"""Meshes that pythreejs draws: moved by a harmonic map in the shader or in the kernel, or given.

Only this module and `scene` know pythreejs.
"""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np
import pythreejs as three
import scipy.sparse
from numpy.typing import NDArray
from PIL import Image

from glid_nb.figures.style import VERMILION
from glid_nb.geometry import MeshMap
from glid_nb.harmonic import FixedPoints, HarmonicMap, as_complex
from glid_nb.methods.mesh.operators import MeshOperators
from glid_nb.widgets.overlays import N_COLORS, rgb
from glid_nb.widgets.shader import ShaderMap, fragment_shader, glsl

Array = NDArray[Any]
Uniforms = dict[str, dict[str, Any]]
EvaluatedIn = Literal["shader", "kernel"]

_LARGEST_SIDE = 2048  # pixels of a texture, which every graphics card can hold


def attribute(values: Array, *, normalized: bool = False) -> Any:
    """An array per vertex as a shader takes it; ``normalized`` makes bytes numbers up to 1."""
    return three.BufferAttribute(values, normalized=normalized)


class Layer:
    """A mesh of (v, 2) points in the undeformed shape and (t, 3) triangles, with its material.

    ``attributes`` are further ones per vertex, made by :func:`attribute`; ``vertex`` and
    ``fragment`` the shaders. ``uniforms`` have at most one texture, as the last item: pythreejs
    binds every texture to the last name.
    """

    def __init__(
        self,
        points: Array,
        triangles: Array,
        attributes: dict[str, Any],
        vertex: str,
        fragment: str,
        uniforms: Uniforms,
    ) -> None:
        flat = np.concatenate([points, np.zeros((len(points), 1))], axis=1)
        self.attributes = {
            "position": attribute(flat.astype(np.float32)),
            "index": attribute(triangles.astype(np.uint32).ravel()),
            **attributes,
        }
        """What there is per vertex, by name, and the triangles."""
        self.n_vertices = len(points)
        self._uniforms = uniforms
        self._geometry = three.BufferGeometry(attributes=self.attributes)
        self.material = _material(vertex, fragment, uniforms)
        self.mesh = _mesh(self._geometry, self.material)

    @property
    def materials(self) -> list[Any]:
        """The materials in drawing order."""
        return [self.material]

    @property
    def meshes(self) -> list[Any]:
        """What is drawn, the lowest first."""
        return [self.mesh]

    def set_uniforms(self, changes: dict[str, Any]) -> None:
        """Give some uniforms other values."""
        self._uniforms = self.material.uniforms = {
            name: {**u, "value": changes.get(name, u["value"])}
            for name, u in self._uniforms.items()
        }

    def close(self) -> None:
        """Free what the page holds of this layer."""
        parts = (*self.attributes.values(), self._geometry, *self.materials, *self.meshes)
        for part in parts:
            part.close()

    def _move(self, image: Array, derivatives: Array) -> None:
        self.attributes["image"].array = image
        self.attributes["derivatives"].array = derivatives


class MapLayer(Layer):
    """A mesh whose vertices a harmonic map moves, at first ``map``.

    As :class:`Layer`, without the map's attributes and uniforms; ``shaders`` names the vertex and
    the fragment shader.
    """

    def __init__(
        self,
        points: Array,
        triangles: Array,
        attributes: dict[str, Any],
        shaders: tuple[str, str],
        uniforms: Uniforms,
        shader_map: ShaderMap,
        map: HarmonicMap,
        evaluated_in: EvaluatedIn,
    ) -> None:
        self._in_kernel = evaluated_in == "kernel"
        self._fixed_points = FixedPoints(map.domain, points)
        self._evaluated_map = map
        if self._in_kernel:
            attributes = {**attributes, **_moved(*self._fixed_points(map))}
            head = glsl("image_buffer.glsl")
        else:
            uniforms = {**shader_map.uniforms(map), **uniforms}
            head = shader_map.defines() + glsl("harmonic.glsl")
        vertex, fragment = head + glsl(shaders[0]), fragment_shader(shaders[1])
        super().__init__(points, triangles, attributes, vertex, fragment, uniforms)

    def show_map(self, map: HarmonicMap) -> None:
        """Bring the vertex buffers up to date, where the kernel computes them."""
        if self._in_kernel and self.mesh.visible and map is not self._evaluated_map:
            self._evaluated_map = map
            self._move(*self._fixed_points(map))


class ComparisonLayer(Layer):
    """The picture on a mesh that another method moves; turned-over triangles have one colour.

    All maps are of one triangulation; ``uniforms`` are those of ``picture.frag``.
    """

    def __init__(self, map: MeshMap, uniforms: Uniforms) -> None:
        self.triangulation = mesh = map.triangulation
        self._operators = MeshOperators(mesh)
        self._mean = _mean_over_neighbours(mesh.triangles, self._operators.weights)
        vertex = glsl("image_buffer.glsl") + glsl("picture.vert")
        moved = _moved(*self._evaluated(map))
        fragment = fragment_shader("picture.frag")
        super().__init__(mesh.vertices, map.layered, moved, vertex, fragment, uniforms)
        # Turned-over triangles show their back, and this material draws only backs.
        mark: Uniforms = {
            "mark": {"value": [*rgb([VERMILION])[0], 0.9]},
            "frame": uniforms["frame"],
        }
        self._mark = _material(vertex, glsl("turned_over.frag"), mark, side="BackSide")
        self._marked = _mesh(self._geometry, self._mark)

    @property
    def materials(self) -> list[Any]:
        """The materials of the picture and of turned-over triangles."""
        return [self.material, self._mark]

    @property
    def meshes(self) -> list[Any]:
        """What is drawn, the lowest first."""
        return [self.mesh, self._marked]

    def show(self, map: MeshMap) -> None:
        """Another map of the same triangulation."""
        self._move(*self._evaluated(map))

    def _evaluated(self, map: MeshMap) -> tuple[Array, Array]:
        """Images of the vertices, and ``[f_z, conj(f_zbar)]`` averaged over their triangles."""
        fz, fzb = (self._mean @ d for d in self._operators.wirtinger(as_complex(map.images)))
        derivatives = np.stack([np.real(fz), np.imag(fz), np.real(fzb), -np.imag(fzb)], axis=1)
        return map.images.astype(np.float32), derivatives.astype(np.float32)


def picture_texture(image: NDArray[np.uint8]) -> Any:
    """A texture of a picture (h, w, 4), premultiplied by alpha.

    Its sides are the nearest powers of two, which three.js needs for mipmaps.
    """
    height, width = (min(1 << round(math.log2(n)), _LARGEST_SIDE) for n in image.shape[:2])
    picture = (
        Image.fromarray(image).convert("RGBa").resize((width, height), Image.Resampling.BICUBIC)
    )
    # A DataTexture begins at the bottom.
    pixels = np.frombuffer(picture.tobytes(), dtype=np.uint8).reshape(height, width, 4)
    return three.DataTexture(
        data=np.ascontiguousarray(pixels[::-1]),
        format="RGBAFormat",
        type="UnsignedByteType",
        minFilter="LinearMipMapLinearFilter",
        magFilter="LinearFilter",
        generateMipmaps=True,
        anisotropy=4,
    )


def _moved(image: Array, derivatives: Array) -> dict[str, Any]:
    """The attributes of ``image_buffer.glsl``."""
    return {"image": attribute(image), "derivatives": attribute(derivatives)}


def _material(vertex: str, fragment: str, uniforms: Uniforms, side: str = "DoubleSide") -> Any:
    return three.ShaderMaterial(
        vertexShader=vertex,
        fragmentShader=f"#define N_COLORS {N_COLORS}\n{glsl('colors.glsl')}\n{fragment}",
        uniforms=uniforms,
        side=side,
        transparent=True,
        premultipliedAlpha=True,
        depthTest=False,
        depthWrite=False,
    )


def _mesh(geometry: Any, material: Any) -> Any:
    # Culling would hide a mesh that leaves its first bounding sphere.
    return three.Mesh(geometry, material, frustumCulled=False)


def _mean_over_neighbours(triangles: Array, areas: Array) -> Any:
    """(v, t) sparse: the mean over a vertex's triangles, weighted by their areas."""
    columns = np.repeat(np.arange(len(triangles)), 3)
    sums = scipy.sparse.csr_matrix((np.repeat(areas, 3), (triangles.ravel(), columns)))
    return scipy.sparse.diags(1 / np.asarray(sums.sum(axis=1)).ravel()) @ sums
