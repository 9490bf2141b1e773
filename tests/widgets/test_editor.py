"""The editor and its parts without a browser."""

from __future__ import annotations

import base64
import gc
import io
import itertools
import os
import shutil
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import nullcontext
from datetime import UTC, datetime
from pathlib import Path
from queue import Queue
from types import SimpleNamespace
from typing import Any

import ipywidgets
import numpy as np
import pytest
import skimage.data
from PIL import Image

import glid_check
import glid_nb as glid
from glid_nb._runtime import stage
from glid_nb.export import ExportError
from glid_nb.figures.style import COLORS, distortion_colors, rgb
from glid_nb.imaging import TraceError
from glid_nb.imaging.read import png
from glid_nb.session.autosave import flush
from glid_nb.session.deformation import Deformation
from glid_nb.session.document import DocumentError
from glid_nb.session.document_file import load_document
from glid_nb.session.edit_state import EditError, EditState, Moment
from glid_nb.session.editor_model import EditorModel
from glid_nb.widgets import DeformCanvas, Editor, SolverMonitor
from glid_nb.widgets.file_panel import OpenPanel
from glid_nb.widgets.overlays import N_COLORS, OVERLAYS, color_range, legend
from glid_nb.widgets.pane import emptiest_corner
from glid_nb.widgets.pins import PinBar

from ..support import from_page
from ..support.domains import domain
from ..support.preparation import FIRST_REPORT, Preparation
from ..support.threads import NewThreads

pytestmark = pytest.mark.slow  # most of the time is compiling

TIMEOUT = 120.0


def bar() -> np.ndarray:
    """An opaque bar of 16 x 4 units with a hole, 200 x 100 pixels."""
    y, x = np.mgrid[:100, :200]
    picture = np.zeros((100, 200, 4), np.uint8)
    inside = (abs(x - 99.5) < 80) & (abs(y - 49.5) < 20)
    picture[inside & (np.hypot(x - 99.5, y - 49.5) > 8)] = (200, 120, 40, 255)
    return picture


@pytest.fixture(autouse=True)
def no_cache(monkeypatch: pytest.MonkeyPatch) -> None:
    """The process's JAX configuration stays unchanged."""
    monkeypatch.setattr("glid_nb.widgets.editor.enable_compilation_cache", lambda: None)


@pytest.fixture
def editor() -> Iterator[Editor]:
    editor = Editor(bar(), n_vertices=300)
    yield editor
    editor.close()


def test_the_colour_bar_goes_where_it_hides_least() -> None:
    size = 600, 400
    corners = {"bottom right": (550, 20), "bottom left": (30, 30), "top right": (500, 390)}
    assert emptiest_corner(np.empty((0, 2)), *size) == "bottom right"
    assert emptiest_corner([corners["bottom right"], (300, 200)], *size) == "bottom left"
    assert emptiest_corner(list(corners.values()), *size) == "top left"
    twice = [*corners.values(), (10, 395), *corners.values()]
    assert emptiest_corner(twice, *size) == "top left"
    # A head may fill a corner without a point of its outline there.
    head = np.array([(250, -200), (900, -200), (900, 200), (250, 200)], float)
    assert emptiest_corner([], *size, loops=[head]) == "bottom left"
    hole = np.array([(300, -100), (300, 100), (800, 100), (800, -100)], float)
    assert emptiest_corner([(10, 10)], *size, loops=[head, hole]) == "bottom right"


def test_a_colour_bar_says_which_values_share_its_last_colours() -> None:
    def ends(name: str, *range_: float) -> list[str]:
        ticks = legend(name, glid.energies.ARAP(), range_)["ticks"]
        return [ticks[0], ticks[-1]]

    assert ends("sigma1", 1.0, 3.0) == ["≤ 1", "≥ 3"]
    assert ends("sigma2", 1.0, 0.5) == ["≥ 1", "≤ 0.5"]
    assert ends("sigma2", 1.0, 0.0) == ["≥ 1", "0"]  # a map without folds has no other values
    assert ends("k", 0.0, 0.2) == ["0", "≥ 0.2"]
    assert ends("k", 0.0, 1.0) == ["0", "1"]
    assert ends("energy", *color_range("energy", glid.energies.ARAP())) == ["0", "≥ 0.1"]


@pytest.mark.parametrize("top", [2.134, 54.6, 5510.3, 1.2345e7, 9.87e201])
def test_the_labels_of_a_colour_bar_do_not_meet(top: float) -> None:
    ticks = legend("energy", glid.energies.SymmetricDirichlet(), (2.0, top))["ticks"]
    sign, end = ticks[-1].split()
    assert (float(ticks[0]), sign, float(end)) == (2.0, "≥", pytest.approx(top, rel=5e-3))
    assert len("".join(ticks)) <= 22  # of 6 pixels, on a bar of 190
    assert len(ticks) == 5 or top > 1e4


def test_the_headless_editor(editor: Editor, tmp_path: Path) -> None:
    assert editor.document.cage.n_holes == 1
    left, right = editor.add_handle((-7, 0)), editor.add_handle((7, 0))
    editor.drag(right, to=(6, 2))
    assert editor.solve(TIMEOUT)
    np.testing.assert_allclose(editor.map([[7, 0]]), [[6, 2]], atol=0.01)
    assert editor.certificate.certified
    assert editor.deformation.status.level == "good"
    assert "certified σ₂ ≥" in editor.monitor.text
    assert left == 0

    # Nothing is lost.
    path = tmp_path / "bar.glid"
    editor.deformation.rename_pose(0, "bent")
    editor.save(path)
    phi = editor.map.phi
    editor.deformation.reset()
    editor.load(path)
    assert [pose.name for pose in editor.poses] == ["bent"]
    assert np.array_equal(editor.map.phi, phi)
    assert editor.canvas is not None
    assert editor.canvas.deformation is editor.deformation

    # Exports.
    for suffix in (".png", ".obj", ".glb", ".svg", ".html", ".py"):
        for file in editor.export(tmp_path / f"out{suffix}"):
            assert file.stat().st_size > 100
    (live,) = editor.export(tmp_path / "out.html", live=True)
    assert "glidPage" in live.read_text(encoding="utf-8")
    assert editor.export(tmp_path / "out.live.html") == (tmp_path / "out.live.html",)
    with pytest.raises(ExportError, match=r"must end in \.html"):
        editor.export(tmp_path / "out.png", live=True)
    proof, map_ = map(str, editor.export(tmp_path / "out.proof.json"))
    assert glid_check.main([map_, proof]) == 0
    with Image.open(editor.export(tmp_path / "big.png", size=(400, 200))[0]) as picture:
        assert picture.size == (400, 200)
        expected = glid.render(bar(), editor.map, size=(400, 200))
        assert np.array_equal(np.asarray(picture), expected)
    with pytest.raises(ExportError, match=r"\.xyz"):
        editor.export(tmp_path / "out.xyz")
    with pytest.raises(glid.InputError, match="at least 2 keyframes"):
        editor.export(tmp_path / "walk.gif")
    editor.deformation.save_pose()
    editor.deformation.reset()
    for suffix in (".gif", ".sheet.png", ".motion.json"):
        for file in editor.export(tmp_path / f"walk{suffix}", size=(64, 32)):
            assert file.stat().st_size > 100
    with Image.open(tmp_path / "walk.gif") as picture:
        assert picture.n_frames > 20
        assert "loop" not in picture.info  # the timeline plays once
    editor.load(path)

    # Tracing again is a step that undo takes back.
    editor.trace(drop_holes=[[100.0, 50.0]])
    assert editor.deformation.state.domain.n_holes == 0
    assert editor.solve(TIMEOUT)
    editor.deformation.undo()
    assert np.array_equal(editor.map.phi, phi)


