"""Evaluate a map on the panels: values, energies, gradient, certificate."""

from typing import NamedTuple

import numpy as np

from glid_nb._jax import Array, Bool, Complex, Float, jax, jnp, lax
from glid_nb.certificate import EndValues, PanelBounds, rounding
from glid_nb.certificate.panels import modulus
from glid_nb.certificate.paper import turning
from glid_nb.energies import Differentials, Energy
from glid_nb.solvers.discretisation import Matrices
from glid_nb.solvers.problem import SubspaceProblem

Number = Float[Array, ""]
Coefficients = Float[Array, " 4c"]
Values = Float[Array, "4 s"]


class Samples(NamedTuple):
    """``f_z`` and ``conj(f_zbar)`` as rows (Re, Im, Re, Im) (16), and their derivatives."""

    values: Float[Array, "4 p+q"]
    slopes: Float[Array, "4 p"]


class Point(NamedTuple):
    """A map and its energies, whose sum is (20)."""

    coefficients: Coefficients
    samples: Samples
    energy_distortion: Number
    energy_p2p: Number
    largest: Number
    """The largest :func:`reach` since the samples were last computed from the coefficients.
    Rounding errors are relative to this number."""

    @property
    def energy(self) -> Number:
        return self.energy_distortion + self.energy_p2p


class Line(NamedTuple):
    direction: Coefficients
    change: Samples
    squared_decrement: Number  # -gradient . direction


def evaluated(problem: SubspaceProblem, coefficients: Coefficients) -> Point:
    """The point with these coefficients and its samples (Algorithm 1, line 3)."""
    samples = products(problem.matrices, coefficients - problem.anchor)
    return _point(problem, coefficients, samples, reach(problem, coefficients))


def line_along(problem: SubspaceProblem, direction: Coefficients, slope: Number) -> Line:
    """The line in a direction (G.11). ``slope`` is the energy's derivative at its start."""
    return Line(direction, products(problem.matrices, direction), -slope)


def moved(problem: SubspaceProblem, point: Point, line: Line, step: Number) -> Point:
    """The point at ``step`` along a line. Its samples are updated, not recomputed (Algorithm 1,
    line 16, by (G.11))."""
    samples = Samples(*(a + step * b for a, b in zip(point.samples, line.change, strict=True)))
    reached = point.coefficients + step * line.direction
    largest = jnp.maximum(point.largest, reach(problem, reached))
    return _point(problem, reached, samples, largest)


def _point(
    problem: SubspaceProblem, coefficients: Coefficients, samples: Samples, largest: Number
) -> Point:
    iso = energy_distortion(samples.values, problem.matrices, problem.energy)
    return Point(coefficients, samples, iso, problem.positional.energy(coefficients), largest)


def energy_distortion(
    values: Float[Array, "4 *t s"], matrices: Matrices, energy: Energy
) -> Float[Array, "*t"]:
    """The isometric energy (12) as the sum (31); infinite if a sample is inverted.

    The energy that stiff areas add to an isometry is subtracted.
    """
    weights = matrices.weights
    x, y = squares(values)
    valid = x > y
    density = energy.density(jnp.where(valid, x, 1.0), jnp.where(valid, y, 0.0))
    density = jnp.where(valid & (density < jnp.inf), density, jnp.inf)
    total = jnp.sum(jnp.where(weights > 0, weights * density, 0), axis=-1)
    if matrices.stiff is None:
        return total
    return total - matrices.stiff * energy.density(jnp.ones(()), jnp.zeros(()))


def gradient(problem: SubspaceProblem, point: Point) -> Coefficients:
    """Gradient of the total energy with respect to all coefficients (Algorithm 1, line 4)."""
    values = point.samples.values
    d = problem.energy.differentials(*squares(values))
    isometric = energy_gradient(problem.matrices, values, d)
    return isometric + problem.positional.gradient(point.coefficients)


