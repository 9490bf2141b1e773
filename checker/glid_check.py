#!/usr/bin/env python3
"""Check a proof that a harmonic map, or a motion, never folds: ``glid-check map.json proof.json``.

It shares nothing with the package that writes the proofs: it needs the standard library and
python-flint, whose real and complex balls (Arb) enclose every rounding error.

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

A motion has such maps at times, its knots; on each piece between two knots phi and psi move on
straight lines. For a unit vector u, ``Re(conj(u) f_z) - |f_zbar|`` is concave in time, so what is
below it at two times is so between; ``sigma_1`` is convex. The turns of ``f_z`` do not change.
On panels of the boundary, and pieces of them and of time as small as it takes, Taylor polynomials
with balls as coefficients prove the bounds, and that ``f_z`` keeps to a half plane.

Exit code 0: verified. 1: refused, a claim is false or could not be proved. 2: unusable files.
"""

from __future__ import annotations

import argparse
import itertools
import json
import math
import operator
import signal
import sys
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

try:
    from flint import acb, acb_mat, acb_poly, arb, arb_mat, ctx, fmpq
except ImportError:
    print("glid-check needs python-flint: pip install python-flint", file=sys.stderr)
    raise SystemExit(2) from None

# Precision, and by how many bits Taylor remainders are smaller than the claimed sigma_2.
LEVELS = ((64, 20), (128, 60), (256, 160), (512, 320))
MOST_BISECTIONS = 300  # of an edge
SMALLEST_PIECE = 2.0**-40  # of a panel, and of time
KINDS = {"glid_nb-map": "glid_nb-proof", "glid_nb-motion": "glid_nb-motion-proof"}
Point = list[float]
Loops = list[list[Point]]
Panel = tuple["Edge", fmpq, fmpq]  # the middle and half of the length as shares of the edge


class RefusedError(Exception):
    """A claim is false or not proved."""


def require(condition: bool, message: str) -> None:
    """Refuse the proof unless the condition holds."""
    if not condition:
        raise RefusedError(message)


def number(value: Any) -> float:
    """A binary64 number, written in decimal or as Python's ``float.hex`` does."""
    written = isinstance(value, str)
    x = float.fromhex(value) if written else float(value if type(value) in (int, float) else "nan")
    if not math.isfinite(x) or (x.hex() if written else x) != value:
        raise ValueError(f"{value!r:.60} is not a finite binary64 number")
    return x


def array(value: Any, *shape: int | None, of: Callable[[Any], Any] = number) -> Any:
    """Nested lists of this shape, None standing for any length."""
    if not shape:
        return of(value)
    if not isinstance(value, list) or shape[0] not in (None, len(value)):
        raise ValueError(f"{value!r:.60} is not a list of {shape[0] or 'any number of'} items")
    return [array(item, *shape[1:], of=of) for item in value]


class File:
    """A motion, or a map as its only knot, of phi and psi, and what a proof claims of it."""

    def __init__(self, data: dict[str, Any]) -> None:
        moving, loops = "motion" in data["format"], []
        for exterior, holes in (("cage", "holes"), ("offset_cage", "offset_holes")):
            loops.append([array(data[exterior], None, 2), *array(data[holes], None, None, 2)])
        self.cage, self.offset_cage = loops
        n_holes, n = len(self.cage) - 1, sum(map(len, self.offset_cage)) + len(self.cage) - 1
        if min(map(len, self.cage + self.offset_cage)) < 3 or n_holes != len(self.offset_cage) - 1:
            raise ValueError("loops need three vertices, and every hole of the cage an offset hole")
        self.hole_points = array(data["hole_points"], n_holes, 2)
        knots = array(data["knots"], None, of=dict) if moving else [{**data, "time": 0}]
        self.knots = [[array(knot[key], n, 2) for key in ("phi", "psi")] for knot in knots]
        self.times = [number(knot["time"]) for knot in knots]
        if len(knots) < 1 + moving or any(a >= b for a, b in itertools.pairwise(self.times)):
            raise ValueError("a motion needs two knots at least, at increasing times")
        self.same = repr(vars(self))  # which tells 0.0 from -0.0
        if "proof" not in data["format"]:
            return
        self.windings = array(data["windings"], None, of=operator.index)
        if moving:
            self.bounds = array(data["pieces"], len(knots) - 1, 3)
            self.panels = [[[0, 0]] for loop in self.cage for _ in loop]
        else:  # panels [k, d] from k/2^d to (k+1)/2^d of an edge
            self.bounds = [[number(data[k]) for k in ("sigma2_lower", "sigma1_upper", "k_upper")]]
            self.panels = array(data["panels"], None, None, 2, of=operator.index)


