"""Preimages: found, with radii that hold, rounding included."""

from __future__ import annotations

import functools
import pickle

import jax
import numpy as np
import pytest
from flint import acb, arb, ctx
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from glid_nb import InputError
from glid_nb.certificate import certify
from glid_nb.geometry import Cage, Domain
from glid_nb.harmonic import HarmonicMap, MapError
from glid_nb.harmonic.expansions import Expansions, cover_of, direct_jets

from ..support.domains import NAMES, domain, random_map

Array = NDArray[np.float64]


def inside(domain: Domain, count: int, seed: int = 0) -> Array:
    """Points of a domain, the corners of its cage among them."""
    rng = np.random.default_rng(seed)
    xmin, ymin, xmax, ymax = domain.cage.bounds
    points = rng.uniform((xmin, ymin), (xmax, ymax), (8 * count, 2))
    return np.concatenate([*domain.cage.loops, points[domain.cage.contains(points)]])[:count]


def gentle(name: str, seed: int = 1) -> HarmonicMap:
    return random_map(name, 0.01, seed)


def curled(turn: float) -> HarmonicMap:
    """A bar on a circle; beyond 2 pi its ends overlap."""
    x = np.concatenate([np.linspace(-9, 9, 73), np.linspace(9, -9, 73)])
    cage = Cage(np.stack([x, np.repeat([-0.8, 0.8], 73)], axis=1))
    one = Domain.from_cage(cage)
    z = one.offset_cage.loops_complex[0]
    radius = 18 / turn
    # An analytic function of z, which conformal coefficients approximate.
    return HarmonicMap(one, radius * np.exp(1j * z / radius), np.zeros(len(z)))


class Exact:
    """A map by Arb, from its coefficients as the binary64 numbers that they are."""

    def __init__(self, map: HarmonicMap) -> None:
        self.loops, at = [], 0
        for loop in map.domain.offset_cage.loops_complex:
            own = slice(at, at + len(loop))
            self.loops.append(
                [[acb(complex(v)) for v in a] for a in (loop, map.phi[own], map.psi[own])]
            )
            at += len(loop)
        rho = map.domain.hole_points_complex
        self.holes = [
            (acb(complex(p)), acb(complex(c))) for p, c in zip(rho, map.phi[at:], strict=True)
        ]

    def __call__(self, z: acb) -> tuple[acb, acb, acb]:
        """f, f_z and conj(f_zbar)."""
        g = h = dg = dh = acb(0)
        for vertices, phi, psi in self.loops:
            for i, a in enumerate(vertices):
                j = (i + 1) % len(vertices)
                log = ((vertices[j] - z) / (a - z)).log() / (2j * acb.pi())
                for row, sums in ((phi, "g"), (psi, "h")):
                    slope = (row[j] - row[i]) / (vertices[j] - a)
                    value = (row[i] + (z - a) * slope) * log
                    if sums == "g":
                        g, dg = g + value, dg + slope * log
                    else:
                        h, dh = h + value, dh + slope * log
        f = g + h.conjugate()
        for rho, c in self.holes:
            f += c * 2 * abs(z - rho).log()
            dg, dh = dg + c / (z - rho), dh + c.conjugate() / (z - rho)
        return f, dg, dh

    def preimage(self, w: complex, z: complex) -> acb:
        """The solution next to z, to 200 bits."""
        at = acb(z)
        for _ in range(6):
            f, fz, h = self(at)
            r = acb(w) - f
            det = abs(fz) ** 2 - abs(h) ** 2
            step = (fz.conjugate() * r - (h * r).conjugate()) / det
            at = acb((at + step).real.mid(), (at + step).imag.mid())
        assert abs(step) < arb(2) ** -180
        return at


@pytest.mark.parametrize("name", NAMES)
def test_an_exact_preimage_lies_within_the_radius(name: str) -> None:
    map = gentle(name)
    z = inside(map.domain, 40)
    w = map(z)
    few, many = map.inverse.locate(w), HarmonicMap(map.domain, map.phi, map.psi)
    many.kept["expansions"] = Expansions(many)
    ctx.prec = 250
    try:
        exact = Exact(map)
        for found in (few, many.inverse.locate(w)):
            assert found.proved.all()
            for i in range(0, len(found), 3):
                near = complex(*found.points[i])
                preimage = exact.preimage(complex(*w[found.index[i]]), near)
                assert abs(preimage - acb(near)) <= arb(float(found.radius[i]))
    finally:
        ctx.prec = 53
    assert few.radius.max() < 1e-9


