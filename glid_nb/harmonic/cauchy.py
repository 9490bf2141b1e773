"""Cauchy barycentric coordinates and their derivatives (paper Appendix D, Equation (9)).

The cage that carries the basis has ``m`` vertices ``z_j`` on one or more closed loops and one
point ``rho`` per hole. With ``A_j = z_j - z_{j-1}`` and ``B_j(z) = z_j - z`` (Figure 4), the
columns of every matrix here are the ``m`` vertices in the order of the loops, then the holes.

All functions take arrays of NumPy or JAX and compute with the library of their first argument.
"""

from typing import Any as Array  # of NumPy or of JAX
from typing import NamedTuple

import numpy as np

from glid_nb._jax import AnyArray, Complex, Int

Points = Complex[Array, " k"]
Matrix = Complex[Array, "k n"]
Edges = Complex[Array, "k m"]
Values = Complex[Array, "... m"]
Rows = Complex[Array, "... n"]

_TWO_PI_I = 2j * np.pi


class Singularities(NamedTuple):
    """Where the basis functions are singular: the offset cage's vertices and the hole points."""

    vertices: Complex[AnyArray, " m"]
    next: Int[AnyArray, " m"]
    previous: Int[AnyArray, " m"]
    hole_points: Complex[AnyArray, " N"]


def cauchy_coordinates(z: Points, singularities: Singularities) -> Matrix:
    """``C_j(z)`` of (6) and (8): (D.1) for vertices and ``ln|z - rho|`` for holes (7)."""
    xp = z.__array_namespace__()
    vertices, following, preceding, rho = singularities
    b = vertices - z[:, None]
    log_over_a = log_over_edge(b, singularities)
    c = (b[:, following] * log_over_a - b[:, preceding] * log_over_a[:, preceding]) / _TWO_PI_I
    logarithms = xp.log(xp.abs(z[:, None] - rho))
    return xp.concat([c, logarithms.astype(c.dtype)], axis=1)


def first_derivatives(z: Points, singularities: Singularities) -> Matrix:
    """``D_j(z)`` of (9) and (B.1): (D.2) for vertices and ``1 / (z - rho)`` for holes."""
    vertices, _, preceding, rho = singularities
    log_over_a = log_over_edge(vertices - z[:, None], singularities)
    d = (log_over_a[:, preceding] - log_over_a) / _TWO_PI_I
    return z.__array_namespace__().concat([d, 1 / (z[:, None] - rho)], axis=1)


def second_derivatives(z: Points, singularities: Singularities) -> Matrix:
    """``D'_j(z)``: (D.3) for vertices and ``-1 / (z - rho)^2`` for holes."""
    vertices, following, preceding, rho = singularities
    b = vertices - z[:, None]
    numerator = (vertices[following] - vertices[preceding]) / _TWO_PI_I
    d = numerator / (b[:, preceding] * b * b[:, following])
    return z.__array_namespace__().concat([d, -1 / (z[:, None] - rho) ** 2], axis=1)


def first_by_edges(z: Points, singularities: Singularities) -> Matrix:
    """The matrix ``L(z)`` with ``f_z = L @ edge_coefficients``; (D.2) summed by edges.

    ``Log(B_{j+1} / B_j) / (2 pi i)`` for the edge from vertex ``j``, ``1 / (z - rho)`` for holes.
    A constant that is added to a loop's coefficients changes no slope, so it costs no accuracy.
    """
    logarithms = edge_logarithms(singularities.vertices - z[:, None], singularities)
    rest = 1 / (z[:, None] - singularities.hole_points)
    return z.__array_namespace__().concat([logarithms / _TWO_PI_I, rest], axis=1)


def second_by_edges(z: Points, singularities: Singularities) -> Matrix:
    """The derivative of :func:`first_by_edges`; (D.4) summed by edges.

    ``A_{j+1} / (2 pi i B_j B_{j+1})`` for the edge from vertex ``j``.
    """
    vertices, following, _, rho = singularities
    b = vertices - z[:, None]
    edges = (vertices[following] - vertices) / (b * b[:, following]) / _TWO_PI_I
    return z.__array_namespace__().concat([edges, -1 / (z[:, None] - rho) ** 2], axis=1)


def edge_coefficients(coefficients: Rows, singularities: Singularities) -> Rows:
    """The slope along the edge from each vertex, and the coefficient itself for the holes."""
    m, xp = singularities.vertices.shape[0], coefficients.__array_namespace__()
    slopes = edge_slopes(coefficients[..., :m], singularities)
    return xp.concat([slopes[..., singularities.next], coefficients[..., m:]], axis=-1)


def edge_slopes(coefficients: Values, singularities: Singularities) -> Values:
    """``s_j = (phi_j - phi_{j-1}) / (z_j - z_{j-1})`` (Section 8, Appendix H), within each loop."""
    vertices, _, preceding, _ = singularities
    return (coefficients - coefficients[..., preceding]) / (vertices - vertices[preceding])


def slope_jumps(coefficients: Rows, singularities: Singularities) -> Rows:
    """``s_j - s_{j+1}`` for the vertices and the coefficient itself for the holes (Appendix H).

    ``f_z' = -1/(2 pi i) sum_j (s_j - s_{j+1}) / B_j - sum_k phi_{m+k} / (z - rho_k)^2``; the
    paper's first sum has the wrong sign.
    """
    m, xp = singularities.vertices.shape[0], coefficients.__array_namespace__()
    slopes = edge_slopes(coefficients[..., :m], singularities)
    jumps = slopes - slopes[..., singularities.next]
    return xp.concat([jumps, coefficients[..., m:]], axis=-1)


def higher_derivative(
    z: Points, coefficients: Complex[Array, " n"], singularities: Singularities, order: int
) -> Points:
    """The ``order``-th derivative (``order >= 1``) of ``sum_j D_j(z) coefficients_j``.

    Differentiating the expression for ``f_z'`` in Appendix H ``order - 1`` times:
    ``-(order-1)!/(2 pi i) sum_j (s_j - s_{j+1}) / B_j^order
    + (-1)^order order! sum_k phi_{m+k} / (z - rho_k)^(order+1)``.
    """
    vertices, _, _, rho = singularities
    m, jumps = vertices.shape[0], slope_jumps(coefficients, singularities)
    factorial = float(np.prod(np.arange(1, order)))
    inner = ((vertices - z[:, None]) ** -order) @ jumps[:m] * (-factorial / _TWO_PI_I)
    holes = ((z[:, None] - rho) ** -(order + 1)) @ jumps[m:]
    return inner + (-1) ** order * factorial * order * holes


def log_over_edge(b: Edges, singularities: Singularities) -> Edges:
    """``Log(B_{j+1} / B_j) / A_{j+1}``, one column per edge from vertex ``j`` to ``j + 1``."""
    vertices, following, _, _ = singularities
    return edge_logarithms(b, singularities) / (vertices[following] - vertices)


def edge_logarithms(b: Edges, singularities: Singularities) -> Edges:
    """``Log(B_{j+1} / B_j)``, the principal branch, because an edge subtends an angle below pi.

    XLA's complex logarithm is off by 50 roundoffs near modulus 0.77, its real ``log`` and ``atan2``
    by one.
    """
    xp = b.__array_namespace__()
    square = xp.real(b) ** 2 + xp.imag(b) ** 2
    angle = xp.angle(b[:, singularities.next] * xp.conj(b))
    return xp.log(square[:, singularities.next] / square) / 2 + 1j * angle
