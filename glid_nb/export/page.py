"""A web page that shows a result: one file, no network, nothing to install."""

from __future__ import annotations

import base64
import html
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glid_nb.certificate import Certificate, global_injectivity
from glid_nb.certificate.rounding import rounded_down, rounded_up
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import PixelFrame, as_rgba8
from glid_nb.imaging.mesh import deformed_mesh
from glid_nb.imaging.read import png
from glid_nb.solvers import Pose

_FOLDER = Path(__file__).parent
_VERTICES = 4000
_TOLERANCE = 0.004  # world units; the picture is 20 long
_MARGIN = 0.04  # of the canvas, as in a rendering with view="fit"
# By the verdict on global injectivity.
_OVERLAPS = {
    "yes": "no part lies over another",
    "no": "parts of the shape lie over one another",
    "undecided": "whether parts lie over one another is not known",
}


def page_html(
    image: ArrayLike,
    map: HarmonicMap,
    certificate: Certificate | None = None,
    title: str = "Deformed picture",
    tolerance: float = _TOLERANCE,
    pose: Pose | None = None,
) -> str:
    """A page that shows the warped picture, with zoom and pan.

    It holds the triangulated shape and the picture; its security policy blocks the network. The
    image, (h, w), (h, w, 3) or (h, w, 4), is the one that the map's cage was traced from. With its
    certificate the page states the map's bounds and whether the shape overlaps itself. The mesh's
    straight edges may stray from the map by the tolerance in world units. The depths of a pose say
    which part is in front where the shape overlaps itself.
    """
    texture = as_rgba8(image)
    height, width = texture.shape[:2]
    mesh = deformed_mesh(map, _VERTICES, tolerance, pose)
    heights = mesh.heights - mesh.heights.mean()
    places = PixelFrame(width, height).to_pixel(mesh.vertices) / [width, height]
    data = {
        "deformed": _base64(mesh.images.astype("<f4")),
        "heights": _base64((heights / (2 * np.ptp(heights) or 1.0)).astype("<f4")),
        "source": _base64(mesh.vertices.astype("<f4")),
        "texture": _base64(places.astype("<f4")),
        "triangles": _base64(mesh.triangles.astype("<u4")),
        "bounds": _bounds(mesh.images),
        "source_bounds": _bounds(mesh.vertices),
        "margin": _MARGIN,
        "picture": "data:image/png;base64," + _base64(png(texture)),
    }
    parts = {
        "title": html.escape(title),
        "caption": html.escape(_caption(map, certificate)),
        "style": _read("page.css"),
        "script": _read("page.js"),
        "data": json.dumps(data, allow_nan=False),
    }
    # One pass, so that inserted text is not searched for placeholders.
    return re.sub(r"\{\{(\w+)\}\}", lambda found: parts[found[1]], _read("page.html"))


def _caption(map: HarmonicMap, certificate: Certificate | None) -> str:
    if certificate is None or not certificate.certified:
        return ""
    whole = global_injectivity(map, certificate)
    return (
        f"Proved not to fold over or tear at any point; {_OVERLAPS[whole.verdict]}. "
        f"Bounds: σ₂ ≥ {rounded_down(certificate.sigma2_lower)}, "
        f"σ₁ ≤ {rounded_up(certificate.sigma1_upper)}, k ≤ {rounded_up(certificate.k_upper)}"
    )


def _bounds(points: NDArray[np.float64]) -> list[float]:
    return [*points.min(axis=0).tolist(), *points.max(axis=0).tolist()]


def _base64(data: Any) -> str:
    return base64.b64encode(data).decode("ascii")


def _read(name: str) -> str:
    return (_FOLDER / name).read_text(encoding="utf-8")
