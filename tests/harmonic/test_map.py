"""Harmonic maps as values: evaluation, derivatives, chunks."""

from __future__ import annotations

import copy
import dataclasses
import pickle
import re
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb._arrays import frozen
from glid_nb.certificate import certificate_of
from glid_nb.geometry import graded_panels
from glid_nb.harmonic import HarmonicMap, MapError, as_complex

from ..support.domains import NAMES, domain, random_map, real, reference
from ..support.reference_map import points_inside


@pytest.mark.slow
@pytest.mark.parametrize("name", [*NAMES, "annulus"])
def test_the_identity_is_the_identity(name: str) -> None:
    d = domain(name)
    map = HarmonicMap.identity(d)
    points = np.concatenate([real(points_inside(d.cage.loops_complex, 40)), *d.cage.loops])[:64]
    np.testing.assert_allclose(map(points), points, atol=1e-12)
    fz, fzbar = map.wirtinger(points)
    np.testing.assert_allclose(fz, 1, atol=1e-12)
    np.testing.assert_allclose(fzbar, 0, atol=1e-12)
    np.testing.assert_allclose(map.sigma1(points), 1, atol=1e-12)
    np.testing.assert_allclose(map.sigma2(points), 1, atol=1e-12)
    np.testing.assert_allclose(map.det(points), 1, atol=1e-12)
    np.testing.assert_allclose(map.k(points), 0, atol=1e-12)
    assert map.distance(map) == 0


