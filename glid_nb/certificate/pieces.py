"""Prove steps, and linear pieces of motion, at every instant; `docs/motion.md` has the lemmas.

On a panel and for a unit vector ``u`` the function ``Re(conj(u) f_z) - |f_zbar| <= sigma_2`` is
concave in time. Panels are halved as in the proof of one map. If no ``u`` works for both times at a
panel's end, the time interval is halved.
"""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, Self

import numpy as np

from glid_nb._arguments import check_type
from glid_nb._arrays import Array
from glid_nb._runtime import in_chunks
from glid_nb.certificate import rounding
from glid_nb.certificate.certify import (
    CertificateError,
    Known,
    certificate_of,
    end_values,
    split_panels,
)
from glid_nb.certificate.hermite import Hermite
from glid_nb.certificate.kept import PanelRows, panel_rows
from glid_nb.certificate.panels import EndValues
from glid_nb.certificate.paper import jumps
from glid_nb.geometry import graded_panels
from glid_nb.harmonic import HarmonicMap, Singularities, basis_of, rows_of

_SHORTEST = 2.0**-12  # interval of time, as a share of a piece
_TIGHT = 1 / 8  # the same where only bounds are not tight
_TIGHTNESS = 0.05
_DIRECTIONS = 9
_GROUP = 16  # pieces whose maps are evaluated together


@dataclass(frozen=True)
class PieceCertificate:
    """What is proved of ``(1 - t) f_0 + t f_1`` on the boundary for every ``t`` in [0, 1].

    The bounds are infinite if it is not certified.
    """

    certified: bool
    """Whether ``|f_z| > |f_zbar|`` is proved at every time."""
    sigma2_lower: float
    sigma1_upper: float
    k_upper: float
    until: float
    """It is proved at all times before this one; 1 where certified."""
    place: complex
    """The middle of the panel where sigma_2 is least, or where the proof fails first."""


Proofs = tuple[PieceCertificate, ...]


class _Values(NamedTuple):
    ends: Array  # (p, k, 2, 4): `EndValues` of f_z and conj(f_zbar) of each map
    errors: Array  # (p, k, 2, 2): their remainders, and bounds on the errors at the ends

    def pair(self, first: int) -> Self:
        return self._make(values[:, first : first + 2] for values in self)

    @property
    def seen(self) -> tuple[float, float]:
        """The least sigma_2 and the largest k at the ends of panels."""
        f, g = (np.abs(self.ends[:, :, i, :2]) for i in (0, 1))
        return float((f - g).min()), float((g / f).max())


def certify_step(first: HarmonicMap, last: HarmonicMap) -> PieceCertificate:
    """Prove every map on the straight line between two maps locally injective, or say until when.

    These are the maps ``(1 - t) first + t last`` for ``t`` in [0, 1], the path of a step of the
    solver and of a linear piece of a motion. Proved are the conditions of Theorem 4.2 at each
    ``t``: (5) on the boundary, and (4a), which follows from (4a) for ``first``, as ``f_z`` has no
    zero on the boundary on the way. Rounding errors are counted.

    Both maps must live on the same or equal domains, else a CertificateError is raised. If the
    first is not certified itself, nothing is proved and ``until`` is 0.
    """
    check_type("first", first, HarmonicMap, "for example result.map")
    check_type("last", last, HarmonicMap, "for example result.map")
    if not first.domain.equals(last.domain):
        raise CertificateError("the two maps have different domains; pass two maps of one domain")
    start = certificate_of(first)
    if not start.certified:
        worst = start.panels.middle[int(np.argmin(start.panels.sigma2_lower))]
        return PieceCertificate(False, -np.inf, np.inf, np.inf, 0.0, complex(worst))
    (proof,) = certify_pieces([first, last])
    return proof


@np.errstate(all="ignore")
def certify_pieces(maps: Sequence[HarmonicMap]) -> Proofs:
    """Prove the linear motion from each map of one domain to the next, or say until when it holds.

    Panels and time intervals are halved where the proof fails, or where bounds are further than the
    relative `_TIGHTNESS` from attained values; the latter only down to an eighth of a piece.
    """
    panels = graded_panels(maps[0].domain)
    size = np.abs(rows_of(*maps)).max(axis=0)
    proofs = []
    for first in range(0, len(maps) - 1, _GROUP):
        group = maps[first : first + _GROUP + 1]
        values = _evaluated(group, size)(panels.start, panels.end)
        for i, pair in enumerate(itertools.pairwise(group)):
            proofs.append(_prove(*pair, values.pair(i), size))
    return tuple(proofs)


