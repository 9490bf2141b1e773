"""The domain of a harmonic map: the cage, its offset cage and one point per hole."""

import itertools
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from numbers import Real
from typing import Any, Self

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from glid_nb._arguments import check_type, unmet
from glid_nb._arrays import Array, Rebuilt, frozen, number_pairs
from glid_nb._errors import about
from glid_nb.geometry._loops import GeometryError, Loops, loop_list, loop_name, place
from glid_nb.geometry.cage import Cage
from glid_nb.geometry.offset import hole_points as choose_hole_points
from glid_nb.geometry.offset import offset_cage

# The paper's reference cages use 0.1 where the longer image side is 20 units.
_DEFAULT_OFFSET = 0.005
# An edge is divided if it is longer than LONG median widths and LONG_SHARE of the cage's longer
# side, or longer than VERY_LONG times the greatest width. Edges of traced cages are shorter.
_LONG, _LONG_SHARE, _VERY_LONG = 3.0, 0.3, 10.0
# The pieces' length in widths, and their least length as a share of the cage's longer side.
_PIECE, _LEAST_PIECE = 0.5, 0.02
_MOST_PIECES = 100  # of a rectangle's side
_CHANNELS = (1, 3, 4)  # of a picture
_SAMPLES = 32  # points of an edge at which the width is measured


