"""The inequalities of docs/proof.md, "In the page", written out."""

from __future__ import annotations

import math
from fractions import Fraction

import flint
import numpy as np
import pytest

from glid_nb.certificate.paper import derivative_bound_weights, jumps
from glid_nb.geometry import Cage, Domain, graded_panels
from glid_nb.harmonic import HarmonicMap, cauchy, rows_of
from glid_nb.harmonic.basis import basis_of
from glid_nb.page import coefficients_of

from ...certificate.test_extremes import derivatives, exact
from ...support.domains import NAMES, random_map
from .in_node import answers

QUADRATIC = math.sqrt(3) / 216
ROUNDOFF = 2.0**-53


def test_the_quadratic_remainder_is_attained_by_a_cubic() -> None:
    t = np.linspace(0, 1, 10_001)
    cubic = t * (t - 0.5) * (t - 1)  # its interpolant is 0, its third derivative 3!
    assert np.abs(cubic).max() <= 6 * QUADRATIC
    assert np.abs(cubic).max() > 6 * QUADRATIC * (1 - 1e-6)


def test_three_values_enlarge_errors_by_at_most_5_quarters() -> None:
    for i in range(401):
        t = Fraction(i, 400)
        lagrange = [
            2 * (t - Fraction(1, 2)) * (t - 1),
            4 * t * (1 - t),
            2 * t * (t - Fraction(1, 2)),
        ]
        assert sum(lagrange) == 1
        assert sum(map(abs, lagrange)) <= Fraction(5, 4)


@pytest.mark.parametrize("name", NAMES)
def test_the_weights_bound_the_remainder_of_a_map(name: str) -> None:
    map = random_map(name, 0.3, seed=4)
    panels, basis = graded_panels(map.domain), basis_of(map.domain)
    rows, singular = rows_of(map), basis.singularities
    weights = derivative_bound_weights(panels.start, panels.end, singular, 3) * QUADRATIC
    bounds = jumps(rows, singular) @ weights.T

    def at(z: np.ndarray) -> np.ndarray:
        edges = cauchy.edge_coefficients(rows, singular)
        return edges @ cauchy.first_by_edges(z, singular).T

    start, middle, end = (at(z) for z in (panels.start, panels.middle, panels.end))
    for t in (0.1, 0.2113, 0.4, 0.7, 0.7887):
        quadratic = (
            2 * (t - 0.5) * (t - 1) * start + 4 * t * (1 - t) * middle + 2 * t * (t - 0.5) * end
        )
        off = np.abs(at(panels.start + t * (panels.end - panels.start)) - quadratic)
        assert (off <= bounds + 1e-11).all()


@pytest.mark.slow
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_nodes_are_beside_the_cage_by_no_more_than_is_allowed(scale: float) -> None:
    """Of a triangle far away, its offset cage close to the cage: many halvings of each edge."""
    corners = np.array([[0.1, 0.2], [1.7, 0.33], [0.61, 1.3]]) * scale + 1.1 * scale
    d = Domain.from_cage(Cage(corners), 1e-5 * scale)
    identity = coefficients_of(HarmonicMap.identity(d))
    (answer,) = answers([{"ask": "samples", "outline": d.to_dict(), "map": identity}])
    (loop,) = d.cage.loops_complex
    largest = np.abs(d.offset_cage.loops_complex[0]).max()
    edges = [[Fraction(v) for v in (z.real, z.imag)] for z in loop]
    assert len(answer["x"]) > 100
    for x, y in zip(map(Fraction, answer["x"]), map(Fraction, answer["y"]), strict=True):
        off = min(
            abs((bx - ax) * (y - ay) - (by - ay) * (x - ax))
            / Fraction(math.hypot(bx - ax, by - ay))
            for (ax, ay), (bx, by) in zip(edges, edges[1:] + edges[:1], strict=True)
        )
        assert off < 64 * ROUNDOFF * largest


def test_the_five_coefficients_are_those_of_the_squared_modulus() -> None:
    rng = np.random.default_rng(3)
    a, b, c = rng.normal(size=3) + 1j * rng.normal(size=3)
    coefficients = [
        abs(a) ** 2,
        (a.conjugate() * b).real,
        ((a.conjugate() * c).real + 2 * abs(b) ** 2) / 3,
        (b.conjugate() * c).real,
        abs(c) ** 2,
    ]
    for t in np.linspace(0, 1, 11):
        p = (1 - t) ** 2 * a + 2 * t * (1 - t) * b + t**2 * c
        basis = [math.comb(4, i) * t**i * (1 - t) ** (4 - i) for i in range(5)]
        assert np.dot(basis, coefficients) == pytest.approx(abs(p) ** 2, rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_the_slack_bounds_the_actual_rounding(name: str) -> None:
    """At nodes of the page, against Arb: `(3 n + 128) u |a| |s| + 16 u / pi sum |s|`."""
    flint.ctx.prec = 200
    map = random_map(name, 0.3, seed=5)
    asked = {"ask": "samples", "outline": map.domain.to_dict(), "map": coefficients_of(map)}
    (answer,) = answers([asked])
    n = map.domain.n_coefficients
    count = len(answer["x"])
    fr, fi, gr, gi = np.reshape(answer["samples"], (4, count))
    bounds = [
        (3 * n + 128) * ROUNDOFF * np.array(answer["norms"]) * size["norm"]
        + 16 * ROUNDOFF / math.pi * size["sum"]
        for size in (answer["f"], answer["g"])
    ]
    for i in range(0, count, max(count // 40, 1)):
        f, g = derivatives(map, exact(complex(answer["x"][i], answer["y"][i])))
        # Moduli differ by no more than the values do.
        assert abs(f - abs(exact(complex(fr[i], fi[i])))) < bounds[0][i]
        assert abs(g - abs(exact(complex(gr[i], gi[i])))) < bounds[1][i]
