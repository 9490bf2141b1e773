"""An iteration's time as the sum of its stages, and what the machine's floor says of each."""

from __future__ import annotations

from typing import Any

from studies.benchmarks.machine import factor_flops
from studies.benchmarks.solving import DEFAULT
from studies.benchmarks.stages import STAGES

Measurement = dict[str, Any]


def floor_of(solve: Measurement) -> float:
    """Seconds that the machine sets for an iteration."""
    return sum(solve["floor"].values())


def over_floor(solve: Measurement) -> float:
    """The median iteration as a multiple of its floor."""
    return solve["per_iteration"]["median"] / floor_of(solve)


def shares(solve: Measurement) -> dict[str, float]:
    """Seconds of the median iteration by stage, in the order of ``STAGES``, and two more.

    Each stage's time counts as often as an iteration runs it in the mean: an indefinite Hessian is
    factored twice, corrections search along lines of their own. ``before`` is the call's part that
    no iteration takes, shared; ``rest`` is what none of these explains, negative where stages run
    faster within the loop than by themselves.
    """
    count = solve["iterations"]
    lines = (count + solve["corrections"]) / count
    factors = 1 + solve["modified"] if solve["mode"] == DEFAULT else 1.0
    times = {
        "hessian": 1.0,
        "factor": factors,
        "products": lines,
        # That of the accepted candidate, and that after corrections.
        "certificate": min(lines, 2.0),
        "search": lines,
    }
    parts = {name: times[name] * solve["stages"][name] for name in STAGES}
    parts["before"] = solve["before"]["median"] / count
    parts["rest"] = solve["per_iteration"]["median"] - sum(parts.values())
    return parts


def product_rate(solve: Measurement) -> float:
    """The rate of the Hessian's products as a share of the machine's best, assembly included."""
    return solve["floor"]["hessian"] / solve["stages"]["hessian"]


def factor_rate(solve: Measurement) -> float:
    """Flops per second of Cholesky's factorisation and two triangular solves, at padded size."""
    return factor_flops(solve["padded"]) / solve["stages"]["factor"]


def in_words(solve: Measurement) -> str:
    """Where the time of an iteration goes, in one sentence without its full stop."""
    part = {name: f"{1e3 * seconds:.1f}" for name, seconds in shares(solve).items()}
    corrections = solve["corrections"] / solve["iterations"]
    return (
        f"of {1e3 * solve['per_iteration']['median']:.1f} ms, assembling the Hessian takes "
        f"{part['hessian']} (at {product_rate(solve):.0%} of the best product rate), factoring it "
        f"{part['factor']} (one thread of LAPACK, {factor_rate(solve) / 1e9:.0f} Gflop/s at this "
        f"size), products with the basis {part['products']}, the certificate "
        f"{part['certificate']}, the line search {part['search']}, the call itself "
        f"{part['before']}, the rest {part['rest']}"
        + (f"; {corrections:.1f} corrections are in it" if corrections else "")
    )
