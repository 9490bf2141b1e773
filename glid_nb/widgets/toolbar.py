"""The bar above the canvas."""

from collections.abc import Callable
from typing import Any

import ipywidgets
import traitlets

from glid_nb.page import bundle, stylesheet
from glid_nb.widgets.canvas import DeformCanvas
from glid_nb.widgets.closing import ClosingWidget
from glid_nb.widgets.monitor import SolverMonitor
from glid_nb.widgets.overlays import OVERLAYS
from glid_nb.widgets.pad import answer_during_cells
from glid_nb.widgets.page_widget import PageWidget

_CHECKS = (
    ("show_cage", "Cage", "Draw the cage"),
    ("show_offset_cage", "Offset", "Draw the offset cage, which carries the basis"),
    ("show_panels", "Certificate", "Colour the boundary by its certified margin"),
    ("show_source", "Source", "Show the undeformed shape beside the result"),
    ("plots", "Plots", "Show energy, steps and certificate of the solve"),
)


class Toolbar(ClosingWidget, PageWidget):
    """Tools, undo and redo, what the canvas shows, and its view."""

    _script = traitlets.Unicode(bundle("toolbar")).tag(sync=True)
    _css = stylesheet("toolbar")

    tool = traitlets.Enum(("", "stiff", "erase"), "").tag(sync=True)
    """The brush's tool; empty while pins are selected and dragged."""
    overlay = traitlets.Unicode("texture").tag(sync=True)  # what the shape shows
    overlays = traitlets.List(
        traitlets.List(), [[name, overlay.label] for name, overlay in OVERLAYS.items()]
    ).tag(sync=True)
    """Names and labels of what the shape can show."""
    checks = traitlets.List(traitlets.List(), list(map(list, _CHECKS))).tag(sync=True)
    """Names, labels and descriptions of what else can be shown."""
    shows = traitlets.Dict({}).tag(sync=True)
    """For each name of the checks, whether it is shown."""
    referenced = traitlets.Bool(False).tag(sync=True)  # whether there is a reference picture
    can_undo = traitlets.Bool(False).tag(sync=True)  # whether there is something to undo
    can_redo = traitlets.Bool(False).tag(sync=True)  # whether there is something to redo

    def __init__(self, canvas: DeformCanvas, monitor: SolverMonitor, **kwargs: Any) -> None:
        self.deformation = model = canvas.deformation  # the model of this view
        self._shown: dict[str, tuple[traitlets.HasTraits, str]] = {
            name: (monitor, "shown") if name == "plots" else (canvas, name) for name, *_ in _CHECKS
        }
        super().__init__(**kwargs)
        answer_during_cells(self)  # in the pad's thread: before the stroke that follows
        ipywidgets.link((canvas, "overlay"), (self, "overlay"))
        stage = canvas.pane.stage
        ipywidgets.dlink((stage, "reference"), (self, "referenced"), bool)
        ipywidgets.link((canvas.brush, "tool"), (self, "tool"))
        for one, name in self._shown.values():
            one.observe(self._show_checks, [name])
        self.observe(self._check, ["shows"])
        self._acts: dict[str, Callable[[], object]] = {"undo": model.undo, "redo": model.redo}
        self.on_msg(lambda _, message, __: self._acts[message["type"]]())
        self._show_checks()
        self._show("state")
        self._endings = (model.observe(self._show),)

    def _show_checks(self, _: Any = None) -> None:
        self.shows = {name: getattr(*shown) for name, shown in self._shown.items()}

    def _check(self, change: Any) -> None:
        for name, shows in change["new"].items():
            one, trait = self._shown[name]
            one.set_trait(trait, shows)

    def _show(self, what: str) -> None:
        if what == "state" and not self._closed:
            model = self.deformation
            self.can_undo, self.can_redo = model.can_undo, model.can_redo
