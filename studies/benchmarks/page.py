"""The page of benchmarks, in Markdown."""

from __future__ import annotations

import statistics
from pathlib import Path

from glid_nb.certificate.rounding import CARRIED_STEPS, carried_slack_factor, slack_factor
from glid_nb.solvers import Options, Status
from studies.benchmarks import goals
from studies.benchmarks.breakdown import (
    factor_rate,
    floor_of,
    over_floor,
    product_rate,
    shares,
)
from studies.benchmarks.drawing import SCALING, SOLVES, SPEEDUPS
from studies.benchmarks.markdown import ms, spread
from studies.benchmarks.measurements import Measurement
from studies.benchmarks.outcomes import on_gpu, outcomes, ratio
from studies.benchmarks.page_scaling import scaling
from studies.benchmarks.results import Results
from studies.benchmarks.solving import ALIGNED, DRAG, DRAG_GAP, GAP, SAME_ENERGY, same_minimum
from studies.benchmarks.starting import PARTS
from studies.comparisons.page.words import joined, table

# What was tried for speed, with prediction and outcome.
_TRIED = Path(__file__).with_name("tried.md")
# Counted in the compiled program of an iteration, on a Xeon with two cores.
_OPERATIONS = 150


def page(results: Results, out: Path) -> str:
    """The page; ``out`` is the folder of the figures, beside the page."""
    sections = [
        _head(results, out),
        _goals(results),
        _solves(results, out.name),
        _breakdown(results),
        _drags(results),
        _start(results.start),
        _compilations(results.compilations),
        scaling(results.scaling, f"{out.name}/{SCALING}"),
        _batches(results.batches),
        _gpu(results),
        _rounding(results),
        _TRIED.read_text(encoding="utf-8").splitlines(),
    ]
    return "\n\n".join("\n".join(lines) for lines in sections if lines).rstrip() + "\n"


def _command(results: Results, out: Path) -> str:
    # A folder of somebody's machine is nobody else's.
    words = ["glid-nb bench", "--out", out.name if out.is_absolute() else out.as_posix()]
    if results.run["reference"]:
        words.insert(1, "--reference DIR")
    if results.run["quick"]:
        words.append("--quick")
    return " ".join(words)


def _head(results: Results, out: Path) -> list[str]:
    machine, run = results.machine, results.run
    versions = ", ".join(f"{name} {v}" for name, v in machine["versions"].items())
    rates, devices = machine["rates"], machine["devices"]
    names = joined([f"{_devices(devices.count(name))} ({name})" for name in dict.fromkeys(devices)])
    command = _command(results, out)
    folder = ", DIR being the folder of the reference problems" if run["reference"] else ""
    lines = [
        "# Benchmarks",
        "",
        f"Written by `{command}`{folder}; do not edit. `{_rendering(out)}` writes it again from "
        "the measurements in its folder `data`, without measuring anything.",
        "",
        "Times are medians with quartiles in brackets, compilation left out unless it is what is "
        f"timed: {run['repeats']} calls for solves and drag steps, at most {run['repeats']} and at "
        "least 3 for sizes (the slow ones fewer), 3 for the making of matrices, for batches and "
        "for processes that start. Peak memory is that of one process. The machine's rates and its "
        "floor are the best seen, stages are medians without quartiles.",
        "",
        f"Machine: {machine['processor']}, {machine['cores']} cores (the goals are for "
        f"{goals.CORES}), {machine['system']}; JAX computes on {names}; Python "
        f"{machine['python']}, {versions} (sources {machine['sources']}). Its best matrix "
        f"product runs at {rates['float64'] / 1e9:.0f} Gflop/s in double and "
        f"{rates['float32'] / 1e9:.0f} in single precision, and it reads "
        f"{rates['bytes'] / 1e9:.0f} GB/s.",
    ]
    if results.elsewhere:
        lines += [
            "",
            "**Not all from this machine and these versions:** "
            f"{joined([f'`{name}`' for name in results.elsewhere])} were measured with others.",
        ]
    if run["quick"]:
        lines += ["", "**A quick run:** sizes are small, and its numbers mean little."]
    return lines