@pytest.mark.parametrize("name", ["cat", "coffee", "rocket", "astronaut"])
def test_a_photograph_opens_in_trace(name: str) -> None:
    editor = Editor(getattr(skimage.data, name)(), n_vertices=300)
    try:
        assert (editor.tabs.selected_index, editor.canvas) == (0, None)
        shown = editor.tracer.shown
        assert shown["doubt"]
        assert (shown["loops"], shown["holes"], shown["tool"]) == ([], [], "foreground")
        assert shown["n_filled"] == editor.tracer.tracing.n_filled
        editor.tabs.selected_index = 1
        assert editor.canvas is None
        assert "no outline yet" in editor.tabs.children[1].children[0].value
        editor.tabs.selected_index = 0
        editor.tracer.handle([{"type": "draw"}])
        assert editor.tracer.shown["doubt"] == ""
        editor.tabs.selected_index = 1
        assert editor.canvas is not None
        assert editor.document.cage.area > 200
    finally:
        editor.close()


def test_code_deforms_a_guess_without_asking() -> None:
    editor = Editor(skimage.data.coffee(), n_vertices=300)
    assert len(editor.poses) == 1
    assert editor.tabs.selected_index == 1
    assert editor.canvas is not None
    editor.close()


@pytest.mark.parametrize("damaged", [False, True])
def test_the_next_editor_of_a_picture_offers_what_was_done(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, damaged: bool
) -> None:
    monkeypatch.setenv("GLID_NB_DATA", str(tmp_path))
    first = Editor(bar(), n_vertices=300)
    assert first.kept.layout.display == "none"
    first.deformation.paused = True
    first.add_handle((-7, 0))
    first.close()
    again = Editor(bar(), n_vertices=300)
    text, bring, _ = again.kept.children
    assert "Your earlier work on this picture is kept" in text.value
    if damaged:
        again.model.kept.write_bytes(b"")
    bring.click()
    assert len(again.pose) == (0 if damaged else 1)
    assert ("not a saved session" in text.value) == damaged
    assert again.kept.layout.display == ("flex" if damaged else "none")
    again.close()


def test_kept_work_replaces_no_unsaved_work_unasked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("GLID_NB_DATA", str(tmp_path))
    monkeypatch.setattr("glid_nb.widgets.file_panel.DOUBLE_CLICK", 0.0)
    first = Editor(bar(), n_vertices=300)
    first.deformation.paused = True
    first.add_handle((-7, 0))
    first.close()
    again = Editor(bar(), n_vertices=300)
    again.deformation.paused = True
    again.deformation.add_handles([(-7, 0), (7, 0)])
    text, bring, _ = again.kept.children
    bring.click()
    assert len(again.pose) == 2
    assert "Click again to open the other one without saving" in text.value
    assert bring.description == "Replace?"
    bring.click()
    assert len(again.pose) == 1
    assert again.kept.layout.display == "none"
    again.close()


def test_where_no_kernel_runs_a_picture_stands_for_the_editor(editor: Editor) -> None:
    def shown() -> np.ndarray:
        bundle = editor._repr_mimebundle_()
        assert set(bundle) > {"application/vnd.jupyter.widget-view+json", "text/plain"}
        with Image.open(io.BytesIO(base64.b64decode(bundle["image/png"]))) as picture:
            return np.asarray(picture.convert("RGBA"))

    np.testing.assert_array_equal(shown(), bar())
    editor.deformation.paused = True
    editor.add_handle((-7, 0), to=(-7, 0))
    deformed = shown()
    assert max(deformed.shape) == 600
    assert (deformed[..., :3] == (200, 120, 40)).all(axis=2).mean() > 0.3
    empty = Editor()
    assert "image/png" not in empty._repr_mimebundle_()
    empty.close()


def test_a_session_file_is_kept_up_to_date(tmp_path: Path) -> None:
    path = tmp_path / "session.glid"
    editor = Editor(bar(), path=path, n_vertices=300)
    editor.add_handle((-7, 0))
    editor.drag(editor.add_handle((7, 0)), to=(6, 1))
    editor.solve(TIMEOUT)
    phi = editor.map.phi
    editor.close()
    with pytest.raises(ValueError, match="exists and is of another picture"):
        Editor(bar()[:-1], path=path)
    again = Editor(path=path, n_vertices=300)
    assert np.array_equal(again.map.phi, phi)
    assert again.pose.targets.tolist()[1] == [6, 1]
    again.close()


