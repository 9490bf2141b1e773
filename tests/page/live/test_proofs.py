"""Attacks on the page's proof: folds, hidden zeros, scales, translations, holes.

The yardsticks are f_z summed in Arb, and the package's own certificate.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import flint
import numpy as np
import pytest
from flint import acb

from glid_nb.certificate import certify
from glid_nb.geometry import Cage, Domain, GeometryError
from glid_nb.harmonic import HarmonicMap

from ...certificate.test_extremes import derivatives, exact
from ...support.domains import NAMES, circle, domain
from .in_node import points_along, proved

pytestmark = pytest.mark.slow

_ELL = np.array([[-3.0, -3], [3, -3], [3, 0], [0, 0], [0, 3], [-3, 3]])


def changed(d: Domain, phi: Any, psi: Any) -> HarmonicMap:
    """A map with the logarithms' coefficients tied."""
    n, holes = d.n_coefficients, d.n_holes
    psi = psi.copy()
    psi[n - holes :] = phi[n - holes :].conj()
    return HarmonicMap(d, phi, psi)


def vertices_of(d: Domain) -> Any:
    return np.concatenate(d.offset_cage.loops_complex)


def noisy(rng: np.random.Generator) -> HarmonicMap:
    """The identity with random coefficients added to all of its own."""
    d = domain(rng.choice(NAMES))
    n = d.n_coefficients
    change = rng.normal(size=(2, n)) + 1j * rng.normal(size=(2, n))
    size = 10.0 ** rng.uniform(-4, 0.3, (2, 1))
    phi, psi = HarmonicMap.identity(d).phi + size[0] * change[0], size[1] * change[1]
    return changed(d, phi, psi)


def with_hidden_zero(rng: np.random.Generator) -> HarmonicMap:
    """``f_z`` is about ``z - c``, with c anywhere, or next to the boundary on either side."""
    d = domain(rng.choice(NAMES))
    z, n = vertices_of(d), d.n_coefficients
    loop = rng.choice(len(d.cage.loops_complex))
    corners = d.cage.loops_complex[loop]
    i, t = rng.integers(len(corners)), rng.uniform()
    along = corners[(i + 1) % len(corners)] - corners[i]
    distance = rng.choice([-1, 1]) * 10.0 ** rng.uniform(-9, 0.5)
    c = corners[i] + t * along + 1j * along / abs(along) * distance
    phi, psi = np.zeros((2, n), dtype=complex)
    phi[: len(z)] = (z - c) ** 2 / 2
    psi[: len(z)] = rng.uniform(0, 0.5) * (z - c) ** 2 / 2
    return changed(d, phi, psi)


def nearly_folded(rng: np.random.Generator) -> HarmonicMap:
    """``|f_zbar|`` is ``1 - e`` of ``|f_z|`` everywhere, with e of either sign."""
    d = domain(rng.choice(NAMES))
    z, n = vertices_of(d), d.n_coefficients
    bent = z + 0.02 * rng.normal() * z**2
    phi, psi = np.zeros((2, n), dtype=complex)
    phi[: len(z)] = bent
    psi[: len(z)] = bent * (1 - rng.choice([-1, 1]) * 10.0 ** rng.uniform(-16, -1))
    return changed(d, phi, psi)


def with_spike(rng: np.random.Generator) -> HarmonicMap:
    """The identity with one coefficient changed."""
    d = domain(rng.choice(NAMES))
    n = d.n_coefficients
    phi, psi = HarmonicMap.identity(d).phi.copy(), np.zeros(n, dtype=complex)
    size = 10.0 ** rng.uniform(-2, 1.5) * np.exp(1j * rng.uniform(0, 7))
    (phi if rng.uniform() < 0.5 else psi)[rng.integers(n)] += size
    return changed(d, phi, psi)


