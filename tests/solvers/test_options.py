"""Settings of a solve: defaults, the paper's, and what is refused."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest

from glid_nb.solvers import Options
from glid_nb.solvers.options import OptionError


def test_defaults() -> None:
    options = Options()
    assert (options.sampling, options.certificate, options.hessian) == (
        *("graded", "hermite", "adaptive"),
    )
    assert options.p2p_weight == 1e5
    assert not options.conformal
    with pytest.raises(dataclasses.FrozenInstanceError):
        options.p2p_weight = 1.0  # type: ignore[misc]
    assert hash(options) == hash(Options())


def test_the_papers_settings() -> None:
    paper = Options.paper()
    assert (paper.sampling, paper.certificate, paper.hessian) == (
        *("uniform", "lipschitz", "projected"),
    )
    assert paper.p2p_weight == 1e5
    mixed = Options.paper(hessian="exact", p2p_weight=7.0)
    assert mixed == dataclasses.replace(paper, hessian="exact", p2p_weight=7.0)
    assert mixed != paper


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("sampling", ("graded", "uniform")),
        ("certificate", ("hermite", "lipschitz", "bdhm")),
        ("hessian", ("adaptive", "projected", "exact")),
        ("p2p_weight", (1e-300, 1, np.float32(2.5), 1e300)),
        ("tolerance", (0, 1e-3)),
        ("max_iterations", (0, 1, np.int64(50))),
        ("iterations_per_call", (1, 7)),
        ("corrections", (0, 3)),
        ("conformal", (True, False)),
    ],
)
def test_the_whole_range_is_accepted(name: str, values: tuple[Any, ...]) -> None:
    for value in values:
        assert getattr(Options(**{name: value}), name) == value


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("sampling", "random", "sampling must be one of graded, uniform, got 'random'"),
        ("sampling", None, "sampling must be one of graded, uniform, got None"),
        (
            "certificate",
            "Hermite",
            "certificate must be one of hermite, .*, got 'Hermite'",
        ),
        ("hessian", "", "hessian must be one of adaptive, projected, exact, got ''"),
        ("p2p_weight", 0, "p2p_weight must be a finite number greater than 0, got 0"),
        ("p2p_weight", -1.5, "p2p_weight .* got -1.5"),
        ("p2p_weight", math.nan, "p2p_weight .* got nan"),
        ("p2p_weight", math.inf, "p2p_weight .* got inf"),
        ("p2p_weight", "1e5", "p2p_weight .* got '1e5'"),
        ("p2p_weight", None, "p2p_weight .* got None"),
        ("p2p_weight", 1j, "p2p_weight"),
        ("tolerance", -1e-9, "tolerance must be a finite number at least 0"),
        ("tolerance", math.nan, "tolerance"),
        ("max_iterations", -1, "max_iterations must be a whole number of at least 0, got -1"),
        ("max_iterations", 2.0, "max_iterations must be a whole number"),
        ("max_iterations", True, "max_iterations must be a whole number"),
        ("max_iterations", "9", "max_iterations must be a whole number"),
        ("iterations_per_call", 0, "iterations_per_call must be a whole number from 1 to 7"),
        ("iterations_per_call", 8, "iterations_per_call must be a whole number from 1 to 7"),
        ("corrections", -1, "corrections must be a whole number from 0 to 3"),
        ("corrections", 4, "corrections must be a whole number from 0 to 3"),
        ("conformal", "no", "conformal"),
    ],
)
def test_values_out_of_range_are_refused(name: str, value: Any, message: str) -> None:
    with pytest.raises(OptionError, match=message):
        Options(**{name: value})
