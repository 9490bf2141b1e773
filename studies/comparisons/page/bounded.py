"""Figure 2."""

from __future__ import annotations

from collections.abc import Sequence

from glid_nb.methods.bdhm.samples import MARGIN
from studies.comparisons import paper
from studies.comparisons.bounded import BOUNDS, WITHIN
from studies.comparisons.page.words import ended, joined, name_of, numbers, table, verdict
from studies.comparisons.store import Measurement
from studies.comparisons.units import seconds

_NAMES = ("k", "sigma_1", "sigma_2")
_TITLES = {"bdhm": "BDHM, the paper's bounds", "tight": "BDHM, tighter bounds"}


def section(cases: list[Measurement], figures: str) -> list[str]:
    """The maps' bounds, and how long each took."""
    (data,) = cases
    runs = data["runs"]
    ours = runs["newton"]
    rows = []
    kept, ratios, binding = [], [], {}
    for name, asked in BOUNDS.items():
        run = runs[name]
        kept.append(run["certified"] and holds(run["bounds"], asked))
        ratios.append(run["time"][-1] / ours["time"][-1])
        binding[name] = bound_by(run["bounds"], asked)
        rows.append(
            [
                _TITLES[name],
                numbers(asked),
                numbers(run["bounds"]),
                joined(binding[name]),
                ended(run),
                seconds(run["time"][-1]),
                f"{ratios[-1]:.0f}x",
            ]
        )
    rows.append(
        ["ours", "none", numbers(ours["bounds"]), "", ended(ours), seconds(ours["time"][-1]), "1x"]
    )
    bdhm_iterations, our_iterations = paper.FIGURE_2_ITERATIONS
    bdhm_seconds, our_seconds = paper.FIGURE_2_SECONDS
    said = joined(bound_by(paper.FIGURE_2["bdhm"], paper.FIGURE_2["asked"]))
    rows += [
        [
            "*paper, BDHM*",
            f"*{numbers(paper.FIGURE_2['asked'])}*",
            f"*{numbers(paper.FIGURE_2['bdhm'])}*",
            f"*{said}*",
            f"*converged after {bdhm_iterations}*",
            f"*{seconds(bdhm_seconds)}*",
            f"*{paper.FIGURE_2_RATIO}x*",
        ],
        [
            "*paper, ours*",
            "*none*",
            f"*{numbers(paper.FIGURE_2['newton'])}*",
            "",
            f"*converged after {our_iterations}*",
            f"*{seconds(our_seconds)}, GPU*",
            "*1x*",
        ],
    ]
    stopped = [_TITLES[name] for name in BOUNDS if runs[name]["status"] != "converged"]
    # Bounds that do not bind would show nothing, nor would the time of a run that did not arrive.
    claim = all(kept) and min(ratios) > 1 and all(binding.values()) and not stopped
    beyond = exceeded(ours["bounds"], BOUNDS["tight"])
    bound = joined(binding["bdhm"])
    return [
        "## Bounded distortion harmonic maps (Figure 2)",
        "",
        f"![BDHM]({figures}/bounded.png)",
        "",
        f"On {name_of(data['name'])}, after the rigid alignment; bounds are (k, sigma_1, sigma_2), "
        "those reached are proved on the whole domain.",
        "",
        *table(
            ["method", "asked", "reached", "binding", "iterations", "time", "time / ours"], rows
        ),
        "",
        f"A bound binds where the map uses {100 * WITHIN:.0f}% of the way from an isometry to it. "
        f"Of the paper's bounds {_where(bound, said)}; of the tighter ones "
        f"{joined(binding['tight'])}. Both of BDHM's maps are proved to keep their bounds"
        f"{'' if all(kept) else ', but for one'}, and ours, asked for nothing, takes "
        f"{ours['iterations']} iterations; of the tighter bounds it exceeds {joined(beyond)}. "
        f"{verdict(claim, any(kept))}",
        "",
        "BDHM's energy falls with every iteration, each of which proves its map; it counts as "
        "converged when the dual of its cone program leaves less to gain than "
        f"{data['tolerance']:g} of the energy"
        f"{', which it did not reach here: ' + joined(stopped) if stopped else ''}. The paper does "
        "not say when it stops, so iterations and times depend on that choice. Its bounds are "
        f"asked {100 * MARGIN:g}% stricter of samples, for what happens between them. The two "
        "minimise different energies, ARAP and symmetric Dirichlet, and both run on the CPU, "
        "BDHM's cone programs by Clarabel.",
    ]


def _where(here: str, paper_says: str) -> str:
    if here == paper_says:
        return f"{here} binds, here as in the paper"
    return f"{here} binds here and {paper_says} in the paper"


def holds(reached: list[float], asked: tuple[float, float, float]) -> bool:
    """Whether bounds that are proved are within those that were asked for."""
    return not exceeded(reached, asked)


def exceeded(reached: list[float], asked: tuple[float, float, float]) -> list[str]:
    """The bounds that a map is not proved to keep."""
    within = (reached[0] <= asked[0], reached[1] <= asked[1], reached[2] >= asked[2])
    return [name for name, so in zip(_NAMES, within, strict=True) if not so]


def bound_by(reached: Sequence[float], asked: tuple[float, float, float]) -> list[str]:
    """The bounds that bind a map."""
    used = zip(_NAMES, shares(reached, asked), strict=True)
    return [name for name, share in used if share >= WITHIN]


def shares(reached: Sequence[float], asked: tuple[float, float, float]) -> list[float]:
    """The share of the way from an isometry to each bound."""
    isometry = (0.0, 1.0, 1.0)
    return [(r - i) / (a - i) for r, a, i in zip(reached, asked, isometry, strict=True)]