@dataclass(frozen=True, eq=False, init=False)
class Domain(Rebuilt):
    """Where a harmonic map lives: the cage P, the offset cage P^ and a point in every hole.

    The basis is singular at the offset cage's vertices and the hole points (Section 5 and Appendix
    D). All of them lie outside the closed domain bounded by `cage`, so the basis is smooth there.
    Domains are compared and hashed by identity, so that they can be keys of a cache. If the parts
    do not fit, a GeometryError names the loop and the place.
    """

    cage: Cage
    """Boundary P of the certified domain."""
    offset_cage: Cage
    """P^, with the exterior loop outside that of `cage` and hole i inside hole i of `cage`. Vertex
    counts may differ from those of `cage`."""
    hole_points: NDArray[np.float64]
    """(N, 2), one strictly inside each hole of `offset_cage`, in order; by default chosen."""
    notes: tuple[str, ...]
    """Sentences about choices, such as a reduced offset."""

    def __init__(
        self,
        cage: Cage,
        offset_cage: Cage,
        hole_points: ArrayLike | None = None,
        notes: tuple[str, ...] = (),
    ) -> None:
        for name, given in (("cage", cage), ("offset_cage", offset_cage)):
            check_type(name, given, Cage, "make one with Cage(points)")
        _check_enclosed(cage, offset_cage)
        chosen = choose_hole_points(offset_cage) if hole_points is None else hole_points
        points = _checked_hole_points(chosen, offset_cage)
        made = {"cage": cage, "offset_cage": offset_cage, "hole_points": points}
        vars(self).update(made, notes=tuple(notes))

    @classmethod
    def from_cage(cls, cage: Cage, offset: float | None = None) -> Self:
        """The domain of a cage, with chosen offset cage and hole points.

        `offset` is the distance between the cages, by default 0.005 of the longer side of the
        cage's bounding box. It is reduced in narrow passages; `notes` says where. The offset cage
        has extra vertices on edges that are long compared with the shape's width.
        """
        check_type("cage", cage, Cage, "make one with Cage(points)")
        outer, notes = _chosen_offset(cage, offset)
        return cls(cage, outer, notes=notes)

    @classmethod
    def rectangle(cls, image: Any, *, margin: float = 0.0, pieces: int = 4) -> Self:
        """A whole picture as a domain, in pixel coordinates as scikit-image has them.

        They are (x, y) = (column, row): x right, y down, whole numbers at the centres of pixels. So
        the picture covers -0.5 to width - 0.5, and ``skimage.transform.warp(image, map.inverse)``
        needs no conversion. ``image`` is an array (h, w) or (h, w, c), or the size (width, height).
        ``margin`` adds room on each side, in pixels. Raises a GeometryError otherwise.

        The offset cage's longer sides are divided into this many ``pieces``, the shorter ones into
        pieces about as long. With one, maps have so few coefficients that they miss most landmarks;
        more follow more landmarks, and take longer to solve.
        """
        width, height = _size_of(image)
        if not (isinstance(margin, Real) and 0 <= margin < 1e100):
            raise GeometryError(f"margin must be a number of pixels, at least 0, not {margin!r}")
        low = -0.5 - margin
        return cls.box((low, low), (width - 0.5 + margin, height - 0.5 + margin), pieces=pieces)

    @classmethod
    def box(cls, low: ArrayLike, high: ArrayLike, *, pieces: int = 4) -> Self:
        """The rectangle between the corners ``low`` and ``high``; ``pieces`` as of `rectangle`."""
        if unmet(int, pieces, {"least": 1, "most": _MOST_PIECES}):
            known = f"a whole number from 1 to {_MOST_PIECES}"
            raise GeometryError(f"pieces must be {known}, not {pieces!r:.40}")
        (x0, y0), (x1, y1) = number_pairs([low, high], "corners are (x, y)", GeometryError)
        cage = Cage([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
        outer, notes = _chosen_offset(cage, None)
        return cls(cage, _shortened(outer, outer.longer_side / pieces), notes=notes)

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """The domain of a mapping.

        Its keys are ``cage`` and ``holes`` as in `Cage.from_dict`, and optionally ``offset`` (a
        distance), ``offset_cage``, ``offset_holes``, ``hole_points`` and ``notes``. Missing parts
        are chosen, and loops are reoriented if needed. ``offset_holes`` needs ``offset_cage``; with
        ``offset_cage``, ``offset`` has no effect.
        """
        cage, notes = Cage.from_dict(data), data.get("notes")
        notes = () if notes is None else (notes,) if isinstance(notes, str) else notes
        if not isinstance(notes, list | tuple) or not all(isinstance(note, str) for note in notes):
            raise GeometryError(f"'notes' must be a list of sentences, not {notes!r:.60}")
        holes = loop_list(data.get("offset_holes"), "offset_holes")
        points = data.get("hole_points")
        if data.get("offset_cage") is not None:
            with about("offset cage", GeometryError):
                outer = Cage(data["offset_cage"], holes)
            return cls(cage, outer, points, tuple(notes))
        if holes:
            raise GeometryError("'offset_holes' is given without 'offset_cage'; give both or none")
        outer, chosen = _chosen_offset(cage, data.get("offset"))
        return cls(cage, outer, points, (*notes, *chosen))

    def to_dict(self) -> dict[str, Any]:
        """Nested lists under the keys that `from_dict` reads, ready for JSON."""
        return {
            **self.cage.to_dict(),
            "offset_cage": self.offset_cage.exterior.tolist(),
            "offset_holes": [hole.tolist() for hole in self.offset_cage.holes],
            "hole_points": self.hole_points.tolist(),
            "notes": list(self.notes),
        }

    def equals(self, other: Self) -> bool:
        """Whether all parts and the notes are the same."""
        return self is other or self.to_dict() == other.to_dict()

    @property
    def n_holes(self) -> int:
        """Number of holes N."""
        return self.cage.n_holes

    @property
    def n_coefficients(self) -> int:
        """Length m + N of phi and of psi: m offset-cage vertices, then the hole points."""
        return self.offset_cage.n_vertices + self.n_holes

    @cached_property
    def hole_points_complex(self) -> NDArray[np.complex128]:
        """(N,) hole points as a read-only complex128 array."""
        return self.hole_points.view(np.complex128)[:, 0]


def _size_of(image: Any) -> tuple[int, int]:
    """The (width, height) of a picture or of a size."""
    shape = getattr(image, "shape", None)
    if shape is not None and len(shape) in (2, 3):
        height, width = shape[:2]
        if len(shape) == 3 and height in _CHANNELS and shape[2] not in _CHANNELS:
            what = f"a picture of the shape {tuple(shape)} has its channels first"
            raise GeometryError(f"{what}; np.moveaxis(image, 0, -1) puts them last")
    elif isinstance(image, tuple | list) and len(image) == 2:
        width, height = image
    else:
        what = "a picture is an array (h, w) or (h, w, c), or its size (width, height)"
        hint = "; of a shape (h, w, c), give the size shape[1::-1]"
        hint = hint if isinstance(image, tuple | list) and len(image) == 3 else ""
        raise GeometryError(f"{what}, not {type(image).__name__}{hint}")
    for name, value in (("width", width), ("height", height)):
        if not (isinstance(value, int | np.integer) and value >= 1):
            raise GeometryError(f"the picture's {name} must be a whole number, not {value!r}")
    return int(width), int(height)


def _shortened(cage: Cage, longest: float) -> Cage:
    """The cage with edges divided evenly, until none is longer."""
    loops = []
    for loop in cage.loops:
        along = np.roll(loop, -1, axis=0) - loop
        # Rounding must not make one more piece.
        counts = np.ceil(np.linalg.norm(along, axis=1) / longest * (1 - 1e-9)).astype(int)
        steps = zip(loop, along, np.maximum(counts, 1), strict=True)
        loops.append(np.concatenate([a + np.arange(n)[:, None] / n * by for a, by, n in steps]))
    return Cage(loops[0], loops[1:])


def _chosen_offset(cage: Cage, distance: float | None) -> tuple[Cage, tuple[str, ...]]:
    distance = _DEFAULT_OFFSET * cage.longer_side if distance is None else distance
    offset = offset_cage(cage, distance)
    return _divided(offset.cage, cage), offset.notes


def _check_enclosed(cage: Cage, offset_cage: Cage) -> None:
    """The closed domain of `cage` must lie in the open domain of `offset_cage`."""
    if offset_cage.n_holes != cage.n_holes:
        both = f"the offset cage has {offset_cage.n_holes} holes and the cage {cage.n_holes}"
        raise GeometryError(f"{both}; give one offset hole per hole, in the same order")
    # Loops of different index cannot meet, because those of each cage do not.
    for i, (loop, offset_loop) in enumerate(zip(cage.loops, offset_cage.loops, strict=True)):
        name = "the exterior loop" if i == 0 else loop_name(i)
        meeting = shapely.intersection(shapely.LinearRing(loop), shapely.LinearRing(offset_loop))
        if not meeting.is_empty:
            where = f"{name} itself at {place(shapely.get_coordinates(meeting)[0])}"
            remedy = "use a smaller offset there, or leave the offset cage out to have it chosen"
            raise GeometryError(f"the offset of {name} meets {where}; {remedy}")
        outer, inner = (offset_loop, loop) if i == 0 else (loop, offset_loop)
        if shapely.contains_xy(shapely.Polygon(outer), *inner[0]):
            continue
        if i == 0:
            what = "the offset cage's exterior loop does not enclose the cage: vertex 0 of the"
            where = f"exterior loop at {place(loop[0])} lies outside it"
            raise GeometryError(f"{what} {where}; move the offset loop outward")
        what = f"offset hole {i} does not lie in {name}: its vertex 0 at {place(offset_loop[0])}"
        remedy = "move it into the hole, and list the offset holes in the order of the holes"
        raise GeometryError(f"{what} is outside; {remedy}")


def _checked_hole_points(points: ArrayLike, offset_cage: Cage) -> NDArray[np.float64]:
    pairs = "hole points must be pairs of numbers [[x, y], ...]"
    checked = number_pairs(points, pairs, GeometryError)
    if len(checked) != offset_cage.n_holes:
        given = f"{len(checked)} hole points given for a cage with {offset_cage.n_holes} holes"
        raise GeometryError(f"{given}; give one per hole")
    for i, ((x, y), hole) in enumerate(zip(checked, offset_cage.holes, strict=True), start=1):
        if not (np.isfinite([x, y]).all() and shapely.contains_xy(shapely.Polygon(hole), x, y)):
            what = f"the point of hole {i} at {place([x, y])} does not lie strictly inside"
            remedy = "move it there, or leave hole_points out to have them chosen"
            raise GeometryError(f"{what} offset hole {i}; {remedy}")
    return frozen(checked)


def _divided(offset_cage: Cage, cage: Cage) -> Cage:
    """The offset cage with extra vertices on long edges, which otherwise could not bend."""
    least = _LEAST_PIECE * cage.longer_side
    start = np.concatenate(cage.loops_complex)
    end = np.concatenate([np.roll(loop, -1) for loop in cage.loops_complex])
    length = np.abs(end - start)
    shares = [np.zeros(1)] * len(start)
    for i in np.flatnonzero(length > 2 * least):
        widths = _widths(start[i], end[i], start, end)
        long = length[i] > max(_LONG * np.median(widths), _LONG_SHARE * cage.longer_side)
        if not (long or length[i] > _VERY_LONG * widths.max()):
            continue
        wanted = np.cumsum(1 / np.maximum(_PIECE * widths, least)) * length[i] / _SAMPLES
        pieces = np.arange(np.ceil(wanted[-1])) * (wanted[-1] / np.ceil(wanted[-1]))
        shares[i] = np.interp(pieces, [0, *wanted], np.arange(_SAMPLES + 1) / _SAMPLES)
    if all(len(share) == 1 for share in shares):
        return offset_cage
    outer = Loops.of(offset_cage.loops)
    edges = zip(outer.points, outer.edges, shares, strict=True)
    cut = [a + share[:, None] * along for a, along, share in edges]
    loops = [np.concatenate(cut[i:j]) for i, j in itertools.pairwise(outer.starts)]
    return Cage(loops[0], loops[1:])


def _widths(a: complex, b: complex, start: Array, end: Array) -> Array:
    """(k,) distances from points of the edge ``a b`` straight across the domain to an edge."""
    inward = 1j * (b - a) / abs(b - a)
    points = a + (b - a) * (np.arange(_SAMPLES)[:, None] + 0.5) / _SAMPLES
    # In a frame with the edge on the real axis and the domain above it.
    p, q = ((z - points) / inward * 1j for z in (start, end))
    rise = np.where(p.real == q.real, 1, q.real - p.real)
    height = p.imag - p.real * (q.imag - p.imag) / rise
    meets = (p.real * q.real <= 0) & (p.real != q.real) & (height > 1e-9 * abs(b - a))
    return np.where(meets, height, np.inf).min(axis=1)
