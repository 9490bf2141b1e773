"""The samples at which a map is held to its bounds."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb.certificate import Certificate
from glid_nb.methods.bdhm.bounds import DistortionBounds
from glid_nb.methods.bdhm.problem import BoundedProblem, Samples

Array = NDArray[Any]

# By which share of a bound's range the bounds at samples are stricter than the proved ones.
MARGIN = 0.01
# How much of the margin a sample that is not in the active set may use before it joins.
_SLACK = 0.1
# A sample joins the active set within the first share of a bound's range and leaves beyond the
# second.
_JOIN, _LEAVE = 0.10, 0.15


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

    @classmethod
    def empty(cls, problem: BoundedProblem, bounds: DistortionBounds) -> ActiveSet:
        """Without any bounds."""
        samples = problem.samples
        return cls(problem, bounds, samples, np.zeros((3, len(samples)), dtype=bool))

    def used(self, v: Array) -> Array:
        """(3, n) shares of the way from an isometry to each bound."""
        return _used(self.samples, v, self.bounds)

    def levels(self, v: Array) -> Array:
        """(3, n) shares that the next map may use; no sample is ever given more than before."""
        strict = 1 - MARGIN
        return strict + self.excess * np.maximum(self.used(v) - strict, 0)

    def with_excess(self, excess: float) -> ActiveSet:
        """The same samples with another share of excess."""
        return replace(self, excess=excess)

    def around(self, v: Array) -> ActiveSet:
        """With the local extremes near a bound, and without samples far from it."""
        used = self.used(v)
        kept = self.chosen & (used > 1 - _LEAVE)
        return self._with(kept | (self._peaks(used) & (used > 1 - _JOIN)))

    def and_violated(self, v: Array) -> ActiveSet:
        """With the local extremes beyond a bound; the same object where there are no new ones."""
        used = self.used(v)
        beyond = self._peaks(used) & (used > 1 - (1 - _SLACK) * MARGIN) & ~self.chosen
        return self._with(self.chosen | beyond) if beyond.any() else self

    def refined(self, certificate: Certificate) -> ActiveSet:
        """With new samples on the panels, of each run of them the worst, that fail the proof."""
        panels = certificate.panels
        used = self.bounds.used(panels.k_upper, panels.sigma1_upper, panels.sigma2_lower)
        failed = (used > 1) & _peaks(used)
        at = np.flatnonzero(failed.any(axis=0))
        places = np.concatenate([panels.start[at], panels.end[at], panels.middle[at]])
        more = self.problem.samples_at(places)
        return replace(
            self,
            samples=self.samples.and_also(more),
            chosen=np.concatenate([self.chosen, *[failed[:, at]] * 3], axis=1),
        )

    def _with(self, chosen: Array) -> ActiveSet:
        return replace(self, chosen=chosen)

    def _peaks(self, used: Array) -> Array:
        """Local extremes; samples that were added are taken for such."""
        peaks = np.ones(used.shape, dtype=bool)
        own = len(self.problem.samples)
        peaks[:, :own] = _peaks(used[:, :own])
        return peaks


def _peaks(used: Array) -> Array:
    return (used >= np.roll(used, 1, axis=1)) & (used >= np.roll(used, -1, axis=1))


def _used(samples: Samples, v: Array, bounds: DistortionBounds) -> Array:
    f, g = (np.abs(part) for part in samples.values(v))
    return bounds.used(g / np.maximum(f, 1e-300), f + g, f - g)