def energy_gradient(matrices: Matrices, values: Values, d: Differentials) -> Coefficients:
    """Gradient of the isometric energy: (13) as the sum (32) of (17), by one product (G.7).

    This is (G.8) with the sign of the last block corrected. Appendix E gives the term of each
    sample: (E.2), (E.6) and (E.7).
    """
    w1, w2 = 2 * matrices.weights * d.alpha1, 2 * matrices.weights * d.alpha2
    m = matrices.nodes @ (values * jnp.stack([w1, w1, w2, w2])).T
    c = m.shape[0] // 2
    re, im = m[:c].T, m[c:].T
    # D^H v = (Re D^T - i Im D^T) v with the stored halves Re D and -Im D.
    return jnp.concatenate([re[0] - im[1], re[1] + im[0], re[2] - im[3], re[3] + im[2]])


def bounds(problem: SubspaceProblem, point: Point) -> PanelBounds:
    matrices, samples = problem.matrices, point.samples
    truncation = matrices.proof.remainder(_complex(point.coefficients), problem.singularities)
    slack = rounding.allowance(matrices.rounding * point.largest, point.largest)
    remainder = truncation + matrices.proof.slack_share * slack
    chord = lax.complex(*matrices.chord)
    panels = chord.shape[0]
    f, g = _complex(samples.values[:, :panels])
    df, dg = _complex(samples.slopes)
    after = matrices.next
    fz = EndValues(f, f[after], df * chord, df[after] * chord)
    fzb_conj = EndValues(g, g[after], dg * chord, dg[after] * chord)
    return matrices.proof.bounds(fz, fzb_conj, remainder)


def tightened_by_splitting(problem: SubspaceProblem, point: Point) -> Bool[np.ndarray, " p"]:
    """The panels whose bounds splitting improves: truncation exceeds rounding. On the host."""
    matrices: Matrices = jax.tree.map(np.asarray, problem.matrices)
    re, im = np.moveaxis(np.asarray(point.coefficients).reshape(2, 2, -1), 1, 0)
    truncation = matrices.proof.remainder(re + 1j * im, problem.singularities)
    return truncation.max(axis=0) > matrices.rounding * float(point.largest)


def reach(problem: SubspaceProblem, coefficients: Coefficients) -> Number:
    """The size to which errors are relative.

    It is the largest coefficient after the anchor is subtracted, plus the rounding of that
    subtraction.
    """
    share = 8 * rounding.UNIT_ROUNDOFF / rounding.slack_factor(coefficients.shape[0] // 4)
    near = modulus(_complex(coefficients - problem.anchor)).max()
    return near + share * (near + 2 * jnp.max(jnp.abs(problem.anchor)))


def fz_turning(matrices: Matrices, values: Values) -> Float[Array, " p"]:
    """The change of ``arg f_z`` along each panel (29)."""
    f, _ = _complex(values[:, : matrices.real.shape[0]])
    return turning(f, f[matrices.next])


def products(matrices: Matrices, coefficients: Coefficients) -> Samples:
    """``f_z``, ``conj(f_zbar)`` (E.5) and their derivatives on the panels (G.6): two products."""
    re, im = jnp.moveaxis(coefficients.reshape(2, 2, -1), 1, 0)
    rows = jnp.stack([jnp.hstack([re, im]), jnp.hstack([im, -re])], axis=1).reshape(4, -1)
    return Samples(rows @ matrices.nodes, rows @ matrices.slopes)


def squares(values: Float[Array, "4 *t s"]) -> tuple[Array, Array]:
    """``|f_z|^2`` and ``|f_zbar|^2``. Energies depend on these instead of singular values (11)."""
    return values[0] ** 2 + values[1] ** 2, values[2] ** 2 + values[3] ** 2


def directions(values: Values) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Unit vectors along ``f_z`` and ``conj(f_zbar)``; (1, 0) where a derivative vanishes."""
    pairs = []
    for k in (0, 2):
        modulus = jnp.hypot(values[k], values[k + 1])
        vanishes = modulus == 0
        safe = jnp.where(vanishes, 1, modulus)
        pairs.append((jnp.where(vanishes, 1, values[k] / safe), values[k + 1] / safe))
    return pairs[0], pairs[1]


def _complex(a: Coefficients | Values) -> Complex[Array, "2 k"]:
    """Two complex rows from the consecutive parts (Re, Im, Re, Im)."""
    return lax.complex(*jnp.moveaxis(a.reshape(2, 2, -1), 1, 0))
