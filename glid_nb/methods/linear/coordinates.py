"""Where points go, linear in the targets: weights and coordinates of the handles."""

from __future__ import annotations

import functools
from typing import Literal

import numpy as np

from glid_nb._arrays import Array
from glid_nb._runtime import double_precision
from glid_nb.geometry import Domain, Triangulation, graded_panels
from glid_nb.harmonic import HarmonicMap, as_complex, basis_of, cauchy
from glid_nb.solvers import Pose
from glid_nb.solvers.discretisation import complex_basis

Kind = Literal["rigid", "similarity"]

# A point this close to an edge, relative to its ends' distances, is on it.
_ON_EDGE = 1e-12


def moving_least_squares(
    z: Array, handles: Array, targets: Array, kind: Kind = "rigid", alpha: float = 1.0
) -> Array:
    """Images of complex points ``z`` (k,) (Schaefer, McPhail & Warren 2006).

    At each point the rigid motion or similarity that fits the handles best, with the weights
    ``|p_i - z|^(-2 alpha)``. Handles go to their targets exactly.
    """
    if not len(handles):
        return z.copy()
    distance = np.abs(z[:, None] - handles)
    at = distance.argmin(axis=1)
    exact = distance[np.arange(len(z)), at] == 0
    w = np.where(distance > 0, distance, 1.0) ** (-2 * alpha)
    w /= w.sum(axis=1, keepdims=True)
    middle, aim = w @ handles, w @ targets
    p, q = handles - middle[:, None], targets - aim[:, None]
    turn = (w * p.conj() * q).sum(axis=1)
    size = np.abs(turn) if kind == "rigid" else (w * np.abs(p) ** 2).sum(axis=1)
    turn = np.where(size > 0, turn / np.where(size > 0, size, 1), 1)
    return np.where(exact, targets[at], aim + turn * (z - middle))


def mean_value_coordinates(z: Array, polygon: Array) -> Array:
    """(k, n) coordinates of complex points, anywhere, with respect to a simple polygon (n,).

    Floater 2003; Hormann & Floater 2006.
    """
    s = polygon - z[:, None]
    after = np.roll(s, -1, axis=1)
    r = np.abs(s)
    r_after = np.abs(after)
    cross, dot = np.imag(s.conj() * after), np.real(s.conj() * after)
    scale = r * r_after
    flat = np.abs(cross) <= _ON_EDGE * scale
    tangent = np.where(flat, 0, (scale - dot) / np.where(flat, 1, cross))
    total = tangent + np.roll(tangent, 1, axis=1)
    w = total / np.where(r > 0, r, 1)
    w = w / w.sum(axis=1, keepdims=True)
    # On an edge: linear between its ends. At a vertex the two edges that meet there agree.
    rows, edges = np.nonzero(flat & (dot <= 0))
    span = r[rows, edges] + r_after[rows, edges]
    w[rows] = 0
    w[rows, edges] = r_after[rows, edges] / span
    w[rows, (edges + 1) % len(polygon)] = r[rows, edges] / span
    return w


@double_precision
def cauchy_point_to_point(domain: Domain, pose: Pose, p2p_weight: float) -> HarmonicMap:
    """The holomorphic map of least ``|f'' |^2`` along the boundary with soft targets.

    Linear: one solve, ``psi = 0`` and no logarithms. Nothing keeps ``f'`` from vanishing.
    """
    basis = basis_of(domain)
    panels = graded_panels(domain)
    columns = np.flatnonzero(basis.phi_free)[: int(basis.phi_free.sum()) - domain.n_holes]
    slopes = complex_basis(cauchy.second_derivatives, panels.middle, basis)[:, columns]
    share = panels.length / panels.length.sum()
    normal = slopes.conj().T @ (share[:, None] * slopes)
    right = np.zeros(len(columns), dtype=complex)
    if len(pose):
        handles, targets = as_complex(pose.handles), as_complex(pose.targets)
        rows = complex_basis(cauchy.cauchy_coordinates, handles, basis)[:, columns]
        normal = normal + p2p_weight / 2 * rows.conj().T @ rows
        right = p2p_weight / 2 * rows.conj().T @ targets
    identity = HarmonicMap.identity(domain)
    base = basis.pad(identity.phi)[columns]
    # Relative to the identity, so that what the handles leave open stays as it is.
    change = np.linalg.lstsq(normal, right - normal @ base, rcond=1e-14)[0]
    padded = basis.pad(identity.phi)
    padded[columns] = base + change
    return HarmonicMap(domain, padded[basis.columns], np.zeros(domain.n_coefficients))


@functools.lru_cache(maxsize=2)
def bounded_biharmonic_weights(mesh: Triangulation, handles: bytes, iterations: int = 20) -> Array:
    """(v, h) weights in [0, 1] that add up to 1 (Jacobson et al. 2011), kept while targets move.

    Each column has the least ``w K M^-1 K w`` within its bounds (``K`` the cotangent Laplacian,
    ``M`` the Voronoi areas); then rows are divided by their sums. Where ``iterations`` end libigl's
    active-set method early, as they do on 10^4 vertices, bounds hold up to about 1e-4. ``handles``
    are the bytes of (h,) indices of vertices, int64.
    """
    import igl  # noqa: PLC0415

    index = np.frombuffer(handles, np.int64)
    w = np.asarray(igl.bbw(*_flat(mesh), index, np.eye(len(index)), max_iter=iterations))
    return w / w.sum(axis=1, keepdims=True)


@functools.lru_cache(maxsize=2)
def harmonic_weights(mesh: Triangulation, handles: bytes, power: int = 2) -> Array:
    """(v, h) weights with vanishing Laplacian (``power = 1``) or bi-Laplacian (2), as above."""
    import igl  # noqa: PLC0415

    index = np.frombuffer(handles, np.int64)
    return np.asarray(igl.harmonic(*_flat(mesh), index, np.eye(len(index)), power))


def _flat(mesh: Triangulation) -> tuple[Array, Array]:
    """Vertices in space, and triangles, as libigl wants them."""
    vertices = np.column_stack([mesh.vertices, np.zeros(len(mesh.vertices))])
    return np.ascontiguousarray(vertices), np.ascontiguousarray(mesh.triangles, dtype=np.int64)
