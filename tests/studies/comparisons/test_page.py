"""What the page says of given numbers."""

from __future__ import annotations

import numpy as np
import pytest

from studies.comparisons import paper
from studies.comparisons.page import bounded, cost, iteration_times, lipschitz, progress, speed
from studies.comparisons.page.words import briefly, ended, joined, name_of, spread, table, verdict
from studies.comparisons.units import percent, seconds


def test_words() -> None:
    assert joined([]) == "none"
    assert joined(["a"]) == "a"
    assert joined(["a", "b", "c"]) == "a, b and c"
    assert spread([2.04, 1.0]) == "1.0 to 2.0"
    assert spread([3, 3], 0) == "3"
    assert name_of("gecko-extreme") == "the bundled gecko, extreme pose"
    assert name_of("t-rex") == "t-rex"
    assert ended({"status": "max_iterations", "iterations": 60}) == "not converged after 60"
    assert briefly({"status": "max_iterations", "iterations": 2_000}) == "2,000+"
    assert briefly({"status": "stationary", "iterations": 60}) == "60"
    assert briefly({"status": "indefinite", "iterations": 2}) == "halts at 2"
    assert table(["a"], [["1"]]) == ["| a |", "| --- |", "| 1 |"]
    assert verdict(True) == "**Reproduced.**"
    assert verdict(False, True) == "**Partly reproduced.**"
    assert verdict(False) == "**Not reproduced.**"


@pytest.mark.parametrize(
    ("share", "text"),
    [
        (0, "0.00%"),
        (1e-6, "<0.01%"),
        (0.0058, "0.58%"),
        (0.05, "5.0%"),
        (0.0996, "10%"),
        (1, "100%"),
    ],
)
def test_percent(share: float, text: str) -> None:
    assert percent(share) == text


def test_seconds() -> None:
    assert seconds(0.0297) == "30 ms"
    assert seconds(3.71) == "3.7 s"


def test_table_2_is_what_the_paper_says_of_it() -> None:
    # Section 10: the CPU version is "approximately 5 times slower on average".
    slower = [row.newton_cpu / row.newton_gpu for row in paper.TABLE_2.values()]
    assert round(sum(slower) / len(slower)) == 5


def test_bounds_are_held_and_bind() -> None:
    asked = (0.8, 5.0, 0.3)
    assert bounded.holds([0.8, 4.3, 0.31], asked)
    assert not bounded.holds([0.81, 4.3, 0.31], asked)
    assert not bounded.holds([0.5, 4.3, 0.29], asked)
    assert bounded.exceeded([0.81, 4.3, 0.29], asked) == ["k", "sigma_2"]
    assert bounded.bound_by([0.79, 2.0, 0.31], asked) == ["k", "sigma_2"]
    assert bounded.shares([0.4, 3.0, 0.3], asked) == pytest.approx([0.5, 0.5, 1.0])


def run(time: float, reached: dict | None, **more: object) -> dict:
    found = None if reached is None else {**dict.fromkeys(("map", "energy", "rest")), **reached}
    base = {"time": [0.0, time], "energy": [9.0, 1.02], "minimum": 1.0, "left": 0.5}
    made = {"preparation": 0.25, "area_mean": 2.1, "step_time": [0.125, time]}
    return {**base, **made, "iterations": 1, "reached": found, **more}


def shape(name: str, slim: dict, aqp: dict) -> dict:
    there = {"iteration": 1, "time": 0.1}
    ours = run(0.1, dict.fromkeys(("map", "energy", "rest"), there))
    eigen = {k: v for k, v in run(5.0, None).items() if k not in ("reached", "minimum")}
    runs = {"newton": ours, "newton-eigen": eigen, "slim": slim, "aqp": aqp}
    runs = {k: {**v, "watching": None} for k, v in runs.items()}
    aligned = {"area_mean": 2.1, "iterations": 1}
    return {
        "name": name,
        "unknowns": 100,
        "area_mean_below_ours": 2.1,
        "aligned": aligned,
        "runs": runs,
    }


