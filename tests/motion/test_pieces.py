"""Proofs of linear pieces, compared with dense evaluation in space and time."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb.certificate import certify
from glid_nb.certificate.hermite import Hermite
from glid_nb.certificate.panels import EndValues
from glid_nb.certificate.pieces import PieceCertificate, certify_pieces
from glid_nb.harmonic import HarmonicMap

from ..support.domains import NAMES, dense_check, domain, random_map, turned
from ..support.reference_map import DenseCheck


def check(
    proof: PieceCertificate, first: HarmonicMap, last: HarmonicMap, dense: DenseCheck, times: int
) -> None:
    """The points of ``dense``, at many times, contradict nothing that is proved."""
    fz, fzb = (
        [np.concatenate(dense.derivative(getattr(map, name))) for map in (first, last)]
        for name in ("phi", "psi")
    )
    for t in np.linspace(0, 1, times):
        if t >= proof.until and not proof.certified:
            continue
        f, g = (np.abs((1 - t) * before + t * after) for before, after in (fz, fzb))
        assert (f - g).min() > 0
        assert not proof.certified or (f - g).min() >= proof.sigma2_lower - 1e-12
        assert not proof.certified or (f + g).max() <= proof.sigma1_upper + 1e-12
        assert not proof.certified or (g / f).max() <= proof.k_upper + 1e-12


poses = st.builds(
    lambda name, sizes, seeds, angle: (
        random_map(name, sizes[0], seeds[0]),
        turned(random_map(name, sizes[1], seeds[1]), angle, 3 + 1j),
        name,
    ),
    st.sampled_from(NAMES),
    st.tuples(*[st.sampled_from([0.003, 0.01, 0.03, 0.06])] * 2),
    st.tuples(*[st.integers(0, 10**6)] * 2),
    st.floats(-3.1, 3.1),
)


@given(poses)
@settings(max_examples=12)
def test_what_is_proved_of_a_piece_is_true_at_every_time(
    pose: tuple[HarmonicMap, HarmonicMap, str],
) -> None:
    first, last, name = pose
    (proof,) = certify_pieces([first, last])
    check(proof, first, last, dense_check(name, 4000), 12)
    ends = [certify(map) for map in (first, last)]
    if proof.certified:
        assert all(end.certified for end in ends)
        assert proof.sigma2_lower <= min(end.panels.sigma2_lower.min() for end in ends) * 1.03
    if not ends[0].certified:
        assert proof.until == 0


@pytest.mark.slow
def test_forty_million_points_and_times_contradict_nothing() -> None:
    first, last = random_map("ring", 0.02, 4), turned(random_map("ring", 0.03, 5), 2.5)
    (proof,) = certify_pieces([first, last])
    assert proof.certified
    check(proof, first, last, dense_check("ring"), 200)


@pytest.mark.parametrize("name", ["ell", "ring"])
def test_a_fold_between_the_frames_is_found(name: str) -> None:
    first = random_map(name, 0.01, 2)
    last = turned(first, np.pi)  # halfway the shape is a point
    (proof,) = certify_pieces([first, last])
    assert not proof.certified
    assert 0.45 < proof.until <= 0.5
    check(proof, first, last, dense_check(name, 4000), 60)
    frames = (
        HarmonicMap(
            first.domain,
            *((1 - t) * a + t * b for a, b in ((first.phi, last.phi), (first.psi, last.psi))),
        )
        for t in (0, 1 / 3, 2 / 3, 1)
    )
    assert all(certify(frame).certified for frame in frames)


def test_it_is_proved_until_the_first_fold() -> None:
    d, name = domain("ell"), "ell"
    first = HarmonicMap.identity(d)
    last = HarmonicMap(d, first.phi, 1.25 * first.phi)  # conj(f_zbar) = 1.25 t: it folds at 0.8
    assert not certify(last).certified
    (proof,) = certify_pieces([first, last])
    assert 0.79 < proof.until <= 0.8
    check(proof, first, last, dense_check(name, 4000), 60)


def test_a_rotation_by_almost_half_a_turn_needs_halves_of_time() -> None:
    first = random_map("twin", 0.001, 1)
    (proof,) = certify_pieces([first, turned(first, 3.0)])
    assert proof.certified
    assert np.cos(1.5) * 0.9 < proof.sigma2_lower < np.cos(1.5)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "size", "seed"), [("ell", 1.4675, 3), ("ring", 0.2625, 2)])
def test_where_f_z_turns_within_a_panel_it_is_halved(name: str, size: float, seed: int) -> None:
    """Almost folded, so no direction works for the whole panel, even for a short time."""
    map = random_map(name, size, seed)
    (still,), (swung,) = (certify_pieces([map, turned(map, angle)]) for angle in (0, 2.0))
    assert still.certified
    assert swung.certified
    assert 0.95 * certify(map).sigma2_lower < still.sigma2_lower < 0.003


@given(st.integers(0, 10**6), st.floats(0, 1.5))
@settings(max_examples=25)
def test_along_one_direction_bounds_hold_at_every_time(seed: int, spread: float) -> None:
    """``Re(conj(u) f_z) - |f_zbar|`` of cubics and their means, anywhere within the remainder."""
    rng = np.random.default_rng(seed)

    def cubic(middle: complex, size: float) -> EndValues:
        values = middle + size * (rng.normal(size=(4, 1)) + 1j * rng.normal(size=(4, 1)))
        return EndValues(values[0], values[1], values[2] - middle, values[3] - middle)

    u, e = np.array([np.exp(2j * rng.random())]), np.array([[0.01], [0.02]])
    fz = [cubic(u[0] * np.exp(1j * turn), 0.1) for turn in (-spread / 2, spread / 2)]
    fzb = [cubic(0.2 * np.exp(1j * turn), 0.1) for turn in (0, spread)]
    with np.errstate(invalid="ignore"):
        bounds = [Hermite.bounds(f, g, e, u) for f, g in zip(fz, fzb, strict=True)]
    s = np.linspace(0, 1, 41)
    r = 1 - s
    basis = np.array([(1 + 2 * s) * r**2, s**2 * (3 - 2 * s), s * r**2, -(s**2) * r])
    for t in np.linspace(0, 1, 9):
        f, g = (
            ((1 - t) * np.concatenate(ends[0]) + t * np.concatenate(ends[1])) @ basis
            for ends in (fz, fzb)
        )
        f, g = np.abs(f) - 0.01, np.abs(g) + 0.02
        if all(bound.turning_known[0] for bound in bounds):
            assert min(bound.sigma2_lower[0] for bound in bounds) <= (f - g).min() + 1e-12
            assert max(bound.k_upper[0] for bound in bounds) >= (g / f).max() - 1e-12
        assert max(bound.sigma1_upper[0] for bound in bounds) >= (f + g).max() - 1e-12


def test_maps_between_are_as_good_as_the_exact_ones() -> None:
    """A motion far from the origin, where the coefficients' rounding is largest."""
    first, last = (turned(random_map("ring", 0.02, i), i, 1e5) for i in (1, 2))
    (proof,) = certify_pieces([first, last])
    near = [turned(map, 0, -1e5 + 1) for map in (first, last)]
    assert proof.certified
    assert 0.97 < proof.sigma2_lower / certify_pieces(near)[0].sigma2_lower <= 1
    dense = dense_check("ring", 4000)
    for t in np.linspace(0, 1, 23):
        pairs = ((first.phi, last.phi), (first.psi, last.psi))
        between = [a + t * (b - a) for a, b in pairs]
        found = dense.measure(*between)
        assert found.sigma2 >= proof.sigma2_lower
        assert found.k <= proof.k_upper
