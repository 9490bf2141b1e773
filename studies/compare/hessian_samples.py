"""Newton's method with fewer and fewer Hessian samples (Figure 8)."""

from typing import Any

from studies.cases import Case
from studies.compare.shapes import some
from studies.runs import outcome, run
from studies.store import Measurement
from studies.study import Plan, Study, on_cases
from studies.tables import Row, digits, seconds

SAMPLES = (50, 100, 200, 400, 700, 1_000, 10_000)
_MOST_ITERATIONS = 60
_RUNS = 2


def measure(case: Case, plan: Plan) -> Measurement:
    """One run for each number of samples."""
    runs = {}
    for count in SAMPLES:
        plan.detail(f"{case.name}: {count} Hessian samples")
        settings: dict[str, Any] = {"hessian_samples": count, "max_iterations": _MOST_ITERATIONS}
        result = run("newton-staged", case, runs=_RUNS, **settings)
        runs[str(count)] = outcome(result)
    return {"perimeter": case.perimeter, "runs": runs}


def tables(found: list[Measurement]) -> dict[str, list[Row]]:
    """Iterations, energy and time for each number of samples."""
    rows: list[Row] = []
    for data in found:
        for count, run_ in data["runs"].items():
            more = "" if run_["status"] == "converged" else "+"
            rows.append(
                {
                    "samples": f"{int(count):,}",
                    "spacing": digits(data["perimeter"] / int(count), 2),
                    "iterations": f"{run_['iterations']}{more}",
                    "energy": f"{run_['energy'][-1]:.8g}",
                    "time": seconds(run_["time"][-1]),
                }
            )
    return {"hessian-samples": rows}


STUDY = Study("hessian-samples", on_cases(some(("deer",), "gecko-extreme"), measure), tables)
