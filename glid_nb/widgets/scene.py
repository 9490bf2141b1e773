"""What is drawn of one domain: the picture on its mesh, and lines along the boundary."""

from __future__ import annotations

import functools
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
import pythreejs as three
from numpy.typing import NDArray

from glid_nb.energies import Energy, SymmetricDirichlet
from glid_nb.figures.style import BLUE, GREY
from glid_nb.geometry import MeshMap, Triangulation, triangulate, uniform_panels
from glid_nb.geometry.panels import Panels
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import PixelFrame
from glid_nb.solvers import DeformationMap
from glid_nb.widgets.layers import (
    ComparisonLayer,
    EvaluatedIn,
    Layer,
    MapLayer,
    attribute,
    picture_texture,
)
from glid_nb.widgets.overlays import (
    FULL_MARGIN,
    OVERLAYS,
    color_range,
    color_stops,
    margin_stops,
    rgb,
)
from glid_nb.widgets.ribbons import (
    Ribbon,
    cage_ribbon,
    offset_ribbon,
    panel_ribbon,
    panel_values,
)
from glid_nb.widgets.shader import UNIFORM_VECTORS, ShaderMap, energy_uniform

Array = NDArray[Any]
Range = Literal["keep", "widen", "fit"]

N_VERTICES = 10_000
"""Vertices of the picture's mesh, by default."""

_RANGE_SAMPLES = 256  # of the boundary, where distortion is largest
_GRID_LINES = 40  # along the longer side
_COLUMN = 8.0  # width of a column of triangles in drawing order, in heights of a row
_CAGE_WIDTH, _OFFSET_WIDTH, _PANEL_WIDTH = 0.9, 0.6, 2.8  # half, in pixels


_NO_POINTS = np.empty((0, 2))


@dataclass(frozen=True, eq=False)
class Drawing:
    """Everything that is seen of a deformation at one moment."""

    map: HarmonicMap
    comparison: MeshMap | None = None
    """A map of a mesh, drawn in place of the harmonic one."""
    targets: Array = field(default_factory=lambda: _NO_POINTS)
    """(h, 2) where the handles should go."""
    images: Array = field(default_factory=lambda: _NO_POINTS)
    """(h, 2) where they are."""
    selected: tuple[int, ...] = ()
    """Indices of selected handles."""
    overlay: str = "texture"
    """One of :data:`~glid_nb.widgets.overlays.OVERLAYS`."""
    energy: Energy = field(default_factory=SymmetricDirichlet)
    """Whose density the overlay "energy" shows."""
    color_range: Range = "fit"
    """Whether the range of the overlay's colour map is kept, only widened, or fitted."""
    cage: bool = False
    """Whether the cage is drawn."""
    offset_cage: bool = False
    """Whether the offset cage is drawn."""
    panels: tuple[Panels, Array] | None = None
    """The boundary's panels and the certified sigma_2 on each, where they are drawn."""

    @property
    def shown(self) -> DeformationMap:
        """What moves the picture."""
        return self.map if self.comparison is None else self.comparison


