"""Certificates of whole maps against dense evaluation by the paper's formulas."""

from __future__ import annotations

import functools
import pickle
import re
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb._errors import InputError
from glid_nb.certificate import Certificate, certify, global_injectivity, rounding
from glid_nb.certificate.certify import CertificateError, Known, known_on, proof_text, split_panels
from glid_nb.geometry import (
    Cage,
    Domain,
    GeometryError,
    Panels,
    graded_panels,
    uniform_panels,
)
from glid_nb.harmonic import HarmonicMap, run_on

from ..support.domains import dense_check, domain, random_map, reference
from ..support.reference_map import DenseCheck, Measured, cauchy_first

pytestmark = pytest.mark.slow  # most of the time is compiling

KINDS = ("hermite", "lipschitz")
CERTIFIED = ("ell", "ring", "twin")

# Sizes at which the random maps go from almost isometric to folded everywhere.
sizes = st.floats(-2.5, 0.2).map(lambda e: 10.0**e)


@functools.cache
def measured(name: str, size: float, seed: int) -> tuple[HarmonicMap, Measured]:
    map = random_map(name, size, seed)
    return map, dense_check(name).measure(map.phi, map.psi)


def check_sound(c: Certificate, truth: Measured) -> None:
    """Nothing certified is contradicted by 2 x 10^5 points on the boundary and inside."""
    rounding = 1e-12 * (1 + truth.sigma1)
    if c.certified:
        assert 0 < c.sigma2_lower <= truth.sigma2 + rounding
        assert c.sigma1_upper >= truth.sigma1 - rounding
        assert 1 > c.k_upper >= truth.k - rounding
        assert c.windings == truth.windings
        assert c.winding == 0
    elif "not locally injective: sigma_2" in c.reason:
        assert truth.sigma2_boundary < 0.05 * truth.sigma1  # dense points may miss the fold
        assert c.sigma2_lower <= truth.sigma2_boundary + rounding
    elif "zeros" in c.reason:
        assert c.winding == sum(truth.windings) != 0
    assert c.certified == c.reason.startswith("Proved locally injective")


@pytest.mark.parametrize("kind", KINDS)
@given(name=st.sampled_from(CERTIFIED), size=sizes, seed=st.integers(0, 10**6))
@settings(max_examples=20)
def test_certificates_are_true(kind: Any, name: str, size: float, seed: int) -> None:
    map, truth = measured(name, size, seed)
    c = certify(map, kind)
    check_sound(c, truth)
    # With refinement, only a real obstacle prevents a proof.
    if truth.sigma2 > 0.02 and sum(truth.windings) == 0:
        assert c.certified, c.reason
    if truth.sigma2_boundary <= 0:
        assert not c.certified
        assert "not locally injective" in c.reason


@pytest.mark.parametrize("kind", KINDS)
@given(name=st.sampled_from(CERTIFIED), size=sizes, seed=st.integers(0, 10**6))
@settings(max_examples=10)
def test_every_panel_is_true(kind: Any, name: str, size: float, seed: int) -> None:
    map = random_map(name, size, seed)
    c = certify(map, kind)
    panels = c.panels
    start, end = panels.start, panels.end
    t = np.linspace(0, 1, 9)
    z = (start[:, None] + (end - start)[:, None] * t).ravel()
    yardstick = reference(map)
    d = cauchy_first(z, yardstick.loops, yardstick.rho)
    f, g = (np.abs(d @ v).reshape(len(start), -1) for v in (map.phi, map.psi))
    rounding = 1e-11 * (1 + f.max())
    assert (panels.sigma2_lower <= (f - g).min(axis=1) + rounding).all()
    assert (panels.sigma1_upper >= (f + g).max(axis=1) - rounding).all()
    assert (panels.k_upper >= (g / f).max(axis=1) - rounding).all()
    assert c.sigma2_lower == panels.sigma2_lower.min()
    assert c.sigma1_upper == panels.sigma1_upper.max()
    assert c.k_upper == panels.k_upper.max()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", CERTIFIED)
