"""Meshes drawn by pythreejs. A map moves them in the shader, in the page or in the kernel."""

import math
from collections.abc import Callable
from typing import Any, Literal

import numpy as np
import pythreejs as three
import scipy.sparse
import shapely
from numpy.typing import NDArray
from PIL import Image

from glid_nb._arrays import Array
from glid_nb.figures.style import VERMILION, rgb
from glid_nb.geometry import Domain, MeshMap, Triangulation, as_points
from glid_nb.geometry.panels import Panels
from glid_nb.harmonic import as_complex
from glid_nb.imaging import PixelFrame
from glid_nb.imaging.backdrop import RGB
from glid_nb.methods.mesh.operators import MeshOperators
from glid_nb.page import ShaderMap, fragment_shader, vertex_shader
from glid_nb.widgets.overlays import N_COLORS

Uniforms = dict[str, dict[str, Any]]
EvaluatedIn = Literal["shader", "page", "kernel"]
"""Who evaluates the map at the vertices: the vertex shader, the page's script, or the kernel."""
Evaluation = Callable[[Any], tuple[Array, Array]]
"""Returns images (v, 2) of a mesh's vertices under a map, and derivatives (v, 4); float32."""

MOVED_BY_PAGE = "moved by the page"
"""The name of meshes whose vertices the page moves; ``canvas/vertices.js`` knows it too."""

_LARGEST_SIDE = 2048  # pixels of a texture; every graphics card supports this size

_BEHIND = -4.9  # height of what lies behind the shape, inside the camera's range

# Lines along curves of the undeformed shape are drawn as triangles with a width in pixels.
_PIECES_PER_SIDE = 80
_PANEL_PIECES = 2
PANEL_VERTICES = 4 * _PANEL_PIECES
_INSIDE = 0.15  # of its distance to the cage: the drawn offset cage is moved inwards by this
Ribbon = tuple[Array, Array, Array]
"""Four vertices for each piece of a curve: (v, 2) points, (t, 3) triangles, and (v, 3) the curve's
unit direction and the side, -1 or 1."""


class Layer:
    """A mesh of (v, 2) points in the undeformed shape and (t, 3) triangles, moved by a map.

    A third coordinate of the points is the height for the picture's depth test.

    The first map is ``map``. If ``mover`` is a `ShaderMap`, the shader evaluates maps; otherwise
    ``mover`` does, but with ``in_page`` only the first one: then the page moves the vertices.
    ``shader`` names the files. ``attributes`` are further arrays per vertex; bytes
    are scaled to numbers up to 1. ``uniforms`` have at most one texture, as the last one, because
    pythreejs binds all textures to the last name.
    """

    def __init__(
        self,
        shader: str,
        uniforms: Uniforms,
        mover: ShaderMap | Evaluation,
        map: Any,
        points: Array,
        triangles: Array,
        *,
        in_page: bool = False,
        **attributes: Array,
    ) -> None:
        arrays = {**_stack(points, triangles), **attributes}
        self._evaluate = None if isinstance(mover, ShaderMap) or in_page else mover
        self._name = MOVED_BY_PAGE if in_page else ""
        if isinstance(mover, ShaderMap):
            uniforms = {**mover.uniforms(map), **uniforms}
            self._vertex = vertex_shader(shader, mover)
        else:
            arrays["image"], arrays["derivatives"] = mover(map)
            self._vertex = vertex_shader(shader, None)
        self.attributes = {  # arrays per vertex by name, and the triangles
            name: three.BufferAttribute(values, normalized=values.dtype == np.uint8)
            for name, values in arrays.items()
        }
        self.n_vertices = len(points)
        self._map = map
        self._uniforms = uniforms
        self._geometry = three.BufferGeometry(attributes=self.attributes)
        self.materials: list[Any] = []  # the materials in drawing order
        self.meshes: list[Any] = []  # the drawn meshes, the lowest first
        self.draw(shader, uniforms, depth=shader == "picture")
        self.material, self.mesh = self.materials[0], self.meshes[0]

    def draw(
        self, shader: str, uniforms: Uniforms, side: str = "DoubleSide", depth: bool = False
    ) -> None:
        """Draw the mesh once more, by the fragment shader ``shader``.

        With ``depth`` the points' heights say what is in front.
        """
        material = three.ShaderMaterial(
            vertexShader=self._vertex,
            fragmentShader=fragment_shader(shader, N_COLORS),
            uniforms=uniforms,
            side=side,
            transparent=True,
            premultipliedAlpha=True,
            depthTest=depth,
            depthWrite=depth,
        )
        self.materials.append(material)
        # Culling would hide a mesh that leaves its initial bounding sphere.
        mesh = three.Mesh(self._geometry, material, frustumCulled=False, name=self._name)
        self.meshes.append(mesh)

    def set_attribute(self, name: str, values: Array) -> None:
        """Replace the values of an attribute."""
        if not np.array_equal(self.attributes[name].array, values):
            self.attributes[name].array = values

    def stack(self, points: Array, triangles: Array) -> None:
        """Replace the heights of the points and the drawing order of the triangles."""
        for name, values in _stack(points, triangles).items():
            self.set_attribute(name, values)

    def set_uniforms(self, changes: Uniforms) -> None:
        """Replace the values of some uniforms."""
        self._uniforms = self.material.uniforms = {**self._uniforms, **changes}

    def show(self, map: Any) -> None:
        """Update the vertex buffers for a map, if the kernel computes them."""
        if self._evaluate is not None and self.mesh.visible and map is not self._map:
            self._map = map
            for name, values in zip(("image", "derivatives"), self._evaluate(map), strict=True):
                self.set_attribute(name, values)

    def close(self) -> None:
        """Free the page's resources of this layer."""
        for part in (*self.attributes.values(), self._geometry, *self.materials, *self.meshes):
            part.close()


