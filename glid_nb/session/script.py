"""Write Python code that makes the same map as a document."""

import dataclasses
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from glid_nb._arguments import check_type
from glid_nb.certificate import certificate_of
from glid_nb.energies import CustomEnergy
from glid_nb.geometry import Cage, Domain
from glid_nb.imaging import TraceError, trace
from glid_nb.motion import unlike_turns
from glid_nb.session.document import Document, DocumentError, NamedPose
from glid_nb.solvers import Newton


def python_code(document: Document, picture: str = "picture.png", *, exact: bool = False) -> str:
    """Python code that makes the map of the document's active pose, as ``map``.

    For several poses it makes all maps, as the list ``maps``, and the ``motion`` of the document's
    timeline through them. If a pose's method works on a mesh, its map is a
    :class:`~glid_nb.MeshMap`, although the document holds a harmonic map. The code traces the cage
    from ``picture``, a file's path, if the document's options reproduce the cage. A cage that was
    edited by hand or came from scribbles is written out.

    For solved poses, ``exact`` writes the coefficients of the document's map, some kilobytes,
    instead of a solve. A solve ends at the same energy to ten digits, unless a hard pose has
    several minima and the editor reached another one than a solve from the identity. Raises a
    DocumentError if there is no pose, or if the energy of a pose is a Python function.
    """
    check_type("document", document, Document, "for example editor.document")
    if not document.poses:
        raise DocumentError("the document has no pose yet, so there is no map to make")
    lines = ["import glid_nb as glid", "", *_domain_lines(document, picture)]
    if len(document.poses) == 1:
        lines += _map_lines(document.poses[0], exact)
    else:
        lines.append("maps = []")
        for pose in document.poses:
            lines += ["", f"# {pose.name!r}", *_map_lines(pose, exact), "maps.append(map)"]
        shown = document.poses[document.active]
        lines += ["", f"map = maps[{document.active}]"]
        lines += _pose_lines(shown) if shown.pose.depths.any() else []
        lines += _motion_lines(document)
    return "\n".join(lines) + "\n"


def _map_lines(pose: NamedPose, exact: bool) -> list[str]:
    if isinstance(pose.energy, CustomEnergy):
        why = "its energy is a Python function, which cannot be written as code"
        raise DocumentError(f"the pose {pose.name!r}: {why}")
    exact = exact and not pose.unsolved
    posed = _pose_lines(pose) if not exact or pose.pose.depths.any() else []
    if exact:
        phi, psi = pose.map.phi.tolist(), pose.map.psi.tolist()
        return [*posed, f"map = glid.HarmonicMap(domain, {phi}, {psi})"]
    arguments = ["domain", "pose", _made(pose.energy, "glid.energies")]
    if options := _changed(pose.options, pose.method.options):
        arguments.append(f"glid.Options({options})")
    if not isinstance(pose.method, Newton):
        arguments.append(f"method={_made(pose.method, 'glid.methods')}")
    return [*posed, f"result = glid.solve({', '.join(arguments)})", "map = result.map"]


def _motion_lines(document: Document) -> list[str]:
    timeline, poses = document.timeline, document.poses
    if timeline is None or not all(pose.method.certified for pose in poses):
        return []
    first, *others = (certificate_of(pose.map) for pose in poses)
    if any(unlike_turns(first, other) for other in others):
        return []
    times = list(timeline.closed_times)
    easing = list(timeline.easing[: len(times) - 1])
    return [f"motion = glid.Motion(maps, {times}, easing={easing}, repeat={timeline.repeat!r})"]


def _pose_lines(pose: NamedPose) -> list[str]:
    given = pose.pose.to_dict().items()
    return ["pose = glid.Pose(", *(f"    {key}={values}," for key, values in given), ")"]


def _domain_lines(document: Document, picture: str) -> list[str]:
    domain, points = document.domain, document.domain.hole_points.tolist()
    lines = [f"cage = {_cage(document.cage)}"]
    if _is_traced(document):
        arguments = ", ".join(filter(None, ["image", _changed(document.trace_options)]))
        lines = [f"image = glid.read_image({picture!r})", f"cage = glid.trace({arguments}).cage"]
    if Domain.from_cage(document.cage).equals(domain):
        return [*lines, "domain = glid.Domain.from_cage(cage)"]
    return [*lines, f"domain = glid.Domain(cage, {_cage(domain.offset_cage)}, {points})"]


def _cage(cage: Cage) -> str:
    return f"glid.Cage({cage.exterior.tolist()}, {[hole.tolist() for hole in cage.holes]})"


def _is_traced(document: Document) -> bool:
    if document.trace_options.scribbles is not None:
        return False
    try:
        cage = trace(document.image, document.trace_options).cage
    except TraceError:
        return False  # the last options give no cage
    return cage.equals(document.cage)


def _made(value: Any, module: str) -> str:
    return f"{module}.{type(value).__name__}({_changed(value)})"


def _changed(value: Any, names: Sequence[str] | None = None) -> str:
    parts, default = [], type(value)()
    for name in [field.name for field in dataclasses.fields(value)] if names is None else names:
        given = getattr(value, name)
        if given != getattr(default, name):
            given = given.item() if isinstance(given, np.generic) else given
            written = "float('inf')" if given == math.inf else repr(given)
            parts.append(f"{name}={written}")
    return ", ".join(parts)
