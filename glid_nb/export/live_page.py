"""A page in which anybody drags the pins of a picture that provably never folds: one file."""

import base64
import html
import json
import math
import re
import zlib
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from glid_nb._arguments import check_type
from glid_nb._errors import InputError
from glid_nb.energies import ENERGIES, CustomEnergy, Energy, SymmetricDirichlet
from glid_nb.export.moving import check_picture
from glid_nb.export.page import (
    GRID_LINES,
    LONGEST_CHAIN,
    behind_canvas,
    factored,
    packed,
    playing,
)
from glid_nb.figures.style import COLORS, rgb
from glid_nb.geometry import Cage, Domain, GeometryError, triangulate
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import PixelFrame, as_rgba8, order_of, png
from glid_nb.imaging.backdrop import Background
from glid_nb.imaging.bleed import bled
from glid_nb.imaging.render import MARGIN
from glid_nb.motion import Motion
from glid_nb.page import (
    ShaderMap,
    bundle,
    coefficients_of,
    outline_of,
    pins_of,
    stylesheet,
    template,
    webgl2_shaders,
)
from glid_nb.pose import Pose
from glid_nb.solvers.stiffness import stiff_nodes

_VERTICES = 300, 250, 200, 150  # of the mesh before the page divides its triangles, the most first
_MOST = 60_000  # bytes beside the picture; for a cage of many vertices the mesh is coarser
_STEP = 2.5e-5  # rounding of the mesh, as a share of the shape's size
_HEIGHT = 2.0**-10  # rounding of heights
_DIGITS = 1e-6  # rounding of the cage, as a share of its size
_APART = 1000  # roundings between the cage and the offset cage, at least
# What a script element may hold as it is: printable characters but "&", "<" and the backslash.
_LETTERS = np.array([c for c in range(33, 127) if chr(c) not in "&<\\"], dtype=np.uint8)
_BITS = 13  # in two letters: 91 ** 2 > 2 ** 13
_RANGES = {2: [1, 2], 3: [1, 0.4], 4: [0, 0.5]}
"""The ends of the colour map for each overlay, by its number in ``picture.frag``."""


def live_page_html(
    image: ArrayLike,
    shown: Domain | HarmonicMap | Motion,
    pose: Pose | Sequence[Pose] | None = None,
    energy: Energy | None = None,
    p2p_weight: float = 1e5,
    title: str = "Live picture",
    background: Background = None,
) -> str:
    """A page with its own certified solver: click to pin, drag, keep poses and play them.

    The page begins at a map, at the first keyframe of a motion, or at the undeformed shape of a
    domain. ``pose`` is the map's pose, or one pose per keyframe; its pins can be dragged. It plays
    a motion until its reader keeps other poses. The background is as in `glid_nb.render`; for None,
    the page shows its own. All is one HTML file that uses no network. The page
    proves every map that it draws, in JavaScript (``docs/proof.md``).

    Raises an InputError for an energy that the page's solver does not have.
    """
    check_type("shown", shown, Domain | HarmonicMap | Motion, "pass a domain or a map", InputError)
    energy = SymmetricDirichlet() if energy is None else energy
    if energy.name not in ENERGIES or isinstance(energy, CustomEnergy):
        known = ", ".join(ENERGIES)
        raise InputError(f"a live page has no energy {energy.name!r}; choose one of {known}")
    texture = as_rgba8(image)
    domain = page_domain(shown if isinstance(shown, Domain) else shown.domain)
    start = HarmonicMap.identity(domain) if isinstance(shown, Domain) else shown
    check_picture((texture.shape[1], texture.shape[0]), start)
    poses = list(pose) if isinstance(pose, Sequence) else [pose]
    _check_poses(shown, poses)
    first = poses[0]
    texture = bled(texture)
    painted = None if first is None else first.stiffness
    stiff = painted if painted and painted.within(domain.cage) else None
    data = {
        "title": title,
        "outline": outline_of(domain),
        "options": {
            "energy": energy.name,
            "s": float(getattr(energy, "s", 1.0)),
            "weight": float(p2p_weight),
            "stiff": None if stiff is None else stiff_nodes(domain, stiff),
        },
        "stiffness": None if stiff is None else stiff.to_list(),
        "start": _start(start),
        "poses": [pins_of(one) for one in poses],
        "motion": _motion(start) if isinstance(start, Motion) else None,
        **_shaders(domain),
        "frame": [*PixelFrame(*texture.shape[1::-1]).bounds],
        "margin": MARGIN,
        "grid": domain.cage.longer_side / GRID_LINES,
        "colors": rgb(COLORS).ravel().round(4).tolist(),
        "ranges": _RANGES,
        "size": [*texture.shape[1::-1]],
    }
    page = template("live_page")
    packed_data = _packed(data, domain, first, _MOST - len(page) - len(title))
    parts = {
        "title": html.escape(title),
        **packed_data,
        "behind": behind_canvas(background),
        "picture": "data:image/png;base64," + base64.b64encode(png(texture)).decode("ascii"),
    }
    # Replace in one pass, so that inserted text is not searched for placeholders.
    return re.sub(r"\{\{(\w+)\}\}", lambda found: parts[found[1]], page)


