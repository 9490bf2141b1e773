"""Folds are counted, grouped and drawn."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from glid_nb.geometry import triangulate
from glid_nb.session.problem import Problem
from studies.cases import Case
from studies.compare import folding
from studies.study import Plan

from ..support.problems import problem


def test_the_outline_is_the_boundary() -> None:
    mesh = triangulate(problem("ring")[0].cage, 120)
    edges = folding.outline_of(mesh.triangles)
    assert len(edges) == mesh.n_boundary
    np.testing.assert_array_equal(np.unique(edges), np.arange(mesh.n_boundary))


@pytest.mark.slow
def test_from_measurement_to_table(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(folding, "MESH_VERTICES", 500)
    pytest.importorskip("igl")
    data = folding.measure(Case("bent", Problem(*problem("bent"))), Plan())
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
    folding.draw([{"name": "bent", **data}], tmp_path)
    with Image.open(tmp_path / "folding.webp") as picture:
        pixels = np.asarray(picture.convert("L"))
    assert (pixels < 50).mean() > 2e-4
    (row,) = folding.tables([{"name": "bent", **data}])["folding"]
    assert row["ours"] == "0"
    assert row["bounded biharmonic weights"].startswith(f"{found['bbw']['flips']:,}")
