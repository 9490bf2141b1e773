"""What pythreejs draws: the picture on its mesh, and lines along the boundary.

Only this module, `comparison_layer` and `picture_texture` know pythreejs.
"""

from __future__ import annotations

import functools
from typing import Any, Literal

import numpy as np
import pythreejs as three
from numpy.typing import NDArray

from glid_nb.energies import Energy
from glid_nb.figures.style import BLUE, GREY
from glid_nb.geometry import Triangulation, triangulate, uniform_boundary_samples
from glid_nb.geometry.panels import Panels
from glid_nb.harmonic import FixedPoints, HarmonicMap
from glid_nb.imaging import PixelFrame
from glid_nb.methods import MeshMap
from glid_nb.widgets.comparison_layer import ComparisonLayer
from glid_nb.widgets.overlays import (
    FULL_MARGIN,
    N_COLORS,
    OVERLAYS,
    color_range,
    color_stops,
    energy_kind,
    margin_stops,
)
from glid_nb.widgets.picture_texture import picture_texture
from glid_nb.widgets.ribbons import (
    Ribbon,
    cage_ribbon,
    offset_ribbon,
    panel_ribbon,
    panel_values,
)
from glid_nb.widgets.shader import UNIFORM_VECTORS, ShaderMap, glsl

Array = NDArray[Any]
EvaluatedIn = Literal["shader", "kernel"]

N_VERTICES = 10_000
"""Vertices of the picture's mesh, by default."""

_RANGE_SAMPLES = 256  # of the boundary, where distortion is largest
_GRID_LINES = 40  # along the longer side
_COLUMN = 8.0  # of triangles that are drawn after one another: width in rows' heights
_CAGE_WIDTH, _OFFSET_WIDTH, _PANEL_WIDTH = 0.9, 0.6, 2.8  # half, in pixels


class Layer:
    """A mesh whose vertices the map moves.

    Parameters
    ----------
    points : (v, 2) array
        Places in the undeformed shape.
    triangles : (t, 3) array
    attributes : dict
        Further arrays per vertex.
    shaders : (str, str)
        Names of the vertex and the fragment shader.
    uniforms : dict
        Uniforms beside those of the map. At most one texture, and that last: pythreejs binds every
        texture to the last name.
    """

    def __init__(
        self,
        points: Array,
        triangles: Array,
        attributes: dict[str, Any],
        shaders: tuple[str, str],
        uniforms: dict[str, dict[str, Any]],
        shader_map: ShaderMap,
        map: HarmonicMap,
        evaluated_in: EvaluatedIn,
    ) -> None:
        self._points, self._in_kernel = points, evaluated_in == "kernel"
        self._fixed_points = FixedPoints(map.domain, points)
        self._evaluated_map: HarmonicMap | None = None
        flat = np.concatenate([points, np.zeros((len(points), 1))], axis=1).astype(np.float32)
        arrays = {
            "position": three.BufferAttribute(flat, normalized=False),
            "index": three.BufferAttribute(triangles.astype(np.uint32).ravel(), normalized=False),
            **attributes,
        }
        if self._in_kernel:
            image, derivatives = self._evaluated(map)
            arrays["image"] = three.BufferAttribute(image, normalized=False)
            arrays["derivatives"] = three.BufferAttribute(derivatives, normalized=False)
            head = glsl("image_buffer.glsl")
        else:
            uniforms = {**shader_map.uniforms(map), **uniforms}
            head = shader_map.defines() + glsl("harmonic.glsl")
        colors = f"#define N_COLORS {N_COLORS}\n"
        self.attributes = arrays
        self._uniforms = uniforms
        self.material = three.ShaderMaterial(
            vertexShader=head + glsl(shaders[0]),
            fragmentShader=colors + glsl(shaders[1]),
            uniforms=uniforms,
            side="DoubleSide",
            transparent=True,
            premultipliedAlpha=True,
            depthTest=False,
            depthWrite=False,
        )
        geometry = three.BufferGeometry(attributes=arrays)
        # A mesh that grows out of its first bounding sphere would vanish.
        self.mesh = three.Mesh(geometry, self.material, frustumCulled=False)

    @property
    def n_vertices(self) -> int:
        """Vertices of the mesh."""
        return len(self._points)

    def show_map(self, map: HarmonicMap) -> None:
        """Bring the vertex buffers up to date, where the kernel computes them."""
        if self._in_kernel and self.mesh.visible and map is not self._evaluated_map:
            image, derivatives = self._evaluated(map)
            self.attributes["image"].array = image
            self.attributes["derivatives"].array = derivatives

    def set_uniforms(self, changes: dict[str, Any]) -> None:
        """Give some uniforms other values."""
        new = {
            name: {**u, "value": changes.get(name, u["value"])}
            for name, u in self._uniforms.items()
        }
        self._uniforms = self.material.uniforms = new

    def close(self) -> None:
        """Free what the page holds of this layer."""
        for attribute in self.attributes.values():
            attribute.close()
        self.mesh.geometry.close()
        self.material.close()
        self.mesh.close()

    def _evaluated(self, map: HarmonicMap) -> tuple[Array, Array]:
        self._evaluated_map = map
        return self._fixed_points(map)


