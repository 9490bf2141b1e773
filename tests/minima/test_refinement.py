"""Finer bases on the same cage: at first the same map, then a lower minimum."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from glid_nb.cli.output import summary_text
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods import BDHM
from glid_nb.minima import refine, solve
from glid_nb.minima.solve import in_finer_basis
from glid_nb.pose import Pose
from glid_nb.session.report import build_report
from glid_nb.solvers import Options
from glid_nb.solvers.method import MethodError

from ..support.checks import check_certified
from ..support.domains import domain, random_map


@pytest.mark.parametrize("name", ["ell", "ring", "twin"])
def test_a_map_stays_the_same_in_a_finer_basis(name: str) -> None:
    map_ = random_map(name, 0.2, 0)
    finer = in_finer_basis(map_)
    points = np.asarray(domain(name).cage.exterior) * 0.97
    points = points[domain(name).cage.contains(points)]
    assert finer.domain.offset_cage.n_vertices > map_.domain.offset_cage.n_vertices
    assert finer.domain.cage is map_.domain.cage
    np.testing.assert_allclose(finer(points), map_(points), atol=1e-11)


def test_edges_as_short_as_their_distance_from_the_cage_stay_whole() -> None:
    map_ = HarmonicMap.identity(domain("ell"))
    for _ in range(12):
        before, map_ = map_, in_finer_basis(map_)
        if map_ is before:
            return
    raise AssertionError("edges are divided for ever")


@pytest.mark.slow
def test_bases_are_refined_until_the_energy_hardly_changes() -> None:
    pose = Pose([[-2, -2], [2, -2], [-2, 2]], [[-2, -2], [2, 0], [0, 2]])
    result = solve(domain("ell"), pose, options=Options(restarts=0))
    finer = refine(result, gain=0.03)
    energies = [step.energy for step in finer.refinements]
    before, last = energies[-2:]
    assert energies[0] == result.energy
    assert last == finer.energy <= before
    assert before - last < 0.03 * before
    unknowns = [step.unknowns for step in finer.refinements]
    assert unknowns == sorted(set(unknowns))
    check_certified(finer)
    assert isinstance(finer.map, HarmonicMap)
    assert isinstance(finer.map.domain, Domain)
    report = build_report(finer)
    assert [one["energy"] for one in report["refinements"]][-1] == report["E"]
    assert f"{unknowns[-1]} unknowns" in summary_text(report, [])


@pytest.mark.slow
def test_the_gain_is_a_fraction() -> None:
    pose = Pose([[-2, -2]], [[-2, -2]])
    result = solve(domain("ell"), pose, options=Options(restarts=0, max_iterations=0))
    with pytest.raises(ValueError, match="between 0 and 1"):
        refine(result, gain=0)


@pytest.mark.slow
def test_results_without_a_basis_of_their_own_are_refused_by_name() -> None:
    pose = Pose([[-2, -2]], [[-2, -2]])
    result = solve(domain("ell"), pose, options=Options(restarts=0, max_iterations=0))
    with pytest.raises(MethodError, match="BDHM"):
        refine(dataclasses.replace(result, method=BDHM(), discretisation=None), gain=0.5)
