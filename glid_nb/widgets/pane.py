"""One renderer with a pad over it."""

import functools
from collections.abc import Sequence
from typing import Any

import ipywidgets
import numpy as np
import shapely
import traitlets

from glid_nb._arrays import Array
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import PixelFrame
from glid_nb.imaging.backdrop import Backdrop
from glid_nb.page import ShaderMap, bundle, stylesheet
from glid_nb.session.scenery import Scenery
from glid_nb.widgets.closing import ClosingWidget
from glid_nb.widgets.layers import BackdropMesh, EvaluatedIn
from glid_nb.widgets.overlays import PANEL_LEGEND, legend
from glid_nb.widgets.pad import Pad
from glid_nb.widgets.scene import (
    N_VERTICES,
    UNIFORM_VECTORS,
    Drawing,
    Scene,
    renderer,
    replacement,
)
from glid_nb.widgets.scenery import (
    Surroundings,
    Textures,
    outlined,
    stacked_meshes,
    suits,
    vertices_of,
    wire_of,
)
from glid_nb.widgets.tracer import displayed

CORNERS = ("bottom right", "bottom left", "top right", "top left")  # the default first

_LEGEND_SIZE = (222, 75)  # CSS pixels, including the distance from the border
_LEGEND_SHARE = 0.45  # most of the width
_MARKS = ("targets", "images", "selected", "hidden", "ring")
_REFERENCE: dict[str, Any] = ipywidgets.widget_serialization
_POINT = 400.0  # square CSS pixels; as bad is a hidden pin
_SHARES = (0.0, 0.25, 0.5, 0.75)  # places on an edge of the outline
_ROOM = 1.12  # size of the view relative to the fitted shape
# Without a graphics processor a vertex costs tens of microseconds. So the mesh is coarse until the
# page has reported its drawing time.
# _DRAWING_TIME: the wanted drawing time, in ms.
# _FEWEST_VERTICES: with fewer vertices, edges of the mesh would be visible.
_DRAWING_TIME, _FEWEST_VERTICES = 40.0, 1500
_FINER = 2.0  # a new mesh is made for at least this many times as many vertices
_QUICK = 8.0  # ms of a drawing; if the shader needs more, the page's script tries to move the mesh
_MOST_ROWS = 2_500_000  # numbers of the basis at the vertices; the page keeps 32 bytes for each


