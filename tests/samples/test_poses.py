"""The poses that come with the pictures."""

from __future__ import annotations

import json
from itertools import product
from typing import Any, get_args

import numpy as np
import pytest

from glid_nb import samples
from glid_nb.imaging.frame import PixelFrame

KINDS = get_args(samples.PoseKind)
POSES = list(product(samples.names(), KINDS))


def pose(name: str, kind: samples.PoseKind) -> dict[str, Any]:
    return json.loads(samples.pose_path(name, kind).read_text(encoding="utf-8"))


@pytest.mark.parametrize(("name", "kind"), POSES)
def test_four_to_nine_handles_and_as_many_targets(name: str, kind: samples.PoseKind) -> None:
    data = pose(name, kind)
    assert set(data) == {"description", "handles", "targets"}
    assert 4 <= len(data["handles"]) <= 9
    assert np.shape(data["targets"]) == np.shape(data["handles"]) == (len(data["handles"]), 2)
    assert len(data["description"]) > 20


@pytest.mark.slow
@pytest.mark.parametrize(("name", "kind"), POSES)
def test_handles_lie_well_inside_the_body(name: str, kind: samples.PoseKind) -> None:
    alpha = samples.image(name)[..., 3]
    height, width = alpha.shape
    frame = PixelFrame(width, height)
    column, row = frame.to_pixel(np.array(pose(name, kind)["handles"])).T.astype(int)
    reach = round(0.2 / frame.units_per_pixel)
    for dx, dy in ((0, 0), (reach, 0), (-reach, 0), (0, reach), (0, -reach)):
        assert (alpha[row + dy, column + dx] == 255).all()


@pytest.mark.parametrize(("name", "kind"), POSES)
def test_targets_lie_inside_the_picture(name: str, kind: samples.PoseKind) -> None:
    height, width = samples.image(name).shape[:2]
    half = 10 * np.array([width, height]) / max(width, height)
    assert (np.abs(pose(name, kind)["targets"]) < half - 0.5).all()


@pytest.mark.parametrize("name", samples.names())
def test_the_extreme_pose_goes_further_than_the_gentle_one(name: str) -> None:
    way = {}
    for kind in KINDS:
        data = pose(name, kind)
        away = np.subtract(data["targets"], data["handles"])
        way[kind] = np.linalg.norm(away, axis=1).max()
    assert 0.5 < way["gentle"] < 3.0
    assert way["extreme"] > 1.5 * way["gentle"]


def test_an_unknown_kind_is_refused() -> None:
    with pytest.raises(samples.SampleError, match="no pose 'wild': choose one of gentle, extreme"):
        samples.pose_path("gecko", "wild")  # pyright: ignore[reportArgumentType]