def _rendering(out: Path) -> str:
    return f"glid-nb bench --render --out {out.name if out.is_absolute() else out.as_posix()}"


def _goals(results: Results) -> list[str]:
    rows = outcomes(results)
    met = sum(row.verdict == "met" for row in rows)
    missed = sum(row.verdict.startswith("missed") for row in rows)
    return [
        "## Goals",
        "",
        f"{met} met, {missed} missed, {len(rows) - met - missed} not measured.",
        "",
        *table(
            ["goal", "wanted", "measured", "outcome", "what limits it"],
            rows,
        ),
    ]


def _solves(results: Results, figures: str) -> list[str]:
    pairs, same = results.pairs, results.like_for_like
    if not pairs:
        return []
    ratios = [ratio(*pair) for pair in pairs]
    lines = [
        f"## To a relative energy gap of {GAP:g}, certified",
        "",
        f"![time per iteration beside the machine's floor, by shape]({figures}/{SOLVES})",
        "",
        f"![how many times faster, by shape]({figures}/{SPEEDUPS})",
        "",
        "`paper`: uniform samples (10^4 for the energy, |G| in the paper, and 10^3 for the "
        "Hessian, |H|), Lipschitz certificate, projected Hessian K+, from the identity, in our own "
        "code and so with the Hessian in whitened coordinates and single precision, as `default` "
        "has it. `default`: ours, from the rigid motion that "
        "brings the handles closest to their targets, and without the other ways to a minimum that "
        "`solve` tries after a poor end (`restarts=0`; so it is all over this page but for the "
        "first solve of a process). The gap is to the minimum of "
        "each mode's own discrete energy. A time is that of a whole call of `solve`, the making of "
        "the matrices left out, which a shape needs once and which has a column of its own; per "
        "iteration is that time shared evenly. An iteration of `default` can contain up to "
        f"{Options().corrections} corrections, further steps by the same Hessian. The modes are "
        "timed in turn, a call of each after the other: a machine that is slow for a while is so "
        "for both.",
        "",
        *table(
            [
                "shape",
                "unknowns",
                "panels",
                "iterations paper / default (with corrections)",
                "energy paper / default",
                "paper, ms",
                "default, ms",
                "ratio",
                "per iteration paper, ms",
                "per iteration default, ms",
                "matrices paper, ms",
                "matrices default, ms",
            ],
            [
                [
                    p["name"],
                    str(p["unknowns"]),
                    str(d["panels"]),
                    f"{p['iterations']} / {d['iterations']} ({d['corrections']})",
                    f"{p['energy']:.4f} / {d['energy']:.4f}{_mark(p, d)}",
                    ms(p["to_gap"]),
                    ms(d["to_gap"]),
                    f"{value:.1f}",
                    ms(p["per_iteration"]),
                    ms(d["per_iteration"]),
                    ms(p["making"]),
                    ms(d["making"]),
                ]
                for (p, d), value in zip(pairs, ratios, strict=True)
            ],
        ),
        "",
        f"`default` is {statistics.median(ratios):.1f} times faster in the median, "
        f"{min(ratios):.1f} times at least.",
    ]
    if len(same) < len(pairs):
        lines += ["", _other_minima(results)]
    if results.aligned:
        lines += ["", *_aligned(results)]
    if results.cage is not None:
        cage = results.cage
        lines += [
            "",
            f"A synthetic cage with {cage['vertices']} vertices ({cage['unknowns']} unknowns, "
            f"{cage['panels']} panels), `default`: {cage['iterations']} iterations, "
            f"{ms(cage['to_gap'])} ms, per iteration {ms(cage['per_iteration'])} ms.",
        ]
    failed = [
        f"{s['name']} ({s['mode']})"
        for by_shape in results.solves.values()
        for s in by_shape.values()
        if not (s["certified"] and s["status"] == Status.CONVERGED.value)
    ]
    certified = (
        f"Not converged, or not certified: {joined(failed)}."
        if failed
        else "Every solve converged, to 1e-10, and every map was certified at its end, and by "
        "construction at each step."
    )
    return [*lines, "", certified]


