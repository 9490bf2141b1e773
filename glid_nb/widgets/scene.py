"""The scene of one domain: the picture on its mesh, and lines along the boundary."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
import pythreejs as three

from glid_nb._arrays import Array
from glid_nb.certificate.certify import PanelCertificate
from glid_nb.energies import ENERGIES, Energy, SymmetricDirichlet
from glid_nb.figures.style import BLUE, COLORS, FULL_MARGIN, GREY, rgb
from glid_nb.geometry import MeshMap, Triangulation, triangulate, uniform_panels
from glid_nb.harmonic import FixedPoints, HarmonicMap
from glid_nb.imaging import Order, PixelFrame, order_of
from glid_nb.page import ShaderMap
from glid_nb.widgets import layers
from glid_nb.widgets.layers import EvaluatedIn, Layer, Uniforms
from glid_nb.widgets.overlays import MARGIN_COLORS, OVERLAYS, color_range

Range = Literal["keep", "widen", "fit"]

N_VERTICES = 10_000  # default vertices of the picture's mesh

UNIFORM_VECTORS = 1024
"""Assumed number of uniform vectors of a vertex shader until the page reports the real number."""

_RANGE_SAMPLES = 256  # of the boundary, where distortion is largest
_GRID_LINES = 40  # along the longer side
HIGHEST = 4.0  # the largest height in world units, inside the camera's range
_LEVELS = 8  # groups of triangles, by height, that are drawn one after the other
_COLUMN = 8.0  # width of a column of triangles in drawing order, in heights of a row
# Lines along the boundary, the lowest first: shape, colour, opacity, half the width in pixels.
_LINES = {
    "cage": (layers.cage_ribbon, BLUE, 0.9, 0.9),
    "offset_cage": (layers.offset_ribbon, GREY, 0.9, 0.6),
    "panels": (layers.panel_ribbon, GREY, 1.0, 2.8),
}


@dataclass(frozen=True, eq=False)
class Drawing:
    """Everything visible of a deformation at one moment."""

    map: HarmonicMap
    comparison: MeshMap | None = None  # a map of a mesh, drawn instead of the harmonic map
    targets: Any = ()  # (h, 2) targets of the handles
    images: Any = ()  # (h, 2) images of the handles
    selected: tuple[int, ...] = ()  # indices of selected handles
    ring: tuple[float, ...] = ()
    """Angle and scale of the last selected handle, and for each whether it is wanted."""
    hidden: Any = ()  # (h,) whether another part of the shape covers a handle
    order: Order | None = None  # the order of the shape's parts; by default that without depths
    overlay: str = "texture"  # one of `glid_nb.widgets.overlays.OVERLAYS`
    energy: Energy = field(default_factory=SymmetricDirichlet)  # for the overlay "energy"
    color_range: Range = "fit"  # whether to keep, only widen or fit the colour map's range
    cage: bool = False
    offset_cage: bool = False
    panels: PanelCertificate | None = None
    """The boundary's panels with their certified bounds, if they are drawn."""