def test_ratios_that_are_bounds_are_called_so() -> None:
    there = {"iteration": 1, "time": 4.0}
    cases = [
        shape("a", run(40.0, {"energy": there}), run(40.0, {"energy": {**there, "time": 2.0}})),
        shape("b", run(40.0, {}), run(9.0, {"energy": there})),
    ]
    text = "\n".join(speed.section(cases))
    assert "| a | 100 ms | unconverged | 4.0 s, 40x | 2.0 s, 20x |" in text
    assert "| b | 100 ms | unconverged | 40.0 s+, 400x+ |" in text
    assert "stopped before: SLIM on b (2.0% above). Unconverged, and in no ratio: Newton-" in text
    assert "SLIM on b (0.5 units away), AQP on a (0.5" in text
    assert "3 of 4 runs at 25x or more" in text
    # The first criterion: 40 and at least 400, of which the median is a bound too.
    assert (
        "1% of its minimum | 220x+ (40x to 400x+) | 220x+ (40x to 400x+) | 30x (20x to 40x)" in text
    )
    # Both medians have to be high enough: SLIM's is at least 220x, AQP's 30x.
    assert "for both: **Reproduced.**" in text
    assert "4 of 4 runs of SLIM and AQP were not visibly at their minimum" in text


def test_one_method_that_is_not_beaten_makes_it_partly() -> None:
    fast, slow = ({"iteration": 1, "time": time} for time in (0.5, 8.0))
    text = "\n".join(
        speed._criterion([shape("a", run(9, {"map": slow}), run(9, {"map": fast}))], "map", "Map")
    )
    assert "80x for SLIM" in text
    assert "5x for AQP" in text
    assert "**Partly reproduced.**" in text


def test_medians_without_shapes_whose_minima_differ() -> None:
    quick, slow = ({"iteration": 1, "time": time} for time in (0.5, 8.0))
    alike = shape("a", run(9, {"rest": quick}), run(9, {"rest": quick}))
    other = shape("b", run(9, {"rest": slow}), run(9, {"rest": slow}))
    other["area_mean_below_ours"] = None
    text = "\n".join(speed._summary([alike, other]))
    assert "| SLIM, all | SLIM, without b |" in text
    assert "*(the paper's)* | 42x (5x to 80x) | 5x (5x to 5x) |" in text


def test_newton_eigen_is_judged_on_one_processor() -> None:
    there = {"iteration": 1, "time": 0.8}
    case = shape("a", run(9, None), run(9, None))
    assert speed._eigen([case]) == []
    case["runs"]["newton-eigen"]["reached"] = dict.fromkeys(("map", "energy", "rest"), there)
    (text,) = speed._eigen([case])
    # Table 2's and the figures' numbers: 32 * 77.6 / (6 * 61.6) and 11 * 56.5 / (8 * 45.2).
    assert "6.7 on rex and 1.7 on raptor" in text
    assert "8 times in the median" in text
    assert "**Reproduced.**" in text


def test_a_run_that_hardly_moves_is_explained() -> None:
    square = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    case = shape("a", run(9, None, energy=[9.0, 8.1], minimum=1.0), run(9, None))
    flat = square * [1.0, 0.01]
    case["arrays"] = {
        "mesh": square,
        "mesh_triangles": np.array([[0, 1, 2]]),
        "images_slim": np.stack([flat, square]),
    }
    text = "\n".join(speed._flat([case]))
    # (1 + 0.01^2) / 2 * (1 + 1 / 0.01^2).
    assert "on a its triangles reach a density of 5e+03" in text
    assert "falls by 10% in an iteration" in text
    case["runs"]["slim"]["energy"] = [9.0, 1.5]
    assert speed._flat([case]) == []


def test_small_steps_are_no_rest() -> None:
    early, late = ({"iteration": i, "time": 1.0} for i in (40, 300))
    cases = [
        shape("a", run(9, {"rest": late, "energy": early}), run(9, {"rest": early, "energy": late}))
    ]
    assert "weakest of the three criteria" in speed._weak(cases, "rest")
    assert "AQP on a met it before" in speed._weak(cases, "rest")
    assert speed._weak(cases, "map") == ""
    assert (
        speed._weak([shape("a", run(9, {"rest": late, "energy": early}), run(9, {}))], "rest") == ""
    )


def test_a_median_of_bounds_is_a_bound() -> None:
    assert speed._median_of([(30.0, False), (50.0, True), (70.0, True)]) == (50.0, True)
    assert speed._median_of([(30.0, False), (50.0, False), (70.0, True)]) == (50.0, False)
    assert speed._median_of([(30.0, False), (50.0, True)]) == (40.0, True)


