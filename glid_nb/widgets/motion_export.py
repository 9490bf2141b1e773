"""Exports of the motion through the poses, drawn in the background."""

from collections.abc import Callable

import ipywidgets

from glid_nb._errors import InputError
from glid_nb.export.motion import motion_files
from glid_nb.session.animation import Animation
from glid_nb.session.editor_model import EditorModel
from glid_nb.session.worker import LatestWins, weakly
from glid_nb.widgets.closing import ClosingWidget
from glid_nb.widgets.controls import REFUSED, button

_NUMBER = {"width": "70px", "flex": "0 0 auto"}

# A name, and what takes the files and says where they are.
_Task = tuple[str, Callable[[dict[str, bytes]], str]]


class MotionExport(ClosingWidget, ipywidgets.HBox):
    """Size and rate of a moving picture, and how far it is drawn; ``say(text, style)`` tells."""

    def __init__(
        self, model: EditorModel, animation: Animation, say: Callable[[str, str], None]
    ) -> None:
        self._model, self._animation, self._say = model, animation, say
        self.size = ipywidgets.BoundedIntText(
            480, min=16, max=4096, tooltip="Pixels of the longer side", layout=_NUMBER
        )
        self.rate = ipywidgets.BoundedFloatText(
            25, min=1, max=100, tooltip="Frames per second", layout=_NUMBER
        )
        self.progress = ipywidgets.IntProgress(layout={"width": "auto", "flex": "1 1 40px"})
        """Frames that are drawn; hidden while nothing is."""
        self._worker: LatestWins[_Task] = LatestWins(weakly(self._draw), self, "export")
        self.cancel = button("Cancel", "stop", "Stop drawing", self._worker.cancel)
        self._running = (self.progress, self.cancel)
        self._show(False)
        px, fps = (ipywidgets.Label(text, layout={"flex": "0 0 auto"}) for text in ("px", "fps"))
        layout = {"flex": "1 1 auto", "min_width": "0"}
        super().__init__([self.size, px, self.rate, fps, *self._running], layout=layout)
        self._endings = (self._worker.close,)

    def start(self, name: str, deliver: Callable[[dict[str, bytes]], str]) -> str:
        """Draw a file of this name, then deliver what was made; says at once what is done."""
        self._show(True)
        self._worker.submit((name, deliver))
        return f"Drawing {name}…"

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until nothing is drawn; whether that is within ``timeout`` seconds."""
        return self._worker.wait(timeout)

    def _draw(self, task: _Task, worker: LatestWins[_Task]) -> None:
        def report(done: int, total: int) -> bool:
            self.progress.max, self.progress.value = total, done
            return worker.overtaken

        try:
            motion, document = self._animation.motion, self._model.document
            count = len(motion.times) - 1
            if any(report(i, count) or not motion.interval(i) for i in range(count)):
                return self._say("Stopped; nothing was written.", "")
            if not motion.certificate.certified:
                raise InputError(f"{motion.certificate.reason} Nothing uncertified is exported.")
            name, deliver = task
            files = motion_files(
                name,
                document.image,
                motion,
                [pose.pose for pose in document.poses],
                size=self.size.value,
                frames_per_second=self.rate.value,
                loop=motion.repeat != "once",
                progress=report,
            )
            stopped = worker.cancelled or not files
            self._say("Stopped; nothing was written." if stopped else deliver(files), "")
        except (OSError, ValueError) as error:  # refusals for the user; others are bugs
            self._say(str(error), REFUSED)
        finally:
            self._show(False)

    def _show(self, running: bool) -> None:
        for part in self._running:
            part.layout.display = None if running else "none"
        self.progress.value = 0
