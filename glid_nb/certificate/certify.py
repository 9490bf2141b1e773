"""Proving any harmonic map locally injective (paper Section 8, Theorem 4.2)."""

from __future__ import annotations

import functools
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np

from glid_nb._arrays import Array
from glid_nb._files import write_text_atomically
from glid_nb._jax import jit, jnp
from glid_nb._runtime import COMPILER_OPTIONS, double_precision
from glid_nb.certificate import rounding
from glid_nb.certificate.bdhm import BDHM
from glid_nb.certificate.hermite import Hermite
from glid_nb.certificate.panels import EndValues, PanelBounds, PanelProof, modulus, split
from glid_nb.certificate.paper import Lipschitz, windings
from glid_nb.certificate.proof import proof_text
from glid_nb.geometry import Panels, graded_panels, place
from glid_nb.harmonic import HarmonicMap, cauchy, run_on

CertificateKind = Literal["hermite", "lipschitz", "bdhm"]

PROOFS: dict[CertificateKind, type[PanelProof]] = {
    "hermite": Hermite,
    "lipschitz": Lipschitz,
    "bdhm": BDHM,
}
"""The kinds of proof by name."""

_CHUNK = 256
_MAX_ROUNDS = 40
_MAX_PANELS = 400_000


@dataclass(frozen=True, eq=False)
class PanelCertificate(Panels):
    """Panels, and the bounds proved on each of them: (p,) arrays."""

    sigma2_lower: Array
    sigma1_upper: Array
    k_upper: Array


@dataclass(frozen=True, eq=False)
class Certificate:
    """The outcome of :func:`certify` for a whole domain (Theorem 4.2).

    The bounds on the singular values and the little dilatation hold on the whole domain when
    ``certified``, otherwise on the boundary only.
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

    @property
    def winding(self) -> int:
        """Number of zeros of ``f_z`` in the domain: the sum of (30) over ``2 pi``."""
        return sum(self.windings)

    @property
    def panels_split(self) -> int:
        """Number of panels that come from splitting."""
        return int((self.panels.depth > 0).sum())

    def save(self, path: str | Path) -> None:
        """Write the proof file that ``glid-check map.json proof.json`` reads, atomically.

        Raises InputError if the map is not certified.
        """
        write_text_atomically(Path(path), proof_text(self))


class _Known(NamedTuple):
    """Bounds on each panel, and the distortion at its start."""

    bounds: PanelBounds
    sigma2_seen: Any
    sigma1_seen: Any
    k_seen: Any
    fz_seen: Any
    slack: Any
    """Bound on the rounding error."""

    @property
    def folded(self) -> Array:
        """(p,) bool: the map is proved to fold at the panel's start."""
        return self.sigma2_seen <= -2 * self.slack

    @property
    def hopeless(self) -> Array:
        """(p,) bool: rounding hides that the map is injective at the panel's start."""
        return ~((self.sigma2_seen > self.slack) & np.isfinite(self.sigma1_seen + self.slack))


@double_precision
def certify(
    map: HarmonicMap,
    kind: CertificateKind = "hermite",
    panels: Panels | None = None,
    *,
    refine: bool = True,
    tightness: float = 0.02,
) -> Certificate:
    """Prove a map locally injective and bound its distortion, or say where that fails.

    Parameters
    ----------
    kind : "hermite", "lipschitz" or "bdhm"
        Cubic interpolants with Bernstein coefficients, the paper's Lipschitz constants (26)-(27),
        or the larger ones of bounded distortion harmonic mappings (Figure 7).
    panels : Panels, optional
        Pieces of the boundary to start from; by default graded ones.
    refine : bool
        Split panels on which the proof fails, as the paper does not, or whose bounds are further
        than the relative ``tightness`` from values that the map attains.
    """
    if kind not in PROOFS:
        raise ValueError(f"unknown kind of certificate {kind!r}; choose one of {', '.join(PROOFS)}")
    if not tightness > 0:
        raise ValueError(f"tightness is {tightness}; it must be positive")
    evaluate = functools.partial(run_on, map, functools.partial(_kernel, kind=kind), _CHUNK)
    panels = graded_panels(map.domain) if panels is None else panels
    known: _Known = evaluate(panels.start, panels.end)
    for _ in range(_MAX_ROUNDS if refine else 0):
        wanted = _to_split(known, tightness) & panels.divisible
        if known.hopeless.any() or not wanted.any() or len(panels) > _MAX_PANELS:
            break
        panels, known = split(panels, known, wanted, evaluate)
    return _conclude(map, panels, known, kind)


