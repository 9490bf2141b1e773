"""The study of the live page: its solver in node beside the package's, and its tables."""

from __future__ import annotations

import numpy as np
import pytest

from studies.cases import sample_case
from studies.live import recorded, timings
from studies.study import Plan

pytestmark = pytest.mark.slow


def test_the_last_pin_runs_on_a_circle_from_its_handle() -> None:
    pose = sample_case("bar", "gentle").problem.pose
    targets = timings.circled(pose, 20.0, timings.POSITIONS)
    np.testing.assert_allclose(targets[0], pose.handles)
    np.testing.assert_array_equal(
        targets[:, :-1], np.broadcast_to(pose.handles[:-1], (60, *pose.handles[:-1].shape))
    )
    distance = np.linalg.norm(targets[:, -1] - pose.handles[-1], axis=1)
    assert distance.max() == pytest.approx(2.0)


def test_a_sample_is_timed_in_node_and_in_the_package() -> None:
    found = timings.measure(sample_case("bar", "gentle"), Plan(quick=True))
    (row,) = timings.tables([{"name": "bar-gentle", **found}])["times"]
    assert row["shape"] == "bar"
    assert row["vertices, holes"] == "37, 0"
    assert all(row[name] for name in ("set-up", "first solve", "drag step", "drag step, package"))


@pytest.mark.browser
def test_a_short_drag_is_recorded_and_all_its_maps_are_certified() -> None:
    run = recorded.RUNS[0]
    found = recorded.measure(
        sample_case("bar", "gentle"), run, 4.0
    )  # a busy machine may need a second for the first map
    assert found["maps"] > 0
    assert found["uncertified"] == 0
    (row,) = recorded.tables([found])["recorded"]
    assert row["shape, window"] == "bar, desktop"