class Scene:
    """The picture and the lines of one domain, under one map, initially ``map``.

    The picture is a `layers.picture_texture` that several scenes may share. Its mesh has about
    ``n_vertices``. By default the shader computes their images if ``uniform_vectors`` are enough.
    """

    def __init__(
        self,
        frame: PixelFrame,
        texture: Any,
        map: HarmonicMap,
        n_vertices: int = N_VERTICES,
        evaluated_in: EvaluatedIn | None = None,
        uniform_vectors: int = UNIFORM_VECTORS,
    ) -> None:
        self.domain = map.domain
        self.map = map
        self.shader_map = ShaderMap(self.domain)
        fits = self.shader_map.fits(uniform_vectors)
        self.evaluated_in: EvaluatedIn = evaluated_in or ("shader" if fits else "kernel")
        self._shown = Drawing(map)
        self.color_range = color_range(self._shown.overlay, self._shown.energy)
        """The values at the ends of the overlay's colour map."""
        self.frame, self.texture = frame, texture
        self.n_vertices = n_vertices  # of the picture's mesh, roughly
        self._mesh = triangulate(self.domain.cage, n_vertices)
        self._order = order_of(self.domain.cage)
        stacked = stacked_triangles(self._mesh, self._order)
        self.picture = self._layer("picture", self._textured_uniforms(), *stacked)
        self.lines: dict[str, Layer] = {}  # the lines of _LINES that have been shown
        self.comparison: Layer | None = None
        self._sources: dict[str, Any] = {}  # the objects from which lines and comparison were made
        self._replaced: list[Layer] = []

    @property
    def layers(self) -> tuple[Layer, ...]:
        """All layers that the map moves, the lowest first."""
        return (self.picture, *(self.lines[name] for name in _LINES if name in self.lines))

    @property
    def drawn(self) -> tuple[Layer, ...]:
        """The drawn layers, the lowest first. The comparison replaces all others."""
        return self.layers if self.comparison is None else (self.comparison,)

    @property
    def meshes(self) -> list[Any]:
        """The meshes of the drawn layers."""
        return [mesh for layer in self.drawn for mesh in layer.meshes]

    @property
    def picture_meshes(self) -> list[Any]:
        """Those of the drawn meshes that show the picture, not lines."""
        return self.drawn[0].meshes

    @property
    def materials(self) -> list[Any]:
        """The materials of the drawn layers."""
        return [material for layer in self.drawn for material in layer.materials]

    def show(self, drawing: Drawing) -> None:
        """Show a drawing. Its map must belong to the scene's domain."""
        while self._replaced:  # in the previous drawing; the page no longer draws them
            self._replaced.pop().close()
        self.map = drawing.map
        self._show_order(drawing.order or order_of(self.domain.cage))
        self._show_comparison(drawing.comparison)
        self._show_overlay(drawing)
        self._show_line("cage", self.domain if drawing.cage else None)
        self._show_line("offset_cage", self.domain if drawing.offset_cage else None)
        self._show_line("panels", drawing.panels)
        for layer in self.layers:
            layer.show(drawing.map)

    def heights(self, orders: Sequence[Order]) -> bytes:
        """The heights of the picture's vertices for each order, concatenated as float32."""
        return _scaled(orders, self._mesh).astype("<f4").tobytes()

    def close(self) -> None:
        """Free the page's resources."""
        for layer in {*self.layers, *self.drawn, *self._replaced}:
            layer.close()

    def _show_order(self, order: Order) -> None:
        if order is self._order:
            return
        self._order = order
        self.picture.stack(*stacked_triangles(self._mesh, order))
        if self.comparison is not None:
            self.comparison.stack(*stacked_triangles(self._sources["comparison"], order))

    def _show_comparison(self, map: MeshMap | None) -> None:
        layer, source = self.comparison, None if map is None else map.triangulation
        if layer is not None and self._sources["comparison"] is not source:
            self._replaced.append(layer)
            layer = None
        if layer is None and map is not None:
            stacked = stacked_triangles(map.triangulation, self._order)
            layer = layers.comparison_layer(map, self._textured_uniforms(), *stacked)
        self.comparison, self._sources["comparison"] = layer, source
        if layer is not None:
            layer.show(map)

    def _show_overlay(self, drawing: Drawing) -> None:
        name, energy, shown = drawing.overlay, drawing.energy, self._shown
        same, measured = (name, energy) == (shown.overlay, shown.energy), OVERLAYS[name].number >= 2
        self._shown, before = drawing, self.color_range
        if same and (drawing.color_range == "keep" or not measured):
            return
        least = before if same and drawing.color_range == "widen" else None
        boundary = uniform_panels(self.domain.cage, _RANGE_SAMPLES).start
        derivatives = self.map.wirtinger(boundary) if measured else (None, None)
        self.color_range = color_range(name, energy, *derivatives, least)
        if not same or before != self.color_range:
            for layer in {self.picture, self.drawn[0]}:
                layer.set_uniforms(self._picture_uniforms())

    def _show_line(self, name: str, source: Any) -> None:
        line = self.lines.get(name)
        if source is not None and source is not self._sources.get(name):
            if line is not None:
                self._replaced.append(line)
            line = self.lines[name] = self._line(name, source)
            self._sources[name] = source
        if line is not None and line.mesh.visible != (source is not None):
            line.mesh.visible = source is not None

    def _line(self, name: str, source: Any) -> Layer:
        ribbon_of, color, opacity, half_width = _LINES[name]
        points, triangles, ribbon = ribbon_of(source)
        # Panels are coloured by their margins, one byte per vertex.
        margin, by_margin = np.zeros(len(points), dtype=np.uint8), 0.0
        if name == "panels":
            share = np.clip(np.nan_to_num(source.sigma2_lower) / FULL_MARGIN, 0.0, 1.0)
            margin = np.repeat(np.rint(255 * (1 - share)).astype(np.uint8), layers.PANEL_VERTICES)
            by_margin = 1.0  # the page sets it to 2 in a motion
        uniforms = _uniforms(
            pixel=0.02,
            half_width=half_width,
            line_color=[*rgb([color])[0], opacity],
            by_margin=by_margin,
            full_margin=FULL_MARGIN,
            colors=rgb(MARGIN_COLORS).ravel().tolist(),
        )
        return self._layer("ribbon", uniforms, points, triangles, ribbon=ribbon, margin=margin)

    def _layer(
        self, shader: str, uniforms: Uniforms, points: Array, triangles: Array, **more: Array
    ) -> Layer:
        in_shader, in_page = (self.evaluated_in == where for where in ("shader", "page"))
        mover = self.shader_map if in_shader else FixedPoints(self.domain, points[:, :2])
        how: dict[str, Any] = {"in_page": in_page, **more}
        return Layer(shader, uniforms, mover, self.map, points, triangles, **how)

    def _textured_uniforms(self) -> Uniforms:
        return {**self._picture_uniforms(), "map": {"value": self.texture}}

    def _picture_uniforms(self) -> Uniforms:
        xmin, ymin, xmax, ymax = self.frame.bounds
        overlay, energy = self._shown.overlay, self._shown.energy
        # An energy defined by the user has no shader expression, so the picture is shown instead.
        unknown = overlay == "energy" and energy.shader is None
        return _uniforms(
            frame=[xmin, ymin, xmax - xmin, ymax - ymin],
            overlay=0.0 if unknown else float(OVERLAYS[overlay].number),
            energy=energy_uniform(energy),
            color_range=list(self.color_range),
            colors=rgb(COLORS).ravel().tolist(),
            pixel=0.02,
            grid_spacing=self.domain.cage.longer_side / _GRID_LINES,
        )


