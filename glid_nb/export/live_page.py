"""A page in which anybody drags the pins of a picture that provably never folds: one file."""

import base64
import html
import json
import math
import re
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glid_nb._arguments import check_type, unmet
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
from glid_nb.export.parts import checked_parts, named_parts
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


@dataclass(frozen=True, eq=False)
class LivePart:
    """A shape of a live page. The fields are the arguments of `live_page_html`."""

    image: ArrayLike
    shown: Domain | HarmonicMap | Motion
    pose: Pose | Sequence[Pose] | None = None
    energy: Energy | None = None
    p2p_weight: float = 1e5
    name: str = ""  # of one of several


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
    part = _Prepared.of(LivePart(image, shown, pose, energy, p2p_weight))
    data = {"title": title, **_common([part]), **part.data()}
    picture = _picture(part.texture, "source")
    most = _MOST - len(_template()) - len(_picture(None, "source")) - len(title)
    for n_vertices in _VERTICES:
        deflated = _deflated({**data, **part.mesh(n_vertices)}, _code("live_page"))
        if len(_lettered(deflated)) <= most:
            break
    return _page(title, deflated, picture, background)


def parts_live_html(
    parts: Sequence[LivePart], title: str = "Live picture", background: Background = None
) -> str:
    """Like `live_page_html` for several shapes, the rearmost first: one canvas, pins on all of
    them, one undo and one timeline.

    Each part has a solver and a proof of its own. The page shows the worst of their bounds, and
    draws a frame of a motion only when it is proved for all. The pictures have the same size. The
    motions, if there are any, have the same times. The names differ; a part without one gets its
    number.
    """
    parts = checked_parts(parts, LivePart)
    if len(parts) == 1:
        one = parts[0]
        shape = one.image, one.shown, one.pose, one.energy, one.p2p_weight
        return live_page_html(*shape, title, background)
    parts = named_parts(parts, LivePart)
    _check_together(parts)
    prepared = [_Prepared.of(part) for part in parts]
    each = [{**one.data(), **one.mesh(_VERTICES[0])} for one in prepared]
    data = {"title": title, **_common(prepared), "parts": each}
    pictures = [_picture(one.texture, f"source{i}") for i, one in enumerate(prepared)]
    deflated = _deflated(data, _code("live_parts"))
    return _page(title, deflated, "\n".join(pictures), background)


def _check_together(parts: Sequence[LivePart]) -> None:
    """Raise an InputError unless one page can show these parts."""
    sizes = {as_rgba8(part.image).shape[:2] for part in parts}
    if len(sizes) > 1:
        raise InputError("the pictures of the parts have different sizes; they share one frame")
    times = {part.shown.times if isinstance(part.shown, Motion) else None for part in parts}
    if len(times) > 1:
        raise InputError("the motions of the parts have different times; all share one timeline")


