"""Time per iteration, to convergence, and of a drag step, with the paper's settings and ours."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from glid_nb.figures.style import BLUE, INK, SKY, SMALL
from glid_nb.harmonic.basis import basis_of
from glid_nb.minima import solve
from glid_nb.pose import Pose
from glid_nb.samples import names
from glid_nb.solvers import Options, Result
from glid_nb.solvers.discretisation import discretise
from studies import figures
from studies.bench.stages import measure_stages
from studies.cases import Case
from studies.store import Measurement
from studies.study import Plan, Study, on_cases
from studies.tables import Row, digits, percent
from studies.timing import Timing, timed, timed_in_turn

GAP, DRAG_GAP = 1e-6, 1e-4
"""Relative distances to the converged energy at which a solve and a drag step count as done."""
DRAG = 0.01
"""How far a target moves in a drag step, in diagonals of the shape's bounding box."""

PAPER, DEFAULT, ALIGNED = "paper", "default", "paper-aligned"
MODES = {PAPER: Options.paper(), DEFAULT: Options(restarts=0), ALIGNED: Options.paper(align=True)}
"""``paper-aligned`` has the start of ``default``, so only the method differs."""

_MAKING_REPEATS = 3
_BAR = 0.36


def bench_cases(plan: Plan) -> list[str]:
    """The reference problems, or the bundled samples in their gentle poses."""
    return list(plan.references) or [f"{name}-gentle" for name in names()]


def iterations_to(result: Result, gap: float) -> int:
    """Iterations after which the energy is within ``gap`` of the last one, relatively."""
    energies = np.array([entry.energy for entry in result.history])
    return 1 + int(np.argmax(energies <= result.energy * (1 + gap)))


def measure(case: Case, plan: Plan) -> Measurement:
    """Solves by each mode until the energy is within :data:`GAP` of its minimum, and a drag step.

    The modes are timed in turn. ``to_gap`` is the time of a whole call of ``solve`` with the needed
    number of iterations, if the domain's matrices exist. ``making`` is the time to make the
    matrices, ``before`` that of a call without iterations, ``stages`` that of each stage. The
    minimum is that of each mode's own discrete energy.
    """
    domain, pose, repeats = case.problem.domain, case.problem.pose, plan.repeats
    whole = {mode: solve(domain, pose, None, options) for mode, options in MODES.items()}
    counts = {mode: iterations_to(result, GAP) for mode, result in whole.items()}

    def limited(most: dict[str, int]) -> dict[str, Timing]:
        def call(mode: str) -> Callable[[], Any]:
            options = replace(MODES[mode], max_iterations=most[mode])
            return lambda: solve(domain, pose, None, options)

        return timed_in_turn({mode: call(mode) for mode in whole}, repeats)

    to_gap, before = limited(counts), limited(dict.fromkeys(whole, 0))
    modes = {
        mode: {
            "to_gap": to_gap[mode],
            "before": before[mode],
            **_about(case, mode, result, counts[mode], repeats),
        }
        for mode, result in whole.items()
    }
    return {**modes, "drag": drag_step(case, whole[DEFAULT], repeats)}


def _about(case: Case, mode: str, whole: Result, count: int, repeats: int) -> dict[str, Any]:
    """The results of one mode's solve of ``count`` iterations, and further times."""
    domain, options, history = case.problem.domain, MODES[mode], whole.history[:count]
    certificate = whole.certificate
    assert certificate is not None

    def make() -> None:
        basis_of.__wrapped__(domain)
        discretise.__wrapped__(domain, options.sampling, options.certificate)

    return {
        "name": case.name,
        "mode": mode,
        "unknowns": whole.n_unknowns,
        "panels": whole.n_panels,
        "iterations": count,
        "corrections": sum(entry.corrections or 0 for entry in history),
        "energy": whole.energy,
        "certified": certificate.certified,
        "making": timed(make, min(repeats, _MAKING_REPEATS)),
        "stages": measure_stages(whole, 3 * repeats),
        "modified": float(np.mean([bool(entry.hessian_modified) for entry in history])),
    }


