"""Figure 9."""

from __future__ import annotations

from studies.comparisons.page.words import joined, spread, table
from studies.comparisons.stages import STAGES
from studies.comparisons.store import Measurement


def section(cases: list[Measurement], figures: str) -> list[str]:
    """The stages, without a verdict: the paper names no number to judge by."""
    rows, shares = [], {stage: [] for stage in STAGES}
    for d in cases:
        seconds = d["seconds"]
        rows.append(
            [d["name"], str(d["unknowns"]), *(f"{1e3 * seconds[stage]:.2f}" for stage in STAGES)]
        )
        for stage in STAGES:
            shares[stage].append(100 * seconds[stage] / sum(seconds.values()))
    largest = {max(STAGES, key=d["seconds"].__getitem__) for d in cases}
    return [
        "## Balance of the four stages (Figure 9)",
        "",
        f"![stages]({figures}/stages.png)",
        "",
        *table(["shape", "unknowns", *(f"{s}, ms" for s in STAGES)], rows),
        "",
        "The stages of the paper's solver (10,000 samples, 1,000 of them for the Hessian), run one "
        'by one. The paper calls its GPU solver "well balanced with respect to the four different '
        'stages" and draws bars without numbers. On this CPU the shares of an iteration are: '
        f"{', '.join(f'{stage} {spread(values, 0)}%' for stage, values in shares.items())}; "
        f"the largest stage is {joined([f'the {stage}' for stage in STAGES if stage in largest])}, "
        f"{'on every shape' if len(largest) == 1 else 'by shape'}. The times are of single "
        "iterates, so that they do not add up to Table 2's means "
        "over a run, and the evaluation of the new map counts as gradient, not as line search. "
        "**Not judged:** there is no number to judge by, and the claim is about a GPU.",
    ]
