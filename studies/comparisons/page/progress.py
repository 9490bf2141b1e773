"""Figures 1, 10 and 11: iterations to convergence, and what decides them."""

from __future__ import annotations

from typing import Any

from studies.comparisons import paper
from studies.comparisons.drawing import LOOK
from studies.comparisons.page import speed
from studies.comparisons.page.words import briefly, joined, name_of, spread, table, verdict
from studies.comparisons.progress import ENDED, LIMITS, MESH, MESH_SECONDS
from studies.comparisons.runs import LIGHT_WEIGHT, NEAR, P2P_WEIGHT, VISIBLE
from studies.comparisons.store import Measurement
from studies.comparisons.units import percent

FAR = 10.0
"""A method that ends at so many times the energy of the minimum is nowhere near it."""
_ORDER = ("energy", "rest", "map")
_MANY = 1000


def section(cases: list[Measurement], figures: str) -> list[str]:
    """Figures, iterations with the paper's, claims, and the speed."""
    lines = ["## Progress of the solvers (Figures 1, 10 and 11)", ""]
    for data in cases:
        lines += [f"![{data['name']}]({figures}/progress-{data['name']}.png)", ""]
    lines += [
        "Colours end at what 97% of our final map's triangles stay below, but between 3 and 12; an "
        "arrow on the bar says that there is more, and above each map stands the largest density "
        "of a triangle that is drawn. The last map of a row is that of the run whose numbers stand "
        "beside it, and a cyan line joins a handle with a target that it has not reached; for SLIM "
        "and AQP it is the minimum to which Newton's method comes from their last one, and the "
        "iteration within 1% may lie between two of the maps. Newton-Eigen and unmodified Newton "
        "have our samples and certificate here, *paper's settings* the paper's.",
        "",
        "### Iterations",
        "",
        "To convergence; for SLIM and AQP, which hardly ever get there, to three weaker states, "
        f"the energy within {100 * NEAR:.0f}% of its minimum / no vertex moved by more than "
        f"{VISIBLE:g} world units in an iteration any more (a picture's longer side has 20) / no "
        "vertex further than that from the minimum. That minimum is of the method's own energy "
        "and constraints on the same mesh, found by Newton's method from the method's last map"
        f"{_borrowed(cases)}. A "
        "`+` marks what was not reached within the limit ("
        f"{joined([f'{LOOK[m][0]} {n:,} iterations' for m, n in LIMITS.items()])}, SLIM and AQP "
        f"{MESH_SECONDS:.0f} s), so that the number is a lower bound. Where a method ended at more "
        f"than {FAR:.0f} times the energy of the minimum, that energy stands in brackets.",
        "",
    ]
    methods = [m for m in LOOK if any(m in d["runs"] for d in cases)]
    rows = []
    for d in cases:
        rows.append([d["name"], *(_iterations(d, m) for m in methods)])
        if d["name"] in paper.ITERATIONS:
            rows.append(_of_paper(paper.ITERATIONS[d["name"]], methods))
    rows.append(_of_paper(paper.ITERATIONS[None], methods))
    lines += table(["shape", *(LOOK[m][0] for m in methods)], rows)
    lines += [
        "",
        "*Paper*: Figures 1 and 11, and 10, whose shape the text does not name. It counts "
        'iterations of all methods "till we couldn\'t spot a change in the rendered image", for '
        "SLIM and AQP closest to the second of the three numbers.",
        "",
        *_definiteness(cases),
        "",
        *_claims(cases),
        "",
        *speed.section(cases),
    ]
    return lines


def _borrowed(cases: list[Measurement]) -> str:
    """Runs from whose end Newton's method on the mesh finds no minimum."""
    runs = [(f"{LOOK[m][0]} on {d['name']}", d["runs"].get(m, {})) for m in MESH for d in cases]
    borrowed = [name for name, run in runs if run.get("borrowed")]
    lost = [name for name, run in runs if "reason" in run]
    text = ""
    if borrowed:
        text += (
            f" ({joined(borrowed)} ended with triangles so close to flat that it does not get down "
            "from there; the minimum of the same energy below the other method's map stands in)"
        )
    if lost:
        text += f" (none was found for {joined(lost)})"
    return text


def _of_paper(said: paper.Iterations, methods: list[str]) -> list[str]:
    values = {
        "newton-paper": said.newton,
        "newton-unmodified": None if said.halts is None else f"halts at {said.halts}",
        "newton-eigen": said.newton_eigen,
        "lbfgs": None if said.lbfgs is None else f"{said.lbfgs:,}",
        "slim": said.slim,
        "aqp": said.aqp,
    }
    cells = [values.get(m) for m in methods]
    return [f"*paper, Figure {said.figure}*", *("" if c is None else f"*{c}*" for c in cells)]


