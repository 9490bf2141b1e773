"""Proving a locally injective map globally injective, or finding where it overlaps itself.

A certified map ``f`` is injective on the closed domain if and only if it is injective on the
boundary, that is, if the images of the loops are simple and do not meet each other. Suppose they
are. Along a loop the image's tangent ``f_z t + f_zbar conj(t)`` turns as ``f_z t`` does, because
``|f_z| > |f_zbar|``, so an image loop's turning number is that of the loop (1 for the exterior,
-1 for each of the ``N`` holes) plus the winding of ``f_z``. The windings add up to 0, so the
turning numbers of the images add up to ``1 - N``. Each is 1 or -1 since the images are simple, so
exactly one image runs counter-clockwise. ``f`` preserves orientation, so by the degree formula the
number of preimages of a point off the images of the loops is the sum of the winding numbers about
it: at most 1. If a point had two preimages, at most one of them on the boundary, points nearby
off the images would have two as well.

So only the boundary is searched. The image of a straight panel of length ``l`` is within
``M l^2 / 8`` of its chord, where ``M`` bounds the second derivative along the panel. Panels are
split until that decides.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import shapely
from numpy.typing import NDArray

from glid_nb._runtime import double_precision
from glid_nb.certificate.arcs import Arcs, JetEvaluator
from glid_nb.certificate.certify import Certificate, certify
from glid_nb.certificate.crossing import proved_crossing
from glid_nb.certificate.panels import after_split
from glid_nb.geometry import Panels, as_points, graded_panels, place
from glid_nb.geometry.panels import segment_distance
from glid_nb.harmonic import HarmonicMap

Array = NDArray[Any]
Verdict = Literal["yes", "no", "undecided"]

_MAX_ROUNDS = 40


@dataclass(frozen=True, eq=False)
class GlobalInjectivity:
    """The outcome of :func:`global_injectivity`.

    Attributes
    ----------
    verdict : "yes", "no" or "undecided"
        Whether the map is injective on the closed domain; "yes" and "no" are proved.
    reason : str
        One sentence: what is proved, or why nothing is.
    n_panels : int
        Number of pieces of the boundary at the end; 0 when the map is not certified.
    crossing : (2,) array or None
        With "no", a point at which the image of the boundary crosses itself.
    parameters : (2, 2) array or None
        With "no", the two boundary points, one per row, that are mapped to ``crossing``. That two
        such points exist is proved; these are their rounded coordinates.
    """

    verdict: Verdict
    reason: str
    n_panels: int
    crossing: Array | None = None
    parameters: Array | None = None


@double_precision
def global_injectivity(
    map: HarmonicMap, certificate: Certificate | None = None, *, max_panels: int = 50_000
) -> GlobalInjectivity:
    """Decide whether a locally injective map is injective on the whole closed domain.

    Parameters
    ----------
    map : HarmonicMap
    certificate : Certificate, optional
        Of ``map``; by default it is computed. For an uncertified map the verdict is "undecided".
    max_panels : int
        Give up beyond this many pieces of the boundary. That happens where images touch without
        crossing, or are closer than rounding.

    Examples
    --------
    >>> from glid_nb import Cage, Domain, HarmonicMap, global_injectivity
    >>> domain = Domain.from_cage(Cage([[0, 0], [2, 0], [2, 1], [0, 1]]))
    >>> global_injectivity(HarmonicMap.identity(domain)).verdict
    'yes'
    """
    if max_panels < 1:
        raise ValueError(f"max_panels is {max_panels}; it must be at least 1")
    certificate = certify(map) if certificate is None else certificate
    if not certificate.certified:
        reason = f"Undecided, because local injectivity is not certified: {certificate.reason}"
        return GlobalInjectivity("undecided", reason, 0)
    evaluate = JetEvaluator(map)
    panels = graded_panels(map.domain)
    jets = evaluate(panels.start, panels.end)
    for _ in range(_MAX_ROUNDS):
        arcs = Arcs.between(panels.start, panels.end, jets, jets.at(panels.next))
        pairs = _pairs_not_apart(arcs, panels)
        corners = ~_corner_simple(arcs, panels.next)
        unresolved = ~_simple(arcs) | corners
        unresolved[panels.next[corners]] = True
        if not unresolved.any() and not pairs.size:
            reason = (
                f"Proved globally injective: the images of the {len(panels)} pieces of the "
                "boundary meet only where neighbours join."
            )
            return GlobalInjectivity("yes", reason, len(panels))
        double_point = proved_crossing(map.domain, panels, arcs, pairs, evaluate)
        if double_point is not None:
            return _overlapping(*double_point, len(panels))
        # Split the larger arc of a pair, or both if they are about equal.
        first, second = pairs
        sagitta = arcs.sagitta
        unresolved[first[2 * sagitta[first] >= sagitta[second]]] = True
        unresolved[second[2 * sagitta[second] >= sagitta[first]]] = True
        # Arcs flatter than their rounding error gain nothing from splitting.
        wanted = unresolved & (sagitta > arcs.error) & panels.divisible
        if not wanted.any() or len(panels) + wanted.sum() > max_panels:
            break
        parent, panels = panels.parents(wanted), panels.split(wanted)
        new = wanted[parent]
        jets = after_split(jets, parent, new, evaluate(panels.start[new], panels.end[new]))
    return _undecided(panels, pairs, unresolved)


def _pairs_not_apart(arcs: Arcs, panels: Panels) -> Array:
    """(2, q) pairs of panels without a common end whose images are not proved disjoint."""
    x = np.real([arcs.start, arcs.end])
    y = np.imag([arcs.start, arcs.end])
    r = arcs.radius
    boxes = shapely.box(x.min(0) - r, y.min(0) - r, x.max(0) + r, y.max(0) + r)
    first, second = shapely.STRtree(boxes).query(boxes)
    wanted = (first < second) & (panels.next[first] != second) & (panels.next[second] != first)
    first, second = first[wanted], second[wanted]
    distance = segment_distance(
        arcs.start[first], arcs.end[first], arcs.start[second], arcs.end[second]
    )
    return np.stack([first, second])[:, ~(distance > r[first] + r[second])]


def _simple(arcs: Arcs) -> Array:
    """Arcs proved not to meet themselves.

    The derivative differs from its mean, the chord over ``l``, by at most ``M l / 2``; where that
    is less than the mean, the arc always advances in the chord's direction.
    """
    return np.abs(arcs.end - arcs.start) - 2 * arcs.error > 4 * arcs.sagitta


def _corner_simple(arcs: Arcs, following: Array) -> Array:
    """Arcs proved to meet the following one only at their common end.

    Let ``p`` and ``q`` be the derivatives at that end, both pointing away from it. With
    ``phi`` the angle between them, ``|s p - t q| >= sin(phi/2) (s |p| + t |q|)`` for all
    ``s, t >= 0``, and the arcs are ``M s^2 / 2`` and ``M t^2 / 2`` off their tangents.
    """
    ahead = arcs.at(following)
    p, q = -arcs.tangent_end, ahead.tangent_start
    sine = np.abs(p / np.abs(p) - q / np.abs(q)) / 2
    back_clear = sine * np.abs(p) - arcs.tangent_error > arcs.bend * arcs.length / 2
    ahead_clear = sine * np.abs(q) - ahead.tangent_error > ahead.bend * ahead.length / 2
    return back_clear & ahead_clear


def _overlapping(image: complex, points: Array, n_panels: int) -> GlobalInjectivity:
    reason = (
        f"The map overlaps itself: the boundary points {place(points[0])} and "
        f"{place(points[1])} are both mapped to {place(image)}."
    )
    return GlobalInjectivity("no", reason, n_panels, as_points(image), as_points(points))


def _undecided(panels: Panels, pairs: Array, unresolved: Array) -> GlobalInjectivity:
    if pairs.size:
        closest = pairs[:, np.argmin(panels.length[pairs].max(axis=0))]
        places = " and ".join(place(z) for z in panels.middle[closest])
        what = f"the images of the boundary near {places} touch or nearly do"
    else:
        what = f"the image of the boundary is too curved near {place(panels.middle[unresolved][0])}"
    reason = f"Undecided: {what}; {len(panels)} pieces of the boundary do not tell."
    return GlobalInjectivity("undecided", reason, len(panels))
