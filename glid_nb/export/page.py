"""A web page that shows a map or plays a motion: one file, no network, nothing to install."""

import base64
import html
import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from glid_nb._arrays import Array
from glid_nb._scripts import bundle, glsl
from glid_nb.certificate import Certificate, global_injectivity
from glid_nb.certificate.rounding import rounded_down, rounded_up
from glid_nb.export.moving import MovingMesh
from glid_nb.figures.style import COLORS, rgb
from glid_nb.harmonic import FixedPoints, HarmonicMap
from glid_nb.harmonic.shader_map import ShaderMap
from glid_nb.imaging import PixelFrame, as_rgba8
from glid_nb.imaging.read import png
from glid_nb.motion import Motion, MotionCertificate
from glid_nb.motion.playing import playing
from glid_nb.solvers import Pose

_FOLDER = Path(__file__).parent
_VERTICES = 4000
_TOLERANCE = 0.004  # world units; the picture is 20 long
_MARGIN = 0.04  # of the canvas, as in a rendering with view="fit"
_GRID_LINES = 20  # along the longer side
_LONGEST_CHAIN = 1024  # vectors that a block of uniforms holds on every device
# By the verdict on global injectivity.
_OVERLAPS = {
    "yes": "no part lies over another",
    "no": "parts of the shape lie over one another",
    "undecided": "whether parts lie over one another is not known",
}
# What three.js puts before the shaders of the canvas.
_VERTEX = """#version 300 es
#define attribute in
#define varying out
uniform mat4 projectionMatrix;
const mat4 modelViewMatrix = mat4(1.0);
in vec3 position;
"""
_FRAGMENT = f"""#version 300 es
#define varying in
#define texture2D texture
#define gl_FragColor shown
#define N_COLORS {len(COLORS)}
#define ENERGY_DENSITY 0.0
"""


def page_html(
    image: ArrayLike,
    map: HarmonicMap | Motion,
    certificate: Certificate | None = None,
    title: str = "Deformed picture",
    tolerance: float = _TOLERANCE,
    pose: Pose | Sequence[Pose] | None = None,
    loop: bool = True,
) -> str:
    """A page that shows the warped picture, with zoom, pan and colours for the distortion.

    The image, (h, w), (h, w, 3) or (h, w, 4), is the one that the cage was traced from. A motion is
    played and scrubbed; a click on a pose leads there along the motion, so that all that is seen is
    proved; with ``loop`` it begins again at its end. The shaders are those of the canvas, which
    evaluate the map itself on the vertices of a triangulation, whose straight edges may stray from
    it by the tolerance, world units, at any time. With its certificate the page states a map's
    bounds and whether the shape overlaps itself; a motion has its own. The depths of a pose, of a
    motion one for each keyframe, say which part is in front where the shape overlaps itself. The
    security policy blocks the network.
    """
    mesh = MovingMesh.of(map, pose, _VERTICES, tolerance)
    proof = map.certificate if isinstance(map, Motion) else certificate
    texture = as_rgba8(image)
    height, width = texture.shape[:2]
    data = {
        **_shape(mesh),
        **_shaders(mesh, map),
        "frame": [*PixelFrame(width, height).bounds],
        "margin": _MARGIN,
        "grid": map.domain.cage.longer_side / _GRID_LINES,
        "colors": rgb(COLORS).ravel().round(4).tolist(),
        "ranges": _ranges(proof),
        "loop": loop,
        "picture": "data:image/png;base64," + _base64(png(texture)),
    }
    parts = {
        "title": html.escape(title),
        "caption": html.escape(_caption(map, proof)),
        "style": _read("page.css"),
        "script": bundle("../../export/page.js"),
        "data": json.dumps(data, allow_nan=False),
    }
    # One pass, so that inserted text is not searched for placeholders.
    return re.sub(r"\{\{(\w+)\}\}", lambda found: parts[found[1]], _read("page.html"))


