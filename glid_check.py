#!/usr/bin/env python3
"""Check a proof that a harmonic map is locally injective: ``glid-check map.json proof.json``.

This program shares nothing with the package that writes the proofs. It needs the standard library
and python-flint, whose real and complex balls (Arb) enclose every rounding error.

The map lives on a polygon with holes, its cage. Around the cage lies the offset cage, with vertices
``z_j``, and there is a point ``rho_h`` in every hole:

    f(z) = sum_j C_j(z) phi_j + conj(sum_j C_j(z) psi_j),

with Cauchy coordinates ``C_j`` for the vertices, and ``ln |z - rho_h|`` for the holes, where
``phi_h = conj(psi_h)``. Summed over the edges e of the offset cage, from ``z_e`` to ``z_e'``,

    f_z          = 1/(2 pi i) sum_e s_e Log((z_e' - z) / (z_e - z)) + sum_h phi_h / (z - rho_h),
    conj(f_zbar) = the same with psi,        s_e = (phi_e' - phi_e) / (z_e' - z_e).

Both are holomorphic on the closed domain if no edge of the offset cage and no ``rho_h`` touches it.
The Jacobian has the singular values ``sigma_1, sigma_2 = |f_z| +- |f_zbar|``; ``k`` is
``|f_zbar| / |f_z|``. If ``sigma_2 > 0`` on the boundary and the turns of ``f_z`` along the loops
(exterior counter-clockwise, holes clockwise) add up to 0, the map is locally injective, and bounds
on the boundary hold on the whole domain (Chen and Weber 2017, Theorem 4.2).

In the order of the code: the proof names the same map as the map's file, bit for bit. In exact
arithmetic, the cage is simple and oriented, its holes lie inside and apart, everything singular
lies outside, and the panels of the proof tile every edge of the cage. On each panel both functions
are Taylor polynomials with balls as coefficients and a bound on the remainder. On pieces as small,
and with a precision as high, as it takes, they prove the bounds and that ``f_z`` keeps to a half
plane, which gives its turns exactly.

Exit code 0: verified. 1: refused, a claim is false or could not be proved. 2: unusable files.
"""

from __future__ import annotations

import argparse
import itertools
import json
import math
import operator
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

try:
    from flint import acb, acb_poly, arb, ctx, fmpq
except ImportError:
    print("glid-check needs python-flint: pip install python-flint", file=sys.stderr)
    raise SystemExit(2) from None

# Precision, and by how many bits Taylor remainders are smaller than the claimed sigma_2.
LEVELS = ((64, 20), (128, 60), (256, 160), (512, 320))
MOST_BISECTIONS = 300  # of an edge
SMALLEST_PIECE = 2.0**-40  # of a panel

Point = list[float]
Loops = list[list[Point]]
Panel = tuple["Edge", fmpq, fmpq]
"""An edge, the middle of a piece of it and half of its length, as shares of the edge."""


class FileError(Exception):
    """A file is not what it should be."""


class RefusedError(Exception):
    """A claim is false or not proved: a message, and the edge and the position on it if known."""


class InconclusiveError(Exception):
    """The precision does not suffice."""


def require(condition: bool, message: str) -> None:
    """Refuse the proof unless the condition holds."""
    if not condition:
        raise RefusedError(message)


class Map(NamedTuple):
    """A map; loops begin with the exterior."""

    cage: Loops
    offset_cage: Loops
    hole_points: list[Point]
    phi: list[Point]
    psi: list[Point]


class Proof(NamedTuple):
    """The claims; panels are (k, d), from k/2^d to (k+1)/2^d, per edge of the cage in order."""

    map: Map
    sigma2_lower: float
    sigma1_upper: float
    k_upper: float
    windings: list[int]
    panels: list[list[list[int]]]


