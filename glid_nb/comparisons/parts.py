"""Comparisons of the solver's parts (Figures 7, 8 and 9)."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from glid_nb._runtime import double_precision, single_blas_thread
from glid_nb.certificate import bdhm, derivative_bound_weights
from glid_nb.compare import run_method
from glid_nb.compare.subspace import SubspaceProblem
from glid_nb.comparisons import drawing
from glid_nb.comparisons.cases import Case
from glid_nb.comparisons.runs import display_mesh, run_recorded, summary
from glid_nb.comparisons.store import Measurement
from glid_nb.energies import SymmetricDirichlet
from glid_nb.geometry import panels_between, uniform_boundary_samples
from glid_nb.harmonic import HarmonicMap, basis_of, cauchy
from glid_nb.imaging.style import BLUE, GREEN, INK, LINE, ORANGE, SKY, SMALL
from glid_nb.solvers import Options
from glid_nb.solvers.discretisation import UNIFORM_SAMPLES

Array = NDArray[Any]

SEGMENTS = 529
"""Of Figure 7."""
HESSIAN_SAMPLES = (50, 100, 200, 400, 1_000, 10_000)
STAGES = ("gradient", "Hessian", "Cholesky", "line search")
_REPEATS = 7


def measure_lipschitz(case: Case, detail: Callable[[str], None]) -> Measurement:
    """Figure 7: both kinds of constants on one map, and Newton's method under either."""
    domain, pose = case.problem.domain, case.problem.pose
    runs = {}
    for name, loose in (("ours", False), ("bdhm", True)):
        detail(f"{case.name}: Newton with the constants of {name}")
        result = run_method(
            "newton-staged", domain, pose, align=False, loose_certificate=loose, max_iterations=100
        )
        runs[name] = {
            "status": result.status.value,
            "message": result.message,
            "energy": [step.energy for step in result.history],
            "iterations": result.iterations,
        }
    result = run_method("newton", domain, pose, align=False)
    assert isinstance(result.map, HarmonicMap)
    ours, theirs = lipschitz_constants(result.map, SEGMENTS)
    fine = [float(values.mean()) for values in lipschitz_constants(result.map, UNIFORM_SAMPLES)]
    return {
        "name": case.name,
        "runs": runs,
        "fine_means": fine,
        "arrays": {"ours": ours, "bdhm": theirs},
    }


@double_precision
def lipschitz_constants(map_: HarmonicMap, segments: int) -> tuple[Array, Array]:
    """Constants of ``f_z`` on about that many segments: the paper's (Section 8), and BDHM's."""
    samples = uniform_boundary_samples(map_.domain.cage, segments)
    panels = panels_between(samples.points, samples.loop)
    basis = basis_of(map_.domain)
    sing, start, end = basis.singularities, jnp.asarray(panels.start), jnp.asarray(panels.end)
    phi = jnp.asarray(basis.pad(map_.phi))[None]
    slope = np.abs(map_.wirtinger_derivatives(panels.start, 1)[0])
    jumps = jnp.abs(cauchy.slope_jumps(phi, sing))[0]
    curvature = np.asarray(derivative_bound_weights(start, end, sing, 2) @ jumps)
    ours = (slope + slope[panels.next]) / 2 + panels.length / 2 * curvature
    theirs = bdhm.constants(phi, bdhm.segment_weights(start, end, sing))[:, 0]
    return ours, np.asarray(theirs)


def measure_hessian_samples(case: Case, detail: Callable[[str], None]) -> Measurement:
    """Figure 8: Newton's method with fewer and fewer Hessian samples."""
    display = display_mesh(case, 500)
    runs = {}
    for count in HESSIAN_SAMPLES:
        detail(f"{case.name}: {count} Hessian samples")
        result, images = run_recorded(
            "newton-staged",
            case,
            display,
            display,
            iterates=False,
            hessian_samples=count,
            max_iterations=60,
        )
        runs[str(count)] = summary(result, images)
    return {"name": case.name, "runs": runs, "arrays": {}}


