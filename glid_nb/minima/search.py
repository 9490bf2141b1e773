"""The search for a lower minimum: try the ways of the table, keep the best result."""

import logging
from dataclasses import replace

from glid_nb.minima.known import LOW_ENERGY, Known, is_above
from glid_nb.minima.ways import GROWTH, WAYS, Case, Way, with_options
from glid_nb.solvers.method import Inputs, Method
from glid_nb.solvers.result import Attempt, Result, Status

_LOG = logging.getLogger(__name__)


def run(method: Method, inputs: Inputs) -> Result:
    """Run a method; without a map to start from, try other ways as well if it has ``restarts``."""
    first = method.run(inputs)
    searches = "restarts" in method.options and inputs.start is None
    return improve(first, inputs, method) if searches else first


def improve(first: Result, inputs: Inputs, method: Method) -> Result:
    """The best of ``first``, a result of these inputs, and, if that is poor, of other ways: at most
    ``options.restarts``."""
    if not (inputs.options.restarts and len(inputs.pose)) or not is_above(first, LOW_ENERGY):
        return first
    known = Known(first, inputs)
    _LOG.info("energy %.6g; trying whether other starts end lower", first.energy)
    _search(known, method)
    if len(known.tried) == 1:
        return first
    attempts = tuple(
        Attempt(name, r.status, r.energy, r.iterations, given_up=r.pose is not inputs.pose)
        for name, r in known.tried
    )
    times = _times([result for _, result in known.tried])
    return replace(known.best, options=inputs.options, attempts=attempts, **times)


def _search(known: Known, method: Method) -> None:
    """Try the ways that pay, one after the other, until enough were tried."""
    for way in WAYS:
        if not way.when(known):
            continue
        for case in way.cases(known):
            if not way.pays(known, case):
                continue
            result = _followed(way, case, known, method)
            if result.status is Status.STOPPED:
                known.stop(way.name.format(case.place), result)
                return
            known.add(way.name.format(case.place), result)
            _LOG.info("energy %.6g by %s", result.energy, known.tried[-1][0])
            if len(known.tried) > known.inputs.options.restarts:
                return
            if way.enough is not None and known.best.energy <= way.enough * known.isometry:
                return


def _followed(way: Way, case: Case, known: Known, method: Method) -> Result:
    """The result of a way's last problem, each started from the result of the one before.

    A shape is distorted more the further it turns, so a waypoint above the way's limit ends it. The
    result is then that waypoint's. A way that is stopped before its last problem returns the best
    result so far.
    """
    *before, last = way.problems(known, case)
    limit = way.limit_of(case)
    done = list[Result]()

    def solved(inputs: Inputs) -> Result:
        start = done[-1] if done else None
        aligned = with_options(inputs, align=inputs.options.align and not done)
        done.append(method.run(replace(aligned, start=start)))
        return done[-1]

    for problem in before:
        result = solved(problem.inputs)
        if result.status is Status.STOPPED:
            return replace(known.best, status=Status.STOPPED)
        excess = result.energy_distortion - known.isometry
        if limit is not None and excess > limit * problem.time**GROWTH * known.excess:
            return replace(result, **_times(done))
    return replace(solved(last.inputs), **_times(done))


def _times(results: list[Result]) -> dict[str, float]:
    """The times of several solves together."""
    return {key: sum(getattr(r, key) for r in results) for key in ("compile_time", "solve_time")}
