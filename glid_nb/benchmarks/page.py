"""The page of benchmarks, in Markdown."""

from __future__ import annotations

import statistics
from pathlib import Path
from typing import Any

import numpy as np

from glid_nb.benchmarks.solving import DRAG, DRAG_GAP, GAP
from glid_nb.benchmarks.timing import Timing

# What was tried for speed, with prediction and outcome.
_TRIED = Path(__file__).with_name("tried.md")


def page(results: dict[str, Any], figures: str) -> str:
    """The page; ``figures`` is the folder of the pictures relative to it."""
    machine = results["machine"]
    versions = ", ".join(f"{name} {v}" for name, v in machine["versions"].items())
    rates = machine["rates"]
    lines = [
        "# Benchmarks",
        "",
        "Written by `glid-nb bench`; do not edit. Medians with quartiles in brackets, all from one "
        "run, compilation left out.",
        "",
        f"Machine: {machine['processor']}, {machine['cores']} cores, {machine['system']}; "
        f"{', '.join(machine['devices'])}; Python {machine['python']}, {versions}. Its best matrix "
        f"product runs at {rates['float64'] / 1e9:.0f} Gflop/s in double and "
        f"{rates['float32'] / 1e9:.0f} in single precision, and it reads "
        f"{rates['bytes'] / 1e9:.0f} GB/s.",
        "",
        "`paper`: uniform samples (|G| = 10^4, |H| = 10^3), Lipschitz certificate, projected "
        "Hessian, from the identity, in our own code. `default`: ours.",
        "",
        *_solves(results["solves"]),
        "",
        *_floors(results["solves"]),
        "",
        *_drags(results["drags"]),
        "",
        *_start(results["start"]),
        "",
        *_scaling(results["scaling"], figures),
        "",
        *_batches(results["batches"]),
        "",
        _TRIED.read_text(encoding="utf-8"),
    ]
    return "\n".join(lines).rstrip() + "\n"


def _ms(timing: Timing) -> str:
    low, high = timing["low"] * 1e3, timing["high"] * 1e3
    return f"{timing['median'] * 1e3:.1f} ({low:.1f} to {high:.1f})"


def _table(head: list[str], rows: list[list[str]]) -> list[str]:
    return [
        "| " + " | ".join(head) + " |",
        "|" + " --- |" * len(head),
        *("| " + " | ".join(row) + " |" for row in rows),
    ]


def _pairs(solves: list[dict[str, Any]]) -> list[tuple[dict[str, Any], dict[str, Any]]]:
    by_mode = {
        mode: {s["name"]: s for s in solves if s["mode"] == mode} for mode in ("paper", "default")
    }
    return [(by_mode["paper"][name], by_mode["default"][name]) for name in by_mode["paper"]]


def _solves(solves: list[dict[str, Any]]) -> list[str]:
    pairs = _pairs(solves)
    ratios = [p["to_gap"]["median"] / d["to_gap"]["median"] for p, d in pairs]
    return [
        f"## From the identity to a relative energy gap of {GAP:g}, certified",
        "",
        *_table(
            [
                "shape",
                "n",
                "iterations paper / default",
                "paper, ms",
                "default, ms",
                "ratio",
                "per iteration paper, ms",
                "per iteration default, ms",
            ],
            [
                [
                    p["name"],
                    str(p["unknowns"]),
                    f"{p['iterations']} / {d['iterations']}",
                    _ms(p["to_gap"]),
                    _ms(d["to_gap"]),
                    f"{ratio:.1f}",
                    _ms(p["per_iteration"]),
                    _ms(d["per_iteration"]),
                ]
                for (p, d), ratio in zip(pairs, ratios, strict=True)
            ],
        ),
        "",
        f"`default` is {statistics.median(ratios):.1f} times faster in the median, "
        f"{min(ratios):.1f} times at least.",
    ]


def _floors(solves: list[dict[str, Any]]) -> list[str]:
    def row(s: dict[str, Any]) -> list[str]:
        parts = [s["floor"][name] for name in ("products", "hessian", "factor")]
        return [
            s["name"],
            s["mode"],
            *(f"{part * 1e3:.2f}" for part in parts),
            f"{sum(parts) * 1e3:.2f}",
            f"{s['per_iteration']['median'] / sum(parts):.1f}",
            f"{s['modified']:.0%}",
        ]

    return [
        "## The floor of one iteration on this machine, ms",
        "",
        "Reading the basis matrices from memory, the Hessian's matrix products at the best rate "
        "seen, and factor and solve as timed at that size. An iteration whose exact Hessian is not "
        "positive definite factors twice.",
        "",
        *_table(
            [
                "shape",
                "mode",
                "products",
                "Hessian",
                "factor",
                "sum",
                "measured / floor",
                "iterations with K+",
            ],
            [row(s) for s in solves],
        ),
    ]


def _drags(drags: list[dict[str, Any]]) -> list[str]:
    return [
        f"## A drag step: one target moved by {DRAG:.0%} of the shape, to a gap of {DRAG_GAP:g}",
        "",
        *_table(
            ["shape", "iterations", "ms"],
            [[d["name"], str(d["iterations"]), _ms(d["time"])] for d in drags],
        ),
    ]


def _start(start: dict[str, Any]) -> list[str]:
    return [
        "## First solve of the bundled gecko in a new process, seconds",
        "",
        *_table(
            ["", "import and trace", "first solve", "of it compiling", "second solve"],
            [
                [
                    name,
                    *(
                        f"{start[name][key]:.2f}"
                        for key in ("import_and_trace", "first_solve", "compiling", "second_solve")
                    ),
                ]
                for name in ("cold", "warm")
            ],
        ),
    ]


def _exponent(rows: list[dict[str, Any]], x: str, y: str) -> float:
    last = rows[-3:]
    if len(last) < 2:
        return float("nan")
    return float(np.polyfit(np.log([r[x] for r in last]), np.log([r[y] for r in last]), 1)[0])


def _scaling(scaling: dict[str, Any], figures: str) -> list[str]:
    vertices = scaling["vertices"]
    largest = vertices[-1]
    return [
        "## Scaling",
        "",
        f"![time and memory against sizes]({figures}/scaling.png)",
        "",
        f"Over its three largest cages the time per iteration grows with the power "
        f"{_exponent(vertices, 'vertices', 'per_iteration'):.1f} of the vertices: the Hessian's "
        "products grow with vertices squared times panels, the factorisation with their cube. A "
        f"cage of {largest['vertices']} vertices ({largest['unknowns']} unknowns, "
        f"{largest['panels']} panels) takes {largest['per_iteration'] * 1e3:.0f} ms per iteration "
        f"and {largest['memory'] / 2**30:.2f} GiB at most, Python and JAX included.",
    ]


def _batches(batches: dict[str, Any]) -> list[str]:
    return [
        f"## Batches: poses per second of {batches['name']}, {batches['devices']} device(s)",
        "",
        *_table(
            ["poses", "in a batch", "one by one"],
            [
                [str(r["poses"]), f"{r['per_second']:.1f}", f"{r['one_by_one']:.1f}"]
                for r in batches["rows"]
            ],
        ),
    ]
