"""What the deformation editor is doing, in words."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from glid_nb._bounds import rounded_down
from glid_nb.compare import MeshMap, MethodError
from glid_nb.session.edit_state import EditState, Solution
from glid_nb.session.live_solver import Frame
from glid_nb.solvers import Status

Level = Literal["idle", "working", "good", "blocked", "error"]

_REACHED = 0.01  # world units: a handle this near to its target looks as if it were there


@dataclass(frozen=True)
class StatusLine:
    """A line of text and its tone."""

    level: Level
    text: str


def describe(
    state: EditState, solution: Solution | None, busy: bool, paused: bool, frame: Frame | None
) -> StatusLine:
    """The status of an editor in this state, which was solved by ``solution`` if by any."""
    current = state.current
    if paused:
        return StatusLine("idle", "Paused" + _bound(frame))
    if busy:
        if frame is None:
            return StatusLine("working", "Preparing the solver…")
        return StatusLine("working", "Working" + _iterations(frame) + _bound(frame))
    if not len(current.pose):
        return StatusLine("idle", "Click the shape to add a handle, then drag it")
    if solution is None:
        return StatusLine("idle", "Stopped" + _bound(frame) if frame else "Not solved yet")
    if frame is not None and frame.mesh is not None:
        return _describe_comparison(solution, frame)
    status = solution.status
    if status is Status.BLOCKED:
        miss = _miss(state)
        return StatusLine(
            "blocked",
            f"Blocked: the shape follows as far as it is proved not to fold{miss}" + _bound(frame),
        )
    if status in (Status.MAX_ITERATIONS, Status.INDEFINITE):
        return StatusLine("blocked", solution.message + _bound(frame))
    if status is Status.STOPPED:
        return StatusLine("idle", "Stopped" + _bound(frame))
    return StatusLine("good", "Converged" + _miss(state) + _bound(frame))


def _describe_comparison(solution: Solution, frame: Frame) -> StatusLine:
    """The status of a pose whose method on a mesh has ended."""
    title = frame.task.pose.method.method.title
    status = solution.status
    if status is Status.STOPPED:
        return StatusLine("idle", f"{title} stopped" + _bound(frame))
    if status.ok:
        ended = "done" if len(frame.history) == 1 else f"done after {len(frame.history)} iterations"
        return StatusLine("idle", f"{title}: {ended}" + _bound(frame))
    return StatusLine("blocked", f"{title}: {solution.message}" + _bound(frame))


def describe_error(error: Exception) -> StatusLine:
    """The status after the solver's thread met an exception."""
    if isinstance(error, MethodError):
        return StatusLine("blocked", str(error))
    text = str(error) or type(error).__name__
    return StatusLine("error", f"The solver failed: {text} The last certified map is shown.")


def _iterations(frame: Frame) -> str:
    return f", iteration {frame.history[-1].iteration}" if frame.history else ""


def _bound(frame: Frame | None) -> str:
    if frame is None:
        return ""
    if frame.mesh is not None:
        return " · " + uncertified(frame.mesh)
    return f" · certified σ₂ ≥ {rounded_down(frame.bound)}" if math.isfinite(frame.bound) else ""


def uncertified(mesh: MeshMap) -> str:
    """What can be said of a map of a mesh, which nothing is proved of."""
    count = int(mesh.flipped.sum())
    if not count:
        return "no triangle is turned over, but a map of a mesh is not certified"
    return f"not certified: {count} {'triangle is' if count == 1 else 'triangles are'} turned over"


def _miss(state: EditState) -> str:
    """How far the farthest handle is from its target, when that is far enough to see."""
    pose = state.pose
    if not len(pose):
        return ""
    gap = state.map(pose.handles) - pose.targets
    worst = float(max(math.hypot(*row) for row in gap))
    return f", {worst:.2g} units from its target" if worst > _REACHED else ""
