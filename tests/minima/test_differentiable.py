"""A solve as a function of JAX."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from glid_nb._features import enable_x64
from glid_nb._jax import jax, jnp
from glid_nb.energies import AMIPS
from glid_nb.harmonic import HarmonicMap, MapError
from glid_nb.minima import DifferentiableSolve, differentiable, solve
from glid_nb.pose import Pose, PoseError
from glid_nb.solvers import Options, SensitivityError

from ..support.domains import domain

pytestmark = pytest.mark.slow

POSE = Pose([[-2, -2], [2, -2], [-2, 2]], [[-2, -2], [2.4, -1.2], [-1.5, 2.2]])
POINTS = np.array([[0.0, -1.0], [2.5, -0.5], [-1.0, 1.0]])


@pytest.fixture(autouse=True)
def _double() -> Iterator[None]:
    before = jax.config.values["jax_enable_x64"]
    jax.config.update("jax_enable_x64", True)
    yield
    jax.config.update("jax_enable_x64", before)


@functools.cache
def f() -> DifferentiableSolve:
    return differentiable(domain("ell"), POSE, AMIPS(s=0.8))


def images(targets: Any) -> Any:
    return f()(targets)(POINTS)


@functools.cache
def jacobian() -> Any:
    """(k, 2, h, 2) by the sensitivities of the result."""
    result = solve(domain("ell"), POSE, AMIPS(s=0.8))
    return np.stack([result.sensitivity(i)(POINTS) for i in range(len(POSE))], axis=2)


def close(a: Any, b: Any) -> None:
    np.testing.assert_allclose(a, b, atol=1e-7)


def test_the_value_is_the_map_of_the_solve() -> None:
    map_ = f()(POSE.targets)
    result = solve(domain("ell"), POSE, AMIPS(s=0.8))
    assert isinstance(map_.map, HarmonicMap)
    assert result.certificate is not None
    assert result.certificate.belongs_to(map_.map)
    close(map_(POINTS), result.map(POINTS))
    close(map_.sigma1(POINTS), map_.map.sigma1(POINTS))
    close(map_.sigma2(POINTS), map_.map.sigma2(POINTS))


def test_forwards_and_backwards_are_the_same_also_compiled() -> None:
    q = jnp.asarray(POSE.targets)
    for derivative in (jax.jacfwd(images), jax.jacrev(images), jax.jit(jax.jacrev(images))):
        close(derivative(q), jacobian())


def test_many_targets_are_mapped() -> None:
    q = jnp.asarray(POSE.targets)
    many = jnp.stack([q, q + 0.1])
    slopes = jax.jit(jax.vmap(jax.jacfwd(images)))(many)
    close(slopes[0], jacobian())
    close(slopes[1], jacobian())  # the whole shape is moved
    maps = jax.vmap(f())(many)
    close(jax.vmap(lambda map_: map_(POINTS))(maps)[1], images(q) + 0.1)
    with pytest.raises(MapError, match="many maps"):
        maps(POINTS)


def test_several_numbers_at_once() -> None:
    def loss(q: Any, p: Any, w: Any, s: Any) -> Any:
        return jnp.sum(f()(q, handles=p, weights=w, s=s)(POINTS) ** 2)

    given = [jnp.asarray(a) for a in (POSE.targets, POSE.handles, POSE.weights, 0.8)]
    found = jax.jit(jax.grad(loss, argnums=(0, 1, 2, 3)))(*given)
    result = solve(domain("ell"), POSE, AMIPS(s=0.8))
    outer = 2 * result.map(POINTS)
    for of, slope in zip(("targets", "handles", "weights", "s"), found, strict=True):
        many = [None] if of == "s" else range(len(POSE))
        wanted = [np.tensordot(outer, result.sensitivity(i, of)(POINTS), 2) for i in many]  # type: ignore[arg-type]
        close(np.ravel(slope), np.ravel(wanted))


def test_points_may_be_traced_with_the_targets() -> None:
    both = jax.grad(lambda p, q: f()(q)(p).sum(), argnums=(0, 1))
    at, targets = both(jnp.asarray(POINTS), jnp.asarray(POSE.targets))
    close(targets, jacobian().sum(axis=(0, 1)))
    close(at, jax.grad(lambda p: f()(POSE.targets).map(p).sum())(jnp.asarray(POINTS)))


def test_a_traced_map_has_no_numbers() -> None:
    with pytest.raises(MapError, match="no numbers yet"):
        jax.jit(lambda q: f()(q).map)(POSE.targets)


def test_second_derivatives_are_refused() -> None:
    with pytest.raises(ValueError, match="JVP"):
        jax.hessian(lambda q: images(q).sum())(jnp.asarray(POSE.targets))


def test_without_a_minimum_it_throws_or_gives_nan() -> None:
    few = Options(max_iterations=1, restarts=0)
    throws = differentiable(domain("ell"), POSE, options=few)
    with pytest.raises(RuntimeError, match="reached no minimum"):
        throws(POSE.targets)
    quiet = differentiable(domain("ell"), POSE, options=few, throw=False)
    value, slope = jax.value_and_grad(lambda q: quiet(q)(POINTS).sum())(jnp.asarray(POSE.targets))
    assert np.isfinite(value)
    assert np.isnan(slope).all()


def test_one_handle_leaves_a_rotation_free() -> None:
    one = differentiable(domain("ell"), POSE.only([0]))
    assert one(POSE.targets[:1])(POINTS).shape == (3, 2)
    with pytest.raises(RuntimeError, match="pin a second handle"):
        jax.grad(lambda q: one(q)(POINTS).sum())(jnp.asarray(POSE.targets[:1]))


def test_what_cannot_be_is_refused() -> None:
    with pytest.raises(SensitivityError, match="jax_enable_x64"), enable_x64(False):
        f()(POSE.targets)
    with pytest.raises(SensitivityError, match=r"targets have the shape \(2, 2\)"):
        f()(POSE.targets[:2])
    with pytest.raises(PoseError, match=r"targets\[0\] is"):
        f()(np.full((3, 2), np.nan))
    with pytest.raises(PoseError, match="lies outside the domain"):
        f()(handles=POSE.handles + 50)
    with pytest.raises(PoseError, match=r"weights\[0\] is -1"):
        f()(weights=-np.ones(3))
    with pytest.raises(SensitivityError, match="no parameter s"):
        differentiable(domain("ell"), POSE)(s=1.0)
    with pytest.raises(PoseError, match="outside the domain"):
        differentiable(domain("ell"), Pose([[9, 9]], [[0, 0]]))
    with pytest.raises(TypeError, match="pose must be"):
        differentiable(domain("ell"), None)  # type: ignore[arg-type]
