"""Bounded distortion harmonic maps keep their bounds, by an evaluation of their own."""

from __future__ import annotations

import functools

import numpy as np
import pytest

from glid_nb.compare import MethodError, MethodResult, run_method
from glid_nb.compare.bdhm.bounds import DistortionBounds
from glid_nb.energies import ARAP
from glid_nb.harmonic import HarmonicMap
from glid_nb.solvers import Status

from ..reference_map import DenseCheck, Measured
from .problems import problem

pytest.importorskip("clarabel")

LOOSE, TIGHT = (0.8, 5.0, 0.3), (0.16, 1.42, 0.72)


@functools.cache
def run(name: str, bounds: tuple[float, float, float]) -> MethodResult:
    k, sigma1, sigma2 = bounds
    return run_method("bdhm", *problem(name), k=k, sigma1=sigma1, sigma2=sigma2)


def measured(map: HarmonicMap) -> Measured:
    domain = map.domain
    rho = domain.hole_points @ np.array([1, 1j])
    loops = domain.cage_loops_complex
    return DenseCheck.on(loops, domain.offset_loops_complex, rho, 100_000).measure(map.phi, map.psi)


@pytest.mark.parametrize("bounds", [LOOSE, TIGHT], ids=["loose", "tight"])
@pytest.mark.parametrize("name", ["ell", "ring", "bent"])
def test_the_bounds_hold_densely_and_are_certified(
    name: str, bounds: tuple[float, float, float]
) -> None:
    result = run(name, bounds)
    k, sigma1, sigma2 = bounds
    assert isinstance(result.map, HarmonicMap)
    dense = measured(result.map)
    certificate = result.certificate
    assert certificate is not None
    assert certificate.certified
    assert dense.k <= certificate.k_upper <= k
    assert dense.sigma1 <= certificate.sigma1_upper <= sigma1
    assert dense.sigma2 >= certificate.sigma2_lower >= sigma2
    assert sum(dense.windings) == 0


@pytest.mark.parametrize("name", ["ell", "ring"])
def test_bounds_that_do_not_bind_leave_the_arap_minimum(name: str) -> None:
    """Within wide bounds the alternation of frames and programs is ARAP's local/global method."""
    result = run_method("bdhm", *problem(name), tolerance=1e-8, max_iterations=100)
    assert result.status is Status.CONVERGED
    newton = run_method("newton", *problem(name), ARAP())
    # Midpoints against Simpson's rule.
    assert result.energy == pytest.approx(newton.energy, rel=2e-3)


def test_bounds_that_bind_cost_energy() -> None:
    loose, tight = run("ring", LOOSE), run("ring", TIGHT)
    certificate = tight.certificate
    assert certificate is not None
    assert certificate.sigma1_upper > 0.97 * TIGHT[1]
    assert tight.energy > loose.energy


def test_every_iterate_keeps_the_bounds() -> None:
    domain, pose = problem("ring")
    seen = []

    def look(progress: object) -> None:
        seen.append(measured(progress.map))

    k, sigma1, sigma2 = TIGHT
    run_method(
        "bdhm", domain, pose, k=k, sigma1=sigma1, sigma2=sigma2, max_iterations=3, callback=look
    )
    assert len(seen) == 4
    for dense in seen:
        assert dense.k <= k
        assert dense.sigma1 <= sigma1
        assert dense.sigma2 >= sigma2


@pytest.mark.parametrize(
    ("name", "value"),
    [("k", 1.0), ("k", 0.0), ("sigma1", 1.0), ("sigma2", 1.0), ("sigma2", -0.1), ("k", "no")],
)
def test_bounds_out_of_range_are_refused(name: str, value: object) -> None:
    with pytest.raises(MethodError, match=f"the bound {name} must lie between"):
        DistortionBounds(**{name: value})


def test_it_goes_on_from_a_map_within_its_bounds() -> None:
    tight = run("ring", TIGHT)
    assert isinstance(tight.map, HarmonicMap)
    bounds = dict(zip(("k", "sigma1", "sigma2"), LOOSE, strict=True))
    settings = {"align": False, "max_iterations": 0, **bounds}
    again = run_method("bdhm", *problem("ring"), start=tight.map, **settings)
    assert again.energy == pytest.approx(tight.energy, rel=1e-9)
    # A map beyond the bounds gives way to the identity.
    beyond = {**settings, "sigma1": 1.2}
    anew = run_method("bdhm", *problem("ring"), start=tight.map, **beyond)
    assert anew.energy_iso == pytest.approx(0.0, abs=1e-12)
