"""Other ways to a minimum, for poses on which the first one ends badly.

The energy has many local minima. Which one a map leads to is decided by how it turns the lines
between handles (:mod:`glid_nb.solvers.turning`): so where one of them turns by about half a circle,
its targets are led the other way round in stages. The identity itself as start, instead of the
rigidly aligned one, frees a line that is squeezed though it could bend, and helps after a high
energy where the targets are far from any rigid motion. Where the first way does not converge or
ends very high, everything is tried: all turns that may go either way, and ``lambda`` raised in
stages, for with the usual ``1e5`` the first Newton steps rush the handles to their targets,
whatever that does to the shape. An energy that is no barrier (ARAP) can run against the limit of
local injectivity far from its targets; it then starts at the symmetric Dirichlet minimum.
"""

import functools
import itertools
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from glid_nb._jax import jnp
from glid_nb._runtime import double_precision
from glid_nb.energies import Energy, SymmetricDirichlet
from glid_nb.harmonic import HarmonicMap, as_complex
from glid_nb.solvers.method import Inputs
from glid_nb.solvers.result import Attempt, Result, Status
from glid_nb.solvers.turning import turning_of

Descend = Callable[[Inputs], Result]

# Multiples of an isometry's energy, if that is at least the last number: below the first no other
# way is tried, above the second lines that turn less and the identity too, above the third all.
LOW_ENERGY, HIGH_ENERGY, HIGHEST_ENERGY, LEAST_ISOMETRY = 1.02, 2.5, 25.0, 0.5
SAME_ENERGY = 1e-6
# Lines that turn by so much may turn the other way round: what that costs grows with the square.
HALF_CIRCLE, FAR = np.deg2rad(145), np.deg2rad(95)
# A rigid alignment that turns by more, and that the targets follow by less of their way, misleads.
ALIGNED, RIGID = np.deg2rad(10), 0.5
# What a shape costs above an isometry grows faster on the way than this power of the time; the
# second one where the first map turns a line by over half a circle.
GROWTH, WOUND_GROWTH = 1.7, 1.25
# The stages' fractions of lambda, and how far each is followed.
STAGES = (1e-5, 1e-3, 1e-1)
STAGE_ITERATIONS, STAGE_TOLERANCE = 8, 1e-3
TURNING_ITERATIONS = 4
FEW_ITERATIONS = 20  # fewer most iterations than these ask for a look at them, not for the minimum


class Way(NamedTuple):
    """Problems, each solved from the last one's map; the last one is the one to be solved."""

    name: str
    problems: list[Inputs]
    above: float = HIGHEST_ENERGY  # tried from this multiple of an isometry's energy on
    limits: Sequence[float] = ()  # what the other problems may cost, of what the best result does


def improve(first: Result, inputs: Inputs, descend: Descend) -> Result:
    """The best of ``first``, of ``inputs``, and if it is poor of ``options.restarts`` others."""
    if not (inputs.options.restarts and len(inputs.pose)) or not _is_above(first, LOW_ENERGY):
        return first
    best, tried = first, [("direct", first)]
    for way in _ways(first, inputs)[: inputs.options.restarts]:
        if not _is_above(best, way.above):
            continue
        result = _followed(way, descend, best)
        tried.append((way.name, result))
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


def _ways(first: Result, inputs: Inputs) -> list[Way]:
    """All other ways that may end lower than the first, those first that help most."""
    assert isinstance(first.map, HarmonicMap)
    turning, ways = turning_of(first.map, inputs.pose), list[Way]()
    high, hopeless = _is_above(first, HIGH_ENERGY), _is_above(first, HIGHEST_ENERGY)
    wound = any(abs(line.turn) > np.pi for line in turning.lines)
    growth = WOUND_GROWTH if wound else GROWTH
    paths = turning.ways(FAR if high or wound else HALF_CIRCLE)
    if hopeless and not inputs.energy.is_barrier:
        barrier = replace(inputs, energy=SymmetricDirichlet())
        ways.append(Way("from the symmetric Dirichlet minimum", [barrier, inputs]))
    if hopeless:
        paths["staged targets"] = turning.stages()
    for name, stages in paths.items():
        loose = _loosened(inputs, TURNING_ITERATIONS, align=True)
        problems = [*(replace(loose, pose=stage.pose) for stage in stages), inputs]
        ways.append(Way(name, problems, 0, [stage.time**growth for stage in stages]))
    squeezed = any(line.squeezed for line in turning.lines)
    z, w = (as_complex(p - p.mean(axis=0)) for p in (inputs.pose.handles, inputs.pose.targets))
    turned, along = abs(np.angle(np.vdot(z, w))) > ALIGNED, abs(np.vdot(z, w))
    misled = high and turned and along < RIGID * np.vdot(z, z).real
    if inputs.options.align and (hopeless or squeezed or misled):
        still = _with(inputs, align=False)
        ways.append(Way("from the identity", [still], 0 if squeezed else HIGH_ENERGY))
        ways.append(Way("staged weights from the identity", _raised(still)))
    return [*ways, Way("staged weights", _raised(inputs))] if hopeless else ways


def _raised(inputs: Inputs) -> list[Inputs]:
    weights = [inputs.options.p2p_weight * fraction for fraction in STAGES]
    return [*(_loosened(inputs, STAGE_ITERATIONS, p2p_weight=w) for w in weights), inputs]


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
    """The result of a way; the history of its stages counts where they only differ by weight.

    A shape is distorted the more the further it turns, so a stage that distorts it more than the
    best result will be at that time is the last.
    """
    final, done = way.problems[-1], list[Result]()
    isometry = isometry_energy(final.energy)
    for stage, limit in itertools.zip_longest(way.problems, way.limits):
        start = done[-1] if done else None
        stage = _with(stage, align=stage.options.align and not done)
        done.append(descend(replace(stage, start=start)))
        costs = done[-1].energy_iso - isometry
        over = limit is not None and costs > limit * (best.energy - isometry)
        if done[-1].status is Status.STOPPED or over:
            break
    if way.problems[0].options.p2p_weight != final.options.p2p_weight:
        return _joined(done)
    if done[-1].status is Status.STOPPED and len(done) < len(way.problems):
        return replace(best, status=Status.STOPPED)
    return replace(done[-1], **_times(done))


def _loosened(inputs: Inputs, iterations: int, **changes: Any) -> Inputs:
    most = inputs.options.max_iterations
    few = iterations if most is None else min(iterations, most)
    return _with(inputs, max_iterations=few, tolerance=STAGE_TOLERANCE, **changes)


def _with(inputs: Inputs, **changes: Any) -> Inputs:
    return replace(inputs, options=replace(inputs.options, **changes))


def _times(results: list[Result]) -> dict[str, float]:
    return {key: sum(getattr(r, key) for r in results) for key in ("compile_time", "solve_time")}


def _joined(stages: list[Result]) -> Result:
    """The last stage's result; the histories and times of all, in energies of the full weight."""
    factors = [1 / fraction for fraction in (*STAGES, 1.0)][: len(stages)]
    (initial, *first), *later = (
        [replace(e, energy_p2p=e.energy_p2p * factor) for e in (stage.initial, *stage.history)]
        for stage, factor in zip(stages, factors, strict=True)
    )
    entries = [*first, *(entry for _, *others in later for entry in others)]
    return replace(
        stages[-1],
        energy_p2p=stages[-1].energy_p2p * factors[-1],
        initial=initial,
        history=tuple(replace(entry, iteration=i) for i, entry in enumerate(entries, start=1)),
        **_times(stages),
    )
