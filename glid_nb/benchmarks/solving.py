"""Time per iteration, to convergence and of a drag step: the paper's settings and ours."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from glid_nb.benchmarks.machine import floor
from glid_nb.benchmarks.timing import scaled, timed
from glid_nb.comparisons.cases import Case
from glid_nb.solvers import Options, Pose, Result, solve

GAP, DRAG_GAP = 1e-6, 1e-4
"""Relative distances to the converged energy at which a solve and a drag step count as done."""
DRAG = 0.01
"""How far a target moves in a drag step, in diagonals of the shape's bounding box."""

MODES = {"paper": Options.paper(), "default": Options(restarts=0)}


def iterations_to(result: Result, gap: float) -> int:
    """Iterations after which the energy is within ``gap`` of the last one, relatively."""
    energies = np.array([entry.energy for entry in result.history])
    return 1 + int(np.argmax(energies <= result.energy * (1 + gap)))


def measure_solve(case: Case, mode: str, repeats: int) -> dict[str, Any]:
    """From the identity until the energy is within :data:`GAP` of its minimum.

    The time is that of a whole call of ``solve`` for so many iterations, with the domain's
    matrices at hand (their making is timed apart); per iteration it is that time shared evenly.
    """
    domain, pose = case.problem.domain, case.problem.pose
    whole = solve(domain, pose, None, MODES[mode])
    count = iterations_to(whole, GAP)
    limited = _limited(MODES[mode], count)
    timing = timed(lambda: solve(domain, pose, None, limited), repeats)
    return {
        "name": case.name,
        "mode": mode,
        "unknowns": whole.n_unknowns,
        "vertices": len(np.concatenate(domain.cage.loops)),
        "panels": whole.n_panels,
        "split": whole.panels_split,
        "iterations": count,
        "energy": whole.energy,
        "certified": whole.certificate.certified,
        "to_gap": timing,
        "per_iteration": scaled(timing, 1 / count),
        "floor": floor(whole.discretisation.matrices, whole.n_unknowns),
        "modified": float(np.mean([e.hessian_modified for e in whole.history[:count]])),
    }


def measure_drag(case: Case, repeats: int) -> dict[str, Any]:
    """One target moved by :data:`DRAG`, from the converged map, to within :data:`DRAG_GAP`."""
    domain, pose = case.problem.domain, case.problem.pose
    before = solve(domain, pose, None, MODES["default"])
    xmin, ymin, xmax, ymax = domain.cage.bounds
    targets = pose.targets.copy()
    targets[0, 0] += DRAG * float(np.hypot(xmax - xmin, ymax - ymin))
    moved = Pose(pose.handles, targets)
    whole = solve(domain, moved, None, MODES["default"], before)
    count = iterations_to(whole, DRAG_GAP)
    limited = _limited(MODES["default"], count)
    timing = timed(lambda: solve(domain, moved, None, limited, before), repeats)
    return {
        "name": case.name,
        "iterations": count,
        "time": timing,
        "certified": whole.certificate.certified,
    }


def _limited(options: Options, count: int) -> Options:
    return replace(options, max_iterations=count)
