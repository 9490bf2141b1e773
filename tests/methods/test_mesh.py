"""Methods on a triangle mesh: they flip no triangle, descend, and reach the same minimum."""

from __future__ import annotations

import functools
import itertools
from typing import Any

import numpy as np
import pytest
import scipy.optimize
from numpy.typing import NDArray

from glid_nb.energies import (
    AMIPS,
    ARAP,
    MIPS,
    Energy,
    ExponentialSymmetricDirichlet,
    SymmetricDirichlet,
)
from glid_nb.geometry import Domain, MeshMap, Triangulation, triangulate
from glid_nb.methods.mesh.aqp import ENOUGH, closest, largest_step, project
from glid_nb.methods.mesh.operators import MeshOperators, Pinned
from glid_nb.pose import Pose
from glid_nb.solvers import MethodError, Result, Status

from ..support.domains import domain
from ..support.problems import problem, run_method

pytestmark = pytest.mark.slow  # most of the time is compiling

Array = NDArray[Any]

COARSE = 600


@functools.cache
def run(method: str, name: str, energy: Energy | None = None, **settings: object) -> Result:
    if method == "slim" or method == "arap-mesh":
        pytest.importorskip("igl")
    shape, pose = problem(name)
    settings = {"n_vertices": COARSE, **settings}
    return run_method(method, shape, pose, energy, **settings)


def independent_energy(map: MeshMap, energy: str) -> float:
    """The area mean of the density from the singular values of each triangle's Jacobian."""
    mesh = map.triangulation
    source, image = (edge_matrices(mesh, v) for v in (mesh.vertices, map.images))
    area = np.linalg.det(source) / 2
    jacobian = image @ np.linalg.inv(source)
    assert (np.linalg.det(jacobian) > 0).all()
    s1, s2 = np.linalg.svd(jacobian, compute_uv=False).T
    density = {
        "iso": (s1**2 + s2**2 + s1**-2 + s2**-2) / 2,
        "arap": (s1 - 1) ** 2 + (s2 - 1) ** 2,
        "mips": (s1 / s2 + s2 / s1) / 2,
        "exp": np.exp(s1**2 + s2**2 + s1**-2 + s2**-2),
    }[energy]
    return float((area * density).sum() / area.sum())


@pytest.mark.parametrize("name", ["ell", "ring", "bent"])
def test_stiff_soft_constraints_and_hard_ones_have_one_minimum(name: str) -> None:
    soft = run("slim", name, p2p_weight=1e9, tolerance=1e-10)
    hard = run("aqp", name, tolerance=1e-10)
    assert soft.status is Status.CONVERGED
    assert hard.status.ok
    assert hard.energy_distortion == pytest.approx(soft.energy_distortion, rel=1e-4)
    assert isinstance(soft.map, MeshMap)
    assert isinstance(hard.map, MeshMap)
    assert np.abs(soft.map.images - hard.map.images).max() < 0.05
    np.testing.assert_allclose(hard.map(hard.pose.handles), hard.pose.targets, atol=1e-9)


@pytest.mark.parametrize(
    ("method", "energy"),
    [
        ("slim", SymmetricDirichlet()),
        ("slim", ExponentialSymmetricDirichlet(2.0)),
        ("slim", MIPS()),
        ("aqp", SymmetricDirichlet()),
        ("aqp", ExponentialSymmetricDirichlet(1.0)),
        ("aqp", AMIPS(0.5)),
        ("aqp", MIPS()),
    ],
    ids=lambda v: v if isinstance(v, str) else v.name,
)
def test_energy_decreases_and_nothing_flips(method: str, energy: Energy) -> None:
    result = run(method, "ell", energy, max_iterations=60)
    energies = [step.energy for step in (result.initial, *result.history)]
    assert len(energies) > 1
    assert all(b <= a * (1 + 1e-9) for a, b in itertools.pairwise(energies))
    assert energies[-1] < energies[0]
    assert all(step.flips == 0 for step in (result.initial, *result.history))


