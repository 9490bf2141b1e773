"""Stiff areas: their strokes, their weights, and that they keep their shape."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb import methods
from glid_nb._jax import jax
from glid_nb._runtime import compilation_clock, double_precision
from glid_nb.energies import SymmetricDirichlet
from glid_nb.minima import solve, solve_batch
from glid_nb.pose import FULL_WEIGHT, Pose, Stiffness, StiffnessError
from glid_nb.solvers import MethodError, Options, evaluation
from glid_nb.solvers.discretisation import discretise
from glid_nb.solvers.hessian import assemble, local_hessian
from glid_nb.solvers.problem import real_coefficients
from glid_nb.solvers.stiffness import NODES, stiff_matrices

from ..support.checks import check_certified
from ..support.domains import domain, random_map, real, reference
from ..support.reference_map import points_inside

HEADS = {"ell": ([[-2.2, 2.2], [-1.6, 2.4]], 1.4), "ring": ([[2.2, 0.4]], 1.3)}
"""By their domains: the lines and the radii of strokes."""
# One handle in the head, three far from it.
HANDLES = {
    "ell": np.array([[-1.6, 2.4], [-2.5, -2.5], [-1.5, -1.5], [2.6, -2.4]]),
    "ring": np.array([[2.2, 0.4], [-2.4, 1.0], [-2.4, -1.0], [-1.0, -2.3]]),
}
OPTIONS = Options(restarts=0)


def head(name: str, strength: float = 1.0) -> Stiffness:
    return Stiffness().painted(*HEADS[name], strength)


def posed(name: str, stiffness: Any = None) -> Pose:
    targets = HANDLES[name].copy()
    targets[0] += {"ell": [1.2, -0.3], "ring": [0.3, 1.3]}[name]
    return Pose(HANDLES[name], targets, stiffness=stiffness)


@given(
    strokes=st.lists(
        st.tuples(
            st.lists(st.tuples(st.floats(-9, 9), st.floats(-9, 9)), min_size=1, max_size=4),
            st.floats(0.1, 5),
            st.sampled_from([0.0, 0.25, 1.0]),
        ),
        max_size=5,
    ),
    point=st.tuples(st.floats(-9, 9), st.floats(-9, 9)),
)
@settings(max_examples=60)
def test_the_last_stroke_over_a_point_counts(strokes: list, point: tuple[float, float]) -> None:
    stiffness, expected = Stiffness(), 0.0
    for points, radius, strength in strokes:
        stiffness = stiffness.painted(points, radius, strength)
        gap = distance_to_line(np.array(point), np.array(points))
        if 0.97 * radius < gap < 1.03 * radius:
            return  # a round brush is a polygon
        expected = strength if gap <= radius else expected
    assert stiffness([point])[0] == expected
    again = Stiffness.of(stiffness.to_list())
    assert again == stiffness
    assert again([point])[0] == expected
    assert bool(stiffness) == bool(stiffness.areas)


def distance_to_line(point: np.ndarray, line: np.ndarray) -> float:
    best = float(np.linalg.norm(line - point, axis=1).min())
    for a, b in itertools.pairwise(line):
        length = float((b - a) @ (b - a))
        if length > 1e-12:
            t = np.clip((point - a) @ (b - a) / length, 0, 1)
            best = min(best, float(np.linalg.norm(a + t * (b - a) - point)))
    return best


@pytest.mark.parametrize(
    ("strokes", "message"),
    [
        ("head", "stiffness must be list or tuple, not str; a list of strokes"),
        (
            [{"points": [[0, 0]]}],
            r"stiffness\[0\]: a stroke has exactly the keys points, radius, strength",
        ),
        ([{"points": [], "radius": 1, "strength": 1}], r"stiffness\[0\]: points must be 1 to"),
        ([{"points": [[0, math.nan]], "radius": 1, "strength": 1}], "within 1e"),
        ([{"points": [[0, 0]], "radius": 0, "strength": 1}], "radius must be .* greater than 0"),
        ([{"points": [[0, 0]], "radius": 1, "strength": 2}], "strength must be .* at most 1"),
    ],
)
def test_a_bad_stroke_is_named(strokes: Any, message: str) -> None:
    with pytest.raises(StiffnessError, match=message):
        Pose([], [], stiffness=strokes)


def test_a_pose_keeps_its_stiff_areas() -> None:
    pose = posed("ell", head("ell", 0.5))
    assert pose.only([1]).stiffness == pose.with_targets(pose.handles).stiffness == pose.stiffness
    assert Pose.from_dict(pose.to_dict()).stiffness == pose.stiffness
    assert "stiffness" not in posed("ell").to_dict()
    assert not pose.same_constraints(posed("ell"))


def test_nothing_painted_changes_nothing() -> None:
    disc = discretise(domain("ell"))
    beside = Stiffness().painted([[20, 20]], 1)
    assert stiff_matrices(disc, beside) is disc.matrices
    assert disc.matrices.stiff is None
    # Dabs far apart, smaller than any grid, have a node, too.
    dabs = Stiffness().painted([[-2.9, 2.9]], 1e-5).painted([[2.9, -2.9]], 1e-5)
    assert np.count_nonzero(np.asarray(stiff_matrices(disc, dabs).weights)[-NODES:]) == 1


@double_precision
def test_weights_nodes_and_energy_of_an_isometry() -> None:
    disc = discretise(domain("ell"))
    m, plain = stiff_matrices(disc, head("ell", 0.5)), disc.matrices
    added = np.asarray(m.weights)[:-NODES] - np.asarray(plain.weights)
    panels = disc.panels
    expected = np.zeros(len(added))
    both = (0, panels.start), (len(plain.real), panels.middle)
    for first, z in both:
        strengths = head("ell", 0.5)(real(z))
        expected[first : first + len(z)] = FULL_WEIGHT**strengths - 1
    np.testing.assert_allclose(added, expected * np.asarray(plain.weights), atol=1e-15)
    # Inside, the integral over the area, as a share of the whole.
    (area,) = head("ell").within(domain("ell").cage).values()
    share = area.area / domain("ell").cage.area * (math.sqrt(FULL_WEIGHT) - 1)
    assert np.asarray(m.weights)[-NODES:].sum() == pytest.approx(share)
    y = real_coefficients(random_map("ell", 0.0, 0))
    energy = evaluation.energy_distortion(evaluation.products(m, y).values, m, SymmetricDirichlet())
    assert float(energy) == pytest.approx(2, abs=1e-12)


@pytest.mark.slow
@double_precision
def test_derivatives_are_those_of_automatic_differentiation() -> None:
    disc, energy = discretise(domain("ell")), SymmetricDirichlet()
    m = disc.full(stiff_matrices(disc, head("ell")))
    map_ = random_map("ell", 0.02, 3)
    y = real_coefficients(map_)
    along = np.random.default_rng(0).normal(size=len(y))

    @jax.jit
    def both(y: Any) -> tuple[Any, ...]:
        def value(y: Any) -> Any:
            return evaluation.energy_distortion(evaluation.products(m, y).values, m, energy)

        nodes = evaluation.products(m, y).values
        squares = evaluation.squares(nodes)
        d = energy.differentials(*squares)
        gradient = evaluation.energy_gradient(m, nodes, d)
        f, g = evaluation.directions(nodes)
        upper = assemble(m.nodes, m.weights, f, g, local_hessian(d, *squares))
        return gradient, upper, *jax.jvp(jax.grad(value), (y,), (along,))

    gradient, upper, expected, change = map(np.asarray, both(y))
    np.testing.assert_allclose(gradient, expected, atol=1e-10 * np.abs(expected).max())
    hessian = np.triu(upper) + np.triu(upper, 1).T
    np.testing.assert_allclose(hessian @ along, change, atol=1e-9 * np.abs(change).max())


@pytest.mark.slow
@pytest.mark.parametrize("name", HEADS)
def test_a_stiff_head_keeps_its_shape(name: str) -> None:
    stiff = solve(domain(name), posed(name, head(name)), options=OPTIONS)
    assert stiff.status.ok
    check_certified(stiff)
    loops = domain(name).cage.loops_complex
    edges = [a + np.linspace(0, 1, 200)[:, None] * (np.roll(a, -1) - a) for a in loops]
    z = np.concatenate([points_inside(loops, 20_000), *(edge.ravel() for edge in edges)])
    inside = head(name)(real(z)) == 1
    assert np.count_nonzero(inside) > 1000
    ratio = reference(stiff.map).sigma1(z) / reference(stiff.map).sigma2(z)
    assert ratio[inside].max() < 1.1
    assert ratio.max() > 1.5
    np.testing.assert_allclose(stiff.map(HANDLES[name]), stiff.pose.targets, atol=1e-3)
    if name == "ell":  # painting more compiles nothing, and neither does a batch
        assert compiled_by_more_paint() == 0
        (other,) = solve_batch(domain(name), [posed(name, head(name))], options=OPTIONS)
        assert other.energy == pytest.approx(stiff.energy, rel=1e-9)


def compiled_by_more_paint() -> int:
    before = compilation_clock().programs
    more = head("ell").painted([[-1, -1], [0, -2]], 0.7, 0.4).painted([[-2, 2]], 0.2, 0)
    first = solve(domain("ell"), posed("ell", more), options=OPTIONS)
    # Continuing from a result whose Hessian has other weights.
    again = solve(domain("ell"), posed("ell", head("ell")), options=OPTIONS, start=first)
    assert first.status.ok
    assert again.status.ok
    return compilation_clock().programs - before


@pytest.mark.parametrize("method", [methods.BDHM(), methods.MovingLeastSquares(), methods.AQP()])
def test_methods_without_stiff_areas_refuse_by_name(method: methods.Method) -> None:
    with pytest.raises(MethodError, match=f"'{method.name}' does not support stiff areas"):
        solve(domain("ell"), posed("ell", head("ell")), method=method)