class Scene:
    """The picture and the lines of one domain, under one map; at first ``map``.

    The image is (h, w, 4) uint8 with straight alpha; its mesh has about ``n_vertices``. By default
    the shader computes the vertices if ``uniform_vectors`` suffice for the domain.
    """

    def __init__(
        self,
        image: Array,
        map: HarmonicMap,
        n_vertices: int = N_VERTICES,
        evaluated_in: EvaluatedIn | None = None,
        uniform_vectors: int = UNIFORM_VECTORS,
    ) -> None:
        self.domain = map.domain
        self.map = map
        self.shader_map = ShaderMap(self.domain)
        if evaluated_in is None:
            evaluated_in = "shader" if self.shader_map.fits(uniform_vectors) else "kernel"
        self.evaluated_in: EvaluatedIn = evaluated_in
        self._overlay, self._energy = "texture", Drawing(map).energy
        self.color_range = color_range(self._overlay, self._energy)
        """The values at the ends of the overlay's colour map."""
        height, width = image.shape[:2]
        self.frame = PixelFrame(width, height)
        self._texture = picture_texture(image)
        mesh = triangulate(self.domain.cage, n_vertices)
        self.picture = self._layer(
            mesh.vertices, drawing_order(mesh), {}, "picture", self._textured_uniforms()
        )
        self.cage: MapLayer | None = None
        """The cage's line, once it has been shown."""
        self.offset_cage: MapLayer | None = None
        self.panels: MapLayer | None = None
        self._panels: Panels | None = None
        self.comparison: ComparisonLayer | None = None
        self._replaced: list[Layer] = []

    @property
    def layers(self) -> tuple[MapLayer, ...]:
        """All layers that the map moves, the lowest first."""
        lines = (self.cage, self.offset_cage, self.panels)
        return (self.picture, *(line for line in lines if line is not None))

    @property
    def drawn(self) -> tuple[Layer, ...]:
        """What is drawn, the lowest first: the layers, or the comparison in their place."""
        return self.layers if self.comparison is None else (self.comparison,)

    @property
    def meshes(self) -> list[Any]:
        """The meshes of what is drawn."""
        return [mesh for layer in self.drawn for mesh in layer.meshes]

    @property
    def materials(self) -> list[Any]:
        """The materials of what is drawn."""
        return [material for layer in self.drawn for material in layer.materials]

    def show(self, drawing: Drawing) -> None:
        """Draw this; the map must be of the scene's domain. See also :meth:`close_replaced`."""
        self.map = drawing.map
        self._show_comparison(drawing.comparison)
        self._show_overlay(drawing)
        for name, visible, ribbon, color, width in (
            ("cage", drawing.cage, cage_ribbon, BLUE, _CAGE_WIDTH),
            ("offset_cage", drawing.offset_cage, offset_ribbon, GREY, _OFFSET_WIDTH),
        ):
            if visible and getattr(self, name) is None:
                setattr(self, name, self._line(ribbon(self.domain), color, 0.9, width))
            _set_visible(getattr(self, name), visible)
        self._show_panels(drawing.panels)
        for layer in self.layers:
            layer.show_map(drawing.map)

    def close_replaced(self) -> None:
        """Free layers that are no longer drawn, once the page has the new ones."""
        while self._replaced:
            self._replaced.pop().close()

    def close(self) -> None:
        """Free what the page holds."""
        self.close_replaced()
        for layer in {*self.layers, *self.drawn}:
            layer.close()
        self._texture.close()

    def _show_comparison(self, map: MeshMap | None) -> None:
        shown = self.comparison
        if map is not None and shown is not None and shown.triangulation is map.triangulation:
            shown.show(map)
            return
        if shown is not None:
            self._replaced.append(shown)
        self.comparison = None if map is None else ComparisonLayer(map, self._textured_uniforms())

    def _show_overlay(self, drawing: Drawing) -> None:
        name, energy = drawing.overlay, drawing.energy
        least = None
        if (name, energy) == (self._overlay, self._energy):
            if drawing.color_range == "keep" or OVERLAYS[name].number < 2:
                return
            least = self.color_range if drawing.color_range == "widen" else None
        before = (self._overlay, self._energy, self.color_range)
        self._overlay, self._energy = name, energy
        self.color_range = self._fitted_range(least)
        if before != (name, energy, self.color_range):
            changes = {k: u["value"] for k, u in self._picture_uniforms().items()}
            for layer in {self.picture, self.drawn[0]}:
                layer.set_uniforms(changes)

    def _fitted_range(self, least: tuple[float, float] | None) -> tuple[float, float]:
        if OVERLAYS[self._overlay].number < 2:
            return color_range(self._overlay, self._energy)
        fz, fzb = self.map.wirtinger(self._range_points)
        return color_range(self._overlay, self._energy, fz, fzb, least)

    @functools.cached_property
    def _range_points(self) -> NDArray[Any]:
        return uniform_panels(self.domain.cage, _RANGE_SAMPLES).start

    def _show_panels(self, shown: tuple[Panels, Array] | None) -> None:
        if shown is None:
            _set_visible(self.panels, False)
            return
        panels, sigma2_lower = shown
        margin = np.clip(np.nan_to_num(sigma2_lower) / FULL_MARGIN, 0.0, 1.0)
        values = panel_values(np.rint(255 * (1 - margin)).astype(np.uint8))
        if panels is self._panels and self.panels is not None:
            if not np.array_equal(self.panels.attributes["margin"].array, values):
                self.panels.attributes["margin"].array = values
            _set_visible(self.panels, True)
            return
        if self.panels is not None:
            self._replaced.append(self.panels)
        self.panels = self._line(panel_ribbon(panels), GREY, 1.0, _PANEL_WIDTH, values)
        self._panels = panels

    def _layer(
        self,
        points: Array,
        triangles: Array,
        attributes: dict[str, Any],
        shader: str,
        uniforms: dict[str, dict[str, Any]],
    ) -> MapLayer:
        shaders = (f"{shader}.vert", f"{shader}.frag")
        domain = (self.shader_map, self.map, self.evaluated_in)
        return MapLayer(points, triangles, attributes, shaders, uniforms, *domain)

    def _line(
        self,
        line: Ribbon,
        color: str,
        opacity: float,
        half_width: float,
        margins: Array | None = None,
    ) -> MapLayer:
        """A line in one colour; with margins coloured by them between borders of that colour."""
        by_margin = 0.0 if margins is None else 1.0
        if margins is None:
            margins = np.zeros(len(line.points), dtype=np.uint8)
        attributes = {
            "ribbon": attribute(line.ribbon),
            "margin": attribute(margins, normalized=True),
        }
        uniforms = {
            "pixel": {"value": 0.02},
            "half_width": {"value": half_width},
            "line_color": {"value": [*rgb([color])[0], opacity]},
            "by_margin": {"value": by_margin},
            "colors": {"value": margin_stops().ravel().tolist()},
        }
        return self._layer(line.points, line.triangles, attributes, "ribbon", uniforms)

    def _textured_uniforms(self) -> dict[str, dict[str, Any]]:
        return {**self._picture_uniforms(), "map": {"value": self._texture}}

    def _picture_uniforms(self) -> dict[str, dict[str, Any]]:
        xmin, ymin, xmax, ymax = self.frame.bounds
        # A user's own energy has no shader expression; the picture is shown instead.
        unknown = self._overlay == "energy" and self._energy.shader is None
        number = 0 if unknown else OVERLAYS[self._overlay].number
        return {
            "frame": {"value": [xmin, ymin, xmax - xmin, ymax - ymin]},
            "overlay": {"value": float(number)},
            "energy": {"value": energy_uniform(self._energy)},
            "color_range": {"value": list(self.color_range)},
            "colors": {"value": color_stops().ravel().tolist()},
            "pixel": {"value": 0.02},
            "grid_spacing": {"value": self.domain.cage.longer_side / _GRID_LINES},
        }


