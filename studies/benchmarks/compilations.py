"""How many programs are compiled when something about a solved problem changes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from glid_nb._runtime import compilation_clock
from glid_nb.energies import ExponentialSymmetricDirichlet
from glid_nb.solvers import Options, Pose, Result, solve
from studies.benchmarks.shapes import flower, ring_of_handles

_VERTICES = 50
_HANDLES, _FULL_BUCKET = 4, 8
_MOVE = 0.05


def count_compilations() -> dict[str, dict[str, int]]:
    """Programs compiled (or loaded) by each change, after one solve and one drag step."""
    domain, options = flower(_VERTICES, 0), Options(restarts=0)
    pose = ring_of_handles(_HANDLES)
    moved = Pose(pose.handles, pose.targets + _MOVE)
    energies = [ExponentialSymmetricDirichlet(s) for s in (1.0, 2.0)]
    first = solve(domain, pose, None, options)
    solve(domain, moved, None, options, first)
    solve(domain, pose, energies[0], options)
    _split(first, 0)

    actions: dict[str, Callable[[], Any]] = {
        "targets moved": lambda: solve(domain, moved, None, options),
        "a drag step": lambda: solve(domain, moved, None, options, first),
        f"handles added, {_HANDLES} to {_FULL_BUCKET}": lambda: solve(
            domain, ring_of_handles(_FULL_BUCKET), None, options
        ),
        "panels split, within their room": lambda: solve(
            domain, moved, None, options, _split(first, 2)
        ),
        "an energy's parameter changed": lambda: solve(domain, pose, energies[1], options),
    }
    clock, counts = compilation_clock(), {}
    for name, action in actions.items():
        before = clock.programs
        action()
        counts[name] = clock.programs - before
    return {"counts": counts}


def _split(result: Result, place: int) -> Result:
    """The result on a boundary with two panels split."""
    chosen = np.zeros(result.n_panels, dtype=bool)
    chosen[place : place + 2] = True
    return replace(result, discretisation=result.discretisation.refined(chosen))
