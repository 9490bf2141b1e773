"""The pad over a renderer."""

from __future__ import annotations

from typing import Any

import ipywidgets
import numpy as np
import traitlets

from glid_nb.widgets.bundle import bundle, stylesheet
from glid_nb.widgets.pad import Pad

_REFERENCE: dict[str, Any] = ipywidgets.widget_serialization

CORNERS = ("bottom right", "bottom left", "top right", "top left")
"""Places of a colour bar, the usual one first."""

_LEGEND_SIZE = np.array([222, 75])  # CSS pixels, with its distance to the border


class Stage(Pad):
    """Lies over a pythreejs renderer.

    It draws handles and targets, sends pointers and keys to the kernel in world coordinates, pans
    and zooms without the kernel, and puts a map's coefficients into the renderer's materials.
    """

    _esm = bundle("canvas/main.js")
    _css = stylesheet("canvas/canvas.css")

    width = traitlets.Int(600).tag(sync=True)
    """Width in CSS pixels; the page changes it when the corner is dragged."""

    height = traitlets.Int(500).tag(sync=True)
    """Height in CSS pixels."""

    view = traitlets.List(traitlets.Float(), [0.0, 0.0, 0.04]).tag(sync=True)
    """Centre (x, y) in world units, and the world units of one CSS pixel."""

    coefficients = traitlets.Bytes(b"").tag(sync=True)
    """The map, as ``ShaderMap.wire`` writes it; empty where the kernel evaluates."""

    marks = traitlets.Dict({"targets": [], "images": [], "selected": []}).tag(sync=True)
    """Targets and images of the handles, lists of [x, y], and indices of those selected."""

    cursor = traitlets.List(default_value=None, allow_none=True).tag(sync=True)
    """Where the keyboard's cursor is, [x, y]; None while it is not used."""

    legend = traitlets.Dict({}).tag(sync=True)
    """The overlay's colour bar: ``title``, ``colors`` and ``ticks``; empty for none."""

    panel_legend = traitlets.Dict({}).tag(sync=True)
    """The certificate's colour bar, below the overlay's."""

    legend_corner = traitlets.Enum(CORNERS, CORNERS[0]).tag(sync=True)
    """Where the colour bars are."""

    notice = traitlets.Unicode("").tag(sync=True)
    """Why the last action was refused; empty for nothing."""

    interactive = traitlets.Bool(True).tag(sync=True)
    """Whether the pad takes pointers and keys."""

    uniform_vectors = traitlets.Int(0).tag(sync=True)
    """How many vectors of uniforms the page's shaders hold; 0 while unknown."""

    drawing_time = traitlets.Float(0.0).tag(sync=True)
    """Milliseconds that the page needs to draw the renderer once; 0 while unknown."""

    drawn = traitlets.Bool(False).tag(sync=True)
    """Whether a page has drawn it."""

    renderer = traitlets.Instance(ipywidgets.Widget).tag(sync=True, **_REFERENCE)
    """The pythreejs renderer below."""

    camera = traitlets.Instance(ipywidgets.Widget).tag(sync=True, **_REFERENCE)
    """Its camera."""

    materials = traitlets.List([]).tag(sync=True, **_REFERENCE)
    """The materials that take the coefficients."""


def emptiest_corner(points: Any, width: int, height: int, bars: int = 1) -> str:
    """The corner of :data:`CORNERS` where colour bars hide the fewest points.

    ``points`` are (k, 2), in CSS pixels from the lower left of a pad of this size.
    """
    x, y = np.asarray(points, dtype=float).T
    beside = {"left": x < _LEGEND_SIZE[0], "right": x > width - _LEGEND_SIZE[0]}
    tall = bars * _LEGEND_SIZE[1]
    level = {"bottom": y < tall, "top": y > height - tall}

    def hidden(corner: str) -> int:
        vertical, horizontal = corner.split()
        return int((level[vertical] & beside[horizontal]).sum())

    return min(CORNERS, key=hidden)  # the first of equals


def marks_of(targets: Any, images: Any, selected: Any) -> dict[str, Any]:
    """The trait ``marks``: points rounded to what a screen can show."""
    rounded = {"targets": np.round(targets, 5), "images": np.round(images, 5)}
    return {**{k: points.tolist() for k, points in rounded.items()}, "selected": list(selected)}