def number(value: Any) -> float:
    """A binary64 number, written in decimal or as Python's ``float.hex`` does."""
    written = isinstance(value, str)
    x = (
        float.fromhex(value)
        if written
        else float(value)
        if type(value) in (int, float)
        else math.nan
    )
    if not math.isfinite(x) or (x.hex() if written else x) != value:
        raise FileError(f"{value!r:.60} is not a finite binary64 number")
    return x


def array(value: Any, *shape: int | None, of: Callable[[Any], Any] = number) -> Any:
    """Nested lists of this shape, None standing for any length."""
    if not shape:
        return of(value)
    if not isinstance(value, list) or shape[0] not in (None, len(value)):
        raise FileError(f"{value!r:.60} is not a list of {shape[0] or 'any number of'} items")
    return [array(item, *shape[1:], of=of) for item in value]


def map_of(data: dict[str, Any]) -> Map:
    """The map in a file of either kind."""
    cage = [array(data["cage"], None, 2), *array(data["holes"], None, None, 2)]
    offset_cage = [array(data["offset_cage"], None, 2), *array(data["offset_holes"], None, None, 2)]
    if min(map(len, cage + offset_cage)) < 3 or len(cage) != len(offset_cage):
        raise FileError("loops need three vertices, and every hole of the cage an offset hole")
    n_holes, n = len(cage) - 1, sum(map(len, offset_cage)) + len(cage) - 1
    rho, phi, psi = array(data["hole_points"], n_holes, 2), data["phi"], data["psi"]
    return Map(cage, offset_cage, rho, array(phi, n, 2), array(psi, n, 2))


def proof_of(data: dict[str, Any]) -> Proof:
    """The claims in a proof's file."""
    s2, s1, k = (number(data[key]) for key in ("sigma2_lower", "sigma1_upper", "k_upper"))
    panels = array(data["panels"], None, None, 2, of=operator.index)
    return Proof(map_of(data), s2, s1, k, array(data["windings"], None, of=operator.index), panels)


def load(path: Path, kind: str, parse: Callable[[dict[str, Any]], Any]) -> Any:
    """The value in a JSON file; FileError names the file."""

    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        if len(dict(pairs)) < len(pairs):
            raise FileError("a key is given twice")
        return dict(pairs)

    try:
        data = json.loads(path.read_bytes().decode("utf-8-sig"), object_pairs_hook=unique)
        if not isinstance(data, dict) or (data.get("format"), data.get("version")) != (kind, 1):
            raise FileError(f"this is not a file of the format {kind}, version 1")
        return parse(data)
    except KeyError as error:
        raise FileError(f"{path}: the key {error} is missing") from error
    except (FileError, TypeError, ValueError, OverflowError, RecursionError) as error:
        raise FileError(f"{path}: {error}") from error


class Edge(NamedTuple):
    """An edge of the cage or the offset cage."""

    start: Point
    end: Point
    loop: int
    index: int
    next: int
    cage: str

    def __str__(self) -> str:
        loop = f"hole {self.loop}" if self.loop else "the exterior loop"
        return f"edge {self.index} of {loop} of the {self.cage}"

    def at(self, t: fmpq) -> acb:
        """The exact point at a dyadic position from 0 to 1."""
        ends = zip(map(exact, self.start), map(exact, self.end), strict=True)
        xy = ((a + (b - a) * t) for a, b in ends)
        return acb(*(arb((x.p, 1 - x.q.bit_length())) for x in xy))


def edges_of(cage: Loops, name: str) -> list[Edge]:
    return [
        Edge(start, loop[(i + 1) % len(loop)], number, i, (i + 1) % len(loop), name)
        for number, loop in enumerate(cage)
        for i, start in enumerate(loop)
    ]


def exact(x: float) -> fmpq:
    return fmpq(*x.as_integer_ratio())


def turn(a: Point, b: Point, c: Point) -> fmpq:
    """Twice the signed area of a triangle."""
    ax, ay, bx, by, cx, cy = map(exact, (*a, *b, *c))
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)


