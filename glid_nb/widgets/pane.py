"""One renderer with the pad over it."""

from __future__ import annotations

from typing import Any

import ipywidgets
import numpy as np
from numpy.typing import NDArray

from glid_nb.energies import Energy
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods import DeformationMap, MeshMap
from glid_nb.widgets.closing import close_with_parts
from glid_nb.widgets.overlays import legend, panel_legend
from glid_nb.widgets.scene import N_VERTICES, EvaluatedIn, Scene, renderer
from glid_nb.widgets.stage import Stage, emptiest_corner, marks_of

Array = NDArray[Any]

_SHARES = (0.0, 0.25, 0.5, 0.75)  # of an edge
_ROOM = 1.12  # what is fitted leaves a border
# Without a graphics processor a vertex costs tens of microseconds: more than these are not moved
# with the hand. Fewer would show, as a picture that breaks at the mesh's edges.
_DRAWING_TIME, _FEWEST_VERTICES = 40.0, 1500  # ms, vertices


class Pane(ipywidgets.GridBox):
    """A picture under a map, with marks over it; renderer and pad share one grid cell."""

    # ipywidgets closes also what was refused while it was made.
    _complete = False

    def __init__(
        self,
        image: Array,
        map: HarmonicMap,
        energy: Energy,
        size: tuple[int, int],
        *,
        interactive: bool,
        n_vertices: int | None,
        evaluated_in: EvaluatedIn | None,
    ) -> None:
        self._image, self._energy = image, energy
        self._n_vertices = N_VERTICES if n_vertices is None else n_vertices
        self._fewest_vertices = _FEWEST_VERTICES if n_vertices is None else n_vertices
        self._evaluated_in: EvaluatedIn | None = evaluated_in
        self._overlay, self._lines, self._with_panels = "texture", (False, False), False
        self._scene = self._new_scene(map)
        self._renderer, camera = renderer(self._scene, *size)
        self.stage = Stage(
            width=size[0],
            height=size[1],
            interactive=interactive,
            renderer=self._renderer,
            camera=camera,
            materials=self._materials(),
            coefficients=self._wire(map),
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
        self._complete = True

    @property
    def scene(self) -> Scene:
        """What pythreejs draws."""
        return self._scene

    def show(
        self, map: HarmonicMap, targets: Array, images: Array, selected: tuple[int, ...]
    ) -> None:
        """Draw this map and these marks, in one message."""
        if map.domain is not self._scene.domain:
            self._replace_scene(map)
        self._scene.show_map(map)
        with self.stage.hold_sync():
            self.stage.coefficients = self._wire(map)
            self.stage.marks = marks_of(targets, images, selected)

    def adapt(self) -> bool:
        """To what the page says of itself; whether there is another scene now.

        Where its shaders do not hold the cage, the kernel evaluates the map; where it draws too
        slowly for a drag, it gets a coarser mesh.
        """
        stage, scene = self.stage, self._scene
        vectors, time = stage.uniform_vectors, stage.drawing_time
        overflows = (
            vectors != 0 and scene.evaluated_in == "shader" and not scene.shader_map.fits(vectors)
        )
        affordable = int(self._n_vertices * _DRAWING_TIME / time) if time else self._n_vertices
        wanted = max(affordable, self._fewest_vertices)
        if not overflows and wanted >= self._n_vertices:
            return False
        self._n_vertices = min(wanted, self._n_vertices)
        stage.drawing_time = 0.0  # it was that of the scene before
        self._replace_scene(scene.map)
        stage.coefficients = self._wire(scene.map)
        return True

    def show_comparison(self, map: MeshMap | None) -> None:
        """Draw a map of a mesh in place of the harmonic one, or this again."""
        if self._scene.show_comparison(map):
            self._update_children()
            self._scene.close_replaced()
            self._show_legend()

    def show_overlay(self, name: str, energy: Energy) -> None:
        """Another way to colour the shape."""
        self._overlay, self._energy = name, energy
        self._scene.show_overlay(name, energy)
        self._show_legend()

    def place_legend(self, map: DeformationMap, points: Any) -> None:
        """Move the colour bar to where it hides least of the shape and of these points."""
        loops = self._scene.domain.cage.loops
        # Edges may be longer than the bar.
        between = [loop + t * (np.roll(loop, -1, axis=0) - loop) for loop in loops for t in _SHARES]
        outline = map(np.concatenate(between))
        x, y, unit = self.stage.view
        width, height = self.stage.width, self.stage.height
        seen = np.concatenate([outline, np.reshape(points, (-1, 2))])
        pixels = (seen - [x, y]) / unit + [width / 2, height / 2]
        self.stage.legend_corner = emptiest_corner(
            pixels, width, height, bool(self.stage.legend) + bool(self.stage.panel_legend)
        )

    def show_lines(self, cage: bool, offset_cage: bool) -> None:
        """Whether the two cages are drawn."""
        self._lines = (cage, offset_cage)
        if self._scene.show_lines(cage, offset_cage):
            self._update_children()

    def show_panels(self, panels: Any, sigma2_lower: Array) -> None:
        """The boundary's panels, coloured by margin; None for none."""
        if self._scene.show_panels(panels, sigma2_lower):
            self._update_children()
        self._with_panels = panels is not None
        self._show_legend()

    def fit(self, map: DeformationMap, points: Any) -> None:
        """Make the whole shape visible, and these points."""
        outline = _images(map, np.concatenate(self._scene.domain.cage.loops))
        everything = np.concatenate([outline, np.reshape(points, (-1, 2))])
        low, high = everything.min(axis=0), everything.max(axis=0)
        x, y = (low + high) / 2
        width, height = self.stage.width, self.stage.height
        unit = _ROOM * max((high[0] - low[0]) / width, (high[1] - low[1]) / height, 1e-6)
        self.stage.view = [float(x), float(y), float(unit)]

    def close(self) -> None:
        """Free the renderer: a page has only eight."""
        if not self._complete:
            return
        self._scene.close()
        close_with_parts(self.stage, self._renderer, self.layout)
        super().close()

    def _new_scene(self, map: HarmonicMap, vectors: int | None = None) -> Scene:
        extra = {} if vectors is None else {"uniform_vectors": vectors}
        return Scene(self._image, map, self._energy, self._n_vertices, self._evaluated_in, **extra)

    def _replace_scene(self, map: HarmonicMap) -> None:
        old = self._scene
        vectors = self.stage.uniform_vectors
        self._scene = self._new_scene(map, None if vectors == 0 else vectors)
        self._scene.show_overlay(self._overlay, self._energy)
        self._scene.show_lines(*self._lines)
        self._show_legend()
        self._update_children()
        old.close()

    def fit_range(self, *, widen_only: bool) -> None:
        """Fit the ends of the overlay's colour map to the map that is shown."""
        if self._scene.fit_range(widen_only=widen_only):
            self._show_legend()

    def _show_legend(self) -> None:
        """The colour bars of the overlay and of the panels, where they are drawn."""
        panels = self._with_panels and self._scene.comparison is None
        with self.stage.hold_sync():
            self.stage.legend = legend(self._overlay, self._energy, self._scene.color_range)
            self.stage.panel_legend = panel_legend() if panels else {}

    def _update_children(self) -> None:
        self._renderer.scene.children = self._scene.meshes
        self.stage.materials = self._materials()

    def _materials(self) -> list[Any]:
        return self._scene.materials

    def _wire(self, map: HarmonicMap) -> bytes:
        scene = self._scene
        return scene.shader_map.wire(map) if scene.evaluated_in == "shader" else b""

    def _resize(self, _: Any = None) -> None:
        width, height = self.stage.width, self.stage.height
        self._renderer.width, self._renderer.height = width, height
        for part in (self, self._renderer, self.stage):
            part.layout.width, part.layout.height = f"{width}px", f"{height}px"
        self.layout.grid_template_columns = f"{width}px"
        self.layout.grid_template_rows = f"{height}px"


def _images(map: DeformationMap, points: Array) -> Array:
    """Images of points; those of the identity without a compiled program, for the first canvas."""
    if isinstance(map, HarmonicMap):
        identity = HarmonicMap.identity(map.domain)
        if np.array_equal(map.phi, identity.phi) and np.array_equal(map.psi, identity.psi):
            return points
    return map(points)
