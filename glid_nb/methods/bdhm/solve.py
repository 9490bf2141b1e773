"""BDHM's iteration: one second-order cone program per step, whose result is certified.

ARAP with fixed frames is an upper bound of ARAP, and both are equal at the map of these frames. The
bounds with fixed frames are convex and imply the true bounds (Chen & Weber 2015). So if the current
map is feasible, the energy decreases along the whole way to the program's solution. The program
imposes the bounds at samples, with a margin, or with the rest of the margin that the current map
leaves. A proof then shows them everywhere.
"""

import functools
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from glid_nb._arrays import Array
from glid_nb._runtime import single_blas_thread
from glid_nb.certificate import Certificate, certify
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods.bdhm import program
from glid_nb.solvers import Inputs, Iteration, Method, MethodError, Result, Status
from glid_nb.solvers.loop import Ending, GeneratedDescent, Reached, Steps, follow
from glid_nb.solvers.positional import measured_apart
from glid_nb.solvers.subspace import KEPT, MOST_MEASUREMENTS

_PROOF = 0.4  # the share of the margin that the proof may use
# Most programs of one step; each has more samples than the one before.
_ROUNDS = 10
_HALVINGS = 12
# The excess for the next program if no step from a map could be proved (see ActiveSet.excess).
_INWARD = 0.9
# Before the first full step, each step solves one program, unless a step is shorter than this.
_SHORT = 1 / 64
_NOTHING = 1e-10  # the tolerance is relative to at least this energy
# The wanted duality gap: relative to the decrease that counts as none, its least and its most.
_GAP, _LEAST_GAP, _MOST_GAP = 0.01, 1e-12, 1e-6

# The method has converged when a program predicts a decrease below this share of the energy. The
# energy may then still be some twenty times as far above its minimum, because the method is of
# first order.
TOLERANCE = 1e-5


@dataclass(frozen=True)
class BDHM(program.DistortionBounds, Method):
    """ARAP within given bounds on k, sigma_1 and sigma_2 by cone programs (Clarabel).

    Bounded distortion harmonic maps (Chen & Weber 2015). ``k``, ``sigma1`` and ``sigma2`` bound the
    distortion of the whole map. An isometry must satisfy them strictly. The energy never rises, and
    every map is proved to keep the bounds. A start that is certified but does not keep the bounds
    is replaced by the identity.

    The method has converged when the dual of the program at the current map shows that the program
    cannot lower the energy by more than the share ``tolerance``. Then the map is stationary under
    bounds at samples that are stricter by `MARGIN`; if the map uses a part of this margin, by the
    rest of it.
    """

    name = "bdhm"
    label = "Bounded distortion harmonic maps"
    family = "harmonic"
    energies = ("arap",)
    package = "clarabel"
    stiffens = False

    tolerance: float = TOLERANCE

    def run(self, inputs: Inputs) -> Result:
        return follow(lambda: _Descent(self, inputs))


class Iterate(NamedTuple):
    """A map for which the bounds are proved."""

    v: Array
    energy: float
    certificate: Certificate
    step: float | None = None


