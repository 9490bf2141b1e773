"""A map as power series on small squares: fast at many points, with proved errors.

On a disc that no singularity of the basis is close to, ``f = g + conj(h)`` with holomorphic g and
h. `Expansions` covers the domain by squares that shrink towards its boundary, as in Whitney's
decomposition, and keeps the power series of g and h around the middle of each. `docs/proof.md`
bounds their errors (Lemmas 27 and 28).
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, NamedTuple, Self, TypeVar

import numpy as np
import shapely

from glid_nb._arrays import Array
from glid_nb._runtime import single_blas_thread
from glid_nb.geometry import Domain, as_points
from glid_nb.harmonic import cauchy, rounding
from glid_nb.harmonic.basis import basis_of
from glid_nb.harmonic.cauchy import Singularities
from glid_nb.harmonic.rounding import UNIT_ROUNDOFF, UPWARD

_RATIO = 0.4  # largest radius of a disc, as a share of the distance from its middle to the edge
_RATIO_BOUND = _RATIO * (1 + 1e-6)
_ORDER = 30
_MANY = 2000  # points for which a cover by squares pays
_DEPTH = 9  # squares are at least this many halvings of the whole
_PLACES_AT_ONCE = 8192
_NUMBERS_AT_ONCE = 1 << 16

R = TypeVar("R")


class Jets(NamedTuple):
    """A map close to points: one entry for each point, and bounds on what is not computed."""

    f: Array
    """Images, complex."""
    fz: Array
    fzb_conj: Array
    """``conj(f_zbar)``."""
    f_error: Array
    """Bounds the error of ``f``."""
    first_error: Array
    """Bounds the sum of the errors of the two derivatives."""
    second: Array
    """Bounds ``|f_zz| + |f_zbar zbar|`` within ``radius`` of the point."""
    radius: Array
    """0 where nothing is proved."""

    @property
    def sigma2_lower(self) -> Array:
        """A lower bound on the smaller singular value at the points, rounding included."""
        f, g = np.abs(self.fz), np.abs(self.fzb_conj)
        return f - g - self.first_error * UPWARD - 8 * UNIT_ROUNDOFF * (f + g)

    def at(self, index: Any) -> Self:
        return self._make(values[index] for values in self)


class Discs(NamedTuple):
    """Discs in the offset cage, and the power series of g and h in ``(z - middle) / radius``."""

    middle: Array
    radius: Array
    series: Array  # (order + 1, 2, k): of g and h; h begins with 0
    f_error: Array  # of values everywhere in the disc
    first_error: Array
    second: Array  # bounds |f_zz| + |f_zbar zbar| at up to twice the radius


def discs_at(map: Any, middle: Array, radius: Array, order: int = _ORDER) -> Discs:
    """Power series of a map on discs. Each radius is at most `_RATIO` times the distance of the
    middle from the offset cage.

    With order 1 the errors hold at the middle only.
    """
    basis = basis_of(map.domain)
    rows = np.stack([basis.pad(values) for values in (map.phi, map.psi)])

    def some(chosen: slice) -> Discs:
        return _series(middle[chosen], radius[chosen], rows, basis.singularities, order)

    with single_blas_thread():
        parts = _in_parallel(some, len(middle), _NUMBERS_AT_ONCE // basis.n_columns)
    return Discs(*(np.concatenate(values, axis=-1) for values in zip(*parts, strict=True)))


def _in_parallel(program: Callable[[slice], R], count: int, size: int) -> list[R]:
    """``program`` on slices of a range, at least one, by two threads."""

    def quiet(start: int) -> R:
        with np.errstate(all="ignore"):
            return program(slice(start, start + size))

    starts = range(0, max(count, 1), size)
    if len(starts) == 1:
        return [quiet(0)]
    with ThreadPoolExecutor(2) as pool:
        return list(pool.map(quiet, starts))


def _series(
    middle: Array, radius: Array, rows: Array, singularities: Singularities, order: int
) -> Discs:
    """Lemma 27. The names of the sums of moduli are those of `docs/proof.md`."""
    vertices, _, preceding, rho = singularities
    m, n = len(vertices), rows.shape[1]
    factor, u = rounding.slack_factor(n), UNIT_ROUNDOFF
    first = cauchy.first_by_edges(middle, singularities)
    edges = cauchy.edge_coefficients(rows, singularities)
    size = np.abs(edges).sum(axis=0)
    g, h = edges @ first.T
    value, value_off = _values(middle, first, edges, rows, singularities)
    of_logarithms = rounding.LOGARITHM * u * size[:m].sum() / np.pi
    first_off = factor * (np.abs(first) @ size) + of_logarithms

    to_vertex = -radius[:, None] / (middle[:, None] - vertices)
    to_hole = radius[:, None] / (middle[:, None] - rho)
    jumps = np.ascontiguousarray(cauchy.slope_jumps(rows, singularities)[:, :m].T)
    series = np.zeros((order + 1, 2, len(middle)), dtype=complex)
    series[0, 0], series[1, 0], series[1, 1] = value, radius * g, radius * h
    _add_powers(series, radius, to_vertex, to_hole, jumps, rows[:, m:].T)

    # |G_k| + |H_k| <= near q^(k-2) / (k (k-1)) + far q^(k-1) / k with the largest ratio q.
    share, hole_share = np.abs(to_vertex), np.abs(to_hole)
    jump_sizes = np.abs(jumps).sum(axis=1)
    near = radius * (share @ jump_sizes) / (2 * np.pi)
    rough = radius * (share @ (size[:m] + size[:m][preceding])) / (2 * np.pi)
    f_error, first_error = _power_errors(near, rough, hole_share @ size[m:], order, factor)
    steep = radius * (np.abs(g) + np.abs(h))
    f_error += value_off + radius * first_off + 64 * u * (np.abs(value) + steep)
    first_error = first_off + (first_error + 64 * u * steep) / radius
    # Within twice the radius, the distance to a singularity is at least d - 2 radius.
    second = (share / (1 - 2 * share)) @ jump_sizes / (2 * np.pi) / radius
    second += (hole_share / (1 - 2 * hole_share)) ** 2 @ size[m:] / radius**2
    second += 256 * u * rough / radius**2
    # Near the cut a computed logarithm may be the wrong one.
    cut = (np.abs(first[:, :m].real) > 0.5 - rounding.CUT).any(axis=1)
    errors = (UPWARD**2 * values + rounding.UNDERFLOW for values in (f_error, first_error, second))
    known = (np.where(np.isfinite(values) & ~cut, values, np.inf) for values in errors)
    return Discs(middle, radius, series, *known)


def _values(
    middle: Array, first: Array, edges: Array, rows: Array, singularities: Singularities
) -> tuple[Array, Array]:
    """(k,) images of the middles, and bounds on their errors.

    By edges, ``g = sum_e (phi_e + (z - z_e) s_e) Log(B_(e+1) / B_e) / (2 pi i)``, without the
    exterior's first coefficient, so that a translation costs no accuracy.
    """
    vertices, _, preceding, rho = singularities
    m, n = len(vertices), rows.shape[1]
    factor, u = rounding.slack_factor(n), UNIT_ROUNDOFF
    logarithms, size = np.abs(first[:, :m]), np.abs(edges).sum(axis=0)
    exterior = np.arange(n) <= preceding[0]
    local = rows - np.where(exterior, rows[:, :1], 0)
    away = middle[:, None] - vertices
    parts = [
        ((one[:m] + away * slope[:m]) * first[:, :m]).sum(axis=1)
        for one, slope in zip(local, edges, strict=True)
    ]
    ln = np.log(np.abs(middle[:, None] - rho))
    value = parts[0] + np.conj(parts[1]) + ln @ (rows[0, m:] + np.conj(rows[1, m:]))
    value = value + (rows[0, 0] + np.conj(rows[1, 0]))
    terms = np.abs(local).sum(axis=0)[:m] + np.abs(away) * size[:m]
    off = (factor + rounding.LOGARITHM * u) * logarithms + rounding.LOGARITHM * u / (2 * np.pi)
    value_off = (terms * off).sum(axis=1) + factor * ((np.abs(ln) + 1) @ size[m:])
    value_off += 8 * u * (np.abs(value) + np.abs(rows[:, 0]).sum())
    return value, value_off


def _add_powers(
    series: Array, radius: Array, to_vertex: Array, to_hole: Array, jumps: Array, holes: Array
) -> None:
    """Fill in the coefficients ``G_k`` and ``H_k`` of the series from the second power on."""
    power, hole_power = to_vertex.copy(), to_hole.copy()
    for k in range(2, len(series)):
        hole_power *= to_hole
        series[k] = (power @ jumps).T * (1j * radius / (2 * np.pi * k * (k - 1)))
        series[k] += (hole_power @ holes).T * ((-1) ** (k - 1) / k)
        power *= to_vertex


def _power_errors(
    near: Array, rough: Array, far: Array, order: int, factor: float
) -> tuple[Array, Array]:
    """Bounds on the errors of the powers from the second on, for values and for slopes: rounding
    (Lemma 28), and what is left out behind the last power."""
    k, q, p = np.arange(2, order + 1), _RATIO_BOUND, order
    per_term = factor + (32 * k + 16) * UNIT_ROUNDOFF
    f_error = rough * (per_term * q ** (k - 2) / (k * (k - 1))).sum()
    f_error += far * (per_term * q ** (k - 1) / k).sum()
    first_error = rough * (per_term * q ** (k - 2) / (k - 1)).sum()
    first_error += far * (per_term * q ** (k - 1)).sum()
    if order > 1:  # the tails
        f_error += near * q ** (p - 1) / (p * (p + 1) * (1 - q)) + far * q**p / ((p + 1) * (1 - q))
        first_error += near * q ** (p - 1) / (p * (1 - q)) + far * q**p / (1 - q)
    return f_error, first_error


class Expansions:
    """Squares that cover a domain, and a map's power series on the discs around them."""

    def __init__(self, map: Any) -> None:
        self._map = map
        self._cover = cover_of(map.domain)
        self._discs = discs_at(map, self._cover.middle, self._cover.radius)

    def __call__(self, z: Array) -> Jets:
        """Jets at (k,) complex points. Points of no square are computed by the formula itself."""
        z = np.ascontiguousarray(z, dtype=complex)
        square = self._cover.square_of(z)
        direct = np.flatnonzero(square < 0)
        parts = _in_parallel(
            lambda s: _evaluated(self._discs, square[s], z[s]), len(z), _PLACES_AT_ONCE
        )
        jets = Jets(*map(np.concatenate, zip(*parts, strict=True)))
        if direct.size:
            for values, own in zip(jets, direct_jets(self._map, z[direct]), strict=True):
                values[direct] = own
        return jets