def on_segment(p: Point, a: Point, b: Point) -> bool:
    between = all(min(u, v) <= x <= max(u, v) for x, u, v in zip(p, a, b, strict=True))
    return between and turn(a, b, p) == 0


def meet(e: Edge, f: Edge) -> bool:
    """Whether two edges have a common point other than the vertex between successive ones."""
    if (e.loop, e.cage) == (f.loop, f.cage) and (e.next == f.index or f.next == e.index):
        e, f = (e, f) if e.next == f.index else (f, e)
        return on_segment(e.start, f.start, f.end) or on_segment(f.end, e.start, e.end)
    ends = ((e.start, *f[:2]), (e.end, *f[:2]), (f.start, *e[:2]), (f.end, *e[:2]))
    if any(on_segment(*end) for end in ends):
        return True
    sides = [turn(a, b, p) > 0 for p, a, b in ends]
    return sides[0] != sides[1] and sides[2] != sides[3]


def meeting(edges: list[Edge]) -> Iterator[tuple[Edge, Edge]]:
    """The pairs of edges that meet, by a sweep in the direction of x."""
    active: list[tuple[Edge, list[float], list[float]]] = []
    boxes = [(e, *(sorted(x) for x in zip(e.start, e.end, strict=True))) for e in edges]
    for e, x, y in sorted(boxes, key=lambda box: box[1]):
        active = [box for box in active if box[1][1] >= x[0]]
        yield from ((f, e) for f, _, v in active if v[0] <= y[1] and y[0] <= v[1] and meet(e, f))
        active.append((e, x, y))


def inside(p: Point, loop: list[Point]) -> bool:
    """Whether a point lies strictly inside a simple loop."""
    odd = False
    for a, b in zip(loop, [*loop[1:], loop[0]], strict=True):
        if on_segment(p, a, b):
            return False
        if (a[1] > p[1]) != (b[1] > p[1]):
            odd ^= (turn(a, b, p) > 0) == (b[1] > a[1])
    return odd


def in_domain(p: Point, cage: Loops) -> bool:
    """Whether a point that is not on the cage lies in its domain."""
    return inside(p, cage[0]) and not any(inside(p, hole) for hole in cage[1:])


def check_geometry(map: Map) -> list[Edge]:
    """The edges of a cage that bounds a domain which the singularities do not touch."""
    cage, edges = map.cage, edges_of(map.cage, "cage")
    all_edges = [*edges, *edges_of(map.offset_cage, "offset cage")]
    for e in all_edges:
        require(e.start != e.end, f"{e} has no length")
    for e, f in meeting(edges):
        raise RefusedError(f"{e} meets {f}: the cage is not simple")
    for i, loop in enumerate(cage):
        area = sum(turn(loop[0], a, b) for a, b in itertools.pairwise(loop))
        require((area > 0) == (i == 0), "the exterior must run counter-clockwise, holes clockwise")
        apart = i == 0 or in_domain(loop[0], cage[:i] + cage[i + 1 :])
        require(apart, f"hole {i} does not lie inside the exterior loop and outside other holes")
    for e, f in meeting(all_edges):
        require(e.cage == f.cage, f"{e} meets {f}, so that f is singular there")
    for i, loop in enumerate(map.offset_cage):
        require(not in_domain(loop[0], cage), f"loop {i} of the offset cage lies in the domain")
    for i, point in enumerate(map.hole_points, 1):
        require(inside(point, cage[i]), f"the point of hole {i} does not lie strictly inside it")
    return edges


def tiling(edges: list[Edge], panels: list[list[list[int]]]) -> list[Panel]:
    """The panels; refused if they leave out a part of an edge or cover it twice."""
    require(len(panels) == len(edges), f"there are panels for {len(panels)} of {len(edges)} edges")
    result: list[Panel] = []
    for edge, own in zip(edges, panels, strict=True):
        require(all(0 <= d <= MOST_BISECTIONS for _, d in own), f"a panel of {edge} is no piece")
        starts, ends = ([fmpq(k + end, 2**d) for k, d in own] for end in (0, 1))
        require([*starts, 1] == [0, *ends], f"the panels of {edge} do not tile it")
        result += [(edge, (a + b) / 2, (b - a) / 2) for a, b in zip(starts, ends, strict=True)]
    return result