def test_a_save_that_fails_is_shown(tmp_path: Path) -> None:
    folder = tmp_path / "away"
    folder.mkdir()
    editor = Editor(bar(), path=folder / "bar.glid", n_vertices=300)
    saved = threading.Event()
    editor.model.observe(lambda what: saved.set() if what == "saved" else None)
    editor.deformation.paused = True  # nothing here needs a solve

    def change() -> None:
        saved.clear()
        editor.add_handle((-7, len(editor.pose) / 10))
        assert saved.wait(TIMEOUT)

    change()
    assert editor.unsaved.layout.display == "none"
    shutil.move(folder, tmp_path / "moved")
    change()
    assert editor.unsaved.layout.display == "block"
    assert f"The folder {folder} does not exist." in editor.unsaved.value
    assert editor.unsaved.layout.height == "0"  # nothing below it moves
    folder.mkdir()
    change()
    assert editor.unsaved.layout.display == "none"
    shutil.rmtree(folder)
    editor.add_handle((7, 0))
    with pytest.warns(RuntimeWarning, match="not saved"):
        editor.close()


def test_without_a_picture_it_asks_for_one() -> None:
    editor = Editor()
    assert editor.tabs.selected_index == 0
    assert editor.canvas is None
    with pytest.raises(EditError, match="open a picture"):
        editor.add_handle((0, 0))
    editor.close()


def test_the_canvas_shows_what_the_model_holds() -> None:
    threads = NewThreads()
    image = np.full((60, 60, 4), 255, np.uint8)
    canvas = DeformCanvas(image, domain("ring"), n_vertices=200, show_source=True)
    model, stage = canvas.deformation, canvas.pane.stage
    assert model.solve(TIMEOUT)
    model.add_handles([(2, 0), (-2, 0)])
    model.drag(0, to=(2.5, 0.5))
    assert model.solve(TIMEOUT)
    assert stage.marks["targets"] == [[2.5, 0.5], [-2.0, 0.0]]
    np.testing.assert_allclose(stage.marks["images"][0], [2.5, 0.5], atol=1e-3)
    assert stage.coefficients == canvas.pane.scene.shader_map.wire(model.map)
    assert canvas.source is not None
    assert canvas.source.stage.marks["images"] == [[2.0, 0.0], [-2.0, 0.0]]
    for name in OVERLAYS:
        canvas.overlay = name
    assert stage.legend["title"] == "Energy density"
    assert stage.legend_corner == "bottom right"  # a ring leaves all corners free
    stage.view = [-4.0, 4.0, stage.view[2]]  # it is in the bottom right one now
    canvas.overlay = "sigma1"
    assert stage.legend_corner == "bottom left"
    canvas.overlay = "texture"
    assert stage.legend == {}
    canvas.show_panels = True
    assert "panels" in canvas.pane.scene.lines
    assert stage.panel_legend["title"] == "Certified σ₂ on the boundary"
    assert stage.panel_legend["ticks"] == ["≥ 0.5", "0.25", "0"]
    canvas.overlay = "k"  # k has its own colour bar
    assert stage.legend["title"] == "Dilatation k"
    assert stage.panel_legend
    assert stage.legend["colors"] != stage.panel_legend["colors"]
    # Even a bend is visible, and the bar shows the range.
    assert canvas.pane.scene.color_range[1] < 1
    assert stage.legend["ticks"][-1] == f"≥ {canvas.pane.scene.color_range[1]:g}"
    range_ = canvas.pane.scene.picture.material.uniforms["color_range"]["value"]
    assert range_ == list(canvas.pane.scene.color_range)
    model.drag(0, to=(4.5, 1.5))
    assert model.solve(TIMEOUT)
    bar = stage.legend["ticks"]
    model.set_domain(domain("twin"))  # at rest there: another scene, with its own range
    assert canvas.pane.scene.color_range == (0.0, 0.1)
    assert stage.legend["ticks"][-1] == "≥ 0.1" != bar[-1]
    model.undo()
    canvas.overlay = "texture"
    canvas.show_panels = False
    assert stage.legend == stage.panel_legend == {}
    canvas.show_panels = True
    assert len(stage.materials) == 2
    canvas.show_cage = canvas.show_offset_cage = True
    assert len(stage.materials) == 4
    canvas.show_cage = False
    assert len(stage.materials) == 4  # hidden
    model.drop_hole(0)
    assert model.solve(TIMEOUT)
    assert canvas.pane.scene.domain is model.state.domain
    canvas.show_source = False
    assert canvas.source is None
    canvas.close()
    solver = threads.named("live solver")
    if solver is not None:
        solver.join(TIMEOUT)  # closing does not wait for it
        assert not solver.is_alive()


_FIRST_CANVAS = """
import sys
import ipywidgets
import numpy as np
from ipywidgets.widgets import widget
import glid_nb as glid
from glid_nb._runtime import compilation_clock

image = np.zeros((60, 90, 4), np.uint8)
image[10:50, 10:80] = 255
clock = compilation_clock()
editor = glid.Editor(image, n_vertices=300, plots=True)
unwanted = [m for m in ("matplotlib", "skimage.draw") if m in sys.modules]
unwanted += [m for m in sys.modules if m.startswith("glid_nb.export.") and m[15:] != "formats"]
assert not unwanted, unwanted
assert clock.programs == 0, clock.programs
# Axes without anything in them, at once.
assert editor.monitor.image.format == "svg+xml"
assert b"Certificate" in bytes(editor.monitor.image.value)
assert len(widget._instances) <= 100, len(widget._instances)
boxes = [editor._boxes[name] for name in ("tracer", "motion", "files", "solver")]
editor.canvas.pane.stage.drawn = True
# The first drag comes before plots and hidden tabs.
editor.deformation.begin_drag([editor.deformation.add_handles([[4, 0], [-4, 0]])[0]])
editor.deformation.drag_to([[4.5, 0.5]])
assert editor.solve(120)
assert editor.deformation.moment.frame.history
assert editor.monitor.refresh(0.5) is False
assert "matplotlib" not in sys.modules
assert not any(box.children for box in boxes)
editor.deformation.end_drag()
assert editor.monitor.refresh(60)
made = [type(box.children[0]).__name__ for box in boxes]
assert made == ["CageTracer", "MotionPanel", "FilePanel", "SolverPanel"]
assert editor.monitor.image.format == "png"
assert bytes(editor.monitor.image.value).startswith(b"\\x89PNG")
editor.close()
"""


