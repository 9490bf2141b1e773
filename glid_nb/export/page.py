"""A web page that shows maps or plays motions: one file, no network, nothing to install."""

import base64
import html
import io
import json
import re
import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from PIL import Image

from glid_nb._arguments import check_type
from glid_nb._arrays import Array
from glid_nb._errors import InputError
from glid_nb.certificate import Certificate
from glid_nb.export.moving import MovingMesh, check_picture
from glid_nb.export.page_proof import Proved, caption, color_ranges, list_of_parts
from glid_nb.export.parts import named_parts
from glid_nb.figures.style import COLORS, rgb
from glid_nb.geometry import Domain
from glid_nb.harmonic import FixedPoints, HarmonicMap
from glid_nb.imaging import PixelFrame, as_rgba8, png
from glid_nb.imaging.backdrop import Background, check_background
from glid_nb.imaging.bleed import bled
from glid_nb.imaging.order import Order
from glid_nb.imaging.progress import Progress, report
from glid_nb.imaging.render import MARGIN
from glid_nb.motion import Motion
from glid_nb.motion.settings import checked
from glid_nb.page import ShaderMap, bundle, stylesheet, template, webgl2_shaders
from glid_nb.pose import Pose

_VERTICES = 4000
_TOLERANCE = 0.004  # world units; the picture is 20 long
GRID_LINES = 20  # along the longer side
# Vertices and images are rounded to this share of the shape's size: 1/20 pixel of 2000 pixels.
_STEP = 2.5e-5
_HEIGHT = 2.0**-16  # rounding of heights
_MOST_STEPS = 2**28  # largest coefficient, in steps
_QUALITY = 92  # of a background, as JPEG
LONGEST_CHAIN = 1024  # vectors that fit in a block of uniforms on every device


@dataclass(frozen=True, eq=False)
class PagePart:
    """A shape of a page. The fields are the arguments of `page_html`."""

    image: ArrayLike
    map: HarmonicMap | Motion
    certificate: Certificate | None = None
    pose: Pose | Sequence[Pose | Order] | None = None
    name: str = ""  # of one of several


def page_html(
    image: ArrayLike,
    map: HarmonicMap | Motion,
    certificate: Certificate | None = None,
    title: str = "Deformed picture",
    tolerance: float = _TOLERANCE,
    pose: Pose | Sequence[Pose | Order] | None = None,
    loop: bool = True,
    progress: Progress | None = None,
    background: Background = None,
) -> str:
    """A page that shows the warped picture, with zoom, pan and colours for the distortion.

    The image is the one from which the cage was traced. The page plays and scrubs a motion. A click
    on a pose moves there along the motion, so that everything shown is proved. With ``loop`` the
    motion starts again at its end. The shaders evaluate the map itself on the vertices of a
    triangulation. Its straight edges deviate from the map by at most ``tolerance``, in world units,
    at all times. With a certificate, the page states the map's bounds and whether the shape
    overlaps itself. A motion has its own certificate. The depths of a pose, or of one pose per
    keyframe of a motion, decide which part is in front. The background is as in `glid_nb.render`;
    for None, the page shows its own.
    """
    part = PagePart(image, map, certificate, pose)
    return parts_page_html([part], title, tolerance, loop, progress, background)


def parts_page_html(
    parts: Sequence[PagePart],
    title: str = "Deformed picture",
    tolerance: float = _TOLERANCE,
    loop: bool = True,
    progress: Progress | None = None,
    background: Background = None,
) -> str:
    """Like `page_html` for several shapes, the rearmost first: one canvas and one player.

    Later shapes cover earlier ones. Each has a proof of its own. The page lists them, and states
    bounds that hold for all. The pictures have the same size. The shapes are all maps, or all
    motions, which have the same times.
    """
    parts = named_parts(parts, PagePart)
    total = len(parts) + 2
    report(progress, 0, total)
    checked("loop", bool, loop)
    behind = behind_canvas(background)
    _check_parts(parts)
    each: list[dict[str, Any]] = []
    for part in parts:
        each.append(_data_of(part, tolerance))
        report(progress, len(each), total)
    proved = [Proved(part.map, part.certificate, part.name) for part in parts]
    _, fragment = webgl2_shaders("picture", None, len(COLORS))
    sides = [part.map.domain.cage.longer_side for part in parts]
    data = {
        "parts": each,
        "fragment": fragment,
        "frame": [*PixelFrame(*as_rgba8(parts[0].image).shape[1::-1]).bounds],
        "margin": MARGIN,
        "grid": max(sides) / GRID_LINES,
        "colors": rgb(COLORS).ravel().round(4).tolist(),
        "ranges": color_ranges(proved),
        "loop": loop,
    }
    texts = {
        "title": html.escape(title),
        "caption": html.escape(caption(proved)),
        "each": list_of_parts(proved),
        "style": stylesheet("exported"),
        "behind": behind,
        "script": bundle("exported"),
        "data": json.dumps(data, allow_nan=False).replace("<", "\\u003c"),
    }
    report(progress, total - 1, total)
    # Replace in one pass, so that inserted text is not searched for placeholders.
    page = re.sub(r"\{\{(\w+)\}\}", lambda found: texts[found[1]], template("exported"))
    report(progress, total, total)
    return page


