"""Global injectivity: proofs, overlaps, and undecided cases."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb.certificate import GlobalInjectivity, certify, global_injectivity
from glid_nb.geometry import Cage, Domain, places
from glid_nb.harmonic import HarmonicMap

pytestmark = pytest.mark.slow  # most of the time is compiling

Array = np.ndarray


def _strip(length: float, half_width: float, pieces: int) -> Cage:
    x = np.linspace(-length / 2, length / 2, pieces + 1)
    below = np.stack([x, np.full_like(x, -half_width)], axis=1)
    return Cage(np.concatenate([below, below[::-1] * [1, -1]]))


def _ring(n: int, radius: float) -> Array:
    angle = 2 * np.pi * np.arange(n) / n
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


# These sizes need few compiled programs.
LENGTH = 8.0
BAR = Domain.from_cage(_strip(LENGTH, 0.4, 22), offset=0.1)
ANNULUS = Domain.from_cage(Cage(_ring(30, 3.0), [_ring(16, 1.0)]), offset=0.1)


def _holomorphic(
    domain: Domain, h: Callable[[Array], Array], antiholomorphic: complex = 0
) -> HarmonicMap:
    """``h(z) + conj(antiholomorphic * z)``, as nearly as the offset cage's vertices allow."""
    z = np.concatenate(domain.offset_cage.loops_complex)
    holes = np.zeros(domain.n_holes)
    return HarmonicMap(domain, np.append(h(z), holes), np.append(antiholomorphic * z, holes))


def _spiral(growth: float, turns: float = 1.2) -> HarmonicMap:
    """The bar wound around the origin; ``growth`` is the logarithm of the radius per radian."""
    a = turns * 2 * np.pi / LENGTH
    return _holomorphic(BAR, lambda z: np.exp((1j + growth) * a * z) / a)


def _image_loops(map: HarmonicMap, n: int) -> list[Array]:
    """The images of about ``n`` points in all, evenly spread along the loops; corners included."""
    loops = []
    for loop in map.domain.cage.loops:
        following = np.roll(loop, -1, axis=0)
        lengths = np.linalg.norm(following - loop, axis=1)
        counts = np.ceil(n * lengths / map.domain.cage.perimeter).astype(int)
        edges = [
            start + (end - start) * (np.arange(k) / k)[:, None]
            for start, end, k in zip(loop, following, counts, strict=True)
        ]
        loops.append(map(np.concatenate(edges)))
    return loops


def _is_simple(map: HarmonicMap, n: int = 20_000) -> bool:
    rings = [shapely.LinearRing(loop) for loop in _image_loops(map, n)]
    pairs = ((a, b) for i, a in enumerate(rings) for b in rings[:i])
    return all(ring.is_simple for ring in rings) and not any(a.intersects(b) for a, b in pairs)


def _polyline_crossings(points: Array) -> Array:
    """Where a closed polyline crosses itself, by comparing all pairs of its segments."""
    start = points @ [1, 1j]
    along = np.roll(start, -1) - start
    relative = start[None, :] - start[:, None]

    def cross(a: Array, b: Array) -> Array:
        return np.imag(a.conj() * b)

    determinant = cross(along[:, None], along[None, :])
    with np.errstate(divide="ignore", invalid="ignore"):
        s = cross(relative, along[None, :]) / determinant
        t = cross(relative, along[:, None]) / determinant
    i, j = np.nonzero((s > 0) & (s < 1) & (t > 0) & (t < 1))
    crossings = start[i] + s[i, j] * along[i]
    return np.stack([crossings.real, crossings.imag], axis=-1)


def _assert_double_point(
    map: HarmonicMap, outcome: GlobalInjectivity, rounding: float = 1e-12
) -> None:
    """Two different points of the boundary have the stated image."""
    assert outcome.crossing is not None
    assert outcome.parameters is not None
    np.testing.assert_allclose(
        map(outcome.parameters), [outcome.crossing] * 2, rtol=0, atol=rounding
    )
    rings = [shapely.LinearRing(loop) for loop in map.domain.cage.loops]
    for point in outcome.parameters:
        assert min(ring.distance(shapely.Point(point)) for ring in rings) < 1e-12
    assert np.linalg.norm(outcome.parameters[1] - outcome.parameters[0]) > 1e-3


def _square(x: float, y: float, side: float) -> list[list[float]]:
    return [[x, y], [x + side, y], [x + side, y + side], [x, y + side]]


@pytest.mark.parametrize("n_holes", [0, 1, 2, 3])
def test_the_identity_is_injective(n_holes: int) -> None:
    holes = [_square(2.5 * k - 3, -2.2, 1.0 + k / 4) for k in range(n_holes)]
    outline = _ring(46 - 4 * n_holes, 4.5)
    outline[0] = [2.0 - n_holes, 1.2]  # A deep and narrow notch.
    map = HarmonicMap.identity(Domain.from_cage(Cage(outline, holes)))
    outcome = global_injectivity(map)
    assert outcome.verdict == "yes"
    assert outcome.crossing is None
    assert outcome.parameters is None
    assert str(outcome.n_panels) in outcome.reason


def test_a_bar_wound_over_itself_is_locally_but_not_globally_injective() -> None:
    map = _spiral(-0.05)
    certificate = certify(map)
    assert certificate.certified
    outcome = global_injectivity(map, certificate)
    assert outcome.verdict == "no"
    _assert_double_point(map, outcome)
    crossings = _polyline_crossings(_image_loops(map, 1200)[0])
    assert len(crossings) >= 2
    assert np.linalg.norm(crossings - outcome.crossing, axis=1).min() < 1e-4