def load(path: Path, kinds: Iterable[str]) -> tuple[str, File]:
    """The format and the content of a JSON file; a ValueError names the file."""

    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        if len(dict(pairs)) < len(pairs):
            raise ValueError("a key is given twice")
        return dict(pairs)

    try:
        data = json.loads(path.read_bytes().decode("utf-8-sig"), object_pairs_hook=unique)
        found = (data.get("format"), repr(data.get("version"))) if isinstance(data, dict) else ()
        if found not in [(kind, "1") for kind in kinds]:  # true is no number
            raise ValueError(f"this is not a file of the format {' or '.join(kinds)}, version 1")
        return data["format"], File(data)
    except KeyError as error:
        raise ValueError(f"{path}: the key {error} is missing") from error
    except (TypeError, ValueError, OverflowError, RecursionError) as error:
        raise ValueError(f"{path}: {error}") from error


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
        xy = (exact(a) + (exact(b) - exact(a)) * t for a, b in zip(*self[:2], strict=True))
        return acb(*(arb((x.p, 1 - x.q.bit_length())) for x in xy))


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
    sides = [turn(a, b, p) > 0 for p, a, b in ends]
    cross = sides[0] != sides[1] and sides[2] != sides[3]
    return cross or any(on_segment(*end) for end in ends)


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


def check_geometry(motion: File) -> list[Edge]:
    """The edges of a cage that bounds a domain which the singularities do not touch."""
    cage, active = motion.cage, []
    edges = [
        Edge(start, loop[(i + 1) % len(loop)], n, i, (i + 1) % len(loop), name)
        for name, loops in (("cage", cage), ("offset cage", motion.offset_cage))
        for n, loop in enumerate(loops)
        for i, start in enumerate(loop)
    ]
    boxes = [(e, *(sorted(x) for x in zip(e.start, e.end, strict=True))) for e in edges]
    for e, x, y in sorted(boxes, key=lambda box: box[1]):  # a sweep in the direction of x
        require(e.start != e.end, f"{e} has no length")
        active = [box for box in active if box[1][1] >= x[0]]
        for f, _, v in active:
            if "cage" in (e.cage, f.cage) and v[0] <= y[1] and y[0] <= v[1]:
                require(not meet(e, f), f"{e} meets {f}: the cage is not simple, or f singular")
        active.append((e, x, y))
    for i, loop in enumerate(cage):
        area = sum(turn(loop[0], a, b) for a, b in itertools.pairwise(loop))
        require((area > 0) == (i == 0), "the exterior must run counter-clockwise, holes clockwise")
        apart = i == 0 or in_domain(loop[0], cage[:i] + cage[i + 1 :])
        require(apart, f"hole {i} does not lie inside the exterior loop and outside other holes")
    for i, loop in enumerate(motion.offset_cage):
        require(not in_domain(loop[0], cage), f"loop {i} of the offset cage lies in the domain")
    for i, point in enumerate(motion.hole_points, 1):
        require(inside(point, cage[i]), f"the point of hole {i} does not lie strictly inside it")
    return [e for e in edges if e.cage == "cage"]


def tiling(edges: list[Edge], panels: list[list[list[int]]]) -> Iterator[Panel]:
    """The panels; refused if they leave out a part of an edge or cover it twice."""
    require(len(panels) == len(edges), f"there are panels for {len(panels)} of {len(edges)} edges")
    for edge, own in zip(edges, panels, strict=True):
        require(all(0 <= d <= MOST_BISECTIONS for _, d in own), f"a panel of {edge} is no piece")
        starts, ends = ([fmpq(k + end, 2**d) for k, d in own] for end in (0, 1))
        require([*starts, 1] == [0, *ends], f"the panels of {edge} do not tile it")
        yield from ((edge, (a + b) / 2, (b - a) / 2) for a, b in zip(starts, ends, strict=True))