def _evaluated(discs: Discs, square: Array, z: Array) -> Jets:
    """Horner's rule for g and h and their derivatives."""
    order = len(discs.series) - 1
    # In the order of squares the series are read from the cache.
    place = np.argsort(square, kind="stable")
    square, z = np.maximum(square[place], 0), z[place]
    radius = discs.radius[square]
    t = (z - discs.middle[square]) / radius
    value = np.take(discs.series[order], square, axis=-1)
    slope = np.zeros_like(value)
    for k in range(order - 1, -1, -1):
        slope *= t
        slope += value
        value *= t
        value += np.take(discs.series[k], square, axis=-1)
    slope /= radius
    f = value[0] + np.conj(value[1])
    f_error, first_error = discs.f_error[square], discs.first_error[square]
    back = np.empty_like(place)
    back[place] = np.arange(len(place))
    jets = Jets(f, slope[0], slope[1], f_error, first_error, discs.second[square], radius)
    return jets.at(back)


def jets_at(map: Any, z: Array) -> Jets:
    """Jets at (k,) complex points. For many points the map keeps its power series."""
    if len(z) < _MANY and "expansions" not in map.kept:
        return direct_jets(map, z)
    if "expansions" not in map.kept:
        map.kept["expansions"] = Expansions(map)
    return map.kept["expansions"](z)