class Functions:
    """``f_z`` and ``conj(f_zbar)`` in balls; Taylor remainders are about 2^-bits."""

    def __init__(self, map: Map, precision: int, bits: float) -> None:
        ctx.prec = self.precision = precision
        z = self.points = [acb(*p) for loop in [*map.offset_cage, map.hole_points] for p in loop]
        self.next, self.rows, factors = [], [], []
        for loop in map.offset_cage:
            first, last = len(self.next), len(self.next) + len(loop) - 1
            self.next += [*range(first + 1, last + 1), first]
        before = {j: i for i, j in enumerate(self.next)}
        for row in (map.phi, map.psi):
            c, two_pi_i = [acb(*x) for x in row], acb(0, 2 * arb.pi())
            s = [(c[j] - c[i]) / (z[j] - z[i]) / two_pi_i for i, j in enumerate(self.next)]
            self.rows.append(s + c[len(s) :])
            # The factors of log(z_j - z) when the sum over the edges is one over the vertices.
            factors.append([s[before[j]] - s[j] for j in range(len(s))] + c[len(s) :])
        self.factors = list(zip(*factors, strict=True))
        self.bits = [bits + log2(abs(a) + abs(b)) for a, b in self.factors]

    def values(self, z: acb) -> list[acb]:
        """Both functions at a point of the closed domain."""
        ctx.prec = self.precision
        b = [point - z for point in self.points]
        terms = [(b[j] / b[i]).log() for i, j in enumerate(self.next)]
        terms += [-1 / x for x in b[len(self.next) :]]
        return [sum(map(acb.__mul__, row, terms), acb(0)) for row in self.rows]

    def taylor(self, centre: acb, half: acb) -> list[tuple[acb_poly, arb]] | None:
        """Polynomials in t, and bounds on what they leave out, at centre + t half, -1 <= t <= 1.

        None if a singularity is close. With w = half / (z_j - centre), log(z_j - z) has the
        derivative ``-sum_k w^k t^(k-1)`` by t, and 1 / (z - rho) ``-sum_k k w^k t^(k-1) / away``.
        """
        values, sums, rests = self.values(centre), ([], []), [arb(0), arb(0)]
        for j, point in enumerate(self.points):
            away, pole = point - centre, j >= len(self.next)
            w = half / away
            q = abs(w)
            if not q < 0.75:
                return None
            n = max(0, math.ceil(self.bits[j] / -log2(q)))
            for row, factor in enumerate(self.factors[j]):
                term = -factor / away if pole else -factor
                rests[row] += abs(term) * q ** (n + 1) / (1 - q)
                sums[row].extend([acb(0)] * (n - len(sums[row])))
                for k in range(n):
                    term *= w
                    sums[row][k] += (k + 1) * term if pole else term
        polynomials = [v + acb_poly(s).integral() for v, s in zip(values, sums, strict=True)]
        return list(zip(polynomials, rests, strict=True))


def log2(x: arb) -> float:
    """The binary logarithm, roughly: for choices on which no proof rests."""
    return float(x.upper().log()) / math.log(2) if x.upper() > 0 else -1e6