class Functions:
    """``f_z`` and ``conj(f_zbar)`` of all knots in balls; Taylor remainders are about 2^-bits."""

    def __init__(self, motion: File, precision: int, bits: float) -> None:
        ctx.prec = self.precision = precision
        loops = [*motion.offset_cage, motion.hole_points]
        z = self.points = [acb(*p) for loop in loops for p in loop]
        self.next, rows, factors = [], [], []
        for loop in motion.offset_cage:
            first, last = len(self.next), len(self.next) + len(loop) - 1
            self.next += [*range(first + 1, last + 1), first]
        before = {j: i for i, j in enumerate(self.next)}
        for row in itertools.chain(*motion.knots):
            c, two_pi_i = [acb(*x) for x in row], acb(0, 2 * arb.pi())
            s = [(c[j] - c[i]) / (z[j] - z[i]) / two_pi_i for i, j in enumerate(self.next)]
            rows.append(s + c[len(s) :])
            # The factors of log(z_j - z) when the sum over the edges is one over the vertices.
            factors.append([s[before[j]] - s[j] for j in range(len(s))] + c[len(s) :])
        self.rows, self.factors = acb_mat(rows), acb_mat(factors)
        self.sizes = arb_mat([[abs(x) for x in row] for row in factors])
        self.bits = [bits + log2(max(column)) for column in self.sizes.transpose().table()]

    def values(self, z: acb) -> list[acb]:
        """Both functions of each knot at a point of the closed domain."""
        ctx.prec = self.precision
        b = [point - z for point in self.points]
        terms = [(b[j] / b[i]).log() for i, j in enumerate(self.next)]
        terms += [-1 / x for x in b[len(self.next) :]]
        return (self.rows * acb_mat(len(terms), 1, terms)).entries()

    def taylor(self, centre: acb, half: acb) -> tuple[list[acb_poly], list[arb]] | None:
        """Polynomials in t, and bounds on what they leave out, at centre + t half, -1 <= t <= 1.

        None if a singularity is close. With w = half / (z_j - centre), log(z_j - z) has the
        derivative ``-sum_k w^k t^(k-1)`` by t, and 1 / (z - rho) ``-sum_k k w^k t^(k-1) / away``.
        """
        values, sums, tails = self.values(centre), [], []
        for j, point in enumerate(self.points):
            away, pole = point - centre, j >= len(self.next)
            q = abs(w := half / away)
            if not q < 0.75:
                return None
            n = max(0, math.ceil(self.bits[j] / -log2(q)))
            term = -1 / away if pole else acb(-1)
            tails.append(abs(term) * q ** (n + 1) / (1 - q))
            sums.append([(k if pole else 1) * term * w**k for k in range(1, n + 1)])
        n = max(1, *map(len, sums))
        rows = self.factors * acb_mat([row + [acb(0)] * (n - len(row)) for row in sums])
        rests = (self.sizes * arb_mat(len(tails), 1, tails)).entries()
        polynomials = map(acb_poly.integral, map(acb_poly, rows.table()))
        return [v + p for v, p in zip(values, polynomials, strict=True)], rests


def at_time(rows: list[Any], piece: int, share: float) -> list[Any]:
    """What there is of both functions when a share of a piece's time has passed."""
    first, last = rows[2 * piece : 2 * piece + 2], rows[2 * piece + 2 : 2 * piece + 4]
    return [a + share * (b - a) for a, b in zip(first, last, strict=True)] if last else first


def log2(x: arb) -> float:
    """The binary logarithm, roughly: for choices on which no proof rests."""
    return float(x.upper().log()) / math.log(2) if x.upper() > 0 else -1e6


class Piece:
    """Bounds on the modulus of polynomial + error for -1 <= t <= 1: real polynomials."""

    def __init__(self, polynomial: acb_poly, error: arb, along: acb) -> None:
        c = polynomial.coeffs() or [acb(0)]
        self.error, self.middle = acb(arb(0, error), arb(0, error)), abs(c[0])
        # Turned so that `along` is positive: x <= |x + iy| <= x + y^2 / 2x.
        self.c = [a * (along.conjugate() / abs(along)) for a in c] if abs(along) > 0 else c
        x, y = [a.real for a in self.c], sum(abs(a.imag) for a in self.c)
        self.lower = [x[0] - error, *x[1:]]
        self.upper = [sum(map(abs, c)) + error]
        if least(self.lower) > 0:
            self.upper = [x[0] + y * y / (2 * least(self.lower)) + error, *x[1:]]

    def turning(self) -> arb:
        """The change of the argument, for a piece in a half plane."""
        start, end = (sum(a * s**k for k, a in enumerate(self.c)) + self.error for s in (-1, 1))
        return arb.atan2(end.imag, end.real) - arb.atan2(start.imag, start.real)


def least(polynomial: list[arb]) -> arb:
    """A lower bound of a real polynomial for -1 <= t <= 1, exact if it is linear."""
    return polynomial[0] - sum(map(abs, polynomial[1:]))