@given(name=st.sampled_from(NAMES), size=st.floats(0.01, 2), seed=st.integers(0, 10**6))
@settings(max_examples=20)
def test_a_map_is_that_of_the_paper(name: str, size: float, seed: int) -> None:
    map = random_map(name, size, seed)
    yardstick = reference(map)
    z = points_inside(map.domain.cage.loops_complex, 50, seed)
    f, (fz, fzbar) = map(real(z)) @ [1, 1j], map.wirtinger(real(z))
    np.testing.assert_allclose(f, yardstick.f(z), rtol=1e-11, atol=1e-11)
    np.testing.assert_allclose(fz, yardstick.fz(z), rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose(fzbar, yardstick.fzbar(z), rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose(map.sigma1(z), yardstick.sigma1(z), rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose(map.sigma2(z), yardstick.sigma2(z), rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose(map.k(z), yardstick.k(z), rtol=1e-8)
    np.testing.assert_allclose(map.det(z), map.sigma1(z) * map.sigma2(z), rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("name", ["ell", "twin"])
def test_wirtinger_derivatives_are_those_of_the_map(name: str) -> None:
    """Fourth-order differences in x and y of the values, singular values of that Jacobian."""
    map = random_map(name, 0.3, 5)
    z = points_inside(map.domain.cage.loops_complex, 15, 2)
    h = 1e-3
    offsets = np.array([-2, -1, 1, 2])
    weights = np.array([1, -8, 8, -1]) / (12 * h)
    along = [
        (map(real((z[:, None] + direction * h * offsets).ravel())) @ [1, 1j]).reshape(-1, 4)
        @ weights
        for direction in (1, 1j)
    ]
    fx, fy = along
    fz, fzbar = map.wirtinger(z)
    np.testing.assert_allclose(fz, (fx - 1j * fy) / 2, rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(fzbar, (fx + 1j * fy) / 2, rtol=1e-6, atol=1e-6)
    jacobians = np.stack([np.stack([a.real, a.imag], axis=-1) for a in along], axis=-1)
    sigma = np.linalg.svd(jacobians, compute_uv=False)
    np.testing.assert_allclose(map.sigma1(z), sigma[:, 0], rtol=1e-6)
    np.testing.assert_allclose(np.abs(map.sigma2(z)), sigma[:, 1], rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(map.det(z), np.linalg.det(jacobians), rtol=1e-5, atol=1e-6)


def test_derivatives_of_the_wirtinger_derivatives() -> None:
    map = random_map("ring", 0.3, 6)
    z = points_inside(map.domain.cage.loops_complex, 20, 3)
    h = 1e-4
    ahead, behind = map.wirtinger(z + h), map.wirtinger(z - h)
    first = map.wirtinger_derivatives(z, 1)
    np.testing.assert_allclose(first[0], (ahead[0] - behind[0]) / (2 * h), atol=1e-4)
    np.testing.assert_allclose(first[1], ((ahead[1] - behind[1]) / (2 * h)).conj(), atol=1e-4)
    second = map.wirtinger_derivatives(z, 2)
    ahead, behind = map.wirtinger_derivatives(z + h, 1), map.wirtinger_derivatives(z - h, 1)
    for k in (0, 1):
        np.testing.assert_allclose(second[k], (ahead[k] - behind[k]) / (2 * h), atol=1e-3)
    with pytest.raises(ValueError, match="order is 0"):
        map.wirtinger_derivatives(z, 0)


@pytest.mark.slow
@pytest.mark.parametrize("count", [0, 1, 2, 63, 64, 65, 100_000])
def test_chunks_do_not_show(count: int) -> None:
    map = random_map("ring", 0.2, 7)
    pool = points_inside(map.domain.cage.loops_complex, 97)
    z = np.resize(pool, count)
    expected = np.resize(reference(map).f(pool), count)
    image = map(real(z))
    assert image.shape == (count, 2)
    assert image.dtype == np.float64
    np.testing.assert_allclose(image @ [1, 1j], expected, rtol=0, atol=1e-12)
    fz, fzbar = map.wirtinger(real(z))
    assert fz.shape == fzbar.shape == (count,)
    np.testing.assert_allclose(fzbar, np.resize(reference(map).fzbar(pool), count), atol=1e-12)


@pytest.mark.slow
def test_memory_is_bounded() -> None:
    """A million points: if evaluated at once, D, its logarithms and so on take 300 MB each."""
    source = """
import resource, numpy as np
from glid_nb.geometry import Cage, Domain
from glid_nb.harmonic import HarmonicMap
angle = 2 * np.pi * np.arange(18) / 18
loop = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
map = HarmonicMap.identity(Domain.from_cage(Cage(loop)))
map(np.zeros((100_000, 2)))
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
points = np.random.default_rng(0).uniform(-0.6, 0.6, (1_000_000, 2))
print(abs(map(points) - points).max() < 1e-12)
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
"""
    done = subprocess.run(
        [sys.executable, "-c", source], capture_output=True, text=True, check=True, timeout=250
    )
    exact, kilobytes = done.stdout.split()
    assert exact == "True"
    assert int(kilobytes) < 250_000


def test_points_may_be_pairs_or_complex() -> None:
    map = random_map("ell", 0.1, 1)
    pairs = [[0.5, -1], [-1, 2], [-2, -2]]
    z = np.array([0.5 - 1j, -1 + 2j, -2 - 2j])
    np.testing.assert_array_equal(map(pairs), map(z))
    np.testing.assert_array_equal(as_complex(pairs), z)
    np.testing.assert_array_equal(map(np.array([[0, 1]])), map(np.array([[0.0, 1.0]])))


@pytest.mark.parametrize("points", [[1.0, 2.0], [[1.0, 2.0, 3.0]], 3.0, [[[1.0, 2.0]]]])
def test_other_shapes_of_points_are_refused(points: Any) -> None:
    map = HarmonicMap.identity(domain("ell"))
    with pytest.raises(ValueError, match=re.escape(f"shape is {np.shape(points)}")):
        map(points)


def test_a_map_is_immutable() -> None:
    phi = HarmonicMap.identity(domain("ring")).phi.copy()
    psi = np.zeros_like(phi)
    map = HarmonicMap(domain("ring"), phi, psi)
    phi[0] = 99
    assert map.phi[0] != 99
    for array in (map.phi, map.psi):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1
    with pytest.raises(dataclasses.FrozenInstanceError):
        map.phi = phi  # type: ignore[misc]


@pytest.mark.slow
def test_distance_is_the_largest_one_on_the_boundary() -> None:
    map = random_map("ring", 0.2, 8)
    moved = HarmonicMap(map.domain, map.phi.copy(), map.psi)
    shifted = moved.phi.copy()
    shifted[: len(map.domain.offset_cage.loops_complex[0])] += 3 - 4j
    assert map.distance(HarmonicMap(map.domain, shifted, map.psi)) == pytest.approx(5)
    d = domain("ring")
    grown = HarmonicMap(d, 1.5 * HarmonicMap.identity(d).phi, np.zeros(d.n_coefficients))
    assert HarmonicMap.identity(d).distance(grown) == pytest.approx(1.5, rel=1e-3)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda phi, psi: (phi[:-1], psi), r"phi has shape \(16,\).* 17 coefficients"),
        (lambda phi, psi: (phi, psi[None]), r"psi has shape \(1, 17\)"),
        (lambda phi, psi: (np.where(np.arange(17) == 3, np.nan, phi), psi), r"phi\[3\] is \(nan"),
        (lambda phi, psi: (phi, np.where(np.arange(17) == 5, np.inf, psi)), r"psi\[5\] is"),
        (lambda phi, psi: (phi + (np.arange(17) == 16), psi), "hole 1 are not conjugate"),
        (lambda phi, psi: (phi + 1j * (np.arange(17) == 16), psi + 1j * (np.arange(17) == 16)),
         "hole 1 are not conjugate"),
    ],
)  # fmt: skip
def test_bad_coefficients_are_refused(change: object, message: str) -> None:
    map = HarmonicMap.identity(domain("ring"))
    with pytest.raises(MapError, match=message):
        HarmonicMap(map.domain, *change(map.phi, map.psi))  # type: ignore[operator]


def test_the_hole_that_is_not_conjugate_is_named() -> None:
    map = HarmonicMap.identity(domain("triple"))
    phi = map.phi.copy()
    phi[-2] = 0.5
    with pytest.raises(MapError, match="hole 2 are not conjugate"):
        HarmonicMap(map.domain, phi, map.psi)


def test_a_point_that_is_not_finite_is_refused() -> None:
    identity = HarmonicMap.identity(domain("ell"))
    with pytest.raises(MapError, match="point 1 is"):
        identity([[0.0, 0.0], [np.nan, 1.0]])


@pytest.mark.parametrize("name", ["ell", "ring"])
def test_no_point_however_far_gives_nan(name: str) -> None:
    map = random_map(name, 0.05, 1)
    far = np.array([[1e50, -1.0], [7e99, 7e99]])
    values = (map(far), map.sigma1(far), map.sigma2(far), *map.wirtinger(far))
    assert all(np.isfinite(value).all() for value in values)
    for x, y in ([1e101, 0.0], [1e308, 1e308], [1.7e308, 1.7e308]):
        with pytest.raises(MapError, match=r"point 1 is .*; the largest distance is 1e\+100"):
            map.sigma1([[0.0, 0.0], [x, y]])


def test_logarithms_that_are_not_exactly_tied_are_tied_without_changing_the_map() -> None:
    """Otherwise the proof would belong to other coefficients than the map's values."""
    exact = random_map("twin", 0.1, 1)
    psi = exact.psi.copy()
    psi[-2] += 4e-10 + 2e-10j
    loose = HarmonicMap(exact.domain, exact.phi, psi)
    np.testing.assert_array_equal(loose.phi[-2:], loose.psi[-2:].conj())
    total = exact.phi[-2] + psi[-2].conj()
    np.testing.assert_allclose(loose.phi[-2] + loose.psi[-2].conj(), total, rtol=1e-15)
    for kept, before in ((loose.phi[:-2], exact.phi[:-2]), (loose.psi[-1:], exact.psi[-1:])):
        assert kept.tobytes() == before.tobytes()
    again = HarmonicMap(loose.domain, loose.phi, loose.psi)
    assert (again.phi.tobytes(), again.psi.tobytes()) == (loose.phi.tobytes(), loose.psi.tobytes())


@pytest.mark.parametrize(
    "copied", [copy.copy, copy.deepcopy, lambda map: pickle.loads(pickle.dumps(map))]
)
def test_a_copy_cannot_be_written_to_and_keeps_no_proof(
    copied: Callable[[HarmonicMap], HarmonicMap],
) -> None:
    map = random_map("ring", 0.05, 1)
    assert certificate_of(map).certified
    other = copied(map)
    assert other.kept == {}
    assert certificate_of(map).belongs_to(other)
    for one in (map, other):
        domain, panels = one.domain, graded_panels(one.domain)
        cages = domain.cage.loops + domain.offset_cage.loops + domain.offset_cage.loops_complex
        arrays = one.phi, one.psi, *cages, domain.hole_points, domain.hole_points_complex
        for array in (*arrays, panels.start, copied(panels).start):  # type: ignore[arg-type]
            with pytest.raises(ValueError, match="read-only"):
                array[0] = 0
            with pytest.raises(ValueError, match="WRITEABLE"):
                array.setflags(write=True)
    assert other.phi.tobytes() == map.phi.tobytes()
    assert copied(map.domain).equals(map.domain)  # type: ignore[arg-type]


def test_a_translation_changes_no_derivative() -> None:
    map = random_map("ring", 0.1, 1)
    points = graded_panels(map.domain).start
    phi = map.phi.copy()
    phi[:8] += 2.0**20
    far = HarmonicMap(map.domain, phi, map.psi)
    phi[:8] -= 2.0**20  # the same differences
    near = HarmonicMap(map.domain, phi, map.psi)
    for a, b in zip(far.wirtinger(points), near.wirtinger(points), strict=True):
        np.testing.assert_allclose(a, b, rtol=0, atol=1e-14)


def test_coefficients_that_squares_would_overflow_are_refused() -> None:
    d = domain("ring")
    phi = HarmonicMap.identity(d).phi.copy()
    for value in (1e121, complex(0, -1e300), complex(1e308, 1e308), np.inf, np.nan):
        phi[3] = value
        with pytest.raises(MapError, match=r"phi\[3\] is .*; it must be finite and at most"):
            HarmonicMap(d, phi, np.zeros_like(phi))


def test_frozen_arrays_are_shared_and_others_copied() -> None:
    start = graded_panels(random_map("ring", 0.05, 1).domain).start
    assert frozen(start) is start
    for other in (start[1:], pickle.loads(pickle.dumps(start)), start.copy()):
        kept = frozen(other)
        assert kept is not other
        assert kept.tobytes() == other.tobytes()
        with pytest.raises(ValueError, match="WRITEABLE"):
            kept.setflags(write=True)