def test_a_missing_minimum_is_said() -> None:
    lost = {**run(40.0, None), "minimum": None, "reason": "singular"}
    del lost["reached"]
    there = {"iteration": 1, "time": 4.0}
    text = "\n".join(speed.section([shape("a", lost, run(9.0, {"map": there}))]))
    assert "| a | 100 ms | unconverged | no minimum | 4.0 s, 40x |" in text
    assert "There is no minimum to compare with for SLIM on a (singular)." in text


def test_borrowed_minima_are_named() -> None:
    lost = {"reason": "singular", "minimum": None}
    cases = [{"name": "a", "runs": {"slim": {"borrowed": True}, "aqp": lost}}]
    text = progress._borrowed(cases)
    assert "(SLIM on a ended with triangles so close to flat" in text
    assert "(none was found for AQP on a)" in text
    assert progress._borrowed([{"name": "a", "runs": {"slim": {}, "aqp": {}}}]) == ""


def constants(name: str, refused: int, ratio: float) -> dict:
    status = "blocked" if refused else "converged"
    each = {"iterations": 4, "energy": [5.0, 2.0]}
    return {
        "name": name,
        "runs": {"ours": {**each, "status": "converged"}, "bdhm": {**each, "status": status}},
        "fine_means": [1.0, 6.0],
        "segments": 10_000,
        "perimeter": 100.0,
        "offset": 0.1,
        "refused": {"ours": 0, "bdhm": refused},
        "arrays": {"ours": np.array([1.0, 1.0]), "bdhm": np.array([ratio, 8.0])},
    }


def test_reasons_follow_the_numbers() -> None:
    text = "\n".join(lipschitz.section([constants("raptor", 6, 4.0)], "figures"))
    assert "on raptor they leave 6 of the segments unproved" in text
    assert "segments are long" not in text
    assert "**Reproduced.**" in text
    text = "\n".join(lipschitz.section([constants("giraffe", 0, 0.5)], "figures"))
    assert "on giraffe they prove it on every segment" in text
    # Two segments of a boundary that is 100 long.
    assert "| giraffe | 2 |" in text
    assert "On 2 segments (as many as 529, the paper's number, become" in text
    assert "on giraffe they are 50.00 units long, 500.0 times" in text
    assert "**Partly reproduced.**" in text


def test_far_energies_are_given_as_multiples() -> None:
    assert speed._left({"energy": [4e7], "minimum": 2.0}, "energy") == "at 2e+07 times it"
    assert speed._left({"energy": [2.08], "minimum": 2.0}, "energy") == "4.0% above"


def test_cost_stands_beside_the_speed() -> None:
    near = shape("a", run(4.0, {}, area_mean=2.0), run(4.0, {}, area_mean=2.05))
    near["runs"]["newton"]["area_mean"] = 2.2
    near["area_mean_below_ours"] = 2.001
    text = "\n".join(cost.energies([near]))
    assert "| a | 2.200 | 2.000 | 2.050 | 1.10x | 2.001 | 2.100 |" in text
    assert "at 1.10 times the lower of theirs, and below it on none of 1 shapes" in text
    assert "Where it is theirs, what lies between is the space's alone." in text
    assert "a ends at 2.100 instead of 2.200, after 1 iterations instead of 1" in text
    text = "\n".join(cost.energies([near, {**near, "name": "b", "area_mean_below_ours": 2.3}]))
    assert "on b it is not" in text
    # Without SLIM, and without a minimum below ours.
    alone = {**near, "area_mean_below_ours": None}
    alone["runs"] = {name: near["runs"][name] for name in ("newton", "aqp")}
    text = "\n".join(cost.energies([alone]))
    assert "| a | 2.200 | - | 2.050 | 1.07x | - | 2.100 |" in text
    assert "on a it finds none from there" in text
    text = "\n".join(cost.preparation([near, alone]))
    assert "| a | 250 ms | 250 ms | 250 ms | 125 ms |" in text
    assert "| a | 250 ms | - | 250 ms | 125 ms |" in text