def direct_jets(map: Any, z: Array) -> Jets:
    """Jets at (k,) points by the formula of the basis, each in the middle of a disc of its own."""
    radius = _clear(map.domain, z)
    known = radius > 0
    discs = discs_at(map, z, np.where(known, radius, map.domain.cage.unit), order=1)
    (f, _), (g, h) = discs.series
    of = np.where(known, discs.radius, 1)
    f_error, first_error, second = (
        np.where(known, e, np.inf) for e in (discs.f_error, discs.first_error, discs.second)
    )
    fz, fzb_conj = g / discs.radius, h / discs.radius
    return Jets(f, fz, fzb_conj, f_error, first_error, second, np.where(known, of, 0))


def _clear(domain: Domain, z: Array) -> Array:
    """(k,) radii of discs that are well inside the offset cage; 0 outside of it."""
    points: Any = shapely.points(as_points(z))
    polygon = domain.offset_cage.polygon
    distance = shapely.distance(shapely.boundary(polygon), points)
    return np.where(shapely.contains_properly(polygon, points), _RATIO * distance, 0)


class Cover(NamedTuple):
    """Squares that cover a domain: the number of each, on a grid of the smallest, and discs."""

    low: complex
    side: float
    number: Array  # (2^depth, 2^depth), -1 where there is none
    middle: Array
    radius: Array
    inside: Array
    """Which squares lie in the domain as a whole."""

    def square_of(self, z: Array) -> Array:
        """(k,) numbers of the squares that points lie in; -1 for none."""
        n = len(self.number)
        shares = (z - self.low) / self.side * n
        x, y = (np.clip(part, -1, n).astype(np.int64) for part in (shares.real, shares.imag))
        known = (shares.real >= 0) & (x < n) & (shares.imag >= 0) & (y < n)
        return np.where(known, self.number[np.clip(y, 0, n - 1), np.clip(x, 0, n - 1)], -1)

    @classmethod
    def of(cls, domain: Domain) -> Self:
        xmin, ymin, xmax, ymax = domain.cage.bounds
        side = 1.0001 * max(xmax - xmin, ymax - ymin)
        low = complex(xmin + xmax - side, ymin + ymax - side) / 2
        outer, cage = domain.offset_cage.polygon, domain.cage.polygon
        edge = shapely.boundary(outer)
        shapely.prepare(edge)
        number = np.full((1, 1), -1)
        x, y = np.zeros((2, 1), dtype=int)
        middles, radii, insides, count = [], [], [], 0
        for level in range(_DEPTH + 1):
            width = side / 2**level
            middle = low + width * ((x + 0.5) + 1j * (y + 0.5))
            radius = np.full(len(x), width * np.sqrt(0.5) * (1 + 1e-6))
            half = width / 2
            boxes = shapely.box(
                middle.real - half, middle.imag - half, middle.real + half, middle.imag + half
            )
            needed = shapely.intersects(cage, boxes)
            x, y, middle, radius = x[needed], y[needed], middle[needed], radius[needed]
            points: Any = shapely.points(as_points(middle))
            fits = shapely.contains_properly(outer, points)
            fits &= _RATIO * shapely.distance(edge, points) >= radius
            number[y[fits], x[fits]] = count + np.arange(fits.sum())
            count += int(fits.sum())
            insides.append(shapely.contains_properly(cage, boxes[needed][fits]))
            middles.append(middle[fits])
            radii.append(radius[fits])
            if level < _DEPTH:
                number = number.repeat(2, axis=0).repeat(2, axis=1)
                rest_x, rest_y = 2 * x[~fits], 2 * y[~fits]
                x = np.concatenate([rest_x, rest_x + 1, rest_x, rest_x + 1])
                y = np.concatenate([rest_y, rest_y, rest_y + 1, rest_y + 1])
        return cls(low, side, number, *map(np.concatenate, (middles, radii, insides)))

    def contains(self, domain: Domain, z: Array) -> Array:
        """(k,) whether points lie in the closed domain, as ``domain.cage.contains`` says."""
        square = self.square_of(z)
        result = (square >= 0) & self.inside[square]
        rest = np.flatnonzero(~result)
        result[rest] = domain.cage.contains(as_points(z[rest]))
        return result


def cover_of(domain: Domain) -> Cover:
    """The squares of a domain; the domain keeps them."""
    known = vars(domain)
    if "_cover" not in known:
        known["_cover"] = Cover.of(domain)
    return known["_cover"]
