"""Prove a locally injective map globally injective, or find where it overlaps itself.

A certified map is injective on the closed domain if and only if it is injective on the boundary, so
only the boundary is searched. The image of a straight panel of length ``l`` is within ``M l^2 / 8``
of its chord, where ``M`` bounds the second derivative along the panel. Panels are split until these
enclosures decide. `docs/proof.md` has the lemmas.
"""

import functools
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import shapely

from glid_nb._arguments import check_type
from glid_nb._arrays import Array
from glid_nb._runtime import double_precision
from glid_nb.certificate.arcs import Arcs, jets_of
from glid_nb.certificate.certify import Certificate, CertificateError, certify
from glid_nb.certificate.panels import split
from glid_nb.geometry import Panels, as_points, graded_panels, place, places
from glid_nb.geometry.panels import cross, point_distance, segment_distance, segments_cross
from glid_nb.harmonic import HarmonicMap

_MAX_ROUNDS = 40
_PLACES = 32  # pairs of panels in which a crossing is looked for
_NEWTON_STEPS = 8
# Half-lengths of the windows on which a crossing is proved, relative to the shorter arc.
_WINDOWS = 4.0 ** -np.arange(4)


@dataclass(frozen=True, eq=False)
class GlobalInjectivity:
    """The outcome of :func:`global_injectivity`."""

    verdict: Literal["yes", "no", "undecided"]
    """Whether the map is injective on the closed domain; "yes" and "no" are proved."""
    reason: str
    """One sentence: what is proved, or why nothing is."""
    n_panels: int
    """Number of pieces of the boundary at the end; 0 when the map is not certified."""
    crossing: Array | None = None
    """With "no", a (2,) point at which the image of the boundary crosses itself."""
    parameters: Array | None = None
    """With "no", the two boundary points, one per row, that are mapped to ``crossing``. That two
    such points exist is proved; these are their rounded coordinates."""


@double_precision
def global_injectivity(
    map: HarmonicMap, certificate: Certificate | None = None, *, max_panels: int = 50_000
) -> GlobalInjectivity:
    """Decide whether a locally injective map is injective on the whole closed domain.

    The certificate is computed unless it is given. The verdict is "undecided" for an uncertified
    map, and if more than ``max_panels`` pieces of the boundary would be needed: images that touch
    without crossing, or that are closer than rounding.

    >>> from glid_nb import Cage, Domain, HarmonicMap, global_injectivity
    >>> domain = Domain.from_cage(Cage([[0, 0], [2, 0], [2, 1], [0, 1]]))
    >>> global_injectivity(HarmonicMap.identity(domain)).verdict
    'yes'
    """
    if max_panels < 1:
        raise ValueError(f"max_panels is {max_panels}; it must be at least 1")
    check_type("certificate", certificate, Certificate | None, "pass what glid_nb.certify returns")
    certificate = certify(map) if certificate is None else certificate
    if not certificate.belongs_to(map):
        raise CertificateError(
            "the certificate belongs to another map; leave it out, or pass that of this map"
        )
    if not certificate.certified:
        reason = f"Undecided, because local injectivity is not certified: {certificate.reason}"
        return GlobalInjectivity("undecided", reason, 0)
    evaluate = functools.partial(jets_of, map)
    panels = graded_panels(map.domain)
    jets = evaluate(panels.start, panels.end)
    for _ in range(_MAX_ROUNDS):
        arcs = Arcs.between(panels.start, panels.end, jets, jets.at(panels.next))
        pairs = _pairs_not_apart(arcs, panels)
        corners = ~_corner_simple(arcs, panels.next)
        # Arcs longer than this do not meet themselves (Lemma 18).
        unresolved = ~(np.abs(arcs.end - arcs.start) - 2 * arcs.error > 4 * arcs.sagitta) | corners
        unresolved[panels.next[corners]] = True
        if not unresolved.any() and not pairs.size:
            images = f"the images of the {len(panels)} pieces of the boundary"
            reason = f"Proved globally injective: {images} meet only where neighbours join."
            return GlobalInjectivity("yes", reason, len(panels))
        double_point = _proved_crossing(map, panels, arcs, pairs)
        if double_point is not None:
            image, points = double_point
            both = f"the boundary points {places(points)} are both mapped to {place(image)}"
            reason = f"The map overlaps itself: {both}."
            return GlobalInjectivity("no", reason, len(panels), as_points(image), as_points(points))
        # Split the larger arc of a pair, or both if they are about equal.
        first, second = pairs
        sagitta = arcs.sagitta
        unresolved[first[2 * sagitta[first] >= sagitta[second]]] = True
        unresolved[second[2 * sagitta[second] >= sagitta[first]]] = True
        # Splitting does not help arcs that are flatter than their rounding error.
        wanted = unresolved & (sagitta > arcs.error) & panels.divisible
        if not wanted.any() or len(panels) + wanted.sum() > max_panels:
            break
        panels, jets = split(panels, jets, wanted, evaluate)
    if pairs.size:
        closest = pairs[:, np.argmin(panels.length[pairs].max(axis=0))]
        where = places(panels.middle[closest])
        what = f"the images of the boundary near {where} touch or nearly do"
    else:
        what = f"the image of the boundary is too curved near {place(panels.middle[unresolved][0])}"
    reason = f"Undecided: {what}; {len(panels)} pieces of the boundary are too few to decide."
    return GlobalInjectivity("undecided", reason, len(panels))