def _mark(paper: Measurement, default: Measurement) -> str:
    return "" if same_minimum(paper["energy"], default["energy"]) else " (other minimum)"


def _other_minima(results: Results) -> str:
    pairs, same = results.pairs, results.like_for_like
    others = [p["name"] for p, d in pairs if (p, d) not in same]
    text = (
        f"On {joined(others)} the two end at minima whose energies differ by more than "
        f"{SAME_ENERGY:.0%}: `paper` begins at the identity itself."
    )
    if same:
        ratios = [ratio(*pair) for pair in same]
        text += (
            f" Over the shapes on which they end at the same one `default` is "
            f"{statistics.median(ratios):.1f} times faster in the median, {min(ratios):.1f} times "
            "at least."
        )
    return text


def _aligned(results: Results) -> list[str]:
    """What the method gains where both begin with the rigid motion."""
    ratios = [ratio(*pair) for pair in results.aligned]
    return [
        f"What the rigid motion alone gains: `{ALIGNED}` is `paper` that begins with it as "
        f"`default` does. Over it `default` is {statistics.median(ratios):.1f} times faster in the "
        f"median, {min(ratios):.1f} times at least.",
        "",
        *table(
            [
                "shape",
                "iterations",
                "energy paper-aligned / default",
                "paper-aligned, ms",
                "default, ms",
                "ratio",
            ],
            [
                [
                    p["name"],
                    f"{p['iterations']} / {d['iterations']}",
                    f"{p['energy']:.4f} / {d['energy']:.4f}{_mark(p, d)}",
                    ms(p["to_gap"]),
                    ms(d["to_gap"]),
                    f"{ratio(p, d):.1f}",
                ]
                for p, d in results.aligned
            ],
        ),
    ]


def _breakdown(results: Results) -> list[str]:
    solves = [s for pair in results.pairs for s in pair]
    if results.cage is not None:
        solves.append(results.cage)
    if not solves:
        return []
    product = [product_rate(s) for s in solves]
    factor = [factor_rate(s) / 1e9 for s in solves]
    before = [1e3 * s["before"]["median"] for s in solves]
    rest = [shares(s)["rest"] / s["per_iteration"]["median"] for s in solves]

    def row(s: Measurement) -> list[str]:
        parts, floor = {k: 1e3 * v for k, v in shares(s).items()}, s["floor"]
        reading = parts["products"] + parts["certificate"]
        return [
            s["name"],
            s["mode"],
            f"{1e3 * s['per_iteration']['median']:.1f}",
            f"{1e3 * floor_of(s):.1f}",
            f"{over_floor(s):.1f}",
            f"{1e3 * floor['hessian']:.2f} / {parts['hessian']:.2f}",
            f"{1e3 * floor['factor']:.2f} / {parts['factor']:.2f}",
            f"{1e3 * floor['products']:.2f} / {reading:.2f}",
            *(f"{parts[name]:.2f}" for name in ("search", "before", "rest")),
            f"{s['modified']:.0%}",
        ]

    return [
        "## Where the time of an iteration goes, ms",
        "",
        "The floor of a step and its corrections: reading the basis matrices from memory, the "
        "matrix products of the Hessian's three blocks and the Cholesky factorisation (a third of "
        "the unknowns cubed) at the best rate of products seen, and reading the factor for the "
        "triangular solves. Beside it each stage, run by itself on the solver's padded matrices, "
        "as often as an iteration runs it in the mean: an exact Hessian that is not positive "
        "definite is factored once more with its positive part K+, and corrections have products, "
        "a line search and a certificate of their own. The call's part is that of a call without "
        "iterations, its result made and all, shared by the iterations of a solve. The rest is "
        "what the stages do not add up to.",
        "",
        *table(
            [
                "shape",
                "mode",
                "measured",
                "floor",
                "ratio",
                "Hessian, floor / run",
                "factor, floor / run",
                "reading, floor / products and certificate",
                "line search",
                "call",
                "rest",
                "iterations with K+",
            ],
            [row(s) for s in solves],
        ),
        "",
        f"Assembling the Hessian reaches {min(product):.0%} to {max(product):.0%} of the best "
        f"product rate, in the median {statistics.median(product):.0%}: its operands must be "
        "rotated and weighted first, and the products are small. The factorisation is one call of "
        f"LAPACK's Cholesky, with one thread: {min(factor):.0f} to {max(factor):.0f} Gflop/s at "
        f"these sizes, two solves included. A call without iterations takes {min(before):.1f} to "
        f"{max(before):.1f} ms. The rest is {min(rest):.0%} to {max(rest):.0%} of the time: not "
        "among the stages are the masking of the Hessian and the targets' part of it, the changes "
        f"of coordinates, the assembly of K+ and the start of some {_OPERATIONS} operations of an "
        "iteration (counted on a Xeon with two cores); and stages run at another moment than the "
        "solves, with other data in the caches.",
    ]


