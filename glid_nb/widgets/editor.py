"""The editor: trace, pin, drag."""

import base64
import html
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import ipywidgets
import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image

from glid_nb import export
from glid_nb._errors import plainly
from glid_nb._jax import once_loaded
from glid_nb._runtime import enable_compilation_cache
from glid_nb.certificate import Certificate
from glid_nb.geometry import Domain, MeshMap
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.backdrop import WHITE
from glid_nb.imaging.read import ImageSource, png, read_image
from glid_nb.imaging.render import View
from glid_nb.motion import Motion
from glid_nb.pose import Pose
from glid_nb.session.ahead import ProgramsAhead
from glid_nb.session.animation import PartAnimation
from glid_nb.session.deformation import Deformation
from glid_nb.session.document import Document, DocumentError, NamedPose
from glid_nb.session.edit_state import EditError
from glid_nb.session.editor_model import EditorModel, KeptWorkError, Shape, find_document
from glid_nb.session.first_minute import IN_THIS_SESSION
from glid_nb.session.look import Behind, Layers
from glid_nb.session.part_sources import PartSources, named_parts, parts_in
from glid_nb.session.scenery import Scenery
from glid_nb.session.status_line import StatusLine
from glid_nb.session.tracing import TracingState
from glid_nb.solvers import Method
from glid_nb.widgets import exporting
from glid_nb.widgets.brush import BrushBar
from glid_nb.widgets.canvas import DeformCanvas, check_size
from glid_nb.widgets.closing import ClosingWidget, close_with_parts, one_a_cell
from glid_nb.widgets.controls import REFUSED, paragraph
from glid_nb.widgets.file_panel import FilePanel, KeptOffer, OpenPanel
from glid_nb.widgets.live_editor import LiveEditor
from glid_nb.widgets.monitor import SolverMonitor
from glid_nb.widgets.motion_panel import MotionPanel
from glid_nb.widgets.parts_panel import PartsPanel
from glid_nb.widgets.pins import PinBar
from glid_nb.widgets.solver_panel import SolverPanel
from glid_nb.widgets.timeline import TimelinePanel
from glid_nb.widgets.toolbar import Toolbar
from glid_nb.widgets.tracer import CageTracer

_TRACE, _DEFORM = 0, 1
_PIN, _FILES = 0, 2  # of the inspector's sections
_LEAST_SIZE = 240  # CSS pixels, of the Trace tab, and of a canvas whose corner is dragged
_PLOTS_SIZE = 460, 382  # CSS pixels
_PLOTS = "Show energy, steps and certificate of the solve"
_EMPTY = "Open a picture in the Trace tab; the shape appears here."
_NO_OUTLINE = (
    "There is no outline yet, as {}. Paint over the shape in the Trace tab, or use the guess there."
)

_LEFT = (
    "{left} was changed elsewhere and stays as it is; this session is saved to {path} from now on."
)
_NOT_SAVED = (
    "The session could not be saved: {error}. The next change tries again; "
    "Save in the section Files writes it elsewhere."
)


