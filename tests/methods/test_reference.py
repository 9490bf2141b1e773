"""Methods on the reference problems."""

from __future__ import annotations

from pathlib import Path

import pytest

from glid_nb.session.problem import Problem

from ..support.problems import run_method

pytestmark = [pytest.mark.slow, pytest.mark.reference]


@pytest.mark.parametrize("name", ["rex", "deer", "giraffe"])
def test_lbfgs_reaches_newtons_minimum_with_the_published_weight(
    name: str, reference_folder: Path
) -> None:
    """From the identity, as in Figures 1 and 11; the published 1e5 is on sums of 10^4 samples."""
    problem = Problem.load(reference_folder / f"{name}.json")
    settings = {"p2p_weight": 20.0, "align": False}
    newton = run_method("newton", problem.domain, problem.pose, **settings)
    lbfgs = run_method("lbfgs", problem.domain, problem.pose, initial="dirichlet", **settings)
    assert lbfgs.status.ok, lbfgs.message
    assert lbfgs.energy == pytest.approx(newton.energy, rel=1e-5)
    assert 5 * newton.iterations < lbfgs.iterations < 1800
    assert lbfgs.certificate is not None
    assert lbfgs.certificate.certified
