"""One renderer with the pad over it."""

from __future__ import annotations

import functools
from typing import Any

import ipywidgets
import numpy as np
from numpy.typing import NDArray

from glid_nb.harmonic import HarmonicMap
from glid_nb.solvers import DeformationMap
from glid_nb.widgets.closing import ClosingWidget, close_with_parts
from glid_nb.widgets.layers import EvaluatedIn
from glid_nb.widgets.overlays import PANEL_LEGEND, legend
from glid_nb.widgets.scene import N_VERTICES, Drawing, Scene, renderer
from glid_nb.widgets.shader import UNIFORM_VECTORS
from glid_nb.widgets.stage import Stage, emptiest_corner, marks_of

Array = NDArray[Any]

_SHARES = (0.0, 0.25, 0.5, 0.75)  # of an edge
_ROOM = 1.12  # what is fitted leaves a border
# Without a graphics processor a vertex costs tens of microseconds, so the mesh gets coarser; with
# fewer vertices than these its edges would be visible.
_DRAWING_TIME, _FEWEST_VERTICES = 40.0, 1500  # ms, vertices


class Pane(ClosingWidget, ipywidgets.GridBox):
    """A picture (h, w, 4) under a map, with marks over it; renderer and pad share one grid cell.

    ``size`` is in CSS pixels; ``n_vertices`` of the mesh are by default as many as the page draws
    quickly, ``evaluated_in`` is as in `DeformCanvas`.
    """

    def __init__(
        self,
        image: Array,
        map: HarmonicMap,
        size: tuple[int, int],
        *,
        interactive: bool,
        n_vertices: int | None,
        evaluated_in: EvaluatedIn | None,
    ) -> None:
        self._image = image
        self._n_vertices = N_VERTICES if n_vertices is None else n_vertices
        self._fewest_vertices = _FEWEST_VERTICES if n_vertices is None else n_vertices
        self._evaluated_in: EvaluatedIn | None = evaluated_in
        self._drawing = Drawing(map)
        self.scene = self._new_scene(0)
        """What pythreejs draws."""
        self._renderer = renderer(self.scene, *size)
        self.stage = Stage(
            width=size[0],
            height=size[1],
            interactive=interactive,
            renderer=self._renderer,
            camera=self._renderer.camera,
            materials=self.scene.materials,
            coefficients=self._wire(),
        )
        for part in (self._renderer, self.stage):
            part.layout.grid_area = "a"
        super().__init__([self._renderer, self.stage])
        self.add_class("glid-pane")
        self.layout.grid_template_areas = "'a'"
        self.layout.flex = "0 0 auto"
        self._resize()
        self.stage.observe(self._resize, ["width", "height"])
        self.fit(map, ())
        # A page has only eight renderers.
        others = functools.partial(close_with_parts, self.stage, self._renderer, self.layout)
        self._endings = (lambda: self.scene.close(), others)

    def show(self, drawing: Drawing) -> None:
        """Draw this, in one message if only the map and the marks have changed."""
        self._drawing, old = drawing, self.scene
        if drawing.map.domain is not old.domain:
            self.scene = self._new_scene(self.stage.uniform_vectors)
        self._show(old)

    def adapt(self) -> None:
        """Adapt to the page, which has told its limits and its speed.

        If its shaders cannot hold the cage, the kernel evaluates the map; if it draws too slowly
        for a drag, the mesh gets coarser.
        """
        stage, scene = self.stage, self.scene
        vectors, time = stage.uniform_vectors, stage.drawing_time
        overflows = (
            vectors != 0 and scene.evaluated_in == "shader" and not scene.shader_map.fits(vectors)
        )
        affordable = int(self._n_vertices * _DRAWING_TIME / time) if time else self._n_vertices
        wanted = max(affordable, self._fewest_vertices)
        if overflows or wanted < self._n_vertices:
            self._n_vertices = min(wanted, self._n_vertices)
            stage.drawing_time = 0.0  # it was the old scene's
            self.scene = self._new_scene(vectors)
            self._show(scene)

    def _show(self, old: Scene) -> None:
        drawing, scene, stage = self._drawing, self.scene, self.stage
        scene.show(drawing)
        if self._renderer.scene.children != (meshes := scene.meshes):
            self._renderer.scene.children = meshes
        panels = drawing.panels is not None and drawing.comparison is None
        with stage.hold_sync():
            stage.materials = scene.materials
            stage.coefficients = self._wire()
            stage.marks = marks_of(drawing.targets, drawing.images, drawing.selected)
            stage.legend = legend(drawing.overlay, drawing.energy, scene.color_range)
            stage.panel_legend = PANEL_LEGEND if panels else {}
        scene.close_replaced()
        if old is not scene:
            old.close()

    def place_legend(self) -> None:
        """Move the colour bars to where they hide least of the shape and the targets."""
        n_bars = bool(self.stage.legend) + bool(self.stage.panel_legend)
        if not n_bars:
            return
        loops = self.scene.domain.cage.loops
        # Edges may be longer than the bar.
        between = [loop + t * (np.roll(loop, -1, axis=0) - loop) for loop in loops for t in _SHARES]
        outline = (self._drawing.comparison or self._drawing.map)(np.concatenate(between))
        x, y, unit = self.stage.view
        width, height = self.stage.width, self.stage.height
        seen = np.concatenate([outline, np.reshape(self._drawing.targets, (-1, 2))])
        pixels = (seen - [x, y]) / unit + [width / 2, height / 2]
        self.stage.legend_corner = emptiest_corner(pixels, width, height, n_bars)

    def fit(self, map: DeformationMap, points: Any) -> None:
        """Make the whole shape visible, and these points."""
        outline = _images(map, np.concatenate(self.scene.domain.cage.loops))
        everything = np.concatenate([outline, np.reshape(points, (-1, 2))])
        low, high = everything.min(axis=0), everything.max(axis=0)
        x, y = (low + high) / 2
        width, height = self.stage.width, self.stage.height
        unit = _ROOM * max((high[0] - low[0]) / width, (high[1] - low[1]) / height, 1e-6)
        self.stage.view = [float(x), float(y), float(unit)]

    def _new_scene(self, uniform_vectors: int) -> Scene:
        vectors = uniform_vectors or UNIFORM_VECTORS  # 0 while no page has said
        map_ = self._drawing.map
        return Scene(self._image, map_, self._n_vertices, self._evaluated_in, vectors)

    def _wire(self) -> bytes:
        scene = self.scene
        return scene.shader_map.wire(scene.map) if scene.evaluated_in == "shader" else b""

    def _resize(self, _: Any = None) -> None:
        width, height = self.stage.width, self.stage.height
        self._renderer.width, self._renderer.height = width, height
        for part in (self, self._renderer, self.stage):
            part.layout.width, part.layout.height = f"{width}px", f"{height}px"
        self.layout.grid_template_columns = f"{width}px"
        self.layout.grid_template_rows = f"{height}px"


def _images(map: DeformationMap, points: Array) -> Array:
    """Images of points; the identity's without JAX, which the first canvas does not wait for."""
    if isinstance(map, HarmonicMap):
        identity = HarmonicMap.identity(map.domain)
        if np.array_equal(map.phi, identity.phi) and np.array_equal(map.psi, identity.psi):
            return points
    return map(points)