def _drags(results: Results) -> list[str]:
    if not results.drags:
        return []
    failed = [d["name"] for d in results.drags if not d["certified"]]
    certified = f"Not certified: {joined(failed)}." if failed else "Every step's map was certified."
    return [
        f"## A drag step: one target moved by {DRAG:.0%} of the shape, to a gap of {DRAG_GAP:g}",
        "",
        "The first handle's target moves along x, by a part of the bounding box's diagonal. "
        "From the converged result of the pose before, whose Hessian's factor serves the "
        "first iteration; one that has not converged passes on none, so that a chain of steps each "
        "stopped at this gap would be slower.",
        "",
        *table(
            ["shape", "iterations (with corrections)", "ms"],
            [
                [d["name"], f"{d['iterations']} ({d['corrections']})", ms(d["time"])]
                for d in results.drags
            ],
        ),
        "",
        certified,
    ]


def _start(start: Measurement | None) -> list[str]:
    if start is None:
        return []
    return [
        "## First solve of the bundled gecko in a new process, seconds",
        "",
        f"Cold without compiled programs on disk, warm with them; "
        f"{start['cold'][PARTS[0]]['runs']} process(es) of each kind.",
        "",
        *table(
            [
                "",
                "import and outline of the picture",
                "first solve",
                "of it tracing, compiling or loading programs",
                "second solve",
            ],
            [
                [name, *(spread(start[name][part], digits=2) for part in PARTS)]
                for name in ("cold", "warm")
            ],
        ),
    ]


def _compilations(compilations: Measurement | None) -> list[str]:
    if compilations is None:
        return []
    return [
        "## Programs compiled when something changes",
        "",
        "After one solve, one drag step and one split of panels; also those that are loaded from "
        "disk would count.",
        "",
        *table(
            ["what changes", "programs compiled"],
            [[name, str(count)] for name, count in compilations["counts"].items()],
        ),
    ]