@pytest.mark.parametrize("tightness", [0.02, 0.002])
def test_bounds_are_as_tight_as_asked(kind: Any, name: str, tightness: float) -> None:
    map, truth = measured(name, 0.05, 1)
    if kind == "lipschitz" and tightness < 0.01:
        return
    c = certify(map, kind, tightness=tightness)
    assert c.certified
    # Theorem 4.2: the extremes are attained on the boundary.
    assert truth.sigma2 * (1 - 1.01 * tightness) <= c.sigma2_lower <= truth.sigma2
    assert truth.sigma1 <= c.sigma1_upper <= truth.sigma1 * (1 + 1.01 * tightness)
    assert truth.k <= c.k_upper <= truth.k * (1 + 1.01 * tightness) + tightness * 1e-3


def test_panels_are_the_boundary_in_order() -> None:
    map = random_map("twin", 0.1, 1)
    c = certify(map, tightness=0.005)
    panels = c.panels
    assert c.panels_split == (panels.depth > 0).sum() > 0
    assert len(panels) == len(panels.start) == len(panels.k_upper) > 0
    for i, loop in enumerate(map.domain.cage.loops):
        of_loop = panels.loop == i
        start, end = panels.start[of_loop], panels.end[of_loop]
        np.testing.assert_array_equal(np.roll(start, -1, axis=0), end)
        assert {complex(*v) for v in loop.tolist()} <= set(start.tolist())
        edges = np.linalg.norm(np.roll(loop, -1, axis=0) - loop, axis=1)
        assert panels.length[of_loop].sum() == pytest.approx(edges.sum(), rel=1e-12)


def test_the_result_is_immutable() -> None:
    panels = certify(HarmonicMap.identity(domain("ring"))).panels
    for name in ("start", "end", "loop", "depth", "sigma2_lower", "sigma1_upper", "k_upper"):
        assert not getattr(panels, name).flags.writeable, name


def test_the_identity() -> None:
    for kind in KINDS:
        for name in CERTIFIED:
            c = certify(HarmonicMap.identity(domain(name)), kind)
            assert c.certified
            assert c.kind == kind
            assert c.sigma2_lower == pytest.approx(1, abs=1e-9)
            assert c.sigma1_upper == pytest.approx(1, abs=1e-9)
            assert c.k_upper == pytest.approx(0, abs=1e-9)
            assert c.windings == (0,) * (1 + domain(name).n_holes)
            assert c.panels_split == 0


def holomorphic(name: str, function: Any, antiholomorphic: Any = lambda z: 0 * z) -> HarmonicMap:
    """The map that interpolates functions at all offset vertices (their Cauchy transform)."""
    d = domain(name)
    vertices = np.concatenate(d.offset_cage.loops_complex)
    no_logarithms = np.zeros(d.n_holes)
    return HarmonicMap(
        d,
        np.concatenate([function(vertices), no_logarithms]),
        np.concatenate([antiholomorphic(vertices), no_logarithms]),
    )


@functools.cache
def annulus_check() -> DenseCheck:
    return dense_check("annulus", 10_000)


@pytest.mark.parametrize("kind", KINDS)
def test_a_knot_is_certified(kind: Any) -> None:
    """Figure 3: f_z turns once around on the exterior loop and back on the interior one."""
    map = holomorphic("annulus", lambda z: z**2 / 2, lambda z: 0.2 * z)
    truth = annulus_check().measure(map.phi, map.psi)
    assert truth.sigma2 > 0.1
    assert truth.windings == (1, -1)
    c = certify(map, kind)
    check_sound(c, truth)
    assert c.certified
    assert c.windings == (1, -1)
    assert c.winding == 0


@pytest.mark.parametrize("kind", KINDS)
def test_a_knot_the_other_way_is_certified(kind: Any) -> None:
    """f = -1 / z, f_z = 1 / z^2: it turns by -2 and +2, and is globally injective."""
    map = holomorphic("annulus", lambda z: -1 / z)
    truth = annulus_check().measure(map.phi, map.psi)
    c = certify(map, kind)
    check_sound(c, truth)
    assert c.certified
    assert c.windings == truth.windings == (-2, 2)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("zero", [-1.5 - 1j, 0.3 - 1.4j])
