"""Other ways to a minimum, for poses on which the first one ends badly.

The energy has many local minima. Which one a map leads to is mostly decided by how it turns the
lines between handles (:mod:`glid_nb.solvers.turning`): where other turns may cost less, the targets
are led along them in stages, and where the shape is wound up at the end of a line, along the same
ones, but that end the other way round. Wanted angles that cost much are left out at first: the best
map without them may come to them from the other side. The identity as start, instead of the rigidly
aligned one, frees a line that is squeezed though it could bend. Where the first way does not
converge or ends very high, everything is tried: ``lambda`` raised in stages, too, for with the
usual ``1e5`` the first Newton steps rush the handles to their targets, whatever that does to the
shape. An energy that is no barrier (ARAP), or none against a shape that shrinks to nothing (MIPS),
can run against the limit of local injectivity far from its targets; it then starts at the symmetric
Dirichlet minimum.
"""

import functools
import itertools
from collections.abc import Callable, Generator, Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from glid_nb._jax import jnp
from glid_nb._runtime import double_precision
from glid_nb.energies import MIPS, Energy, SymmetricDirichlet
from glid_nb.harmonic import as_complex
from glid_nb.solvers.method import Inputs
from glid_nb.solvers.result import Attempt, Result, Status
from glid_nb.solvers.turning import Stages, Turning, turning_of

Descend = Callable[[Inputs], Result]
Way = tuple[str, list[Inputs], list[float]]  # a name, problems and limits, as of _followed

# Multiples of an isometry's energy, if that is at least the last number: below the first no other
# way is tried, above the second more of them, above the third all.
LOW_ENERGY, HIGH_ENERGY, HIGHEST_ENERGY, LEAST_ISOMETRY = 1.02, 2.5, 25.0, 0.5
SAME_ENERGY = 1e-6
# A way is tried that would gain so much of the energy if it cost so little of what the best does:
# the other way round, of what the turns tell; an arc; no angles; staged targets; the identity.
GAIN, REVERSED, ARC, FREED, STAGED, STILL = 0.015, 0.9, 0.6, 0.8, 0.8, 0.4
# Turns tell less above so many times an isometry's energy; most ways round without a gain; what
# ends that are held may add to what a stage costs.
UNSURE, MOST_MISSES, HELD = 1.1, 3, 2.0
# Lines that turn by so much may turn the other way round (the second number: from a high energy
# on); where one turns by so much, others of the same turns may end lower.
FAR, HALF_CIRCLE = np.deg2rad((80, 60)), np.deg2rad(140)
# A rigid alignment that turns by more, and that the targets follow by less of their way, misleads.
ALIGNED, RIGID = np.deg2rad(60), 0.5
# What a shape costs above an isometry grows faster on the way than this power of the time.
GROWTH = 1.5
# The stages' fractions of lambda, and how far each is followed.
STAGES, STAGE_ITERATIONS, STAGE_TOLERANCE = (1e-5, 1e-3, 1e-1), 6, 1e-3
FEW_ITERATIONS = 20  # fewer most iterations than these ask for a look at them, not for the minimum


def improve(first: Result, inputs: Inputs, descend: Descend) -> Result:
    """The best of ``first``, of ``inputs``, and if it is poor of ``options.restarts`` others."""
    if not (inputs.options.restarts and len(inputs.pose)) or not _is_above(first, LOW_ENERGY):
        return first
    best, tried = first, [("direct", first)]
    ways = _Ways(first, inputs, lambda: best)
    for way in itertools.islice(ways, inputs.options.restarts):
        result = _followed(way, descend, best)
        tried.append((way[0], result))
        if result.status is Status.STOPPED:
            best = replace(min(best, result, key=lambda r: r.energy), status=Status.STOPPED)
            break
        if result.pose is inputs.pose and result.energy < best.energy * (1 - SAME_ENERGY):
            best = result
    if len(tried) == 1:
        return first
    attempts = tuple(
        Attempt(name, r.status, r.energy, r.iterations, given_up=r.pose is not inputs.pose)
        for name, r in tried
    )
    times = _times([result for _, result in tried])
    return replace(best, options=inputs.options, attempts=attempts, **times)


