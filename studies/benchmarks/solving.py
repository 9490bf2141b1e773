"""Time per iteration, to convergence and of a drag step: the paper's settings and ours."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from glid_nb.harmonic.basis import build_basis
from glid_nb.solvers import Options, Pose, Result, solve
from glid_nb.solvers.discretisation import discretise
from studies.benchmarks.machine import floor
from studies.benchmarks.stages import measure_stages
from studies.benchmarks.timing import Timing, scaled, timed, timed_in_turn
from studies.comparisons.cases import Case

GAP, DRAG_GAP = 1e-6, 1e-4
"""Relative distances to the converged energy at which a solve and a drag step count as done."""
DRAG = 0.01
"""How far a target moves in a drag step, in diagonals of the shape's bounding box."""
SAME_ENERGY = 0.01
"""Relative difference up to which two energies count as of the same minimum."""

PAPER, DEFAULT, ALIGNED = "paper", "default", "paper-aligned"
MODES = {
    PAPER: Options.paper(),
    DEFAULT: Options(restarts=0),
    ALIGNED: Options.paper(align=True),
}
"""``paper-aligned`` begins where ``default`` does, and differs in the method alone."""

_MAKING_REPEATS = 3


def iterations_to(result: Result, gap: float) -> int:
    """Iterations after which the energy is within ``gap`` of the last one, relatively."""
    energies = np.array([entry.energy for entry in result.history])
    return 1 + int(np.argmax(energies <= result.energy * (1 + gap)))


def same_minimum(one: float, other: float) -> bool:
    """Whether two energies differ by no more than :data:`SAME_ENERGY` of the lower one."""
    return abs(one - other) <= SAME_ENERGY * min(one, other)


def measure_solves(
    case: Case, repeats: int, modes: Sequence[str] = (PAPER, DEFAULT, ALIGNED)
) -> dict[str, dict[str, Any]]:
    """From the identity until the energy is within :data:`GAP` of its minimum, by mode.

    The modes are timed in turn. ``to_gap`` is the time of a whole call of ``solve`` for so many
    iterations, with the domain's matrices at hand; ``per_iteration`` is that time shared evenly.
    ``making`` is that of making the matrices, ``before`` that of a call that takes no iteration,
    ``stages`` the stages' by themselves. The gap is to the minimum of each mode's own discrete
    energy.
    """
    domain, pose = case.problem.domain, case.problem.pose
    whole = {mode: solve(domain, pose, None, MODES[mode]) for mode in modes}
    counts = {mode: iterations_to(result, GAP) for mode, result in whole.items()}

    def limited(most: dict[str, int]) -> dict[str, Timing]:
        def call(mode: str) -> Callable[[], Any]:
            options = replace(MODES[mode], max_iterations=most[mode])
            return lambda: solve(domain, pose, None, options)

        return timed_in_turn({mode: call(mode) for mode in whole}, repeats)

    to_gap, before = limited(counts), limited(dict.fromkeys(whole, 0))
    return {
        mode: {
            "to_gap": to_gap[mode],
            "per_iteration": scaled(to_gap[mode], 1 / counts[mode]),
            "before": before[mode],
            **_about(case, mode, result, counts[mode], repeats),
        }
        for mode, result in whole.items()
    }


def _about(case: Case, mode: str, whole: Result, count: int, repeats: int) -> dict[str, Any]:
    """What there is to say about one mode's solve of ``count`` iterations, beside its times."""
    domain, options, history = case.problem.domain, MODES[mode], whole.history[:count]

    def make() -> None:
        build_basis(domain)
        discretise.__wrapped__(domain, options.sampling, options.certificate)

    return {
        "name": case.name,
        "mode": mode,
        "unknowns": whole.n_unknowns,
        "vertices": len(np.concatenate(domain.cage.loops)),
        "padded": 4 * len(whole.discretisation.basis.unknown_columns),
        "panels": whole.n_panels,
        "status": whole.status.value,
        "split": whole.panels_split,
        "iterations": count,
        "corrections": sum(entry.corrections for entry in history),
        "energy": whole.energy,
        "certified": whole.certificate.certified,
        "making": timed(make, min(repeats, _MAKING_REPEATS)),
        "floor": floor(
            whole.discretisation.matrices,
            whole.n_unknowns,
            1 + sum(entry.corrections for entry in history) / count,
        ),
        "stages": measure_stages(whole, 3 * repeats),
        "modified": float(np.mean([entry.hessian_modified for entry in history])),
    }


def measure_drag(case: Case, repeats: int) -> dict[str, Any]:
    """One target moved by :data:`DRAG`, from the converged map, to within :data:`DRAG_GAP`."""
    domain, pose = case.problem.domain, case.problem.pose
    before = solve(domain, pose, None, MODES[DEFAULT])
    xmin, ymin, xmax, ymax = domain.cage.bounds
    targets = pose.targets.copy()
    targets[0, 0] += DRAG * float(np.hypot(xmax - xmin, ymax - ymin))
    moved = Pose(pose.handles, targets)
    whole = solve(domain, moved, None, MODES[DEFAULT], before)
    count = iterations_to(whole, DRAG_GAP)
    limited = replace(MODES[DEFAULT], max_iterations=count)
    return {
        "name": case.name,
        "iterations": count,
        "corrections": sum(entry.corrections for entry in whole.history[:count]),
        "time": timed(lambda: solve(domain, moved, None, limited, before), repeats),
        "certified": whole.certificate.certified,
    }
