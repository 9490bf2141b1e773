"""Prove any harmonic map locally injective (Section 8, Theorem 4.2)."""

import functools
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from numbers import Real
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np

from glid_nb._arguments import check_type
from glid_nb._arrays import Array
from glid_nb._errors import InputError
from glid_nb._files import write_atomically
from glid_nb.certificate import rounding
from glid_nb.certificate.hermite import Hermite
from glid_nb.certificate.kept import PanelRows, panel_rows
from glid_nb.certificate.panels import EndValues, PanelBounds, check_tiling, modulus, split
from glid_nb.certificate.paper import BDHMLipschitz, Lipschitz, jumps, turning, windings
from glid_nb.certificate.proof import FORMAT, FORMAT_VERSION, dyadic_panels, exact_text
from glid_nb.geometry import Panels, graded_panels, place
from glid_nb.harmonic import HarmonicMap, Singularities, cauchy, run_on

CertificateKind = Literal["hermite", "lipschitz", "bdhm"]

PROOFS = {"hermite": Hermite, "lipschitz": Lipschitz, "bdhm": BDHMLipschitz}

_MAX_ROUNDS = 40
_MAX_PANELS = 400_000


class CertificateError(InputError):
    """A certificate belongs to another map, or two maps live on different domains."""


@dataclass(frozen=True, eq=False)
class PanelCertificate(Panels):
    """Panels, and the bounds proved on each of them: (p,) arrays."""

    sigma2_lower: Array
    sigma1_upper: Array
    k_upper: Array


@dataclass(frozen=True, eq=False)
class Certificate:
    """The outcome of :func:`certify`, with the bounds (4b), (4c) and (4d) of Theorem 4.2.

    If ``certified``, the bounds hold on the whole domain, otherwise on the boundary only. Only
    :func:`certify` and the solver set ``certified=True``.
    """

    certified: bool
    """Whether the map is proved locally injective on the closed domain."""
    sigma2_lower: float
    sigma1_upper: float
    k_upper: float
    windings: tuple[int, ...]
    """Turns of ``f_z`` along each loop of the cage, exterior first."""
    panels: PanelCertificate
    """The same bounds per panel."""
    kind: CertificateKind
    reason: str
    """One sentence: what is proved, or where and why the proof failed."""
    map: HarmonicMap = field(repr=False)
    """The map that this is the certificate of."""

    def __post_init__(self) -> None:
        if self.certified:  # only `_assembled` may set this, afterwards
            vars(self).update(certified=False, reason="Undecided: this certificate has no proof.")

    def __setstate__(self, state: dict[str, Any]) -> None:
        """From a pickle. There maps come without the proofs that they keep."""
        vars(self).update(state)
        if self.certified:
            proofs = _proofs_of(self.map)
            proofs.solvers = proofs.solvers or self

    def belongs_to(self, map: HarmonicMap) -> bool:
        """Whether it belongs to this map: the same coefficients on the same or an equal domain."""
        check_type("map", map, HarmonicMap, "for example result.map")
        own = self.map
        same = np.array_equal(own.phi, map.phi) and np.array_equal(own.psi, map.psi)
        return own is map or (same and own.domain.equals(map.domain))

    @property
    def winding(self) -> int:
        """Number of zeros of ``f_z`` in the domain (B.2): the sum (30) over ``2 pi``."""
        return sum(self.windings)

    @property
    def panels_split(self) -> int:
        """Number of panels that come from splitting."""
        return int((self.panels.depth > 0).sum())

    def save(self, path: str | Path) -> None:
        """Write the proof file that ``glid-check`` reads; InputError if nothing is certified."""
        write_atomically(path, proof_text(self))


def proof_text(certificate: Certificate) -> str:
    """The proof file of a certificate, as text; InputError for one that proves nothing."""
    if certificate.certified and not np.isfinite(certificate.sigma1_upper):  # a solver's
        certificate = certify(certificate.map, certificate.kind, certificate.panels)
    if not certificate.certified:
        raise InputError(f"there is no proof to write: {certificate.reason}")
    map_, bounds = certificate.map, ("sigma2_lower", "sigma1_upper", "k_upper")
    loops = map_.domain.cage.loops_complex
    pieces = dyadic_panels(certificate.panels, loops)
    if pieces is None:
        # The claims do not depend on the panels, and graded panels are fewer than uniform ones.
        pieces = dyadic_panels(graded_panels(map_.domain), loops)
    values = {key: value for key, value in map_.to_dict().items() if key != "notes"}
    return exact_text(
        {
            **values,
            "format": FORMAT,
            "version": FORMAT_VERSION,
            **{key: getattr(certificate, key) for key in bounds},
            "windings": list(certificate.windings),
            "panels": pieces,
        }
    )


class Known(NamedTuple):
    """Bounds on each panel, and the distortion at its start."""

    bounds: PanelBounds
    sigma2_seen: Any
    sigma1_seen: Any
    k_seen: Any
    fz_seen: Any
    slack: Any  # bounds the error of both derivatives there, and of all that follows from them
    ends: Any = None  # (p, 2) f_z as computed at the start and the end
    own: Any = None  # (p,) bound on the errors of the two values at the start alone

    @property
    def proved(self) -> bool:
        return bool(np.asarray(self.bounds.injective).all())


