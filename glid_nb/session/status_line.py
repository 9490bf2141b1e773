"""What the deformation editor is doing, in words."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from glid_nb.session.edit_state import EditState
from glid_nb.session.live_solver import Frame
from glid_nb.solvers import Status

Level = Literal["idle", "working", "good", "blocked", "error"]

_REACHED = 0.01  # world units: a handle this near to its target looks as if it were there


@dataclass(frozen=True)
class StatusLine:
    """A line of text and its tone."""

    level: Level
    text: str


def describe(state: EditState, busy: bool, paused: bool, frame: Frame | None) -> StatusLine:
    """The status of an editor in this state."""
    current = state.current
    if paused:
        return StatusLine("idle", "Paused" + _bound(frame))
    if busy:
        if frame is None:
            return StatusLine("working", "Preparing the solver…")
        return StatusLine("working", "Working" + _iterations(frame) + _bound(frame))
    solution = current.solution
    if solution is None:
        return StatusLine("idle", "Stopped" + _bound(frame))
    if not len(current.pose):
        return StatusLine("idle", "Click the shape to add a handle, then drag it")
    status = solution.status
    if status is Status.BLOCKED:
        miss = _miss(state)
        return StatusLine(
            "blocked",
            f"Blocked: the shape follows as far as it is proved not to fold{miss}" + _bound(frame),
        )
    if status in (Status.MAX_ITERATIONS, Status.INDEFINITE):
        return StatusLine("blocked", status.message + _bound(frame))
    if status is Status.STOPPED:
        return StatusLine("idle", "Stopped" + _bound(frame))
    return StatusLine("good", "Converged" + _miss(state) + _bound(frame))


def describe_error(error: Exception) -> StatusLine:
    """The status after the solver's thread met an exception."""
    text = str(error) or type(error).__name__
    return StatusLine("error", f"The solver failed: {text} The last certified map is shown.")


def _iterations(frame: Frame) -> str:
    return f", iteration {frame.history[-1].iteration}" if frame.history else ""


def _bound(frame: Frame | None) -> str:
    if frame is None or not len(frame.sigma2_lower):
        return ""
    return f" · certified σ₂ ≥ {rounded_down(float(frame.sigma2_lower.min()))}"


def _miss(state: EditState) -> str:
    """How far the farthest handle is from its target, when that is far enough to see."""
    pose = state.pose
    if not len(pose):
        return ""
    gap = state.map(pose.handles) - pose.targets
    worst = float(max(math.hypot(*row) for row in gap))
    return f", {worst:.2g} units from its target" if worst > _REACHED else ""


def rounded_down(value: float) -> str:
    """Three digits of a lower bound that still is one."""
    if not (value > 0 and math.isfinite(value)):
        return f"{value:.3g}"
    unit = 10.0 ** (math.floor(math.log10(value)) - 2)
    return f"{math.floor(value / unit) * unit:.3g}"