class Scene:
    """The picture and the lines of one domain, under one map.

    Parameters
    ----------
    image : (h, w, 4) uint8 array
        Straight alpha.
    map : HarmonicMap
        The first map; its domain is the scene's.
    energy : Energy
        For the overlay that shows its density.
    n_vertices : int
        Vertices of the picture's mesh.
    evaluated_in : "shader" or "kernel", optional
        Who computes the vertices; by default the shader where it can hold the domain.
    uniform_vectors : int
        What the page's shaders hold.
    """

    def __init__(
        self,
        image: Array,
        map: HarmonicMap,
        energy: Energy,
        n_vertices: int = N_VERTICES,
        evaluated_in: EvaluatedIn | None = None,
        uniform_vectors: int = UNIFORM_VECTORS,
    ) -> None:
        domain = map.domain
        self.domain = domain
        self.shader_map = ShaderMap(domain)
        fits = self.shader_map.fits(uniform_vectors)
        if evaluated_in is None:
            evaluated_in = "shader" if fits else "kernel"
        self.evaluated_in: EvaluatedIn = evaluated_in
        self._energy, self._overlay = energy, "texture"
        self.color_range = color_range("texture", energy)
        """The values at the ends of the overlay's colour map."""
        self.map = map
        height, width = image.shape[:2]
        self.frame = PixelFrame(width, height)
        self._texture = picture_texture(image)
        mesh = triangulate(domain.cage, n_vertices)
        self.picture = self._layer(
            mesh.vertices,
            drawing_order(mesh),
            {},
            ("picture.vert", "picture.frag"),
            {**self._picture_uniforms(), "map": {"value": self._texture}},
        )
        self.cage: Layer | None = None
        """The cage's line, once it has been shown."""
        self.offset_cage: Layer | None = None
        self.comparison: ComparisonLayer | None = None
        self._replaced: list[ComparisonLayer] = []
        self.panels: Layer | None = None
        self._panels: Panels | None = None

    @property
    def layers(self) -> tuple[Layer, ...]:
        """All layers, the lowest first."""
        lines = (self.cage, self.offset_cage, self.panels)
        return (self.picture, *(line for line in lines if line is not None))

    @property
    def meshes(self) -> list[Any]:
        """What is drawn, the lowest first: the layers, or the comparison in their place."""
        if self.comparison is not None:
            return self.comparison.meshes
        return [layer.mesh for layer in self.layers]

    @property
    def materials(self) -> list[Any]:
        """The materials of what is drawn."""
        if self.comparison is not None:
            return self.comparison.materials
        return [layer.material for layer in self.layers]

    def show_comparison(self, map: MeshMap | None) -> bool:
        """A map of a mesh in place of the layers, or these again; whether other meshes are drawn.

        What is drawn no longer must be closed when the page has let go of it: see
        `close_replaced`.
        """
        shown = self.comparison
        if map is None:
            self.comparison = None
        elif shown is not None and shown.triangulation is map.triangulation:
            shown.show(map)
        else:
            self.comparison = ComparisonLayer(
                map, {**self._picture_uniforms(), "map": {"value": self._texture}}
            )
        if shown is self.comparison:
            return False
        if shown is not None:
            self._replaced.append(shown)
        return True

    def close_replaced(self) -> None:
        """Free comparisons that are no longer drawn."""
        while self._replaced:
            self._replaced.pop().close()

    def show_map(self, map: HarmonicMap) -> None:
        """Another map; where the shader evaluates it, the page does the rest."""
        self.map = map
        for layer in self.layers:
            layer.show_map(map)

    def show_overlay(self, name: str, energy: Energy) -> None:
        """Another way to colour the shape."""
        if (name, energy) != (self._overlay, self._energy):
            self._overlay, self._energy = name, energy
            self.color_range = self._fitted_range()
            self._set_overlay()

    def fit_range(self, *, widen_only: bool) -> bool:
        """Fit the ends of the colour map to the map; whether they changed."""
        if OVERLAYS[self._overlay].number < 2:
            return False
        fitted = self._fitted_range(self.color_range if widen_only else None)
        if fitted == self.color_range:
            return False
        self.color_range = fitted
        self._set_overlay()
        return True

    def _fitted_range(self, least: tuple[float, float] | None = None) -> tuple[float, float]:
        if OVERLAYS[self._overlay].number < 2:
            return color_range(self._overlay, self._energy)
        fz, fzb = self.map.wirtinger(self._range_points)
        return color_range(self._overlay, self._energy, fz, fzb, least)

    @functools.cached_property
    def _range_points(self) -> NDArray[Any]:
        return uniform_boundary_samples(self.domain.cage, _RANGE_SAMPLES).points

    def _set_overlay(self) -> None:
        changes = {k: u["value"] for k, u in self._picture_uniforms().items()}
        self.picture.set_uniforms(changes)
        if self.comparison is not None:
            self.comparison.set_uniforms(changes)

    def show_lines(self, cage: bool, offset_cage: bool) -> bool:
        """Whether the cage and the offset cage are drawn; whether there is another layer now."""
        before = len(self.layers)
        if cage and self.cage is None:
            self.cage = self._line(cage_ribbon(self.domain), BLUE, 0.9, _CAGE_WIDTH)
        if offset_cage and self.offset_cage is None:
            self.offset_cage = self._line(offset_ribbon(self.domain), GREY, 0.9, _OFFSET_WIDTH)
        for layer, visible in ((self.cage, cage), (self.offset_cage, offset_cage)):
            if layer is not None and layer.mesh.visible != visible:
                layer.mesh.visible = visible
                layer.show_map(self.map)
        return len(self.layers) > before

    def show_panels(self, panels: Panels | None, sigma2_lower: Array) -> bool:
        """The boundary's panels coloured by margin, or none; whether there is another layer now."""
        if panels is None:
            if self.panels is not None:
                self.panels.mesh.visible = False
            return False
        margin = np.clip(np.nan_to_num(sigma2_lower) / FULL_MARGIN, 0.0, 1.0)
        values = panel_values(np.rint(255 * (1 - margin)).astype(np.uint8))
        if panels is self._panels and self.panels is not None:
            self.panels.attributes["margin"].array = values
            self.panels.mesh.visible = True
            return False
        if self.panels is not None:
            self.panels.close()
        attribute = three.BufferAttribute(values, normalized=True)
        self.panels = self._line(panel_ribbon(panels), GREY, 1.0, _PANEL_WIDTH, attribute)
        self._panels = panels
        return True

    def close(self) -> None:
        """Free what the page holds."""
        self.close_replaced()
        for layer in (*self.layers, *([self.comparison] if self.comparison else [])):
            layer.close()
        self._texture.close()

    def _layer(
        self,
        points: Array,
        triangles: Array,
        attributes: dict[str, Any],
        shaders: tuple[str, str],
        uniforms: dict[str, dict[str, Any]],
    ) -> Layer:
        domain = (self.shader_map, self.map, self.evaluated_in)
        return Layer(points, triangles, attributes, shaders, uniforms, *domain)

    def _line(
        self,
        line: Ribbon,
        color: str,
        opacity: float,
        half_width: float,
        margin: three.BufferAttribute | None = None,
    ) -> Layer:
        """A line of one colour, or coloured by margin with borders of it where there is one."""
        by_margin = 0.0 if margin is None else 1.0
        if margin is None:
            values = np.zeros(len(line.points), dtype=np.uint8)
            margin = three.BufferAttribute(values, normalized=True)
        rgb = [int(color[i : i + 2], 16) / 255 for i in (1, 3, 5)]
        return self._layer(
            line.points,
            line.triangles,
            {
                "ribbon": three.BufferAttribute(line.ribbon, normalized=False),
                "margin": margin,
            },
            ("ribbon.vert", "ribbon.frag"),
            {
                "pixel": {"value": 0.02},
                "half_width": {"value": half_width},
                "line_color": {"value": [*rgb, opacity]},
                "by_margin": {"value": by_margin},
                "colors": {"value": margin_stops().ravel().tolist()},
            },
        )

    def _picture_uniforms(self) -> dict[str, dict[str, Any]]:
        xmin, ymin, xmax, ymax = self.frame.bounds
        kind = energy_kind(self._energy)
        # The shader cannot know a user's own function; the picture is shown instead.
        unknown = self._overlay == "energy" and kind is None
        number = 0 if unknown else OVERLAYS[self._overlay].number
        return {
            "frame": {"value": [xmin, ymin, xmax - xmin, ymax - ymin]},
            "overlay": {"value": float(number)},
            "energy": {"value": list(kind or (0.0, 1.0))},
            "color_range": {"value": list(self.color_range)},
            "colors": {"value": color_stops().ravel().tolist()},
            "pixel": {"value": 0.02},
            "grid_spacing": {"value": self.domain.cage.longer_side / _GRID_LINES},
        }


