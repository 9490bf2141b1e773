"""Proving a map locally injective, whatever made it (paper Section 8, Theorem 4.2)."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from glid_nb._jax import jit, jnp
from glid_nb._runtime import COMPILER_OPTIONS, double_precision
from glid_nb.certificate import bdhm, hermite, lipschitz, rounding
from glid_nb.certificate.bounds import EndValues, derivative_bound_weights, modulus
from glid_nb.geometry import Panels, graded_panels
from glid_nb.harmonic import HarmonicMap, basis_of, cauchy
from glid_nb.harmonic.basis import Basis

Array = NDArray[Any]
Method = Literal["hermite", "lipschitz", "bdhm"]

METHODS = {"hermite": hermite, "lipschitz": lipschitz, "bdhm": bdhm}
_CHUNK = 256
_MAX_ROUNDS = 40
_MAX_PANELS = 400_000


@dataclass(frozen=True, eq=False)
class PanelCertificate:
    """What is proved on each panel of the boundary.

    Attributes
    ----------
    start, end : (p, 2) arrays
        End points, world coordinates, in order along each loop.
    loop, depth : (p,) int arrays
        Loop of the cage (0 exterior, then holes), and how often the panel was split.
    sigma2_lower, sigma1_upper, k_upper : (p,) arrays
        Certified bounds on the whole panel.
    """

    start: Array
    end: Array
    loop: Array
    depth: Array
    sigma2_lower: Array
    sigma1_upper: Array
    k_upper: Array

    def __len__(self) -> int:
        return len(self.start)

    @property
    def length(self) -> Array:
        """(p,) lengths of the panels, world units."""
        return np.linalg.norm(self.end - self.start, axis=1)


@dataclass(frozen=True, eq=False)
class Certificate:
    """The outcome of :func:`certify` for a whole domain (Theorem 4.2).

    Attributes
    ----------
    certified : bool
        Whether the map is proved locally injective on the closed domain.
    sigma2_lower, sigma1_upper, k_upper : float
        Bounds on the singular values and the little dilatation. When ``certified`` they hold at
        every point of the domain; when not, they are what is known on the boundary.
    windings : tuple of int
        Turns of ``f_z`` along each loop of the cage, exterior first.
    panels : PanelCertificate
        The same per panel.
    reason : str
        One sentence: what is proved, or where and why the proof failed.
    """

    certified: bool
    sigma2_lower: float
    sigma1_upper: float
    k_upper: float
    windings: tuple[int, ...]
    panels: PanelCertificate
    method: Method
    reason: str

    @property
    def winding(self) -> int:
        """Number of zeros of ``f_z`` in the domain: the sum of (30) over ``2 pi``."""
        return sum(self.windings)

    @property
    def panels_split(self) -> int:
        """How many panels stem from splitting."""
        return int((self.panels.depth > 0).sum())


@double_precision
def certify(
    map: HarmonicMap,
    method: Method = "hermite",
    panels: Panels | None = None,
    *,
    refine: bool = True,
    tightness: float = 0.02,
) -> Certificate:
    """Prove a map locally injective and bound its distortion, or say where that fails.

    Parameters
    ----------
    map : HarmonicMap
    method : "hermite", "lipschitz" or "bdhm"
        Cubic interpolants with Bernstein coefficients, the paper's Lipschitz constants (26)-(27),
        or the larger ones of bounded distortion harmonic mappings (Figure 7).
    panels : Panels, optional
        Pieces of the boundary to start from; by default graded ones.
    refine : bool
        Split panels on which the proof fails or whose bounds are loose. With ``False`` the given
        panels are all there is, as in the paper.
    tightness : float
        With ``refine``, panels are split until the bounds are within this relative distance of
        values that the map attains.
    """
    if method not in METHODS:
        raise ValueError(f"unknown method {method!r}; choose one of {', '.join(METHODS)}")
    if not tightness > 0:
        raise ValueError(f"tightness is {tightness}; it must be positive")
    basis = basis_of(map.domain)
    coefficients = np.stack([basis.pad(map.phi), basis.pad(map.psi)])
    panels = graded_panels(map.domain) if panels is None else panels
    known = _evaluate(panels, coefficients, basis, method)
    for _ in range(_MAX_ROUNDS if refine else 0):
        wanted = _to_split(known, tightness) & panels.divisible
        if (
            (known["sigma2_seen"] <= -2 * known["slack"]).any()
            or not wanted.any()
            or len(panels) > _MAX_PANELS
        ):
            break
        finer = panels.split(wanted)
        parent = np.repeat(np.arange(len(panels)), np.where(wanted, 2, 1))
        new = wanted[parent]
        known = {name: values[parent] for name, values in known.items()}
        fresh = _evaluate(finer.chosen(new), coefficients, basis, method)
        for name, values in fresh.items():
            known[name][new] = values
        panels = finer
    return _conclude(map, panels, known, method)


def _to_split(known: dict[str, Array], tightness: float) -> Array:
    """Panels whose proof fails, or that keep the overall bounds from being tight."""
    least, most, worst = (
        known["sigma2_seen"].min(),
        known["sigma1_seen"].max(),
        known["k_seen"].max(),
    )
    k_slack = tightness * max(worst, 1e-3)
    # Splitting shortens panels; it does not lessen what rounding takes from the bounds.
    slack = known["slack"]
    least_gain = 4 * slack
    failed = ~known["injective"] & (known["sigma2_seen"] > least_gain)
    loose_sigma2 = known["sigma2_seen"] - known["sigma2_lower"] > least_gain
    loose_sigma1 = known["sigma1_upper"] - known["sigma1_seen"] > least_gain
    # An unknown k belongs to a failed panel; elsewhere k is bounded and f_z is not 0.
    k_known = np.isfinite(known["k_upper"]) & (known["fz_seen"] > 0)
    k_gap = np.where(k_known, known["k_upper"], 0) - np.where(k_known, known["k_seen"], 0)
    loose_k = ~k_known | (k_gap * known["fz_seen"] > 2 * least_gain)
    return failed | (
        (loose_sigma2 & (known["sigma2_lower"] < least * (1 - tightness)))
        | (loose_sigma1 & (known["sigma1_upper"] > most * (1 + tightness)))
        | (loose_k & known["injective"] & (known["k_upper"] > worst + k_slack))
    )


def _conclude(
    map: HarmonicMap, panels: Panels, known: dict[str, Array], method: Method
) -> Certificate:
    n_loops = 1 + map.domain.n_holes
    turns = np.bincount(panels.loop, weights=known["turning"], minlength=n_loops) / (2 * np.pi)
    windings = tuple(int(w) for w in np.round(np.nan_to_num(turns)))
    folded = known["sigma2_seen"] <= -2 * known["slack"]
    open_ = ~known["injective"]
    if folded.any():
        i = int(np.argmin(known["sigma2_seen"]))
        certified = False
        reason = (
            f"The map is not locally injective: sigma_2 = {known['sigma2_seen'][i]:.3g} "
            f"near {_place(panels.start[i])}."
        )
    elif open_.any():
        i = int(np.argmin(known["sigma2_lower"]))
        certified = False
        reason = (
            f"Undecided: {int(open_.sum())} of {len(panels)} panels could not be proved "
            f"injective, the worst near {_place(panels.middle[i])}."
        )
    elif sum(windings) != 0:
        certified = False
        reason = f"The map is not locally injective: f_z has {sum(windings)} zeros in the domain."
    else:
        certified = True
        reason = f"Proved locally injective on {len(panels)} panels."
    return Certificate(
        certified,
        float(known["sigma2_lower"].min()),
        float(known["sigma1_upper"].max()),
        float(known["k_upper"].max()),
        windings,
        PanelCertificate(
            _frozen(_real(panels.start)),
            _frozen(_real(panels.end)),
            panels.loop,
            panels.depth,
            *(_frozen(known[name]) for name in ("sigma2_lower", "sigma1_upper", "k_upper")),
        ),
        method,
        reason,
    )


def _evaluate(
    panels: Panels, coefficients: Array, basis: Basis, method: Method
) -> dict[str, Array]:
    """Bounds on each panel, and the distortion seen at its start, by name."""
    count = len(panels)
    parts = []
    for first in range(0, count, _CHUNK):
        ends = [panels.start[first : first + _CHUNK], panels.end[first : first + _CHUNK]]
        size = len(ends[0])
        filled = [np.append(e, np.full(_CHUNK - size, e[0])) for e in ends]
        outputs = _kernel(*filled, coefficients, basis.singularities, method=method)
        parts.append({name: np.asarray(values)[:size] for name, values in outputs.items()})
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


@functools.partial(jit, static_argnames="method", compiler_options=COMPILER_OPTIONS)
def _kernel(start: Any, end: Any, coefficients: Any, singularities: Any, method: Method) -> Any:
    chord = end - start
    values = [cauchy.first_derivatives(z, singularities) @ coefficients.T for z in (start, end)]
    slopes = [
        chord[:, None] * (cauchy.second_derivatives(z, singularities) @ coefficients.T)
        for z in (start, end)
    ]
    ends = EndValues(
        *(v[:, k] for k in (0, 1) for v in values), *(s[:, k] for k in (0, 1) for s in slopes)
    )
    length = jnp.abs(chord)
    if method == "bdhm":
        segments = bdhm.segment_weights(start, end, singularities)
        remainder = length * bdhm.constants(coefficients, segments)
    else:
        module = hermite if method == "hermite" else lipschitz
        jumps = jnp.abs(cauchy.slope_jumps(coefficients, singularities))
        weights = derivative_bound_weights(start, end, singularities, module.DERIVATIVE_ORDER)
        remainder = module.remainder_factor(length) * (jumps @ weights.T)
    factor = rounding.slack_factor(coefficients.shape[1]) * jnp.abs(coefficients).max()
    slack = factor * rounding.panel_scale(start, end, singularities)
    remainder = remainder + slack
    bounds = METHODS[method].panel_bounds(ends, remainder[0], remainder[1])
    f, g = (modulus(values[0][:, k]) for k in (0, 1))
    return {
        "sigma2_lower": bounds.sigma2_lower,
        "sigma1_upper": bounds.sigma1_upper,
        "k_upper": bounds.k_upper,
        "turning": bounds.turning,
        "injective": bounds.injective,
        "sigma2_seen": f - g,
        "sigma1_seen": f + g,
        "k_seen": g / f,
        "fz_seen": f,
        "slack": slack,
    }


def _frozen(values: Array) -> Array:
    values.flags.writeable = False
    return values


def _real(z: Array) -> Array:
    return np.stack([np.real(z), np.imag(z)], axis=-1)


def _place(z: complex) -> str:
    return f"({z.real:.6g}, {z.imag:.6g})"
