"""Options of tracing, validated on construction."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, Literal, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glid_nb._arguments import field_kinds, option, plain, unmet
from glid_nb._arrays import number_pairs, read_only
from glid_nb._errors import about
from glid_nb._json import check_fields, check_strokes, read_object
from glid_nb.imaging.frame import TraceError

ForegroundMethod = Literal["auto", "alpha", "threshold", "color", "scribbles"]
"""Ways to tell the foreground from the background."""

Point = tuple[float, float]
Color = tuple[float, float, float]  # (red, green, blue), each in [0, 1]

Strokes = tuple[NDArray[np.float64], ...] | NDArray[np.bool_]
GivenStrokes = Iterable[ArrayLike] | NDArray[np.bool_]

_ANY = math.inf
_STROKES = "Strokes, lists of [x, y] pixels under the keys foreground, background"
_PIXEL: Any = {"least": -math.inf, "form": "a pixel (x, y) of finite numbers"}
_PIXELS: Any = {"least": -math.inf, "form": "a list of pixels (x, y) of finite numbers"}


@dataclass(frozen=True, eq=False, init=False)
class Scribbles:
    """Strokes that a user drew over the shape and over the background.

    Each is a list of polylines, (k, 2) arrays of pixel coordinates (x, y), or a boolean mask of the
    picture's shape (h, w). If ``background`` is empty, the picture's border is the background.
    """

    foreground: Strokes
    background: Strokes

    def __init__(self, foreground: GivenStrokes, background: GivenStrokes = ()) -> None:
        object.__setattr__(self, "foreground", _strokes(foreground, "foreground"))
        object.__setattr__(self, "background", _strokes(background, "background"))

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read strokes from a JSON file.

        The file holds an object with the keys ``foreground`` and, optionally, ``background``. Each
        is a list of strokes. A stroke is a list of pixels ``[x, y]``, counted from the picture's
        top left corner. Raises an InputFileError that names the wrong field, or an OSError.
        """
        with about(path):
            data = read_object(path)
            required, optional = {"foreground": check_strokes}, {"background": check_strokes}
            check_fields(data, "scribbles", required, optional, others=True)
            return cls(data["foreground"], data.get("background") or [])


@dataclass(frozen=True)
class TraceOptions:
    """How a cage is traced. For None, the value is chosen automatically for the picture.

    Raises a TraceError that names a value outside its range.
    """

    method: ForegroundMethod = option("auto", "How the foreground is found")
    """``"alpha"`` (the alpha channel), ``"threshold"`` (brightness), ``"color"`` (distance from the
    background's colour), ``"scribbles"`` (a user's strokes), or ``"auto"``. ``"auto"`` uses
    scribbles if there are any, else alpha if part of the picture is transparent, else colour if the
    border is uniform, else threshold."""
    threshold: float | None = option(None, "Least value of the foreground, 0 to 1", most=1)
    """Least value of the foreground. The value is alpha (None: 0.5), brightness (None: Otsu's
    threshold), the distance from the background's colour, where black and white are 1 apart (None:
    chosen from the distances), or the probability from scribbles (None: 0.5)."""
    invert: bool | None = option(None, "Swap foreground and background")
    """Swap foreground and background. With "threshold", dark pixels become foreground. With
    "color", pixels of the background's colour become foreground. None: with "threshold", chosen so
    that the border is background; else no."""
    background: Color | None = option(
        None,
        "Background colour, each 0 to 1 (default: estimated from the border)",
        most=1,
        form="(red, green, blue), each in [0, 1]",
    )
    """(red, green, blue), each in [0, 1], for ``"color"``; None: estimated from the border."""
    background_at: Point | None = option(None, "A pixel of the background's colour", **_PIXEL)
    """A pixel (x, y) that shows the background's colour, instead of `background`."""
    scribbles: Scribbles | None = option(None, _STROKES)
    """Strokes for ``"scribbles"``."""
    smoothing: float | None = option(None, "Blur before the outline is taken, pixels")
    """Standard deviation of a Gaussian blur, in pixels. None: 0.1 % of the longer side, or 0 for
    alpha and scribbles."""
    component: int = option(0, "Which component, 0 being the largest")
    """Index of the connected component of the foreground; 0 is the largest."""
    component_at: Point | None = option(None, "A pixel in the component to trace", **_PIXEL)
    """A pixel (x, y) in the component, instead of `component`."""
    min_hole_area: float | None = option(None, "Smaller holes are filled, square pixels")
    """Least area of a kept hole, in square pixels. None: 0.2 % of the component, at least 9. With
    "color" and "threshold" it is 0.75 %, because eyes and highlights look like holes."""
    keep_holes: Sequence[Point] = option((), "A pixel in a hole to keep, of any size", **_PIXELS)
    drop_holes: Sequence[Point] = option((), "A pixel in a hole to fill, of any size", **_PIXELS)
    """Pixels (x, y) in holes that are filled, of any area; takes precedence over `keep_holes`."""
    offset: float | None = option(None, "Distance of the cage from the outline, pixels")
    """Distance outwards, and into holes. None: about 1 % of the shape's size, less if that would
    close a bay."""
    simplify: float | None = option(None, "How far simplification may move the outline, pixels")
    """Largest distance from the outline. Afterwards, edges that cut off a part of the shape are
    moved outwards. None: a value that gives a typical character 60 to 120 vertices."""
    max_vertices: int | None = option(None, "Largest number of vertices of the cage", least=3)
    min_edge: float | None = option(None, "Shorter edges are merged, pixels")
    """Least length of an edge. Short edges make the harmonic basis stiff. None: a fifth of the mean
    edge."""
    max_edge: float | None = option(None, "Longer edges are divided, pixels", least=0.5, most=_ANY)
    """Largest length of an edge. Edges must be short enough for limbs to bend. None: perimeter /
    25; `math.inf`: edges are never divided."""

    def __post_init__(self) -> None:
        for known in fields(self):
            given = getattr(self, known.name)
            value = plain(given)
            if expected := unmet(field_kinds(TraceOptions)[known.name], value, known.metadata):
                raise TraceError(f"{known.name} must be {expected}, not {given!r:.60}")
            object.__setattr__(self, known.name, value)
        if self.background is not None and self.background_at is not None:
            raise TraceError("background and background_at are both given; give one of them")
        if self.method == "scribbles" and self.scribbles is None:
            raise TraceError("method='scribbles' needs scribbles=Scribbles(foreground, background)")


def _strokes(strokes: GivenStrokes, name: str) -> Strokes:
    if isinstance(strokes, np.ndarray) and strokes.dtype == np.bool_:
        if strokes.ndim != 2:
            wanted = f"must have the shape (h, w), not {strokes.shape}"
            raise TraceError(f"scribbles: the {name} mask {wanted}")
        return read_only(strokes.copy())
    lines = []
    for i, stroke in enumerate(strokes):
        wanted = f"scribbles: {name} stroke {i} must be a (k, 2) array of finite pixel coordinates"
        wanted += " (x, y); for a mask use an array of bool"
        line = number_pairs(stroke, wanted, TraceError)
        if not len(line) or not np.isfinite(line).all():
            raise TraceError(wanted)
        lines.append(read_only(line))
    return tuple(lines)
