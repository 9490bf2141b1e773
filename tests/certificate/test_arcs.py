"""The enclosures of the images of panels are true, also with rounding."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb._runtime import double_precision
from glid_nb.certificate.arcs import Arcs, Jets, jets_of
from glid_nb.geometry import Cage, Domain, Panels, graded_panels
from glid_nb.harmonic import HarmonicMap

OUTLINE = [[0, 0], [4, 0], [4, 3], [2.1, 3], [2, 0.6], [1.9, 3], [0, 3]]
HOLE = [[3, 1], [3, 2], [3.5, 2], [3.3, 1.2]]
DOMAIN = Domain.from_cage(Cage(OUTLINE, [HOLE]), offset=0.03)
RATIO = 2.0  # Panels twice as coarse as those in use make the curvature matter.


def _random_map(seed: int, roughness: float) -> HarmonicMap:
    """The identity plus noise on every coefficient."""
    rng = np.random.default_rng(seed)
    n = DOMAIN.n_coefficients
    phi, psi = roughness * (rng.normal(size=(2, n)) + 1j * rng.normal(size=(2, n)))
    psi[-1] = phi[-1].conj()
    identity = HarmonicMap.identity(DOMAIN)
    return HarmonicMap(DOMAIN, identity.phi + phi, psi)


def _anchor(map: HarmonicMap) -> complex:
    """The size that errors of images are relative to."""
    return complex(map.phi[0] + map.psi[0].conj())


@double_precision
def _jets(map: HarmonicMap) -> tuple[Panels, Jets]:
    panels = graded_panels(DOMAIN, RATIO)
    return panels, jets_of(map, panels.start, panels.end)


def _arcs(map: HarmonicMap) -> Arcs:
    panels, jets = _jets(map)
    return Arcs.between(panels.start, panels.end, jets, jets.at(panels.next))


@pytest.mark.slow
@settings(max_examples=20)
@given(st.integers(0, 2**32), st.sampled_from([0.0, 0.01, 0.3]))
def test_an_arc_stays_close_to_its_chord_and_its_tangents(seed: int, roughness: float) -> None:
    map = _random_map(seed, roughness)
    panels, arcs = graded_panels(DOMAIN, RATIO), _arcs(map)
    step = np.linspace(0, 1, 33)
    z = panels.start[:, None] + step * (panels.end - panels.start)[:, None]
    image = map(np.stack([z.real, z.imag], -1).reshape(-1, 2)) @ [1, 1j]
    image = image.reshape(z.shape) - _anchor(map)
    chord = arcs.start[:, None] + step * (arcs.end - arcs.start)[:, None]
    assert (np.abs(image - chord) <= arcs.radius[:, None]).all()
    along = step * panels.length[:, None]
    tangent = arcs.start[:, None] + along * arcs.tangent_start[:, None]
    assert (np.abs(image - tangent) <= arcs.bend[:, None] * along**2 / 2 + 1e-8).all()
    if roughness:  # The bound must not be far too large.
        used = np.abs(image - chord).max(axis=1) / arcs.sagitta
        assert 0.2 < used.max() <= 1


def test_rounding_stays_within_its_bound() -> None:
    # Where long double is double, this compares two computations in double.
    extended = np.clongdouble
    map = _random_map(1, 0.3)
    panels, jets = _jets(map)
    z = panels.start.astype(extended)[:, None]
    f = np.zeros(len(z), dtype=extended)
    fz = np.zeros(len(z), dtype=extended)
    offset = 0
    for loop in DOMAIN.offset_cage.loops_complex:
        vertices = loop.astype(extended)
        phi, psi = (c[offset : offset + len(loop)].astype(extended) for c in (map.phi, map.psi))
        offset += len(loop)
        b = vertices - z
        log = np.log(np.roll(b, -1, axis=1) / b) / (np.roll(vertices, -1) - vertices)
        previous = np.roll(log, 1, axis=1)
        two_pi_i = 2j * np.arctan2(np.longdouble(0), np.longdouble(-1))
        c = (np.roll(b, -1, axis=1) * log - np.roll(b, 1, axis=1) * previous) / two_pi_i
        f += c @ phi + np.conj(c @ psi)
        fz += ((previous - log) / two_pi_i) @ phi
    to_hole = z[:, 0] - extended(DOMAIN.hole_points_complex[0])
    f += np.log(np.abs(to_hole)) * (map.phi[-1] + np.conj(map.psi[-1]))
    fz += extended(map.phi[-1]) / to_hole
    assert (np.abs(jets.f - (f - _anchor(map))) < jets.f_error).all()
    assert (np.abs(jets.fz - fz) < jets.first_error).all()
    assert jets.f_error.max() < 1e-7


@pytest.mark.slow
def test_jets_are_those_of_the_map() -> None:
    map = _random_map(2, 0.1)
    panels, jets = _jets(map)
    points = np.stack([np.real(panels.start), np.imag(panels.start)], -1)
    fz, fzb = map.wirtinger(points)
    dfz, dfzb = map.wirtinger_derivatives(points, 1)
    image = map(points) @ [1, 1j]
    np.testing.assert_allclose(jets.f + _anchor(map), image, atol=1e-11)
    np.testing.assert_allclose(jets.fz, fz, atol=1e-11)
    np.testing.assert_allclose(jets.fzb_conj, fzb.conj(), atol=1e-11)
    np.testing.assert_allclose(jets.dfz, dfz, atol=1e-10)
    np.testing.assert_allclose(jets.dfzb_conj, dfzb, atol=1e-10)
    # A straight line's second derivative, against a difference quotient of the map.
    direction = np.exp(0.7j)
    h = 1e-4
    shift = h * np.array([np.cos(0.7), np.sin(0.7)])
    left, middle, right = (map(points + k * shift) @ [1, 1j] for k in (-1, 0, 1))
    np.testing.assert_allclose(
        jets.first(direction), (right - left) / (2 * h), rtol=1e-4, atol=1e-4
    )
    np.testing.assert_allclose(
        jets.second(direction), (right - 2 * middle + left) / h**2, rtol=1e-3, atol=1e-3
    )