class Piece:
    """Bounds on the modulus of polynomial + error for -1 <= t <= 1: real polynomials."""

    def __init__(self, polynomial: acb_poly, error: arb) -> None:
        c = polynomial.coeffs() or [acb(0)]
        self.error, self.middle, mid = acb(arb(0, error), arb(0, error)), abs(c[0]), c[0].mid()
        # Turned so that its middle is positive it is x + iy, and x <= modulus <= x + y^2 / 2x.
        self.c = [a * mid.conjugate() / abs(mid) for a in c] if abs(mid) > 0 else c
        x, y = [a.real for a in self.c], sum(abs(a.imag) for a in self.c)
        self.lower = [x[0] - error, *x[1:]]
        self.in_half_plane = least(self.lower) > 0
        self.upper = [sum(map(abs, c)) + error]
        if self.in_half_plane:
            self.upper = [x[0] + y * y / (2 * least(self.lower)) + error, *x[1:]]

    def turning(self) -> arb:
        """The change of the argument, for a piece in a half plane."""
        start, end = (sum(a * s**k for k, a in enumerate(self.c)) + self.error for s in (-1, 1))
        return arb.atan2(end.imag, end.real) - arb.atan2(start.imag, start.real)


def least(polynomial: list[arb]) -> arb:
    """A lower bound of a real polynomial for -1 <= t <= 1, exact if it is linear."""
    return polynomial[0] - sum(map(abs, polynomial[1:]))


def proved(f: Piece, g: Piece, claims: list[tuple[str, arb, arb]]) -> bool:
    """Whether a |f| - |g| >= b for all claims (a, b), and f keeps to a half plane."""
    for name, a, b in claims:
        bounds = itertools.zip_longest(f.lower if a >= 0 else f.upper, g.upper, fillvalue=arb(0))
        if not least([a * x - y for x, y in bounds]) >= b:
            margin = a * (f.middle + f.error.real) - g.middle - g.error.real - b
            if margin < 0:
                raise RefusedError(f"{name} is false")
            if not margin > 4 * margin.rad():
                raise InconclusiveError
            return False
    return f.in_half_plane