def _stack(points: Array, triangles: Array) -> dict[str, Array]:
    position = np.zeros((len(points), 3), np.float32)
    position[:, : points.shape[1]] = points
    return {"position": position, "index": triangles.astype(np.uint32).ravel()}


def comparison_layer(map: MeshMap, uniforms: Uniforms, points: Array, triangles: Array) -> Layer:
    """The picture, with the uniforms of ``picture.frag``, on the mesh of a method on a mesh."""
    layer = Layer("picture", uniforms, _evaluation_on(map.triangulation), map, points, triangles)
    # Flipped triangles show their back, and this material draws only backs.
    mark = {"mark": {"value": [*rgb([VERMILION])[0], 0.9]}, "frame": uniforms["frame"]}
    layer.draw("turned_over", mark, "BackSide")
    return layer


def _evaluation_on(mesh: Triangulation) -> Evaluation:
    """An evaluation of maps on a mesh: images of the vertices, and ``[f_z, conj(f_zbar)]`` as area
    means over the triangles of each vertex."""
    operators = MeshOperators(mesh)
    columns = np.repeat(np.arange(len(mesh.triangles)), 3)
    areas = np.repeat(operators.weights, 3)
    sums = scipy.sparse.csr_matrix((areas, (mesh.triangles.ravel(), columns)))
    mean = scipy.sparse.diags(1 / np.asarray(sums.sum(axis=1)).ravel()) @ sums

    def evaluate(map: MeshMap) -> tuple[Array, Array]:
        fz, fzb = (mean @ d for d in operators.wirtinger(as_complex(map.images)))
        derivatives = np.stack([np.real(fz), np.imag(fz), np.real(fzb), -np.imag(fzb)], axis=1)
        return map.images.astype(np.float32), derivatives.astype(np.float32)

    return evaluate


def picture_texture(image: NDArray[np.uint8]) -> Any:
    """A texture of a picture (h, w, 4), premultiplied by alpha."""
    # Mipmaps need sides that are powers of two.
    height, width = (min(1 << round(math.log2(n)), _LARGEST_SIDE) for n in image.shape[:2])
    picture = Image.fromarray(image).convert("RGBa").resize((width, height))  # bicubic
    # The first row of a DataTexture is the bottom.
    data = np.asarray(picture)[::-1].copy()
    kind = {"format": "RGBAFormat", "type": "UnsignedByteType"}
    filters = {"minFilter": "LinearMipMapLinearFilter", "magFilter": "LinearFilter"}
    return three.DataTexture(data=data, **kind, **filters, generateMipmaps=True, anisotropy=4)


class BackdropMesh:
    """A rectangle behind the shape, with a colour or an opaque picture, that no map moves."""

    def __init__(self, background: RGB | NDArray[np.uint8], frame: PixelFrame) -> None:
        (left, bottom, right, top), centre = frame.bounds, [*frame.centre, _BEHIND]
        self._texture, look = None, {}
        sides: Any = right - left, top - bottom
        if isinstance(background, tuple):
            look = {"color": f"rgb({','.join(map(str, background))})"}
        else:
            self._texture = picture_texture(background)
            look = {"map": self._texture}
        self._geometry = three.PlaneBufferGeometry(*sides)
        self._material = three.MeshBasicMaterial(depthTest=False, depthWrite=False, **look)
        self.mesh = three.Mesh(self._geometry, self._material, position=centre)

    @property
    def is_picture(self) -> bool:
        return self._texture is not None

    def close(self) -> None:
        """Free the page's resources."""
        for part in (self.mesh, self._geometry, self._material, self._texture):
            if part is not None:
                part.close()


def cage_ribbon(domain: Domain) -> Ribbon:
    """A ribbon along the cage's loops."""
    return _loops_ribbon(domain.cage.polygon, domain.cage.longer_side)


def offset_ribbon(domain: Domain) -> Ribbon:
    """A ribbon along the offset cage's loops, moved slightly towards the cage."""
    offset, shape = domain.offset_cage.polygon, domain.cage.polygon
    gap = float(shapely.distance(offset.boundary, shape.boundary))
    inner = shapely.buffer(offset, -_INSIDE * gap, join_style="mitre")
    return _loops_ribbon(inner, domain.cage.longer_side)


def panel_ribbon(panels: Panels) -> Ribbon:
    """A ribbon along the boundary's panels, with `PANEL_VERTICES` for each."""
    t = np.linspace(0.0, 1.0, _PANEL_PIECES + 1)
    points = panels.start[:, None] + (panels.end - panels.start)[:, None] * t
    return _ribbon(points[:, :-1].ravel(), points[:, 1:].ravel())


def _loops_ribbon(shape: shapely.Geometry, side: float) -> Ribbon:
    fine = shapely.segmentize(shape, side / _PIECES_PER_SIDE)
    loops = [shapely.get_coordinates(ring) @ [1, 1j] for ring in shapely.get_rings(fine)]
    starts, ends = [loop[:-1] for loop in loops], [loop[1:] for loop in loops]
    return _ribbon(np.concatenate(starts), np.concatenate(ends))


def _ribbon(start: Array, end: Array) -> Ribbon:
    along = np.repeat((end - start) / np.maximum(np.abs(end - start), 1e-300), 4)
    points = as_points(np.stack([start, start, end, end], axis=1).ravel())
    side = np.tile([-1.0, 1.0, -1.0, 1.0], len(start))
    triangles = 4 * np.arange(len(start))[:, None, None] + np.array([[0, 1, 2], [2, 1, 3]])
    ribbon = np.column_stack([as_points(along), side]).astype(np.float32)
    return points, triangles.reshape(-1, 3), ribbon
