"""The cage tracer: a picture with its cage, and controls."""

import functools
import io
import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import shapely
import traitlets
from numpy.typing import NDArray
from PIL import Image

from glid_nb._errors import InputError
from glid_nb.geometry import Cage, Domain
from glid_nb.imaging import Hole, ImageSource, TraceOptions, Tracing, png
from glid_nb.page import bundle, stylesheet
from glid_nb.session.tracing import TracingModel, TracingState
from glid_nb.widgets.gestures import Event
from glid_nb.widgets.pad import Pad
from glid_nb.widgets.tracer_gestures import REACH_SHARES, Cut, TraceGestures

_LONGEST_SIDE = 1600  # of the page's picture; the cage is traced on the original
_LISTED_HOLES = 40
_BRUSHES = ("foreground", "background")
_MOST_POINTS = 200  # of a hole's outline
_AUTOMATIC = ("method", "threshold", "offset", "simplify")  # options that may be automatic


class CageTracer(Pad):
    """Traces a cage around the shape in a picture and edits it by hand.

    The widget is a view of a `TracingModel`, which does the work and needs no browser. The image is
    as in `glid_nb.read_image`; without one the widget asks for a file. ``options`` are the initial
    options. Give a ``model`` instead of image and options to show that model. The picture's area is
    ``height`` CSS pixels high, at least 240; None uses the height of the window. With
    ``on_pieces`` the page offers to keep the other pieces of a picture or cut, and gives that
    function the states that trace them. Raises a
    TraceError for an unreadable picture.

    >>> import numpy as np
    >>> y, x = np.mgrid[:100, :100] + 0.5
    >>> tracer = CageTracer(np.hypot(x - 50, y - 50) < 40)
    >>> tracer.cage.n_holes
    0
    """

    _script = traitlets.Unicode(bundle("tracer")).tag(sync=True)
    _css = stylesheet("tracer")

    picture = traitlets.Bytes(b"").tag(sync=True)
    """The page's picture, PNG or JPEG, at most 1,600 pixels wide or high."""

    shown = traitlets.Dict().tag(sync=True)
    """The state shown by the page; see `described`."""

    height = traitlets.Int(460, min=240, allow_none=True).tag(sync=True)
    """Height of the picture's area in CSS pixels, at least 240; None uses the window's height."""

    def __init__(
        self,
        image: ImageSource | None = None,
        options: TraceOptions | None = None,
        *,
        model: TracingModel | None = None,
        height: int | None = 460,
        on_pieces: Callable[[list[TracingState]], None] | None = None,
        **kwargs: Any,
    ) -> None:
        if model is not None and (image is not None or options is not None):
            raise ValueError("give a model, or a picture and options, not both")
        self.tracing_model = model if model is not None else TracingModel(image, options)
        """The model of this view."""
        self.gestures = TraceGestures(self.tracing_model)  # handles pointers and keys
        self._on_pieces = on_pieces
        self._pushed_image: NDArray[np.uint8] | None = None
        super().__init__(height=height, **kwargs)
        self._push()
        self.serve(self.tracing_model, self.handle)
        self._endings = (self.on_change(self._push),)

    @property
    def image(self) -> NDArray[np.uint8] | None:
        """The picture, (h, w, 4) uint8."""
        return self.tracing_model.image

    @property
    def options(self) -> TraceOptions:
        """The options of the tracing, as shown by the controls."""
        return self.tracing_model.options

    @property
    def tracing(self) -> Tracing | None:
        """The automatic part of the tracing; None if it failed."""
        return self.tracing_model.outcome.tracing

    @property
    def cage(self) -> Cage | None:
        """The last valid cage, with edits by hand; None before there is one."""
        return self.tracing_model.cage

    @property
    def domain(self) -> Domain | None:
        """The domain of the cage."""
        return self.tracing_model.domain

    def on_change(self, callback: Callable[[], None]) -> Callable[[], None]:
        """Call ``callback`` after every change, by hand or by code. Returns a function that ends
        this."""
        return self.tracing_model.observe(lambda _: callback())

    def handle(self, events: Sequence[Event]) -> str | None:
        """Act on pointers and keys."""
        rest = [event for event in events if event["type"] != "keep_pieces"]
        refusal = self.gestures.handle(rest) if rest else None
        if self._on_pieces is not None and len(rest) < len(events):
            try:
                self._on_pieces(self.gestures.pieces())  # without the model's lock
            except InputError as error:
                refusal = error.plain
        # The model announces its own changes. Changes of the tools are not the model's.
        own = _of_hand(self.gestures)
        if own != {name: self.shown[name] for name in own}:
            self._push()
        return refusal

    def _push(self) -> None:
        with self.tracing_model.locked(), self.hold_sync():
            if self.tracing_model.image is not self._pushed_image:
                self._pushed_image = self.tracing_model.image
                self.gestures.begin()
                self.picture = displayed(self._pushed_image)
            keeps: dict[str, Any] = {"keeps": self._on_pieces is not None}
            self.shown = described(self.gestures) | keeps


