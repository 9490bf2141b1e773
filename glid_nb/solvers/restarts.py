"""Other ways to a minimum, for poses on which the first one ends badly.

The energy has many local minima, and with the usual weight ``lambda = 1e5`` the first Newton steps
rush the handles to their targets, whatever that does to the shape. Three remedies are tried: to let
the targets turn into place in stages, either way round (:mod:`glid_nb.solvers.turning`); to raise
``lambda`` in stages, which lets the shape turn before it bends; and to start at the identity itself
instead of at the rigidly aligned one. No single one is best on all hard poses, so all are tried and
the best is kept; on ordinary poses they find the same minimum, which is why they are not tried
there. An energy that is no barrier (ARAP) can run against the limit of local injectivity far from
its targets; it then starts at the symmetric Dirichlet minimum.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from glid_nb._jax import jnp
from glid_nb._runtime import double_precision
from glid_nb.energies import Energy, SymmetricDirichlet
from glid_nb.solvers.method import Inputs
from glid_nb.solvers.pose import Pose
from glid_nb.solvers.result import Attempt, Result
from glid_nb.solvers.status import Status
from glid_nb.solvers.turning import Turning, turning_of

Descend = Callable[[Inputs], Result]
"""Follows one way down."""
Way = Callable[[Result], Result]
"""Follows another way, with the best result so far at hand."""

# Energies above this multiple of an isometry's, if that is at least the last number, are worth all
# other ways; those above the second are worth turning where joints may turn either way.
HIGH_ENERGY, HIGH_ENERGY_OF_JOINTS, LEAST_ISOMETRY = 2.0, 1.02, 0.5
SAME_ENERGY = 1e-6
# The stages' fractions of lambda, and how far each is followed.
STAGES = (1e-5, 1e-3, 1e-1)
STAGE_ITERATIONS, STAGE_TOLERANCE = 8, 1e-3
TURNING_ITERATIONS = 4
# Fewer most iterations than these ask for a look at them, not for the minimum.
FEW_ITERATIONS = 20


def improve(first: Result, inputs: Inputs, descend: Descend) -> Result:
    """The best of ``first`` and, if it is poor, of ``options.restarts`` other attempts.

    ``inputs`` are those of ``first``.
    """
    if not (inputs.options.restarts and len(inputs.pose)):
        return first
    if not _is_poor(first, 1):
        return first
    turning = turning_of(inputs.pose, inputs.domain.cage)
    ways = _ways(inputs, descend, turning)[: inputs.options.restarts]
    best, tried = first, [("direct", first)]
    for name, way, joints in ways:
        if not _is_poor(best, joints):
            continue
        result = way(best)
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
    return replace(
        best, options=inputs.options, attempts=attempts, **_times([result for _, result in tried])
    )


def _ways(inputs: Inputs, descend: Descend, turning: Turning) -> list[tuple[str, Way, int]]:
    """All other ways by name, those first that help most, and the joints that they turn."""
    ways: list[tuple[str, Way, int]] = []
    if not inputs.energy.is_barrier:
        barrier = functools.partial(_from_barrier, inputs, descend)
        ways.append(("from the symmetric Dirichlet minimum", barrier, 0))
    joints = len(turning.joints)
    for name, stages in turning.ways.items():
        ways.append((name, functools.partial(_turned, inputs, descend, stages), joints))
    if inputs.options.align:
        still = _with(inputs, align=False)
        ways.append(("staged weights from the identity", lambda _: _staged(still, descend), 0))
        ways.append(("from the identity", lambda _: descend(still), 0))
    return [*ways, ("staged weights", lambda _: _staged(inputs, descend), 0)]


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


def _staged(inputs: Inputs, descend: Descend) -> Result:
    """Descend with a rising weight of the targets; the history holds all stages."""
    options = inputs.options
    most = STAGE_ITERATIONS if options.max_iterations is None else options.max_iterations
    done: list[Result] = []
    for fraction in STAGES:
        stage = _with(
            inputs,
            p2p_weight=options.p2p_weight * fraction,
            max_iterations=min(STAGE_ITERATIONS, most),
            tolerance=STAGE_TOLERANCE,
            align=options.align and not done,
        )
        done.append(descend(replace(stage, start=done[-1] if done else None)))
        if done[-1].status is Status.STOPPED:
            return _joined(done)
    done.append(descend(replace(_with(inputs, align=False), start=done[-1])))
    return _joined(done)


def _turned(inputs: Inputs, descend: Descend, stages: Sequence[Pose], best: Result) -> Result:
    """Descend along the stages of a way to turn; their own history is left out.

    A shape is distorted the more the further it turns, so a stage that distorts it more than the
    best result is the last.
    """
    options, done = inputs.options, list[Result]()
    most = TURNING_ITERATIONS if options.max_iterations is None else options.max_iterations
    loose = _with(inputs, max_iterations=min(TURNING_ITERATIONS, most), tolerance=STAGE_TOLERANCE)
    for pose in stages:
        stage = _with(replace(loose, pose=pose), align=not done)
        done.append(descend(replace(stage, start=done[-1] if done else None)))
        if done[-1].status is Status.STOPPED:
            return replace(best, status=Status.STOPPED)
        if done[-1].energy_iso > best.energy:
            return replace(done[-1], **_times(done))
    done.append(descend(replace(_with(inputs, align=False), start=done[-1])))
    return replace(done[-1], **_times(done))


def _from_barrier(inputs: Inputs, descend: Descend, best: Result) -> Result:
    """Descend from the symmetric Dirichlet minimum, whose own history is left out."""
    barrier = descend(replace(inputs, energy=SymmetricDirichlet()))
    if barrier.status is Status.STOPPED:
        return replace(best, status=Status.STOPPED)
    result = descend(replace(_with(inputs, align=False), start=barrier))
    return replace(result, **_times([barrier, result]))


def _with(inputs: Inputs, **changes: Any) -> Inputs:
    """The same with other options."""
    return replace(inputs, options=replace(inputs.options, **changes))


def _times(results: list[Result]) -> dict[str, float]:
    """The times of all together."""
    return {
        "compile_time": sum(result.compile_time for result in results),
        "solve_time": sum(result.solve_time for result in results),
    }


def _joined(stages: list[Result]) -> Result:
    """The last stage's result with the histories and the times of all.

    The full weight counts everywhere, so that all energies compare.
    """
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
