"""What a method takes before its first iteration, once for a shape and its handles."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from glid_nb._runtime import compilation_clock
from glid_nb.geometry import Domain, triangulate
from glid_nb.session import Problem
from studies.comparisons.cases import Case
from studies.comparisons.runs import MESH_VERTICES, run

_REPEATS = 3


def preparation(method: str, case: Case, on_mesh: bool, vertices: int = MESH_VERTICES) -> float:
    """Median seconds from a cage and handles to a method that can begin, without compilation.

    A run without iterations, on a domain or a mesh made for it, less what its history counts.
    """
    taken = [_once(method, case, on_mesh, vertices) for _ in range(1 + _REPEATS)]
    return float(np.median(taken[1:]))  # the first run waits for programs that are compiled


def _once(method: str, case: Case, on_mesh: bool, vertices: int) -> float:
    domain, pose = case.problem.domain, case.problem.pose
    parts = domain.to_dict()
    settings: dict[str, Any] = {}
    clock = compilation_clock()
    compiling, began = clock.seconds, time.perf_counter()
    if on_mesh:
        settings["triangulation"] = triangulate(domain.cage, vertices, points=pose.handles)
    else:
        # A file may bring its offset cage, which somebody had to choose.
        Domain.from_cage(domain.cage, case.offset)
        # What is kept of a domain is kept for that object, so that another one begins anew.
        domain = Domain.from_dict(parts)
    result = run(method, Case(case.name, Problem(domain, pose)), max_iterations=0, **settings)
    elapsed = time.perf_counter() - began - (clock.seconds - compiling)
    return max(elapsed - result.solve_time, 0.0)