def certify(
    map: HarmonicMap,
    kind: CertificateKind = "hermite",
    panels: Panels | None = None,
    *,
    split: bool = True,
    tightness: float = 0.02,
) -> Certificate:
    """Prove a map locally injective and bound its distortion (Theorem 4.2), or say what fails.

    The kind is "hermite", cubic interpolants with Bernstein coefficients, "lipschitz", the paper's
    Lipschitz constants (26)-(27), or "bdhm", the larger constants of bounded distortion harmonic
    mappings (Figure 7).

    ``panels`` are the pieces of the boundary to start from, by default graded ones. They must tile
    the boundary of the map's cage, else a GeometryError is raised. With ``split`` a panel is split
    if its proof fails, or if its bounds are further than the relative ``tightness`` from values
    that the map attains. The paper does not split panels.
    """
    check_type("map", map, HarmonicMap, "for example result.map")
    check_type("panels", panels, Panels | None, "for example certificate.panels")
    check_type("tightness", tightness, Real, "a positive number")
    if kind not in PROOFS:
        raise ValueError(f"unknown kind of certificate {kind!r}; choose one of {', '.join(PROOFS)}")
    if not tightness > 0:
        raise ValueError(f"tightness is {tightness}; it must be positive")
    evaluate = functools.partial(run_on, map, functools.partial(known_on, kind=kind))
    if panels is not None:
        check_tiling(panels, map.domain.cage)
    panels = graded_panels(map.domain) if panels is None else panels
    known: Known = evaluate(panels.start, panels.end)
    if split:
        panels, known = split_panels(panels, known, evaluate, tightness)
    return _conclude(map, panels, known, kind)


def split_panels(
    panels: Panels, known: Known, evaluate: Callable[..., Known], tightness: float
) -> tuple[Panels, Known]:
    """Halve panels until the proof succeeds, then until bounds are tight, or while it helps."""
    best = panels, known
    for _ in range(_MAX_ROUNDS):
        wanted = _to_split(known, tightness) & panels.divisible
        # If not, rounding hides whether the map is injective at the panel's start.
        own = known.slack if known.own is None else known.own
        seen = (known.sigma2_seen > own) & np.isfinite(known.sigma1_seen + own)
        if not (seen.all() and wanted.any()) or len(panels) > _MAX_PANELS:
            break
        panels, known = split(panels, known, wanted, evaluate)
        if known.proved or not best[1].proved:  # finer panels may lose what was proved
            best = panels, known
    return best


def _to_split(known: Known, tightness: float) -> Array:
    """(p,) bool: the proof fails; or, if it fails nowhere, the overall bounds are not tight."""
    bounds, injective = known.bounds, np.asarray(known.bounds.injective)
    if not known.proved or not np.isfinite(known.slack).all():
        return ~injective
    worst = known.k_seen.max()
    k_slack = tightness * max(worst, 1e-3)
    # Splitting does not reduce the allowance for rounding, so smaller gains are not worth it.
    least_gain = 4 * known.slack
    loose_sigma2 = known.sigma2_seen - bounds.sigma2_lower > least_gain
    loose_sigma1 = bounds.sigma1_upper - known.sigma1_seen > least_gain
    loose_k = (bounds.k_upper - known.k_seen) * known.fz_seen > 2 * least_gain
    return (
        (loose_sigma2 & (bounds.sigma2_lower < known.sigma2_seen.min() * (1 - tightness)))
        | (loose_sigma1 & (bounds.sigma1_upper > known.sigma1_seen.max() * (1 + tightness)))
        | (loose_k & (bounds.k_upper > worst + k_slack))
    )


@dataclass
class _Proofs:
    """A map's certificates; the map keeps them, so that they live as long as it does."""

    own: Certificate | None = None
    """Computed from its coefficients."""
    solvers: Certificate | None = None
    """What the solver that found it has proved."""


def _proofs_of(map: HarmonicMap) -> _Proofs:
    return map.kept.setdefault("proofs", _Proofs())


def certificate_of(map: HarmonicMap, *, alone: bool = False) -> Certificate:
    """A map's certificate, computed from its coefficients and kept.

    If that fails and ``alone`` is false, a solver's (`proved_by`) is returned if the map has one.
    """
    proofs = _proofs_of(map)
    own = proofs.own = proofs.own or certify(map)
    return own if alone or own.certified else proofs.solvers or own


