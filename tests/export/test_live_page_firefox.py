"""The live page in Firefox, opened from disk: another engine draws it and computes its proofs."""

from __future__ import annotations

import functools
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser

import glid_check
from glid_nb import Domain, HarmonicMap, Pose, samples, trace
from glid_nb.energies import ENERGIES
from glid_nb.export import live_page_html
from glid_nb.io import load_pose
from glid_nb.page import coefficients_of

from ..support import shapes
from ..support.browser import ARTEFACTS, launched_chromium, watched_page
from ..support.firefox import Firefox, launched_firefox

pytestmark = [pytest.mark.browser, pytest.mark.slow]

SIZES = {1366: 768, 768: 1024, 390: 844}
READY = "document.documentElement.dataset.ready === 'true'"
SETTLED = "document.documentElement.dataset.settled === 'true'"

# Every bound that the page shows.
WATCH = """(() => {
  window.bounds = [];
  new MutationObserver(() => window.bounds.push(document.getElementById("bound").textContent))
    .observe(document.getElementById("bound"), { childList: true, subtree: true });
})()"""

# A worker of the page's own code answers requests, one after the other, until each is settled.
ASK = """async (requests) => {
  const code = new Blob([window.glidPage.worker], { type: "text/javascript" });
  const worker = new Worker(URL.createObjectURL(code));
  const answers = [];
  for (const request of requests) {
    if (request.coefficients) request.coefficients = Float64Array.from(request.coefficients);
    const answer = await new Promise((resolve) => {
      worker.onmessage = ({ data }) => {
        if (data.type !== "map" || data.settled) resolve(data);
      };
      worker.postMessage({ ...request, id: 1 });
    });
    const { type, energy, certificate, coefficients } = answer;
    const numbers = coefficients ? Array.from(coefficients) : null;
    const told = { energy: energy ?? null, certificate: certificate ?? null };
    answers.push({ type, ...told, coefficients: numbers });
  }
  worker.terminate();
  return answers;
}"""


@pytest.fixture(scope="module")
def firefox() -> Iterator[Firefox]:
    with launched_firefox() as one:
        yield one


@pytest.fixture(scope="module")
def chromium() -> Iterator[Browser]:
    with launched_chromium() as one:
        yield one


@functools.cache
def sample_page(name: str) -> tuple[str, Pose]:
    """A live page of a sample, and its gentle pose. The teapot's handle surrounds a hole."""
    image = samples.image(name)
    domain = Domain.from_cage(trace(image).cage)
    assert domain.n_holes == (name == "teapot")
    return live_page_html(image, domain, title=name), load_pose(samples.pose_path(name, "gentle"))


def on_screen(firefox: Firefox, point: Any) -> tuple[float, float]:
    x, y = point
    at = firefox.value(f"window.glidPage.view.toScreen([{x}, {y}])")
    return at[0], at[1]


def click_named(firefox: Firefox, name: str) -> None:
    """Click a button by script, which works in a closed menu, too."""
    firefox.value(
        "[...document.querySelectorAll('button')].find((one) =>"
        f"[one.textContent, one.title, one.ariaLabel].includes({json.dumps(name)})).click()"
    )


@pytest.mark.parametrize("width", SIZES)
@pytest.mark.parametrize("name", ["gecko", "teapot"])
def test_a_page_from_disk_is_dragged_undone_and_proved(
    firefox: Firefox, tmp_path: Path, name: str, width: int
) -> None:
    """The narrow page is touched, the wide ones have a mouse. glid-check reads the saved proof."""
    html, pose = sample_page(name)
    page = tmp_path / "page.html"
    page.write_text(html, encoding="utf-8")
    firefox.open(page.as_uri(), width, SIZES[width], downloads=tmp_path)
    firefox.wait_for(READY)
    firefox.value(WATCH)
    assert firefox.value("document.documentElement.scrollWidth") == width
    kind = "touch" if width < 500 else "mouse"
    for handle in pose.handles[:3]:
        firefox.drag([on_screen(firefox, handle)], kind)
    firefox.wait_for(SETTLED)
    before, after = pose.handles[2], pose.targets[2]
    way = [before + share * (after - before) for share in np.linspace(0, 1, 9)]
    firefox.drag([on_screen(firefox, point) for point in way], kind)
    firefox.wait_for(SETTLED)
    dragged = firefox.value("window.glidPage.editing.pins.map((pin) => pin.target)")
    np.testing.assert_allclose(dragged[2], after, atol=0.1)
    firefox.screenshot(ARTEFACTS / f"firefox-{name}-{width}.png")
    firefox.press("Control", "z")
    firefox.wait_for(SETTLED)
    undone = firefox.value("window.glidPage.editing.pins.map((pin) => pin.target)")
    np.testing.assert_allclose(undone[2], before, atol=0.1)
    firefox.press("Control", "Shift", "z")
    firefox.wait_for(SETTLED)
    assert firefox.value("window.glidPage.editing.pins.map((pin) => pin.target)") == dragged

    bounds = firefox.value("window.bounds")
    assert len(bounds) > 3
    assert min(float(text.split("σ₂ ≥ ")[1].split()[0].rstrip(",")) for text in bounds) > 0
    click_named(firefox, "Download the map and its proof")
    files = [tmp_path / f"{name}.map.json", tmp_path / f"{name}.proof.json"]
    firefox.wait_for("true")
    assert downloaded(firefox, files)
    assert glid_check.main([str(file) for file in files]) == 0
    map = HarmonicMap.from_dict(json.loads(files[0].read_text(encoding="utf-8")))
    places = firefox.value("window.glidPage.editing.pins.map((pin) => pin.handle)")
    np.testing.assert_allclose(map(places), dragged, atol=0.1)
    assert firefox.errors == []
    assert [
        url for url in firefox.requests if not url.startswith(("file:", "data:", "blob:"))
    ] == []


