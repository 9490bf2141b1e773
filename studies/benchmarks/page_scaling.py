"""The page's section on sizes: a table for each series, its exponents, and what explains them."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from studies.benchmarks.growth import exponent, local_exponents
from studies.benchmarks.markdown import ms
from studies.benchmarks.scaling import STEPS
from studies.comparisons.page.words import joined, table

Rows = list[dict[str, Any]]

_CLIFF = 0.75
"""An exponent this far above that of the fastest growing part of the work is a cliff."""


class _Series(NamedTuple):
    title: str
    by: str
    """The key that exponents are taken over."""
    name: str
    explanation: str


_SERIES = {
    "vertices": _Series(
        "Cage vertices",
        "vertices",
        "the vertices",
        "The Hessian's products grow with the vertices squared times the panels, the factorisation "
        "and the change to whitened coordinates with their cube: 3 is where the exponent goes. "
        "Small cages stay below it, for there the operations' start and the work on the panels "
        "weigh more. Where a cage has so many vertices that half its panels give fewer than 2.25 "
        "nodes for each column, the Hessian takes every panel or every node of the energy: a step "
        "in the nodes, not in the panels.",
    ),
    "holes": _Series(
        "Holes, three vertices each, in a cage with 40",
        "unknowns",
        "the unknowns",
        "Holes add vertices, and panels faster than vertices, because the boundary near a small "
        "hole is cut finely. A hole's first two coefficients are no unknowns and have no place in "
        "the Hessian, which has room for a power of two of holes, so that programs are shared.",
    ),
    "panels": _Series(
        "Panels, of one basis (edges of a cage with 100 vertices cut in pieces)",
        "panels",
        "the panels",
        "All products with the basis and the Hessian's assembly are linear in the panels, the "
        "factorisation does not know of them: the more panels, the closer the exponent should be "
        "to 1.",
    ),
    "handles": _Series(
        "Handles, in a cage with 100 vertices",
        "handles",
        "the handles",
        "An iteration reads one row per handle; their part of the Hessian, handles times unknowns "
        "squared, is made once in a call. Every tenth handle is moved, so that more handles are "
        "also a harder pose.",
    ),
}


def scaling(series: dict[str, Rows], picture: str) -> list[str]:
    """The section; empty without any series."""
    if not series:
        return []
    lines = [
        "## Scaling",
        "",
        f"![time and memory against sizes]({picture})",
        "",
        "Each size in a process of its own, a flower with a ring of handles, `default`. An "
        "iteration is equal work at every size, near a minimum, on a boundary whose panels need "
        "no further splitting, and without corrections: the "
        f"difference between calls with {STEPS} iterations and with none, divided by their number. "
        "The call is one without iterations. Exponents are between a size and the one before it; "
        "that of the work is of its fastest growing part: columns squared times nodes (the "
        "Hessian), columns cubed (the factorisation), columns times panels or handles (products), "
        "columns and nodes padded as they are. Memory is what the process held at most, "
        "corrections and all, Python and JAX included.",
    ]
    for name, about in _SERIES.items():
        if name in series:
            lines += ["", *_section(about, name, series[name])]
    if "mesh" in series:
        lines += ["", *_mesh(series["mesh"])]
    return lines


def _section(about: _Series, name: str, rows: Rows) -> list[str]:
    x = [row[about.by] for row in rows]
    times = [row["step"]["median"] for row in rows]
    local, work = local_exponents(x, times), _work_exponents(rows, x)
    columns = [] if name in ("vertices", "panels") else [name]
    return [
        f"### {about.title}",
        "",
        *table(
            [
                *columns,
                "vertices" if name == "vertices" else "panels",
                "unknowns" if name != "vertices" else "panels / unknowns",
                "iteration, ms",
                "exponent",
                "of the work",
                "call, ms",
                "memory, GB",
            ],
            [
                [
                    *(str(row[column]) for column in columns),
                    str(row["vertices" if name == "vertices" else "panels"]),
                    str(row["unknowns"])
                    if name != "vertices"
                    else f"{row['panels']} / {row['unknowns']}",
                    ms(row["step"]),
                    power,
                    of_work,
                    ms(row["before"]),
                    f"{row['memory'] / 1e9:.2f}",
                ]
                for row, power, of_work in zip(rows, _powers(local), _powers(work), strict=True)
            ],
        ),
        "",
        " ".join([*_statements(about, rows, x, local, work), about.explanation]),
    ]


def _powers(local: list[float]) -> list[str]:
    return ["", *(_power(value) for value in local)]


def _power(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.1f}"


def _work_exponents(rows: Rows, x: list[float]) -> list[float]:
    """Local exponents of the part of an iteration's work that grows fastest."""
    parts = (
        [row["coordinates"] ** 2 * row["nodes"] for row in rows],
        [row["coordinates"] ** 3 for row in rows],
        [row["columns"] * row["panels"] for row in rows],
        [row["columns"] * row["handles"] for row in rows],
    )
    local = [local_exponents(x, part) for part in parts]
    return [max(powers) for powers in zip(*local, strict=True)]