class _Ways:
    """Those that may end lower than the best so far, the likeliest first."""

    def __init__(self, first: Result, inputs: Inputs, best: Callable[[], Result]) -> None:
        self.first, self.inputs, self.best = first, inputs, best
        self.isometry = isometry_energy(inputs.energy)
        self.high, self.hopeless = (_is_above(first, e) for e in (HIGH_ENERGY, HIGHEST_ENERGY))

    def __iter__(self) -> Iterator[Way]:
        inputs, hopeless, energy = self.inputs, self.hopeless, self.inputs.energy
        if hopeless and (not energy.is_barrier or isinstance(energy, MIPS)):
            barrier = replace(inputs, energy=SymmetricDirichlet())
            yield "from the symmetric Dirichlet minimum", [barrier, inputs], []
            if self.best().energy <= HIGH_ENERGY * self.isometry:
                return
        turning = turning_of(self.first.map, inputs.pose)
        seen = yield from self.with_other_turns(turning)
        for line in turning.lines:
            if line.curled and not line.wound and self.may_cost(ARC):
                yield self.led(f"along an arc at {line.child}", turning.stages(bent=line.child))
        if not np.isnan(inputs.pose.angles).all() and self.may_cost(FREED):
            free = replace(inputs, pose=replace(inputs.pose, angles=None, scales=None))
            free = _with(free, tolerance=STAGE_TOLERANCE)
            yield "without its angles first", [free, inputs], [FREED]
        turned = max((abs(line.turn) for line in turning.lines), default=0) > HALF_CIRCLE
        wound = [each for each in seen if any(line.wound for line in each.lines)]
        for each in wound:
            if self.may_cost(STAGED):
                yield self.led("ends the other way round", each.stages(unwound=True), HELD)
        if not wound and (hopeless or (self.high and turned)) and self.may_cost(STAGED):
            yield self.led("staged targets", turning.stages())
        bends = any(line.squeezed for line in turning.lines) or (not turned and self.misled())
        still = functools.partial(_with, inputs, align=False)
        if inputs.options.align and (bends or hopeless) and self.may_cost(STILL):
            yield "from the identity", [still()], []
        if inputs.options.align and hopeless and _is_above(self.best(), HIGHEST_ENERGY):
            yield "staged weights from the identity", _raised(still()), []
        if hopeless and _is_above(self.best(), HIGHEST_ENERGY):
            yield "staged weights", _raised(inputs), []

    def with_other_turns(self, first: Turning) -> Generator[Way, None, list[Turning]]:
        """Led by lines that turn the other way round; returns the turns of the first map, and of
        the best if that is another."""
        now, misses, known = first, 0, {first.key()}
        told = dict[tuple[float, ...], float]()  # the least that any map tells of others' costs
        unsure = max(self.first.energy / max(self.isometry, LEAST_ISOMETRY) / UNSURE, 1)

        def reversals() -> list[tuple[tuple[int, ...], tuple[float, ...], float]]:
            costs = max(self.best().energy - self.isometry, SAME_ENERGY)
            ratios = now.reversals(FAR[int(self.high)]).items()
            found = [(lines, now.key(lines), ratio) for lines, ratio in ratios]
            for _, key, ratio in found:
                told[key] = min(ratio * costs, told.get(key, np.inf))
            return [(lines, key, told[key] / costs) for lines, key, _ in found]

        left = reversals()
        while left and misses < MOST_MISSES:
            (lines, key, ratio), before = left.pop(0), self.best()
            if key not in known and self.may_cost(REVERSED * ratio / unsure):
                name = f"the other way round at {', '.join(map(str, lines))}"
                yield self.led(name, now.stages(lines), 1 / min(ratio, 1))
                misses += self.best() is before
            known.add(key)
            if self.best() is not before:  # what it turns may turn on from there
                now = turning_of(self.best().map, self.inputs.pose)
                left = reversals()
        return [first] if now is first else [first, now]

    def may_cost(self, ratio: float) -> bool:
        """Whether a way pays that costs so much of what the best does above an isometry."""
        best = self.best()
        least = self.isometry + ratio * (best.energy - self.isometry)
        return _is_above(best, least / (1 - GAIN) / max(self.isometry, LEAST_ISOMETRY))

    def led(self, name: str, stages: Stages, most: float = 1) -> Way:
        loose = _loosened(self.inputs, align=True)
        problems = [*(replace(loose, pose=pose) for _, pose in stages), self.inputs]
        return name, problems, [most * time**GROWTH for time, _ in stages]

    def misled(self) -> bool:
        """Whether the rigid start turned the shape far, though its targets hardly follow that."""
        pose = self.inputs.pose
        z, w = (as_complex(p - p.mean(axis=0)) for p in (pose.handles, pose.targets))
        along, rigid = np.vdot(z, w), RIGID * np.vdot(z, z).real
        return bool(self.high and abs(np.angle(along)) > ALIGNED and abs(along) < rigid)


def _raised(inputs: Inputs) -> list[Inputs]:
    weights = [inputs.options.p2p_weight * fraction for fraction in STAGES]
    return [*(_loosened(inputs, p2p_weight=w) for w in weights), inputs]


def _is_above(result: Result, multiple: float) -> bool:
    """Whether another way may well end lower: it has not converged, or above a multiple."""
    if result.status in (Status.STOPPED, Status.INDEFINITE):
        return False
    if result.status is Status.MAX_ITERATIONS and result.iterations < FEW_ITERATIONS:
        return False
    isometry = max(isometry_energy(result.energy_measure), LEAST_ISOMETRY)
    return not result.status.ok or result.energy > multiple * isometry


@functools.lru_cache
@double_precision
def isometry_energy(energy: Energy) -> float:
    """``E(1, 0)``, the density of an isometry."""
    return float(energy.density(jnp.ones(1), jnp.zeros(1))[0])


def _followed(way: Way, descend: Descend, best: Result) -> Result:
    """The last of the problems' results, each from the one before.

    A shape is distorted the more the further it turns, so a stage that costs more than so much of
    what the best result does (``limits``) is the last.
    """
    _, problems, limits = way
    done, isometry = list[Result](), isometry_energy(problems[-1].energy)
    for stage, limit in itertools.zip_longest(problems, limits):
        stage = _with(stage, align=stage.options.align and not done)
        done.append(descend(replace(stage, start=done[-1] if done else None)))
        costs = done[-1].energy_iso - isometry
        over = limit is not None and costs > limit * (best.energy - isometry)
        if done[-1].status is Status.STOPPED or over:
            break
    if done[-1].status is Status.STOPPED and len(done) < len(problems):
        return replace(best, status=Status.STOPPED)
    return replace(done[-1], **_times(done))


def _loosened(inputs: Inputs, **changes: Any) -> Inputs:
    most = inputs.options.max_iterations
    few = STAGE_ITERATIONS if most is None else min(STAGE_ITERATIONS, most)
    return _with(inputs, max_iterations=few, tolerance=STAGE_TOLERANCE, **changes)


def _with(inputs: Inputs, **changes: Any) -> Inputs:
    return replace(inputs, options=replace(inputs.options, **changes))


def _times(results: list[Result]) -> dict[str, float]:
    return {key: sum(getattr(r, key) for r in results) for key in ("compile_time", "solve_time")}