def _iterations(data: Measurement, method: str) -> str:
    run = data["runs"].get(method)
    if run is None:
        return "not installed"
    if method in MESH:
        if run["minimum"] is None:
            return f"{run['iterations']:,}+"
        found = [run["reached"][name] for name in _ORDER]
        return " / ".join(
            f"{run['iterations']:,}+" if f is None else f"{f['iteration']:,}" for f in found
        )
    energy = f" ({run['energy'][-1]:.2g})" if excess(data, run) > FAR else ""
    return f"{briefly(run)}{energy}"


def excess(data: Measurement, run: dict[str, Any]) -> float:
    """The energy at which a method in the harmonic subspace ended, over that of the minimum."""
    return run["energy"][-1] / data["runs"]["newton"]["energy"][-1]


def _definiteness(cases: list[Measurement]) -> list[str]:
    """The eigenvalues that the claims below go back to."""
    rows = []
    for d in cases:
        contraction = d["contraction"]
        rows.append(
            [
                d["name"],
                str(d["handles"]),
                ", ".join(str(count) for count in d["negative"]),
                f"{contraction['least']:.2f} to {contraction['most']:.2f}",
                f"{contraction['least_projected']:.2f}",
            ]
        )
    return [
        "What decides the iterations of Newton's methods:",
        "",
        *table(
            [
                "shape",
                "handles",
                "negative eigenvalues of H, iterate by iterate without a modification",
                "eigenvalues of M^-1 H at the minimum",
                "their least with all samples",
            ],
            rows,
        ),
        "",
        "H is the exact Hessian, M that of the paper's settings, projected and of 1,000 samples. "
        "Close to the minimum a full step leaves I - M^-1 H of the error: in its direction an "
        "eigenvalue of 1 removes it, one near 0 keeps it, and one above 2 makes it grow, so that "
        "the line search shortens steps. With all 10,000 samples in M only the projection is left.",
    ]


def _claims(cases: list[Measurement]) -> list[str]:
    return [_halts(cases), _eigen(cases), _lbfgs(cases), *_flips(cases)]


def _halts(cases: list[Measurement]) -> str:
    halted = [d for d in cases if d["runs"]["newton-unmodified"]["status"] == "indefinite"]
    others = [d for d in cases if d not in halted]
    ratios = [excess(d, d["runs"]["newton-unmodified"]) for d in halted]
    high = sum(ratio > FAR for ratio in ratios)
    said = [f"{s.halts} in Figure {s.figure}" for s in paper.ITERATIONS.values() if s.halts]
    at = (
        f", at {min(ratios):.2g} to {max(ratios):.2g} times the energy of the minimum and on "
        f"{high} of them at more than {FAR:.0f} times"
        if ratios
        else ""
    )
    why = "".join(
        f" On {d['name']} it ends otherwise: of the {len(d['negative'])} Hessians on its way "
        f"{sum(c > 0 for c in d['negative']) or 'none'} has a negative eigenvalue, with "
        f"{d['handles']} handles to hold the map; the paper does not say what it does there."
        for d in others
    )
    return (
        f"- *Unmodified Newton halts at a high energy* (paper: after {joined(said)} iterations): "
        f"it halts on {len(halted)} of {len(cases)} shapes{at}. "
        f"{verdict(high == len(cases), high > 0)}{why}"
    )


def _eigen(cases: list[Measurement]) -> str:
    every = [(d, d["runs"]["newton-paper"], d["runs"]["newton-eigen"]) for d in cases]
    # What one that does not get there would need is not known.
    pairs = [(d, a, b) for d, a, b in every if b["status"] in ENDED]
    more = [(d, a, b) for d, a, b in pairs if a["iterations"] > b["iterations"]]
    said = [f"{s.newton} against {s.newton_eigen}" for s in paper.ITERATIONS.values()]
    fewer = len(pairs) - len(more)
    alone = [(d["projected"]["iterations"], b["iterations"]) for d, _, b in pairs]
    only = sum(projected <= eigen for projected, eigen in alone)
    counts = joined([f"{projected} against {eigen}" for projected, eigen in alone])
    why = "".join(
        f" On {d['name']} it takes {a['iterations']} against {b['iterations']}: "
        + (
            "the Hessian has no negative eigenvalue on the way, so that Newton-Eigen is Newton's "
            "method itself, while "
            if not any(d["negative"])
            else ""
        )
        + f"M differs from H at the minimum, with eigenvalues of M^-1 H from "
        f"{d['contraction']['least']:.2f} to {d['contraction']['most']:.2f}. Ours, which takes the "
        f"exact Hessian where it is definite, needs {d['runs']['newton']['iterations']}."
        for d, a, b in more
    )
    return (
        "- *The pointwise modification needs no more iterations than Newton-Eigen* (paper: "
        f"{joined(said)}): with the paper's settings on {fewer} of the {len(pairs)} shapes where "
        f"Newton-Eigen converges, and on {only} with the samples and the certificate of "
        f"Newton-Eigen, so that they differ by the modification alone ({counts}). "
        f"{_judged(len(more), len(pairs))}{why}{_astray(cases)}"
    )