def _check_parts(parts: Sequence[PagePart]) -> None:
    for part in parts:
        check_type("map", part.map, HarmonicMap | Motion, "for example result.map", InputError)
    if len({as_rgba8(part.image).shape[:2] for part in parts}) > 1:
        raise InputError("the pictures of the parts have different sizes; they share one frame")
    if len({_times_of(part.map) for part in parts}) > 1:
        raise InputError("the motions of the parts have different times; all share one player")


def _times_of(shown: HarmonicMap | Motion) -> tuple[str, tuple[float, ...]] | None:
    return (shown.repeat, tuple(shown.times)) if isinstance(shown, Motion) else None


def _data_of(part: PagePart, tolerance: float) -> dict[str, Any]:
    """What the page needs of one shape alone."""
    texture = as_rgba8(part.image)
    check_picture((texture.shape[1], texture.shape[0]), part.map)
    mesh = MovingMesh.of(part.map, part.pose, _VERTICES, tolerance)
    step = _STEP * part.map.domain.cage.longer_side
    return {
        **_shape(mesh, step),
        **_shaders(mesh, part.map, step),
        "picture": "data:image/png;base64," + _base64(png(bled(texture))),
    }


def behind_canvas(background: Background) -> str:
    """The style of a page's canvas that shows a background. The page's script moves a picture with
    the view."""
    picture, file = check_background(background), io.BytesIO()
    if picture is None:
        return ""
    if isinstance(picture, tuple):
        return f"\nmain canvas:first-child {{ background: rgb({' '.join(map(str, picture))}); }}\n"
    if (picture[..., 3] < 255).any():
        kind, data = "png", png(picture)
    else:  # a photograph
        Image.fromarray(picture[..., :3].copy()).save(file, "JPEG", quality=_QUALITY)
        kind, data = "jpeg", file.getvalue()
    address = f"data:image/{kind};base64,{_base64(data)}"
    return f"\nmain canvas:first-child {{ background: url({address}) no-repeat; }}\n"


def _shape(mesh: MovingMesh, step: float) -> dict[str, Any]:
    first = mesh.triangles.argmin(axis=1)[:, None]
    corners = np.take_along_axis(mesh.triangles, (first + np.arange(3)) % 3, axis=1)
    corners = corners[np.lexsort(corners.T[::-1])]  # sorted triangles compress well
    heights = mesh.heights - mesh.heights.mean()
    return {
        "source": packed(mesh.vertices, step),
        "heights": factored(heights / (2 * np.abs(heights).max() or 1.0), _HEIGHT, 1),
        "height_times": list(mesh.height_times) if len(heights) > 1 else [],
        "triangles": packed(corners - corners[:, :1] * [0, 1, 1], 1),
        "bounds": _bounds(mesh.images.reshape(-1, 2)),
        "source_bounds": _bounds(mesh.vertices),
    }


