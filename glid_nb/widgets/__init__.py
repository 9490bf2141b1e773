"""The notebook's user interface: thin views of plain models. Only this layer knows the browser."""

from glid_nb.widgets.canvas import DeformCanvas
from glid_nb.widgets.editor import Editor
from glid_nb.widgets.live_editor import LiveEditor
from glid_nb.widgets.monitor import SolverMonitor
from glid_nb.widgets.solver_panel import SolverPanel
from glid_nb.widgets.timeline import TimelinePanel as TimelinePanel
from glid_nb.widgets.tracer import CageTracer

__all__ = ["CageTracer", "DeformCanvas", "Editor", "LiveEditor", "SolverMonitor", "SolverPanel"]