class _Descent(GeneratedDescent):
    method: BDHM
    far, measured = True, 0

    def __init__(self, method: BDHM, inputs: Inputs) -> None:
        super().__init__(method, inputs, self.steps())

    def _measure(self, map: HarmonicMap) -> None:
        weight = self.inputs.options.p2p_weight
        with single_blas_thread():
            damping = KEPT if self.measured == MOST_MEASUREMENTS else 1.0
            self.problem = program.BoundedProblem(map, self.inputs.pose, weight, damping)
        samples = self.problem.samples
        none = np.zeros((3, len(samples.a)), dtype=bool)
        self.active = program.ActiveSet(self.problem, self.method, samples, none)
        self.measured += 1

    def _measured_anew(self, now: Iterate) -> Iterate | None:
        """The same map with angles and scales measured from it; None if that changes nothing."""
        if self.measured > MOST_MEASUREMENTS or not self.inputs.pose.oriented.any():
            return None
        before, map = self.problem.positional, now.certificate.map
        self._measure(map)
        if not measured_apart(before, self.problem.positional):
            return None
        v = self.problem.unknowns(map, False)
        return now._replace(v=v, energy=sum(self.problem.energies(v)))

    def steps(self) -> Steps:
        identity = HarmonicMap.identity(self.inputs.domain)
        given = self.method.proved_start(self.inputs)
        start = identity if given is None else given.map
        start = HarmonicMap(identity.domain, start.phi, start.psi)
        self._measure(start)
        for map_ in (start, identity):
            v = self.problem.unknowns(map_, self.inputs.options.align)
            now = Iterate(v, sum(self.problem.energies(v)), self._proved(v))
            if self.method.hold(now.certificate):
                break
        else:
            why = now.certificate.reason
            raise MethodError(f"the identity could not be proved to keep the bounds: {why}")
        while True:
            yield functools.partial(self._at, now)
            with single_blas_thread():
                then = self._next(now)
            if isinstance(then, Ending):
                anew = self._measured_anew(now) if then.status is Status.CONVERGED else None
                if anew is None:
                    return then
                then = anew
            now = then

    def _at(self, now: Iterate) -> Reached:
        iso, p2p = self.problem.energies(now.v)
        sigma2 = now.certificate.sigma2_lower
        entry = Iteration(energy_distortion=iso, energy_p2p=p2p, step=now.step, sigma2_lower=sigma2)
        return Reached(entry, lambda: now.certificate)

    def _next(self, now: Iterate) -> Iterate | Ending:
        self.active = self.active.around(now.v)
        outcome = self._attempt(now, 1 if self.far else _ROUNDS)
        if self.far:
            self.far = isinstance(outcome, Iterate) and _SHORT <= (outcome.step or 0.0) < 1
            if isinstance(outcome, Ending) and outcome.status is not Status.CONVERGED:
                outcome = self._attempt(now, _ROUNDS)
        if isinstance(outcome, Iterate) or outcome.status is Status.CONVERGED:
            return outcome
        # If the map has used up the margin, no step can be proved. A program that moves the map
        # inwards may raise the energy, but far from the minimum it lowers it.
        self.active = replace(self.active, excess=_INWARD)
        inward = self._attempt(now, _ROUNDS)
        self.active = replace(self.active, excess=1.0)
        return inward if isinstance(inward, Iterate) else outcome

    def _attempt(self, now: Iterate, rounds: int) -> Iterate | Ending:
        gradient = self.problem.gradient(now.v)
        none = self.method.tolerance * max(now.energy, _NOTHING)
        gap = float(np.clip(_GAP * none, _LEAST_GAP, _MOST_GAP))
        while True:
            solved = program.solve_program(gradient, self.active, now.v, gap)
            rounds -= 1
            if solved.change is None:
                return _blocked(f"the cone program was not solved ({solved.status})")
            if solved.decrease <= none and solved.status == "Solved":
                if self.active.excess < 1:
                    return _blocked("giving back some of the margin costs more than it gains")
                share = f"more than {self.method.tolerance:g} of it"
                why = f"with fixed frames, no map within the bounds lowers the energy by {share}"
                return Ending(Status.CONVERGED, f"The solver converged: {why}.")
            reached = now.v + solved.change
            wider = self.active.and_violated(reached)
            if wider is self.active:
                full = self._accepted(now, reached, 1.0)
                if isinstance(full, Iterate):
                    return full
                if full is None:
                    break
                wider = self.active.widened(full)
            if not rounds:
                break
            self.active = wider
        return self._shortened(now, solved.change, solved)

    def _accepted(self, now: Iterate, v: Array, step: float) -> Iterate | Certificate | None:
        energy = sum(self.problem.energies(v))
        if not energy <= now.energy:
            return None
        certificate = self._proved(v)
        if not self.method.hold(certificate):
            return certificate
        return Iterate(v, energy, certificate, step)

    def _shortened(self, now: Iterate, change: Array, solved: program.Step) -> Iterate | Ending:
        """The longest of the steps 1, 1/2, 1/4, ... for which the bounds are proved."""
        for halvings in range(_HALVINGS):
            step = 0.5**halvings
            v = now.v + step * change
            # Check the samples first, because that is cheaper than a proof.
            if (self.active.used(v) <= 1).all():
                accepted = self._accepted(now, v, step)
                if isinstance(accepted, Iterate):
                    return accepted
        solution = f"the cone program's solution ({solved.status}), which promises to lower"
        share = f"the energy by {solved.decrease / now.energy:.1g} of it"
        missed = "both lowers it and is proved to keep the bounds"
        return _blocked(f"no step toward {solution} {share}, {missed}")

    def _proved(self, v: Array) -> Certificate:
        tightness = _PROOF * program.MARGIN * self.method.narrowest
        return certify(self.problem.map_of(v), panels=self.problem.panels, tightness=tightness)


def _blocked(why: str) -> Ending:
    last = "The last map, which keeps the bounds and has the least energy, is returned."
    return Ending(Status.BLOCKED, f"The solver did not converge: {why}. {last}")
