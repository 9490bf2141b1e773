"""A tracing for the page: plain JSON values and the picture's bytes."""

from __future__ import annotations

import dataclasses
import functools
import io
import math
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from PIL import Image

from glid_nb.imaging import Hole, TraceOptions
from glid_nb.widgets.tracer_gestures import TraceGestures

_LONGEST_SIDE = 1600  # of the picture that the page draws; the cage is traced on the original
_LISTED_HOLES = 40
_MOST_POINTS = 200  # of a hole's outline, and of a stroke


def described(gestures: TraceGestures) -> dict[str, Any]:
    """The state of a tracing and its tools; points in pixels, rounded to hundredths."""
    model = gestures.model
    frame, outcome = model.frame, model.outcome
    tracing = outcome.tracing
    scribbles = model.state.scribbles
    return {
        "size": None if frame is None else [frame.width, frame.height],
        "loops": [_rounded(loop) for loop in model.loops],
        "problems": [
            {"message": p.plain, "point": None if p.point is None else _rounded(p.point)}
            for p in outcome.problems
        ],
        "options": _options(model.options),
        "automatic": None
        if tracing is None
        else {
            "method": tracing.method,
            "threshold": tracing.threshold,
            "offset": tracing.offset,
            "simplify": tracing.simplify,
        },
        "component": 0 if tracing is None else tracing.component.rank,
        "n_components": 0 if tracing is None else tracing.n_components,
        "component_area": 0 if tracing is None else tracing.component.area,
        "holes": [_hole(hole) for hole in model.holes[:_LISTED_HOLES]],
        "n_holes": len(model.holes),
        "notes": [] if tracing is None else list(tracing.notes),
        "strokes": {
            brush: _strokes(None if scribbles is None else getattr(scribbles, brush))
            for brush in ("foreground", "background")
        },
        "can_undo": model.can_undo,
        "can_redo": model.can_redo,
        "edited": model.edited,
        "discarded": model.has_discarded_edits,
        "tool": gestures.tool,
        "selected": [list(vertex) for vertex in gestures.selected],
    }


def displayed(image: NDArray[np.uint8] | None) -> bytes:
    """A picture for the page: PNG, or JPEG when nothing is transparent; empty without one."""
    if image is None:
        return b""
    picture = Image.fromarray(image)
    scale = _LONGEST_SIDE / max(picture.size)
    if scale < 1:
        size = (max(1, round(picture.width * scale)), max(1, round(picture.height * scale)))
        picture = picture.resize(size, Image.Resampling.LANCZOS, reducing_gap=2.0)
    buffer = io.BytesIO()
    if image[..., 3].min() == 255:
        picture.convert("RGB").save(buffer, format="JPEG", quality=92)
    else:
        picture.save(buffer, format="PNG", compress_level=3)
    return buffer.getvalue()


def _options(options: TraceOptions) -> dict[str, Any]:
    names = (f.name for f in dataclasses.fields(options) if f.name != "scribbles")
    values = {name: getattr(options, name) for name in names}
    if values["max_edge"] == math.inf:
        values["max_edge"] = "never"
    return values


@functools.lru_cache(maxsize=256)  # by identity; most changes leave the holes as they are
def _hole(hole: Hole) -> dict[str, Any]:
    ring = shapely.LinearRing(hole.loop)
    loop = shapely.get_coordinates(ring.simplify(0.5))[:-1]
    if len(loop) > _MOST_POINTS:
        loop = loop[:: math.ceil(len(loop) / _MOST_POINTS)]
    return {
        "loop": _rounded(loop),
        "area": round(hole.area, 1),
        "kept": hole.kept,
        "by_offset": hole.by_offset,
    }


def _strokes(strokes: Any) -> list[list[list[float]]]:
    if strokes is None or isinstance(strokes, np.ndarray):
        return []
    return [_rounded(stroke) for stroke in strokes]


def _rounded(points: Any) -> Any:
    return np.round(points, 2).tolist()
