"""Other ways to a minimum, for poses on which the first one ends badly.

The energy has many local minima, and with the usual weight ``lambda = 1e5`` the first Newton steps
rush the handles to their targets, whatever that does to the shape. Two remedies are tried: to
raise ``lambda`` in stages, which lets the shape turn before it bends, and to start at the identity
itself instead of at the rigidly aligned one. On hard poses of the reference shapes one of them
often ends at a fraction of the first energy; on ordinary poses they find the same minimum, which
is why they are not tried there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import jax.numpy as jnp

from glid_nb._runtime import double_precision
from glid_nb.energies import Energy
from glid_nb.solvers.options import Options
from glid_nb.solvers.result import Attempt, Iteration, Result
from glid_nb.solvers.status import Status

Descend = Callable[..., Result]

# Energies above this multiple of an isometry's are worth another attempt.
HIGH_ENERGY = 2.0
AGREEMENT = 1e-3
SAME_ENERGY = 1e-6
# The stages' fractions of lambda, and how far each is followed.
STAGES = (1e-5, 1e-3, 1e-1)
STAGE_ITERATIONS, STAGE_TOLERANCE = 8, 1e-3


def improve(first: Result, descend: Descend, callback: Callable[..., Any] | None) -> Result:
    """The best of ``first`` and, if it is poor, of ``options.restarts`` other attempts.

    ``descend(pose, energy, options, start, callback)`` follows one way down.
    """
    options = first.options
    ways = [
        ("staged weights", lambda: _staged(first, descend, options, callback)),
        (
            "staged weights from the identity",
            lambda: _staged(first, descend, replace(options, align=False), callback),
        ),
        (
            "from the identity",
            lambda: descend(
                first.pose, first.energy_measure, replace(options, align=False), None, callback
            ),
        ),
    ]
    if not options.align:
        del ways[1:]
    best, tried = first, [("direct", first)]
    for name, way in ways[: options.restarts]:
        if not _is_poor(best):
            break
        result = way()
        tried.append((name, result))
        if result.status is Status.STOPPED:
            best = result
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
        best,
        options=options,
        attempts=attempts,
        compile_time=sum(r.compile_time for _, r in tried),
        solve_time=sum(r.solve_time for _, r in tried),
    )


def _is_poor(result: Result) -> bool:
    if result.status in (Status.STOPPED, Status.MAX_ITERATIONS, Status.INDEFINITE):
        return False
    return result.status is Status.BLOCKED or result.energy > HIGH_ENERGY * isometry_energy(
        result.energy_measure
    )


@double_precision
def isometry_energy(energy: Energy) -> float:
    """``E(1, 0)``, the density of an isometry."""
    return float(energy.density(jnp.ones(1), jnp.zeros(1))[0])


def _staged(
    first: Result, descend: Descend, options: Options, callback: Callable[..., Any] | None
) -> Result:
    """Descend with a rising weight of the targets; the history holds all stages."""
    result: Result | None = None
    history: tuple[Iteration, ...] = ()
    for fraction in STAGES:
        stage = replace(
            options,
            p2p_weight=options.p2p_weight * fraction,
            max_iterations=min(STAGE_ITERATIONS, options.max_iterations),
            tolerance=STAGE_TOLERANCE,
            align=options.align and result is None,
        )
        result = descend(first.pose, first.energy_measure, stage, result, callback)
        if result.status is Status.STOPPED:
            return result
        # As the full weight counts them, so that all energies of the history compare.
        history += tuple(_at_weight(entry, 1 / fraction) for entry in result.history)
    final = descend(
        first.pose, first.energy_measure, replace(options, align=False), result, callback
    )
    history += final.history
    numbered = tuple(replace(entry, iteration=i) for i, entry in enumerate(history, start=1))
    return replace(final, history=numbered)


def _at_weight(entry: Iteration, factor: float) -> Iteration:
    p2p = entry.energy_p2p * factor
    return replace(entry, energy_p2p=p2p, energy=entry.energy_iso + p2p)
