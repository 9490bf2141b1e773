"""The same deformation in every unit of length and at every place."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
import pytest

from glid_nb import methods
from glid_nb.geometry import Cage, Domain
from glid_nb.minima import solve, solve_batch
from glid_nb.pose import Pose
from glid_nb.solvers import Options, Result

pytestmark = pytest.mark.slow

BAR = np.array([[-10.0, -3], [10, -3], [10, 3], [-10, 3]])
HOLE = np.array([[-2.0, -1], [-2, 1], [0, 1], [0, -1]])
HANDLES = np.array([[-8.0, 0], [0, 2], [8, 0]])
TARGETS = np.array([[-8.0, 0], [0, 8], [8, 0]])
SCALES = (1e-6, 1e-3, 1e3, 1e6)
FAR = np.array([700.0, -300.0])
# With holes, the steps of these methods depend on the unit, because the logarithms do.
WITHOUT_HOLES = ("lbfgs", "gradient-descent", "levenberg-marquardt")
EVERY = tuple(
    name
    for name, method in methods.METHODS.items()
    if method.available() and name not in ("newton", "newton-paper")
)


def posed(scale: float, place: Any, holed: bool = True, **more: Any) -> tuple[Domain, Pose]:
    def moved(points: Any) -> Any:
        return scale * np.asarray(points) + place

    if "stiffness" in more:
        line = moved([[-6, 0], [-4, 0]])
        more = {"stiffness": [{"points": line, "radius": 2 * scale, "strength": 0.7}]}
    domain = Domain.from_cage(Cage(moved(BAR), [moved(HOLE)] * holed))
    return domain, Pose(moved(HANDLES), moved(TARGETS), **more)


def seen(result: Result, scale: float, place: Any) -> Any:
    """Images of fixed points, in the units of the bar."""
    points = np.array([[-9.0, 2], [-5, -2], [0.5, 0], [4, 2.5], [9, -1]])
    return (result.map(scale * points + place) - place) / scale


@functools.cache
def solved(scale: float, place: tuple[float, float], kind: str) -> tuple[Any, Result]:
    more: dict[str, Any] = {}
    options, method = Options(), None
    if kind == "pins":
        more = {"angles": [0.5, None, None], "scales": [None, 1.3, None], "weights": [1, 2, 1e-2]}
    elif kind == "stiff":
        more = {"stiffness": True}
    elif kind == "paper":
        options = Options.paper()
    elif kind != "newton":
        mesh = methods.METHODS[kind].family != "harmonic"
        method = methods.by_name(kind, **({"n_vertices": 300} if mesh else {}))
        # L-BFGS is chaotic close to a fold, where heavy weights lead it.
        options = Options(p2p_weight=20, max_iterations=20)
    domain, pose = posed(scale, place, kind not in WITHOUT_HOLES, **more)
    result = solve(domain, pose, options=options, method=method)
    return seen(result, scale, place), result


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("kind", ["newton", "pins", "stiff", "paper"])
def test_a_shape_deforms_alike_at_every_scale(kind: str, scale: float) -> None:
    (images, result), (usual, known) = (solved(s, (0.0, 0.0), kind) for s in (scale, 1.0))
    np.testing.assert_allclose(images, usual, rtol=0, atol=1e-9)
    assert (result.status, result.iterations) == (known.status, known.iterations)
    assert result.energy == pytest.approx(known.energy, rel=1e-12)
    assert result.misses / scale == pytest.approx(known.misses, abs=1e-9)


@pytest.mark.parametrize("kind", ["newton", "pins", "stiff"])
def test_a_shape_deforms_alike_in_another_place(kind: str) -> None:
    images, result = solved(1.0, tuple(FAR), kind)
    usual, known = solved(1.0, (0.0, 0.0), kind)
    np.testing.assert_allclose(images, usual, rtol=0, atol=1e-8)
    assert result.iterations == known.iterations


@pytest.mark.parametrize("name", EVERY)
def test_other_methods_deform_alike_at_every_scale(name: str) -> None:
    usual, known = solved(1.0, (0.0, 0.0), name)
    for scale in (1e-6, 1e6):
        images, result = solved(scale, (0.0, 0.0), name)
        np.testing.assert_allclose(images, usual, rtol=0, atol=1e-6)
        assert (result.status, result.iterations) == (known.status, known.iterations)


def test_a_batch_deforms_alike_at_every_scale() -> None:
    ways = []
    for scale in (1e-5, 1.0):
        domain, pose = posed(scale, 0.0)
        results = solve_batch(domain, [pose, pose.with_targets(pose.handles)])
        ways.append([seen(result, scale, 0.0) for result in results])
    np.testing.assert_allclose(*ways, rtol=0, atol=1e-9)


def test_the_weight_in_the_cages_own_units() -> None:
    domain, _ = posed(1e-3, 0.0)
    assert domain.cage.unit == pytest.approx(1e-3)
    assert Options(p2p_weight=7).lambda_on(domain.cage) == pytest.approx(7e6)
    _, result = solved(1e-3, (0.0, 0.0), "newton")
    lam = result.options.lambda_on(domain.cage)
    assert result.energy_p2p == pytest.approx(lam / 2 * (result.misses**2).sum(), rel=1e-6)
