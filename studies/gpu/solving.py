"""Energies, certificates and times of one shape after the other, on this process's device.

As a script it prints one line of JSON for each shape, the most important shapes first.
"""

import json
import os
import sys
import time
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import replace
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp

import glid_nb
from glid_nb.certificate import Certificate
from glid_nb.minima import solve
from glid_nb.solvers import Options, Result, step
from studies.bench.solving import drag_step
from studies.bench.stages import measure_stages
from studies.cases import Case, reference_cases
from studies.study import Plan
from studies.timing import timed

OPTIONS = Options(restarts=0)

_BUDGET = 2.0  # seconds of one kind of timing, after which three are enough
_MOST_THREADS = 8
_SMALL = 8  # numbers in the smallest program


def found(case: Case) -> dict[str, Any]:
    """The results of one shape's solve; ``first`` includes compiling or loading its programs."""
    began = time.perf_counter()
    result = _solved(case, OPTIONS)
    first = time.perf_counter() - began
    certificate = certificate_of(result)
    return {
        "found": case.name,
        "status": result.status.value,
        "energy": result.energy,
        "iterations": result.iterations,
        "certified": certificate.certified,
        "k": certificate.k_upper,
        "unknowns": result.n_unknowns,
        "panels": result.n_panels,
        "first": first,
    }


def times(case: Case, repeats: int) -> dict[str, Any]:
    """Seconds of a solve, of a call without iterations, and of a drag step."""
    nothing = replace(OPTIONS, max_iterations=0)
    result = _solved(case, OPTIONS)
    return {
        "timed": case.name,
        "iterations": result.iterations,
        "solve": timed(lambda: _solved(case, OPTIONS), repeats, 0, _BUDGET),
        "call": timed(lambda: _solved(case, nothing), repeats, 1, _BUDGET),
        "drag": drag_step(case, result, repeats, _BUDGET)["time"],
    }


def stages(case: Case, repeats: int) -> dict[str, Any]:
    """Seconds of each stage, run separately."""
    return {"staged": case.name, "stages": measure_stages(_solved(case, OPTIONS), repeats)}


def certificate_of(result: Result) -> Certificate:
    """The certificate of a result in the harmonic subspace."""
    assert result.certificate is not None
    return result.certificate


def _solved(case: Case, options: Options) -> Result:
    return solve(case.problem.domain, case.problem.pose, None, options)


def dispatch(repeats: int) -> dict[str, float]:
    """Seconds to start the smallest program and get its result."""
    program, numbers = jax.jit(lambda x: x + 1), jnp.zeros(_SMALL)
    return timed(lambda: program(numbers).block_until_ready(), 10 * repeats)


def operations(case: Case) -> dict[str, Any]:
    """Operations in the largest of a shape's programs: fusions, calls of libraries, loops, copies.

    A GPU launches each of them in every turn of a loop.
    """
    step.run._ready.clear()  # forget the programs of other shapes
    _solved(case, OPTIONS)
    kinds = (" fusion(", " custom-call(", " while(", " conditional(", " copy(", " dot(")
    texts = [program.as_text() for program in step.run._ready.values()]
    counts = [sum(any(k in line for k in kinds) for line in t.splitlines()) for t in texts]
    return {"counted": case.name, "operations": max(counts)}


def main() -> None:
    """Measure the shapes named on standard input.

    First all are solved, several at a time, because each compilation uses one core.
    """
    given = json.load(sys.stdin)
    glid_nb.enable_compilation_cache()
    reference, repeats = given["reference"], given["repeats"]
    plan = Plan({} if reference is None else reference_cases(Path(reference)))
    show({"dispatch": dispatch(repeats)})
    cases = [plan.case(name) for name in given["shapes"]]
    show(found(cases[0]))  # alone, because its first solve is timed
    with ThreadPoolExecutor(min(os.cpu_count() or 1, _MOST_THREADS)) as pool:
        for done in as_completed([pool.submit(found, case) for case in cases[1:]]):
            show(done.result())
    for case in cases:
        show(times(case, repeats))
    for case in cases[: given["stages"]]:
        show(stages(case, repeats))
    for case in cases[: given["stages"]]:
        show(operations(case))


def show(line: dict[str, Any]) -> None:
    """Print one line and flush it."""
    print(json.dumps(line), flush=True)


if __name__ == "__main__":
    main()
