"""Maps as functions of JAX, also outside their domain."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from glid_nb._features import enable_x64
from glid_nb._jax import jax, jnp
from glid_nb.geometry import Cage, GeometryError, MeshMap, triangulate
from glid_nb.harmonic.map import HarmonicMap, MapError

from ..support.domains import random_map

pytestmark = pytest.mark.slow

# In roundoffs of the values, which are a few units large, and of the derivatives.
PRECISION = {False: 1e-5, True: 1e-13}


def bent() -> HarmonicMap:
    return random_map("ring", 0.05, 1)


def inside(map: HarmonicMap) -> Any:
    points = np.concatenate([map.domain.cage.exterior * share for share in (0.9, 0.95)])
    return points[map.domain.cage.contains(points)]


def jacobian(map: HarmonicMap, points: Any) -> Any:
    """(k, 2, 2) by the map's own derivatives."""
    fz, fzb = map.wirtinger(points)
    x, y = fz + fzb, 1j * (fz - fzb)
    return np.stack([np.stack([x.real, y.real], -1), np.stack([x.imag, y.imag], -1)], -2)


@pytest.mark.parametrize("x64", [False, True])
def test_a_map_is_traced_mapped_and_differentiated(x64: bool) -> None:
    map, close = bent(), PRECISION[x64]
    points = inside(map)
    usual, slopes = map(points), jacobian(map, points)
    with enable_x64(x64):
        q = jnp.asarray(points)
        for images in (map(q), jax.jit(map)(q), jax.vmap(map)(q), map(q.reshape(2, -1, 2))):
            assert isinstance(images, jax.Array)
            assert images.dtype == q.dtype
            np.testing.assert_allclose(np.reshape(images, (-1, 2)), usual, atol=close)
        gradient = jax.grad(lambda q: map(q).sum())(q)
        np.testing.assert_allclose(gradient, slopes.sum(axis=1), atol=close)


def test_the_derivatives_of_jax_are_those_of_the_map() -> None:
    map, close = bent(), PRECISION[True]
    points = inside(map)
    slopes = jacobian(map, points)
    with enable_x64():
        q = jnp.asarray(points)
        for derivative in (jax.jacfwd, jax.jacrev):
            np.testing.assert_allclose(jax.vmap(derivative(map))(q), slopes, atol=close)
        for name in ("sigma1", "sigma2", "k", "det"):
            values = jax.jit(getattr(map, name))(q)
            np.testing.assert_allclose(values, getattr(map, name)(points), atol=close)
        hessian = jax.vmap(jax.hessian(lambda p: map(p)[0]))(q)
        second, _ = map.wirtinger_derivatives(points, 1)
        by_jax, _ = map.wirtinger_derivatives(q, 1)
        np.testing.assert_allclose(by_jax, second, atol=close)
        np.testing.assert_allclose(hessian[:, 0, 0] + hessian[:, 1, 1], 0, atol=10 * close)


def test_arrays_of_numpy_stay_in_double_precision_with_the_same_bits() -> None:
    map = bent()
    points = inside(map)
    usual = map(points)
    with enable_x64(False):
        jax.jit(map)(jnp.asarray(points))
        again = map(points)
    assert type(again) is np.ndarray
    assert again.dtype == np.float64
    assert again.tobytes() == usual.tobytes() == map(points.tolist()).tobytes()
    z = points @ np.array([1, 1j])
    for complex_points in (z, z.tolist(), np.asfortranarray(z.reshape(2, -1))):
        assert map(complex_points).tobytes() == usual.tobytes()
    assert map(complex(z[0])).tobytes() == usual[:1].tobytes()
    assert map(np.asfortranarray(points)).tobytes() == usual.tobytes()


def test_points_of_jax_that_are_none_are_refused() -> None:
    with pytest.raises(MapError, match=r"points must be \(..., 2\) coordinates.*float32.*\(5, 3\)"):
        bent()(jnp.zeros((5, 3), dtype=jnp.float32))


def test_outside_its_domain_a_map_gives_nan_where_asked() -> None:
    map = bent()
    points = np.concatenate([inside(map)[:2], [[50.0, 0], [0, 0]]])
    known = map.domain.cage.contains(points)
    assert known.tolist() == [True, True, False, False]  # beside the domain, and in the hole
    for name in ("__call__", "sigma1", "sigma2", "k", "det", "wirtinger"):
        evaluate = getattr(map, name)
        extended = np.moveaxis(np.asarray(evaluate(points)), 0, -1)
        assert (
            extended.tobytes()
            == np.moveaxis(np.asarray(evaluate(points, outside="extend")), 0, -1).tobytes()
        )
        for given in (points, jnp.asarray(points)):
            values = evaluate(given, outside="nan")
            for part in values if isinstance(values, tuple) else (values,):
                assert np.isfinite(np.asarray(part)).reshape(4, -1).all(axis=1).tolist() == [
                    *(True, True),
                    *(False, False),
                ]
    first, _ = map.wirtinger_derivatives(points, 2, outside="nan")
    assert np.isnan(first).tolist() == [False, False, True, True]
    rim = map.domain.cage.exterior
    assert np.isfinite(map(rim, outside="nan")).all()
    with pytest.raises(MapError, match="outside must be 'extend' or 'nan', not 'clip'"):
        map(points, outside="clip")  # type: ignore[arg-type]
    with pytest.raises(MapError, match=r"JAX traces these; ask domain\.cage\.contains"):
        jax.jit(lambda p: map(p, outside="nan"))(jnp.asarray(points))


def test_a_map_of_a_mesh_gives_nan_off_it_where_asked() -> None:
    cage = Cage([[0, 0], [3, 0.1], [2.9, 1.7], [0.2, 2]], [[[1, 1], [1.3, 1], [1.2, 1.2]]])
    mesh = triangulate(cage, 60)
    map = MeshMap(mesh, mesh.vertices + 1)
    points = np.array([[0.5, 0.5], [9, 9], [1.2, 1.1]])
    assert np.isfinite(map(points)).all()
    assert np.isnan(map(points, outside="nan")).all(axis=1).tolist() == [False, True, True]
    rim = np.linspace(cage.exterior[0], cage.exterior[1], 57)
    assert np.isfinite(map(rim, outside="nan")).all()
    np.testing.assert_allclose(map([0.5 + 0.5j]), [[1.5, 1.5]])
    with pytest.raises(GeometryError, match="outside must be"):
        map(points, outside="other")  # type: ignore[arg-type]
    with pytest.raises(GeometryError, match="JAX cannot trace it"):
        jax.jit(map)(jnp.asarray(points))
