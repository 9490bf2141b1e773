"""What is said of Hessians against what Newton's methods do with them."""

from __future__ import annotations

import numpy as np
import pytest

from glid_nb.harmonic import HarmonicMap
from glid_nb.session import Problem
from studies.comparisons.cases import Case
from studies.comparisons.curvature import contraction, negative_eigenvalues
from studies.comparisons.runs import run

from ...methods.problems import problem


def case(name: str) -> Case:
    return Case(name, Problem(*problem(name)))


@pytest.mark.slow
def test_newton_halts_at_the_first_negative_eigenvalue() -> None:
    halted = run("newton-unmodified", case("bent"))
    counts = negative_eigenvalues(case("bent"))
    assert halted.status.value == "indefinite"
    assert len(counts) == halted.iterations + 1
    assert counts[-1] > 0
    assert not any(counts[:-1])


@pytest.mark.slow
def test_contraction_is_that_of_a_step() -> None:
    ell = case("ell")
    minimum = run("newton-paper", ell).map
    assert isinstance(minimum, HarmonicMap)
    every = contraction(ell, minimum, 10_000)
    # The exact Hessian is never above the projected one of the same samples, but for a few more.
    assert every["most"] == pytest.approx(1, abs=1e-6)
    assert every["least"] == pytest.approx(every["least_projected"], abs=1e-4)
    assert 0 < every["least"] <= 1
    # The last gaps of an iteration with full steps fall at most by the slowest factor squared.
    energy = [step.energy for step in run("newton-paper", ell).history]
    paper = contraction(ell, minimum)
    slowest = max(1 - paper["least"], paper["most"] - 1)
    gaps = np.array(energy[:-1]) - energy[-1]
    falling = gaps[gaps > 1e-9 * energy[-1]]
    assert falling[-1] / falling[-2] <= slowest**2 + 0.05


@pytest.mark.slow
def test_few_samples_leave_directions_without_curvature() -> None:
    ell = case("ell")
    minimum = run("newton-paper", ell).map
    assert isinstance(minimum, HarmonicMap)
    assert contraction(ell, minimum, 3)["most"] > 100
    assert contraction(ell, minimum, 2_000)["most"] < 2