class Stage(Pad):
    """The pad over a pythreejs renderer. It draws pins, sends events and gives coefficients to the
    materials."""

    _script = traitlets.Unicode(bundle("canvas")).tag(sync=True)
    _css = stylesheet("canvas")

    width = traitlets.Int(600).tag(sync=True)
    """Width in CSS pixels. The page changes it when the corner is dragged."""
    height = traitlets.Int(500).tag(sync=True)  # height in CSS pixels
    room = traitlets.List(traitlets.Int(), []).tag(sync=True)
    """Width and height that the surrounding editor has for the canvas, in CSS pixels, then 1 if the
    canvas fills it, whatever its shape; empty without an editor."""
    view = traitlets.List(traitlets.Float(), [0.0, 0.0, 0.04]).tag(sync=True)
    """Centre (x, y) in world units, and the world units of one CSS pixel."""
    coefficients = traitlets.Bytes(b"").tag(sync=True)
    """The map, as written by ``ShaderMap.wire``; empty if the kernel evaluates."""
    outline = traitlets.Dict({}).tag(sync=True)
    """The domain: ``outline``, and the sizes ``chain`` and ``shaderHoles`` of `coefficients`."""
    part_shapes = traitlets.List([]).tag(sync=True, **_REFERENCE)
    """The shapes around the edited one: for each its ``key``, its ``materials``, and the domain as
    in `outline`."""
    part_maps = traitlets.Dict({}).tag(sync=True)
    """The maps of these shapes by their keys, as in `coefficients`."""
    solver_script = traitlets.Unicode("").tag(sync=True)  # of the worker of the page's own solver
    solver = traitlets.Dict({}).tag(sync=True)
    """The ``options`` of the page's own solver; empty if it cannot solve what is edited."""
    rest = traitlets.Dict({}).tag(sync=True)
    """Where the model is at rest, or was when a drag made its pin: the ``pose``, ``coefficients``
    in double precision, and the ``number`` of this rest."""
    marks = traitlets.Dict({key: [] for key in _MARKS}).tag(sync=True)
    """Targets and images of handles, [x, y]; indices selected, hidden; and `Drawing.ring`."""
    names = traitlets.List(traitlets.Unicode(), []).tag(sync=True)  # the handles', may be empty
    pins = traitlets.Dict({"locked": [], "away": [], "groups": []}).tag(sync=True)
    """Indices of the handles that are ``locked`` and that the user hid (``away``), and for each
    handle its group's number, 0 for none."""
    reference = traitlets.CBytes(b"").tag(sync=True)  # the page sends memory views
    """A picture that the page shows dimmed behind the shape; empty for none."""
    behind_reference = traitlets.CBytes(b"").tag(sync=True)
    """The background, while there is a reference, which lies over it; empty for none."""
    onion = traitlets.List([]).tag(sync=True)  # other poses' colours and loops of [x, y], each
    stiff = traitlets.List([]).tag(sync=True)  # painted areas' strengths and loops of [x, y], each
    brush = traitlets.Dict({}).tag(sync=True)
    """The brush of the left button: ``tool`` (empty without a brush), ``radius``, ``strength``."""
    cursor = traitlets.List(default_value=None, allow_none=True).tag(sync=True)
    """The place of the keyboard's cursor, [x, y]; None while it is not used."""
    legend = traitlets.Dict({}).tag(sync=True)
    """The overlay's colour bar: ``title``, ``colors`` and ``ticks``; empty for none."""
    panel_legend = traitlets.Dict({}).tag(sync=True)  # the certificate's, below the overlay's
    legend_corner = traitlets.Enum(CORNERS, CORNERS[0]).tag(sync=True)  # where the colour bars are
    notice = traitlets.Unicode("").tag(sync=True)  # why the last action was refused, if it was
    prepared = traitlets.Float(1.0).tag(sync=True)
    """The finished share, 0 to 1, of the preparation for the first solve of a shape."""
    interactive = traitlets.Bool(True).tag(sync=True)  # whether the pad reacts to pointers and keys
    uniform_vectors = traitlets.Int(0).tag(sync=True)
    """Number of uniform vectors that the page's shaders support; 0 while unknown."""
    drawing_time = traitlets.Float(0.0).tag(sync=True)
    """Milliseconds that the page needs to draw the renderer once; 0 while unknown."""
    drawn = traitlets.Bool(False).tag(sync=True)  # whether a page has drawn the renderer
    renderer = traitlets.Instance(ipywidgets.Widget).tag(sync=True, **_REFERENCE)
    """The pythreejs renderer below."""
    camera = traitlets.Instance(ipywidgets.Widget).tag(sync=True, **_REFERENCE)  # its camera
    materials = traitlets.List([]).tag(sync=True, **_REFERENCE)  # those that take coefficients


