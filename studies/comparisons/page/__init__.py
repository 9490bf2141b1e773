"""The page of comparisons: figures, tables and what became of each claim of the paper.

Its text is written from the measurements: a reason is given where the numbers that show it are.
"""

from __future__ import annotations

import os
import platform
from collections.abc import Callable

from studies.comparisons.page import (
    bounded,
    conformal,
    exponential,
    folding,
    hessian_samples,
    iteration_times,
    lipschitz,
    progress,
    stages,
)
from studies.comparisons.runs import MESH_VERTICES
from studies.comparisons.store import Measurement

Results = dict[str, list[Measurement]]

_SECTIONS: dict[str, Callable[[list[Measurement], str], list[str]]] = {
    "progress": progress.section,
    "iteration-times": iteration_times.section,
    "bounded": bounded.section,
    "conformal": conformal.section,
    "exponential": exponential.section,
    "lipschitz": lipschitz.section,
    "hessian-samples": hessian_samples.section,
    "stages": stages.section,
    "folding": folding.section,
}


def page(results: Results, figures: str) -> str:
    """The page in Markdown; ``figures`` is the folder of the pictures relative to it."""
    lines = [
        "# Comparisons",
        "",
        "Written by `glid-nb compare`; do not edit. With `--reference DIR` its shapes are those of "
        "the problem files in DIR, by default bundled samples. The numbers of one shape in one "
        "section were measured in one run, without compilation times; all runs were on one machine "
        f"with {os.cpu_count()} CPU cores ({platform.machine()}). The paper's times are from a "
        "6-core Xeon with a Titan X, so only ratios within a row compare. Where this page names no "
        "number of the paper, the paper gives none.",
        "",
        "All methods start from the identity with lambda = 1e5 unless stated otherwise. Harmonic "
        f"maps are certified at every iteration; methods on a mesh have one of "
        f"{MESH_VERTICES:,} vertices with the handles among them, SLIM with the same lambda, AQP "
        "with hard constraints.",
        "",
    ]
    for name, write in _SECTIONS.items():
        if name in results:
            lines += [*write(results[name], figures), ""]
    return "\n".join(lines)
