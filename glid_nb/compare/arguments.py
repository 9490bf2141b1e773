"""Arguments of the wrong type, refused by name before any method sees them."""

from __future__ import annotations

from typing import Any

import numpy as np

from glid_nb.compare.mesh.map import MeshMap
from glid_nb.compare.method import MethodError
from glid_nb.geometry import Domain, Triangulation
from glid_nb.harmonic import HarmonicMap
from glid_nb.solvers import Pose, StartError


def check_arguments(
    domain: Any, pose: Any, align: Any, start: Any, triangulation: Any, callback: Any
) -> None:
    """Check the arguments of :func:`glid_nb.compare.run_method` that every method takes.

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
    if not isinstance(align, bool | np.bool_):
        raise MethodError(f"align must be True or False, got {align!r:.60}")
    if not isinstance(start, HarmonicMap | MeshMap | None):
        remedy = "of an earlier result take result.map"
        raise _wrong("start", start, "a HarmonicMap, a MeshMap or None", remedy)
    if not isinstance(triangulation, Triangulation | None):
        remedy = "make one with triangulate(domain.cage, points=pose.handles)"
        raise _wrong("triangulation", triangulation, "a Triangulation or None", remedy)
    if callback is not None and not callable(callback):
        raise _wrong("callback", callback, "a function or None", "it is given a MethodProgress")
    if isinstance(start, HarmonicMap) and not _same(start.domain, domain):
        raise StartError(
            "the map to start from belongs to another domain; start from a map of this one"
        )


def _same(one: Domain, other: Domain) -> bool:
    return one is other or one.to_dict() == other.to_dict()


def _wrong(name: str, value: Any, wanted: str, remedy: str) -> MethodError:
    return MethodError(f"{name} must be {wanted}, not of type {type(value).__name__}; {remedy}")
