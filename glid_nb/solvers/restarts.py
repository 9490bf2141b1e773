"""Other ways to a minimum, for poses on which the first one ends badly.

The energy has many local minima, and with ``lambda = 1e5`` the first Newton steps rush the handles
to their targets, whatever that does to the shape. Tried are targets that turn into place in stages,
either way round (:mod:`glid_nb.solvers.turning`), a ``lambda`` that rises in stages, and the
identity itself as start; an energy that is no barrier (ARAP) starts at the symmetric Dirichlet
minimum. None is best on all hard poses, so the best result is kept.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from glid_nb._jax import jnp
from glid_nb._runtime import double_precision
from glid_nb.energies import Energy, SymmetricDirichlet
from glid_nb.solvers.method import Inputs
from glid_nb.solvers.result import Attempt, Result, Status
from glid_nb.solvers.turning import turning_of

Descend = Callable[[Inputs], Result]

# Energies above this multiple of an isometry's, if that is at least the last number, are worth all
# other ways; those above the second are worth turning where joints may turn either way.
HIGH_ENERGY, HIGH_ENERGY_OF_JOINTS, LEAST_ISOMETRY = 2.0, 1.02, 0.5
SAME_ENERGY = 1e-6
# The stages' fractions of lambda, and how far each is followed.
STAGES = (1e-5, 1e-3, 1e-1)
STAGE_ITERATIONS, STAGE_TOLERANCE = 8, 1e-3
TURNING_ITERATIONS = 4
FEW_ITERATIONS = 20  # fewer most iterations than these ask for a look at them, not for the minimum


def improve(first: Result, inputs: Inputs, descend: Descend) -> Result:
    """The best of ``first``, of ``inputs``, and if it is poor of ``options.restarts`` others."""
    if not (inputs.options.restarts and len(inputs.pose)) or not _is_poor(first, 1):
        return first
    best, tried = first, [("direct", first)]
    for name, stages, joints in _ways(inputs)[: inputs.options.restarts]:
        if not _is_poor(best, joints):
            continue
        result = _followed(stages, descend, best)
        tried.append((name, result))
        if result.status is Status.STOPPED:
            best = replace(min(best, result, key=lambda r: r.energy), status=Status.STOPPED)
            break
        if result.energy < best.energy * (1 - SAME_ENERGY):
            best = result
    if len(tried) == 1:
        return first
    attempts = tuple(
        Attempt(name, r.status, r.energy, r.iterations, given_up=r.pose is not inputs.pose)
        for name, r in tried
    )
    times = _times([result for _, result in tried])
    return replace(best, options=inputs.options, attempts=attempts, **times)


def _ways(inputs: Inputs) -> list[tuple[str, list[Inputs], int]]:
    """All other ways by name, those first that help most: the problems, each solved from the last
    one's map, ``inputs`` at the end; and the joints that they turn."""
    positions = replace(inputs.pose, angles=None, scales=None)
    turning = turning_of(positions, inputs.domain.cage)
    joints, ways = len(turning.joints), list[tuple[str, list[Inputs], int]]()
    if not inputs.energy.is_barrier:
        barrier = replace(inputs, energy=SymmetricDirichlet())
        ways.append(("from the symmetric Dirichlet minimum", [barrier, inputs], 0))
    loose = _loosened(inputs, TURNING_ITERATIONS, align=True)
    for name, poses in turning.ways.items():
        ways.append((name, [*(replace(loose, pose=pose) for pose in poses), inputs], joints))
    if inputs.options.align:
        still = _with(inputs, align=False)
        ways.append(("staged weights from the identity", _raised(still), 0))
        ways.append(("from the identity", [still], 0))
    return [*ways, ("staged weights", _raised(inputs), 0)]


def _raised(inputs: Inputs) -> list[Inputs]:
    weights = [inputs.options.p2p_weight * fraction for fraction in STAGES]
    return [*(_loosened(inputs, STAGE_ITERATIONS, p2p_weight=w) for w in weights), inputs]


def _is_poor(result: Result, joints: int) -> bool:
    """Whether a way that turns so many joints may well end lower."""
    if result.status in (Status.STOPPED, Status.INDEFINITE):
        return False
    if result.status is Status.MAX_ITERATIONS and result.iterations < FEW_ITERATIONS:
        return False
    isometry = max(isometry_energy(result.energy_measure), LEAST_ISOMETRY)
    high = HIGH_ENERGY_OF_JOINTS if joints else HIGH_ENERGY
    return not result.status.ok or result.energy > high * isometry


@double_precision
def isometry_energy(energy: Energy) -> float:
    """``E(1, 0)``, the density of an isometry."""
    return float(energy.density(jnp.ones(1), jnp.zeros(1))[0])


def _followed(stages: Sequence[Inputs], descend: Descend, best: Result) -> Result:
    """The result of a way, which ends early at a stage that distorts the shape more than the best
    result; the history of its stages counts where they only differ by weight."""
    final, done = stages[-1], list[Result]()
    for stage in stages:
        start = done[-1] if done else None
        stage = _with(stage, align=stage.options.align and not done)
        done.append(descend(replace(stage, start=start)))
        turns_too_far = stage.pose is not final.pose and done[-1].energy_iso > best.energy
        if done[-1].status is Status.STOPPED or turns_too_far:
            break
    if stages[0].options.p2p_weight != final.options.p2p_weight:
        return _joined(done)
    if done[-1].status is Status.STOPPED and len(done) < len(stages):
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
    """The last stage's result with the histories and times of all, in energies of the full
    weight."""
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