@pytest.mark.parametrize(
    ("method", "energy"),
    [
        ("slim", SymmetricDirichlet()),
        ("slim", MIPS()),
        ("slim", ExponentialSymmetricDirichlet(2.0)),
        ("aqp", MIPS()),
    ],
    ids=lambda v: v if isinstance(v, str) else v.name,
)
def test_energies_are_those_of_the_singular_values(method: str, energy: Energy) -> None:
    result = run(method, "ell", energy, max_iterations=60)
    assert isinstance(result.map, MeshMap)
    assert result.energy_distortion == pytest.approx(
        independent_energy(result.map, energy.name), rel=1e-9
    )


def strained(name: str) -> tuple[Domain, Pose]:
    """Many handles, with targets far from any conformal map and any isometry."""
    shape = domain(name)
    rng = np.random.default_rng(3)
    chosen: list[Array] = []
    for p in rng.uniform(-2.8, 2.8, (200, 2)):
        apart = all(np.linalg.norm(p - q) > 1 for q in chosen)
        if apart and shape.cage.contains(p[None])[0] and len(chosen) < 10:
            chosen.append(p)
    handles = np.array(chosen)
    stretch = np.array([[1.3, 0.2], [0.0, 0.8]])
    return shape, Pose(handles, handles @ stretch + 0.1 * rng.normal(size=handles.shape))


def unbalance(result: Result, energy: Energy, weight: float) -> float:
    """How much of the targets' pull our energy's gradient leaves, at the worst vertex."""
    assert isinstance(result.map, MeshMap)
    operators = MeshOperators(result.map.triangulation)
    w = result.map.images @ np.array([1, 1j])
    pose = result.pose
    handles = [
        int(np.linalg.norm(operators.mesh.vertices - p, axis=1).argmin()) for p in pose.handles
    ]
    pull = np.zeros(len(w), dtype=complex)
    pull[handles] = weight * (w[handles] - pose.targets @ np.array([1, 1j]))
    iso = operators.gradient(energy, *operators.wirtinger(w))
    return float(np.abs(iso + pull).max() / np.abs(pull).max())


@pytest.mark.parametrize("weight", [1.0, 100.0])
@pytest.mark.parametrize("name", ["ell", "ring"])
@pytest.mark.parametrize(
    "energy",
    [SymmetricDirichlet(), ExponentialSymmetricDirichlet(2.0), MIPS()],
    ids=lambda energy: energy.name,
)
def test_slim_minimises_our_energy_with_our_lambda(
    energy: Energy, name: str, weight: float
) -> None:
    """libigl reports no energy, but at its end our own total gradient vanishes."""
    pytest.importorskip("igl")
    settings = {"n_vertices": 300, "tolerance": 1e-14, "max_iterations": 400}
    result = run_method("slim", *strained(name), energy, p2p_weight=weight, **settings)
    assert unbalance(result, energy, weight) < 1e-4
    # Another parameter, weight or energy would make a difference.
    assert unbalance(result, energy, 1.01 * weight) > 5e-3
    assert unbalance(result, ExponentialSymmetricDirichlet(1.9), weight) > 5e-3


def test_arap_goes_down_with_hard_constraints() -> None:
    result = run("arap-mesh", "ell", ARAP())
    assert result.status is Status.CONVERGED
    np.testing.assert_allclose(result.map(result.pose.handles), result.pose.targets, atol=1e-9)
    energies = [step.energy for step in result.history]
    assert all(b <= a * (1 + 1e-9) for a, b in itertools.pairwise(energies))
    if result.flips == 0:
        assert isinstance(result.map, MeshMap)
        assert result.energy == pytest.approx(independent_energy(result.map, "arap"), rel=1e-9)