def _to_split(known: _Known, tightness: float) -> Array:
    """(p,) bool: the proof fails, or the panel keeps the overall bounds from being tight."""
    bounds, injective = known.bounds, np.asarray(known.bounds.injective)
    worst = known.k_seen.max()
    k_slack = tightness * max(worst, 1e-3)
    # Splitting does not reduce the allowance for rounding, so smaller gains are not worth it.
    least_gain = 4 * known.slack
    failed = ~injective & (known.sigma2_seen > least_gain)
    loose_sigma2 = known.sigma2_seen - bounds.sigma2_lower > least_gain
    loose_sigma1 = bounds.sigma1_upper - known.sigma1_seen > least_gain
    # Where k is unknown the proof failed; elsewhere k is bounded and f_z is not 0.
    k_known = np.isfinite(bounds.k_upper) & (known.fz_seen > 0)
    k_gap = np.where(k_known, bounds.k_upper, 0) - np.where(k_known, known.k_seen, 0)
    loose_k = ~k_known | (k_gap * known.fz_seen > 2 * least_gain)
    return failed | (
        (loose_sigma2 & (bounds.sigma2_lower < known.sigma2_seen.min() * (1 - tightness)))
        | (loose_sigma1 & (bounds.sigma1_upper > known.sigma1_seen.max() * (1 + tightness)))
        | (loose_k & injective & (bounds.k_upper > worst + k_slack))
    )


def _conclude(
    map: HarmonicMap, panels: Panels, known: _Known, kind: CertificateKind
) -> Certificate:
    bounds, unproved = known.bounds, ~np.asarray(known.bounds.injective)
    turns = windings(np.asarray(bounds.turning), panels.loop, 1 + map.domain.n_holes)
    certified = False
    if known.folded.any():
        i = int(np.argmin(known.sigma2_seen))
        reason = (
            f"The map is not locally injective: sigma_2 = {known.sigma2_seen[i]:.3g} "
            f"near {place(panels.start[i])}."
        )
    elif unproved.any():
        i = int(np.argmin(bounds.sigma2_lower))
        reason = (
            f"Undecided: {int(unproved.sum())} of {len(panels)} panels could not be proved "
            f"injective, the worst near {place(panels.middle[i])}."
        )
    elif sum(turns) != 0:
        reason = f"The map is not locally injective: f_z has {sum(turns)} zeros in the domain."
    else:
        certified, reason = True, f"Proved locally injective on {len(panels)} panels."
    sigma2, sigma1, k = (np.asarray(values) for values in bounds[:3])
    along = (panels.start, panels.end, panels.loop, panels.depth, panels.next)
    per_panel = PanelCertificate(*along, sigma2, sigma1, k)
    extremes = (float(sigma2.min()), float(sigma1.max()), float(k.max()))
    return Certificate(certified, *extremes, turns, per_panel, kind, reason, map)


@functools.partial(jit, static_argnames="kind", compiler_options=COMPILER_OPTIONS)
def _kernel(
    start: Any, end: Any, coefficients: Any, singularities: Any, kind: CertificateKind
) -> _Known:
    chord = end - start
    values = [cauchy.first_derivatives(z, singularities) @ coefficients.T for z in (start, end)]
    slopes = [
        chord[:, None] * (cauchy.second_derivatives(z, singularities) @ coefficients.T)
        for z in (start, end)
    ]
    fz, fzb_conj = (EndValues(*(a[:, k] for a in (*values, *slopes))) for k in (0, 1))
    proof = PROOFS[kind].on(start, end, singularities)
    factor = rounding.slack_factor(coefficients.shape[1]) * jnp.abs(coefficients).max()
    slack = factor * rounding.panel_scale(start, end, singularities)
    remainder = proof.remainder(coefficients, singularities) + slack
    bounds = proof.bounds(fz, fzb_conj, remainder)
    f, g = modulus(fz.start), modulus(fzb_conj.start)
    return _Known(bounds, f - g, f + g, g / f, f, slack)