def tables(found: list[Measurement]) -> dict[str, list[Row]]:
    """Iterations, energies and times by shape; and the times of an iteration's stages."""
    return {
        "solves": [_solve_row(data) for data in found],
        "breakdown": [_breakdown_row(data[mode]) for data in found for mode in (PAPER, DEFAULT)],
    }


def _per_iteration(solve: Measurement, part: str = "median") -> float:
    """Mean seconds of a solve's iterations."""
    return solve["to_gap"][part] / solve["iterations"]


def _solve_row(data: Measurement) -> Row:
    paper, default, aligned = (data[mode] for mode in (PAPER, DEFAULT, ALIGNED))
    time = {mode: 1e3 * data[mode]["to_gap"]["median"] for mode in MODES}
    return {
        "shape": default["name"],
        "unknowns": default["unknowns"],
        "iterations, paper / aligned / default": " / ".join(
            str(solve["iterations"]) for solve in (paper, aligned, default)
        ),
        "energy, paper / default": f"{paper['energy']:.4f} / {default['energy']:.4f}",
        "paper, ms": time[PAPER],
        "default, ms": time[DEFAULT],
        "ratio": digits(time[PAPER] / time[DEFAULT], 2),
        "ratio, paper aligned": digits(time[ALIGNED] / time[DEFAULT], 2),
        "per iteration, paper / default, ms": " / ".join(
            digits(1e3 * _per_iteration(solve)) for solve in (paper, default)
        ),
        "matrices, ms": 1e3 * default["making"]["median"],
        "drag step, ms": digits(1e3 * data["drag"]["time"]["median"], 2),
    }


def _breakdown_row(solve: Measurement) -> Row:
    return {
        "shape": solve["name"],
        "settings": solve["mode"],
        "iteration, ms": 1e3 * _per_iteration(solve),
        **{f"{n}, ms": digits(1e3 * t, 2) for n, t in solve["stages"].items()},
        "call, ms": digits(1e3 * solve["before"]["median"], 2),
        "K+": percent(solve["modified"]),
    }


def draw(found: list[Measurement], folder: Path) -> None:
    """Bars of the measured time per iteration, with quartiles."""
    pairs = [(data[PAPER], data[DEFAULT]) for data in found]
    figure = figures.figure(9.0, 3.2)
    axes: Any = figure.subplots()
    place = np.arange(len(pairs))
    for i, (mode, color) in enumerate(((PAPER, SKY), (DEFAULT, BLUE))):
        x = place + (i - 0.5) * _BAR
        middle, *ends = (
            np.array([_per_iteration(pair[i], part) for pair in pairs])
            for part in ("median", "low", "high")
        )
        spread = np.abs(np.array(ends) - middle)
        axes.bar(x, 1e3 * middle, 0.94 * _BAR, color=color, label=mode)
        axes.errorbar(x, 1e3 * middle, 1e3 * spread, fmt="none", ecolor=INK, elinewidth=0.7)
    axes.set_xticks(place, [f"{p['name']}\n{p['unknowns']}" for p, _ in pairs])
    figures.label_axes(axes, "shape and unknowns", "ms per iteration")
    axes.legend(fontsize=SMALL, frameon=False, ncols=3)
    axes.set_ylim(top=1.25 * axes.get_ylim()[1])
    figures.save(figure, folder / "solves.webp")


def drag_step(
    case: Case, before: Result, repeats: int, budget: float = float("inf")
) -> dict[str, Any]:
    """Move one target by :data:`DRAG` from the converged map; solve to within :data:`DRAG_GAP`."""
    domain, pose = case.problem.domain, case.problem.pose
    xmin, ymin, xmax, ymax = domain.cage.bounds
    targets = pose.targets.copy()
    targets[0, 0] += DRAG * float(np.hypot(xmax - xmin, ymax - ymin))
    moved = Pose(pose.handles, targets)
    whole = solve(domain, moved, None, MODES[DEFAULT], before)
    count = iterations_to(whole, DRAG_GAP)
    limited = replace(MODES[DEFAULT], max_iterations=count)
    return {
        "iterations": count,
        "time": timed(lambda: solve(domain, moved, None, limited, before), repeats, 1, budget),
    }


STUDY = Study("solves", on_cases(bench_cases, measure), tables, draw)