def _check_poses(shown: Domain | HarmonicMap | Motion, poses: Sequence[Pose | None]) -> None:
    for one in poses:
        check_type("a pose", one, Pose | None, "give one for each keyframe", InputError)
    wanted = len(shown.keyframes) if isinstance(shown, Motion) else 1
    if poses != [None] and len(poses) != wanted:
        raise InputError(f"there are {wanted} keyframes but {len(poses)} poses; give one each")


def _start(start: HarmonicMap | Motion) -> list[float]:
    """The coefficients of the map to begin with; empty for the identity."""
    map = start.keyframes[0] if isinstance(start, Motion) else start
    identity = HarmonicMap.identity(map.domain)
    if np.array_equal(map.phi, identity.phi) and np.array_equal(map.psi, identity.psi):
        return []
    return coefficients_of(map)


def _packed(data: Any, domain: Domain, pose: Pose | None, most: int) -> dict[str, str]:
    """Data, mesh and code of the page, if possible in at most this many letters."""
    code = [bundle("live"), bundle("live_page"), stylesheet("live_page")]
    for n_vertices in _VERTICES:
        deflated = _deflated({**data, **_mesh(domain, pose, n_vertices)}, code)
        letters = _lettered(deflated)
        if len(letters) <= most:
            break
    return {"packed": letters, "size": str(len(deflated))}


def _mesh(domain: Domain, pose: Pose | None, n_vertices: int) -> dict[str, Any]:
    mesh = triangulate(domain.cage, n_vertices)
    heights = order_of(domain.cage, pose)(mesh.vertices)
    heights = heights - heights.mean()
    heights /= 2 * np.abs(heights).max() or 1.0
    first = mesh.triangles.argmin(axis=1)[:, None]
    corners = np.take_along_axis(mesh.triangles, (first + np.arange(3)) % 3, axis=1)
    corners = corners[np.lexsort(corners.T[::-1])]  # sorted triangles compress well
    return {
        "source": packed(mesh.vertices, _STEP * domain.cage.longer_side),
        "heights": packed(heights[:, None], _HEIGHT),
        "triangles": packed(corners - corners[:, :1] * [0, 1, 1], 1),
    }


def _shaders(domain: Domain) -> dict[str, Any]:
    """Two vertex shaders: one evaluates the map, the other takes vertices that are moved."""
    shader = ShaderMap(domain)
    vertex, fragment = webgl2_shaders("picture", shader, len(COLORS))
    painting, _ = webgl2_shaders("picture", None, len(COLORS))
    fits = shader.n_chain <= LONGEST_CHAIN
    return {
        "vertex": _plain(vertex) if fits else "",
        "painting": _plain(painting),
        "fragment": _plain(fragment),
        "chain": shader.n_chain,
        "shaderHoles": shader.n_holes,
    }


def _motion(motion: Motion) -> dict[str, Any]:
    """The motion as the page's player takes it, with the maps at its knots."""

    def wire(map: HarmonicMap) -> bytes:
        return np.concatenate([map.phi.view(float), map.psi.view(float)]).astype("<f4").tobytes()

    values, arrays = playing(motion, wire)
    width = 4 * motion.domain.n_coefficients
    rows = np.frombuffer(arrays, "<f4").reshape(-1, width)
    step = _STEP * motion.domain.cage.longer_side
    return {**values, "coefficients": factored(rows, step, 2), "width": width}


def _deflated(data: dict[str, Any], code: Sequence[str]) -> bytes:
    """For `DecompressionStream` of the page. Strings of JSON would take more bytes."""
    text = json.dumps(data, allow_nan=False, ensure_ascii=False, separators=(",", ":"))
    return zlib.compress("\0".join([text, *code]).encode(), 9)


def _lettered(data: bytes) -> str:
    """Bytes as letters, of which a script element may hold any: 13 bits in two letters, the least
    significant first. That is 8 % shorter than base64. The first script of the page reads it."""
    bits = np.unpackbits(np.frombuffer(data, np.uint8), bitorder="little")
    bits = np.pad(bits, (0, -len(bits) % _BITS)).reshape(-1, _BITS)
    numbers = bits @ (1 << np.arange(_BITS))
    pairs = np.stack([numbers // len(_LETTERS), numbers % len(_LETTERS)], axis=1)
    return _LETTERS[pairs].tobytes().decode("ascii")


def page_domain(domain: Domain) -> Domain:
    """The domain of a live page, with fewer digits, which make the page smaller.

    It is the same one if its cages are too close to each other for that.
    """
    side = domain.cage.longer_side
    digits = -math.floor(math.log10(_DIGITS * side))
    cages = (domain.cage, domain.offset_cage)
    apart = cages[0].polygon.boundary.distance(cages[1].polygon.boundary)
    if apart < _APART * 10.0**-digits:
        return domain
    cage, offset_cage = (
        Cage(loops[0].round(digits), [hole.round(digits) for hole in loops[1:]])
        for loops in (cage.loops for cage in cages)
    )
    try:
        return Domain(cage, offset_cage, domain.hole_points.round(digits))
    except GeometryError:
        return domain


def _plain(shader: str) -> str:
    """A shader without comments and indentation."""
    lines = (re.sub(r"//.*", "", line).strip() for line in shader.splitlines())
    return "\n".join(line for line in lines if line)