def test_the_last_moment_before_two_ends_meet_is_told_from_the_first_after() -> None:
    apart, over = -0.15, -0.1
    while over - apart > 1e-7:
        middle = (apart + over) / 2
        outcome = global_injectivity(_spiral(middle))
        if outcome.verdict == "yes":
            apart = middle
        else:
            assert outcome.verdict == "no", outcome.reason
            _assert_double_point(_spiral(middle), outcome)
            over = middle
    # A corner of the bar's end nearly meets the side of the bar's beginning.
    map = _spiral(apart)
    x = np.linspace(-2.7, -2.5, 20_001)
    side = shapely.LineString(map(np.stack([x, np.full_like(x, 0.4)], axis=1)))
    gap = side.distance(shapely.Point(map([[LENGTH / 2, -0.4]])[0]))
    assert 0 < gap < 1e-5


def test_a_degree_two_map_of_an_annulus_is_not_injective() -> None:
    map = _holomorphic(ANNULUS, lambda z: z**2 + 0.3 * z)
    certificate = certify(map)
    assert certificate.certified
    assert certificate.windings == (1, -1)
    outcome = global_injectivity(map, certificate)
    assert outcome.verdict == "no"
    _assert_double_point(map, outcome)


def test_a_loop_traced_twice_is_undecided() -> None:
    outcome = global_injectivity(_holomorphic(ANNULUS, lambda z: z**2), max_panels=2000)
    assert outcome.verdict == "undecided"
    assert outcome.n_panels <= 2000
    assert "touch" in outcome.reason


def test_two_places_are_told_apart() -> None:
    assert places([1.5, 2 - 1j]) == "(1.5, 0) and (2, -1)"
    assert places([1.23456789 + 0j, 1.23456788]) == "(1.23456789, 0) and (1.23456788, 0)"
    assert places([complex(1 / 3), np.nextafter(1 / 3, 1)]).count("0.3333333333333333") == 2
    assert places([1j, 1j]) == "(0, 1) and (0, 1)"


def test_an_annulus_turned_inside_out_is_injective() -> None:
    map = _holomorphic(ANNULUS, lambda z: 1 / z)
    certificate = certify(map)
    assert certificate.certified
    assert certificate.windings == (-2, 2)
    assert global_injectivity(map, certificate).verdict == "yes"
    assert _is_simple(map)


def test_a_map_that_is_not_certified_is_undecided() -> None:
    fold = _holomorphic(BAR, lambda z: z, antiholomorphic=1.5)
    outcome = global_injectivity(fold)
    assert outcome.verdict == "undecided"
    assert outcome.n_panels == 0
    assert "not locally injective" in outcome.reason


def test_too_few_panels_leave_it_undecided() -> None:
    map = _spiral(-0.12478)  # This is decided only if panels may be split.
    assert global_injectivity(map).verdict == "yes"
    outcome = global_injectivity(map, max_panels=1)
    assert outcome.verdict == "undecided"
    assert f"{outcome.n_panels} pieces" in outcome.reason
    with pytest.raises(ValueError, match="max_panels is 0"):
        global_injectivity(map, max_panels=0)


def _bent_bar(turns: tuple[float, ...], shear: complex, similarity: complex) -> HarmonicMap:
    """The bar with direction ``sum_k turns[k] (x / 4)^(k+1)`` at ``x``, sheared and placed."""
    nodes, weights = np.polynomial.legendre.leggauss(40)

    def bend(z: Array) -> Array:
        t = z[:, None] * (nodes + 1) / 2
        angle = sum(turn * (t / 4) ** k for k, turn in enumerate(turns, start=1))
        return similarity * (z / 2 * (np.exp(1j * angle) @ weights) + 100)

    return _holomorphic(BAR, bend, shear * similarity)


@settings(max_examples=20)
@given(
    st.tuples(st.floats(-4.5, 4.5), st.floats(-2, 2), st.floats(-2, 2)),
    st.complex_numbers(max_magnitude=0.3),
    st.complex_numbers(min_magnitude=0.01, max_magnitude=100),
)
def test_a_random_bend_is_judged_like_a_dense_polyline(
    turns: tuple[float, float, float], shear: complex, similarity: complex
) -> None:
    map = _bent_bar(turns, shear, similarity)
    certificate = certify(map)
    outcome = global_injectivity(map, certificate)
    if not certificate.certified:
        assert outcome.verdict == "undecided"
    elif outcome.verdict == "no":
        _assert_double_point(map, outcome, rounding=1e-12 * 100 * abs(similarity))
        assert not _is_simple(map)
    else:
        assert outcome.verdict == "yes", outcome.reason
        assert _is_simple(map)


@settings(max_examples=20)
@given(
    st.lists(st.floats(0.5, 1.5), min_size=46, max_size=46),
    st.complex_numbers(max_magnitude=0.9),
)
def test_an_affine_image_of_a_jagged_star_is_injective(
    radii: list[float], antiholomorphic: complex
) -> None:
    vertices = _ring(46, 1.0) * np.array(radii)[:, None]
    star = Domain(Cage(vertices), Cage(1.02 * vertices))  # of one size for any shape
    outcome = global_injectivity(_holomorphic(star, lambda z: z, antiholomorphic))
    assert outcome.verdict == "yes", outcome.reason
