"""The standalone page is complete and needs no network; see also tests/widgets."""

from __future__ import annotations

import base64
import json
import re
import zlib
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from glid_nb import InputError, Motion
from glid_nb.certificate import certify
from glid_nb.certificate.rounding import rounded_down
from glid_nb.export import PagePart, page_html, parts_page_html
from glid_nb.harmonic import HarmonicMap
from glid_nb.page import ShaderMap

from ..support.shapes import bent, domain, picture


def data_of(page: str, part: int = 0) -> dict:
    """What a page has for a part, and for all."""
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    assert found is not None
    data = json.loads(found[1])
    return {**data, **data["parts"][part]}


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


def two(**settings: Any) -> str:
    """The page of the shape at rest, and the bent one in front."""
    rest = HarmonicMap.identity(domain())
    maps = {"rest": rest, "bent <&>": bent()}
    parts = [PagePart(picture(), map, certify(map), name=name) for name, map in maps.items()]
    return parts_page_html(parts, **settings)


@pytest.mark.slow
def test_a_page_of_several_shapes_states_what_is_proved_of_each() -> None:
    page = two(title="Two", background=(1, 2, 3))
    assert "<title>Two</title>" in page
    assert "background: rgb(1 2 3)" in page
    proof = certify(bent())
    worst = f"σ₂ ≥ {rounded_down(min(proof.sigma2_lower, 1.0))}"
    assert (
        f"Each of 2 parts is proved not to fold over or tear at any point. Bounds for all: {worst}"
        in page
    )
    rows = re.findall(r"<li><b>(.*?)</b> (.*?)</li>", page)
    assert [name for name, _ in rows] == ["rest", "bent &lt;&amp;&gt;"]
    assert rows[1][1].startswith(f"σ₂ ≥ {rounded_down(proof.sigma2_lower)}, ")
    assert all(text.endswith("; it does not overlap itself") for _, text in rows)
    first, second = data_of(page), data_of(page, 1)
    assert first["source_bounds"] == second["source_bounds"]
    np.testing.assert_allclose(first["bounds"], first["source_bounds"], atol=1e-6)
    assert abs(second["bounds"][3] - first["bounds"][3]) > 0.1
    assert first["ranges"]["2"][1] >= proof.sigma1_upper


@pytest.mark.slow
def test_no_bounds_are_stated_for_all_if_one_shape_is_not_proved() -> None:
    rest = HarmonicMap.identity(domain())
    parts = [
        PagePart(picture(), rest, certify(rest), name="a"),
        PagePart(picture(), bent(), name="b"),
    ]
    page = parts_page_html(parts)
    assert "Bounds for all" not in page
    rows = re.findall(r"<li><b>(.*?)</b> (.*?)</li>", page)
    assert rows[0][1].startswith("σ₂ ≥ ")
    assert rows[1] == ("b", "not proved")
    assert data_of(page)["ranges"] == {}


@pytest.mark.slow
def test_one_shape_of_several_is_the_page_of_one() -> None:
    one = PagePart(picture(), bent(), certify(bent()), name="a")
    assert parts_page_html([one], "A") == page_html(picture(), bent(), certify(bent()), title="A")


@pytest.mark.slow
def test_shapes_that_do_not_fit_together_are_refused() -> None:
    rest = HarmonicMap.identity(domain())
    slow, fast = (Motion([rest, bent()], times=[0, end]) for end in (2, 1))
    there = Motion([rest, bent()], times=[0, 2], repeat="ping-pong")
    for other in (rest, fast, there):
        with pytest.raises(InputError, match="different times; all share one player"):
            parts_page_html([PagePart(picture(), slow), PagePart(picture(), other)])
    small = np.zeros((50, 300, 4), np.uint8)
    with pytest.raises(InputError, match="different sizes"):
        parts_page_html([PagePart(picture(), rest), PagePart(small, rest)])
    with pytest.raises(InputError, match="no parts"):
        parts_page_html([])
