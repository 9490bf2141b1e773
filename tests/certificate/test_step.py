"""A proved step passes only locally injective maps, compared with a dense evaluation."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb.certificate import certify, certify_step
from glid_nb.certificate.certify import CertificateError
from glid_nb.certificate.pieces import certify_pieces
from glid_nb.harmonic import HarmonicMap

from ..support.domains import NAMES, dense_check, domain, random_map

TIMES = np.linspace(0, 1, 21)


@pytest.mark.slow
@given(
    st.sampled_from(NAMES),
    st.sampled_from([0.003, 0.01, 0.03]),
    st.floats(-3.1, 3.1),
    st.integers(0, 10**6),
)
@settings(max_examples=10)
def test_on_a_proved_step_sigma_2_is_positive_at_every_point_and_time(
    name: str, size: float, angle: float, seed: int
) -> None:
    first, other = random_map(name, size, seed), random_map(name, size, seed + 1)
    turn = np.exp(1j * angle)
    last = HarmonicMap(first.domain, turn * other.phi, other.psi / turn)
    step = certify_step(first, last)
    dense = dense_check(name, 4000)
    for t in TIMES[step.until > TIMES]:
        between = [(1 - t) * getattr(first, k) + t * getattr(last, k) for k in ("phi", "psi")]
        assert dense.measure(*between).sigma2 > 0
    if step.certified:
        assert step.until == 1
        assert certify(last).certified
    if not certify(first).certified:
        assert step.until == 0


def test_a_step_that_folds_on_its_way_between_good_maps_is_not_proved() -> None:
    first = random_map("ring", 0.01, 2)
    last = HarmonicMap(first.domain, -first.phi, -first.psi)
    assert certify(first).certified
    assert certify(last).certified
    step = certify_step(first, last)
    assert not step.certified
    assert 0.45 < step.until <= 0.5


def test_a_step_to_itself_is_proved_as_the_map_is() -> None:
    map = random_map("twin", 0.01, 3)
    step = certify_step(map, map)
    assert step.certified
    assert step.sigma2_lower == pytest.approx(certify(map).sigma2_lower, rel=0.05)


def test_a_step_on_which_f_z_vanishes_inside_is_not_proved() -> None:
    """Around z -> z^2 the maps stay conformal on the boundary, but f_z vanishes at a point
    inside."""
    ell = domain("ell")
    z = ell.offset_cage.loops_complex[0] + 0.5 + 0.5j
    first, last = (HarmonicMap(ell, size * z**2, 0 * z) for size in (1, 1.1))
    (boundary,) = certify_pieces([first, last])
    assert boundary.certified
    step = certify_step(first, last)
    assert not step.certified
    assert step.until == 0


def test_maps_of_different_domains_are_refused() -> None:
    with pytest.raises(CertificateError, match="different domains"):
        certify_step(random_map("ell", 0.01, 1), random_map("ring", 0.01, 1))
