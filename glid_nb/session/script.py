"""A document as the few lines of Python that make the same map."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np

from glid_nb.energies import CustomEnergy, Energy
from glid_nb.geometry import Domain
from glid_nb.imaging import TraceError, TraceOptions, trace
from glid_nb.methods import OURS
from glid_nb.session.document import Document, DocumentError, NamedPose
from glid_nb.solvers import Options


def python_code(document: Document, picture: str = "picture.png", *, exact: bool = False) -> str:
    """Lines that make the map of the document's active pose, as ``result.map`` or ``map``.

    Where the pose's method works on a mesh, the lines make what it comes to, a
    :class:`~glid_nb.MeshMap`, though the document holds a harmonic map.

    The cage is traced from the picture by the document's options if that gives the document's cage;
    a cage that was edited by hand, or that scribbles gave, stands in the text.

    Parameters
    ----------
    document : Document
        It has an active pose.
    picture : str
        Path of the picture's file, as the lines shall name it.
    exact : bool
        Write the coefficients of the document's map, some kilobytes, instead of a solve. A solve
        ends at the same energy to ten digits, unless the pose is a hard one with several minima,
        and the editor came to another of them on its way than a solve from the identity does.

    Raises
    ------
    DocumentError
        When there is no pose, or its energy is a Python function.
    """
    pose = document.active_pose
    if pose is None:
        raise DocumentError("the document has no pose yet, so there is no map to make")
    if isinstance(pose.energy, CustomEnergy):
        raise DocumentError(
            f"the pose {pose.name!r}: its energy is a Python function, which cannot be written down"
        )
    lines = ["import glid_nb as glid", ""]
    lines += _domain_lines(document, picture)
    if exact:
        lines += [
            f"map = glid.HarmonicMap(domain, {pose.map.phi.tolist()}, {pose.map.psi.tolist()})"
        ]
    else:
        lines += _solve_lines(pose)
    return "\n".join(lines) + "\n"


def _solve_lines(pose: NamedPose) -> list[str]:
    handles, targets = pose.pose.handles.tolist(), pose.pose.targets.tolist()
    arguments = ["domain", "pose", _energy(pose.energy)]
    function, options = "solve", _changed(pose.options, Options())
    if pose.method.name != OURS:
        function = "run_method"
        settings = pose.method.arguments(pose.options)
        arguments = [
            repr(pose.method.name),
            *arguments,
            *(f"{name}={_plain(value)!r}" for name, value in settings.items()),
        ]
    elif options:
        arguments.append(f"glid.Options({options})")
    return [
        "pose = glid.Pose(",
        f"    handles={handles},",
        f"    targets={targets},",
        ")",
        f"result = glid.{function}({', '.join(arguments)})",
        "map = result.map",
    ]


def _domain_lines(document: Document, picture: str) -> list[str]:
    lines = []
    if _is_traced(document):
        options = _changed(document.trace_options, TraceOptions())
        arguments = f"image, {options}" if options else "image"
        lines += [
            f"image = glid.read_image({picture!r})",
            f"cage = glid.trace({arguments}).cage",
        ]
    else:
        cage = document.cage
        lines += [
            "cage = glid.Cage(",
            f"    {cage.exterior.tolist()},",
            f"    {[hole.tolist() for hole in cage.holes]},",
            ")",
        ]
    domain = document.domain
    if Domain.from_cage(document.cage).to_dict() == domain.to_dict():
        return [*lines, "domain = glid.Domain.from_cage(cage)"]
    outer = domain.offset_cage
    return [
        *lines,
        "domain = glid.Domain(",
        "    cage,",
        f"    glid.Cage({outer.exterior.tolist()}, {[hole.tolist() for hole in outer.holes]}),",
        f"    {domain.hole_points.tolist()},",
        ")",
    ]


def _is_traced(document: Document) -> bool:
    """Whether tracing the picture anew gives the document's cage, vertex for vertex."""
    if document.trace_options.scribbles is not None:
        return False
    try:
        cage = trace(document.image, document.trace_options).cage
    except TraceError:
        return False  # the cage comes from other options than those that were tried last
    return cage.equals(document.cage)


def _energy(energy: Energy) -> str:
    s = getattr(energy, "s", None)
    return f"glid.{type(energy).__name__}({'' if s is None else f's={float(s)!r}'})"


def _changed(value: Any, default: Any) -> str:
    """The fields of a dataclass that differ from the default, as keyword arguments."""
    parts = []
    for field in dataclasses.fields(value):
        given = getattr(value, field.name)
        if given != getattr(default, field.name):
            written = "float('inf')" if given == math.inf else repr(_plain(given))
            parts.append(f"{field.name}={written}")
    return ", ".join(parts)


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value
