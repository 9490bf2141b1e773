"""Figures with sliders, and a point to drag, that need no kernel: all frames are in the output, and
the page shows one.

A frame is an SVG file, in which fields and pictures are WebP. Frames of one figure have most lines
in common, such as the outlines of letters, so each line is stored once. `page/js/frames` reads it.
"""

import base64
import html
import io
import itertools
import json
import math
import re
import zlib
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import Collection
from matplotlib.figure import Figure
from numpy.typing import ArrayLike
from PIL import Image

from glid_nb._errors import InputError
from glid_nb.figures.drawing import MANY, figure_png, notebook_png
from glid_nb.figures.parts import parts
from glid_nb.figures.style import COLOR_BAR, CSS_DPI
from glid_nb.geometry import as_points
from glid_nb.page.files import bundle, stylesheet

_PIXELS_PER_INCH = 120.0  # of the fields and pictures in a frame
_QUALITY = 70  # of their WebP files
_MOST = 200  # frames of one figure
_PNG = re.compile(r'data:image/png;base64,([^"]+)')


class LiveFigure:
    """A figure with sliders, as :func:`live` draws it. A notebook shows it."""

    def __init__(self, markup: str, first: Figure) -> None:
        self._html, self._first = markup, first

    def __repr__(self) -> str:
        return f"<{type(self).__name__}>"

    def _repr_mimebundle_(self, **_: Any) -> tuple[dict[str, Any], dict[str, Any]]:
        """The page with its sliders, and the first picture for readers that show no HTML."""
        png, size = notebook_png(self._first)
        data = {"text/plain": repr(self), "text/html": self._html, "image/png": png}
        return data, {"image/png": size}


def live(
    draw: Callable[..., Figure],
    *start: Any,
    point: Callable[..., ArrayLike] | None = None,
    **values: Iterable[Any],
) -> LiveFigure:
    """A figure with a slider for each argument of ``draw``. It also moves in a saved notebook.

    ``values`` has the positions of each slider, such as ``t=[0, 0.5, 1]``; False and True make a
    check box. ``draw`` returns a figure of this package or of matplotlib. It is called once for
    each combination of them, now, so the page needs no kernel. ``start`` has the values to begin
    with, in the same order; the default is the first of each. All frames have the same axes: the
    limits contain those of every frame. On a phone, panels side by side come below each other.

    ``point`` takes the same arguments and returns a place (x, y) in the first axes, or a complex
    number. The page shows a ring there. Dragging the ring moves the sliders to neighbouring
    positions as long as their place is nearer to the hand.

    Raises an InputError if a slider has no position, if ``start`` is not among the values, if a
    place of ``point`` lies outside the figure, or for more than 200 frames.
    """
    positions = {name: _plain(name, given) for name, given in values.items()}
    if not positions:
        raise InputError("there is no slider; give values for one, such as t=[0, 0.5, 1]")
    count = math.prod(map(len, positions.values()))
    if count > _MOST:
        raise InputError(f"there are {count} frames; at most {_MOST} fit in a notebook")
    begin = _indices(positions, start)
    combinations = [
        dict(zip(positions, one, strict=True)) for one in itertools.product(*positions.values())
    ]
    figures = [draw(**one) for one in combinations]
    for one in figures:
        if not isinstance(one, Figure):
            raise InputError(f"the function returns {type(one).__name__}, not a figure")
    _hold_still(figures)
    data = {
        "controls": [
            {"name": name, "values": list(map(_text, given)), "start": i, "check": _is_check(given)}
            for (name, given), i in zip(positions.items(), begin, strict=True)
        ],
        **_in_lines([_svg(figure) for figure in figures]),
        "titles": [_titles(figure) for figure in figures],
        "parts": parts(figures),
    }
    if point is not None:
        places = [point(**one) for one in combinations]
        data["points"] = list(map(_in_picture, figures, places, combinations))
    shown = int(np.ravel_multi_index(begin, [len(given) for given in positions.values()]))
    words = ", ".join(f"{name} = {_text(value)}" for name, value in combinations[shown].items())
    alt = ": ".join(filter(None, [words, _titles(figures[shown])]))
    return LiveFigure(_markup(data, alt, figures[shown]), figures[shown])


def _in_picture(figure: Figure, place: ArrayLike, of: dict[str, Any]) -> list[float]:
    """A place in the first axes, as shares of the picture's width and height from its top left.

    The figure must have been drawn, because drawing arranges its axes.
    """
    given = np.asarray(place)
    if given.ndim == 0:
        given = as_points(np.atleast_1d(given))[0]
    words = ", ".join(f"{name} = {_text(value)}" for name, value in of.items())
    if given.shape != (2,):
        raise InputError(f"the point of {words} is no (x, y) and no complex number")
    x, y = figure.axes[0].transData.transform(given) / figure.bbox.size
    if not (0 <= x <= 1 and 0 <= y <= 1):
        raise InputError(f"the point of {words} lies outside the figure; enlarge the axes' limits")
    return [round(float(x), 4), round(float(1 - y), 4)]