class Editor(ClosingWidget, ipywidgets.VBox):
    """Trace a picture, pin points on it, and drag them. The picture follows and never folds over.

    The Trace tab finds the cage, the Deform tab moves it. If the outline is only a guess, as on
    most photographs, the Trace tab is open at first, without an outline, and asks for strokes over
    the shape. Code can do the same: `trace`, `add_handle`, `drag`, `solve`, `save`, `load`,
    `export`.

    The image is as in `glid_nb.read_image`; without one the editor asks for a file. A folder of PNG
    pictures of the same size opens as parts, in the order of their names, the rearmost first, and a
    Photoshop file as its visible layers (with ``glid-nb[psd]``). ``parts`` gives the pictures of
    several shapes instead, as a list or by names. Parts have one timeline, and each has its own
    cage and proof. Every change
    updates the session file ``path``. If this file exists, the editor opens it (give the same
    picture or none). If another session is opened later, its file is updated instead. If another
    picture is opened later, it is saved to a new file beside ``path``. The session also goes to a
    new file if another program changes its file.

    The canvas is ``width`` by ``height`` CSS pixels, at least 240 each, narrower if there is less
    room. By default it is as large as there is room. ``n_vertices``, at least 3, is the size of the
    mesh for the picture; by default 10,000, or as many as the page draws within 40 ms. The shape of
    a photograph is cut out (`cut_out`). ``background`` is what lies behind it at first, by default
    that of the session file.
    With ``plots``, plots of energy, steps and certificate are shown at first.

    Raises a TraceError when the picture cannot be read, a DocumentError when the session file
    cannot be read or belongs to another picture, a TypeError or ValueError for a wrong size.

    >>> import glid_nb as glid
    >>> editor = glid.Editor(glid.samples.image("bar"), n_vertices=500)
    >>> left, right = editor.add_handle((-6, 0)), editor.add_handle((6, 0))
    >>> editor.drag(right, to=(5.5, 2))
    >>> editor.solve()
    True
    >>> editor.map([[6, 0]]).round(2)
    array([[5.5, 2. ]])
    >>> editor.certificate.certified
    True
    >>> editor.close()
    """

    _displayed = False
    _section: int | None = _PIN  # of the inspector, before a brush was chosen
    _told_path: Path | None = None
    _live: tuple[Domain, LiveEditor] | None = None
    _layers: Layers | None = None  # what the canvas draws
    _around: list[tuple[Shape, bool]] | None = None  # the shapes around it on the canvas
    _edited = 0  # the key of the part that the canvas edits
    _ahead: ProgramsAhead | None = None

    @one_a_cell
    def __init__(
        self,
        image: ImageSource | None = None,
        path: str | Path | None = None,
        *,
        parts: PartSources | None = None,
        width: int | None = None,
        height: int | None = None,
        n_vertices: int | None = None,
        background: Behind = None,
        plots: bool = False,
        **kwargs: Any,
    ) -> None:
        self._size = check_size(_LEAST_SIZE, n_vertices, width=width, height=height)
        self._plots = plots
        self._asked = {"width": width, "height": height, "n_vertices": n_vertices}
        once_loaded(enable_compilation_cache)
        if parts is None and (layers := parts_in(image)) is not None:
            parts, image = layers, None
        document = None if path is None else find_document(path)
        known = None if document is None else document.image
        if known is not None and image is not None and not np.array_equal(read_image(image), known):
            what = f"{path} exists and is of another picture; leave the picture out to continue"
            raise DocumentError(f"{what} that session, or give another path")
        pictures = None if parts is None or document is not None else named_parts(parts)
        self.model = EditorModel(image, document=document, path=path, parts=pictures)
        """The editor without its widgets."""
        if background is not None:
            self.background = background
        self.canvas: DeformCanvas | None = None
        """The canvas of the Deform tab; None while nothing is traced."""
        self._parts: dict[str, Any] = {}
        # Keep these boxes: if the tabs' children changed, the page would select another tab.
        self._trace_box, self._deform_box = ipywidgets.VBox(), ipywidgets.VBox()
        boxes = [self._trace_box, self._deform_box]
        self.tabs = ipywidgets.Tab(boxes, titles=("Trace", "Deform"), selected_index=_DEFORM)
        """The two tabs."""
        # Without height, the text covers other parts instead of moving them.
        covering = {"display": "none", "height": "0", "margin": "0", "overflow": "visible"}
        self.unsaved = ipywidgets.HTML(layout=covering)
        """Why the session file is not up to date; hidden if it is."""
        self.kept = KeptOffer(self.model)
        """Offers the kept work of an earlier editor of the picture; hidden if there is none."""
        super().__init__([self.unsaved, self.kept, self.tabs], **kwargs)
        self.add_class("glid-editor")
        self._build()
        show = {"replaced": self._build, "saved": self._show_saving, "look": self._show_look}
        self.model.observe(lambda what: show[what]())
        self.tabs.observe(self._on_tab, ["selected_index"])
        self._endings = (self._take_down, self._close_live, self.model.close)

    def __repr__(self) -> str:
        """The text that a notebook shows if it cannot show widgets."""
        if not self.model.has_shape:
            return "Editor(nothing traced yet)"
        state = self.deformation.state
        handles = f"{len(state.pose)} handles in {state.current.name!r}"
        return f"Editor({len(state.poses)} poses, {handles})"

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        """The widget, and the present picture for pages without a kernel."""
        self._displayed = True
        self._begin()  # JAX is imported while the picture is compressed
        bundle, image = super()._repr_mimebundle_(**kwargs), self.model.tracing.image
        if bundle is not None and image is not None:
            bundle["image/png"] = base64.b64encode(self._snapshot(image)).decode()
        return bundle

    def _display_(self) -> Any:
        """What marimo shows, which has no pythreejs."""
        if not self.model.has_shape:
            return "Nothing is traced yet. Pass a picture: glid_nb.Editor(image)."
        return self.live

    @property
    def live(self) -> LiveEditor:
        """The edited pose as a live editor, one for each domain.

        Poses from its page come back to this editor, which solves them with JAX. Raises an
        InputError for an energy that the page's solver does not have.
        """
        current, known = self.deformation.state.current, self._live
        if known is not None and known[0] is current.map.domain:
            return known[1]
        how = {"energy": current.energy, "p2p_weight": current.options.p2p_weight}
        live = LiveEditor(self.model.layers.image, current.map, current.pose, **how)
        self._close_live()
        self._live = current.map.domain, live
        live.observe(lambda _: self.deformation.set_pose(live.pose), ["edit"])
        return live

    def _snapshot(self, image: NDArray[np.uint8]) -> bytes:
        if self.model.has_shape and len(self.pose):
            frame = {"size": max(self._size), "format": "apng"}
            layers, behind = self.model.layers, self.model.background
            frame |= {"background": WHITE if behind is None else behind}
            if len(shapes := exporting.shown_shapes(self.model)) > 1:
                parts = [
                    export.StillPart(s.layers.image, s.state.map, s.state.pose) for s in shapes
                ]
                return export.parts_png(parts, background=frame["background"])
            return export.animation_bytes(layers.image, [self.map], [self.pose], **frame)
        picture = Image.fromarray(image)
        picture.thumbnail(self._size)
        return png(np.asarray(picture))

    # These parts are made when the canvas is drawn and the model is at rest, or on first use.

    @property
    def tracer(self) -> CageTracer:
        """The Trace tab."""
        return self._part("tracer")

    @property
    def solver_panel(self) -> SolverPanel:
        """The solver's controls in the section Proof."""
        return self._part("solver")

    @property
    def files(self) -> FilePanel:
        """The section Files beside the canvas."""
        return self._part("files")

    # From code

    @property
    def deformation(self) -> Deformation:
        """The model of the Deform tab."""
        return self.model.deformation

    @property
    def map(self) -> HarmonicMap:
        """The certified map."""
        return self.deformation.state.map

    @property
    def comparison(self) -> MeshMap | None:
        """The uncertified map of a method on a mesh; None for other methods."""
        return self.deformation.moment.comparison

    @property
    def certificate(self) -> Certificate:
        """The proof of `map`."""
        return self.deformation.certificate

    @property
    def pose(self) -> Pose:
        """Handles and targets of the edited pose."""
        return self.deformation.state.pose

    @property
    def poses(self) -> tuple[NamedPose, ...]:
        """All poses."""
        return self.deformation.state.poses

    @property
    def motion(self) -> Motion:
        """The motion of the timeline through all poses. The poses are solved first.

        Raises a MotionError if there is only one pose or no motion joins two of them, an EditError
        if a pose cannot be solved, for example while the solver is paused.
        """
        self.deformation  # noqa: B018 - raises an EditError if there is no shape yet
        return self.timeline.animation.motion

    @property
    def status(self) -> StatusLine:
        """The status of the editor in words."""
        return self.deformation.status

    @property
    def document(self) -> Document:
        """Picture, cage and poses as one value."""
        return self.model.document

    @property
    def background(self) -> Behind:
        """What lies behind the shape on the canvas and in exports: a colour (red, green, blue),
        ``"filled"`` for the old picture with the hole filled in, or None for transparent."""
        return self.model.look.background

    @background.setter
    def background(self, background: Behind) -> None:
        self.model.set_look(replace(self.model.look, background=background))

    @property
    def cut_out(self) -> bool:
        """Whether the shape of an opaque picture is cut out with soft edges, as in
        `glid_nb.cut_out`. Otherwise all inside the cage is drawn."""
        return self.model.look.cut_out

    @cut_out.setter
    def cut_out(self, cut_out: bool) -> None:
        self.model.set_look(replace(self.model.look, cut_out=cut_out))

    def trace(self, **options: Any) -> None:
        """Trace with changed options (fields of `glid_nb.TraceOptions`), and deform the result.

        Raises a TraceError for an unknown option or a value out of range, an EditError if the
        editor is closed.
        """
        if self._closed:
            raise EditError("the editor is closed")
        self.model.tracing.set_options(**options)
        self.model.apply_tracing()

    def add_handle(self, point: ArrayLike, to: ArrayLike | None = None) -> int:
        """Pin a point of the undeformed shape. Returns the handle's index."""
        return self.deformation.add_handle(point, to)

    def drag(self, handle: int, to: ArrayLike) -> None:
        """Drag a handle's target. The shape follows in the background."""
        self.deformation.drag(handle, to)

    def set_method(self, method: Method | str, **settings: Any) -> None:
        """Solve with another method of `glid_nb.methods`, or its name. Methods on a mesh are for
        comparison only.

        Raises a MethodError if the method is unknown, cannot minimise the energy, or lacks its
        package.
        """
        self.deformation.set_method(method, **settings)

    def solve(self, timeout: float | None = None) -> bool:
        """Wait until the shape is at rest and all poses are solved, also after a change of the
        cage. Returns False if that takes longer than ``timeout`` seconds."""
        return self.deformation.solve(timeout)

    def export(
        self,
        path: str | Path,
        size: tuple[int, int] | None = None,
        view: View = "source",
        *,
        live: bool = False,
    ) -> tuple[Path, ...]:
        """Export the pose as .png, .obj, .glb, .svg, .html, .py or .proof.json, or the session as
        .glid. The suffixes .gif, .apng, .mp4, .webm, .sheet.png, .zip and .motion.json export the
        motion.

        With ``live=True``, or the suffix .live.html, a page has a solver of its own. Its reader
        drags the pins in any browser, without Python and without a network
        (`export.live_page_html`). With several poses it holds their motion.

        ``size`` and ``view`` of a picture are as in `glid_nb.render`. Returns the written files:
        ``path``, then additional files, such as ``-texture.png`` of a mesh, or ``.map.json`` of a
        proof (``glid-check x.map.json x.proof.json``). Exported poses are solved first. Raises an
        EditError if that is not possible, for example while the solver is paused. Raises an
        ExportError for another suffix, or if an additional file would replace another file.
        """
        return exporting.export(self.model, path, size, view, live)

    def save(self, path: str | Path) -> None:
        """Write a session file. Its poses are solved first, or later when the file is opened."""
        self.model.save(path)

    def load(self, path: str | Path) -> None:
        """Continue with a session file."""
        self.model.load(path)

    # The widgets

    def _build(self) -> None:
        with self.model.locked():
            self._take_down()
            self._parts, self.canvas = {}, None
            self._boxes = {"tracer": self._trace_box}
            if self.model.has_shape:
                self._deform_box.children = [self._deform_tab()]
            else:
                self._nothing = ipywidgets.HTML()
                self._deform_box.children = [self._nothing, OpenPanel(self.model)]
                self._show_nothing()
            self.tabs.selected_index = _DEFORM if self.model.has_shape else _TRACE
            self._begin()
            if self.canvas is None:
                self._fill()

    def _begin(self) -> None:
        """Prepare the solver if there is a shape and the editor is displayed."""
        if self._displayed and self.model.has_shape:
            self.deformation.begin()

    def _fill(self, *names: str) -> None:
        """Make the missing ones among these parts, by default among all parts."""
        with self.model.locked():
            for name in names or self._boxes:
                if self._closed:  # perhaps closed since the previous part
                    return
                self._made(name)

    def _fill_at_rest(self) -> None:
        """Make the missing parts once the model rests and a page has drawn the canvas.

        A page that is still connecting may miss a widget that is made meanwhile, and then it cannot
        show what refers to the widget. Voila connects when all cells have run.
        """
        if self.canvas is not None and self.canvas.drawn and self.monitor.rested:
            self._fill()
            with self.model.locked():
                if not self._closed and self._ahead is None:
                    self._ahead = ProgramsAhead(self.deformation)

    def _part(self, name: str) -> Any:
        """A part; made if it is missing. Raises a RuntimeError if the editor is closed."""
        if self._closed and name not in self._parts:
            raise RuntimeError("the editor is closed; this part of it was never made")
        return self._made(name)

    def _made(self, name: str) -> Any:
        makers: dict[str, Callable[[], ipywidgets.Widget]] = {
            "tracer": lambda: CageTracer(
                model=self.model.tracing, height=self._asked["height"], on_pieces=self._keep_pieces
            ),
            "pins": self._bars,
            "motion": lambda: MotionPanel(self.deformation, self._open_files),
            "solver": lambda: SolverPanel(self.deformation),
            "files": lambda: FilePanel(self.model, self.timeline.animation),
        }
        with self.model.locked():
            if name not in self._parts:
                try:
                    part = self._parts[name] = makers[name]()
                except Exception as error:  # show it, because nobody reads the kernel's log
                    what = paragraph(f"{type(error).__name__}: {error}", REFUSED)
                    self._boxes[name].children = [ipywidgets.HTML(what)]
                    raise
                self._boxes[name].children = [part]
                if isinstance(part, FilePanel) and part.motion is not None:
                    ipywidgets.dlink((part.motion.rate, "value"), (self.timeline, "rate"))
            return self._parts[name]

    def _bars(self) -> ipywidgets.VBox:
        """The controls of the pins; the brush's controls replace them while a brush is chosen."""
        assert self.canvas is not None
        pins = PinBar(self.deformation)
        return ipywidgets.VBox([pins, BrushBar(self.deformation, self.canvas.brush, pins)])

    def _show_brush(self, change: Any) -> None:
        """Show the brush's controls while there is a brush, then the section that was open."""
        self.deformation.tell("hand")
        if not change["old"]:
            self._section = self.inspector.selected_index
        if change["new"]:
            self.inspector.selected_index = _PIN
        elif self.inspector.selected_index == _PIN:
            self.inspector.selected_index = self._section

    def _deform_tab(self) -> ipywidgets.Widget:
        model, layers = self.model.deformation, self.model.layers
        self._layers, self._around, self._edited = layers, None, self._edited_key
        self._known_parts = {self._edited}  # the keys of the parts that the view was fitted to
        shown = {**self._asked, "background": self.model.background}
        # Before the canvas's own observer: another part comes with its picture.
        model.observe(lambda what: self._show_layers() if what == "state" else None)
        self.canvas = canvas = DeformCanvas(layers.image, model, **shown)
        canvas.on_other_part = self._edit_part
        self.monitor = monitor = SolverMonitor(model, *_PLOTS_SIZE, self._plots, IN_THIS_SESSION)
        self.toolbar = Toolbar(self.canvas, monitor)
        # Make the hidden parts only when the model rests, and the pins' numbers after the first
        # gesture. So the first drag has the processor for itself.
        monitor.observe(lambda _: self._fill_at_rest(), ["rested"])
        canvas.pane.stage.observe(lambda _: self._fill_at_rest(), ["drawn"])
        canvas.brush.observe(self._show_brush, ["tool"])
        model.observe(lambda what: self._fill("pins") if what == "hand" else None)
        self.timeline = TimelinePanel(self.canvas, self._open_files)
        self.timeline.on_play = self._on_play
        self.parts = PartsPanel(self.model)
        """The list of the parts; hidden if there is only one shape."""
        self._show_parts()
        # Fill these boxes later: if the tab's children changed, the page would select another tab.
        names = "pins", "motion", "files", "solver"
        self._boxes |= {name: ipywidgets.VBox() for name in names}
        self._boxes["pins"].add_class("glid-bars")
        plots_shown = ipywidgets.ToggleButton(
            description="Plots", icon="line-chart", tooltip=_PLOTS
        )
        ipywidgets.link((monitor, "shown"), (plots_shown, "value"))
        proof = ipywidgets.VBox([monitor.verdict, plots_shown, self._boxes["solver"]])
        for section in (self._boxes["files"], proof):
            section.add_class("glid-whole")
        pins = ipywidgets.VBox([self.parts, self._boxes["pins"]])
        sections = [pins, *(self._boxes[name] for name in names[1:-1]), proof]
        titles = "Pin", "Motion", "Files", "Proof"
        self.inspector = ipywidgets.Tab(sections, titles=titles, selected_index=_PIN)
        """The sections beside the canvas."""
        self.inspector.observe(lambda _: self._fill(), ["selected_index"])
        self.inspector.add_class("glid-skin").add_class("glid-side")
        plots = monitor.plots.add_class("glid-plots-box")
        visible = (plots.layout, "display"), lambda shown: None if shown else "none"
        ipywidgets.dlink((monitor, "shown"), *visible)
        parts = [self.toolbar, canvas, self.inspector, self.timeline, monitor.line, plots]
        return ipywidgets.GridBox(parts).add_class("glid-shell")

    def _on_play(self) -> None:
        IN_THIS_SESSION.made("play")
        self.deformation.tell("status")

    def _open_files(self) -> None:
        self.inspector.selected_index = _FILES
        self.files.show_motion()

    def _take_down(self) -> None:
        with self.model.locked():
            shown = (*self._trace_box.children, *self._deform_box.children)
            if self._ahead is not None:
                self._ahead.close()
                self._ahead = None
            if self.canvas is not None:
                shown += (self.monitor,)
            self._trace_box.children = self._deform_box.children = ()
        close_with_parts(*shown)

    def _close_live(self) -> None:
        if self._live is not None:
            self._live[1].close()

    def _show_saving(self) -> None:
        error, left, path = self.model.save_error, self.model.left_path, self.model.autosave_path
        if error is not None:
            kept = isinstance(error, KeptWorkError)
            text = html.escape(str(error) if kept else _NOT_SAVED.format(error=plainly(error)))
            self.unsaved.value = f'<p class="glid-unsaved">{text}</p>'
        self.unsaved.layout.display = "none" if error is None else "block"
        if left is None or path is None or path == self._told_path:
            return
        self._told_path = path
        if self.canvas is not None:
            self.canvas.pane.stage.notice = _LEFT.format(left=left.name, path=path.name)
        if "files" in self._parts:
            self.files.follow_autosave()

    def _show_look(self) -> None:
        with self.model.locked():
            if not self._closed and self.canvas is not None:
                self._show_layers()
                if "files" in self._parts:
                    self.files.look.follow()

    def _show_layers(self) -> None:
        """Let the canvas draw the picture as it is cut out by the present cage."""
        with self.model.locked():
            if self._closed or self.canvas is None:
                return
            layers, edited = self.model.layers, self._edited_key
            if layers is self._layers:
                self._show_parts()
                return
            self._layers = layers
            if edited != self._edited:
                self._edited = edited
                self._around = around = self._shapes_around()
                self.canvas.edit(self.deformation, layers.image, [_scenery(*one) for one in around])
                self._accompany()
            else:
                self.canvas.set_picture(layers.image, self.model.background)
                self._show_parts()
            self.timeline.set_picture()

    @property
    def _edited_key(self) -> int:
        state = self.deformation.state
        return state.keys[state.part]

    def _shapes_around(self) -> list[tuple[Shape, bool]]:
        """The visible parts that are not edited, and whether each is in front of that one."""
        shapes, edited = self.model.shapes, self.deformation.state.part
        return [(s, i > edited) for i, s in enumerate(shapes) if s.visible and i != edited]

    def _show_parts(self) -> None:
        """Let the canvas draw the other parts, if anything of them has changed."""
        state = self.deformation.state
        if self.canvas is None or not (state.parts or self._around):
            return
        before, around = self._around or [], self._shapes_around()
        self._around = around
        if [_look_of(*one) for one in before] != [_look_of(*one) for one in around]:
            self.canvas.show_scenery([_scenery(*one) for one in around])
            self._accompany()
        if new := {shape.key for shape, _ in around} - self._known_parts:
            self._known_parts |= new
            self.canvas.fit()

    def _accompany(self) -> None:
        animation = self.timeline.animation
        keys = [shape.key for shape, _ in self._around or []]
        self.timeline.accompany({str(key): PartAnimation(animation, key) for key in keys})

    def _keep_pieces(self, pieces: list[TracingState]) -> None:
        """Keep the other pieces of the picture or of a cut as parts, and show them."""
        self.model.keep_pieces(pieces)
        self.tabs.selected_index = _DEFORM

    def _edit_part(self, key: str, _: Any) -> None:
        """Edit the part that was pressed on the canvas."""
        self.deformation.select_part(self.deformation.state.keys.index(int(key)))

    def _on_tab(self, change: Any) -> None:
        self._fill()
        if change["new"] == _DEFORM:
            doubt = self.model.tracing.doubt
            notice = _NO_OUTLINE.format(doubt) if doubt else self.model.apply_tracing()
            if self.canvas is None:
                self._show_nothing()
            elif notice:
                self.canvas.pane.stage.notice = notice

    def _show_nothing(self) -> None:
        """Say in the Deform tab why there is nothing to deform yet."""
        doubt = self.model.tracing.doubt
        text = _NO_OUTLINE.format(doubt) if doubt else _EMPTY
        self._nothing.value = paragraph(text, "padding:2em")


def _look_of(shape: Shape, above: bool) -> tuple[Any, ...]:
    """What the canvas draws of a shape, to be compared: objects by their identities."""
    return shape.key, shape.layers, shape.state.current, shape.name, above


def _scenery(shape: Shape, above: bool) -> Scenery:
    state = shape.state
    return Scenery(str(shape.key), shape.layers.image, state.map, state.order, above, shape.name)