def energy_uniform(energy: Energy) -> list[float]:
    """The number of an energy and its parameter, for ``energy.glsl``."""
    number = list(ENERGIES).index(energy.name) if energy.shader else -1
    return [float(number), float(getattr(energy, "s", 1.0))]


def _uniforms(**values: Any) -> Uniforms:
    return {name: {"value": value} for name, value in values.items()}


def stacked_triangles(mesh: Triangulation, order: Order) -> tuple[Array, Array]:
    """(v, 3) vertices with the order's heights as z, and (t, 3) triangles, the lower ones first.

    Within a level, the depth test orders the triangles. Lower levels must be drawn first, so that
    they are visible through the soft edges of higher ones.
    """
    (z,) = _scaled([order], mesh)
    triangles = drawing_order(mesh)
    rank = np.argsort(np.argsort(z[triangles].mean(axis=1), kind="stable"))
    levels = rank * _LEVELS // len(rank)
    return np.column_stack([mesh.vertices, z]), triangles[np.argsort(levels, kind="stable")]


def _scaled(orders: Sequence[Order], mesh: Triangulation) -> Array:
    """(n, v) heights of the vertices for each order, scaled to the camera's range."""
    z = np.stack([order(mesh.vertices) for order in orders])
    return 2 * HIGHEST * ((z - z.min()) / (np.ptp(z) or 1.0) - 0.5)


def drawing_order(mesh: Triangulation) -> Array:
    """The triangles, row by row within narrow columns. A graphics card caches only the last few
    vertices."""
    rows = np.unique(np.round(mesh.vertices[mesh.n_boundary :, 1], 9))
    if len(rows) < 2:
        return mesh.triangles
    width = _COLUMN * float(np.median(np.diff(rows)))
    x, y = mesh.vertices[mesh.triangles].mean(axis=1).T
    return mesh.triangles[np.lexsort((x, np.searchsorted(rows, y), np.floor(x / width)))]


def renderer(meshes: list[Any], antialias: bool) -> Any:
    """A pythreejs renderer of meshes. The page sets its camera's frame."""
    camera = three.OrthographicCamera(-10, 10, 10, -10, 0, 10, position=[0, 0, 5])
    return _renderer(camera, three.Scene(children=meshes, background=None), antialias)


def replacement(old: Any, antialias: bool) -> Any:
    """Another renderer of what an old one draws: with or without multisampling is decided once."""
    parts = {"shadowMap": old.shadowMap, "width": old.width, "height": old.height}
    return _renderer(old.camera, old.scene, antialias, **parts)


def _renderer(camera: Any, drawn: Any, antialias: bool, **parts: Any) -> Any:
    look = {"alpha": True, "background_opacity": 0, "clearOpacity": 0, "antialias": antialias}
    look |= {"controls": [], "sortObject": False, **parts}
    return three.Renderer(camera=camera, scene=drawn, **look)