@pytest.mark.parametrize("name", NAMES)
def test_jets_are_within_their_errors(name: str) -> None:
    map = gentle(name)
    points = inside(map.domain, 60)
    z = points @ np.array([1, 1j])
    ctx.prec = 200
    try:
        exact = Exact(map)
        for jets in (direct_jets(map, z), Expansions(map)(z)):
            for i in range(0, len(z), 4):
                f, fz, h = exact(acb(complex(z[i])))
                assert abs(f - acb(complex(jets.f[i]))) <= arb(float(jets.f_error[i]))
                off = abs(fz - acb(complex(jets.fz[i]))) + abs(h - acb(complex(jets.fzb_conj[i])))
                assert off <= arb(float(jets.first_error[i]))
    finally:
        ctx.prec = 53


@settings(max_examples=15, deadline=None)
@given(st.sampled_from(NAMES), st.integers(0, 2**32), st.sampled_from([0.0, 0.01, 0.05]))
def test_second_derivatives_are_bounded_nearby(name: str, seed: int, size: float) -> None:
    map, rng = random_map(name, size, seed), np.random.default_rng(seed)
    z = inside(map.domain, 50, seed) @ np.array([1, 1j])
    for jets in (direct_jets(map, z), Expansions(map)(z)):
        near = z + jets.radius * np.sqrt(rng.uniform(size=len(z))) * np.exp(
            6.3j * rng.uniform(size=len(z))
        )
        fzz, gzz = map.wirtinger_derivatives(near, 1)
        assert (abs(fzz) + abs(gzz) <= jets.second * (1 + 1e-9) + 1e-9).all()


@settings(max_examples=10, deadline=None)
@given(st.sampled_from(NAMES), st.integers(0, 2**32), st.sampled_from([0.0, 0.005, 0.02]))
def test_points_come_back(name: str, seed: int, size: float) -> None:
    map = random_map(name, size, seed)
    if not certify(map).certified:
        return
    z = inside(map.domain, 3000, seed)
    found = map.inverse.locate(map(z), all=True)
    assert (found.found >= 1).all()
    gap = np.linalg.norm(found.points - z[found.index], axis=1)
    best = np.full(len(z), np.inf)
    np.minimum.at(best, found.index, gap)
    assert best.max() < 1e-9
    assert map.domain.cage.contains(found.points).all()


def test_no_second_preimage_is_near() -> None:
    map, rng = gentle("twin"), np.random.default_rng(3)
    found = map.inverse.locate(map(inside(map.domain, 400)))
    assert (found.alone > found.radius).all()
    turns = np.exp(2j * np.pi * rng.uniform(size=(2, len(found))))
    z = found.points @ np.array([1, 1j])
    a, b = z + found.alone * np.sqrt(rng.uniform(size=turns.shape)) * turns
    slope = abs((map(a) - map(b)) @ [1, 1j]) / abs(a - b).ravel()
    assert slope.min() > 0.05
    with_proof = map.inverse.locate(map(inside(map.domain, 400)), certificate=certify(map))
    assert (with_proof.alone >= found.alone).all()
    assert (with_proof.radius <= found.radius).all()


def test_a_shape_that_overlaps_itself_has_several_preimages() -> None:
    map = curled(2.2 * np.pi)
    assert certify(map).certified
    right = np.stack(np.meshgrid(np.linspace(8, 8.8, 9), np.linspace(-0.5, 0.5, 5)), -1).reshape(
        -1, 2
    )
    w = map(right)
    every, one = map.inverse(w, all=True), map.inverse(w)
    assert (every.found == 2).all()
    assert np.allclose(map(every.points), w[every.index], atol=1e-12)
    assert np.allclose(map(one), w, atol=1e-12)
    apart = np.linalg.norm(every.points[::2] - every.points[1::2], axis=1)
    assert (apart > every.alone[::2] + every.alone[1::2]).all()
    assert (map.inverse.locate(map([[0.0, 0.0]]), all=True).found == 1).all()


def test_outside_there_is_nothing() -> None:
    map = gentle("ring")
    w = [[99.0, 0.0], [0.0, 0.0], [2.0, 0.5]]  # the second lies in the hole
    found = map.inverse.locate(w)
    assert found.found.tolist() == [0, 0, 1]
    away = map.inverse(w)
    assert np.isfinite(away).all()
    assert (away[:2] == map.inverse.nowhere).all()
    assert not map.domain.cage.contains(away[:2]).any()
    assert np.isnan(map.inverse(w, outside="nan")).all(axis=1).tolist() == [True, True, False]
    assert len(map.inverse(np.empty((0, 2)))) == 0
    assert len(map.inverse([[99, 0]], all=True)) == 0