def _in_lines(frames: Sequence[str]) -> dict[str, Any]:
    """All lines of the frames, each once, and each frame as the numbers of its lines."""
    known: dict[str, int] = {}
    numbers = [
        [known.setdefault(line, len(known)) for line in frame.splitlines()] for frame in frames
    ]
    return {"lines": list(known), "frames": numbers}


def _plain(name: str, given: Iterable[Any]) -> list[Any]:
    """The positions as Python's own numbers, texts or booleans."""
    if not isinstance(given, Iterable):
        raise InputError(f"the slider {name} needs several values, such as {name}=[0, 0.5, 1]")
    found = [np.asarray(value).tolist() for value in given]
    found = [round(value, 12) if isinstance(value, float) else value for value in found]
    if not found:
        raise InputError(f"the slider {name} has no position; give at least one value")
    return found


def _indices(positions: dict[str, list[Any]], start: Sequence[Any]) -> list[int]:
    if len(start) > len(positions):
        raise InputError(
            f"there are {len(start)} values to begin with for {len(positions)} sliders"
        )
    indices = [0] * len(positions)
    for i, (value, (name, given)) in enumerate(zip(start, positions.items(), strict=False)):
        if value not in given:
            known = ", ".join(map(_text, given))
            raise InputError(f"{name} cannot begin with {value}, which is not one of {known}")
        indices[i] = given.index(value)
    return indices


def _is_check(given: list[Any]) -> bool:
    return given == [False, True] and all(isinstance(value, bool) for value in given)


def _text(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _titles(figure: Figure) -> str:
    """The titles of a figure's axes, in one line, for screen readers."""
    titles = (" ".join(axes.get_title().split()) for axes in figure.axes)
    return "; ".join(filter(None, titles))


def _hold_still(figures: Sequence[Figure]) -> None:
    """Give all figures the size of the largest, and their axes the limits that contain all."""
    sizes = np.array([figure.get_size_inches() for figure in figures])
    for figure in figures:
        figure.set_size_inches(*sizes.max(axis=0))
    if len({len(figure.axes) for figure in figures}) > 1:
        return
    for same in zip(*(figure.axes for figure in figures), strict=True):
        if same[0].get_label() == COLOR_BAR:
            continue
        x, y = _union(same, Axes.get_xlim), _union(same, Axes.get_ylim)
        for axes in same:
            axes.set(xlim=x, ylim=y, adjustable="box")  # "datalim" would change the limits


def _union(same: Sequence[Axes], limits: Callable[[Axes], Any]) -> tuple[float, float]:
    found = np.array([limits(axes) for axes in same])
    return float(found.min()), float(found.max())


def _svg(figure: Figure) -> str:
    """The figure as SVG. Fields and pictures in it have pixels, because they have many parts."""
    for collection in figure.findobj(Collection):
        if isinstance(collection, Collection) and len(collection.get_paths()) > MANY:
            collection.set_rasterized(True)
    file = io.StringIO()
    # The same figure gives the same text.
    with mpl.rc_context({"svg.hashsalt": "glid_nb", "svg.fonttype": "path"}):
        figure.savefig(file, format="svg", dpi=_PIXELS_PER_INCH, metadata={"Date": None})
    return _PNG.sub(_as_webp, file.getvalue())


def _as_webp(found: re.Match[str]) -> str:
    """The same picture, with colours mixed with white instead of half transparent ones: those make
    WebP files large, and encoding slow."""
    with Image.open(io.BytesIO(base64.b64decode(found[1]))) as picture:
        drawn = picture.convert("RGBA")
    white = Image.new("RGBA", drawn.size, "white")
    white.alpha_composite(drawn)
    alpha = np.asarray(drawn.getchannel("A"))
    white.putalpha(Image.fromarray(np.where(alpha > 0, 255, 0).astype(np.uint8)))
    return _data_url(white)


def _data_url(picture: Image.Image) -> str:
    file = io.BytesIO()
    picture.save(file, "webp", quality=_QUALITY, method=4)
    return "data:image/webp;base64," + _base64(file.getvalue())


def _base64(data: bytes) -> str:
    return base64.b64encode(data).decode("ascii")


def _markup(data: dict[str, Any], alt: str, figure: Figure) -> str:
    """HTML with a frame as a picture, for print and without script. The script adds the sliders."""
    packed = json.dumps(data, ensure_ascii=False, separators=(",", ":")).encode()
    width, height = (CSS_DPI * figure.get_size_inches()).round().astype(int)
    with Image.open(io.BytesIO(figure_png(figure))) as drawn:
        source = _data_url(drawn.convert("RGB"))
    return (
        f'<figure class="glid-frames" data-frames="{_base64(zlib.compress(packed, 9))}">'
        f'<img src="{source}" width="{width}" height="{height}" alt="{html.escape(alt)}">'
        f"</figure><style>{stylesheet('frames')}</style><script>{bundle('frames')}</script>"
    )