def test_iterations_that_are_not_alike_are_said_so() -> None:
    cases = [{"name": n, "spread": [0.01, 0.01 * r]} for n, r in (("a", 2), ("b", 4))]
    text = iteration_times._unlike(cases)
    assert "most on b, where the dearest takes 4.0 times as long" in text
    assert "(40.0 against 10.0 ms" in text


def newton(iterations: int, energy: float = 2.0, status: str = "converged") -> dict:
    return {
        "status": status,
        "iterations": iterations,
        "energy": [9.0, energy],
        "time": [0.0, 0.1 * iterations],
        "step": [None, 1e-3],
    }


def solved(unmodified: dict, eigen: int, lbfgs: dict) -> dict:
    runs = {
        "newton": newton(6),
        "newton-paper": newton(20),
        "newton-unmodified": unmodified,
        "newton-eigen": newton(eigen),
        "lbfgs": lbfgs,
    }
    return {
        "name": "rex",
        "unknowns": 100,
        "handles": 8,
        "runs": runs,
        "light": {"newton": newton(6), "lbfgs": lbfgs},
        "negative": [0, 0],
        "contraction": {"least": 0.2, "most": 2.1, "least_projected": 0.5},
        "projected": newton(12),
    }


def test_halting_close_to_the_minimum_is_not_at_a_high_energy() -> None:
    slow = newton(1_700)
    low = solved(newton(2, 3.0, "indefinite"), 30, slow)
    assert "1.5 to 1.5 times" in progress._halts([low])
    assert "**Not reproduced.**" in progress._halts([low])
    high = solved(newton(2, 3e5, "indefinite"), 30, slow)
    assert "**Reproduced.**" in progress._halts([high])
    assert "**Partly reproduced.**" in progress._halts([low, high])
    through = progress._halts([high, solved(newton(9), 30, slow)])
    assert "of the 2 Hessians on its way none has a negative eigenvalue" in through


def test_newton_eigen_and_lbfgs_are_judged() -> None:
    halted = newton(2, 3e5, "indefinite")
    fair = progress._eigen([solved(halted, 30, newton(1_700))])
    assert "**Reproduced.**" in fair
    assert "on 1 with the samples and the certificate" in fair
    assert "alone (12 against 30)" in fair
    fewer = progress._eigen([solved(halted, 10, newton(1_700))])
    assert "20 against 10: the Hessian has no negative eigenvalue on the way" in fewer
    assert "from 0.20 to 2.10" in fewer
    astray = solved(halted, 120, newton(1_700))
    astray["runs"]["newton-eigen"] |= {"status": "max_iterations", "negative": [0, 4, 8]}
    astray["runs"]["newton-eigen"]["by_modulus"] = {"status": "converged", "iterations": 34}
    mixed = progress._eigen([solved(halted, 30, newton(1_700)), astray])
    # The run that was stopped is no win of the other method.
    assert "on 1 of the 1 shapes where Newton-Eigen converges" in mixed
    assert "steps are 1e-03 of a full one in the median, with 4.0% of the Hessian's" in mixed
    assert "by their modulus instead of 1e-10 it takes 34 iterations" in mixed
    assert "**Not judged.**" in progress._eigen([astray])
    assert "**Reproduced.**" in progress._lbfgs([solved(halted, 30, newton(1_700))])
    stuck = progress._lbfgs([solved(halted, 30, newton(2_000, 1e6, "max_iterations"))])
    assert "converges on 0 of 1 shapes" in stuck
    assert "**Partly reproduced.**" in stuck
    assert "1e-03" in stuck
    ended = progress._lbfgs([solved(halted, 30, newton(98, 2.0000001, "stationary"))])
    assert (
        "On rex it ends where no step lowers the energy in double precision, at most 5e-08" in ended
    )
    quick = progress._lbfgs([solved(halted, 30, newton(98))])
    assert "98 on rex" in quick
    assert "**Partly reproduced.**" in quick


@pytest.mark.parametrize(("flips", "said"), [(0, "**Reproduced.**"), (3, "**Not reproduced.**")])
def test_flips_of_any_iteration_count(flips: int, said: str) -> None:
    data = {"runs": {"slim": {"most_flips": flips, "iterations": 50}}}
    (text,) = progress._flips([data])
    assert said in text
    assert "in 50 iterations of 1 runs" in text
