"""Arguments of the wrong type, refused by name before any method sees them."""

from __future__ import annotations

from typing import Any

from glid_nb.geometry import Domain, Triangulation
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods.mesh.map import MeshMap
from glid_nb.methods.method import MethodError, unmet
from glid_nb.solvers import Pose
from glid_nb.solvers.start import check_belongs


def check_arguments(
    domain: Any, pose: Any, align: Any, start: Any, triangulation: Any, callback: Any
) -> None:
    """Check the arguments of :func:`glid_nb.methods.run_method` that every method takes.

    Raises
    ------
    MethodError
        For the first one of the wrong type.
    StartError
        When the harmonic map to start from belongs to another domain.
    """
    if not isinstance(domain, Domain):
        raise _wrong("domain", domain, "a Domain", "make one with Domain.from_cage(cage)")
    if not isinstance(pose, Pose):
        raise _wrong("pose", pose, "a Pose", "make one with Pose(handles, targets)")
    if expected := unmet(bool, align):
        raise MethodError(f"align must be {expected}, got {align!r:.60}")
    if not isinstance(start, HarmonicMap | MeshMap | None):
        remedy = "of an earlier result take result.map"
        raise _wrong("start", start, "a HarmonicMap, a MeshMap or None", remedy)
    if not isinstance(triangulation, Triangulation | None):
        remedy = "make one with triangulate(domain.cage, points=pose.handles)"
        raise _wrong("triangulation", triangulation, "a Triangulation or None", remedy)
    if callback is not None and not callable(callback):
        raise _wrong("callback", callback, "a function or None", "it is given a MethodProgress")
    if isinstance(start, HarmonicMap):
        check_belongs(start, domain)


def _wrong(name: str, value: Any, wanted: str, remedy: str) -> MethodError:
    return MethodError(f"{name} must be {wanted}, not of type {type(value).__name__}; {remedy}")