@pytest.mark.parametrize("name", ["ell", "ring", "bent"])
def test_arap_ends_where_a_general_optimiser_ends(name: str) -> None:
    """SciPy's L-BFGS-B from the same start, on the energy by singular values; "bent" folds."""
    start = run("arap-mesh", name, n_vertices=250, max_iterations=0).map
    end = run("arap-mesh", name, n_vertices=250, tolerance=1e-13, max_iterations=3000)
    assert isinstance(start, MeshMap)
    assert isinstance(end.map, MeshMap)
    assert end.status is Status.CONVERGED
    mesh, pose = end.map.triangulation, end.pose
    assert np.array_equal(start.triangulation.vertices, mesh.vertices)
    handles = [int(np.linalg.norm(mesh.vertices - p, axis=1).argmin()) for p in pose.handles]
    free = np.setdiff1d(np.arange(len(mesh.vertices)), handles)
    source = edge_matrices(mesh, mesh.vertices)
    share, back = np.linalg.det(source), np.linalg.inv(source)
    share /= share.sum()

    def value(unknowns: Array) -> tuple[float, Array]:
        images = mesh.vertices.copy()
        images[handles], images[free] = pose.targets, unknowns.reshape(-1, 2)
        jacobian = edge_matrices(mesh, images) @ back
        u, _, vt = np.linalg.svd(jacobian)
        u[:, :, 1] *= np.sign(np.linalg.det(u @ vt))[:, None]
        strain = jacobian - u @ vt
        slope = 2 * share[:, None, None] * strain @ np.swapaxes(back, 1, 2)
        gradient = np.zeros_like(images)
        for corner, part in enumerate((-slope.sum(axis=2), slope[:, :, 0], slope[:, :, 1])):
            np.add.at(gradient, mesh.triangles[:, corner], part)
        return float((share * (strain**2).sum(axis=(1, 2))).sum()), gradient[free].ravel()

    reached, gradient = value(end.map.images[free].ravel())
    assert end.energy == pytest.approx(reached, rel=1e-9)
    assert np.abs(gradient).max() < 1e-7
    beginning = start.images[free].ravel()
    assert np.abs(value(beginning)[1]).max() > 1e-2
    options = {"maxiter": 5000, "maxfun": 8000, "ftol": 1e-15, "gtol": 1e-10}
    found = scipy.optimize.minimize(value, beginning, jac=True, method="L-BFGS-B", options=options)
    assert reached == pytest.approx(found.fun, rel=1e-8)
    np.testing.assert_allclose(end.map.images[free].ravel(), found.x, atol=1e-4)


def edge_matrices(mesh: Triangulation, points: Array) -> Array:
    """(t, 2, 2): two edges of each triangle as columns."""
    first = points[mesh.triangles[:, 0]]
    return np.stack([points[mesh.triangles[:, k]] - first for k in (1, 2)], axis=-1)


def test_gradient_is_the_derivative_of_the_energy() -> None:
    operators = MeshOperators(triangulate(domain("ring").cage, 200))
    rng = np.random.default_rng(0)
    w = operators.rest + 0.01 * (rng.normal(size=(2, len(operators.rest))).T @ [1, 1j])
    change = rng.normal(size=(len(w), 2)) @ np.array([1, 1j])
    for energy in (SymmetricDirichlet(), MIPS(), AMIPS(1.0)):
        slope = np.vdot(operators.gradient(energy, *operators.wirtinger(w)), change).real
        h = 1e-6
        up, down = (operators.energy(energy, *operators.wirtinger(w + t * change)) for t in (h, -h))
        assert slope == pytest.approx((up - down) / (2 * h), rel=1e-5)


def test_the_laplacian_is_the_dirichlet_energys() -> None:
    operators = MeshOperators(triangulate(domain("ell").cage, 200))
    w = np.random.default_rng(1).normal(size=(len(operators.rest), 2)) @ np.array([1, 1j])
    fz, fzb = operators.wirtinger(w)
    dirichlet = operators.weights @ (np.abs(fz) ** 2 + np.abs(fzb) ** 2)
    assert np.vdot(w, operators.laplacian @ w).real / 2 == pytest.approx(dirichlet)
    assert np.abs(operators.laplacian @ np.ones(len(w))).max() < 1e-12


def test_largest_step_is_where_a_triangle_becomes_flat() -> None:
    rng = np.random.default_rng(2)
    fz = 1 + 0.1 * rng.normal(size=50)
    fzb, dfz, dfzb = (0.3 * rng.normal(size=(50, 2)) @ np.array([1, 1j]) for _ in range(3))
    t = largest_step(fz, fzb, dfz, dfzb)
    for step, flat in ((t * (1 - 1e-6), False), (t * (1 + 1e-6), True)):
        assert (np.abs(fz + step * dfz) <= np.abs(fzb + step * dfzb)).any() == flat


