"""What the kernel does for each frame of a canvas, noted down for a benchmark."""

import time
from collections.abc import Callable
from typing import Any

import numpy as np

import glid_nb as glid
from glid_nb.session import live_solver
from glid_nb.session.problem import Problem
from studies.cases import sample_case

N_SAMPLES = 64
"""Numbers of a frame by which it is recognised in the page."""


class FrameLog:
    """Notes, from now on, what a canvas sends and what that cost."""

    def __init__(self, canvas: glid.widgets.DeformCanvas) -> None:
        self.canvas = canvas
        self.frames: list[dict[str, Any]] = []
        """Of each frame: ``sample`` to recognise it, and the ``targets`` it was solved for."""
        self.solving: list[float] = []
        """Seconds of each solve, which the next target may have cut short."""
        self.showing: list[float] = []
        """Seconds of each update of the canvas: evaluating, packing and sending."""
        live_solver.solve = _timed(live_solver.solve, self.solving)
        pane = canvas.pane
        pane.show = _timed(pane.show, self.showing)
        # The canvas observes the model too, from before: it has sent the frame when this is told.
        canvas.deformation.observe(self._note)

    def clear(self) -> None:
        """Begin anew."""
        for rows in (self.frames, self.solving, self.showing):
            rows.clear()

    @property
    def source(self) -> tuple[str, str]:
        """The widget whose trait carries a frame, by its identity, and the trait's name."""
        scene = self.canvas.pane.scene
        if scene.evaluated_in == "shader":
            return str(self.canvas.pane.stage.model_id), "coefficients"
        return str(scene.picture.attributes["image"].model_id), "array"

    @property
    def widgets(self) -> list[str]:
        """Identities of the widgets that a frame goes through."""
        pane = self.canvas.pane
        attributes = [a.model_id for layer in pane.scene.layers for a in layer.attributes.values()]
        return [str(pane.stage.model_id), *map(str, attributes)]

    def _note(self, what: str) -> None:
        frame = self.canvas.deformation.moment.frame
        if what != "frame" or frame is None:
            return
        pane = self.canvas.pane
        if pane.scene.evaluated_in == "shader":
            numbers = np.frombuffer(pane.stage.coefficients, "<u4")
        else:
            numbers = np.ravel(pane.scene.picture.attributes["image"].array).view("<u4")
        sample = numbers[:: max(1, len(numbers) // N_SAMPLES)][:N_SAMPLES]
        targets = frame.task.pose.pose.targets
        self.frames.append({"sample": sample.tolist(), "targets": targets.tolist()})


def load(shape: str) -> tuple[np.ndarray, glid.Domain, glid.Pose]:
    """A bundled sample with its gentle pose, or a problem file under a blank picture."""
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
