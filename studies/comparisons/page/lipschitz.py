"""Figure 7."""

from __future__ import annotations

from typing import Any

from studies.comparisons import paper
from studies.comparisons.page.words import briefly, joined, spread, table, verdict
from studies.comparisons.store import Measurement


def section(cases: list[Measurement], figures: str) -> list[str]:
    """The constants, and what loose ones do to Newton's method."""
    means = [(d["arrays"]["ours"].mean(), d["arrays"]["bdhm"].mean()) for d in cases]
    ratios = [theirs / ours for ours, theirs in means]
    fine = [d["fine_means"][1] / d["fine_means"][0] for d in cases]
    shares = [float((d["arrays"]["ours"] <= d["arrays"]["bdhm"]).mean()) for d in cases]
    few = [len(d["arrays"]["ours"]) for d in cases]
    rows = [
        [
            d["name"],
            f"{segments:,}",
            f"{ours:.3f}",
            f"{theirs:.3f}",
            f"{ratio:.1f}x",
            f"{100 * share:.0f}%",
            f"{finer:.1f}x",
            _outcome(d["runs"]["ours"]),
            _outcome(d["runs"]["bdhm"]),
        ]
        for d, segments, (ours, theirs), ratio, share, finer in zip(
            cases, few, means, ratios, shares, fine, strict=True
        )
    ]
    stopped = [d["name"] for d in cases if d["runs"]["bdhm"]["status"] == "blocked"]
    claim = min(shares) == 1 and len(stopped) == len(cases)
    count = cases[0]["segments"]
    return [
        "## Lipschitz constants (Figure 7)",
        "",
        f"![Lipschitz constants]({figures}/lipschitz.png)",
        "",
        *table(
            [
                "shape",
                "segments",
                "mean, paper's",
                "mean, BDHM's",
                "BDHM's / paper's",
                "paper's is smaller on",
                f"the same on {count:,}",
                "Newton, paper's",
                "Newton, BDHM's",
            ],
            rows,
        ),
        "",
        "The last two columns are Newton's iterations with either's constants, and the energy at "
        "which it ended.",
        "",
        f"On {spread(few, 0)} segments (as many as {paper.FIGURE_7_SEGMENTS}, the paper's number, "
        "become when every edge has whole ones) the paper's constants are smaller by a factor of "
        f"{spread(ratios)} on average (paper: {paper.FIGURE_7_RATIO}, and on every segment). "
        f"{_why_not_smaller(cases, shares)}On the solver's {count:,} segments the factor is "
        f"{spread(fine)}.",
        "",
        f"Newton's method on {count:,} fixed segments stops early with BDHM's constants on "
        f"{joined(stopped)} of these shapes (paper: on {joined(paper.FIGURE_7_SHAPES)}; there is "
        f"no horse among ours). {_why_stopped(cases)} "
        f"{verdict(claim, min(ratios) > 1)}",
    ]


def _outcome(run: dict[str, Any]) -> str:
    return f"{briefly(run)} ({run['energy'][-1]:.4g})"


def _why_not_smaller(cases: list[Measurement], shares: list[float]) -> str:
    larger = [d for d, share in zip(cases, shares, strict=True) if share < 1]
    if not larger:
        return ""
    means = [d["perimeter"] / len(d["arrays"]["ours"]) for d in larger]
    lengths = joined(
        [
            f"on {d['name']} they are {mean:.2f} units long, {mean / d['offset']:.1f} times as "
            "long as the singularities of the basis are away"
            for d, mean in zip(larger, means, strict=True)
        ]
    )
    return (
        "Where it is larger, the segments are long: its second term is half a segment's length "
        "times a bound on |f_z''|, and so shrinks as segments do, which BDHM's bound does not; "
        f"{lengths}. "
    )


def _why_stopped(cases: list[Measurement]) -> str:
    """Whether BDHM's constants could prove the minimum itself, which the paper's do."""
    parts = []
    for d in cases:
        refused = d["refused"]["bdhm"]
        if refused:
            parts.append(
                f"on {d['name']} they leave {refused} of the segments unproved, so that map cannot "
                "be accepted"
            )
        else:
            parts.append(
                f"on {d['name']} they prove it on every segment, and nothing stands in the way"
            )
    return f"The minimum decides: {'; '.join(parts)}."