def test_a_zero_of_fz_inside_is_refused_by_the_winding(kind: Any, zero: complex) -> None:
    """f = (z - a)^2 / 2 on a domain around a: sigma_2 > 0 on the boundary, yet a branch point."""
    map = holomorphic("ell", lambda z: (z - zero) ** 2 / 2)
    truth = dense_check("ell").measure(map.phi, map.psi)
    assert truth.sigma2_boundary > 0.05
    assert truth.windings == (1,)
    c = certify(map, kind)
    assert not c.certified
    assert (c.panels.sigma2_lower > 0).all()
    assert c.windings == (1,)
    assert c.reason == "The map is not locally injective: f_z has 1 zero in the domain."


def test_two_zeros_are_counted() -> None:
    map = holomorphic("annulus", lambda z: z**4 / 4 - 2 * z**3)  # f_z = z^2 (z - 6)
    truth = annulus_check().measure(map.phi, map.psi)
    assert certify(map).windings == truth.windings == (2, -2)
    map = holomorphic("annulus", lambda z: z**3 / 3 - 4.41 * z)  # zeros at -2.1 and 2.1
    truth = annulus_check().measure(map.phi, map.psi)
    c = certify(map)
    assert c.windings == truth.windings == (2, 0)
    assert c.winding == 2
    assert not c.certified


@pytest.mark.parametrize("kind", KINDS)
def test_a_folded_map_is_reported_where_it_folds(kind: Any) -> None:
    """f = z + conj(z^2) / 6 folds where |z| > 3, only at the far corners of the L."""
    map = holomorphic("ell", lambda z: z, lambda z: z**2 / 6)
    truth = dense_check("ell").measure(map.phi, map.psi)
    assert truth.sigma2_boundary < -0.1
    c = certify(map, kind)
    assert not c.certified
    found = re.fullmatch(
        r"The map is not locally injective: sigma_2 = (\S+) near \((\S+), (\S+)\)\.", c.reason
    )
    assert found is not None, c.reason
    value, x, y = (float(group) for group in found.groups())
    place = np.array([x + 1j * y])
    assert abs(place[0]) > 3
    assert reference(map).sigma2(place)[0] == pytest.approx(value, abs=1e-3)
    assert value == pytest.approx(truth.sigma2_boundary, abs=0.2)
    assert c.sigma2_lower <= truth.sigma2_boundary


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("excess", [1e-3, -1e-3])
def test_a_dent_between_the_ends_of_panels_is_seen(kind: Any, excess: float) -> None:
    """The least sigma_2 is just below or above 0, at a point that ends no panel."""
    map = random_map("ell", 0.3, 3)
    check = dense_check("ell")
    f, g = (np.abs(check.d_boundary[0] @ v) for v in (map.phi, map.psi))
    worst = int(np.argmax(g / f))
    ends = graded_panels(map.domain).start
    assert np.abs(ends - check.boundary[0][worst]).min() > 0.02
    psi = map.psi * (1 + excess) * f[worst] / g[worst]
    yardstick = reference(HarmonicMap(map.domain, map.phi, psi))
    assert yardstick.sigma2(ends).min() > 0
    c = certify(HarmonicMap(map.domain, map.phi, psi), kind)
    check_sound(c, check.measure(map.phi, psi))
    assert c.certified == (excess < 0), c.reason


@pytest.mark.parametrize("kind", KINDS)
def test_without_refinement_the_given_panels_are_all_there_is(kind: Any) -> None:
    d = domain("ring")
    panels = uniform_panels(d.cage, 1000)
    map, truth = measured("ring", 0.02, 3)
    c = certify(map, kind, panels, split=False)
    assert len(c.panels) == len(panels) >= 1000
    np.testing.assert_array_equal(c.panels.start, panels.start)
    check_sound(c, truth)
    assert c.certified
    # A few long panels prove nothing, and the reason says so.
    map, truth = measured("ring", 0.4, 3)
    coarse = uniform_panels(d.cage, 10)
    c = certify(map, kind, coarse, split=False)
    assert len(c.panels) == len(coarse) < 25
    assert not c.certified
    assert re.search(r"Undecided: \d+ of \d+ panels could not be proved injective", c.reason)
    finer = certify(map, kind, coarse, split=True)
    check_sound(finer, truth)
    assert finer.certified
    # Even with loose bounds, panels are split until there is a proof.
    loose = certify(map, kind, coarse, tightness=5.0)
    check_sound(loose, truth)
    assert loose.certified
    assert len(loose.panels) < len(finer.panels)


