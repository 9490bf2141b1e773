"""Lines along curves of the undeformed shape as triangles, with a width in pixels."""

import numpy as np
import shapely

from glid_nb._arrays import Array
from glid_nb.geometry import Domain
from glid_nb.geometry.panels import Panels

_PIECES_PER_SIDE = 80
_PANEL_PIECES = 2
PANEL_VERTICES = 4 * _PANEL_PIECES
_INSIDE = 0.15  # of its distance to the cage, by which the offset cage is drawn inside the domain

Ribbon = tuple[Array, Array, Array]
"""Four vertices for each piece of a curve: (v, 2) points, (t, 3) triangles, and (v, 3) the curve's
unit direction and the side, -1 or 1."""


def cage_ribbon(domain: Domain) -> Ribbon:
    """The cage's loops."""
    cage = domain.cage
    return _loops_ribbon(shapely.Polygon(cage.exterior, cage.holes), cage.longer_side)


def offset_ribbon(domain: Domain) -> Ribbon:
    """The offset cage's loops, moved slightly towards the cage."""
    cages = domain.offset_cage, domain.cage
    offset, shape = (shapely.Polygon(cage.exterior, cage.holes) for cage in cages)
    gap = float(shapely.distance(offset.boundary, shape.boundary))
    inner = shapely.buffer(offset, -_INSIDE * gap, join_style="mitre")
    return _loops_ribbon(inner, domain.cage.longer_side)


def panel_ribbon(panels: Panels) -> Ribbon:
    """The boundary's panels, each with `PANEL_VERTICES`."""
    t = np.linspace(0.0, 1.0, _PANEL_PIECES + 1)
    points = panels.start[:, None] + (panels.end - panels.start)[:, None] * t
    return _ribbon(points[:, :-1].ravel(), points[:, 1:].ravel())


def _loops_ribbon(shape: shapely.Geometry, side: float) -> Ribbon:
    fine = shapely.segmentize(shape, side / _PIECES_PER_SIDE)
    loops = [shapely.get_coordinates(ring) @ [1, 1j] for ring in shapely.get_rings(fine)]
    starts, ends = [loop[:-1] for loop in loops], [loop[1:] for loop in loops]
    return _ribbon(np.concatenate(starts), np.concatenate(ends))


def _ribbon(start: Array, end: Array) -> Ribbon:
    """Along straight pieces from ``start`` to ``end``, (s,) complex."""
    count = len(start)
    direction = (end - start) / np.maximum(np.abs(end - start), 1e-300)
    points = np.stack([start, start, end, end], axis=1).ravel()
    along = np.repeat(direction, 4)
    side = np.tile([-1.0, 1.0, -1.0, 1.0], count)
    corner = 4 * np.arange(count)[:, None, None]
    triangles = corner + np.array([[0, 1, 2], [2, 1, 3]])
    return (
        np.stack([np.real(points), np.imag(points)], axis=1),
        triangles.reshape(-1, 3),
        np.stack([along.real, along.imag, side], axis=1).astype(np.float32),
    )
