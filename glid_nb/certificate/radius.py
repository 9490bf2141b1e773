"""How far a map may move along a field before a fold is possible."""

import numpy as np

from glid_nb._arguments import check_type
from glid_nb.certificate.certify import CertificateError, certificate_of, certify
from glid_nb.certificate.pieces import certify_step
from glid_nb.harmonic import HarmonicMap

# _MOST: steps that are doubled from the first bound. _BELOW: leaves out the rounding of products.
_MOST, _BELOW = 12, 1 - 1e-9


def safe_radius(map: HarmonicMap, field: HarmonicMap) -> float:
    """A radius r: every map ``map + t field`` with ``-r < t < r`` is locally injective.

    ``field`` is a harmonic field, such as those of :meth:`Result.sensitivity`. Its coefficients are
    added to the map's. ``t`` has the unit of the field's parameter: for a target, world units.

    A first bound is the least quotient over the panels: ``sigma_2`` of the map by ``sigma_1`` of
    the field, both as proved. Within it ``|f_z| > |f_zbar|`` holds on the boundary on the whole
    way, so ``f_z`` keeps its number of zeros (Theorem 4.2). Steps twice as long are tried by
    :func:`glid_nb.certify_step`, while they are proved in both directions. The radius is 0 if the
    map itself is not certified, and infinite if the field is 0. The line is that of exact
    arithmetic.

    Raises a CertificateError if the two live on different domains.
    """
    check_type("map", map, HarmonicMap, "such as that of a result")
    check_type("field", field, HarmonicMap, "such as those of a sensitivity")
    if not map.domain.equals(field.domain):
        raise CertificateError("the map and the field live on different domains")
    certificate = certificate_of(map, alone=True)
    if not certificate.certified:
        return 0.0
    if not (field.phi.any() or field.psi.any()):
        return np.inf
    panels = certificate.panels
    fastest = certify(field, panels=panels, split=False).panels.sigma1_upper
    shares = panels.sigma2_lower / np.where(fastest > 0, fastest, np.inf)
    reached = float(_BELOW * shares.min())
    for _ in range(_MOST):
        wanted = 2 * reached
        until = min(_proved(map, field, wanted), _proved(map, field, -wanted))
        reached = max(reached, _BELOW * until * wanted)
        if until < 1:
            break
    return reached


def _proved(map: HarmonicMap, field: HarmonicMap, t: float) -> float:
    """The share of the way to ``map + t field`` that is proved."""
    end = HarmonicMap(map.domain, map.phi + t * field.phi, map.psi + t * field.psi)
    return certify_step(map, end).until
