"""The paper's Lipschitz constants and BDHM's, and Newton's method under either (Figure 7)."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray

from glid_nb._runtime import double_precision
from glid_nb.certificate import BDHM, certify
from glid_nb.certificate.paper import derivative_bound_weights
from glid_nb.figures.style import BLUE, LINE, ORANGE, SMALL
from glid_nb.geometry import panels_between, uniform_boundary_samples
from glid_nb.harmonic import HarmonicMap, basis_of, cauchy
from glid_nb.solvers.discretisation import UNIFORM_SAMPLES
from studies.comparisons import drawing, paper
from studies.comparisons.cases import Case
from studies.comparisons.runs import outcome, run
from studies.comparisons.store import Measurement

Array = NDArray[Any]

_LINES = (("bdhm", "BDHM", ORANGE, 3.0), ("ours", "paper, Section 8", BLUE, 1.0))
"""Name, colour and width over the usual: the wide one is seen beneath the other."""
_MOST_ITERATIONS = 100


def measure(case: Case, detail: Callable[[str], None]) -> Measurement:
    """Both kinds of constants on one map, and Newton's method under either."""
    runs = {}
    for name, certificate in (("ours", "lipschitz"), ("bdhm", "bdhm")):
        detail(f"{case.name}: Newton with the Lipschitz constants of {name}")
        result = run(
            "newton-staged", case, certificate=certificate, max_iterations=_MOST_ITERATIONS
        )
        runs[name] = outcome(result)
    map_ = run("newton", case).map
    assert isinstance(map_, HarmonicMap)
    ours, theirs = lipschitz_constants(map_, paper.FIGURE_7_SEGMENTS)
    fine = [float(values.mean()) for values in lipschitz_constants(map_, UNIFORM_SAMPLES)]
    return {
        "name": case.name,
        "runs": runs,
        "fine_means": fine,
        "perimeter": case.perimeter,
        "offset": case.offset,
        "segments": UNIFORM_SAMPLES,
        "refused": {
            "ours": refused_segments(map_, "lipschitz"),
            "bdhm": refused_segments(map_, "bdhm"),
        },
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
    theirs = BDHM.on(start, end, sing).constants(phi, sing)[0]
    return ours, np.asarray(theirs)


def refused_segments(map_: HarmonicMap, constants: Any) -> int:
    """On how many of the solver's fixed segments a map is not proved locally injective."""
    samples = uniform_boundary_samples(map_.domain.cage, UNIFORM_SAMPLES)
    panels = panels_between(samples.points, samples.loop)
    proof = certify(map_, constants, panels, refine=False)
    return int((~(proof.panels.sigma2_lower > 0)).sum())


def draw(cases: list[Measurement], path: Path) -> None:
    """The constants on all segments of the first shape, and the energies of all."""
    figure = drawing.figure(10.0, 3.0)
    axes = figure.subplots(1, 1 + len(cases), width_ratios=(1.5, *(1,) * len(cases)))
    for name, label, color, width in _LINES:
        values = cases[0]["arrays"][name]
        axes[0].semilogy(
            values, color=color, lw=0.7 * width, label=f"{label} (mean {values.mean():.2f})"
        )
    drawing.label_axes(axes[0], "segment", "Lipschitz constant of $f_z$", cases[0]["name"])
    # Room for the legend above the data.
    axes[0].set_ylim(top=8 * max(cases[0]["arrays"][name].max() for name, *_ in _LINES))
    axes[0].legend(fontsize=SMALL, frameon=False, loc="upper right", ncols=2)
    for ax, data in zip(axes[1:], cases, strict=True):
        for name, label, color, width in _LINES:
            energy = drawing.values_of(data["runs"][name]["energy"])
            ax.semilogy(energy, color=color, lw=width * LINE, label=label, marker=".", ms=3)
            if data["runs"][name]["status"] == "blocked":
                ax.plot(len(energy) - 1, energy[-1], "x", color=color, ms=7)
        drawing.label_axes(ax, "iteration", "energy", data["name"])
        ax.legend(fontsize=SMALL, frameon=False)
    drawing.save(figure, path)
