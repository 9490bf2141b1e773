"""Why an action was refused stays on the canvas until it can be read."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import ipywidgets
import pytest

from glid_nb.energies import by_name
from glid_nb.methods import METHODS
from glid_nb.pose import Pose, PoseError, in_both
from glid_nb.session.animation import Animation
from glid_nb.session.deformation import Deformation
from glid_nb.session.document import DocumentError
from glid_nb.session.edit_state import EditError
from glid_nb.session.editor_model import EditorModel
from glid_nb.solvers import MethodError
from glid_nb.widgets import DeformCanvas, Editor
from glid_nb.widgets.file_panel import OpenPanel
from glid_nb.widgets.gestures import PinGestures
from glid_nb.widgets.pins import PinBar
from glid_nb.widgets.solver_panel import SolverPanel

from ..support import shapes
from ..support.domains import domain


def test_a_refusal_in_a_drag_stays_until_the_next_gesture() -> None:
    with Deformation(domain("ring"), begin=False) as model:
        model.paused = True  # nothing here needs a solve
        canvas = DeformCanvas(shapes.picture(), model, n_vertices=200)

        def send(*kinds: str, x: float = 2.0, y: float = 0.0, **more: Any) -> str | None:
            event = {"x": x, "y": y, "button": 0, "shift": False, "reach": 0.3, "unit": 0.02}
            return canvas.handle([{**event, "type": kind, **more} for kind in kinds])

        def shown() -> str:
            return canvas.pane.stage.notice

        model.add_handle((2, 0))
        model.select([0])
        model.set_method("mls")
        send("down", x=3, part="turn")
        refused = send("move", y=1, part="turn")
        assert refused is not None
        assert "cannot hold the angle" in refused
        for _ in range(3):
            assert send("move", y=2, part="turn") is None
            assert shown() == refused
        send("up", y=2)
        assert shown() == refused
        send("down", x=2)
        assert shown() == ""

        # A batch that begins another gesture shows what that one does.
        send("cancel")
        send("down", x=3, part="turn")
        assert send("move", y=1, part="turn") == shown() == refused
        assert send("up", "down", "move", x=2) is None
        assert shown() == ""
        canvas.close()


def test_the_editor_names_pins_as_its_list_does_and_python_handles() -> None:
    with Deformation(domain("ring"), begin=False) as model:
        model.paused = True  # nothing here needs a solve
        bar, solver = PinBar(model), SolverPanel(model)
        model.add_handles([(2, 0), (-2, 0)])
        model.select([1])

        model.set_method("mls")
        bar.angle.value = "30"
        assert "the angle or the scale of pin 2;" in bar.refusal.value
        with pytest.raises(MethodError, match="the angle or the scale of handle 1;"):
            model.set_pins([1], angles=0.5)

        model.set_method("newton")
        model.set_pins([0], angles=0.5)
        solver.method.value = "mls"
        assert "the angle or the scale of pin 1;" in solver.refusal.value
        assert solver.method.value == "newton"

        bar.list.act({"type": "set", "key": 7, "name": "locked", "on": True})  # just removed
        assert "there is no pin 8; the pose has 2" in bar.refusal.value
        with pytest.raises(EditError, match="there is no handle 7; the pose has 2"):
            model.mark_pins([7], locked=True)

        twice = {"handles": [[1, 0], [1, 0]], "targets": [[1, 0], [1, 0]]}
        pasted = PinGestures(model, lambda: None)
        refused = pasted.handle([{"type": "paste_pose", "text": json.dumps(twice)}])
        assert refused is not None
        assert "pins 1 and 2 are the same point (1, 0); remove one" in refused
        with pytest.raises(PoseError, match="handles 0 and 1 are the same point"):
            Pose(**twice)
        bar.close()
        solver.close()


def test_what_a_solve_refuses_names_pins_in_the_editor(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: Any, **__: Any) -> None:
        raise MethodError(*in_both(lambda named: f"no map holds {named(0)}"))

    monkeypatch.setattr("glid_nb.session.live_solver.solve", refuse)
    with Deformation(domain("ring"), begin=False) as model:
        animation = Animation(model)
        model.add_handles([(2, 0), (-2, 0)])
        model.save_pose("A")
        model.move_target(0, (2.2, 0))
        model.solve()
        assert model.status.text == "no map holds pin 1"
        with pytest.raises(EditError, match="'A 1' could not be solved: no map holds handle 0"):
            model.solved_state()
        with pytest.raises(EditError) as refused:
            model.solved_state()
        assert "no map holds pin 1" in refused.value.plain
        assert animation.wait(10)
        assert "no map holds pin 1" in animation.spans[0].reason
        animation.close()


def test_a_session_with_a_pin_outside_names_it_as_the_list_does(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("GLID_NB_DATA", str(tmp_path / "data"))
    model = EditorModel(shapes.picture())
    model.deformation.paused = True  # nothing here needs a solve
    model.deformation.add_handles([(6.5, 0), (-6.5, 0)])
    good, bad = tmp_path / "good.glid", tmp_path / "bad.glid"
    model.save(good)
    with zipfile.ZipFile(good) as archive, zipfile.ZipFile(bad, "w") as changed:
        for name in archive.namelist():
            data = archive.read(name)
            if name == "document.json":
                document = json.loads(data)
                document["poses"][0]["handles"][1] = [0, 0]  # in the hole
                data = json.dumps(document).encode()
            changed.writestr(name, data)

    panel = OpenPanel(model)
    panel.path.value = str(bad)
    panel.button.click()
    assert "pin 2 at (0, 0) lies outside the domain" in panel.message.value
    with pytest.raises(DocumentError, match=r"bad\.glid: .*handle 1 at \(0, 0\) lies outside"):
        model.load(bad)
    model.close()


def test_no_control_of_the_editor_speaks_of_handles() -> None:
    editor = Editor(shapes.picture(), n_vertices=200)
    editor.deformation.paused = True
    editor.deformation.add_handles([(6.5, 0), (-6.5, 0)])
    editor.deformation.tell("hand")  # makes the section of the pins
    parts = editor.solver_panel, editor.files
    texts: set[str] = set()
    for name, method in METHODS.items():
        if not method.available():
            continue
        if method.energies is not None:
            editor.deformation.set_method("newton")  # which can minimise them all
            editor.deformation.set_energy(by_name(method.energies[0]))
        editor.deformation.set_method(name)
        texts |= set(_said(editor))
    assert all(part in set(_within(editor)) for part in parts)
    assert any("Weight λ" in text for text in texts)
    assert [text for text in texts if "handle" in text.lower()] == []
    editor.close()


def _said(widget: ipywidgets.Widget) -> Iterator[str]:
    """The texts of a widget and of all that it holds."""
    for one in _within(widget):
        texts = (getattr(one, name, None) for name in ("description", "tooltip", "placeholder"))
        yield from (text for text in (*texts, getattr(one, "value", None)) if isinstance(text, str))


def _within(widget: ipywidgets.Widget) -> Iterator[ipywidgets.Widget]:
    """A widget and all that it holds."""
    yield widget
    for child in getattr(widget, "children", ()):
        yield from _within(child)