def downloaded(firefox: Firefox, files: list[Path]) -> bool:
    """Whether all files have come."""
    for _ in range(200):
        if all(file.exists() and file.stat().st_size for file in files):
            return True
        firefox.value("new Promise((resolve) => setTimeout(resolve, 50))")
    return False


def requests_of_maps() -> list[dict[str, Any]]:
    """Maps from the identity past a bent one, until they fold; and noise on it."""
    domain = shapes.domain()
    identity, bent = HarmonicMap.identity(domain), shapes.bent()
    pose = {"handles": [[-5, 0], [5, 0]], "targets": [[-5, 0], [5, 0]]}
    rng = np.random.default_rng(1)
    maps = []
    for t in np.linspace(-4, 6, 40):
        noise = 10 ** rng.uniform(-4, -1) * rng.normal(size=(2, domain.n_coefficients))
        phi = identity.phi + t * (bent.phi - identity.phi) + noise[0]
        psi = identity.psi + noise[1]
        psi[-domain.n_holes :] = phi[-domain.n_holes :].conj()  # Lemma 1
        maps.append(HarmonicMap(domain, phi, psi))
    placed = [{"type": "place", "pose": pose, "coefficients": coefficients_of(m)} for m in maps]
    return [{"type": "shape", "outline": domain.to_dict(), "options": {}}, *placed]


def requests_of_solves() -> list[dict[str, Any]]:
    """First solves by all energies, each followed by a drag."""
    outline = shapes.domain().to_dict()
    pose = shapes.pose().to_dict()
    start = {"handles": pose["handles"], "targets": pose["targets"]}
    end = {**start, "targets": [pose["targets"][0], [6, 3]]}
    return [
        request
        for energy in ENERGIES
        for request in (
            {"type": "shape", "outline": outline, "options": {"energy": energy}},
            {"type": "solve", "pose": start},
            {"type": "drag", "pose": end},
        )
    ]


@pytest.fixture(scope="module")
def both(
    firefox: Firefox, chromium: Browser, tmp_path_factory: pytest.TempPathFactory
) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """The answers of Firefox's and of Chromium's worker to the same requests."""
    path = tmp_path_factory.mktemp("both") / "ring.html"
    path.write_text(live_page_html(shapes.picture(), shapes.domain()), encoding="utf-8")
    requests = requests_of_maps() + requests_of_solves()
    firefox.open(path.as_uri(), 800, 600)
    firefox.wait_for(READY)
    ours = firefox.value(f"({ASK})({json.dumps(requests)})")
    with watched_page(chromium) as page:
        page.goto(path.as_uri())
        page.wait_for_selector("html[data-ready=true]", state="attached")
        theirs = page.evaluate(ASK, requests)
    return ours, theirs


N_MAPS = 41


def test_both_engines_accept_the_same_maps_with_the_same_bounds(
    both: tuple[list[dict[str, Any]], list[dict[str, Any]]],
) -> None:
    """To the last bit (docs/proof.md, Lemma 21)."""
    ours, theirs = (answers[:N_MAPS] for answers in both)
    assert {answer["type"] for answer in ours[1:]} == {"map", "failed"}
    for one, other in zip(ours, theirs, strict=True):
        assert one["type"] == other["type"]
        assert one["certificate"] == other["certificate"]


def test_both_engines_find_the_same_energies_and_minima(
    both: tuple[list[dict[str, Any]], list[dict[str, Any]]],
) -> None:
    ours, theirs = both
    placed = [pair for pair in zip(ours[:N_MAPS], theirs, strict=False) if pair[0]["type"] == "map"]
    for one, other in placed:
        assert one["energy"] == pytest.approx(other["energy"], rel=1e-14)
    solved = list(zip(ours[N_MAPS:], theirs[N_MAPS:], strict=True))
    assert len(solved) == 3 * len(ENERGIES)
    for one, other in solved:
        assert one["type"] == other["type"]
        if one["type"] == "map":
            assert one["energy"] == pytest.approx(other["energy"], rel=1e-12)
            np.testing.assert_allclose(one["coefficients"], other["coefficients"], atol=1e-9)