def of_any_size(rng: np.random.Generator) -> HarmonicMap | None:
    """A map of a small or large shape far away, with the offset cage next to the cage."""
    scale, turn = 10.0 ** rng.integers(-8, 9), np.exp(1j * rng.uniform(0, 7))
    shift = rng.choice([0, 0, 1, 1e3, 1e6, -1e6])
    turned = (_ELL @ [1, 1j]) * turn * scale + shift
    corners = np.stack([turned.real, turned.imag], axis=1)
    holes = []
    if rng.uniform() < 0.5:
        holes = [circle(4, 0.7 * scale, -1.5 * (1 + 1j) * turn * scale + shift)]
    offset = rng.choice([0, 0.1, 1e-3, 1e-6, 1e-9])
    try:
        d = Domain.from_cage(Cage(corners, holes), offset * scale or None)
    except GeometryError:
        return None  # rounding of the coordinates leaves no such shape
    n = d.n_coefficients
    noise = (rng.normal(size=(2, n)) + 1j * rng.normal(size=(2, n))) * scale
    noise *= 10.0 ** rng.uniform(-4, 0.3)
    return changed(d, HarmonicMap.identity(d).phi + noise[0], noise[1])


def scaled(map: HarmonicMap, rng: np.random.Generator) -> HarmonicMap:
    """The map, its image enlarged and moved."""
    factor = 10.0 ** rng.uniform(-8, 8)
    phi, psi = factor * map.phi, factor * map.psi
    phi[: len(map.domain.offset_cage.loops_complex[0])] += 10.0 ** rng.uniform(-8, 8)
    return changed(map.domain, phi, psi)


MAKERS = (noisy, with_hidden_zero, nearly_folded, with_spike, of_any_size)


def attacks(count: int, seed: int) -> Iterator[HarmonicMap]:
    """``count`` maps of every kind; every other one scaled and moved."""
    rng = np.random.default_rng(seed)
    for maker in MAKERS:
        for i in range(count):
            map = maker(rng)
            if map is not None:
                yield scaled(map, rng) if i % 2 else map


def refuted(map: HarmonicMap, proof: dict[str, Any], rng: np.random.Generator) -> str | None:
    """Why the page's certificate of a map is false, by f_z in Arb; None if nothing was found."""
    flint.ctx.prec = 200
    z = points_along(map, 40) @ [1, 1j]
    with np.errstate(all="ignore"):
        worst = np.argsort(map.sigma2(z))[:3]
    for loop in map.domain.cage.loops_complex:
        for a, b in zip(loop, np.roll(loop, -1), strict=True):
            t = flint.arb(rng.uniform())
            if why := false_at(map, proof, exact(a) + t * (exact(b) - exact(a))):
                return why
    return next((why for i in worst if (why := false_at(map, proof, exact(z[i])))), None)


def false_at(map: HarmonicMap, proof: dict[str, Any], z: acb) -> str | None:
    f, g = derivatives(map, z)
    # Points beside the edge by rounding: the bounds hold there up to much less than this.
    room = 1 + 2.0**-30
    if not f > g:
        return f"it folds at {z}"
    if proof["sigma2_lower"] > (f - g) * room:
        return f"sigma_2 is {f - g} at {z}, not {proof['sigma2_lower']}"
    if proof["sigma1_upper"] * room < f + g:
        return f"sigma_1 is {f + g} at {z}"
    return f"k is {g / f} at {z}" if proof["k_upper"] * room < g / f else None


def test_what_the_page_proves_is_true() -> None:
    maps = list(attacks(24, seed=1))
    proofs = proved(maps)
    rng = np.random.default_rng(2)
    certified = [(m, p) for m, p in zip(maps, proofs, strict=True) if p["certified"]]
    assert len(maps) // 8 < len(certified) < len(maps)
    for map, proof in certified:
        assert refuted(map, proof, rng) is None
        ours = certify(map)
        assert not ours.reason.startswith("The map is not locally injective"), ours.reason
        assert sum(proof["windings"]) == 0
        if ours.certified:
            assert tuple(proof["windings"]) == ours.windings
            assert proof["sigma2_lower"] <= ours.sigma2_lower * 1.03