def test_the_first_canvas_waits_for_no_more_than_it_needs(tmp_path: Path) -> None:
    environment = {**os.environ, "GLID_NB_CACHE": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", _FIRST_CANVAS], env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr


def sections(editor: Editor) -> list[Any]:
    """The boxes of the inspector's sections: pin, motion, files, and the solver's in the proof."""
    pin, *boxes, proof = editor.inspector.children
    return [pin.children[-1], *boxes, proof.children[-1]]


def numbers(editor: Editor) -> Any:
    """The box for the numbers of pins and for the brush."""
    return sections(editor)[0]


def test_what_a_hidden_tab_holds_is_there_for_who_asks(editor: Editor) -> None:
    tracer, panel, files = editor.tracer, editor.solver_panel, editor.files
    assert editor.tabs.children[0].children == (tracer,)
    assert [box.children for box in sections(editor)[2:]] == [(files,), (panel,)]
    assert (editor.tracer, editor.solver_panel, editor.files) == (tracer, panel, files)


def test_a_tab_is_filled_when_it_is_chosen(editor: Editor) -> None:
    box = sections(editor)[3]
    assert box.children == ()
    editor.inspector.selected_index = 3
    assert box.children == (editor.solver_panel,)


def test_no_widget_is_made_while_a_page_may_be_connecting(editor: Editor) -> None:
    """It would miss the widget: Voila connects when all cells have run."""
    canvas = editor.canvas
    assert canvas is not None
    editor._repr_mimebundle_()
    made = set(ipywidgets.widgets.widget._instances)
    assert editor.solve(60)
    while not editor.monitor.rested:
        assert editor.monitor.refresh(60)
    assert set(ipywidgets.widgets.widget._instances) == made
    canvas.pane.stage.drawn = True
    assert editor.monitor.refresh(60)
    assert all(box.children for box in sections(editor)[1:])


def test_the_numbers_come_when_the_first_gesture_has_ended(editor: Editor) -> None:
    canvas, box = editor.canvas, numbers(editor)
    assert canvas is not None
    editor.deformation.paused = True
    where = {"x": -7.0, "y": 0.0, "button": 0, "shift": False, "reach": 0.3, "unit": 0.02}
    for step in (0.0, 0.5, 1.0):  # so the first drag has the processor for itself
        canvas.handle([{**where, "type": "move" if step else "down", "x": where["x"] + step}])
        assert box.children == ()
    canvas.handle([{**where, "type": "up"}])
    assert len(editor.pose) == 1
    assert len(box.children) == 1


@pytest.mark.parametrize("event", [{"type": "up"}, {"type": "key", "key": "b"}])
def test_the_numbers_are_made_without_the_models_lock(
    editor: Editor, event: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Another thread may hold the model's lock and wait for the editor's."""
    free: list[bool] = []

    def made(model: Deformation) -> PinBar:
        taken = threading.Event()

        def take() -> None:
            with model.locked():
                taken.set()

        threading.Thread(target=take, daemon=True).start()
        free.append(taken.wait(5.0))
        return PinBar(model)

    monkeypatch.setattr("glid_nb.widgets.editor.PinBar", made)
    editor.deformation.paused = True
    where = {"x": -7.0, "y": 0.0, "button": 0, "shift": False, "reach": 0.3, "unit": 0.02}
    if event["type"] == "up":
        editor.canvas.handle([{**where, "type": "down"}])
    editor.canvas.handle([{**where, **event}])
    assert free == [True]


def test_the_numbers_come_with_the_brush(editor: Editor) -> None:
    assert numbers(editor).children == ()
    editor.toolbar.tool = "stiff"
    assert len(numbers(editor).children) == 1


def test_a_brush_opens_its_section_and_then_the_one_before(editor: Editor) -> None:
    editor.inspector.selected_index = 3
    editor.toolbar.tool = "stiff"
    assert editor.inspector.selected_index == 0
    editor.toolbar.tool = "erase"
    assert editor.canvas.brush.tool == "erase"
    editor.toolbar.tool = ""
    assert editor.inspector.selected_index == 3


def test_the_plots_are_hidden_unless_they_are_asked_for(editor: Editor) -> None:
    monitor = editor.monitor
    assert (monitor.shown, monitor.plots.layout.display) == (False, "none")
    editor.toolbar.shows = {**editor.toolbar.shows, "plots": True, "show_cage": True}
    assert (monitor.shown, monitor.plots.layout.display) == (True, None)
    assert editor.canvas.show_cage
    editor.canvas.show_cage = False
    assert editor.toolbar.shows["show_cage"] is False
    other = Editor(editor.document.image, n_vertices=50, plots=True)
    assert other.monitor.shown
    other.close()


def test_the_motions_controls_change_the_edited_pose(editor: Editor) -> None:
    model = editor.deformation
    model.add_handle((-7.0, 0.0))
    model.save_pose()
    editor.inspector.selected_index = 1
    panel = sections(editor)[1].children[0]
    assert (panel.pose.value, panel.time.value) == (1, "1.00")
    panel.name.value, panel.time.value, panel.easing.value = "Jump", "1,5", "in-out"
    panel.repeat.value = "loop"
    timeline = model.state.timeline
    assert (model.state.poses[1].name, timeline.times) == ("Jump", (0.0, 1.5))
    assert (timeline.easing[1], timeline.repeat) == ("in-out", "loop")
    panel.time.value = "soon"
    assert "is not a number" in panel.refusal.value
    assert panel.time.value == "1.50"
    panel.pose.value = 0
    assert model.state.active == 0
    panel.export.click()
    assert editor.inspector.selected_index == 2
    assert str(editor.files.format.value).startswith("motion")


def test_a_part_that_cannot_be_made_says_why_in_its_place(
    editor: Editor, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(_: object) -> None:
        raise ValueError("no such <option>")

    caught: list[Any] = []
    monkeypatch.setattr(threading, "excepthook", caught.append)
    monkeypatch.setattr("glid_nb.widgets.monitor.REST", 0.0)
    assert editor.canvas is not None
    editor.canvas.pane.stage.drawn = True
    with monkeypatch.context() as patched:
        patched.setattr("glid_nb.widgets.editor.PinBar", fail)
        assert editor.solve(TIMEOUT)
        assert editor.monitor.refresh(TIMEOUT)
        [said] = numbers(editor).children
        assert "ValueError: no such &lt;option&gt;" in said.value
        assert [str(report.exc_value) for report in caught] == ["no such <option>"]  # for the log
    editor.toolbar.tool = "stiff"
    assert said not in numbers(editor).children


def test_the_colours_are_those_of_the_figures() -> None:
    expected = distortion_colors()(np.linspace(0, 1, N_COLORS))[:, :3]
    np.testing.assert_allclose(rgb(COLORS), expected, atol=0.5 / 255 + 1e-9)


def test_a_closed_editor_leaves_no_widget_behind(tmp_path: Path) -> None:
    from ipywidgets.widgets import widget

    before = set(widget._instances)
    editor = Editor(bar(), n_vertices=300)
    canvas = editor.canvas
    assert canvas is not None
    canvas.show_source = canvas.show_panels = True
    editor.add_handle((-7, 0))
    assert editor.solve(TIMEOUT)
    canvas.show_source = False
    editor.trace(drop_holes=[[100.0, 50.0]])
    editor.save(tmp_path / "bar.glid")
    built = len(widget._instances)
    editor.load(tmp_path / "bar.glid")
    assert len(widget._instances) <= built
    editor.close()
    left = [type(widget._instances[name]).__name__ for name in set(widget._instances) - before]
    assert left == []


def test_parts_are_listed_and_closed_with_the_editor() -> None:
    from ipywidgets.widgets import widget

    before = set(widget._instances)
    left, right = np.zeros((60, 90, 4), np.uint8), np.zeros((60, 90, 4), np.uint8)
    left[10:50, 5:40], right[10:50, 50:85] = (220, 30, 30, 255), (30, 30, 220, 255)
    editor = Editor(parts={"left": left, "right": right}, n_vertices=300)
    canvas, panel = editor.canvas, editor.parts
    assert canvas is not None

    def names() -> list[str]:
        return [row["name"] for row in panel.rows.rows]

    def act(kind: str, row: int, **said: Any) -> None:
        key = panel.rows.rows[row]["key"]
        panel.rows.act({"type": kind, "key": key, "keys": [key], **said})

    assert names() == ["right", "left"]
    assert [(s.name, s.above) for s in canvas.scenery] == [("right", True)]
    act("choose", 0)
    assert editor.deformation.state.part == 1
    assert [(s.name, s.above) for s in canvas.scenery] == [("left", False)]
    assert (canvas.image == right).all()
    act("set", 1, name="hidden", on=True)
    assert canvas.scenery == ()
    act("set", 0, name="hidden", on=True)
    assert "only visible part" in panel.refusal.value
    panel.name.value = "front"
    assert names() == ["front", "left"]
    panel.back.click()
    assert names() == ["left", "front"]
    panel.remove.click()
    assert names() == ["left"]
    assert (canvas.image == left).all()
    editor.deformation.undo()
    upload = {"name": "half.png", "content": memoryview(png(left[:, :45]))}
    panel.add.value = (
        {**upload, "type": "image/png", "size": 1, "last_modified": datetime.now(UTC)},
    )
    assert "same size" in panel.refusal.value
    editor.close()
    left_over = [type(widget._instances[n]).__name__ for n in set(widget._instances) - before]
    assert left_over == []


def test_a_closed_editor_makes_nothing_more() -> None:
    editor = Editor(bar(), n_vertices=300)
    tracer = editor.tracer
    editor.close()
    assert editor.tracer is tracer
    with pytest.raises(RuntimeError, match="the editor is closed"):
        _ = editor.solver_panel


def test_a_frame_that_comes_late_finds_the_canvas_closed() -> None:
    from ipywidgets.widgets import widget

    from glid_nb.session.deformation import Deformation

    image = np.full((60, 60, 4), 255, np.uint8)
    with Deformation(domain("ring")) as model:
        assert model.solve(TIMEOUT)
        canvases: list[DeformCanvas] = []
        # Observers are told in turn: this one closes the canvas just before the canvas is told.
        model.observe(lambda _: canvases.pop().close() if canvases else None)
        before = set(widget._instances)
        canvas = DeformCanvas(image, model, n_vertices=200)
        canvas.show_panels = True
        canvases.append(canvas)
        model.drop_hole(0)  # the canvas would draw another scene
        assert model.solve(TIMEOUT)
    assert set(widget._instances) == before


def test_the_numbers_of_pins_and_the_model_show_each_other() -> None:
    from glid_nb.session.deformation import Deformation

    with Deformation(domain("ring"), begin=False) as model:
        model.paused = True  # nothing here needs a solve
        bar = PinBar(model)
        assert bar.list.rows == bar.list.chosen == []
        assert bar.x.disabled
        model.add_handles([(2, 0), (-2, 0.25)])
        model.select([0, 1])
        assert [row["unnamed"] for row in bar.list.rows] == ["Pin 1", "Pin 2"]
        assert [row["detail"] for row in bar.list.rows] == ["2.00, 0.00", "−2.00, 0.25"]
        assert bar.list.chosen == [0, 1]
        assert (bar.x.value, bar.y.value, bar.depth.value) == ("", "", "0")  # x and y differ
        assert bar.count.value == "2 pins"
        model.name_pin(1, "tail")
        assert model.pose.names.tolist() == ["", "tail"]
        assert [(row["number"], row["name"]) for row in bar.list.rows] == [("1", ""), ("2", "tail")]
        bar.back.click()
        assert model.pose.depths.tolist() == [-1, -1]
        assert bar.depth.value == "-1"
        bar.list.act({"type": "choose", "keys": [0]})
        assert model.selection == (0,)
        assert bar.list.chosen == [0]
        bar.x.value = "2,5"
        bar.depth.value = "0,5"
        assert model.pose.targets.tolist() == [[2.5, 0], [-2, 0.25]]
        assert model.pose.depths.tolist() == [0.5, -1]
        for field, refused, needed in (
            (bar.x, "", "is not a number; type a coordinate, such as 7.5<"),
            (bar.y, "abc", "is not a number; type a coordinate"),
            (bar.y, "1e30", "is out of range; type a coordinate"),
            (bar.depth, "1e30", "is out of range; type a depth from -100 to 100<"),
        ):
            field.value = refused
            assert needed in bar.refusal.value
        assert (bar.x.value, bar.y.value, bar.depth.value) == ("2.5", "0", "0.5")
        model.undo()
        assert bar.depth.value == "-1"
        bar.angle.value, bar.scale.value, bar.weight.value = "30", "1,5", 0.01
        assert np.degrees(model.pose.angles[0]) == pytest.approx(30)
        assert (model.pose.scales[0], model.pose.weights[0]) == (1.5, 0.01)
        bar.angle.value = "much"
        assert "is not a number; type an angle" in bar.refusal.value
        assert bar.angle.value == "30"
        for refused in ("-1", "1e9", "0"):
            bar.scale.value = refused
            needed = "is out of range; type a scale from 0.01 to 100, such as 1.5, or nothing"
            assert needed in bar.refusal.value
            assert bar.scale.value == "1.5"
        bar.angle.value = "720"
        assert bar.angle.value == "0"  # not -2.8e-14
        bar.angle.value = ""
        assert np.isnan(model.pose.angles).all()
        bar.mirror.click()
        assert model.pose.handles[:, 0].tolist() == [-2, 2]
        model.undo()
        bar.release.click()
        assert "still moving" in bar.refusal.value
        assert len(model.pose) == 2
        bar.list.act({"type": "choose", "keys": []})
        assert model.selection == ()
        assert bar.depth.disabled
        assert (bar.x.value, bar.name.value, bar.angle.value, bar.weight.value) == ("0", "", "", 1)
        bar.close()


def test_fields_of_several_pins_show_and_set_what_all_of_them_have() -> None:
    from glid_nb.session.deformation import Deformation

    with Deformation(domain("ring"), begin=False) as model:
        model.paused = True  # nothing here needs a solve
        bar = PinBar(model)
        model.add_handles([(2, 0), (-2, 0.25), (0, 2)])
        model.set_pins([0, 1], angles=0.5)
        model.set_pins([0], scales=2, weights=0.01)
        model.select([0, 1])
        assert bar.count.layout.display is None
        fields = bar.x, bar.y, bar.depth, bar.angle, bar.scale, bar.name
        assert [one.value for one in fields] == ["", "", "0", "28.65", "", ""]
        said = ["mixed", "mixed", "", "free", "mixed", "name"]
        assert [one.placeholder for one in fields] == said
        assert "mixed" in bar.weight.tooltip
        assert bar.weight.value == pytest.approx(0.1)  # between them, so that each can be chosen

        def undone(change: Callable[[], None], setter: str, wanted: list[Any]) -> None:
            before = model.state
            change()
            np.testing.assert_array_equal(getattr(model.pose, setter), wanted)
            model.undo()
            assert model.state is before

        undone(lambda: setattr(bar.x, "value", "3"), "targets", [[3, 0], [3, 0.25], [0, 2]])
        undone(lambda: setattr(bar.depth, "value", "2"), "depths", [2, 2, 0])
        undone(lambda: setattr(bar.scale, "value", "1.5"), "scales", [1.5, 1.5, np.nan])
        undone(lambda: setattr(bar.scale, "value", "free"), "scales", [np.nan] * 3)
        undone(lambda: setattr(bar.angle, "value", ""), "angles", [np.nan] * 3)
        undone(lambda: setattr(bar.weight, "value", 1), "weights", [1, 1, 1])
        undone(lambda: setattr(bar.name, "value", "leg"), "names", ["leg", "leg", ""])

        bar.scale.value = "1.5"
        assert (bar.scale.value, bar.scale.placeholder) == ("1.5", "free")
        model.undo()
        bar.scale.value = "much"
        assert "is not a number" in bar.refusal.value
        assert (bar.scale.value, bar.scale.placeholder) == ("", "mixed")

        model.mark_pins([1], locked=True)
        assert bar.count.value == "2 pins, 1 of them locked"
        undone(lambda: setattr(bar.y, "value", "1"), "targets", [[2, 1], [-2, 0.25], [0, 2]])
        model.mark_pins([0], locked=True)
        assert bar.x.disabled
        model.select([2])
        assert bar.count.layout.display == "none"
        assert [one.value for one in fields] == ["0", "2", "0", "", "", ""]
        assert [one.placeholder for one in fields] == ["", "", "", "free", "free", "name"]
        assert "mixed" not in bar.weight.tooltip
        bar.close()


def test_the_panel_and_the_model_show_each_other() -> None:
    from glid_nb.session.deformation import Deformation
    from glid_nb.widgets import SolverPanel

    with Deformation(domain("ring")) as model:
        panel = SolverPanel(model)
        assert model.solve(TIMEOUT)
        model.paused = True  # nothing here needs a solve
        assert panel.pause.value
        assert panel.s.layout.display == "none"  # the energy has none
        panel.energy.value = "amips"
        assert panel.s.layout.display is None
        panel.s.value = 0.5
        assert model.state.current.energy == glid.energies.AMIPS(0.5)
        model.undo()
        model.undo()
        assert panel.energy.value == "iso"
        panel.options.controls["p2p_weight"].value = 1e3
        assert model.state.current.options.p2p_weight == 1e3
        panel.options.controls["hessian"].value = "projected"
        assert model.state.current.options.hessian == "projected"
        # The method, its own settings, and the options that matter for it.
        panel.method.value = "gauss-newton"
        assert "cannot minimise the energy" in panel.refusal.value
        assert panel.method.value == "newton"
        panel.method.value = "lbfgs"
        assert panel.refusal.value == ""
        assert panel.options.controls["hessian"].disabled
        assert not panel.options.controls["sampling"].disabled
        panel.settings.controls["memory"].value = 9
        assert dict(model.state.current.method.settings) == {"memory": 9}
        model.undo()
        assert panel.settings.controls["memory"].value == 5
        panel.method.value = "mls"
        assert "certified map" in panel.about.value
        assert panel.options.controls["p2p_weight"].disabled
        panel.energy.value = "arap"
        panel.method.value = "newton"


def _widgets() -> set[str]:
    from ipywidgets.widgets import widget

    return set(widget._instances)


@pytest.mark.parametrize(
    ("arguments", "kind", "message"),
    [
        ({"n_vertices": 0}, ValueError, "n_vertices is 0; it must be at least 3 vertices"),
        ({"n_vertices": "a"}, TypeError, "n_vertices must be a whole number of vertices, not 'a'"),
        ({"width": -5}, ValueError, "width is -5; it must be at least 240 pixels"),
        ({"height": 0}, ValueError, "height is 0; it must be at least 240 pixels"),
        ({"width": "a"}, TypeError, "width must be a whole number of pixels, not 'a'"),
        ({"height": 300.5}, TypeError, "height must be a whole number of pixels, not 300.5"),
        ({"path": "."}, DocumentError, "is a folder"),
        ({"path": "no/a.glid"}, DocumentError, "does not exist"),
    ],
)
def test_wrong_arguments_are_refused_and_leave_nothing(
    arguments: dict[str, Any], kind: type[Exception], message: str
) -> None:
    before = _widgets()
    with pytest.raises(kind, match=message):
        Editor(bar(), **arguments)
    if "path" not in arguments:
        with pytest.raises(kind, match=message.replace("240", "100")):
            DeformCanvas(bar(), domain("ell"), **arguments)
    gc.collect()  # warnings are errors, so a dropped canvas that complains fails here
    assert _widgets() == before


def test_a_canvas_that_cannot_be_made_is_dropped_quietly(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object, **__: object) -> None:
        raise MemoryError

    complaints: list[Any] = []
    monkeypatch.setattr("sys.unraisablehook", complaints.append)
    monkeypatch.setattr("glid_nb.widgets.pane.Scene", fail)
    with pytest.raises(MemoryError):
        DeformCanvas(bar(), domain("ell"))
    gc.collect()
    assert not complaints


@pytest.mark.parametrize("timeout", ["a", [1.0]])
def test_a_timeout_that_is_no_number_is_refused(editor: Editor, timeout: Any) -> None:
    with pytest.raises(TypeError, match="timeout must be Real or None"):
        editor.solve(timeout)


def test_the_monitor_draws_plots_and_words() -> None:
    from glid_nb.session.deformation import Deformation

    with Deformation(domain("ring")) as model:
        monitor = SolverMonitor(model, 400, 300)
        model.add_handles([(2, 0), (-2, 0)])
        model.drag(0, to=(2.5, 0.5))
        assert model.solve(TIMEOUT)
        assert monitor.refresh(TIMEOUT)
        assert bytes(monitor.image.value).startswith(b"\x89PNG")
        assert "Converged · certified σ₂ ≥" in monitor.line.said.value
        before = bytes(monitor.image.value)
        model.drag(0, to=(3.0, 1.0))
        assert model.solve(TIMEOUT)
        assert monitor.refresh(TIMEOUT)
        assert bytes(monitor.image.value) != before
        monitor.close()


def test_frames_are_counted_in_words() -> None:
    observers: list[Callable[[str], None]] = []

    def observe(observer: Callable[[str], None]) -> Callable[[], None]:
        observers.append(observer)
        return observers.clear

    working = Moment(EditState.initial(domain("ell")), None, busy=True, paused=False)
    model: Any = SimpleNamespace(observe=observe, moment=working, begun=False, locked=nullcontext)
    monitor = SolverMonitor(model, plots=False)
    assert monitor.text == "Preparing the solver…"
    observers[0]("frame")
    assert monitor.text == "Preparing the solver… · 1 frame/s"
    observers[0]("frame")
    assert monitor.text == "Preparing the solver… · 2 frames/s"
    monitor.close()


def test_a_comparison_is_drawn_in_place_of_the_map(editor: Editor) -> None:
    canvas = editor.canvas
    assert canvas is not None
    editor.add_handle((-7, 0))
    editor.drag(editor.add_handle((7, 0)), to=(-9, 0))
    editor.deformation.paused = True  # only the comparison is solved here
    editor.set_method("mls")
    editor.deformation.paused = False
    assert editor.solve(TIMEOUT)
    scene, certified = canvas.pane.scene, editor.map
    comparison = editor.deformation.moment.comparison
    assert comparison is not None
    assert comparison.flipped.any()
    assert scene.comparison is not None
    assert canvas.pane.stage.materials == scene.comparison.materials
    np.testing.assert_allclose(canvas.pane.stage.marks["images"][1], [-9, 0], atol=1e-3)
    assert "turned over" in editor.monitor.text
    assert editor.monitor.refresh(TIMEOUT)
    canvas.overlay = "sigma1"
    assert editor.map is certified
    editor.add_handle((0, 1.5))  # another triangulation
    assert editor.solve(TIMEOUT)
    assert canvas.pane.scene.comparison is not scene.picture
    editor.deformation.paused = True
    editor.set_method("newton")
    assert scene.comparison is None
    assert canvas.pane.stage.materials == [layer.material for layer in scene.layers]


def test_colour_ranges_fit_the_map_in_round_steps() -> None:
    energy = glid.energies.SymmetricDirichlet()
    one = np.ones(100)

    def end(name: str, stretch: float, **least: tuple[float, float]) -> float:
        """The ends of the colours for a map that stretches one direction."""
        fz, fzb = one * (stretch + 1) / 2, one * (stretch - 1) / 2
        return color_range(name, energy, fz, fzb, **least)[1]

    assert [end("sigma1", s) for s in (1, 1.2, 1.4, 2.4, 90)] == [1.25, 1.25, 1.5, 3, 10]
    assert [end("sigma2", s) for s in (1, 0.9, 0.7, 0.1)] == [0.8, 0.8, 0.5, 0]
    assert [end("k", s) for s in (1, 1.3, 2)] == [0.1, 0.2, 0.5]
    np.testing.assert_allclose([end("energy", s) for s in (1, 1.5, 2)], [2.2, 2.5, 4.0])
    assert end("sigma1", 1.2, least=(1.0, 2.0)) == 2  # it only widens


def test_a_cell_with_picture_and_file_can_run_again(tmp_path: Path) -> None:
    path = tmp_path / "bar.glid"
    first = Editor(bar(), path=path, n_vertices=300)
    first.deformation.paused = True
    first.add_handle((-7, 0))
    first.add_handle((7, 0))  # within the interval of the autosave
    again = Editor(bar(), path=path, n_vertices=300)
    assert again.pose.handles.tolist() == [[-7, 0], [7, 0]]
    for editor in (first, again):
        editor.close()


def test_a_cell_that_runs_again_stops_the_solver_of_its_first_editor(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The new editor stops it from the beginning on. If that raises, the first editor goes on."""
    begun, may_end, busy, run = Queue[None](), Queue[None](), list[bool](), itertools.count()

    def prepared(*_: object, **__: object) -> None:
        begun.put(None)
        may_end.get(timeout=TIMEOUT)
        stage("compile")

    class Model(EditorModel):
        def __init__(self, *arguments: Any, **named: Any) -> None:
            busy.append(first.deformation.busy)
            super().__init__(*arguments, **named)

    monkeypatch.setattr("glid_nb.session.live_solver.solve", prepared)
    monkeypatch.setattr("glid_nb.widgets.closing.widgets_of_cells", {})
    monkeypatch.setattr("glid_nb.widgets.closing.running_cell", lambda: ("cell", str(next(run))))
    first = Editor(bar(), n_vertices=300)
    first.add_handle((-7, 0))
    begun.get(timeout=TIMEOUT)
    monkeypatch.setattr("glid_nb.widgets.editor.EditorModel", Model)
    with pytest.raises(TraceError):
        Editor(np.zeros(3))
    assert busy == [False]
    assert first.deformation.busy
    may_end.put(None)
    begun.get(timeout=TIMEOUT)  # it prepares again
    first.add_handle((7, 0))
    assert len(first.pose) == 2
    again = Editor(bar(), n_vertices=300)
    assert busy == [False, False]
    with pytest.raises(EditError, match="closed"):
        first.add_handle((0, 1))
    may_end.put(None)
    again.close()


def test_a_file_of_another_editor_is_left_and_told(tmp_path: Path) -> None:
    path = tmp_path / "bar.glid"
    first, second = (Editor(bar(), path=path, n_vertices=300) for _ in range(2))
    for editor, point in ((first, (-7, 0)), (second, (7, 0))):
        editor.deformation.paused = True
        editor.add_handle(point)
        flush(path)
        flush(tmp_path / "bar-2.glid")
    assert second.canvas is not None
    assert "bar.glid was changed elsewhere" in second.canvas.pane.stage.notice
    assert "saved to bar-2.glid" in second.canvas.pane.stage.notice
    assert Path(second.files.path.value).name == "bar-2.glid"
    assert first.canvas is not None
    assert not first.canvas.pane.stage.notice
    for editor in (first, second):
        editor.close()
    for name, x in (("bar.glid", -7), ("bar-2.glid", 7)):
        assert load_document(tmp_path / name).poses[0].pose.handles.tolist() == [[x, 0]]


def test_lost_handles_are_told(editor: Editor) -> None:
    editor.deformation.paused = True
    editor.add_handle((-7.5, 1.5))
    editor.tabs.selected_index = 0
    tracing, exterior = editor.model.tracing, editor.deformation.state.domain.cage.exterior
    corner = int(np.argmin(np.hypot(*(exterior - [-8, 2]).T)))
    assert tracing.frame is not None
    tracing.move_vertex(0, corner, tracing.frame.to_pixel([-6.5, 0.5]))
    editor.tabs.selected_index = 1
    assert editor.canvas is not None
    assert "A pin was outside the new outline" in editor.canvas.pane.stage.notice
    assert len(editor.pose) == 0


def test_what_becomes_of_the_tracing_is_told(editor: Editor) -> None:
    tracing, frame = editor.model.tracing, editor.model.tracing.frame
    assert frame is not None
    editor.tabs.selected_index = 0
    corner = int(np.argmin(np.hypot(*(editor.deformation.state.domain.cage.exterior - [-8, 2]).T)))
    tracing.move_vertex(0, corner, frame.to_pixel([20, -1]))
    editor.tabs.selected_index = 1
    assert editor.canvas is not None
    assert "not valid yet" in editor.canvas.pane.stage.notice
    editor.tabs.selected_index = 0
    tracing.undo()
    tracing.open(glid.samples.image("bar")[::-1])
    editor.tabs.selected_index = 1
    assert "comes back with Undo in the Trace tab" in editor.canvas.pane.stage.notice
    editor.tabs.selected_index = 0
    tracing.undo()
    editor.tabs.selected_index = 1
    assert "comes back with Redo in the Trace tab" in editor.canvas.pane.stage.notice


def test_a_closed_editor_refuses() -> None:
    editor = Editor(bar(), n_vertices=300)
    editor.close()
    for change in (
        lambda: editor.add_handle((-7, 0)),
        lambda: editor.trace(offset=3),
        editor.solve,
    ):
        with pytest.raises(EditError, match="closed"):
            change()


def test_an_empty_editor_opens_sessions(editor: Editor, tmp_path: Path) -> None:
    editor.save(tmp_path / "bar.glid")
    empty = Editor(n_vertices=300)
    panel = empty.tabs.children[1].children[1]
    assert isinstance(panel, OpenPanel)
    panel.path.value = str(tmp_path / "none")
    panel.button.click()
    assert "none.glid" in panel.message.value
    panel.path.value = str(tmp_path / "bar")
    panel.button.click()
    assert empty.document.cage.equals(editor.document.cage)
    assert empty.tabs.selected_index == 1
    empty.close()


def test_the_solver_is_prepared_as_soon_as_the_editor_is_displayed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def solve(*_: object, **__: object) -> None:
        raise EditError("nothing is solved here")

    monkeypatch.setattr("glid_nb.session.live_solver.solve", solve)
    model = Deformation(domain("ring"), begin=False)
    for widget in (Editor(bar(), n_vertices=300), DeformCanvas(bar(), model, n_vertices=300)):
        assert not widget.deformation.begun
        widget._repr_mimebundle_()
        assert widget.deformation.begun
        widget.close()


def test_the_canvas_says_how_far_the_solver_is_prepared_and_answers_meanwhile(
    editor: Editor, monkeypatch: pytest.MonkeyPatch
) -> None:
    preparation = Preparation.instead_of_solving(monkeypatch)
    model, stage = editor.deformation, editor.canvas.pane.stage
    answers: list[dict[str, Any]] = []
    monkeypatch.setattr(stage, "send", lambda content, **_: answers.append(content))

    def click(number: int, x: float) -> None:
        place = {"x": x, "y": 1.5, "unit": 0.04, "reach": 0.5, "button": 0, "shift": False}
        events = [
            {"type": kind, "seq": 2 * number + i, "time": 0, **place}
            for i, kind in enumerate(("down", "up"))
        ]
        from_page.send(stage, {"view": "page", "events": events})

    model.begin()
    preparation.go_on("basis", "rows", "trace")
    assert stage.prepared == 0.3
    click(1, -6.0)
    click(2, 6.0)
    assert [answer["ack"] for answer in answers] == [3, 5]
    assert len(model.pose) == 2
    preparation.go_on(FIRST_REPORT)
    assert stage.prepared == 1.0
    answers.clear()
    click(3, 0.0)
    assert answers == []  # the next frame answers
    editor.close()
    preparation.go_on("rows", wait=False)
