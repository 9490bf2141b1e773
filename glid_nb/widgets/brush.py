"""Painting of stiff areas: the brush, its strokes, its controls, the painted areas."""

import functools
from collections.abc import Callable
from typing import Any, Self

import ipywidgets
import numpy as np
import shapely
import traitlets

from glid_nb._arrays import Array
from glid_nb.geometry import Cage
from glid_nb.pose import Stiffness
from glid_nb.session.deformation import Deformation
from glid_nb.session.edit_state import EditError, Moment
from glid_nb.widgets.controls import EditControls, button, toggle
from glid_nb.widgets.gestures import LEFT, Event, PinGestures
from glid_nb.widgets.pad import answer_during_cells

TOOLS = "", "stiff", "erase"
_USUAL_RADIUS, _LARGEST_RADIUS = 0.05, 0.25  # of the shape's longer side
_EDGES = 60  # along the longer side, so that edges bend with the shape


class Brush(traitlets.HasTraits):
    """The brush of the left button. Without a tool, the button does not paint."""

    tool = traitlets.Enum(TOOLS, "")
    radius = traitlets.Float()  # in world units
    strength = traitlets.Float(1.0)  # how stiff, from 0 to 1

    @property
    def shown(self) -> dict[str, Any]:
        """What the page needs to paint, also with a tool that a key chooses there."""
        return {"tool": self.tool, "radius": self.radius, "strength": self.strength}


class BrushGestures(PinGestures):
    """Gestures that pin and drag, or paint with a brush."""

    def __init__(
        self, deformation: Deformation, fit: Callable[[], None], image: Array | None = None
    ) -> None:
        super().__init__(deformation, fit, image)
        self._actions = {**self._actions, "tool": self._take_tool}
        self.brush = Brush(radius=_USUAL_RADIUS * deformation.state.domain.cage.longer_side)

    def on(self, deformation: Deformation, image: Array) -> Self:
        """The same gestures on another shape, with the same brush."""
        other = type(self)(deformation, self._fit, image)
        other.brush, other.copy, other.go_to = self.brush, self.copy, self.go_to
        return other

    def _down(self, event: Event) -> None:
        if not self.brush.tool or event["button"] != LEFT:
            super()._down(event)

    def _up(self, event: Event) -> None:
        if self.brush.tool and self._press is None and event.get("path"):
            self._enter_motion()
            self._paint(np.array(event["path"], dtype=float), event["unit"])
        else:
            super()._up(event)

    def _take_tool(self, event: Event) -> None:
        """Take the tool that a key chose in the page, which has it already."""
        if (tool := event.get("name")) not in TOOLS:
            raise EditError(f"the brush has no tool {tool!r:.40}")
        self.brush.tool = tool

    def _key(self, event: Event) -> None:
        if event["key"] == "Escape" and self.brush.tool:
            self.brush.tool = ""
        else:
            super()._key(event)

    def _paint(self, path: Array, unit: float) -> None:
        """Paint along a path on the canvas, as one step. A line ends where it leaves a limb."""
        brush, places, model = self.brush, path[:1], self.deformation
        if len(path) > 1 and (line := shapely.LineString(path)).length > unit:
            places = shapely.get_coordinates(line.simplify(unit).segmentize(brush.radius / 2))
        sources = model.sheets(self._image).sources(places)
        far = np.linalg.norm(np.diff(sources, axis=0), axis=1) > 2 * brush.radius
        outside = np.isnan(sources[:, 0])
        if outside.all():
            raise EditError("there is no shape here; paint over the shape")
        stiffness = model.pose.stiffness
        strength = brush.strength if brush.tool == "stiff" else 0.0
        for line in np.split(sources, np.flatnonzero(far | outside[1:] | outside[:-1]) + 1):
            if not np.isnan(line).any():
                stiffness = stiffness.painted(line, brush.radius, strength)
        model.set_stiffness(stiffness)


class BrushBar(EditControls):
    """Controls of a brush. They replace ``other`` while the brush has a tool."""

    def __init__(self, deformation: Deformation, brush: Brush, other: ipywidgets.DOMWidget) -> None:
        look: Any = {"layout": {"width": "auto"}, "style": {"description_width": "60px"}}
        most = _LARGEST_RADIUS * deformation.state.domain.cage.longer_side
        size = {"min": most / 50, "max": most, "step": most / 50, "tooltip": "Of the brush"}
        self.size = ipywidgets.FloatSlider(description="Size", readout=False, **size, **look)
        look |= {"min": 0.1, "max": 1.0, "step": 0.1, "tooltip": "How stiff it makes the shape"}
        self.strength = ipywidgets.FloatSlider(description="Strength", readout_format=".1f", **look)
        ipywidgets.link((brush, "radius"), (self.size, "value"))
        ipywidgets.link((brush, "strength"), (self.strength, "value"))
        self.erase = toggle("Erase", "eraser", "Erase (E)", {"width": "auto"})
        answer_during_cells(self.erase)  # in the pad's thread: before the stroke that follows
        chosen = lambda tool: tool == "erase", lambda on: "erase" if on else "stiff"
        ipywidgets.link((brush, "tool"), (self.erase, "value"), chosen)
        clear = functools.partial(self._act, lambda: deformation.set_stiffness(Stiffness()))
        self.clear = button("Clear", "trash", "Erase all stiff areas", clear)
        buttons = ipywidgets.HBox([self.erase, self.clear]).add_class("glid-wide")
        shown = [self.size, self.strength, buttons]
        super().__init__(deformation, [ipywidgets.GridBox(shown)])
        self.children[0].add_class("glid-pin")
        this, that = (self.layout, "display"), (other.layout, "display")
        ipywidgets.dlink((brush, "tool"), this, lambda tool: None if tool else "none")
        ipywidgets.dlink((brush, "tool"), that, lambda tool: "none" if tool else None)

    def _show(self) -> None:
        self.clear.disabled = not self.deformation.pose.stiffness


def painted_areas(moment: Moment) -> list[Any]:
    """The stiff areas of the deformed shape: for each, its strength and its loops of [x, y]."""
    state = moment.state
    return [
        [strength, [np.round(moment.shown(loop), 3).tolist() for loop in loops]]
        for strength, loops in _outlines(state.pose.stiffness, state.domain.cage)
    ]


@functools.lru_cache(maxsize=2)
def _outlines(stiffness: Stiffness, cage: Cage) -> list[tuple[float, list[Array]]]:
    """Strengths and loops (n, 2) of the undeformed areas. Holes have the opposite orientation."""
    outlines = []
    for strength, part in stiffness.within(cage).items():
        fine = shapely.segmentize(shapely.normalize(part), cage.longer_side / _EDGES)
        rings = shapely.get_rings(shapely.get_parts(fine))
        outlines.append((strength, [shapely.get_coordinates(ring)[:-1] for ring in rings]))
    return outlines