def test_lipschitz_needs_more_panels_than_hermite() -> None:
    map = random_map("ring", 0.4, 3)
    assert len(certify(map, "lipschitz").panels) > 1.5 * len(certify(map, "hermite").panels)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            {"kind": "newton"},
            "unknown kind of certificate 'newton'; choose one of hermite, lipschitz, bdhm",
        ),
        ({"tightness": 0}, "tightness is 0; it must be positive"),
        ({"tightness": -1.0}, "tightness is -1.0"),
        ({"tightness": float("nan")}, "tightness is nan"),
    ],
)
def test_bad_arguments_are_refused(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        certify(HarmonicMap.identity(domain("ell")), **arguments)


def test_a_collapsed_map_is_not_certified() -> None:
    """A constant, a projection to a line, and a mirror image."""
    d = domain("ring")
    identity, zero = HarmonicMap.identity(d).phi, np.zeros(d.n_coefficients)
    for phi, psi in ((zero, zero), (identity / 2, identity / 2), (zero, identity)):
        c = certify(HarmonicMap(d, phi, psi))
        assert not c.certified
        assert c.sigma2_lower <= 0
        assert not np.isnan([c.sigma2_lower, c.sigma1_upper, c.k_upper]).any()


def test_a_nearly_collapsed_map_ends_quickly() -> None:
    """sigma_2 > 0 on all of the boundary, but below what double precision can prove."""
    d = domain("ring")
    identity = HarmonicMap.identity(d).phi
    c = certify(HarmonicMap(d, identity / 2, identity / 2 * (1 - 1e-15)))
    assert not c.certified
    assert len(c.panels) < 10_000


def test_a_long_thin_domain_with_small_features() -> None:
    """Panels of very different lengths: a thin arm with a notch, offset 0.002."""
    loop = [[0, 0], [10, 0], [10, 0.1], [5.05, 0.1], [5, 0.02], [4.95, 0.1], [0, 0.1], [0, 0]][:-1]
    d = Domain.from_cage(Cage(loop), 0.002)
    rng = np.random.default_rng(0)
    z = np.array(d.offset_cage.loops_complex[0])
    phi = z * np.exp(0.05j * z.real) + 1e-4 * (
        rng.normal(size=len(z)) + 1j * rng.normal(size=len(z))
    )
    check = DenseCheck.on(d.cage.loops_complex, [z], np.empty(0), 20_000)
    truth = check.measure(phi, 0.01 * z)
    check_sound(certify(HarmonicMap(d, phi, 0.01 * z)), truth)


def test_panels_must_tile_the_boundary_of_the_map() -> None:
    map = HarmonicMap.identity(domain("twin"))
    panels = graded_panels(map.domain)
    assert certify(map, panels=panels).certified
    n = len(panels)
    shifted = panels.start + np.where(np.arange(n) == 5, 1e-9, 0)
    corner = np.flatnonzero(panels.start == map.domain.cage.loops_complex[0][1])
    nudged = panels.start.copy()
    nudged[corner] = panels.middle[corner]
    wrong = {
        "of another cage": graded_panels(domain("ring")),
        "of the exterior alone": Panels.along(map.domain.cage.loops_complex[:1]),
        "in another order": Panels.along(map.domain.cage.loops_complex[::-1]),
        "inside": uniform_panels(Cage(0.9 * map.domain.cage.exterior, map.domain.cage.holes)),
        "backwards": replace(panels, start=panels.end, end=panels.start),
        "with a gap": replace(panels, end=np.roll(panels.end, 1)),
        "beside": replace(panels, start=shifted, end=shifted[panels.next]),
        "skipping a corner": replace(panels, start=nudged, end=nudged[panels.next]),
    }
    for name, one in wrong.items():
        print(name)  # the sentence names the place
        with pytest.raises(GeometryError, match="do not tile the boundary"):
            certify(map, panels=one)


def test_the_ends_of_panels_are_beside_the_cage_by_no_more_than_is_allowed() -> None:
    """In exact arithmetic, on edges of any slope, near the origin and far from it."""
    rng = np.random.default_rng(0)
    for shift in (0, 1e3, 1e6):
        corners = shift + np.exp(2j * np.pi * (np.arange(7) + rng.uniform(0, 0.5, 7)) / 7)
        panels = Panels.along([corners])
        for _ in range(40):
            chosen = np.isin(np.arange(len(panels)), rng.integers(0, len(panels), 6))
            panels, _ = panels.split(chosen)
        edge = np.cumsum(np.isin(panels.start, corners)) - 1
        worst = 0.0
        for p, a, b in zip(panels.start, corners[edge], np.roll(corners, -1)[edge], strict=True):
            px, py, ax, ay, bx, by = (Fraction(v) for z in (p, a, b) for v in (z.real, z.imag))
            cross = (px - ax) * (by - ay) - (py - ay) * (bx - ax)
            worst = max(worst, abs(float(cross)) / abs(b - a))
        assert worst <= rounding.BESIDE * np.abs(corners).max()


def test_a_certificate_belongs_to_one_map() -> None:
    map = random_map("ring", 0.05, 1)
    certificate = certify(map)
    again = HarmonicMap(map.domain, map.phi, map.psi)
    assert certificate.belongs_to(map)
    assert certificate.belongs_to(again)
    other = HarmonicMap(map.domain, map.phi * (1 + 1e-15), map.psi)
    assert not certificate.belongs_to(other)
    elsewhere = Domain(map.domain.cage, map.domain.offset_cage, [[0.0, 0.0]])
    assert not certificate.belongs_to(HarmonicMap(elsewhere, map.phi, map.psi))
    psi = map.psi.copy()
    psi[:8] += 3 * map.domain.offset_cage.loops_complex[0]
    folded = HarmonicMap(map.domain, map.phi, psi)
    with pytest.raises(CertificateError, match="belongs to another map"):
        global_injectivity(folded, certificate)
    assert global_injectivity(again, certificate).verdict == "yes"


def test_a_certificate_that_no_proof_made_proves_nothing() -> None:
    certificate = certify(random_map("ring", 0.05, 1))
    map = certificate.map
    folded = HarmonicMap(map.domain, map.psi.conj(), map.phi.conj())
    for changed in ({"map": folded}, {"sigma2_lower": 1.0}, {"windings": (1, -1)}, {}):
        forged = replace(certificate, **changed)
        assert not forged.certified
        assert "has no proof" in forged.reason
        assert global_injectivity(forged.map, forged).verdict == "undecided"
        with pytest.raises(InputError, match="no proof"):
            proof_text(forged)
    copied = pickle.loads(pickle.dumps(certificate))
    assert copied.certified
    assert copied.belongs_to(map)
    with pytest.raises(ValueError, match="WRITEABLE"):
        copied.panels.start.setflags(write=True)


def test_rounding_that_falls_with_a_panels_length_hides_nothing() -> None:
    """Beside an offset of 10^-10 the errors of slopes are large on panels of that length."""
    bar = Domain.from_cage(Cage([[-10, -1], [10, -1], [10, 1], [-10, 1]]), 1e-10)
    rng = np.random.default_rng(0)
    real, imaginary = rng.normal(size=(2, 2, bar.n_coefficients))
    phi, psi = 0.03468 * (real + 1j * imaginary)
    map = HarmonicMap(bar, HarmonicMap.identity(bar).phi + phi, psi)
    assert certify(map).certified


def test_what_was_proved_is_not_lost_to_finer_panels() -> None:
    map = random_map("ring", 0.05, 1)
    evaluate = functools.partial(run_on, map, functools.partial(known_on, kind="hermite"))
    panels = graded_panels(map.domain)
    known: Known = evaluate(panels.start, panels.end)
    assert known.proved

    def worse(start: Any, end: Any) -> Known:
        fresh: Known = evaluate(start, end)
        bounds = fresh.bounds._replace(sigma2_lower=-np.ones(len(start)))
        return fresh._replace(bounds=bounds)

    kept, still = split_panels(panels, known, worse, 1e-6)
    assert kept is panels
    assert still.proved


def test_what_rounding_hides_is_not_searched_for() -> None:
    """A huge logarithm makes f_z and f_zbar agree to the last digit, on all panels."""
    map = HarmonicMap.identity(domain("twin"))
    phi, psi = np.array(map.phi), np.array(map.psi)
    phi[-1] = psi[-1] = 1e60
    c = certify(HarmonicMap(map.domain, phi, psi))
    assert not c.certified
    assert len(c.panels) < 1000
