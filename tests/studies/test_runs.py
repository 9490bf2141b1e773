"""What is kept of a run, and when a method counts as converged."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

from glid_nb.geometry import MeshMap, triangulate
from glid_nb.methods import AQP
from glid_nb.session.problem import Problem
from glid_nb.solvers import Iteration, Progress
from studies.cases import Case
from studies.compare.progress import ended_by
from studies.runs import VISIBLE, Watcher, outcome, reached, run, thumbnails

from ..support.problems import problem, run_method

pytestmark = pytest.mark.slow  # most of the time is compiling

MESH = triangulate(problem("ell")[0].cage, 20)


def step(iteration: int, flips: int = 0, seconds: float = 1.0) -> Iteration:
    return Iteration(
        iteration=iteration,
        energy_distortion=1.0,
        energy_p2p=0.0,
        step=1.0,
        time=seconds,
        flips=flips,
    )


def progress(iteration: int, shift: float) -> Progress:
    return Progress(
        method=AQP(),
        history=tuple(step(i) for i in range(1, iteration + 1)),
        initial=step(0),
        energy_distortion=1.0,
        energy_p2p=0.0,
        make=lambda: MeshMap(MESH, MESH.vertices + np.array([shift, 0])),
    )


def test_iterates_are_thinned_and_the_method_stopped_in_time() -> None:
    watcher = Watcher(MESH.vertices, seconds=999.5)
    stopped = [watcher(progress(i, 0.5 * i)) for i in range(1_000)]
    assert stopped.index(True) == 999
    kept = sorted(watcher.images)
    assert kept[:128] == list(range(128))
    for before, after in itertools.pairwise(kept[127:]):
        assert 1.01 * before <= after <= 1.01 * before + 1
    np.testing.assert_allclose(watcher.moved, [0, *[0.5] * 999])
    far = watcher.distance(MESH.vertices)
    np.testing.assert_allclose(list(far.values()), [0.5 * i for i in kept], atol=1e-12)


def test_harmonic_maps_are_watched_at_the_points() -> None:
    points = np.array([[0.1, 0.2], [-1.0, -1.0]])
    watcher = Watcher(points)
    result = run_method("newton", *problem("ell"), callback=watcher, iterations_per_call=1)
    np.testing.assert_allclose(watcher.images[result.iterations], result.map(points), rtol=1e-6)


def test_a_method_is_there_when_it_stays_there() -> None:
    far, near = 2 * VISIBLE, VISIBLE / 2
    distance = dict(enumerate([far, near, far, near, near]))
    energy = [9.0, 1.005, 1.5, 1.02, 1.009]
    moved = [0.0, far, near, far, near]
    found = reached(distance, moved, energy, 1.0, converged=False)
    assert found == {"energy": 4, "rest": 3, "map": 3}
    # Only kept iterates are known, so the next one counts.
    assert reached({0: far, 2: far, 4: near}, moved, energy, 1.0, False)["map"] == 4


def test_a_method_that_was_stopped_on_its_way_is_not_there() -> None:
    far = 2 * VISIBLE
    arguments = ({0: far, 1: far}, [0.0, far], [5.0, 3.0], 1.0)
    assert reached(*arguments, converged=False) == dict.fromkeys(("map", "energy", "rest"))
    assert reached(*arguments, converged=True)["rest"] == 1


def test_thumbnails_are_different_iterations_up_to_the_last() -> None:
    images = {i: np.full((3, 2), float(i)) for i in range(9)}
    chosen, pictures = thumbnails(images, 4)
    assert chosen == [1, 2, 5, 8]
    np.testing.assert_array_equal(pictures[:, 0, 0], chosen)
    assert thumbnails({i: images[i] for i in range(3)}, 4)[0] == [1, 2]
    assert thumbnails({3: images[3]}, 4)[0] == [3]


def test_thumbnails_end_with_the_run_that_counts() -> None:
    images = {i: np.full((3, 2), float(i)) for i in range(16)}
    end = np.full((3, 2), -1.0)
    # The watched run took 15 iterations.
    for iterations in (12, 15, 16):
        chosen, pictures = thumbnails(ended_by(images, iterations, end), 4)
        assert chosen[-1] == iterations
        np.testing.assert_array_equal(pictures[-1], end)
        np.testing.assert_array_equal(pictures[:-1, 0, 0], chosen[:-1])


def test_flips_count_at_every_iteration() -> None:
    case = Case("ell", Problem(*problem("ell")))
    result = run("mls", case, n_vertices=60)
    folded = replace(result, history=(step(1, flips=7), *result.history))
    assert folded.flips == 0
    assert outcome(folded)["most_flips"] == 7


def test_runs_are_from_the_identity() -> None:
    case = Case("bent", Problem(*problem("bent")))
    still = run("newton", case, max_iterations=0)
    points = np.array([[0.3, 0.1]])
    np.testing.assert_allclose(still.map(points), points, atol=1e-12)
