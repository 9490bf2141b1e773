"""Options of tracing, validated on construction."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from numbers import Integral, Real
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glid_nb._arguments import unmet
from glid_nb._arrays import number_pairs, read_only
from glid_nb._errors import about
from glid_nb._json import check_fields, check_strokes, read_object
from glid_nb.imaging.errors import TraceError

Method = Literal["auto", "alpha", "threshold", "color", "scribbles"]
"""Ways to tell the foreground from the background."""

Point = tuple[float, float]


@dataclass(frozen=True, eq=False, init=False)
class Scribbles:
    """Strokes that a user drew over the shape and over the background.

    Parameters
    ----------
    foreground
        Either polylines, a list of (k, 2) arrays of pixel coordinates (x, y), or a boolean mask of
        the picture's shape (h, w).
    background
        Likewise. If empty, the picture's border is taken as background.
    """

    foreground: tuple[NDArray[np.float64], ...] | NDArray[np.bool_]
    background: tuple[NDArray[np.float64], ...] | NDArray[np.bool_]

    def __init__(
        self,
        foreground: Iterable[ArrayLike] | NDArray[np.bool_],
        background: Iterable[ArrayLike] | NDArray[np.bool_] = (),
    ) -> None:
        object.__setattr__(self, "foreground", _strokes(foreground, "foreground"))
        object.__setattr__(self, "background", _strokes(background, "background"))

    @classmethod
    def load(cls, path: str | Path) -> Scribbles:
        """Read strokes from a JSON file.

        It holds an object with the keys ``foreground`` and, optionally, ``background``, each a list
        of strokes; a stroke is a list of pixels ``[x, y]`` from the picture's top left corner.

        Raises
        ------
        InputFileError
            The file holds something else; the message names the file and the field.
        OSError
            The file cannot be read.
        """
        with about(path):
            data = read_object(path)
            required, optional = {"foreground": check_strokes}, {"background": check_strokes}
            check_fields(data, "scribbles", required, optional, others=True)
            return cls(data["foreground"], data.get("background") or [])


@dataclass(frozen=True)
class TraceOptions:
    """How a cage is traced. None: the value is chosen to suit the picture.

    Parameters
    ----------
    method
        How the foreground is found: ``"alpha"`` (the alpha channel), ``"threshold"`` (brightness),
        ``"color"`` (distance from the background's colour), ``"scribbles"`` (a user's strokes), or
        ``"auto"``: scribbles if there are any, else alpha if it is informative, else colour if the
        border is uniform, else threshold.
    threshold
        Least value in [0, 1] of the foreground: of alpha (None: 0.5), of brightness (None: Otsu),
        of the distance from the background's colour, where black and white are 1 apart (None: from
        the distances themselves), of the probability from scribbles (None: 0.5).
    invert
        Swap foreground and background: by threshold dark pixels become foreground, by colour those
        that have the colour. None: no; by threshold, so that the border becomes background.
    background
        Background colour (red, green, blue), each in [0, 1], for ``"color"``; None: estimated from
        the border.
    background_at
        A pixel (x, y) that shows the background's colour, instead of `background`.
    scribbles
        Strokes for ``"scribbles"``.
    smoothing
        Standard deviation in pixels of a Gaussian blur before the outline is taken. None: 0 for
        alpha and scribbles, 0.1 % of the longer side otherwise.
    component
        Which connected component of the foreground, counted from 0, the largest.
    component_at
        A pixel (x, y) in the component, instead of `component`.
    min_hole_area
        Least area, in square pixels, of a hole that is kept. None: 0.2 % of the component, or
        0.75 % by colour or threshold, where eyes and highlights look like holes; at least 9.
    keep_holes, drop_holes
        Pixels (x, y) in holes that are kept or filled whatever their area; the later list wins.
    offset
        Pixels by which the cage is moved away from the shape's outline, also into the holes.
        None: about 1 % of the shape's size, less if that would close a bay.
    simplify
        Largest distance in pixels between the outline and its simplification, before edges that cut
        off a part of the shape are moved outwards. None: for a typical character this gives 60 to
        120 vertices.
    max_vertices
        Most vertices that the cage may have.
    min_edge
        Edges shorter than this many pixels, which make the harmonic basis stiff, are merged with a
        neighbour. None: a fifth of the mean edge.
    max_edge
        Edges longer than this many pixels, at least 0.5, are divided evenly, so that straight limbs
        can bend. None: a twenty-fifth of the perimeter; `math.inf`: never.

    Raises
    ------
    TraceError
        A value outside its range; the message names it.
    """

    method: Method = "auto"
    threshold: float | None = None
    invert: bool | None = None
    background: tuple[float, float, float] | None = None
    background_at: Point | None = None
    scribbles: Scribbles | None = None
    smoothing: float | None = None
    component: int = 0
    component_at: Point | None = None
    min_hole_area: float | None = None
    keep_holes: Sequence[Point] = ()
    drop_holes: Sequence[Point] = ()
    offset: float | None = None
    simplify: float | None = None
    max_vertices: int | None = None
    min_edge: float | None = None
    max_edge: float | None = None

    def __post_init__(self) -> None:
        if expected := unmet(Method, self.method):
            raise TraceError(f"method must be {expected}, not {self.method!r}")
        if self.invert not in (None, True, False):
            raise TraceError(f"invert must be True, False or None, not {self.invert!r}")
        if self.scribbles is not None and not isinstance(self.scribbles, Scribbles):
            kind = type(self.scribbles).__name__
            raise TraceError(f"scribbles must be of the class Scribbles, not {kind}")
        for name, check in _CHECKS.items():
            value = getattr(self, name)
            if value is not None or name == "component":
                object.__setattr__(self, name, check(value, name))
        if self.background is not None and self.background_at is not None:
            raise TraceError("background and background_at are both given; give one of them")
        if self.method == "scribbles" and self.scribbles is None:
            raise TraceError(
                "the method 'scribbles' needs scribbles=Scribbles(foreground, background)"
            )


def _number(value: Any, name: str, low: float = 0, high: float = math.inf) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float, np.number)):
        raise TraceError(f"{name} must be a number, not {value!r}")
    if not low <= value <= high or (value == math.inf and name != "max_edge"):
        span = f"in [{low}, {high}]" if high < math.inf else f"at least {low}, and finite"
        raise TraceError(f"{name} must be a number {span}, not {value!r}")
    return float(value)


def _whole(value: Any, name: str, least: int = 0) -> int:
    if isinstance(value, bool) or not isinstance(value, Integral) or value < least:
        raise TraceError(f"{name} must be a whole number, at least {least}, not {value!r}")
    return int(value)


def _numbers(value: Any, name: str, what: str = "pixels (x, y)", count: int = 2) -> tuple:
    given = tuple(value) if isinstance(value, Iterable) and not isinstance(value, str) else ()
    if len(given) != count or any(isinstance(v, Real) and not math.isfinite(v) for v in given):
        raise TraceError(f"{name} must be given as {what} with finite numbers, not {value!r}")
    return tuple(_number(v, name, -math.inf) for v in given)


def _color(value: Any, name: str) -> tuple[float, ...]:
    color = _numbers(value, name, "(red, green, blue)", 3)
    if not all(0 <= c <= 1 for c in color):
        raise TraceError(f"{name} must be (red, green, blue), each in [0, 1], not {color}")
    return color


def _points(value: Any, name: str) -> tuple[Point, ...]:
    if not isinstance(value, Iterable):
        raise TraceError(f"{name} must be a list of pixels (x, y), not {value!r}")
    return tuple(_numbers(point, name) for point in value)


_CHECKS: dict[str, Callable[[Any, str], Any]] = {
    "background": _color,
    "threshold": partial(_number, high=1),
    "component": _whole,
    "max_vertices": partial(_whole, least=3),
    "max_edge": partial(_number, low=0.5),
    **dict.fromkeys(("smoothing", "min_hole_area", "offset", "simplify", "min_edge"), _number),
    **dict.fromkeys(("background_at", "component_at"), _numbers),
    **dict.fromkeys(("keep_holes", "drop_holes"), _points),
}


def _strokes(
    strokes: Iterable[ArrayLike] | NDArray[np.bool_], name: str
) -> tuple[NDArray[np.float64], ...] | NDArray[np.bool_]:
    if isinstance(strokes, np.ndarray) and strokes.dtype == np.bool_:
        if strokes.ndim != 2:
            raise TraceError(
                f"scribbles: the {name} mask must have the shape (h, w), not {strokes.shape}"
            )
        return read_only(strokes.copy())
    lines = []
    for i, stroke in enumerate(strokes):
        wanted = (
            f"scribbles: {name} stroke {i} must be a (k, 2) array of finite pixel coordinates "
            "(x, y); for a mask use an array of bool"
        )
        line = number_pairs(stroke, wanted, TraceError)
        if not len(line) or not np.isfinite(line).all():
            raise TraceError(wanted)
        lines.append(read_only(line))
    return tuple(lines)
