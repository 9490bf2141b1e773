"""The reference problems' own cages, offset cages and sample counts."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from glid_nb.geometry import Domain, offset_cage, uniform_panels

pytestmark = pytest.mark.reference


def problems(folder: Path) -> list[dict]:
    found = [json.loads(p.read_text(encoding="utf-8")) for p in sorted(folder.glob("*.json"))]
    assert found, f"no problems in {folder}"
    return found


def test_given_domains_are_taken_as_they_are(reference_folder: Path) -> None:
    for data in problems(reference_folder):
        domain = Domain.from_dict(data)
        rows = {tuple(p) for p in domain.offset_cage.exterior.tolist()}
        assert rows == {tuple(p) for p in data["offset_cage"]}, data["name"]
        assert domain.n_holes == len(data["holes"])


def test_sample_counts(reference_folder: Path) -> None:
    for data in problems(reference_folder):
        samples = uniform_panels(Domain.from_dict(data).cage, 10_000)
        assert len(samples) == data["n_samples"], data["name"]


def test_our_offset_is_theirs_where_nothing_is_narrow(reference_folder: Path) -> None:
    same = []
    for data in problems(reference_folder):
        given = Domain.from_dict(data)
        ours = offset_cage(given.cage, data["offset"])
        far = [
            np.abs(a[:, None] - b[None]).sum(axis=2).min(axis=1)
            for a, b in zip(ours.cage.loops, given.offset_cage.loops, strict=True)
        ]
        same.append(np.concatenate(far) < 1e-9)
        assert same[-1].mean() > 0.9, data["name"]
    assert np.concatenate(same).mean() > 0.98
