"""The cage tracer: a picture with its cage drawn over it, and controls for both."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import anywidget
import numpy as np
import traitlets
from numpy.typing import NDArray

from glid_nb.geometry import Cage, Domain, GeometryError
from glid_nb.imaging import TraceError, TraceOptions, Tracing
from glid_nb.imaging.read import ImageSource, read_image
from glid_nb.session import TracingModel
from glid_nb.widgets.bundle import bundle, stylesheet
from glid_nb.widgets.subshells import answer_during_cells
from glid_nb.widgets.tracer_view import described, displayed

_LARGEST_UPLOAD = 64 << 20


class CageTracer(anywidget.AnyWidget):
    """Traces a cage around the shape in a picture, with the hand and the eye.

    The widget is a view of a `TracingModel`, which does the work and can be driven without a
    browser; what either does shows in the other.

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

    _stop: Callable[[], None] | None = None  # a widget is closed though its making failed

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
        self._lock = threading.RLock()
        self._pushed_image: NDArray[np.uint8] | None = None
        self._upload = _Upload()
        super().__init__(height=height, **kwargs)
        answer_during_cells(self)
        self._push()
        self._stop = self.tracing_model.on_change(self._push)
        self.on_msg(self._receive)

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
        return self.tracing_model.tracing

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
        return self.tracing_model.on_change(callback)

    def close(self) -> None:
        """Remove the widget from the page; the model lives on."""
        if self._stop is not None:
            self._stop()
        super().close()

    def _push(self) -> None:
        """Bring the page up to date."""
        with self._lock, self.hold_sync():
            if self.tracing_model.image is not self._pushed_image:
                self._pushed_image = self.tracing_model.image
                self.picture = displayed(self._pushed_image)
            self.shown = described(self.tracing_model)

    def _receive(self, _: Any, message: dict[str, Any], buffers: list[Any]) -> None:
        """Do what the page asks for, and acknowledge: then it sends the latest that came since."""
        refusal = None
        try:
            self._act(message, buffers)
        except (TraceError, GeometryError) as error:
            refusal = error.plain
        except Exception as error:
            refusal = f"{type(error).__name__}: {error}"  # shown, and logged by the kernel
            raise
        finally:
            self.send({"view": message.get("view"), "ack": message.get("id"), "refusal": refusal})

    def _act(self, message: dict[str, Any], buffers: list[Any]) -> None:
        model, action, gesture = self.tracing_model, message.get("action"), message.get("gesture")
        if action == "set_options":
            model.set_options(gesture, **message["changes"])
        elif action == "move_vertex":
            model.move_vertex(message["loop"], message["index"], message["to"], gesture)
        elif action == "insert_vertex":
            model.insert_vertex(message["at"])
        elif action == "delete_vertices":
            model.delete_vertices([(loop, index) for loop, index in message["vertices"]])
        elif action == "toggle_hole":
            model.toggle_hole(message["number"])
        elif action == "paint":
            model.paint(message["brush"], message["stroke"])
        elif action in ("pick_background", "pick_component"):
            getattr(model, action)(tuple(message["at"]))
        elif action in ("clear_scribbles", "discard_edits", "undo", "redo"):
            getattr(model, action)()
        elif action == "upload":
            data = self._upload.add(message, buffers)
            if data is not None:
                model.open(read_image(data, message["name"]))
        else:
            raise TraceError(f"the page asked for {action!r}, which the tracer cannot do")


class _Upload:
    """A file that arrives in parts: a websocket message has a largest size."""

    def __init__(self) -> None:
        self._name: str | None = None
        self._data = bytearray()

    def add(self, message: dict[str, Any], buffers: list[Any]) -> bytes | None:
        """Add the part that starts at ``message["start"]``; the file when it is complete."""
        if message["start"] == 0:
            self._name, self._data = message["name"], bytearray()
        if message["name"] != self._name or message["start"] != len(self._data):
            raise TraceError(f"{message['name']}: the upload was interrupted; try again")
        if message["size"] > _LARGEST_UPLOAD:
            raise TraceError(
                f"{message['name']} has {message['size']:,} bytes; at most {_LARGEST_UPLOAD:,} can "
                "be uploaded"
            )
        for buffer in buffers:
            self._data += bytes(buffer)
        if len(self._data) < message["size"]:
            return None
        data, self._data = bytes(self._data), bytearray()
        return data