def _prove(first: HarmonicMap, last: HarmonicMap, values: _Values, size: Array) -> PieceCertificate:
    """Intervals of time one after the other, halved until each is proved."""
    intervals: list[Any] = [(0.0, 1.0, first, last, values)]
    bounds = []
    while intervals:
        begin, end, a, b, values = intervals.pop()
        evaluate, panels = _evaluated([a, b], size), graded_panels(a.domain)
        values = evaluate(panels.start, panels.end) if values is None else values
        along = _bounds(values)
        panels, known = split_panels(
            panels,
            along,
            lambda start, end, evaluate=evaluate: _bounds(evaluate(start, end)),
            _TIGHTNESS,
        )
        own = known.bounds
        unproved = ~np.asarray(own.injective)
        extremes = own.sigma2_lower.min(), own.sigma1_upper.max(), own.k_upper.max()
        sigma2, k = values.seen
        # Whether a common u makes the bounds loose, at the ends of panels.
        loose = along.sigma2_seen.min() < (1 - _TIGHTNESS) * sigma2
        loose |= along.k_seen.max() > (1 + _TIGHTNESS) * k + 1e-3
        if end - begin > (_SHORTEST if unproved.any() else _TIGHT) and (unproved.any() or loose):
            phi, psi = a.phi + (b.phi - a.phi) / 2, a.psi + (b.psi - a.psi) / 2
            middle = HarmonicMap(a.domain, phi, psi)
            half = (begin + end) / 2
            intervals += [(half, end, middle, b, None), (begin, half, a, middle, None)]
            continue
        bounds.append((*extremes, panels.middle[int(np.argmin(known.sigma2_seen))]))
        if unproved.any():
            break
    sigma2, sigma1, k, place = zip(*bounds, strict=True)
    if unproved.any():
        return PieceCertificate(False, -np.inf, np.inf, np.inf, begin, complex(place[-1]))
    worst = complex(place[int(np.argmin(sigma2))])
    return PieceCertificate(True, float(min(sigma2)), float(max(sigma1)), float(max(k)), 1.0, worst)


def _evaluated(maps: Sequence[HarmonicMap], size: Array) -> Any:
    basis, rows = basis_of(maps[0].domain), rows_of(*maps)

    def evaluate(start: Array, end: Array) -> _Values:
        return in_chunks(_values, basis.n_columns, (start, end), rows, size, basis.singularities)

    return evaluate


def _values(start: Any, end: Any, rows: Any, size: Any, singularities: Singularities) -> _Values:
    known = panel_rows(start, end, singularities, Hermite)
    ends, slack, _ = end_values(end - start, known, rows, singularities)
    slack = slack + _coefficient_rounding(end - start, known, size, singularities)
    remainder = known.proof.remainder(rows, singularities)
    shift = jumps(rows, singularities) @ known.beside.T
    by_map = [
        np.stack(values, axis=-1).reshape(len(rows) // 2, 2, len(start), -1)
        for values in (ends, [remainder + slack, slack + shift])
    ]
    return _Values(*(np.moveaxis(values, 2, 0) for values in by_map))


def _coefficient_rounding(
    chord: Any, known: PanelRows, size: Any, singularities: Singularities
) -> Any:
    """(p,) bounds on the effect of rounding the coefficients of maps in between (Lemma 4)."""
    vertices, following, _, _ = singularities
    m = len(vertices)
    edges = (size[:m] + size[following]) / np.abs(vertices[following] - vertices)
    off = 32 * rounding.UPWARD * rounding.UNIT_ROUNDOFF * np.concatenate([edges, size[m:]])
    sizes = known.ends.first_size, known.ends.second_size
    first, second = (np.split(moduli @ off, 2) for moduli in sizes)
    return np.maximum(*first) + np.abs(chord) * np.maximum(*second)


def _bounds(values: _Values) -> Known:
    """What is proved for all times between two maps.

    The values that are seen use each end's own ``u``. So if only the panel's common ``u`` fails,
    the panel is halved, not the time.
    """
    ends: Any = values.ends
    errors: Any = values.errors
    fz, fzb_conj = ([EndValues(*ends[:, i, k].T) for i in (0, 1)] for k in (0, 1))
    f, g = (np.stack([side[:2] for side in each]) for each in (fz, fzb_conj))
    u = _common_direction(f, g)
    proved = [Hermite.bounds(fz[i], fzb_conj[i], errors[:, i, :, 0].T, u) for i in (0, 1)]
    known = proved[0].turning_known & proved[1].turning_known
    sigma2, sigma1, k = (
        least([getattr(each, name) for each in proved], axis=0)
        for least, name in ((np.min, "sigma2_lower"), (np.max, "sigma1_upper"), (np.max, "k_upper"))
    )
    sigma2: Any = np.where(known & (sigma2 > -np.inf), sigma2, -np.inf)
    k: Any = np.where(known, k, np.inf)
    own = _common_direction(*(each.reshape(2, 1, -1) for each in (f, g)))
    along = np.real(own.conj().reshape(2, -1) * f)
    return Known(
        bounds=proved[0]._replace(
            sigma2_lower=sigma2, sigma1_upper=sigma1, k_upper=k, turning_known=known
        ),
        sigma2_seen=(along - np.abs(g)).min(axis=(0, 1)),
        sigma1_seen=(np.abs(f) + np.abs(g)).max(axis=(0, 1)),
        k_seen=(np.abs(g) / along).max(axis=(0, 1)),
        fz_seen=np.abs(f).min(axis=(0, 1)),
        slack=errors[..., 1].sum(axis=2).max(axis=1),
    )


def _common_direction(f: Array, g: Array) -> Any:
    """(p,) ``u`` between those of both times, chosen to maximise the least ``Re(conj(u) f) - |g|``.

    ``f`` and ``g`` are (2, e, p): both times, e points of each panel.
    """
    before, after = (f / np.abs(f)).sum(axis=1)
    before, after = before / np.abs(before), after / np.abs(after)
    u = before + np.linspace(0, 1, _DIRECTIONS)[:, None] * (after - before)
    u /= np.abs(u)
    least = np.min(np.real(u[:, None, None].conj() * f) - np.abs(g), axis=(1, 2))
    return u[np.argmax(least, axis=0), np.arange(f.shape[2])]
