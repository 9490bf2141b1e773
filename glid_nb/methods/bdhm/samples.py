"""The bounds on the distortion, and the samples at which a map is held to them."""

from __future__ import annotations

import math
import numbers
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb.certificate import Certificate
from glid_nb.methods.bdhm.problem import BoundedProblem, Samples
from glid_nb.solvers import MethodError

Array = NDArray[Any]

# By which share of a bound's range the bounds at samples are stricter than the proved ones.
MARGIN = 0.01
# How much of the margin a sample that is not in the active set may use before it joins.
_SLACK = 0.1
# A sample joins the active set within the first share of a bound's range and leaves beyond the
# second.
_JOIN, _LEAVE = 0.10, 0.15


@dataclass(frozen=True)
class DistortionBounds:
    """``k(z) <= k``, ``sigma_1(z) <= sigma1`` and ``sigma_2(z) >= sigma2`` (Theorem 4.2).

    Raises
    ------
    MethodError
        When an isometry does not satisfy them with room to spare.
    """

    k: float = 0.8
    sigma1: float = 5.0
    sigma2: float = 0.3

    def __post_init__(self) -> None:
        ranges = {"k": (0, 1), "sigma1": (1, math.inf), "sigma2": (0, 1)}
        for name, (low, high) in ranges.items():
            value = getattr(self, name)
            if not isinstance(value, numbers.Real) or not low < float(value) < high:
                raise MethodError(
                    f"the bound {name} must lie between {low} and {high}, ends excluded, for the "
                    f"method starts at an isometry; got {value!r}"
                )

    def hold(self, certificate: Certificate) -> bool:
        """Whether they are proved on the whole domain."""
        return (
            certificate.certified
            and certificate.k_upper <= self.k
            and certificate.sigma1_upper <= self.sigma1
            and certificate.sigma2_lower >= self.sigma2
        )

    @property
    def narrowest(self) -> float:
        """The least of the bounds' ranges, each relative to its bound and no more than 1."""
        return min(1.0, (self.sigma1 - 1) / self.sigma1, (1 - self.sigma2) / self.sigma2)

    def used(self, k: Array, sigma1: Array, sigma2: Array) -> Array:
        """(3, n) shares of the way from an isometry to each bound."""
        return np.stack(
            [k / self.k, (sigma1 - 1) / (self.sigma1 - 1), (1 - sigma2) / (1 - self.sigma2)]
        )

    def at(self, used: Array) -> tuple[Array, Array, Array]:
        """k, sigma_1 and sigma_2 at (3, n) such shares."""
        k, sigma1, sigma2 = used
        return k * self.k, 1 + sigma1 * (self.sigma1 - 1), 1 - sigma2 * (1 - self.sigma2)


@dataclass(frozen=True, eq=False)
class ActiveSet:
    """Samples of the boundary, and which of them are held to which bound.

    Attributes
    ----------
    samples : Samples
        First the problem's own, which follow one another, then those that a failed proof added.
    chosen : (3, n) bool array
        Where k, sigma_1 and sigma_2 are bounded.
    excess : float
        How much the next map may keep of what this one has beyond the stricter bounds. With 1 the
        map itself is always admitted; with less it is drawn inward.
    """

    problem: BoundedProblem
    bounds: DistortionBounds
    samples: Samples
    chosen: Array
    excess: float = 1.0

    def used(self, v: Array) -> Array:
        """(3, n) shares of the way from an isometry to each bound."""
        f, g = (np.abs(part) for part in self.samples.values(v))
        return self.bounds.used(g / np.maximum(f, 1e-300), f + g, f - g)

    def levels(self, v: Array) -> Array:
        """(3, n) shares that the next map may use; no sample is ever given more than before."""
        strict = 1 - MARGIN
        return strict + self.excess * np.maximum(self.used(v) - strict, 0)

    def around(self, v: Array) -> ActiveSet:
        """With the local extremes near a bound, and without samples far from it."""
        used = self.used(v)
        kept = self.chosen & (used > 1 - _LEAVE)
        return replace(self, chosen=kept | (self._peaks(used) & (used > 1 - _JOIN)))

    def and_violated(self, v: Array) -> ActiveSet:
        """With the local extremes beyond a bound; the same object where there are no new ones."""
        used = self.used(v)
        beyond = self._peaks(used) & (used > 1 - (1 - _SLACK) * MARGIN) & ~self.chosen
        return replace(self, chosen=self.chosen | beyond) if beyond.any() else self

    def refined(self, certificate: Certificate) -> ActiveSet:
        """With new samples on the panels, of each run of them the worst, that fail the proof."""
        panels = certificate.panels
        used = self.bounds.used(panels.k_upper, panels.sigma1_upper, panels.sigma2_lower)
        failed = (used > 1) & _peaks(used)
        at = np.flatnonzero(failed.any(axis=0))
        ends = (panels.start[at] @ np.array([1, 1j]), panels.end[at] @ np.array([1, 1j]))
        more = self.problem.samples_at(np.concatenate([*ends, (ends[0] + ends[1]) / 2]))
        return replace(
            self,
            samples=Samples(
                *(np.concatenate([a, b]) for a, b in zip(self.samples, more, strict=True))
            ),
            chosen=np.concatenate([self.chosen, *[failed[:, at]] * 3], axis=1),
        )

    def _peaks(self, used: Array) -> Array:
        """Local extremes; samples that were added are taken for such."""
        peaks = np.ones(used.shape, dtype=bool)
        own = len(self.problem.samples.a)
        peaks[:, :own] = _peaks(used[:, :own])
        return peaks


def _peaks(used: Array) -> Array:
    return (used >= np.roll(used, 1, axis=1)) & (used >= np.roll(used, -1, axis=1))