def test_projection_bounds_the_distortion_and_keeps_the_handles() -> None:
    shape, pose = problem("bent")
    mesh = triangulate(shape.cage, COARSE, points=pose.handles)
    operators = MeshOperators(mesh)
    held = np.array([np.linalg.norm(mesh.vertices - p, axis=1).argmin() for p in pose.handles])
    pinned = Pinned(operators, held)
    w = pinned.solve(np.zeros(len(mesh.vertices), dtype=complex), pose.targets @ [1, 1j])
    fz, fzb = operators.wirtinger(w)
    assert (np.abs(fz) <= np.abs(fzb)).any()
    projected, iterations = project(operators, pinned, w)
    assert iterations > 0
    fz, fzb = operators.wirtinger(projected)
    assert (np.abs(fzb) < ENOUGH * np.abs(fz)).all()
    np.testing.assert_array_equal(projected[held], w[held])


def test_closest_differentials_are_closest() -> None:
    rng = np.random.default_rng(3)
    fz, fzb = (rng.normal(size=(200, 2)) @ np.array([1, 1j]) for _ in range(2))
    pz, pzb = closest(fz, fzb, 0.7)
    assert (np.abs(pzb) <= 0.7 * np.abs(pz) * (1 + 1e-12)).all()
    distance = np.abs(pz - fz) ** 2 + np.abs(pzb - fzb) ** 2
    for _ in range(200):
        qz = pz + 0.1 * (rng.normal(size=(200, 2)) @ np.array([1, 1j]))
        qzb = pzb + 0.1 * (rng.normal(size=(200, 2)) @ np.array([1, 1j]))
        allowed = np.abs(qzb) <= 0.7 * np.abs(qz)
        other = np.abs(qz - fz) ** 2 + np.abs(qzb - fzb) ** 2
        assert (other[allowed] >= distance[allowed] - 1e-12).all()


def test_a_mesh_map_is_linear_on_triangles() -> None:
    mesh = triangulate(domain("ring").cage, 300)
    map = MeshMap(mesh, mesh.vertices @ np.array([[2.0, 0.5], [0.0, 1.0]]) + [1.0, -1.0])
    inside = mesh.vertices[mesh.triangles].mean(axis=1)
    expected = inside @ np.array([[2.0, 0.5], [0.0, 1.0]]) + [1.0, -1.0]
    np.testing.assert_allclose(map(inside), expected, atol=1e-12)
    np.testing.assert_allclose(map(mesh.vertices), map.images, atol=1e-9)
    assert not map.flipped.any()
    assert MeshMap(mesh, mesh.vertices * [-1, 1]).flipped.all()


def still(mesh: Triangulation) -> MeshMap:
    return MeshMap(mesh, mesh.vertices)


def test_a_foreign_triangulation_is_refused() -> None:
    shape, pose = problem("ell")
    with pytest.raises(MethodError, match=r"handle 0 .* is not a vertex of the start's"):
        run_method("aqp", shape, pose, start=still(triangulate(shape.cage, 100)))
    mesh = triangulate(shape.cage, 100, points=pose.handles)
    result = run_method("aqp", shape, pose, start=still(mesh), max_iterations=3)
    assert isinstance(result.map, MeshMap)
    assert result.map.triangulation is mesh


def test_a_method_goes_on_from_a_map_of_its_mesh() -> None:
    pytest.importorskip("igl")
    few = run("slim", "bent", max_iterations=3)
    assert isinstance(few.map, MeshMap)
    mesh = few.map.triangulation
    more = run("slim", "bent", start=few.map, align=False)
    assert more.initial.energy == pytest.approx(few.energy, rel=1e-9)
    assert more.energy < few.energy
    # SLIM cannot start with a flipped triangle; then it starts at rest.
    folded = MeshMap(mesh, mesh.vertices * [-1, 1])
    anew = run("slim", "bent", start=folded, max_iterations=0)
    assert anew.initial.energy_distortion == pytest.approx(2.0)
    with pytest.raises(MethodError, match="cannot start from a map of a mesh"):
        run_method("lbfgs", *problem("bent"), start=few.map)
