"""The cage tracer: a picture with its cage, and controls."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import traitlets
from numpy.typing import NDArray

from glid_nb.geometry import Cage, Domain
from glid_nb.imaging import TraceOptions, Tracing
from glid_nb.imaging.read import ImageSource
from glid_nb.session import TracingModel
from glid_nb.widgets.bundle import bundle, stylesheet
from glid_nb.widgets.gestures import Event
from glid_nb.widgets.pad import Pad
from glid_nb.widgets.tracer_gestures import TraceGestures
from glid_nb.widgets.tracer_view import described, displayed


class CageTracer(Pad):
    """Traces a cage around the shape in a picture and edits it by hand.

    The widget is a view of a `TracingModel`, which does the work and needs no browser.

    Parameters
    ----------
    image
        A picture, as in `glid_nb.read_image`. Without one the widget asks for a file.
    options : TraceOptions, optional
        How to trace at first.
    model : TracingModel, optional
        A model to show, instead of `image` and `options`.
    height : int
        Height of the picture's area in CSS pixels.

    Raises
    ------
    TraceError
        The picture cannot be read.

    Examples
    --------
    >>> import numpy as np
    >>> y, x = np.mgrid[:100, :100] + 0.5
    >>> tracer = CageTracer(np.hypot(x - 50, y - 50) < 40)
    >>> tracer.cage.n_holes
    0
    """

    _esm = bundle("tracer/main.js")
    _css = stylesheet("tracer/tracer.css")

    picture = traitlets.Bytes(b"").tag(sync=True)
    """The picture that the page draws, PNG or JPEG, at most 1,600 pixels wide or high."""

    shown = traitlets.Dict().tag(sync=True)
    """The state that the page shows; see `glid_nb.widgets.tracer_view.described`."""

    height = traitlets.Int(460, min=240).tag(sync=True)
    """Height of the picture's area in CSS pixels, at least 240."""

    def __init__(
        self,
        image: ImageSource | None = None,
        options: TraceOptions | None = None,
        *,
        model: TracingModel | None = None,
        height: int = 460,
        **kwargs: Any,
    ) -> None:
        if model is not None and (image is not None or options is not None):
            raise ValueError("give a model, or a picture and options, not both")
        self.tracing_model = model if model is not None else TracingModel(image, options)
        """The model that this is a view of."""
        self.gestures = TraceGestures(self.tracing_model)
        """What pointers and keys mean here."""
        self._pushed_image: NDArray[np.uint8] | None = None
        super().__init__(height=height, **kwargs)
        self._push()
        self.serve(self.tracing_model, self)
        self._endings = (self.on_change(self._push),)

    @property
    def image(self) -> NDArray[np.uint8] | None:
        """The picture, (h, w, 4) uint8."""
        return self.tracing_model.image

    @property
    def options(self) -> TraceOptions:
        """How the cage is traced, as the controls stand."""
        return self.tracing_model.options

    @property
    def tracing(self) -> Tracing | None:
        """The automatic part of the tracing; None when it fails."""
        return self.tracing_model.outcome.tracing

    @property
    def cage(self) -> Cage | None:
        """The cage, with the edits by hand; the last valid one; None before there is one."""
        return self.tracing_model.cage

    @property
    def domain(self) -> Domain | None:
        """The domain of the cage."""
        return self.tracing_model.domain

    def on_change(self, callback: Callable[[], None]) -> Callable[[], None]:
        """Call ``callback`` after every change, by hand or by code; the result ends that."""
        return self.tracing_model.observe(lambda _: callback())

    def handle(self, events: Sequence[Event]) -> str | None:
        """Act on pointers and keys."""
        hand = self.gestures
        refusal = hand.handle(events)
        # The model announces its own changes; tool and selection are not the model's.
        selected = [list(vertex) for vertex in hand.selected]
        if (hand.tool, selected) != (self.shown["tool"], self.shown["selected"]):
            self._push()
        return refusal

    def _push(self) -> None:
        with self.tracing_model.locked(), self.hold_sync():
            if self.tracing_model.image is not self._pushed_image:
                self._pushed_image = self.tracing_model.image
                self.picture = displayed(self._pushed_image)
            self.shown = described(self.gestures)
