"""Continuing from a result and splitting panels compile nothing."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from glid_nb import Options, Pose, Result, solve
from glid_nb._runtime import compilation_clock
from glid_nb.solvers.discretisation import discretise

from ..support.domains import domain

HANDLES = np.array([[-2.5, -2.0], [-2.5, 2.5], [2.5, -1.5], [0.0, -1.5]])
OPTIONS = Options(restarts=0)


def bent(amount: float, handles: np.ndarray = HANDLES) -> Pose:
    return Pose(handles, handles + amount * np.sin(3 * handles[:, ::-1]))


def compiled_by(action: Callable[[], Result]) -> int:
    before = compilation_clock().programs
    assert action().status.ok
    return compilation_clock().programs - before


@pytest.fixture(scope="module")
def first() -> Result:
    """Everything that a first solve and a solve from its result compile."""
    result = solve(domain("ell"), bent(0.1), None, OPTIONS)
    return solve(domain("ell"), bent(0.12), None, OPTIONS, result)


@pytest.mark.slow
def test_moved_targets_compile_nothing(first: Result) -> None:
    assert compiled_by(lambda: solve(domain("ell"), bent(0.2), None, OPTIONS)) == 0
    assert compiled_by(lambda: solve(domain("ell"), bent(0.14), None, OPTIONS, first)) == 0


@pytest.mark.slow
def test_panels_split_within_a_bucket_compile_nothing(first: Result) -> None:
    def split(place: int) -> Result:
        disc = first.discretisation
        chosen = np.zeros(len(disc.panels), dtype=bool)
        chosen[place : place + 2] = True
        return replace(first, discretisation=disc.split(chosen), factor=None)

    split(0)  # what cuts panels is compiled once
    assert compiled_by(lambda: solve(domain("ell"), bent(0.13), None, OPTIONS, split(4))) == 0


@pytest.mark.slow
def test_splitting_any_panels_makes_few_sizes() -> None:
    """Each size needs another program, and a person who drags waits for it to compile."""
    rng, sizes = np.random.default_rng(0), set[tuple[int, int]]()
    for _ in range(8):
        disc = discretise(domain("ell"))
        while len(disc.panels) < 700:
            disc = disc.split(rng.random(len(disc.panels)) < 0.1)
            sizes.add((len(disc.matrices.real), len(disc.matrices.hessian_index)))
    assert len(sizes) <= 6, sorted(sizes)