def _set_visible(layer: Layer | None, visible: bool) -> None:
    if layer is not None and layer.mesh.visible != visible:
        layer.mesh.visible = visible


def drawing_order(mesh: Triangulation) -> Array:
    """The triangles row by row within columns a few vertices wide.

    A vertex costs the shader a sum over the cage, and only the last few results are cached. In this
    order each vertex is shaded little more than once.
    """
    rows = np.unique(np.round(mesh.vertices[mesh.n_boundary :, 1], 9))
    if len(rows) < 2:
        return mesh.triangles
    width = _COLUMN * float(np.median(np.diff(rows)))
    x, y = mesh.vertices[mesh.triangles].mean(axis=1).T
    return mesh.triangles[np.lexsort((x, np.searchsorted(rows, y), np.floor(x / width)))]


def renderer(scene: Scene, width: int, height: int) -> Any:
    """A pythreejs renderer of a scene; the page sets its camera's frame."""
    return three.Renderer(
        camera=three.OrthographicCamera(-10, 10, 10, -10, 0, 10, position=[0, 0, 5]),
        scene=three.Scene(children=scene.meshes, background=None),
        controls=[],
        width=width,
        height=height,
        antialias=True,
        alpha=True,
        background_opacity=0,
        clearOpacity=0,
        sortObject=False,
    )
