"""Harmonic and bounded biharmonic weights against systems built and solved in another way."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy.sparse
import scipy.sparse.linalg
from numpy.typing import NDArray

from glid_nb.geometry import Triangulation, triangulate
from glid_nb.methods.linear import bounded_biharmonic_weights, harmonic_weights

from ..support.problems import problem

pytest.importorskip("igl")

Array = NDArray[Any]


def mesh_and_handles(name: str) -> tuple[Triangulation, Array]:
    shape, pose = problem(name)
    mesh = triangulate(shape.cage, 250, points=pose.handles)
    gap = np.linalg.norm(mesh.vertices[:, None] - pose.handles, axis=2)
    return mesh, gap.argmin(axis=0)


def cotangent_laplacian(mesh: Triangulation) -> tuple[Any, Array]:
    """The stiffness matrix, positive semidefinite, and the vertices' Voronoi areas."""
    count = len(mesh.vertices)
    stiffness, mass = scipy.sparse.lil_matrix((count, count)), np.zeros(count)
    for triangle in mesh.triangles:
        corners = mesh.vertices[triangle]
        cots, squares = np.zeros(3), np.zeros(3)
        for k in range(3):
            u, v = corners[k - 2] - corners[k], corners[k - 1] - corners[k]
            twice_area = u[0] * v[1] - u[1] * v[0]
            cots[k] = u @ v / twice_area
            squares[k] = (u - v) @ (u - v)
            i, j = triangle[k - 2], triangle[k - 1]
            for row, column, sign in ((i, i, 1), (j, j, 1), (i, j, -1), (j, i, -1)):
                stiffness[row, column] += sign * cots[k] / 2
        if (cots >= 0).all():
            parts = cots * squares / 8
            mass[triangle] += parts.sum() - parts
        else:
            mass[triangle] += np.where(cots < 0, 1 / 2, 1 / 4) * twice_area / 2
    return stiffness.tocsc(), mass


def operator(mesh: Triangulation, power: int) -> Any:
    """``K``, ``K M^-1 K`` or ``K M^-1 K M^-1 K``."""
    stiffness, mass = cotangent_laplacian(mesh)
    product = stiffness
    for _ in range(power - 1):
        product = product @ scipy.sparse.diags(1 / mass) @ stiffness
    return product.tocsc()


@pytest.mark.parametrize("power", [1, 2, 3])
@pytest.mark.parametrize("name", ["ell", "ring"])
def test_harmonic_weights_solve_the_laplace_equation(name: str, power: int) -> None:
    mesh, handles = mesh_and_handles(name)
    q = operator(mesh, power)
    free = np.setdiff1d(np.arange(len(mesh.vertices)), handles)
    expected = np.zeros((len(mesh.vertices), len(handles)))
    expected[handles] = np.eye(len(handles))
    right = -q[free][:, handles].toarray()
    solution: Any = scipy.sparse.linalg.spsolve(q[free][:, free].tocsc(), right)
    expected[free] = solution
    w = harmonic_weights(mesh, handles.tobytes(), power)
    np.testing.assert_allclose(w, expected, atol=1e-8)
    np.testing.assert_allclose(w.sum(axis=1), 1, atol=1e-8)


@pytest.mark.parametrize("name", ["ell", "ring"])
def test_harmonic_weights_have_their_extremes_at_handles(name: str) -> None:
    """The maximum principle holds for Delaunay triangulations, and only for order 1."""
    mesh, handles = mesh_and_handles(name)
    inside = np.setdiff1d(np.arange(len(mesh.vertices)), handles)
    w = harmonic_weights(mesh, handles.tobytes(), 1)
    assert 0 < w[inside].min() < w[inside].max() < 1
    biharmonic = harmonic_weights(mesh, handles.tobytes(), 2)
    assert biharmonic.min() < -0.01


@pytest.mark.parametrize("name", ["ell", "ring"])
def test_bounded_biharmonic_weights_are_those_of_a_quadratic_program(name: str) -> None:
    """The least ``w K M^-1 K w`` within [0, 1] by an interior point method, handle by handle."""
    clarabel: Any = pytest.importorskip("clarabel")
    mesh, handles = mesh_and_handles(name)
    q = scipy.sparse.triu(operator(mesh, 2)).tocsc()
    count, n_handles = len(mesh.vertices), len(handles)
    held = scipy.sparse.csc_matrix(
        (np.ones(n_handles), (np.arange(n_handles), handles)), (n_handles, count)
    )
    identity = scipy.sparse.identity(count)
    rows = scipy.sparse.vstack([held, identity, -identity]).tocsc()
    cones = [clarabel.ZeroConeT(n_handles), clarabel.NonnegativeConeT(2 * count)]
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    expected = np.zeros((count, n_handles))
    for k in range(n_handles):
        right = np.concatenate([np.eye(n_handles)[k], np.ones(count), np.zeros(count)])
        solver = clarabel.DefaultSolver(q, np.zeros(count), rows, right, cones, settings)
        solution = solver.solve()
        assert str(solution.status) == "Solved"
        expected[:, k] = solution.x
    # Each weight is bounded separately. They are normalised to the sum 1 afterwards.
    assert np.abs(expected.sum(axis=1) - 1).max() > 0.01
    expected /= expected.sum(axis=1, keepdims=True)
    w = bounded_biharmonic_weights(mesh, handles.tobytes())
    np.testing.assert_allclose(w, expected, atol=1e-4)
    np.testing.assert_allclose(w.sum(axis=1), 1, atol=1e-12)
    assert w.min() >= 0
    assert w.max() <= 1
    # The bounds matter: without them some weights are negative here.
    assert harmonic_weights(mesh, handles.tobytes(), 2).min() < -0.01
