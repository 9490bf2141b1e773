"""How far handles miss their targets, and the message if targets fold a shape."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from glid_nb.geometry import Cage, Domain, MeshMap, triangulate
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods import MovingLeastSquares
from glid_nb.minima import solve, solve_batch
from glid_nb.pose import Pose
from glid_nb.session.report import build_report
from glid_nb.solvers import Options, Status
from glid_nb.solvers.misses import Naming, misses_of, told, unit_of

SQUARE: Any = np.array([[-5.0, -5], [5, -5], [5, 5], [-5, 5]])
PULLED = np.array([[1.0, 0], [0, 0], [0, 0], [0, 1]])
FIVE = np.vstack([SQUARE, [[0, 0]]])


def box(scale: float = 1.0) -> Domain:
    return Domain.from_cage(Cage(scale * np.array([[-10, -8], [10, -8], [10, 8], [-10, 8]])))


def at_rest(handles: Any, targets: Any) -> str:
    """The message if the shape stays as it is."""
    pose, map = Pose(handles, targets), HarmonicMap.identity(box())
    return told(pose, misses_of(map, pose), unit_of(map))


@pytest.mark.parametrize(
    ("handles", "targets", "seen"),
    [
        (SQUARE, SQUARE * [-1, 1], "the targets mirror the handles"),
        (SQUARE, SQUARE[:, ::-1] * 0.5 + 3, "the targets mirror the handles"),
        (FIVE, FIVE[[1, 0, 2, 3, 4]], "the targets of handles 0 and 1 are swapped"),
        (FIVE, FIVE[[0, 1, 4, 3, 2]] + [30, 7], "the targets of handles 2 and 4 are swapped"),
        (SQUARE, SQUARE[[0, 0, 2, 3]], "the targets of handles 0 and 1 are the same place"),
        (
            [[0, 0], [0, 1e-3], [5, 0]],
            [[0, 0], [0, 5], [5, 0]],
            "0 and 1 are nearly the same",
        ),
        (
            SQUARE,
            [[-5, -5], [5, -5], [-6, -6], [-5, 5]],
            "turn over the triangle of handles 1, 2 and 3",
        ),
        (SQUARE, SQUARE @ [[0.6, 0.8], [-0.8, 0.6]] + 40, None),
        (SQUARE, SQUARE + PULLED, None),
        ([[0, 0], [1, 0], [2, 0]], [[2, 0], [1, 0], [0, 0]], None),  # half a turn
        ([[0, 0]], [[3, 0]], None),
    ],
)
def test_what_is_seen_in_targets(handles: Any, targets: Any, seen: str | None) -> None:
    text = at_rest(handles, targets)
    assert "units from its target" in text
    assert (seen in text) if seen else (":" not in text)


def test_sentences_take_the_names_of_the_caller() -> None:
    pose, map = Pose(SQUARE, [[-5, -5], [5, -5], [-6, -6], [-5, 5]]), HarmonicMap.identity(box())
    text = told(pose, misses_of(map, pose), unit_of(map), Naming("pin", 1))
    assert text.startswith("pin 3 is ")
    assert text.endswith("the triangle of pins 2, 3 and 4")


def test_what_cannot_be_seen_is_not_told() -> None:
    assert at_rest(SQUARE, SQUARE + 0.005) == ""
    assert at_rest(np.zeros((0, 2)), np.zeros((0, 2))) == ""


@pytest.mark.slow
def test_a_mirrored_square_is_told_in_message_and_report_at_every_scale() -> None:
    for scale in (1.0, 1e-4):
        pose = Pose(scale * SQUARE, scale * SQUARE * [-1, 1])
        result = solve(box(scale), pose, options=Options(restarts=0))
        images = result.map(pose.handles)
        np.testing.assert_allclose(result.misses, np.hypot(*(images - pose.targets).T))
        assert result.misses.max() > 4 * scale
        worst = int(result.misses.argmax())
        assert f" Handle {worst} is " in result.message
        why = "the targets mirror the handles, and maps without folds cannot mirror."
        assert result.message.endswith(why)
        report = build_report(result)
        assert report["misses"] == result.misses.tolist()
        assert report["message"] == result.message


@pytest.mark.slow
def test_every_result_knows_its_misses() -> None:
    light, square = Options(p2p_weight=1.0), Pose(SQUARE, SQUARE + PULLED)
    met = solve(box(), square)
    assert met.message == Status.CONVERGED.message
    assert met.misses.max() < 1e-3
    (result,) = solve_batch(box(), [square], options=light)
    assert "units from its target." in result.message
    exact = solve(box(), square, method=MovingLeastSquares(n_vertices=200))
    assert exact.misses.max() < 1e-12
    stopped = solve(box(), Pose(SQUARE, 2 * SQUARE), callback=lambda _: True)
    assert stopped.status is Status.STOPPED
    assert stopped.message == Status.STOPPED.message
    assert solve(box(), Pose(np.zeros((0, 2)), np.zeros((0, 2)))).misses.shape == (0,)


def test_a_map_of_a_mesh_is_measured_too() -> None:
    mesh = triangulate(box().cage, 100, points=SQUARE)
    map, pose = MeshMap(mesh, mesh.vertices + np.array([3, 4])), Pose(SQUARE, SQUARE)
    np.testing.assert_allclose(misses_of(map, pose), 5)
    assert unit_of(map) == pytest.approx(1)
