"""The minimum on a mesh against the methods that descend to it, and against differences."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from scipy.spatial import KDTree

from glid_nb.energies import SymmetricDirichlet
from glid_nb.geometry import MeshMap
from glid_nb.solvers import Result
from studies.compare import minimum
from studies.compare.minimum import Constraints, NoMinimumError, mesh_minimum

from ..support.problems import problem, run_method

pytestmark = pytest.mark.slow  # most of the time is compiling

COARSE = 250
_, POSE = problem("ell")


@functools.cache
def run(method: str, iterations: int) -> Result:
    if method == "slim":
        pytest.importorskip("igl")
    shape, pose = problem("ell")
    return run_method(method, shape, pose, n_vertices=COARSE, max_iterations=iterations)


def map_of(method: str, iterations: int) -> MeshMap:
    found = run(method, iterations).map
    assert isinstance(found, MeshMap)
    return found


def total(map_: MeshMap, constraints: Constraints) -> float:
    """The energy from the singular values of each triangle's Jacobian."""
    mesh = map_.triangulation
    source, image = (
        np.stack([v[mesh.triangles[:, k]] - v[mesh.triangles[:, 0]] for k in (1, 2)], axis=-1)
        for v in (mesh.vertices, map_.images)
    )
    s1, s2 = np.linalg.svd(image @ np.linalg.inv(source), compute_uv=False).T
    area = np.linalg.det(source)
    iso = float(area @ (s1**2 + s2**2 + s1**-2 + s2**-2) / 2 / area.sum())
    miss = map_(POSE.handles) - POSE.targets
    return iso + (1e5 / 2 * float((miss**2).sum()) if constraints == "soft" else 0.0)


@pytest.mark.parametrize(("method", "constraints"), [("slim", "soft"), ("aqp", "hard")])
def test_a_method_that_goes_on_ends_at_the_minimum(method: str, constraints: Constraints) -> None:
    found = mesh_minimum(map_of(method, 3), POSE, SymmetricDirichlet(), constraints)
    late = run(method, 5_000)
    assert late.status.ok
    assert found.energy == pytest.approx(late.energy, rel=1e-6)
    np.testing.assert_allclose(found.images, map_of(method, 5_000).images, atol=5e-3)


@pytest.mark.parametrize("constraints", ["soft", "hard"])
def test_no_direction_lowers_the_energy(constraints: Constraints) -> None:
    start = map_of("aqp", 5)
    found = mesh_minimum(start, POSE, SymmetricDirichlet(), constraints)
    mesh = start.triangulation
    assert found.energy == pytest.approx(total(MeshMap(mesh, found.images), constraints), rel=1e-12)
    handles = KDTree(mesh.vertices).query(POSE.handles)[1]
    if constraints == "hard":
        np.testing.assert_allclose(found.images[handles], POSE.targets, atol=1e-12)
    rng = np.random.default_rng(4)
    h = 1e-4
    for _ in range(5):
        direction = rng.normal(size=found.images.shape)
        if constraints == "hard":
            direction[handles] = 0
        before, after = (
            total(MeshMap(mesh, found.images + t * direction), constraints) for t in (-h, h)
        )
        curvature = (before - 2 * found.energy + after) / h**2
        assert curvature > 0
        # What a Newton step along the direction would still gain.
        slope = (after - before) / (2 * h)
        assert slope**2 / (2 * curvature) < 1e-8 * found.energy


def test_what_cannot_be_minimised_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    start = map_of("aqp", 5)
    turned = MeshMap(start.triangulation, start.images * [-1, 1])
    with pytest.raises(NoMinimumError, match="inverted triangles"):
        mesh_minimum(turned, POSE, SymmetricDirichlet(), "soft")
    monkeypatch.setattr(minimum, "ITERATIONS", 1)
    with pytest.raises(NoMinimumError, match="after 1 iterations"):
        mesh_minimum(map_of("aqp", 1), POSE, SymmetricDirichlet(), "hard")
