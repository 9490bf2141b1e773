"""The status line of the deformation editor."""

import math
from dataclasses import dataclass
from typing import Literal

from glid_nb.certificate import Certificate, certificate_of
from glid_nb.certificate.rounding import rounded_down, rounded_up
from glid_nb.geometry import MeshMap
from glid_nb.session.document import Solution
from glid_nb.session.edit_state import EditState, Frame, Moment
from glid_nb.solvers import MethodError, Status

Level = Literal["idle", "working", "good", "blocked", "error"]

_REACHED = 0.01  # world units; a smaller distance from the target is not visible


@dataclass(frozen=True)
class StatusLine:
    """A line of text and its tone."""

    level: Level
    text: str


def describe(moment: Moment) -> StatusLine:
    """The status of an editor.

    While the solver works it shows the solver's bound on sigma_2; at rest the bounds of the
    certificate, which is only then computed.
    """
    if (error := moment.error) is not None:
        if isinstance(error, MethodError):
            return StatusLine("blocked", str(error))
        text = str(error) or type(error).__name__
        return StatusLine("error", f"The solver failed: {text} The last certified map is shown.")
    state, frame, solution = moment.state, moment.frame, moment.solution
    if moment.busy and not moment.paused:
        if frame is None:
            done = "" if moment.prepared == 1 else f" {moment.prepared:.0%}"
            return StatusLine("working", f"Preparing the solver…{done}")
        iteration = f", iteration {frame.history[-1].iteration}" if frame.history else ""
        return StatusLine("working", f"Working{iteration}{_bound(frame)}")

    def proof() -> str:
        if moment.comparison is not None:
            return f" · {uncertified(moment.comparison)}"
        return f" · {_proof(certificate_of(moment.map))}"

    if moment.paused:
        return StatusLine("idle", "Paused" + (_bound(frame) if moment.busy else proof()))
    if not len(state.pose):
        return StatusLine("idle", "Click the shape to add a handle, then drag it")
    if solution is None:
        return StatusLine("idle", "Stopped" + proof() if frame else "Not solved yet")
    if frame is not None and frame.mesh is not None:
        return _describe_comparison(solution, frame, proof())
    status = solution.status
    if status is Status.BLOCKED:
        text = "Blocked: the shape follows as far as it is proved not to fold"
        return StatusLine("blocked", text + _miss(state) + proof())
    if status in (Status.MAX_ITERATIONS, Status.INDEFINITE):
        return StatusLine("blocked", solution.message + proof())
    if status is Status.STOPPED:
        return StatusLine("idle", "Stopped" + proof())
    return StatusLine("good", "Converged" + _miss(state) + proof())


def _describe_comparison(solution: Solution, frame: Frame, proof: str) -> StatusLine:
    title = frame.task.pose.method.label
    status = solution.status
    if status is Status.STOPPED:
        return StatusLine("idle", f"{title} stopped" + proof)
    if status.ok:
        ended = "done" if len(frame.history) == 1 else f"done after {len(frame.history)} iterations"
        return StatusLine("idle", f"{title}: {ended}" + proof)
    return StatusLine("blocked", f"{title}: {solution.message}" + proof)


def _bound(frame: Frame | None) -> str:
    if frame is None:
        return ""
    if frame.mesh is not None:
        return f" · {uncertified(frame.mesh)}"
    return f" · certified σ₂ ≥ {rounded_down(frame.bound)}" if math.isfinite(frame.bound) else ""


def _proof(certificate: Certificate) -> str:
    if not certificate.certified:
        return "not certified"
    return (
        f"certified σ₂ ≥ {rounded_down(certificate.sigma2_lower)}, "
        f"σ₁ ≤ {rounded_up(certificate.sigma1_upper)}, k ≤ {rounded_up(certificate.k_upper)}"
    )


def uncertified(mesh: MeshMap) -> str:
    """The number of flipped triangles of a mesh's map, which is not certified."""
    count = int(mesh.flipped.sum())
    if not count:
        return "no triangle is turned over, but a map of a mesh is not certified"
    return f"not certified: {count} {'triangle is' if count == 1 else 'triangles are'} turned over"


def _miss(state: EditState) -> str:
    """The largest distance of a handle from its target, if that is visible."""
    pose = state.pose
    if not len(pose):
        return ""
    gap = state.map(pose.handles) - pose.targets
    worst = float(max(math.hypot(*row) for row in gap))
    return f", {worst:.2g} units from its target" if worst > _REACHED else ""