def halved(f: Piece, g: Piece, claims: list[tuple[str, arb, arb]]) -> int:
    """What to halve until a |f| - |g| >= b is proved for all claims (a, b) and f keeps to a half
    plane: 1 the panel, 2 the time, 3 the rounding errors; 0 where that is so."""
    for name, a, b in claims:
        bounds = itertools.zip_longest(f.lower if a >= 0 else f.upper, g.upper, fillvalue=arb(0))
        if not least([a * x - y for x, y in bounds]) >= b:
            margin = a * (f.middle + f.error.real) - g.middle - g.error.real - b
            require(not margin < 0, f"{name} is false")
            if not margin > 4 * margin.rad():
                return 3
            # Where f turns away from its direction in the time, half of the margin may be lost.
            x, y = f.c[0].real, f.c[0].imag
            seen = a * (x if a >= 0 else x + y * y / (2 * x)) - g.middle - b
            return 1 if x > 0 and seen > margin / 2 else 2
    return 0 if least(f.lower) > 0 else 1


class Checker:
    """The check of one proof."""

    def __init__(self, proof: File) -> None:
        self.proof, self.panels = proof, [*tiling(check_geometry(proof), proof.panels)]
        # What is looked at: an edge, a position on it, a piece and a share of its time.
        self.place = self.panels[0][0], fmpq(0), 0, 0.0
        bits = -math.log2(max(2.0**-60, min(proof.bounds)[0]))
        self.functions = [Functions(proof, prec, more + bits) for prec, more in LEVELS]

    def check(self) -> None:
        """Refuse what is not proved."""
        windings, n_holes = self.proof.windings, len(self.proof.hole_points)
        for both in self.proof.knots:
            phi, psi = (row[len(row) - n_holes :] for row in both)
            tied = all((a, b) == (c, -d) for (a, b), (c, d) in zip(phi, psi, strict=True))
            require(tied, "the logarithms' coefficients phi and psi are not conjugate")
        require(min(self.proof.bounds)[0] > 0, "sigma_2 > 0 is not claimed at all times")
        found = [(turn / (2 * arb.pi())).unique_fmpz() for turn in self.turns(self.proof.bounds)]
        require(found == windings, f"f_z turns {found} times along the loops")
        require(sum(windings) == 0, f"f_z has {sum(windings)} zeros in the domain")

    def turns(self, bounds: list[list[float]]) -> list[arb]:
        """The changes of arg f_z along the loops at first; refused where bounds are not proved."""
        turns, panels, refused = [arb(0)] * len(self.proof.cage), self.panels[::-1], ()
        while panels and bounds:  # those before the first piece that is refused
            edge, middle, size = panel = panels.pop()
            try:
                turning = self.turning(panel, bounds)
            except RefusedError as error:
                where = f"{error} on the panel from {middle - size} to {middle + size} of {edge}"
                refused, bounds = (f"{where}, {self}", self.place), bounds[: self.place[2]]
                continue
            if turning is None:
                panels += [(edge, middle + s * size / 2, size / 2) for s in (1, -1)]
            else:
                turns[edge.loop] += turning
        if refused:
            message, self.place = refused
            raise RefusedError(message)
        return turns

    def turning(self, panel: Panel, bounds: list[list[float]]) -> arb | None:
        """The change along a panel where bounds are proved; None if it has to be halved."""
        edge, middle, size = panel
        for functions in self.functions:
            self.place = edge, middle, 0, 0.0
            taylor = functions.taylor(edge.at(middle), edge.at(size) - edge.at(fmpq(0)))
            if taylor is None:
                require(size.q.bit_length() <= MOST_BISECTIONS, "singularities are near")
                return None
            found = [self.prove(panel, *taylor, i, claims) for i, claims in enumerate(bounds)]
            if None not in found:
                return found[0]
        raise RefusedError("nothing could be decided")

    def prove(self, panel: Panel, rows: Any, rests: Any, piece: int, claimed: Any) -> arb | None:
        """The change at a piece's beginning if its bounds are proved; None: not so precisely."""
        s2, s1, k = claimed
        # In words, then a and b with a |f_z| - |f_zbar| >= b.
        bounds = (f"sigma_2 >= {s2}", 1, s2), (f"sigma_1 <= {s1}", -1, -s1), (f"k <= {k}", k, 0)
        claims = [(text, arb(a), arb(b)) for text, a, b in bounds]
        turning, boxes = arb(0), [(0.0, 1.0, 0.0, 1.0)]
        while boxes:
            t, half, begin, end = boxes.pop()
            wanted, times = 0, (begin, end)[: len(self.proof.knots)]
            both = [[p(acb_poly([t, half])) for p in at_time(rows, piece, s)] for s in times]
            middles = [f[0].mid() for f, _ in both]
            along = sum((z / abs(z) for z in middles if abs(z) > 0), acb(0)).mid()
            for (f, g), share in zip(both[::-1], times[::-1], strict=True):
                self.place = panel[0], panel[1] + panel[2] * exact(t), piece, share
                f_rest, g_rest = at_time(rests, piece, share)
                seen = Piece(f, f_rest, along)
                wanted = max(wanted, halved(seen, Piece(g, g_rest, g[0].mid()), claims))
            if not wanted:
                turning += seen.turning() if begin == 0 else 0
            elif wanted == 3 or min(half, end - begin) < SMALLEST_PIECE:
                return None
            elif wanted == 2:
                now = (begin + end) / 2
                boxes += [(t, half, now, end), (t, half, begin, now)]
            else:
                boxes += [(t + s * half / 2, half / 2, begin, end) for s in (1, -1)]
        return turning

    def __str__(self) -> str:
        """The place in words, with the time of a motion."""
        edge, t, piece, share = self.place
        start, *end = self.proof.times[piece : piece + 2]
        times = [f", at t = {start + share * (stop - start):.9g} s" for stop in end]
        return "".join([f"near {complex(edge.at(t)):.6g}", *times])

    def fold(self) -> str:
        """A place of negative determinant in words, or nothing."""
        try:
            self.turns([[0.0, math.inf, 1.0]] * len(self.proof.bounds))
        except RefusedError:
            edge, t, piece, share = self.place
            if (value := self.determinant(edge.at(t), piece, share)) < 0:
                return f"{value.str(4)} at {t} of {edge}, {self}"
        # At a zero of f_z in the domain, by Newton's method from a grid.
        xs, ys = zip(*self.proof.cage[0], strict=True)
        width, height, n = max(xs) - min(xs), max(ys) - min(ys), 7
        for i, j in itertools.product(range(n), repeat=2):
            z = complex(min(xs) + (i + 0.5) * width / n, min(ys) + (j + 0.5) * height / n)
            for h in [1e-6 * width] * 20:
                finite = math.hypot(z.real, z.imag) < math.inf
                if not (finite and in_domain([z.real, z.imag], self.proof.cage)):
                    break
                if (value := self.determinant(acb(z), 0, 0.0)) < 0:
                    return f"{value.str(4)} at {z}"
                here, beside = (complex(self.functions[0].values(acb(x))[0]) for x in (z, z + h))
                z -= here * h / (beside - here or 1)
        return ""

    def determinant(self, z: acb, piece: int, share: float) -> arb:
        f, g = map(abs, at_time(self.functions[1].values(z), piece, share))
        return (f - g) * (f + g)


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="glid-check", description="Check a certified map.")
    parser.add_argument("map", type=Path, metavar="map.json", help="the map, or the motion")
    parser.add_argument("proof", type=Path, metavar="proof.json", help="what is claimed of it")
    chosen = parser.parse_args(arguments)
    if arguments is None and hasattr(signal, "SIGPIPE"):
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # end quietly once `head` has seen enough
    try:
        kind, motion = load(chosen.map, KINDS)
        _, proof = load(chosen.proof, [KINDS[kind]])
    except (OSError, ValueError) as error:
        print(f"glid-check: {error}", file=sys.stderr)
        return 2
    checker = None
    try:
        require(motion.same == proof.same, f"the proof is one of another {kind[8:]}")
        checker = Checker(proof)
        checker.check()
    except RefusedError as refusal:
        print(f"NOT VERIFIED: {refusal}")
        if checker and (fold := checker.fold()):
            print(f"The map folds. Its determinant is {fold}")
        return 1
    sigma2, sigma1, k = zip(*proof.bounds, strict=True)
    always = "at every time " * (len(motion.times) > 1)
    print(f"VERIFIED: {always}the map is locally injective on the closed domain, and there")
    print(f"sigma_2 >= {min(sigma2)}", f"sigma_1 <= {max(sigma1)}", f"k <= {max(k)}", sep="\n")
    print(f"f_z turns {proof.windings} times along the loops")
    for ends, bounds in zip(itertools.pairwise(motion.times), proof.bounds, strict=False):
        print("{} s to {} s: sigma_2 >= {}, sigma_1 <= {}, k <= {}".format(*ends, *bounds))
    return 0


if __name__ == "__main__":
    sys.exit(main())
