"""The status line of the deformation editor."""

from dataclasses import dataclass
from typing import Literal

from glid_nb._errors import plainly
from glid_nb.certificate import Certificate, certificate_of
from glid_nb.certificate.rounding import rounded_down, rounded_up
from glid_nb.geometry import MeshMap
from glid_nb.harmonic import HarmonicMap
from glid_nb.pose import PINS, Pose
from glid_nb.session.edit_state import Frame, Moment
from glid_nb.solvers import MethodError, Status, misses

Level = Literal["idle", "working", "good", "blocked", "error"]


@dataclass(frozen=True)
class StatusLine:
    """A line of text and its tone."""

    level: Level
    text: str
    proved: str = ""
    """What is proved of the map at rest, in plain words; empty if nothing is said of it."""


def describe(moment: Moment) -> StatusLine:
    """The status of an editor, with the solver's bound on sigma_2 during a solve, and with the
    certificate's bounds at rest."""
    state, frame = moment.state, moment.frame
    if (error := moment.error) is not None:
        if isinstance(error, MethodError):
            return StatusLine("blocked", error.plain)
        text = plainly(error) or type(error).__name__
        return StatusLine("error", f"The solver failed: {text} The last certified map is shown.")
    if moment.busy and moment.paused:
        return StatusLine("idle", f"Paused{_bound(frame)}")
    if moment.busy and (frame is None or moment.prepared < 1):
        done = "" if moment.prepared == 1 else f" {moment.prepared:.0%}"
        return StatusLine("working", f"Preparing the solver…{done}")
    if moment.busy and frame is not None:
        iteration = f", iteration {frame.history[-1].iteration}" if frame.history else ""
        return StatusLine("working", f"Working{iteration}{_bound(frame)}")
    if not moment.paused and not len(state.pose):
        return StatusLine("idle", "No pins yet")
    if not moment.paused and not moment.solved and frame is None:
        return StatusLine("idle", "Not solved yet")
    level, text = ("idle", "Paused") if moment.paused else _ended(moment)
    if (mesh := moment.comparison) is not None:
        return StatusLine(level, f"{text} · {uncertified(mesh)}")
    certificate = certificate_of(moment.map)
    return StatusLine(level, f"{text} · {_proof(certificate)}", in_plain_words(certificate))


def _ended(moment: Moment) -> tuple[Level, str]:
    solution, frame = moment.solution, moment.frame
    if solution is None:
        return "idle", "Stopped"
    status = solution.status
    if frame is not None and frame.mesh is not None:
        title, count = frame.task.pose.method.label, len(frame.history)
        if status is Status.STOPPED:
            return "idle", f"{title} stopped"
        if status.ok:
            done = f"{title}: done" + (f" after {count} iterations" if count != 1 else "")
            return "idle", done + _missed(frame.mesh, moment.state.pose)
        return "blocked", f"{title}: {solution.message}"
    if status is Status.STOPPED:
        return "idle", "Stopped"
    if status is Status.BLOCKED:
        text = "Blocked: the shape follows as far as it is proved not to fold"
        return "blocked", text + _missed(moment.state.map, moment.state.pose)
    if status in (Status.MAX_ITERATIONS, Status.INDEFINITE):
        return "blocked", solution.message
    return "good", "Converged" + _missed(moment.state.map, moment.state.pose)


def _bound(frame: Frame | None) -> str:
    if frame is not None and frame.mesh is not None:
        return f" · {uncertified(frame.mesh)}"
    if frame is None or frame.certificate is None:
        return ""
    return f" · certified σ₂ ≥ {rounded_down(frame.certificate.sigma2_lower)}"


def in_plain_words(certificate: Certificate) -> str:
    """What a certificate proves; empty if it proves nothing."""
    if not certificate.certified:
        return ""
    return f"Proved: never folds, worst squeeze {rounded_down(certificate.sigma2_lower, 2)}"


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


def _missed(map: HarmonicMap | MeshMap, pose: Pose) -> str:
    text = misses.told(pose, misses.misses_of(map, pose), misses.unit_of(map), PINS)
    return f", {text}" if text else ""