def _batches(batches: Measurement | None) -> list[str]:
    if batches is None:
        return []
    series = batches["series"]
    first = series[0]
    alone, hard = first["one_by_one"], first["hard"]
    largest = [s["rows"][-1] for s in series]
    lines = [
        f"## Batches: poses of {batches['name']} per second",
        "",
        *table(
            ["poses", *(_devices(s["devices"]) for s in series)],
            [
                [str(rows[0]["poses"]), *(spread(r["per_second"]) for r in rows)]
                for rows in zip(*(s["rows"] for s in series), strict=True)
            ],
        ),
        "",
        f"One by one, by `solve`: {spread(alone)} poses per second.",
    ]
    on_cpu = batches["taken"]["devices"][0].startswith("cpu")
    if on_cpu:
        smallest = first["rows"][0]
        gain = largest[0]["per_second"]["median"] / smallest["per_second"]["median"]
        lines += [
            "",
            f"On one device a batch of {largest[0]['poses']} runs {gain:.2f} times as many poses "
            f"per second as one of {smallest['poses']}, and "
            f"{largest[0]['per_second']['median'] / alone['median']:.2f} times as many as `solve`: "
            "a CPU has little to gain. The poses of a batch run in turn (`lax.map`), for one pose "
            "keeps the cores busy already, and in lockstep every pose would take every branch of "
            "every other. What a batch saves is the host's part of each call.",
        ]
    if on_cpu and len(series) > 1:
        gain = largest[-1]["per_second"]["median"] / largest[0]["per_second"]["median"]
        lines[-1] += (
            f" {_devices(series[-1]['devices']).capitalize()}, forced on the same cores, run "
            f"{gain:.2f} times as many poses per second as one, in batches of "
            f"{largest[0]['poses']}: each takes its share of the poses, one after the other."
        )
    added = hard["with"]["median"] - hard["without"]["median"]
    lines += [
        "",
        f"A hard pose ({hard['hard_iterations']} iterations) among {hard['easy']} easy ones (in "
        f"the median {hard['easy_iterations']}): the batch takes {ms(hard['with'])} ms instead of "
        f"{ms(hard['without'])} ms, {1e3 * added:.0f} ms more; alone the hard pose takes "
        f"{ms(hard['alone'])} ms. A batch goes round by round of {Options().iterations_per_call} "
        "iterations, and what has ended leaves it: by their shares of the calls' time the easy "
        f"ones were done after {1e3 * hard['easy_done']:.0f} ms. The caller waits for all of them.",
        "",
        "Each pose is certified on its own and solved until it has converged, to 1e-10. Under "
        "`jax.distributed` each host passes its own share of the poses and gets their results; "
        "tested with two processes on one machine.",
    ]
    return lines


def _devices(count: int) -> str:
    return "one device" if count == 1 else f"{count} devices"


def _gpu(results: Results) -> list[str]:
    calls = Options().iterations_per_call
    there = on_gpu(results)
    return [
        "## On a GPU",
        "",
        "These are the numbers of a GPU."
        if there
        else "No GPU was in reach of this run: nothing on this page was measured on one, and the "
        f"goal of {1e3 * goals.GPU_ITERATION:.1f} ms per iteration is open.",
        "",
        "One command measures everything above on a machine with a GPU, which JAX chooses by "
        "itself. The code is the same but for two places: the factorisation is JAX's own instead "
        "of a direct call of LAPACK, and the poses of a batch are vectorised.",
        "",
        "```sh",
        'pip install "jax[cuda12]"',
        "glid-nb bench --reference PROBLEMS --out DIR",
        "```",
        "",
        "What is expected to bound an iteration there, in this order: the start of its small "
        f"operations, some {_OPERATIONS} of them; the factorisation of a matrix of a few hundred "
        "unknowns, which is too small to fill a GPU and waits for its own columns; the line "
        "search's loop, whose end the device decides. The host takes part once in up to "
        f"{calls} iterations (`iterations_per_call`), which are one dispatch; a solve with more "
        f"has a synchronisation for every {calls}.",
    ]


def _rounding(results: Results) -> list[str]:
    largest = max((s["unknowns"] for pair in results.pairs for s in pair), default=0)
    # Four real numbers a column.
    columns = -(-largest // 4)
    lines = [
        "## Rounding in the certificate",
        "",
        "The bounds are evaluated in double precision. Each panel's remainder is enlarged by "
        "`(n + 64) u s max_j |phi_j|`, a running error bound of first order in the unit roundoff "
        "`u` for sums of `n` terms whose moduli add up to at most `s max_j |phi_j|`: `n` roundings "
        "for the sum and an allowance of 64 for the basis functions, the control points and the "
        "Bernstein coefficients (the terms of second order, `n u` times smaller, 1e-14 of it, are "
        "within that allowance), and by "
        f"{carried_slack_factor(1) / slack_factor(1):.0f} times as much for values that a solve "
        f"carries along through up to {CARRIED_STEPS} steps (`glid_nb/certificate/rounding.py`).",
    ]
    if columns:
        lines[-1] += (
            f" For {columns} columns, about those of the largest shape above, that is "
            f"{carried_slack_factor(columns):.1e} of `s max_j |phi_j|`."
        )
    return lines
