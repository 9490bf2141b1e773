"""Folds are counted, grouped and drawn."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from glid_nb.geometry import Cage, Domain, triangulate
from glid_nb.session import Problem
from glid_nb.solvers import Pose
from studies.comparisons import folding
from studies.comparisons.cases import Case
from studies.comparisons.page import page

from ...methods.problems import problem


def test_triangles_that_share_a_vertex_are_one_fold() -> None:
    triangles = np.array([[0, 1, 2], [5, 6, 7], [2, 3, 4], [7, 8, 9], [20, 21, 22]])
    np.testing.assert_array_equal(folding._groups(triangles), [0, 1, 0, 1, 2])


def test_the_outline_is_the_boundary() -> None:
    mesh = triangulate(problem("ring")[0].cage, 120)
    edges = folding._outline(mesh.triangles)
    assert len(edges) == mesh.n_boundary
    np.testing.assert_array_equal(np.unique(edges), np.arange(mesh.n_boundary))


@pytest.mark.slow
def test_from_measurement_to_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(folding, "MESH_VERTICES", 500)
    pytest.importorskip("igl")
    data = folding.measure(Case("bent", Problem(*problem("bent"))), lambda _: None)
    found = data["methods"]
    assert found["newton"] == {"flips": 0, "share": 0.0, "proved": True}
    rest, triangles = data["arrays"]["mesh"], data["arrays"]["triangles"]
    for name, counted in found.items():
        images = data["arrays"][f"images_{name}"]
        a, b = (
            np.stack([v[triangles[:, k]] - v[triangles[:, 0]] for k in (1, 2)], axis=-1)
            for v in (rest, images)
        )
        turned = np.linalg.det(b) <= 0
        assert counted["flips"] == turned.sum()
        area = np.linalg.det(a)
        assert counted["share"] == pytest.approx(area[turned].sum() / area.sum())
    assert max(counted["flips"] for counted in found.values()) > 0
    folding.draw([data], tmp_path / "folding.png")
    with Image.open(tmp_path / "folding.png") as picture:
        pixels = np.asarray(picture.convert("L"))
    assert (pixels < 50).mean() > 2e-4
    text = page({"folding": [data]}, "figures")
    assert "Ours turns over none and is proved locally injective on 1 of 1" in text
    assert f"| {found['bbw']['flips']:,}" in text


def test_zeros_of_a_holomorphic_derivative_are_counted() -> None:
    square = Domain.from_cage(Cage([[-2, -2], [2, -2], [2, 2], [-2, 2]]))
    z = np.exp(2j * np.pi * np.arange(8) / 8)
    handles = np.stack([z.real, z.imag], axis=1)
    for power in (1, 2, 3):
        w = z**power
        pose = Pose(handles, np.stack([w.real, w.imag], axis=1))
        assert folding._zeros(Case("square", Problem(square, pose))) == power - 1
