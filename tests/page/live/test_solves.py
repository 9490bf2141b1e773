"""Solves in the page end where the package's end; golden numbers are up to date."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

import glid_nb as glid
from glid_nb.solvers.stiffness import stiff_nodes

from ...support.domains import domain
from .golden import FOLDER, MINIMA, SAMPLES, energy_of_minimum, map_of, minimum, numbers_of, shape
from .in_node import answers

pytestmark = pytest.mark.slow

_HANDLES = [[-2.4, -2.4], [2.4, -1.5], [-1.5, 2.4]]
_TARGETS = [[-2.0, -2.6], [2.9, -0.4], [-0.9, 2.2]]


def golden(name: str) -> dict[str, Any]:
    return json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", SAMPLES)
def test_golden_numbers_are_up_to_date(name: str) -> None:
    """`python -m tests.page.live.golden` writes them again."""
    data = golden(name)
    traced, pose = shape(name)
    kept = glid.Domain.from_dict(data["outline"])
    for ours, theirs in zip(traced.cage.loops, kept.cage.loops, strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-9)
    assert pose.to_dict() == data["pose"]
    numbers = numbers_of(map_of(data))
    for key, value in numbers.items():
        np.testing.assert_allclose(data[key], value, rtol=1e-9, atol=1e-9, err_msg=key)


@pytest.mark.parametrize(("name", "index"), [("bar", 0), ("teapot", 2)])
def test_golden_minima_are_up_to_date(name: str, index: int) -> None:
    data = golden(name)
    result = minimum(*shape(name), *MINIMA[index])
    assert energy_of_minimum(result) == pytest.approx(data["minima"][index], rel=1e-8)


@pytest.mark.parametrize(
    "more",
    [
        {},
        {"weights": [1.0, 1e-4, 3.0]},
        {"angles": [None, 0.4, None]},
        {"angles": [0.2, 0.9, -0.3], "weights": [1.0, 1e-3, 1.0]},
        {"scales": [None, 1.3, 0.8]},
        {"angles": [None, 0.7, None], "scales": [None, 1.2, None]},
    ],
)
@pytest.mark.parametrize("name", ["ell", "ring"])
def test_a_solve_in_the_page_ends_where_the_packages_ends(name: str, more: dict[str, Any]) -> None:
    d = domain(name)
    handles = _HANDLES if name == "ell" else [[-2.0, 0.1], [2.0, 0.2], [0.1, 2.0]]
    targets = _TARGETS if name == "ell" else [[-2.2, 0.5], [2.1, -0.3], [0.4, 2.5]]
    map, result = _solved_by_both(d, glid.Pose(handles, targets, **more))
    assert map.distance(result.map) < 0.02


def _solved_by_both(d: glid.Domain, pose: glid.Pose) -> tuple[glid.HarmonicMap, glid.Result]:
    """The page's certified map and the package's result, which have the same energy."""
    result = glid.solve(d, pose, options=glid.Options(restarts=0))
    request = {"ask": "solve", "outline": d.to_dict(), "pose": pose.to_dict(), "options": {}}
    (answer,) = answers([request])
    assert answer["energy"] == pytest.approx(result.energy, rel=1e-6)
    parts = np.reshape(answer["coefficients"], (4, -1))
    map = glid.HarmonicMap(d, parts[0] + 1j * parts[1], parts[2] + 1j * parts[3])
    assert glid.certify(map).certified
    return map, result


def test_a_part_that_was_cut_loose_moves_in_the_page_too() -> None:
    (cage,) = glid.cut(domain("ell").cage, [[-1, 4], [-1, -2]])
    d = glid.Domain.from_cage(cage)
    pose = glid.Pose([[-2.4, 2.4], [-0.5, 2.4], [2, -1.5]], [[-0.2, 2.2], [-0.5, 2.4], [2, -1.5]])
    _solved_by_both(d, pose)


@pytest.mark.parametrize("name", ["ell", "ring"])
def test_a_solve_in_the_page_keeps_stiff_areas_as_the_package_does(name: str) -> None:
    d = domain(name)
    handles = [[-2.4, -2.4], [2.4, -1.5]] if name == "ell" else [[-2.0, 0.1], [2.0, 0.2]]
    targets = [[-2.0, -2.6], [2.9, 0.4]] if name == "ell" else [[-2.2, 0.5], [2.6, -0.9]]
    strokes = [{"points": [[1.5, -2.0], [2.2, -1.0]], "radius": 0.8, "strength": 0.9}]
    pose = glid.Pose(handles, targets, stiffness=strokes)
    result = glid.solve(d, pose, options=glid.Options(restarts=0))
    options = {"stiff": stiff_nodes(d, pose.stiffness)}
    plain = {"handles": handles, "targets": targets}
    asked = {"ask": "solve", "outline": d.to_dict(), "pose": plain, "options": options}
    without = {**asked, "options": {}}
    stiff, soft = answers([asked, without])
    assert stiff["energy"] == pytest.approx(result.energy, rel=1e-6)
    assert soft["energy"] < result.energy
