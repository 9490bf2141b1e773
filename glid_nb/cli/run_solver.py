"""Solving with progress, and the report of it."""

from __future__ import annotations

from typing import Any

import glid_nb
from glid_nb.cli.progress import Progress


def run_solver(
    domain: glid_nb.Domain,
    pose: glid_nb.Pose,
    energy: glid_nb.Energy,
    options: glid_nb.Options,
    progress: Progress,
    start: glid_nb.HarmonicMap | None = None,
) -> tuple[glid_nb.Result, dict[str, Any]]:
    """The result and its report."""
    glid_nb.enable_compilation_cache()
    with progress.step("solving (new shapes are compiled first)") as detail:

        def show(state: glid_nb.Progress) -> None:
            last = state.history[-1]
            detail(f"iteration {last.iteration}, energy {last.energy:.6g}")

        result = glid_nb.solve(domain, pose, energy, options, start=start, callback=show)
    with progress.step("proving the result"):
        report = glid_nb.build_report(result)
    return result, report