def _shape(mesh: MovingMesh) -> dict[str, Any]:
    """The triangulation, its layers and its extent."""
    heights = mesh.heights - mesh.heights.mean()
    return {
        "source": _floats(mesh.vertices),
        "heights": _floats(heights / (2 * np.abs(heights).max() or 1.0)),
        "height_times": list(mesh.height_times) if len(heights) > 1 else [],
        "triangles": _base64(mesh.triangles.astype("<u4" if len(mesh.vertices) > 65535 else "<u2")),
        "bounds": _bounds(mesh.images.reshape(-1, 2)),
        "source_bounds": _bounds(mesh.vertices),
    }


def _shaders(mesh: MovingMesh, shown: HarmonicMap | Motion) -> dict[str, Any]:
    """The shaders of the canvas, and the maps at the knots as they take them."""
    domain = shown.domain
    shader = ShaderMap(domain)
    wire, head = shader.wire, shader.defines() + glsl("harmonic.glsl")
    # Blocks hold more than plain uniforms do.
    head = re.sub(r"uniform vec4 (\w+)(\[\w+\]);", r"uniform \1_block { vec4 \1\2; };", head)
    if in_kernel := shader.n_chain > _LONGEST_CHAIN:
        points, head = FixedPoints(domain, mesh.vertices), glsl("image_buffer.glsl")

        def wire(map: HarmonicMap) -> bytes:
            return np.concatenate(points(map), axis=1).astype("<f4").tobytes()

    if isinstance(shown, Motion):
        motion, arrays = playing(shown, wire)
    else:
        motion, arrays = {"times": [0, 1], "keyframes": [], "repeat": "once"}, 2 * wire(shown)
    parts = (glsl(name) for name in ("colors.glsl", "energy.glsl", "picture.frag"))
    return {
        "vertex": _VERTEX + head + glsl("picture.vert"),
        "fragment": _FRAGMENT + "\n".join(["precision highp float; out vec4 shown;", *parts]),
        "motion": motion,
        "coefficients": _base64(arrays),
        "undeformed": _base64(wire(HarmonicMap.identity(domain))),
        "cage": "" if in_kernel else _floats(shader.cage),
    }


def _ranges(proof: Certificate | MotionCertificate | None) -> dict[str, list[float]]:
    """The colour map's ends for each distortion: an isometry, and the bound, or a tenth off."""
    if proof is None or not proof.certified:
        return {}
    ends = {
        "sigma1": [1, max(proof.sigma1_upper, 1.1)],
        "sigma2": [1, min(proof.sigma2_lower, 0.9)],
        "k": [0, max(proof.k_upper, 0.1)],
    }
    return {name: range_ for name, range_ in ends.items() if np.isfinite(range_[1])}


def _caption(shown: HarmonicMap | Motion, proof: Certificate | MotionCertificate | None) -> str:
    if proof is None or not proof.certified:
        return proof.reason if isinstance(proof, MotionCertificate) else ""
    told = "point, at any time"
    if isinstance(shown, HarmonicMap):
        assert isinstance(proof, Certificate)
        told = f"point; {_OVERLAPS[global_injectivity(shown, proof).verdict]}"
    return (
        f"Proved not to fold over or tear at any {told}. "
        f"Bounds: σ₂ ≥ {rounded_down(proof.sigma2_lower)}, "
        f"σ₁ ≤ {rounded_up(proof.sigma1_upper)}, k ≤ {rounded_up(proof.k_upper)}"
    )


def _bounds(points: Array) -> list[float]:
    return [*points.min(axis=0).tolist(), *points.max(axis=0).tolist()]


def _floats(values: Array) -> str:
    return _base64(values.astype("<f4"))


def _base64(data: Any) -> str:
    return base64.b64encode(data).decode("ascii")


def _read(name: str) -> str:
    return (_FOLDER / name).read_text(encoding="utf-8")