def _statements(
    about: _Series, rows: Rows, x: list[float], local: list[float], work: list[float]
) -> list[str]:
    if len(rows) < 2:
        return []
    times = [row["step"]["median"] for row in rows]
    found = [
        f"Over all sizes an iteration grows with the power {_power(exponent(x, times))} of "
        f"{about.name}, over the last two with {_power(local[-1])}."
    ]
    extra = [row["memory"] - rows[0]["memory"] for row in rows[-2:]]
    if min(extra) > 0 and x[-1] > x[-2]:
        power = _power(exponent(x[-2:], extra))
        found.append(f"Memory above that of the first size grows with the power {power} there.")
    beyond = [time - part for time, part in zip(local, work, strict=True)]
    worst = int(np.nanargmax([-np.inf, *beyond])) - 1
    modified = [str(row[about.by]) for row in rows if row["modified"]]
    if modified:
        found.append(
            f"At {joined(modified)} an exact Hessian was not definite and was factored twice."
        )
    found += [
        f"At {row[about.by]} the solve must split {row['split']} panels first, which takes "
        f"{1e3 * row['splitting']:.0f} ms beside its iterations: the matrices of the finer "
        "boundary are made anew, and the direction is searched once more."
        for row in rows
        if row["split"]
    ]
    if worst >= 0 and beyond[worst] > _CLIFF:
        found.append(
            f"**A cliff:** from {x[worst]:g} to {x[worst + 1]:g} the time grows with the power "
            f"{_power(local[worst])}, the work with {_power(work[worst])} at most."
        )
    else:
        found.append(
            f"There is no cliff in the sense that no exponent is more than {_CLIFF:g} above that "
            "of the fastest growing part of the work."
        )
    return found


def _mesh(rows: Rows) -> list[str]:
    x = [row["mesh_vertices"] for row in rows]
    parts = ("triangulate", "evaluate")
    times = {part: [row[part]["median"] for row in rows] for part in parts}
    powers = {part: _powers(local_exponents(x, times[part])) for part in parts}
    lines = [
        "### Display vertices, of a cage with 100 vertices",
        "",
        *table(
            [
                "display vertices",
                "triangulate, ms",
                "exponent",
                "evaluate the map, ms",
                "exponent",
                "memory, GB",
            ],
            [
                [
                    str(row["mesh_vertices"]),
                    ms(row["triangulate"]),
                    powers["triangulate"][i],
                    ms(row["evaluate"]),
                    powers["evaluate"][i],
                    f"{row['memory'] / 1e9:.2f}",
                ]
                for i, row in enumerate(rows)
            ],
        ),
    ]
    if len(rows) > 1:
        both = (_power(exponent(x, times[part])) for part in parts)
        lines += [
            "",
            "Over all sizes triangulation grows with the power {} and evaluation with {}: the "
            "map is evaluated in pieces of equal size, so that its memory does not grow with them; "
            "what grows is the mesh.".format(*both),
        ]
    return lines