class Pane(ClosingWidget, ipywidgets.GridBox):
    """A picture (h, w, 4) under a map, with marks over it. Arguments are as in `DeformCanvas`."""

    def __init__(
        self,
        image: Array,
        map: HarmonicMap,
        size: tuple[int, int],
        *,
        interactive: bool,
        n_vertices: int | None,
        evaluated_in: EvaluatedIn | None,
        background: Backdrop = None,
    ) -> None:
        self._frame, self._image = PixelFrame(*image.shape[1::-1]), image
        self._textures = Textures()
        self._n_vertices = self._fewest = n_vertices or _FEWEST_VERTICES  # at first
        self._most = n_vertices or N_VERTICES
        self._asked: EvaluatedIn | None = evaluated_in
        self._evaluated_in: EvaluatedIn | None = evaluated_in
        self._drawing = Drawing(map)
        self._times: dict[str, float] = {}  # ms for a vertex, by who evaluates
        self._around = Surroundings(self._new_scene, self._suits)
        self._rearranged = False  # whether the shapes around have to be shown anew
        self._vectors = UNIFORM_VECTORS  # vectors of uniforms of the page's shaders
        self.scene = self._edited_scene()  # what pythreejs draws of the edited shape
        self._background, self._backdrop = background, self._new_backdrop(background)
        self._renderer = renderer(self._meshes, self._multisamples)
        self.stage = Stage(
            width=size[0],
            height=size[1],
            interactive=interactive,
            renderer=self._renderer,
            camera=self._renderer.camera,
            materials=self.scene.materials,
            coefficients=wire_of(self.scene),
            outline=outlined(self.scene),
        )
        super().__init__([self.stage, self._renderer])  # a new renderer leaves the stage's views
        self.add_class("glid-pane")
        for side in ("width", "height"):
            ipywidgets.dlink((self.stage, side), (self.layout, side), "{}px".format)
        self._size_renderer()
        self.stage.observe(self._size_renderer, ["width", "height"])
        self.stage.observe(self._show_backdrop, ["reference"])
        self.fit()
        self._endings = (self._free,)

    def show(self, drawing: Drawing) -> None:
        """Show a drawing. If only the map and the marks have changed, this sends one message."""
        self._drawing, old = drawing, self.scene
        if drawing.map.domain is not old.domain:
            texture = self._textures.of(self._image)
            self.scene = self._around.take(drawing.map.domain, texture) or self._edited_scene()
            self._rearranged = bool(self._around.scenery or self._around.scenes)
        self._show(old)

    def show_scenery(self, scenery: Sequence[Scenery]) -> None:
        """Draw other shapes behind and in front of the edited one. If only their maps have changed,
        this sends one message."""
        before = [shape.map.domain for shape in self._around.scenery]
        self._around.scenery, self._rearranged = tuple(scenery), True
        self._show(self.scene)
        if before != [shape.map.domain for shape in scenery]:
            self.stage.drawing_time = 0.0  # the page measures how long all shapes take

    def show_part_maps(self, scenery: Sequence[Scenery]) -> None:
        """Draw the shapes of `show_scenery` under other maps for a moment, as in a motion."""
        self._around.move(scenery)
        self.stage.part_maps = self._around.wires

    @property
    def part_scenes(self) -> dict[str, Scene]:
        """The scenes of the shapes around the edited one, by their keys."""
        return self._around.scenes

    def edit(self, image: Array, scenery: Sequence[Scenery]) -> None:
        """Edit another shape from the next `show` on: its picture (h, w, 4), of the same size, and
        the shapes around it."""
        self._image = image
        self._around.scenery = tuple(scenery)

    def set_picture(self, image: Array, background: Backdrop) -> None:
        """Draw another picture of the same size, and what lies behind it."""
        behind, old, framed = self._backdrop, self.scene, self._has_picture_behind
        self._image = image
        self._background, self._backdrop = background, self._new_backdrop(background)
        self._show_backdrop()
        self.scene = self._edited_scene()
        self._show(old)
        if self._has_picture_behind and not framed:
            self.fit()  # the shape has room to move in front of it
        if behind is not None:
            behind.close()

    def adapt(self) -> None:
        """Adapt to the page: evaluate in the kernel if its shaders are too small, in the page's
        script if that is quicker than its shaders, and use a mesh that it draws fast enough."""
        stage, scene, count = self.stage, self.scene, self._n_vertices
        self._vectors = stage.uniform_vectors or UNIFORM_VECTORS  # 0 until a page has reported it
        if stage.drawing_time:
            self._times[scene.evaluated_in] = stage.drawing_time / count
        where = self._asked or self._quickest()
        wanted = self._affordable(where)
        if where == scene.evaluated_in and count <= wanted < _FINER * count:
            return
        multisampled = self._multisamples
        self._n_vertices, self._evaluated_in = wanted, where
        if where in self._times:
            self._most = wanted
        self.scene, self._rearranged = self._edited_scene(), bool(self._around.scenery)
        self._show(scene)
        if self._multisamples != multisampled:
            self._replace_renderer()
        if where not in self._times:
            stage.drawing_time = 0.0  # it was the old scene's; the page measures the new one

    def _quickest(self) -> EvaluatedIn:
        """Who is to evaluate, by what the page has reported. What may be quicker is tried once."""
        times, scene, vectors = self._times, self.scene, self.stage.uniform_vectors
        if vectors and not scene.shader_map.fits(vectors):
            return "kernel"
        if "shader" in times and "page" in times:
            return "page" if times["page"] < times["shader"] else "shader"
        slow = scene.evaluated_in == "shader" and self.stage.drawing_time > _QUICK
        kept = self._n_vertices * scene.domain.n_coefficients
        return "page" if slow and kept <= _MOST_ROWS else scene.evaluated_in

    def _affordable(self, where: EvaluatedIn) -> int:
        """How many vertices the page draws in time; as many as now if that was not measured."""
        if where not in self._times or not self.stage.drawing_time:
            return self._n_vertices
        return max(min(int(_DRAWING_TIME / self._times[where]), self._most), self._fewest)

    def _show(self, old: Scene) -> None:
        drawing, around, stage = self._drawing, self._around, self.stage
        rearranged, self._rearranged = self._rearranged, False
        unused = [] if old is self.scene else [old]
        if rearranged and not self._suits(self.scene, self._share(self.scene.domain)):
            unused.append(self.scene)
            self.scene = self._edited_scene()
        scene = self.scene
        scene.show(drawing)
        if rearranged:
            unused = around.show(scene, unused, self._textures)
        self._draw_in_order(self._meshes)
        panels = drawing.panels is not None and drawing.comparison is None
        with stage.hold_sync():
            stage.materials = scene.materials
            stage.coefficients = wire_of(scene)
            if old.domain is not scene.domain:
                stage.outline = outlined(scene)
            if rearranged:
                stage.part_shapes, stage.part_maps = around.outlined, around.wires
            # Round to the precision of a screen.
            at = {key: np.round(getattr(drawing, key), 5).tolist() for key in ("targets", "images")}
            chosen = {"selected": list(drawing.selected), "ring": drawing.ring}
            stage.marks = {**at, **chosen, "hidden": np.flatnonzero(drawing.hidden).tolist()}
            stage.legend = legend(drawing.overlay, drawing.energy, scene.color_range)
            stage.panel_legend = PANEL_LEGEND if panels else {}
        for one in unused:
            one.close()
        self._textures.keep([self._image, *(shape.picture for shape in around.scenery)])

    def _draw_in_order(self, meshes: list[Any]) -> None:
        """Let the page draw these meshes, in their order.

        The page keeps the order of the meshes that it has and appends new ones. So if that is
        another order, it first drops all of them.
        """
        drawn = self._renderer.scene
        kept = [mesh for mesh in drawn.children if mesh in meshes]
        appended = [*kept, *(mesh for mesh in meshes if mesh not in kept)]
        if appended != meshes:
            drawn.children = []
        if drawn.children != meshes:
            drawn.children = meshes

    def place_legend(self) -> None:
        """Move the colour bars to the corner where they hide least of the shape and targets."""
        n_bars = bool(self.stage.legend) + bool(self.stage.panel_legend)
        if not n_bars:
            return
        x, y, unit = self.stage.view
        width, height = self.stage.width, self.stage.height
        loops, targets = self._drawn()
        loops = [(loop - [x, y]) / unit + [width / 2, height / 2] for loop in loops]
        pixels = (targets - [x, y]) / unit + [width / 2, height / 2]
        self.stage.legend_corner = emptiest_corner(pixels, width, height, n_bars, loops)

    def _drawn(self) -> tuple[list[Array], Array]:
        """The loops of the drawn outline, and the targets."""
        loops = self.scene.domain.cage.loops
        shares = np.array(_SHARES)[:, None]  # edges may be longer than a colour bar
        edges = [(loop[:, None], (np.roll(loop, -1, axis=0) - loop)[:, None]) for loop in loops]
        dense = [(start + shares * along).reshape(-1, 2) for start, along in edges]
        map_ = self._drawing.comparison or self._drawing.map
        images = map_(np.concatenate(dense))
        ends = np.cumsum([len(loop) for loop in dense])[:-1]
        return np.split(images, ends), np.reshape(self._drawing.targets, (-1, 2))

    def _everything(self) -> Any:
        """Points of the drawn outlines, the targets, and the corners of a picture behind them."""
        loops, targets = self._drawn()
        around = (scene.map(scene.domain.cage.exterior) for scene in self.part_scenes.values())
        corners = self._frame.bounds if self._has_picture_behind else ()
        return np.concatenate([*loops, *around, targets, np.reshape(corners, (-1, 2))])

    @property
    def _has_picture_behind(self) -> bool:
        return self._backdrop is not None and self._backdrop.is_picture

    _seen: tuple[float, float]  # width and height, in world units, that must fit in the view
    _unit: float  # world units per CSS pixel with which they fit

    def fit(self) -> None:
        """Make the whole shape and all targets visible."""
        everything = self._everything()
        low, high = everything.min(axis=0), everything.max(axis=0)
        x, y = (low + high) / 2
        width, height = self.stage.width, self.stage.height
        self._seen = across, up = (_ROOM * np.maximum(high - low, 1e-6)).tolist()
        self._unit = max(across / width, up / height)
        self.stage.view = [float(x), float(y), self._unit]

    def resize(self, width: int, height: int) -> None:
        """Change the size in CSS pixels. The visible part of the plane stays visible."""
        stage = self.stage
        x, y, unit = stage.view
        before = stage.width * unit, stage.height * unit
        if unit != self._unit:  # the user has zoomed since
            self._seen = before
        # Parts that have moved out of the fitted area stay visible too.
        far = 2 * _ROOM * abs(self._everything() - [x, y]).max(axis=0)
        across, up = np.maximum(self._seen, np.minimum(far, before)).tolist()
        self._unit = max(across / width, up / height)
        with stage.hold_sync(), stage.hold_trait_notifications():
            stage.width, stage.height, stage.view = width, height, [x, y, self._unit]

    def _edited_scene(self) -> Scene:
        """A new scene of the edited shape."""
        map_ = self._drawing.map
        count = vertices_of(self._n_vertices, self._share(map_.domain))
        how = count, self._evaluated_in, self._vectors
        return Scene(self._frame, self._textures.of(self._image), map_, *how)

    def _new_scene(self, map: HarmonicMap, image: Array, share: float) -> Scene:
        """A scene of another shape, with a share of all vertices."""
        count = vertices_of(self._n_vertices, share)
        how = count, self._where(map.domain), self._vectors
        return Scene(self._frame, self._textures.of(image), map, *how)

    def _suits(self, scene: Scene, share: float) -> bool:
        """Whether a scene is evaluated where a new one would be, and about as fine."""
        edited = scene is self.scene
        where = scene.evaluated_in if edited else self._where(scene.domain)
        fine = suits(scene, vertices_of(self._n_vertices, share))
        return where == scene.evaluated_in and fine

    def _where(self, domain: Domain) -> EvaluatedIn:
        """Who evaluates the map of a shape that is not edited."""
        if self._asked is not None:
            return self._asked
        if not ShaderMap(domain).fits(self._vectors):
            return "kernel"
        return "page" if self._evaluated_in == "page" else "shader"

    def _share(self, domain: Domain) -> float:
        return self._around.share(domain, self._drawing.map.domain)

    @property
    def _multisamples(self) -> bool:
        """Whether edges of the mesh are smooth. Without a graphics processor that takes most of the
        time, and soft edges of a picture, and lines, are smooth without."""
        return self._evaluated_in != "page"

    def _replace_renderer(self) -> None:
        old, self._renderer = self._renderer, replacement(self._renderer, self._multisamples)
        self.children = [self.stage, self._renderer]
        self.stage.renderer = self._renderer
        old.layout.close()
        old.close()

    def _size_renderer(self, _: Any = None) -> None:
        self._renderer.width, self._renderer.height = self.stage.width, self.stage.height

    def _new_backdrop(self, background: Backdrop) -> BackdropMesh | None:
        return None if background is None else BackdropMesh(background, self._frame)

    def _show_backdrop(self, _: Any = None) -> None:
        """Draw the background; under a reference the page shows it, below its renderer."""
        behind, under = self._background, bool(self.stage.reference)
        if self._backdrop is not None:
            self._backdrop.mesh.visible = not under
        if isinstance(behind, tuple):
            behind = np.array([[(*behind, 255)]], dtype=np.uint8)  # one pixel, which is stretched
        self.stage.behind_reference = displayed(behind if under else None)

    @property
    def _meshes(self) -> list[Any]:
        behind = [] if self._backdrop is None else [self._backdrop.mesh]
        return [*behind, *stacked_meshes(self.scene, self._around.in_order(self.scene))]

    def _free(self) -> None:
        self.scene.close()
        self._around.close()
        self._textures.keep([])
        if self._backdrop is not None:
            self._backdrop.close()


def emptiest_corner(
    points: Any, width: int, height: int, bars: int = 1, loops: Sequence[Array] = ()
) -> str:
    """The corner where colour bars hide least of a shape's ``loops``, inside too, and of (k, 2)
    ``points``. Places are CSS pixels from the lower left."""
    x, y = np.asarray(points, dtype=float).reshape(-1, 2).T
    parts = [shapely.make_valid(shapely.Polygon(loop)) for loop in loops]
    shape = functools.reduce(shapely.symmetric_difference, parts, shapely.Point())
    across, up = min(_LEGEND_SIZE[0], _LEGEND_SHARE * width), bars * _LEGEND_SIZE[1]

    def hidden(corner: str) -> float:
        left = 0 if "left" in corner else width - across
        bottom = 0 if "bottom" in corner else height - up
        inside = (left < x) & (x < left + across) & (bottom < y) & (y < bottom + up)
        covered = shapely.box(left, bottom, left + across, bottom + up).intersection(shape)
        return float(_POINT * inside.sum() + covered.area)

    return min(CORNERS, key=hidden)  # the first of equally good corners