@double_precision
def measure_stages(case: Case, detail: Callable[[str], None]) -> Measurement:
    """Figure 9: seconds of the four stages of one iteration, the paper's sampling.

    The stages are run one by one, a step into the solve. The line search's program also evaluates
    the new point, whose time is taken off it.
    """
    detail(f"{case.name}: stages")
    options = Options(sampling="uniform", certificate="lipschitz", align=False)
    problem = SubspaceProblem(case.problem.domain, case.problem.pose, SymmetricDirichlet(), options)
    point = problem.evaluate(problem.start)
    seconds: dict[str, float] = {}
    with single_blas_thread():
        for _ in range(2):
            h = problem.hessian(point, "projected") + problem.p2p_hessian
            direction = _newton_step(h, np.asarray(point.gradient))
            before = point
            point = problem.advance(point, direction, False).point
        stages: dict[str, Callable[[], Any]] = {
            "gradient": lambda: problem.evaluate(np.asarray(before.coefficients)),
            "Hessian": lambda: problem.hessian(before, "projected"),
            "Cholesky": lambda: _newton_step(h, np.asarray(before.gradient)),
            "line search": lambda: problem.advance(before, direction, False),
        }
        for name, run in stages.items():
            taken = []
            for _ in range(_REPEATS):
                began = time.perf_counter()
                jax.block_until_ready(run())
                taken.append(time.perf_counter() - began)
            seconds[name] = float(np.median(taken))
    seconds["line search"] = max(seconds["line search"] - seconds["gradient"], 0.0)
    unknowns = 4 * case.problem.domain.n_coefficients - 10 * case.problem.domain.n_holes - 2
    return {"name": case.name, "unknowns": unknowns, "seconds": seconds, "arrays": {}}


def _newton_step(h: Array, gradient: Array) -> Array:
    factor = scipy.linalg.cho_factor(h, lower=True, check_finite=False)
    return -scipy.linalg.cho_solve(factor, gradient, check_finite=False)


def draw_lipschitz(cases: list[Measurement], path: Path) -> None:
    """The constants on all segments of the first shape, and the energies of all."""
    figure = drawing.figure(10.0, 3.0)
    axes = figure.subplots(1, 1 + len(cases), width_ratios=(1.5, *(1,) * len(cases)))
    for name, label, color in (("bdhm", "BDHM", INK), ("ours", "paper, Section 8", BLUE)):
        values = cases[0]["arrays"][name]
        axes[0].semilogy(values, color=color, lw=0.8, label=f"{label} (mean {values.mean():.2f})")
    drawing.label_axes(axes[0], "segment", "Lipschitz constant of $f_z$", cases[0]["name"])
    axes[0].legend(fontsize=SMALL, frameon=False)
    for ax, data in zip(axes[1:], cases, strict=True):
        for name, label, color in (("bdhm", "BDHM", INK), ("ours", "paper, Section 8", BLUE)):
            energy = drawing.gap(data["runs"][name]["energy"])
            ax.semilogy(energy, color=color, lw=LINE, label=label, marker=".", ms=3)
            if data["runs"][name]["status"] == "blocked":
                ax.plot(len(energy) - 1, energy[-1], "x", color=color, ms=7)
        drawing.label_axes(ax, "iteration", "energy", data["name"])
        ax.legend(fontsize=SMALL, frameon=False)
    drawing.save(figure, path)


def draw_hessian_samples(data: Measurement, path: Path) -> None:
    """Energy above the least against iterations and time."""
    figure = drawing.figure(9.0, 3.0)
    axes = figure.subplots(1, 2)
    colors = (ORANGE, SKY, GREEN, "#cc79a7", BLUE, INK)
    least = min(drawing.gap(run["energy"]).min() for run in data["runs"].values())
    for (count, run), color in zip(data["runs"].items(), colors, strict=False):
        excess = drawing.gap(run["energy"]) / least - 1
        keep = excess > 1e-12
        label = f"{int(count):,}"
        axes[0].semilogy(np.flatnonzero(keep), excess[keep], color=color, lw=LINE, label=label)
        axes[1].semilogy(
            1e3 * np.array(run["time"])[keep], excess[keep], color=color, lw=LINE, label=label
        )
    axes[1].set_xscale("log")
    drawing.label_axes(axes[0], "iteration", "relative energy gap", data["name"])
    drawing.label_axes(axes[1], "milliseconds", "relative energy gap")
    axes[0].legend(fontsize=SMALL, frameon=False, title="Hessian samples", title_fontsize=SMALL)
    drawing.save(figure, path)


def draw_stages(cases: list[Measurement], path: Path) -> None:
    """Bars of the four stages for each shape."""
    figure = drawing.figure(9.0, 3.0)
    axes = figure.subplots()
    place = np.arange(len(cases))
    for i, (stage, color) in enumerate(zip(STAGES, (SKY, BLUE, ORANGE, GREEN), strict=True)):
        values = [1e3 * data["seconds"][stage] for data in cases]
        axes.bar(place + 0.2 * (i - 1.5), values, 0.19, color=color, label=stage)
    axes.set_xticks(place, [f"{d['name']}\n{d['unknowns']}" for d in cases], fontsize=SMALL)
    drawing.label_axes(axes, "shape and unknowns", "milliseconds")
    axes.legend(fontsize=SMALL, frameon=False, ncols=4)
    drawing.save(figure, path)
