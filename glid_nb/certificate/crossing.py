"""Finding and proving a point where the image of the boundary crosses itself."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb.certificate.arcs import Arcs, JetEvaluator
from glid_nb.geometry import Domain, Panels, edge_panels
from glid_nb.geometry.panels import cross, point_distance, segments_cross

Array = NDArray[Any]

# Most pairs of panels that are tried.
_PLACES = 32
_NEWTON_STEPS = 8
# Half-lengths of the windows, relative to the shorter arc.
_WINDOWS = 4.0 ** -np.arange(4)


def proved_crossing(
    domain: Domain, panels: Panels, arcs: Arcs, pairs: Array, evaluate: JetEvaluator
) -> tuple[complex, Array] | None:
    """A double point of the image of the boundary, and the two boundary points mapped to it.

    Newton's method finds candidates, starting from pairs of panels whose chords cross. A candidate
    is proved on windows around it on the two edges, which may extend over several panels.

    Parameters
    ----------
    domain : Domain
    panels, arcs : Panels, Arcs
        The whole boundary and its image.
    pairs : (2, q) int array
        Pairs of panels whose images may meet.
    evaluate : JetEvaluator
        Of the map.
    """
    first, second = pairs
    crossing = segments_cross(
        arcs.start[first], arcs.end[first], arcs.start[second], arcs.end[second]
    )
    pairs = pairs[:, crossing]
    if not pairs.size:
        return None
    # The flatter the arcs, the more likely they cross where their chords do.
    bulge = arcs.sagitta / np.abs(arcs.end - arcs.start)
    pairs = pairs[:, np.argsort(bulge[pairs].max(axis=0))[:_PLACES]]

    edges = edge_panels(domain)
    edge = np.cumsum(np.isin(panels.start, edges.start))[pairs] - 1
    origin, length = edges.start[edge], edges.length[edge]
    direction = (edges.end[edge] - origin) / length
    position = np.abs(panels.middle[pairs] - origin)
    for _ in range(_NEWTON_STEPS):
        image, tangent = _image(origin + position * direction, direction, evaluate)
        determinant = cross(tangent[0], tangent[1])
        determinant = np.where(determinant == 0, np.inf, determinant)
        step = cross(tangent[::-1], image[0] - image[1]) / determinant
        position = np.clip(position + step, 0, length)
    image, tangent = _image(origin + position * direction, direction, evaluate)

    size = (np.abs(tangent) * panels.length[pairs]).min(axis=0)
    half = (size / np.abs(tangent))[..., None] * _WINDOWS
    low = np.maximum(position[..., None] - half, 0)
    high = np.minimum(position[..., None] + half, length[..., None])
    apart = (edge[0] != edge[1])[:, None] | (high[0] < low[1]) | (high[1] < low[0])
    windows = _arcs(low, high, origin[..., None], direction[..., None], evaluate)
    proved = (apart & _certainly_cross(windows)).any(axis=1)
    # The proof may succeed on a wide window before Newton's method has settled.
    proved &= np.abs(image[0] - image[1]) <= 1e-9 * size + windows.error.max(axis=(0, 2))
    if not proved.any():
        return None
    best = int(np.argmax(proved))
    return complex(image[:, best].mean()), (origin + position * direction)[:, best]


def _image(z: Array, direction: Array, evaluate: JetEvaluator) -> tuple[Array, Array]:
    jets = evaluate(z.ravel(), z.ravel())
    return jets.f.reshape(z.shape), jets.first(direction.ravel()).reshape(z.shape)


def _arcs(low: Array, high: Array, origin: Array, direction: Array, evaluate: JetEvaluator) -> Arcs:
    """Images of the pieces of edges from ``low`` to ``high``, in the shape of ``low``."""
    start, end = (origin + position * direction for position in (low, high))
    count = start.size
    jets = evaluate(np.append(start, end), np.append(end, end))
    arcs = Arcs.between(
        start.ravel(), end.ravel(), jets.at(slice(count)), jets.at(slice(count, None))
    )
    return Arcs(*(values.reshape(low.shape) for values in arcs))


def _certainly_cross(pair: Arcs) -> Array:
    """Whether the two arcs of each pair are proved to meet in the interior of both.

    On the unit square let ``F(s, t)`` be the difference of the points of the arcs at relative
    parameters ``s`` and ``t``, and ``L(s, t)`` the same for the chords. ``L`` is affine and has
    one simple zero if the chords cross. If ``|F - L| < |L|`` on the square's boundary, ``F`` has
    the same degree there, 1 or -1, and so a zero. On an edge of the square one of the points is an
    end of an arc, where arc and chord agree, so ``|F - L|`` is at most the sagitta of the other.
    """
    a, b = pair.at(0), pair.at(1)
    clear = segments_cross(a.start, a.end, b.start, b.end)
    for arc, other in ((a, b), (b, a)):
        for end in (arc.start, arc.end):
            clear = clear & (point_distance(end, other.start, other.end) > arc.error + other.radius)
    return clear