def _judged(against: int, shapes: int) -> str:
    if not shapes:
        return "**Not judged.**"
    return verdict(not against, against < shapes / 2)


def _astray(cases: list[Measurement]) -> str:
    """What Newton-Eigen does where it does not converge."""
    runs = [(d, run) for d in cases if (run := d["runs"]["newton-eigen"])["status"] not in ENDED]
    if not runs:
        return ""
    return (
        " It does not converge within its limit on "
        f"{joined([name_of(d['name']) for d, _ in runs])}, which counts for neither method: "
        + "; ".join(
            f"on {d['name']} its steps are {_median_step(run):.0e} of a full one in the median, "
            f"with {_negative_share(run['negative'], d['unknowns'])} of the Hessian's eigenvalues "
            f"negative; by their modulus instead of 1e-10 {_by_modulus(run['by_modulus'])}"
            for d, run in runs
        )
        + ". A negative eigenvalue raised to 1e-10, whatever the Hessian's scale, makes the "
        "direction along its eigenvector as long as the gradient there over 1e-10, and the line "
        "search shortens all of the step to what that one direction allows."
    )


def _by_modulus(run: dict[str, Any]) -> str:
    if run["status"] in ENDED:
        return f"it takes {run['iterations']} iterations"
    return "it does not converge either"


def _negative_share(counts: list[int], unknowns: int) -> str:
    """The median over the iterates."""
    return percent(sorted(counts)[len(counts) // 2] / unknowns)


def _lbfgs(cases: list[Measurement]) -> str:
    """With the light weight, at which the paper's counts were taken, and with the others' own."""
    light = [(d["name"], d["light"]["lbfgs"], d["light"]["newton"]) for d in cases]
    done = [(name, run) for name, run, _ in light if run["status"] in ENDED]
    said = [s.lbfgs for s in paper.ITERATIONS.values() if s.lbfgs]
    slower = [run["time"][-1] / ours["time"][-1] for _, run, ours in light]
    many = len(done) == len(light) and all(run["iterations"] > _MANY for _, run in done)
    counts = joined([f"{run['iterations']:,} on {name_of(name)}" for name, run in done])
    text = (
        f"- *L-BFGS needs over a thousand iterations and is not competitive* (paper: "
        f"{joined([f'{n:,}' for n in said])}): with lambda = {LIGHT_WEIGHT:g}, what the published "
        "code's weight amounts to, and the Dirichlet energy's Hessian to start from, it converges "
        f"on {len(done)} of {len(light)} shapes within {LIMITS['lbfgs']:,} iterations: {counts}. "
        f"It takes {spread(slower, 0)} times as long as ours.{_exhausted(light)} "
        f"{verdict(many, min(slower) > 1)}"
    )
    runs = [(d, d["runs"]["lbfgs"]) for d in cases]
    stuck = [(d, r) for d, r in runs if excess(d, r) > FAR]
    if stuck:
        steps = [_median_step(r) for _, r in stuck]
        text += (
            f" With lambda = {P2P_WEIGHT:,.0f}, as in the figures above, it is still at more than "
            f"{FAR:.0f} times the energy of the minimum on "
            f"{joined([name_of(d['name']) for d, _ in stuck])}: targets outweigh distortion so "
            "much that the first steps bring the map next to folding, and from there the line "
            f"search takes steps of {min(steps):.0e} to {max(steps):.0e} in the median. Where it "
            "is blocked none of the steps that it tries lowers the energy any more, though the "
            "gradient is not zero."
        )
    return text


def _exhausted(light: list[tuple[str, dict[str, Any], dict[str, Any]]]) -> str:
    """Where it ended because rounding leaves nothing to gain."""
    exhausted = [found for found in light if found[1]["status"] == "stationary"]
    if not exhausted:
        return ""
    names = [name_of(name) for name, _, _ in exhausted]
    gaps = [run["energy"][-1] / ours["energy"][-1] - 1 for _, run, ours in exhausted]
    return (
        f" On {joined(names)} it ends where no step lowers the energy in double precision, "
        f"{f'at most {max(gaps):.0e} above ours' if max(gaps) > 0 else 'not above ours'}."
    )


def _median_step(run: dict[str, Any]) -> float:
    steps = sorted(step for step in run["step"] if step is not None)
    return steps[len(steps) // 2]


def _flips(cases: list[Measurement]) -> list[str]:
    runs = [d["runs"][m] for d in cases for m in MESH if m in d["runs"]]
    if not runs:
        return []
    flipped = [r for r in runs if r["most_flips"]]
    total = sum(r["iterations"] for r in runs)
    return [
        f"- *SLIM and AQP produce no inverted triangles*: in {total:,} iterations of "
        f"{len(runs)} runs, every one looked at, {len(flipped) or 'none'} of the runs has one with "
        f"some. {verdict(not flipped)}"
    ]