def drawing_order(mesh: Triangulation) -> Array:
    """The triangles row by row within columns of some vertices' width.

    A vertex costs the shader a sum over the cage, and whatever draws remembers the results of the
    last few only. In this order a row's vertices are still known when the next row needs them, so
    each is shaded little more than once.
    """
    rows = np.unique(np.round(mesh.vertices[mesh.n_boundary :, 1], 9))
    if len(rows) < 2:
        return mesh.triangles
    width = _COLUMN * float(np.median(np.diff(rows)))
    x, y = mesh.vertices[mesh.triangles].mean(axis=1).T
    return mesh.triangles[np.lexsort((x, np.searchsorted(rows, y), np.floor(x / width)))]


def renderer(scene: Scene, width: int, height: int) -> tuple[Any, Any]:
    """A pythreejs renderer of a scene, and its camera, whose frame the page sets."""
    camera = three.OrthographicCamera(-10, 10, 10, -10, 0, 10, position=[0, 0, 5])
    root = three.Scene(children=[layer.mesh for layer in scene.layers], background=None)
    view = three.Renderer(
        camera=camera,
        scene=root,
        controls=[],
        width=width,
        height=height,
        antialias=True,
        alpha=True,
        background_opacity=0,
        clearOpacity=0,
        sortObject=False,
    )
    return view, camera
