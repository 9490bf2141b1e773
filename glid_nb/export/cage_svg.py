"""The deformed cage as an SVG drawing."""

from collections.abc import Iterable
from xml.sax.saxutils import quoteattr

import numpy as np

from glid_nb._arrays import Array
from glid_nb.figures.style import BLUE, CYAN, GREY, INK
from glid_nb.geometry import as_points
from glid_nb.geometry._loops import subdivided
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import PixelFrame, Sheets, deformed_loops, order_of
from glid_nb.imaging.render import check_fits
from glid_nb.pose import Pose

_MARGIN = 0.02  # around the drawing, as a share of the longer side
_PIECE = 0.0025  # of the cage's size: the resolution at which covered parts are found


def cage_svg(
    map: HarmonicMap, image_size: tuple[int, int], *, source: bool = False, pose: Pose | None = None
) -> str:
    """Draw the image of a map's cage: curves, as polylines within 0.002 world units of them.

    ``image_size`` (w, h) is the size of the picture from which the cage was traced. The drawing's
    unit is a pixel of this picture. ``source`` also draws the undeformed cage, dashed. With a pose,
    its targets are drawn as disks and the images of its handles as dots, and its depths decide
    which part is in front. Where the shape overlaps itself, covered parts are dashed, and a covered
    handle is a ring.

    The SVG document has the path ``cage`` and, with ``source``, the path ``source-cage``. Each has
    one closed subpath per loop, the exterior first. If the shape overlaps itself, the path
    ``in-sight`` lies over ``cage``, with an open subpath for every visible piece.
    """
    frame = PixelFrame(*image_size)
    check_fits(frame, map)
    loops = [frame.to_pixel(loop) for loop in deformed_loops(map)]
    cage_loops = [frame.to_pixel(loop) for loop in map.domain.cage.loops]
    targets = [frame.to_pixel(pose.targets)] if pose is not None else []
    shown = np.concatenate([*loops, *(cage_loops if source else []), *targets])
    unit = max(frame.width, frame.height)
    low, high = shown.min(axis=0) - _MARGIN * unit, shown.max(axis=0) + _MARGIN * unit
    (x, y), (w, h) = low, high - low
    line, radius = unit / 500, unit / 130
    parts = [_path("source-cage", cage_loops, GREY, line, dash=4 * line)] if source else []
    sheets = Sheets(map, order_of(map.domain.cage, pose))
    pieces = _in_sight(map, sheets)
    if pieces is None:
        parts.append(_path("cage", loops, BLUE, line))
    else:
        parts.append(_path("cage", loops, BLUE, line / 2, dash=2 * line))
        seen = (frame.to_pixel(piece) for piece in pieces)
        parts.append(_path("in-sight", seen, BLUE, line, close=""))
    if pose is not None and len(pose):
        hidden = sheets.hidden(pose.handles)
        targets, images = (frame.to_pixel(p) for p in (pose.targets, map(pose.handles)))
        parts.append(_disks("targets", targets[~hidden], radius, CYAN))
        parts.append(_disks("handles", images[~hidden], radius / 2, INK))
        if hidden.any():
            parts.append(_disks("covered", targets[hidden], radius, "none", CYAN))
    body = "\n  ".join(parts)
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{w:.2f}" height="{h:.2f}" '
        f'viewBox="{x:.2f} {y:.2f} {w:.2f} {h:.2f}">\n'
        f"  <title>Deformed cage</title>\n  {body}\n</svg>\n"
    )


def _in_sight(map: HarmonicMap, sheets: Sheets) -> list[Array] | None:
    """The visible pieces of the cage's image; None if nothing is covered."""
    cage, pieces, covered = map.domain.cage, [], False
    for loop in cage.loops_complex:
        parts = np.ceil(np.abs(np.roll(loop, -1) - loop) / (_PIECE * cage.longer_side)).astype(int)
        points = as_points(subdivided(loop, parts))
        hidden, images = sheets.hidden(points), map(points)
        covered |= hidden.any()
        runs = np.split(np.concatenate([images, images[:1]]), np.flatnonzero(hidden))
        # All runs but the first begin with a covered point.
        pieces += [run for run in (runs[0], *(run[1:] for run in runs[1:])) if len(run) > 1]
    return pieces if covered else None


def _path(
    name: str, loops: Iterable[Array], color: str, width: float, dash: float = 0, close: str = "Z"
) -> str:
    data = " ".join("M" + " ".join(f"{x:.3f},{y:.3f}" for x, y in loop) + close for loop in loops)
    dashes = f' stroke-dasharray="{dash:.3f}"' if dash else ""
    return (
        f'<path id={quoteattr(name)} d="{data}" fill="none" fill-rule="evenodd" '
        f'stroke="{color}" stroke-width="{width:.3f}" stroke-linejoin="round"{dashes}/>'
    )


def _disks(name: str, points: Array, radius: float, color: str, line: str = "white") -> str:
    disks = "".join(f'<circle cx="{x:.3f}" cy="{y:.3f}" r="{radius:.3f}"/>' for x, y in points)
    return f'<g id={quoteattr(name)} fill="{color}" stroke="{line}">{disks}</g>'
