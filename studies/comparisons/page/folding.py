"""Linear methods, which fold."""

from __future__ import annotations

from typing import Any

from studies.comparisons.folding import METHODS
from studies.comparisons.page.words import joined, table
from studies.comparisons.store import Measurement
from studies.comparisons.units import percent


def section(cases: list[Measurement], figures: str) -> list[str]:
    """Counts of what is turned over."""
    names = [name for name in METHODS if any(name in d["methods"] for d in cases)]
    rows = [
        [d["name"], f"{d['triangles']:,}", *(_cell(d["methods"].get(name)) for name in names)]
        for d in cases
    ]
    linear = [name for name in names if name != "newton"]
    counts = {
        name: sum(d["methods"][name]["flips"] > 0 for d in cases if name in d["methods"])
        for name in linear
    }
    proved = sum(bool(d["methods"]["newton"]["proved"]) for d in cases)
    ours = sum(d["methods"]["newton"]["flips"] for d in cases)
    return [
        "## Linear methods fold",
        "",
        f"![folding]({figures}/folding.png)",
        "",
        "Poses as above. Triangles with a negative determinant are black, with a ring around each "
        "small group; sheets that lie over one another without being turned over show darker.",
        "",
        *table(
            ["shape", "triangles", *(METHODS[name][0] for name in names)],
            rows,
        ),
        "",
        "Turned-over triangles, and their share of the shape's area. These methods solve one "
        "linear system or none, and nothing in them looks at the determinant: "
        f"{joined([f'{METHODS[n][0]} fold on {counts[n]}' for n in linear])} of {len(cases)} "
        f"shapes. Ours turns over {ours or 'none'} and is proved locally injective on {proved} of "
        f"{len(cases)}, everywhere and not only at vertices of a mesh. Mean value coordinates "
        "have the polygon of the handles, by their angle about their mean, as cage, and are used "
        "outside it as well: with three handles they are one affine map, which the order of the "
        f"targets may turn over. {_conformal(cases)}",
    ]


def _cell(found: dict[str, Any] | None) -> str:
    if found is None:
        return "not installed"
    share = f" ({percent(found['share'])})" if found["flips"] else ""
    return f"{found['flips']:,}{share}"


def _conformal(cases: list[Measurement]) -> str:
    zeros = {d["name"]: d["methods"]["cauchy"]["zeros"] for d in cases}
    branched = [f"{name} ({count})" for name, count in zeros.items() if count]
    return (
        "The map by Cauchy coordinates has the cage of the shape, not the handles, as its own: it "
        "is the conformal map of our subspace whose handles come closest to their targets, as "
        "Cauchy coordinates are used since they were published, while a polygon of handles need "
        "not contain the shape. Being conformal, its determinant is never negative, and "
        "the few triangles that it turns over sit where its derivative vanishes. There it "
        "winds around itself like the square of z, which is no less a failure: its derivative has "
        f"zeros inside {joined(branched)}."
    )
