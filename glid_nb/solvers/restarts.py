"""Other ways to a minimum, for poses on which the first one ends badly.

The energy has many local minima, and with the usual weight ``lambda = 1e5`` the first Newton steps
rush the handles to their targets, whatever that does to the shape. Two remedies are tried: to
raise ``lambda`` in stages, which lets the shape turn before it bends, and to start at the identity
itself instead of at the rigidly aligned one. On hard poses of the reference shapes one of them
often ends at a fraction of the first energy; on ordinary poses they find the same minimum, which
is why they are not tried there. An energy that is no barrier (ARAP) can run against the limit of
local injectivity far from its targets; it then starts at the symmetric Dirichlet minimum.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from glid_nb._jax import jnp
from glid_nb._runtime import double_precision
from glid_nb.energies import Energy, SymmetricDirichlet
from glid_nb.solvers.method import Inputs
from glid_nb.solvers.result import Attempt, Result
from glid_nb.solvers.status import Status

Descend = Callable[[Inputs], Result]
"""Follows one way down."""

# Energies above this multiple of an isometry's, if that is at least the second number, are worth
# another attempt.
HIGH_ENERGY, LEAST_ISOMETRY = 2.0, 0.5
AGREEMENT = 1e-3
SAME_ENERGY = 1e-6
# The stages' fractions of lambda, and how far each is followed.
STAGES = (1e-5, 1e-3, 1e-1)
STAGE_ITERATIONS, STAGE_TOLERANCE = 8, 1e-3


def improve(first: Result, inputs: Inputs, descend: Descend) -> Result:
    """The best of ``first`` and, if it is poor, of ``options.restarts`` other attempts.

    ``inputs`` are those of ``first``.
    """
    from_identity = _with(inputs, align=False)
    ways = [
        ("staged weights", lambda: _staged(inputs, descend)),
        ("staged weights from the identity", lambda: _staged(from_identity, descend)),
        ("from the identity", lambda: descend(from_identity)),
    ]
    if not inputs.options.align:
        del ways[1:]
    if not inputs.energy.is_barrier:
        barrier = lambda: _from_barrier(first, inputs, descend)  # noqa: E731
        ways.insert(0, ("from the symmetric Dirichlet minimum", barrier))
    best, tried = first, [("direct", first)]
    for name, way in ways[: inputs.options.restarts]:
        if not _is_poor(best):
            break
        result = way()
        tried.append((name, result))
        if result.status is Status.STOPPED:
            best = replace(min(best, result, key=lambda r: r.energy), status=Status.STOPPED)
            break
        # Two ways that agree are taken for the answer.
        agree = best.status.ok and abs(best.energy - result.energy) <= AGREEMENT * best.energy
        if result.energy < best.energy * (1 - SAME_ENERGY):
            best = result
        if agree:
            break
    if len(tried) == 1:
        return first
    attempts = tuple(Attempt(name, r.status, r.energy, r.iterations) for name, r in tried)
    return replace(
        best, options=inputs.options, attempts=attempts, **_times([result for _, result in tried])
    )


def _is_poor(result: Result) -> bool:
    if result.status in (Status.STOPPED, Status.MAX_ITERATIONS, Status.INDEFINITE):
        return False
    isometry = max(isometry_energy(result.energy_measure), LEAST_ISOMETRY)
    return result.status is Status.BLOCKED or result.energy > HIGH_ENERGY * isometry


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


def _from_barrier(first: Result, inputs: Inputs, descend: Descend) -> Result:
    """Descend from the symmetric Dirichlet minimum, whose own history is left out."""
    barrier = descend(replace(inputs, energy=SymmetricDirichlet()))
    if barrier.status is Status.STOPPED:
        return replace(first, status=Status.STOPPED)
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
