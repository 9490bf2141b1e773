"""The standalone page is complete and needs no network; see also tests/widgets."""

from __future__ import annotations

import base64
import json
import re
import zlib
from dataclasses import replace

import numpy as np
import pytest

from glid_nb import Motion
from glid_nb.certificate import certify
from glid_nb.export import page_html
from glid_nb.harmonic import HarmonicMap
from glid_nb.page import ShaderMap

from ..support.shapes import bent, domain, picture


def data_of(page: str) -> dict:
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    assert found is not None
    return json.loads(found[1])


def unpacked(data: dict, width: int) -> np.ndarray:
    """(n, width) values that the page computes from packed values."""
    planes = np.frombuffer(zlib.decompress(base64.b64decode(data["bytes"])), "u1").reshape(4, -1)
    folded = np.ascontiguousarray(planes.T).view("<u4").astype(np.int64).reshape(-1, width)
    fresh = (folded >> 1) ^ -(folded & 1)
    return data["step"] * fresh.cumsum(axis=0).cumsum(axis=0)


def restored(data: dict, width: int) -> np.ndarray:
    """(n, width) values that the page computes from sums of few rows."""
    shares = unpacked(data["shares"], len(data["sizes"])) / data["sizes"]
    return shares @ unpacked(data["rows"], data["rows"]["width"]).reshape(-1, width)


def ends(points: np.ndarray) -> list[np.ndarray]:
    return [points.min(axis=0), points.max(axis=0)]


def test_the_page_holds_everything_and_may_not_use_the_network() -> None:
    page = page_html(picture(), bent())
    assert "default-src 'none'" in page
    assert not re.search(r"""(src|href)\s*=\s*["'](?!data:)""", page)
    assert "http" not in re.sub(r"http-equiv", "", page)
    assert "{{" not in page
    data = data_of(page)
    step = 2.5e-5 * domain().cage.longer_side
    vertices = unpacked(data["source"], 2)
    low, high = np.reshape(data["bounds"], (2, 2))
    np.testing.assert_allclose([low, high], ends(bent()(vertices)), atol=2 * step)
    wire = (ShaderMap(domain()).wire(map) for map in (HarmonicMap.identity(domain()), bent()))
    first, last = (np.frombuffer(one, "<f4") for one in wire)
    rows = restored(data["coefficients"], data["width"])
    np.testing.assert_allclose(rows, [first, last, last], atol=step, rtol=1e-6)
    corners = unpacked(data["triangles"], 3)
    corners[:, 1:] += corners[:, :1]
    a, b, c = vertices[corners.astype(int)].transpose(1, 0, 2) @ [1, 1j]
    area = np.imag((b - a).conj() * (c - a)) / 2
    assert (area > 0).all()
    assert area.sum() == pytest.approx(domain().cage.polygon.area, rel=1e-4)
    assert data["picture"].startswith("data:image/png;base64,")


def test_a_title_cannot_break_out() -> None:
    page = page_html(picture(), bent(), title="</title><script>alert(1)</script>{{data}}")
    assert "<script>alert" not in page
    assert "&lt;script&gt;alert(1)&lt;/script&gt;{{data}}" in page
    assert page.count('"source_bounds"') == 1


@pytest.mark.slow
def test_bounds_are_stated_only_if_they_are_proved() -> None:
    assert "Proved not to fold" in page_html(picture(), bent(), certify(bent()))
    assert "Proved" not in page_html(picture(), bent())


@pytest.mark.slow
def test_stated_bounds_are_bounds() -> None:
    proof = replace(certify(bent()), sigma2_lower=0.4567, sigma1_upper=1.2341, k_upper=1.12e-10)
    vars(proof)["certified"] = True
    page = page_html(picture(), bent(), proof)
    assert "σ₂ ≥ 0.456, σ₁ ≤ 1.24, k ≤ 0.001" in page


@pytest.mark.slow
def test_an_overlap_is_told_of() -> None:
    start = HarmonicMap.identity(domain())
    # (z + 1)^2 on a ring about -1 goes around twice.
    phi = np.where(start.phi != 0, (start.phi + 1) ** 2, 0)
    twice = HarmonicMap(domain(), phi, start.psi)
    proof = certify(twice)
    assert proof.certified
    assert "parts of the shape lie over one another" in page_html(picture(), twice, proof)
    assert "no part lies over another" in page_html(picture(), bent(), certify(bent()))


@pytest.mark.slow
def test_a_page_that_moves_states_what_is_proved() -> None:
    motion = Motion([HarmonicMap.identity(domain()), bent()])
    page = page_html(picture(), motion, title="walk")
    assert "Proved not to fold over or tear at any point, at any time. Bounds: σ₂ ≥ 0." in page
    data = data_of(page)
    assert data["motion"]["keyframes"] == [0, 1]
    assert data["ranges"]["4"][1] >= motion.certificate.k_upper
    assert len(page) - len(data["picture"]) < 300_000


@pytest.mark.slow
@pytest.mark.parametrize(("poses", "turns", "least"), [(5, 3, 400), (40, 0, 150)])
def test_long_motions_make_small_pages(poses: int, turns: int, least: int) -> None:
    """A shape of 42 vertices. The page gets all knots, whatever their number."""
    start, rng = HarmonicMap.identity(domain()), np.random.default_rng(1)
    bends = rng.normal(size=(poses, 4, 2)) @ [1, 1j]
    bases = np.stack([start.phi**n / 10 ** (n - 1) for n in (1, 2, 3)])
    maps = [
        HarmonicMap(domain(), start.phi + 0.05 * bend[:3] @ bases, 0.05 * bend[3] * start.phi)
        for bend in bends
    ]
    motion = Motion(maps, turns=turns)
    knots = [motion.pieces[0].start_map, *(piece.end_map for piece in motion.pieces)]
    assert len(knots) > least
    page = page_html(picture(), motion)
    data = data_of(page)
    assert len(page) - len(data["picture"]) < 100_000
    wire = ShaderMap(domain()).wire
    wanted = [np.frombuffer(wire(map), "<f4") for map in (start, *knots)]
    step = 2.5e-5 * domain().cage.longer_side
    rows = restored(data["coefficients"], data["width"])
    np.testing.assert_allclose(rows, wanted, atol=step, rtol=1e-6)


@pytest.mark.slow
def test_a_cage_too_large_for_a_shader_is_evaluated_beforehand(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("glid_nb.export.page.LONGEST_CHAIN", 10)
    data = data_of(page_html(picture(), Motion([HarmonicMap.identity(domain()), bent()])))
    vertices = unpacked(data["source"], 2)
    images = restored(data["coefficients"], data["width"])[-1].reshape(-1, 6)[:, :2]
    np.testing.assert_allclose(images, bent()(vertices), atol=1e-3)
    assert data["cage"] == ""