class Checker:
    """The check of one proof."""

    def __init__(self, proof: Proof) -> None:
        s2, s1, k = proof[1:4]
        self.proof, self.panels = proof, tiling(check_geometry(proof.map), proof.panels)
        bits = -math.log2(s2) if s2 > 0 else 0
        self.functions = [Functions(proof.map, prec, more + bits) for prec, more in LEVELS]
        # The bounds in words, then a and b with a |f_z| - |f_zbar| >= b.
        names = f"sigma_2 >= {s2}", f"sigma_1 <= {s1}", f"k <= {k}"
        self.claims = [*zip(names, map(arb, (1, -1, k)), map(arb, (s2, -s1, 0)), strict=True)]

    def check(self) -> None:
        """Refuse what is not proved."""
        proof, n_holes = self.proof, len(self.proof.map.hole_points)
        phi, psi = (row[len(row) - n_holes :] for row in (proof.map.phi, proof.map.psi))
        conjugate = all((a, b) == (c, -d) for (a, b), (c, d) in zip(phi, psi, strict=True))
        require(conjugate, "the logarithms' coefficients phi and psi are not conjugate")
        require(proof.sigma2_lower > 0, "sigma_2 > 0 is not claimed, and so no local injectivity")
        turns = [arb(0)] * (n_holes + 1)
        for panel in self.panels:
            turns[panel[0].loop] += self.turning(*panel)
        found = [(turn / (2 * arb.pi())).unique_fmpz() for turn in turns]
        require(found == proof.windings, f"f_z turns {found} times along the loops")
        require(sum(proof.windings) == 0, f"f_z has {sum(proof.windings)} zeros in the domain")

    def turning(self, edge: Edge, middle: fmpq, size: fmpq) -> arb:
        """The change of arg f_z along a panel, on which all claims are proved first."""
        where = f"on the panel from {middle - size} to {middle + size} of {edge}"
        for functions in self.functions:
            taylor = functions.taylor(edge.at(middle), edge.at(size) - edge.at(fmpq(0)))
            if taylor is None:
                require(size.q.bit_length() <= MOST_BISECTIONS, f"singularities are near {where}")
                halves = (self.turning(edge, middle + s * size / 2, size / 2) for s in (-1, 1))
                return sum(halves, arb(0))
            turning, pieces = arb(0), [(0.0, 1.0)]
            try:
                while pieces:
                    t, half = pieces.pop()
                    f, g = (Piece(p(acb_poly([t, half])), rest) for p, rest in taylor)
                    if proved(f, g, self.claims):
                        turning += f.turning()
                        continue
                    if half < SMALLEST_PIECE:
                        raise InconclusiveError
                    pieces += [(t + half / 2, half / 2), (t - half / 2, half / 2)]
                return turning
            except InconclusiveError:
                continue
            except RefusedError as error:
                t = middle + size * exact(t)
                near = f"near {complex(edge.at(t)):.6g}"
                raise RefusedError(f"{error} {where}, {near}", edge, t) from None
        raise RefusedError(f"nothing could be decided {where}", edge, middle)

    def determinant(self, z: acb) -> arb:
        f, g = map(abs, self.functions[1].values(z))
        return (f - g) * (f + g)

    def fold(self, *place: Any) -> str:
        """A place of negative determinant in words, or nothing: downhill along the boundary."""
        starts = [(*place, fmpq(1, 4))] if place else []
        starts += self.panels
        found = [(self.determinant(edge.at(t)), edge, t, step) for edge, t, step in starts]
        for value, edge, t, step in sorted(found, key=lambda one: float(one[0]))[:4]:
            for _ in range(40):
                if value < 0:
                    return f"{value.str(4)} at {t} of {edge}, near {complex(edge.at(t)):.6g}"
                for s in (t - step, t + step):
                    if 0 <= s <= 1 and (other := self.determinant(edge.at(s))).mid() < value.mid():
                        value, t = other, s
                        break
                else:
                    step /= 2
        return ""

    def branch_point(self) -> str:
        """The same at a zero of f_z in the domain, by Newton's method from a grid."""
        xs, ys = zip(*self.proof.map.cage[0], strict=True)
        width, height, n = max(xs) - min(xs), max(ys) - min(ys), 7
        for i, j in itertools.product(range(n), repeat=2):
            z = complex(min(xs) + (i + 0.5) * width / n, min(ys) + (j + 0.5) * height / n)
            for _ in range(20):
                if not in_domain([z.real, z.imag], self.proof.map.cage):
                    break
                if (value := self.determinant(acb(z))) < 0:
                    return f"{value.str(4)} at {z}"
                values = map(self.functions[0].values, (acb(z), acb(z + 1e-6 * width)))
                here, beside = (complex(f) for f, _ in values)
                z -= here * 1e-6 * width / (beside - here or 1)
        return ""


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="glid-check", description="Check a certified map.")
    parser.add_argument("map", type=Path, metavar="map.json", help="the map")
    parser.add_argument("proof", type=Path, metavar="proof.json", help="what is claimed of it")
    chosen = parser.parse_args(arguments)
    try:
        map_ = load(chosen.map, "glid_nb-map", map_of)
        proof = load(chosen.proof, "glid_nb-proof", proof_of)
    except (OSError, FileError) as error:
        print(f"glid-check: {error}", file=sys.stderr)
        return 2
    checker = None
    try:
        # The text tells 0.0 from -0.0.
        require(repr(map_) == repr(proof.map), "the proof is one of another map")
        checker = Checker(proof)
        checker.check()
    except RefusedError as refusal:
        print(f"NOT VERIFIED: {refusal.args[0]}")
        if checker and (fold := checker.fold(*refusal.args[1:]) or checker.branch_point()):
            print(f"The map folds. Its determinant is {fold}")
        return 1
    print("VERIFIED: the map is locally injective on the closed domain, and there")
    print(*(name for name, *_ in checker.claims), sep="\n")
    print(f"f_z turns {proof.windings} times along the loops")
    return 0


if __name__ == "__main__":
    sys.exit(main())