@dataclass(frozen=True, eq=False)
class _Prepared:
    """A checked part, with the digits that a page has."""

    part: LivePart
    texture: NDArray[np.uint8]
    domain: Domain
    start: HarmonicMap | Motion
    poses: Sequence[Pose | None]

    @classmethod
    def of(cls, part: LivePart) -> Self:
        shown = part.shown
        kinds = Domain | HarmonicMap | Motion
        check_type("shown", shown, kinds, "pass a domain or a map", InputError)
        _check_energy(part.energy)
        if wanted := unmet(float, part.p2p_weight, {"above": 0}):
            raise InputError(f"p2p_weight is {part.p2p_weight!r:.60}; it must be {wanted}")
        texture = as_rgba8(part.image)
        domain = page_domain(shown if isinstance(shown, Domain) else shown.domain)
        start = HarmonicMap.identity(domain) if isinstance(shown, Domain) else shown
        check_picture((texture.shape[1], texture.shape[0]), start)
        poses: list[Pose | None] = (
            list(part.pose) if isinstance(part.pose, Sequence) else [part.pose]
        )
        _check_poses(shown, poses)
        return cls(part, bled(texture), domain, start, poses)

    def data(self) -> dict[str, Any]:
        """What the page needs of this part alone, without its mesh."""
        domain, energy = self.domain, self.part.energy or SymmetricDirichlet()
        painted = None if self.poses[0] is None else self.poses[0].stiffness
        stiff = painted if painted and painted.within(domain.cage) else None
        return {
            **({"name": self.part.name} if self.part.name else {}),
            "outline": outline_of(domain),
            "options": {
                "energy": energy.name,
                "s": float(getattr(energy, "s", 1.0)),
                "weight": float(self.part.p2p_weight),
                "stiff": None if stiff is None else stiff_nodes(domain, stiff),
            },
            "stiffness": None if stiff is None else stiff.to_list(),
            "start": _start(self.start),
            "poses": [pins_of(one) for one in self.poses],
            "motion": _motion(self.start) if isinstance(self.start, Motion) else None,
            **_shader(domain),
        }

    def mesh(self, n_vertices: int) -> dict[str, Any]:
        return _mesh(self.domain, self.poses[0], n_vertices)


def _common(parts: Sequence[_Prepared]) -> dict[str, Any]:
    """What all parts of a page share."""
    size = parts[0].texture.shape[1::-1]
    painting, fragment = webgl2_shaders("picture", None, len(COLORS))
    return {
        "painting": _plain(painting),
        "fragment": _plain(fragment),
        "frame": [*PixelFrame(*size).bounds],
        "margin": MARGIN,
        "grid": max(part.domain.cage.longer_side for part in parts) / GRID_LINES,
        "colors": rgb(COLORS).ravel().round(4).tolist(),
        "ranges": _RANGES,
        "size": [*size],
    }


def _picture(texture: NDArray[np.uint8] | None, name: str) -> str:
    """The element with a picture; without one, the letters around it."""
    data = b"" if texture is None else base64.b64encode(png(texture))
    address = "" if texture is None else "data:image/png;base64," + data.decode("ascii")
    return f'<img id="{name}" alt="" hidden src="{address}">'


def _page(title: str, deflated: bytes, pictures: str, background: Background) -> str:
    parts = {
        "title": html.escape(title),
        "packed": _lettered(deflated),
        "size": str(len(deflated)),
        "behind": behind_canvas(background),
        "pictures": pictures,
    }
    # Replace in one pass, so that inserted text is not searched for placeholders.
    return re.sub(r"\{\{(\w+)\}\}", lambda found: parts[found[1]], _template())


def _template() -> str:
    """The page's frame, in one line. All statements of its script end with a semicolon."""
    return _plain(template("live_page")).replace("\n", "")


def _check_energy(energy: Energy | None) -> None:
    advice = 'for example glid_nb.energies.by_name("amips")'
    check_type("energy", energy, Energy | None, advice, InputError)
    if energy is not None and (energy.name not in ENERGIES or isinstance(energy, CustomEnergy)):
        known = ", ".join(ENERGIES)
        raise InputError(f"a live page has no energy {energy.name!r}; choose one of {known}")


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


def _code(page: str) -> list[str]:
    """The scripts and the style sheet of a page."""
    return [bundle("live"), bundle(page), stylesheet("live_page")]


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


def _shader(domain: Domain) -> dict[str, Any]:
    """The vertex shader that evaluates the map; empty if the cage is too large for it."""
    shader = ShaderMap(domain)
    vertex, _ = webgl2_shaders("picture", shader, len(COLORS))
    return {
        "vertex": _plain(vertex) if shader.n_chain <= LONGEST_CHAIN else "",
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


def _plain(code: str) -> str:
    """A shader, or the page's frame, without comments and indentation."""
    lines = (re.sub(r"//.*", "", line).strip() for line in code.splitlines())
    return "\n".join(line for line in lines if line)