def _pairs_not_apart(arcs: Arcs, panels: Panels) -> Array:
    """(2, q) pairs of panels without a common end whose images are not proved disjoint."""
    (x, y), r = (part([arcs.start, arcs.end]) for part in (np.real, np.imag)), arcs.radius
    boxes = shapely.box(x.min(0) - r, y.min(0) - r, x.max(0) + r, y.max(0) + r)
    first, second = shapely.STRtree(boxes).query(boxes)
    wanted = (first < second) & (panels.next[first] != second) & (panels.next[second] != first)
    first, second = first[wanted], second[wanted]
    a, b = arcs.at(first), arcs.at(second)
    distance = segment_distance(a.start, a.end, b.start, b.end)
    return np.stack([first, second])[:, ~(distance > r[first] + r[second])]


def _corner_simple(arcs: Arcs, following: Array) -> Array:
    """Arcs proved to meet the following one only at their common end (Lemma 19)."""
    ahead = arcs.at(following)
    p, q = -arcs.tangent_end, ahead.tangent_start
    sine = np.abs(p / np.abs(p) - q / np.abs(q)) / 2
    back_clear = sine * np.abs(p) - arcs.tangent_error > arcs.bend * arcs.length / 2
    ahead_clear = sine * np.abs(q) - ahead.tangent_error > ahead.bend * ahead.length / 2
    return back_clear & ahead_clear


def _proved_crossing(map: HarmonicMap, panels: Panels, arcs: Arcs, pairs: Array) -> Any:
    """A double point of the boundary's image and the two points mapped to it, or None.

    Newton's method finds candidates from pairs of panels whose chords cross. Each is proved on
    windows around it on the two edges, which may extend over several panels.
    """
    a, b = (arcs.at(index) for index in pairs)
    pairs = pairs[:, segments_cross(a.start, a.end, b.start, b.end)]
    if not pairs.size:
        return None
    # The flatter the arcs, the more likely they cross where their chords do.
    bulge = arcs.sagitta / np.abs(arcs.end - arcs.start)
    pairs = pairs[:, np.argsort(bulge[pairs].max(axis=0))[:_PLACES]]

    edges = Panels.along(map.domain.cage.loops_complex)
    edge = np.cumsum(np.isin(panels.start, edges.start))[pairs] - 1
    origin, length = edges.start[edge], edges.length[edge]
    direction = (edges.end[edge] - origin) / length
    position = np.abs(panels.middle[pairs] - origin)

    def along(position: Array) -> tuple[Array, Array]:
        z = origin + position * direction
        jets = jets_of(map, z, z)
        return jets.f, jets.first(direction)

    for _ in range(_NEWTON_STEPS):
        image, tangent = along(position)
        determinant = cross(tangent[0], tangent[1])
        determinant = np.where(determinant == 0, np.inf, determinant)
        step = cross(tangent[::-1], image[0] - image[1]) / determinant
        position = np.clip(position + step, 0, length)
    image, tangent = along(position)

    size = (np.abs(tangent) * panels.length[pairs]).min(axis=0)
    half = (size / np.abs(tangent))[..., None] * _WINDOWS
    low = np.maximum(position[..., None] - half, 0)
    high = np.minimum(position[..., None] + half, length[..., None])
    apart = (edge[0] != edge[1])[:, None] | (high[0] < low[1]) | (high[1] < low[0])
    start, end = (origin[..., None] + p * direction[..., None] for p in (low, high))
    windows = Arcs.between(start, end, jets_of(map, start, end), jets_of(map, end, end))
    proved = (apart & _certainly_cross(windows)).any(axis=1)
    # The proof may succeed on a wide window before Newton's method has settled.
    proved &= np.abs(image[0] - image[1]) <= 1e-9 * size + windows.error.max(axis=(0, 2))
    if not proved.any():
        return None
    best = int(np.argmax(proved))
    anchor = map.phi[0] + np.conj(map.psi[0])
    return complex(image[:, best].mean() + anchor), (origin + position * direction)[:, best]


def _certainly_cross(pair: Arcs) -> Array:
    """Whether the two arcs of each pair are proved to meet in the interior of both (Lemma 20)."""
    a, b = pair.at(0), pair.at(1)
    clear = segments_cross(a.start, a.end, b.start, b.end)
    for arc, other in ((a, b), (b, a)):
        for end in (arc.start, arc.end):
            clear = clear & (point_distance(end, other.start, other.end) > arc.error + other.radius)
    return clear
