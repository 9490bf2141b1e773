"""What stands beside the speed: preparation, and the energies of the minima."""

from __future__ import annotations

from studies.comparisons.drawing import LOOK
from studies.comparisons.page.words import joined, spread, table
from studies.comparisons.progress import MESH
from studies.comparisons.runs import MESH_VERTICES
from studies.comparisons.store import Measurement
from studies.comparisons.units import seconds

_METHODS = ("newton", *MESH)
_SAME = 0.01
"""Means on one mesh that differ by no more, relatively, are those of one local minimum."""


def preparation(cases: list[Measurement]) -> list[str]:
    """What each method takes before it begins."""
    rows = [[d["name"], *(_prepared(d, m) for m in _METHODS), _start(d)] for d in cases]
    return [
        "**Preparation**",
        "",
        *table(["shape", "ours", *(LOOK[m][0] for m in MESH), "AQP's start"], rows),
        "",
        "Once for a shape and its handles, not in the times above, and without compilation: for "
        "ours the offset cage, the basis on the boundary's panels and at the handles, the "
        "certificate's bounds of it and the whitening; for SLIM and AQP the triangulation and its "
        "differential operators, for SLIM also libigl's precomputation and for AQP the "
        "factorisation of its Laplacian. SLIM factors anew in each iteration, which is in its "
        "times. AQP's start, ARAP projected onto maps without inverted triangles, is made for each "
        "pose, and so it is in the times above; the last column has it alone. Tracing a picture is "
        "in none.",
    ]


def energies(cases: list[Measurement]) -> list[str]:
    """The quality that the speed buys: distortion by area at each method's minimum."""
    rows, ratios = [], []
    for d in cases:
        ours, *others = (d["runs"].get(m, {}).get("area_mean") for m in _METHODS)
        least, ratio = _least(d), "-"
        if least is not None:
            ratios.append(ours / least)
            ratio = f"{ratios[-1]:.2f}x"
        means = (ours, *others)
        more = (d["area_mean_below_ours"], d["aligned"]["area_mean"])
        rows.append([d["name"], *map(_mean, means), ratio, *map(_mean, more)])
    heads = ["shape", "ours", *(LOOK[m][0] for m in MESH), "ours / the lower"]
    return [
        "**Distortion at the minimum**",
        "",
        *table([*heads, "mesh, from ours", "ours, aligned first"], rows),
        "",
        "The mean of E_iso over the shape's area, 2 for an isometry, for all on the same mesh and "
        "without the positional part: of the minimum of SLIM's and of AQP's energy on it (above; "
        "soft and hard constraints), exact for piecewise linear maps, and of our map from its own "
        "f_z and f_zbar in the middle of each triangle, weighted by its area.",
        "",
        f"{_compared(ratios)}The speed is that of another problem, not only of another solver. Our "
        f"map has {spread([d['unknowns'] for d in cases], 0)} unknowns, is smooth and proved "
        "injective everywhere, and what it minimises is the mean along the boundary. Theirs have "
        f"about {2 * MESH_VERTICES:,}, minimise what this table shows, bend at every edge if "
        "that is of use and crowd distortion around the handles, so that a lower energy is to be "
        "expected of them. *Mesh, from ours* is the minimum of SLIM's energy to which Newton's "
        f"method on the mesh comes from our map. {_basins(*_elsewhere(cases))}",
        "",
        "The last column is ours as it is by default, with the rigid alignment before the first "
        f"iteration{_aligned(cases)}.",
    ]


def other_minima(cases: list[Measurement]) -> list[str]:
    """Shapes on which ours and the methods on a mesh do not go to one local minimum."""
    elsewhere, lost = _elsewhere(cases)
    return [d["name"] for d in cases if d["name"] in (*elsewhere, *lost)]


def _elsewhere(cases: list[Measurement]) -> tuple[list[str], list[str]]:
    """Shapes where the mesh has another minimum below our map, and where none is found there."""
    elsewhere, lost = [], []
    for d in cases:
        below, least = d["area_mean_below_ours"], _least(d)
        if least is None:
            continue
        if below is None:
            lost.append(d["name"])
        elif abs(below / least - 1) > _SAME:
            elsewhere.append(d["name"])
    return elsewhere, lost


def _least(data: Measurement) -> float | None:
    """The lower mean of the methods on a mesh."""
    means = (data["runs"].get(m, {}).get("area_mean") for m in MESH)
    return min((mean for mean in means if mean is not None), default=None)


def _mean(value: float | None) -> str:
    return "-" if value is None else f"{value:.3f}"


def _aligned(cases: list[Measurement]) -> str:
    """What the alignment changes, shape by shape."""
    changed = []
    for d in cases:
        ours, aligned = d["runs"]["newton"]["area_mean"], d["aligned"]
        if abs(aligned["area_mean"] / ours - 1) > _SAME:
            changed.append(
                f"{d['name']} ends at {aligned['area_mean']:.3f} instead of {ours:.3f}, after "
                f"{aligned['iterations']} iterations instead of {d['runs']['newton']['iterations']}"
            )
    if not changed:
        return ", which changes none of the minima"
    return (
        f": {joined(changed)}. From the identity ours ends in a poor local minimum there, as the "
        "pictures above show, and the time to that one tells little; the other shapes end where "
        "they did"
    )


def _compared(ratios: list[float]) -> str:
    if not ratios:
        return ""
    lower = sum(ratio < 1 for ratio in ratios)
    return (
        f"Ours is at {spread(ratios, 2)} times the lower of theirs, and below it on "
        f"{lower or 'none'} of {len(ratios)} shapes. "
    )


def _basins(elsewhere: list[str], lost: list[str]) -> str:
    """Where ours and theirs do not belong to one local minimum."""
    text = "Where it is theirs, what lies between is the space's alone"
    if elsewhere:
        text += (
            f"; on {joined(elsewhere)} it is not, for there the methods went from the identity to "
            "different local minima (ours without the restarts that `solve` may make)"
        )
    if lost:
        text += f"; on {joined(lost)} it finds none from there, and the pictures above have to tell"
    return f"{text}."


def _prepared(data: Measurement, method: str) -> str:
    run = data["runs"].get(method)
    return "-" if run is None else seconds(run["preparation"])


def _start(data: Measurement) -> str:
    aqp = data["runs"].get("aqp")
    return "-" if aqp is None else seconds(aqp["step_time"][0])