def proved_by(
    map: HarmonicMap, panels: Panels, sigma2_lower: Array, turning: Array, kind: CertificateKind
) -> Certificate:
    """The certificate of what a solver has proved: no bound on sigma_1, and only ``k < 1``."""
    every = np.ones(len(panels))
    bounds = PanelBounds(sigma2_lower, every * np.inf, every, every > 0, turning)
    turns = windings(turning, panels.loop, 1 + map.domain.n_holes)
    certified = bool((sigma2_lower > 0).all()) and sum(turns) == 0
    how = "Proved locally injective" if certified else "Undecided: not proved"
    reason = f"{how} by the solver on {len(panels)} panels."
    proof = _assembled(panels, bounds, certified, map=map, windings=turns, kind=kind, reason=reason)
    _proofs_of(map).solvers = proof
    return proof


def _conclude(map: HarmonicMap, panels: Panels, known: Known, kind: CertificateKind) -> Certificate:
    """The certificate that the panels' bounds give: (26) on each, (30) by loops (Corollary 8.2)."""
    bounds, unproved = known.bounds, ~np.asarray(known.bounds.injective)
    # Where two panels join, f_z was computed twice: with the turn from one value to the other the
    # loops close, and about the true one where both are less off than they are large.
    with np.errstate(all="ignore"):
        joints = turning(known.ends[:, 1], known.ends[panels.next, 0])
    turns = windings(bounds.turning + joints, panels.loop, 1 + map.domain.n_holes)
    errors, certified = np.stack([known.own, known.own[panels.next]], axis=1), False
    if (np.isfinite(known.slack) & (known.sigma2_seen <= -2 * known.slack)).any():  # it folds there
        i = int(np.argmin(known.sigma2_seen))
        seen = f"sigma_2 = {known.sigma2_seen[i]:.3g} near {place(panels.start[i])}"
        reason = f"The map is not locally injective: {seen}."
    elif unproved.any():
        i = int(np.argmin(bounds.sigma2_lower))
        share = f"{int(unproved.sum())} of {len(panels)} panels could not be proved injective"
        reason = f"Undecided: {share}, the worst near {place(panels.middle[i])}."
    elif not (np.abs(known.ends) > errors).all():
        reason = "Undecided: f_z is as small as rounding errors, so its turns cannot be counted."
    elif sum(turns) != 0:
        zeros = "1 zero" if sum(turns) == 1 else f"{sum(turns)} zeros"
        reason = f"The map is not locally injective: f_z has {zeros} in the domain."
    else:
        certified, reason = True, f"Proved locally injective on {len(panels)} panels."
    return _assembled(panels, bounds, certified, map=map, windings=turns, kind=kind, reason=reason)


def _assembled(panels: Panels, bounds: PanelBounds, certified: bool, **more: Any) -> Certificate:
    sigma2, sigma1, k = (np.asarray(values) for values in bounds[:3])
    along = {field.name: getattr(panels, field.name) for field in fields(Panels)}
    made = Certificate(
        certified=False,
        sigma2_lower=float(sigma2.min()),
        sigma1_upper=float(sigma1.max()),
        k_upper=min(float(k.max()), 1.0) if certified else float(k.max()),
        panels=PanelCertificate(**along, sigma2_lower=sigma2, sigma1_upper=sigma1, k_upper=k),
        **more,
    )
    vars(made)["certified"] = certified
    return made


def known_on(
    start: Any, end: Any, coefficients: Any, singularities: Singularities, kind: CertificateKind
) -> Known:
    """What is known on panels of the map with these coefficients: bounds and values at the ends."""
    rows = panel_rows(start, end, singularities, PROOFS[kind])
    ends, slack, own = end_values(end - start, rows, coefficients, singularities)
    fz, fzb_conj = (EndValues(*(values[k] for values in ends)) for k in (0, 1))
    proof = rows.proof
    remainder = proof.remainder(coefficients, singularities) + proof.slack_share * slack
    bounds = proof.bounds(fz, fzb_conj, remainder)
    f, g = modulus(fz.start), modulus(fzb_conj.start)
    # The start may lie beside the boundary.
    shift = jumps(coefficients, singularities) @ rows.beside.T
    slack, at_ends = np.sum(slack + shift, axis=0), np.stack([fz.start, fz.end], axis=1)
    return Known(bounds, f - g, f + g, g / f, f, slack, at_ends, np.sum(own, axis=0))


def end_values(
    chord: Any, rows: PanelRows, coefficients: Any, singularities: Singularities
) -> tuple[EndValues, Any, Any]:
    """``sum_j D_j coefficients_j`` at the ends of panels, (k, p), and bounds on the errors: of all,
    and of the values at the start alone. ``chord`` is each panel's end minus its start."""
    edges: Any = cauchy.edge_coefficients(coefficients, singularities)
    parts: Any = rounding.derivatives_by(rows.ends, edges, singularities)
    own, probe = np.split(parts[2], 2, axis=1)[0], 1 + modulus(edges).max()
    (values, slopes, slack), (values_end, slopes_end, slack_end) = (
        (first, chord * second, first_off + modulus(chord) * second_off)
        for first, second, first_off, second_off in zip(
            *(np.split(part, 2, axis=1) for part in parts), strict=True
        )
    )
    slack, own = (rounding.allowance(a, probe) for a in (np.maximum(slack, slack_end), own))
    return EndValues(values, values_end, slopes, slopes_end), slack, own
