"""The Hermite-Bernstein certificate: cubic interpolants with a remainder bound.

On a panel of length ``l`` let ``p`` and ``q`` be the cubic Hermite interpolants of ``f_z`` and
``conj(f_zbar)``, and ``e_f >= |f_z - p|``, ``e_g >= |conj(f_zbar) - q|`` their remainders, at most
``l^4 / 384`` times a bound on the fourth derivative (Peano's kernel of cubic Hermite
interpolation does not change sign, so the bound holds for complex functions too). Then
``|p|^2 - |q|^2`` is a real polynomial of degree 6, whose Bernstein coefficients enclose it.
"""

import functools
from typing import Any as Array  # of NumPy or of JAX
from typing import NamedTuple, Self

from glid_nb._jax import Float
from glid_nb.certificate import rounding
from glid_nb.certificate.panels import Ends, EndValues, PanelBounds, PerPanel, Rows, modulus
from glid_nb.certificate.paper import beside, derivative_bound_weights, jumps, turning
from glid_nb.harmonic.cauchy import Singularities

# A cubic by its four Bezier control points, a real sextic by its seven Bernstein coefficients.
Cubic = list[Ends] | list[PerPanel]
Sextic = list[PerPanel]


class Hermite(NamedTuple):
    weights: Float[Array, "n p"]
    """``l^4 / 384`` times the bound on the fourth derivative per unit of each slope jump, and
    :func:`~glid_nb.certificate.paper.beside`."""

    slack_share = 1

    @classmethod
    def on(cls, start: Ends, end: Ends, singularities: Singularities) -> Self:
        weights = derivative_bound_weights(start, end, singularities, 4) / 384
        return cls((weights + beside(start, end, singularities)).T)

    def remainder(self, coefficients: Rows, singularities: Singularities) -> Float[Array, "k p"]:
        return jumps(coefficients, singularities) @ self.weights

    @staticmethod
    def bounds(
        fz: EndValues,
        fzb_conj: EndValues,
        remainder: Float[Array, "2 p"],
        direction: Ends | None = None,
    ) -> PanelBounds:
        """Bounds on each whole panel; its interpolants are halved once to tighten them.

        With unit vectors ``u`` as ``direction``, the bounds on sigma_2 and k hold with
        ``Re(conj(u) f_z)`` in place of ``|f_z|``. It is proved positive where the turning is known.
        """
        p, q = _control_points(fz), _control_points(fzb_conj)
        e_f, e_g = remainder[0], remainder[1]
        p_most = _greatest([modulus(point) for point in p])
        mean = p[0] / modulus(p[0]) + p[3] / modulus(p[3])
        u = mean / modulus(mean) if direction is None else direction
        along = [(u.conj() * point).real for point in p]
        if direction is not None:
            e_f = e_f + rounding.BERNSTEIN * p_most  # rounding of u and of the products
        halves = [
            _piece_bounds(a, b, e_f, e_g)
            for a, b in zip(halved(p if direction is None else along), halved(q), strict=True)
        ]
        sigma2, sigma1, k = zip(*halves, strict=True)
        if direction is not None:
            sigma1 = [p_most + _greatest([modulus(point) for point in q]) + e_f + e_g]
        # If the control points lie in a half plane further than e_f from 0, f_z avoids 0 there.
        return PanelBounds(
            sigma2_lower=_least(sigma2),
            sigma1_upper=_greatest(sigma1),
            k_upper=_greatest(k),
            turning_known=_least(along) > e_f,
            turning=turning(fz.start, fz.end),
        )


def _piece_bounds(p: Cubic, q: Cubic, e_f: PerPanel, e_g: PerPanel) -> tuple[Array, Array, Array]:
    """Lower bound on sigma_2, upper bounds on sigma_1 and k, for interpolants ``p`` and ``q``."""
    xp = e_f.__array_namespace__()
    p_most = _greatest([modulus(point) for point in p])
    q_most = _greatest([modulus(point) for point in q])
    # Rounding errors of the computed coefficients.
    p_off, q_off = (rounding.BERNSTEIN * most**2 for most in (p_most, q_most))
    p_square = [a - p_off for a in squared_modulus(p)]
    q_square = [b + q_off for b in squared_modulus(q)]

    # |p| - |q| = (|p|^2 - |q|^2) / (|p| + |q|), and the control points bound the denominator.
    # If least is negative, |q|^2 <= |p|^2 - least gives |q| <= |p| + sqrt(-least).
    least = _least([a - b for a, b in zip(p_square, q_square, strict=True)])
    sigma2 = xp.where(least > 0, least / (p_most + q_most), -xp.sqrt(-least)) - e_f - e_g
    sigma1 = p_most + q_most + e_f + e_g

    # If all coefficients of kappa^2 |p|^2 - |q|^2 are at least 0, |q| / |p| is at most kappa.
    p_least_square = _least(p_square)
    p_least = xp.sqrt(xp.maximum(p_least_square, 0))
    ratios = [xp.maximum(b, 0) / a for a, b in zip(p_square, q_square, strict=True)]
    kappa = xp.sqrt(_greatest(ratios))
    k = (kappa * p_least + e_g) / (p_least - e_f)
    k = xp.where((p_least_square > 0) & (p_least > e_f), k, xp.inf)
    # k = (sigma_1 - sigma_2) / (sigma_1 + sigma_2) grows with sigma_1 and falls with sigma_2. So
    # their bounds give another bound on k, below 1 where sigma_2 is proved positive.
    from_sigma = (sigma1 - sigma2) / (sigma1 + sigma2)
    k = xp.where(sigma2 > 0, xp.minimum(k, from_sigma), k)
    # Overflow proves nothing.
    finite = xp.isfinite(p_off + q_off + e_f + e_g)
    sigma2 = xp.where(finite, sigma2, -xp.inf)
    sigma1, k = (xp.where(finite, a, xp.inf) for a in (sigma1, k * (1 + rounding.BERNSTEIN)))
    return sigma2, sigma1, k


def _control_points(f: EndValues) -> Cubic:
    return [f.start, f.start + f.slope_start / 3, f.end - f.slope_end / 3, f.end]


def halved(cubic: Cubic) -> tuple[Cubic, Cubic]:
    """De Casteljau's subdivision at the middle."""
    a, b, c, d = cubic
    ab, bc, cd = (a + b) / 2, (b + c) / 2, (c + d) / 2
    abc, bcd = (ab + bc) / 2, (bc + cd) / 2
    middle = (abc + bcd) / 2
    return [a, ab, abc, middle], [middle, bcd, cd, d]


def squared_modulus(cubic: Cubic) -> Sextic:
    """Bernstein coefficients of ``|cubic|^2``."""

    def dot(i: int, j: int) -> PerPanel:
        a, b = cubic[i], cubic[j]
        return a.real * b.real + a.imag * b.imag

    second, fourth = (2 * dot(i, i + 2) + 3 * dot(i + 1, i + 1) for i in (0, 1))
    middle = (dot(0, 3) + 9 * dot(1, 2)) / 10
    return [dot(0, 0), dot(0, 1), second / 5, middle, fourth / 5, dot(2, 3), dot(3, 3)]


def _least(values: list[Array] | tuple[Array, ...]) -> Array:
    return functools.reduce(values[0].__array_namespace__().minimum, values)


def _greatest(values: list[Array] | tuple[Array, ...]) -> Array:
    return functools.reduce(values[0].__array_namespace__().maximum, values)