def test_the_inverse_of_the_inverse_is_the_map() -> None:
    map = gentle("ell")
    assert map.inverse.inverse is map
    assert map.inverse is map.inverse
    copy = pickle.loads(pickle.dumps(map.inverse))
    z = inside(map.domain, 10)
    assert np.array_equal(copy(map(z)), map.inverse(map(z)))
    assert np.allclose(map.residuals(z, map(z) + np.array([3, 4])), 5)
    assert map.inverse.residuals(map(z), z).max() < 1e-12


def test_bad_input_is_named() -> None:
    map = gentle("ell")
    with pytest.raises(MapError, match="point 1 is"):
        map.inverse([[0, 0], [np.nan, 0]])
    with pytest.raises(MapError, match=r"point 1 is \(nan, 2\)"):
        map([[0, 0], [np.nan, 2]])
    for masked in (
        np.ma.masked_equal([[0, 1], [2, 3]], 2),
        np.ma.masked_equal([1, 2 + 1j], 2 + 1j),
    ):
        with pytest.raises(MapError, match="point 1 is masked"):
            map(masked)
        with pytest.raises(MapError, match="point 1 is masked"):
            map.inverse(masked)
    with pytest.raises(MapError, match=r"write one point as \[\[x, y\]\]"):
        map.inverse([1, 0.1])
    with pytest.raises(MapError, match="certificate must be"):
        map.inverse.locate([[0, 0]], certificate=3)  # type: ignore[arg-type]
    with pytest.raises(MapError, match="all must be bool"):
        map.inverse([[0, 0]], all="yes")  # type: ignore[call-overload]
    with pytest.raises(MapError, match="'away' or 'nan'"):
        map.inverse([[0, 0]], outside="extend")  # type: ignore[call-overload]
    with pytest.raises(MapError, match="2 points src and 1 points dst"):
        map.residuals([[0, 0], [1, 1]], [[0, 0]])
    with pytest.raises(InputError, match="belongs to another map"):
        map.inverse.locate([[0, 0]], certificate=certify(gentle("ell", 2)))


class NoNumbers:
    """As a tensor of PyTorch that requires a gradient."""

    def __array__(self, *given: object, **how: object) -> Array:
        raise RuntimeError("Can't call numpy() on Tensor that requires grad.")


def test_arrays_that_cannot_be_read_are_named() -> None:
    with pytest.raises(MapError, match=r"points must be .*requires grad"):
        gentle("ell").inverse(NoNumbers())
    with pytest.raises(MapError, match="JAX traces these"):
        jax.jit(gentle("ell").inverse)(np.zeros((1, 2)))


def test_a_map_that_folds_proves_nothing_false() -> None:
    one = domain("ell")
    flat = HarmonicMap.identity(one)
    folded = HarmonicMap(one, flat.phi, flat.phi * 1.0)  # z + conj(z)
    found = folded.inverse.locate([[0.5, 0.0], [1.0, 1.0]], all=True)
    assert not found.proved.any()
    assert (found.alone == 0).all()


def test_squares_cover_the_domain() -> None:
    for name in NAMES:
        one = domain(name)
        z = inside(one, 2000) @ np.array([1, 1j])
        cover = cover_of(one)
        square = cover.square_of(z)
        assert (square >= 0).mean() > 0.99
        known = square >= 0
        assert (abs(z - cover.middle[square])[known] <= cover.radius[square][known]).all()
        assert cover.contains(one, z).all()


@functools.cache
def narrow() -> HarmonicMap:
    """A slit of width 1e-7, where no square fits."""
    outline = [[0, 0], [4, 0], [4, 3], [2.0000001, 3], [2, 0.6], [1.9999999, 3], [0, 3]]
    one = Domain.from_cage(Cage(outline))
    rng = np.random.default_rng(0)
    change = 1e-10 * rng.normal(size=(2, one.n_coefficients))
    return HarmonicMap(one, HarmonicMap.identity(one).phi + change[0], change[1])


def test_points_at_a_narrow_slit_come_back() -> None:
    map = narrow()
    z = inside(map.domain, 3000)
    back = map.inverse.locate(map(z))
    assert (back.found == 1).all()
    assert np.allclose(back.points, z, atol=1e-9)
