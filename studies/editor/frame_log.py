"""Records the kernel's work for each frame of a canvas, for a benchmark."""

import time
from collections.abc import Callable
from typing import Any

import numpy as np

import glid_nb as glid
from glid_nb.session import live_solver
from glid_nb.session.problem import Problem
from studies.cases import sample_case

N_SAMPLES = 64
"""How many numbers of a frame identify it in the page."""


class FrameLog:
    """Records, from its creation on, the frames that a canvas sends and their cost."""

    def __init__(self, canvas: glid.widgets.DeformCanvas) -> None:
        self.canvas = canvas
        self.frames: list[dict[str, Any]] = []
        """For each frame: ``sample``, which identifies it, and the ``targets`` of its solve."""
        self.solving: list[float] = []
        """Seconds of each solve; the next target may have stopped the solve early."""
        self.showing: list[float] = []
        """Seconds of each update of the canvas: evaluating, packing and sending."""
        live_solver.solve = _timed(live_solver.solve, self.solving)
        pane = canvas.pane
        pane.show = _timed(pane.show, self.showing)
        # The canvas observes the model since earlier, so it sends the frame before this is called.
        canvas.deformation.observe(self._note)

    def clear(self) -> None:
        """Forget everything recorded."""
        for rows in (self.frames, self.solving, self.showing):
            rows.clear()

    @property
    def source(self) -> tuple[str, str]:
        """The identity of the widget that sends the frames, and the name of its trait."""
        scene = self.canvas.pane.scene
        if scene.evaluated_in != "kernel":
            return str(self.canvas.pane.stage.model_id), "coefficients"
        return str(scene.picture.attributes["image"].model_id), "array"

    @property
    def widgets(self) -> list[str]:
        """Identities of the widgets that send a part of a frame."""
        pane = self.canvas.pane
        attributes = [a.model_id for layer in pane.scene.layers for a in layer.attributes.values()]
        return [str(pane.stage.model_id), *map(str, attributes)]

    def _note(self, what: str) -> None:
        frame = self.canvas.deformation.moment.frame
        if what != "frame" or frame is None:
            return
        pane = self.canvas.pane
        if pane.scene.evaluated_in != "kernel":
            numbers = np.frombuffer(pane.stage.coefficients, "<u4")
        else:
            numbers = np.ravel(pane.scene.picture.attributes["image"].array).view("<u4")
        sample = numbers[:: max(1, len(numbers) // N_SAMPLES)][:N_SAMPLES]
        targets = frame.task.pose.pose.targets
        self.frames.append({"sample": sample.tolist(), "targets": targets.tolist()})


def load(shape: str) -> tuple[np.ndarray, glid.Domain, glid.Pose]:
    """A bundled sample with its gentle pose, or a problem file with a blank picture."""
    if shape.endswith(".json"):
        problem = Problem.load(shape)
        return np.full((200, 200, 4), 255, np.uint8), problem.domain, problem.pose
    problem = sample_case(shape, "gentle").problem
    return glid.samples.image(shape), problem.domain, problem.pose


def _timed(function: Callable[..., Any], seconds: list[float]) -> Callable[..., Any]:
    def timed(*arguments: Any, **options: Any) -> Any:
        start = time.perf_counter()
        try:
            return function(*arguments, **options)
        finally:
            seconds.append(time.perf_counter() - start)

    return timed
