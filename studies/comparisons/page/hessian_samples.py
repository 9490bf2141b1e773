"""Figure 8."""

from __future__ import annotations

from studies.comparisons import paper
from studies.comparisons.page.words import briefly, table, verdict
from studies.comparisons.store import Measurement
from studies.comparisons.units import seconds

_SLACK = 1
"""Iterations by which two runs of one rate of convergence may differ."""


def section(cases: list[Measurement], figures: str) -> list[str]:
    """How many samples are enough, and why no fewer."""
    (data,) = cases
    runs = {int(count): run for count, run in data["runs"].items()}
    most, said = max(runs), paper.FIGURE_8_ENOUGH
    rows = [
        [
            f"{n:,}",
            f"{data['perimeter'] / n:.2g}",
            briefly(r),
            f"{r['energy'][-1]:.8g}",
            f"{r['contraction']['most']:.3g}",
            seconds(r["time"][-1]),
        ]
        for n, r in runs.items()
    ]
    alike = [
        n
        for n, r in runs.items()
        if r["status"] == "converged" and r["iterations"] <= runs[most]["iterations"] + _SLACK
    ]
    enough = min(n for n in alike if all(m in alike for m in runs if m >= n))
    slower = runs[most]["time"][-1] / runs[enough]["time"][-1]
    same = said in alike
    return [
        "## Number of Hessian samples (Figure 8)",
        "",
        f"![Hessian samples]({figures}/hessian-samples.png)",
        "",
        f"The paper's solver on {data['name']} with 10,000 energy samples, of which the Hessian's "
        "are some; so there are no more of them, and the paper's 50,000 are not measured.",
        "",
        *table(["samples", "spacing", "iterations", "energy", "largest eigenvalue", "time"], rows),
        "",
        "A `+` marks runs that had not converged when they were stopped.",
        "",
        f"From {enough:,} samples on there is at most {_SLACK} iteration more than with {most:,}, "
        f"which take {slower:.1f} times as long (paper: from {said} on that of "
        f"{paper.FIGURE_8_MOST:,}, which take {paper.FIGURE_8_SLOWER} times as long). "
        f"{verdict(same and slower > 1, slower > 1)}"
        f"{'' if same else ' ' + _why(data, said, most)}",
    ]


def _why(data: Measurement, said: int, most: int) -> str:
    runs = data["runs"]
    few, many = (runs[str(n)]["contraction"]["most"] for n in (said, most))
    return (
        f"The reason: {said} samples are {data['perimeter'] / said:.2f} units apart, while the "
        f"singularities of the basis are {data['offset']:.2f} from the boundary, so samples miss "
        "what is sharp in it. The table's largest eigenvalue is that of M^-1 H at the minimum, "
        f"with M the sampled Hessian and H the exact one: {few:.3g} against {many:.3g} of "
        f"{most:,}, so along one direction a Newton step is up to {few:.3g} times too long, and "
        "the line search has to shorten every step to it. The paper says neither which samples it "
        "takes nor how far its deer's cage is offset."
    )