def _shaders(mesh: MovingMesh, shown: HarmonicMap | Motion, step: float) -> dict[str, Any]:
    domain = shown.domain
    shader = ShaderMap(domain)
    wire = shader.wire
    if in_kernel := shader.n_chain > LONGEST_CHAIN:
        points = FixedPoints(domain, mesh.vertices)

        def wire(map: HarmonicMap) -> bytes:
            return np.concatenate(points(map), axis=1).astype("<f4").tobytes()

    if isinstance(shown, Motion):
        motion, arrays = playing(shown, wire)
    else:
        motion, arrays = {"times": [0, 1], "keyframes": [], "repeat": "once"}, 2 * wire(shown)
    step *= 1 if in_kernel else 1 / _spread(domain, mesh.vertices)
    undeformed = wire(HarmonicMap.identity(domain))
    rows = np.frombuffer(undeformed + arrays, "<f4").reshape(-1, len(undeformed) // 4)
    step = max(step, float(np.linalg.norm(rows, axis=1).max()) / _MOST_STEPS)
    vertex, _ = webgl2_shaders("picture", None if in_kernel else shader, len(COLORS))
    return {
        "vertex": vertex,
        "motion": motion,
        "coefficients": factored(rows, step, 6 if in_kernel else 4),
        "width": rows.shape[1],
        "cage": "" if in_kernel else _base64(shader.cage.astype("<f4")),
    }


def playing(motion: Motion, wire: Callable[[HarmonicMap], bytes]) -> tuple[dict[str, Any], bytes]:
    """The data for ``page/js/motion/motion.js``: JSON values, and the float32 arrays of knots.

    ``wire`` writes the array of a map and is linear in the map. Between two knots everything moves
    on straight lines. ``times`` are the times of the knots, with the easing; for a ping-pong, on
    the way forth only. ``keyframes`` are some of these times. ``sigma2``, ``sigma1`` and ``k`` are
    the bounds on each piece between two knots, None if it is not proved. Everything before the time
    ``until`` is proved.
    """
    pieces, certificate = motion.pieces_forth, motion.certificate
    maps = [pieces[0].start_map, *(piece.end_map for piece in pieces)]
    proofs = certificate.pieces[: len(pieces)]
    values = {
        "times": [pieces[0].start, *(piece.end for piece in pieces)],
        "keyframes": list(motion.times[: len(motion.keyframes)]),
        "repeat": motion.repeat,
        "sigma2": [proof.sigma2_lower if proof.certified else None for proof in proofs],
        "sigma1": [proof.sigma1_upper if proof.certified else None for proof in proofs],
        "k": [proof.k_upper if proof.certified else None for proof in proofs],
        "until": certificate.until,
    }
    return values, b"".join(map(wire, maps))


def _spread(domain: Domain, points: Array) -> float:
    """A limit on how far images move if coefficients are rounded: 1.5 times a random sample."""
    n, holes = domain.n_coefficients, domain.n_holes
    phi, psi = np.random.default_rng(0).uniform(-0.5, 0.5, (2, n, 2)) @ [1, 1j]
    psi[n - holes :] = phi[n - holes :].conj()
    return 1.5 * float(np.abs(HarmonicMap(domain, phi, psi)(points)).max())


def _bounds(points: Array) -> list[float]:
    return [*points.min(axis=0).tolist(), *points.max(axis=0).tolist()]


def factored(values: Array, step: float, width: int) -> dict[str, Any]:
    """(n, m) values for `restored` in the page, as sums of few rows, with errors of about a step.

    The maps of a motion lie near a space of few dimensions, even if the shape turns. A row consists
    of groups of ``width`` numbers.
    """
    shares, scale, rows = np.linalg.svd(values, full_matrices=False)
    missed = np.sqrt(np.cumsum(scale[::-1] ** 2))[::-1]  # the total error with i rows
    count = max(np.count_nonzero(missed > step * np.sqrt(len(values))), 1)
    shares, rows = shares[:, :count] * scale[:count], rows[:count]
    sizes = np.maximum(np.abs(shares).max(axis=0), 1e-300)
    rows = (rows * sizes[:, None]).reshape(-1, width)
    return {
        "sizes": sizes.tolist(),
        "rows": {**packed(rows, step / 4), "width": width},
        "shares": packed(shares, step / 2),
    }


def packed(values: Array, step: float) -> dict[str, Any]:
    """(n, m) values for `unpacked` in the page.

    The values are rounded to whole steps. Second differences down the columns are taken and written
    as unsigned integers, where odd ones stand for negative numbers. The least significant bytes of
    all come first, and the bytes are deflated.
    """
    whole = np.rint(np.asarray(values, dtype=float) / step).astype(np.int64)
    fresh = np.diff(whole, 2, axis=0, prepend=np.zeros((2, whole.shape[1]), np.int64))
    planes = ((fresh << 1) ^ (fresh >> 63)).astype("<u4").reshape(-1, 1).view("u1").T
    return {"step": step, "bytes": _base64(zlib.compress(planes.tobytes(), 9))}


def _base64(data: Any) -> str:
    return base64.b64encode(data).decode("ascii")
