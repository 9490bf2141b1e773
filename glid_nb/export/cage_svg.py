"""The deformed cage as a drawing."""

from __future__ import annotations

from collections.abc import Iterable
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from glid_nb.figures.style import BLUE, CYAN, GREY, INK
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import PixelFrame
from glid_nb.imaging.mesh import deformed_loops
from glid_nb.solvers import Pose

_MARGIN = 0.02  # around everything, as a share of the longer side


def cage_svg(
    map: HarmonicMap,
    image_size: tuple[int, int],
    *,
    source: bool = False,
    pose: Pose | None = None,
) -> str:
    """Draw the image of a map's cage: curves, as polylines within 0.002 world units of them.

    Parameters
    ----------
    map : HarmonicMap
        The map.
    image_size : (w, h)
        Pixels of the picture that the cage was traced from: the drawing's unit is its pixel.
    source : bool
        Draw the undeformed cage too, dashed.
    pose : Pose, optional
        Draw its targets as disks and the images of its handles as dots.

    Returns
    -------
    str
        An SVG document with the paths ``cage`` and, if wanted, ``source-cage``, each with one
        closed subpath per loop, the exterior first.
    """
    frame = PixelFrame(*image_size)
    loops = [frame.to_pixel(loop) for loop in deformed_loops(map)]
    cage_loops = [frame.to_pixel(loop) for loop in map.domain.cage.loops]
    targets = [frame.to_pixel(pose.targets)] if pose is not None else []
    shown = np.concatenate([*loops, *(cage_loops if source else []), *targets])
    unit = max(frame.width, frame.height)
    low, high = shown.min(axis=0) - _MARGIN * unit, shown.max(axis=0) + _MARGIN * unit
    (x, y), (w, h) = low, high - low
    line, radius = unit / 500, unit / 130
    parts = [_path("source-cage", cage_loops, GREY, line, dash=4 * line)] if source else []
    parts.append(_path("cage", loops, BLUE, line))
    if pose is not None and len(pose):
        parts.append(_disks("targets", frame.to_pixel(pose.targets), radius, CYAN))
        parts.append(_disks("handles", frame.to_pixel(map(pose.handles)), radius / 2, INK))
    body = "\n  ".join(parts)
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{w:.2f}" height="{h:.2f}" '
        f'viewBox="{x:.2f} {y:.2f} {w:.2f} {h:.2f}">\n'
        f"  <title>Deformed cage</title>\n  {body}\n</svg>\n"
    )


def _path(
    name: str, loops: Iterable[NDArray[np.float64]], color: str, width: float, dash: float = 0.0
) -> str:
    data = " ".join("M" + " ".join(f"{x:.3f},{y:.3f}" for x, y in loop) + "Z" for loop in loops)
    dashes = f' stroke-dasharray="{dash:.3f}"' if dash else ""
    return (
        f'<path id={quoteattr(name)} d="{data}" fill="none" fill-rule="evenodd" '
        f'stroke="{color}" stroke-width="{width:.3f}" stroke-linejoin="round"{dashes}/>'
    )


def _disks(name: str, points: NDArray[np.float64], radius: float, color: str) -> str:
    disks = "".join(f'<circle cx="{x:.3f}" cy="{y:.3f}" r="{radius:.3f}"/>' for x, y in points)
    return f'<g id={quoteattr(name)} fill="{color}" stroke="white">{disks}</g>'