def described(gestures: TraceGestures) -> dict[str, Any]:
    """The state of a tracing and its tools. Points are in pixels, rounded to hundredths."""
    model = gestures.model
    frame, outcome, scribbles = model.frame, model.outcome, model.state.scribbles
    options = {k: v for k, v in vars(model.options).items() if k != "scribbles"}
    if options["max_edge"] == math.inf:
        options["max_edge"] = "never"
    traced: dict[str, Any] = {"automatic": None, "notes": []}
    traced |= dict.fromkeys(("component", "n_components", "component_area", "n_filled"), 0)
    if (tracing := outcome.tracing) is not None:
        traced = {
            "automatic": {name: getattr(tracing, name) for name in _AUTOMATIC},
            "component": tracing.component.rank,
            "n_components": tracing.n_components,
            "component_area": tracing.component.area,
            "n_filled": tracing.n_filled,
            "notes": list(tracing.notes),
        }
    return {
        **traced,
        "size": None if frame is None else [frame.width, frame.height],
        "loops": [_rounded(loop) for loop in model.loops],
        "problems": [
            {"message": p.plain, "point": None if p.point is None else _rounded(p.point)}
            for p in outcome.problems
        ],
        "options": options,
        "reach_shares": REACH_SHARES,
        "holes": [_hole(hole) for hole in model.holes[:_LISTED_HOLES]],
        "n_holes": len(model.holes),
        "strokes": {brush: _strokes(getattr(scribbles, brush, None)) for brush in _BRUSHES},
        **{name: getattr(model, name) for name in ("doubt", "can_undo", "can_redo", "edited")},
        "discarded": model.has_discarded_edits,
        **_of_hand(gestures),
    }


def _of_hand(gestures: TraceGestures) -> dict[str, Any]:
    """The state of the tools, which is not part of the tracing."""
    return {
        "tool": gestures.tool,
        "corners": [list(corner) for corner in gestures.corners],
        "inside": gestures.inside,
        "cut": _cut(gestures.cut),
        "knife_width": gestures.knife_width,
        "selected": [list(vertex) for vertex in gestures.selected],
    }


def _cut(cut: Cut | None) -> dict[str, Any] | None:
    """The last cut for the page: the pieces as shares of the shape, and the kept one."""
    if cut is None:
        return None
    areas = np.array([piece.area for piece in cut.pieces])
    shares = (areas / areas.sum()).tolist()
    return {"shares": shares, "kept": cut.kept, "in_middle": cut.in_middle}


def displayed(image: NDArray[np.uint8] | None) -> bytes:
    """The picture for the page: PNG, or JPEG if nothing is transparent; empty without a picture."""
    if image is None:
        return b""
    picture, buffer = Image.fromarray(image), io.BytesIO()
    picture.thumbnail((_LONGEST_SIDE, _LONGEST_SIDE), Image.Resampling.LANCZOS)
    if image[..., 3].min() < 255:
        return png(np.asarray(picture), compress_level=3)
    picture.convert("RGB").save(buffer, format="JPEG", quality=92)
    return buffer.getvalue()


@functools.lru_cache(maxsize=256)  # by identity; most changes do not change the holes
def _hole(hole: Hole) -> dict[str, Any]:
    loop = shapely.get_coordinates(shapely.LinearRing(hole.loop).simplify(0.5))[:-1]
    loop = _rounded(loop[:: math.ceil(len(loop) / _MOST_POINTS)])
    area = round(hole.area, 1)
    return {"loop": loop, "area": area, "kept": hole.kept, "by_offset": hole.by_offset}


def _strokes(strokes: Any) -> list[Any]:
    return [] if isinstance(strokes, np.ndarray) else [_rounded(one) for one in strokes or ()]


def _rounded(points: Any) -> Any:
    return np.round(points, 2).tolist()
