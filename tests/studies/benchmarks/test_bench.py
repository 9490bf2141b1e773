"""The benchmarks run from end to end and write their page; no number is judged here."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

import glid_nb
from studies.benchmarks.__main__ import main
from studies.benchmarks.shapes import flower, ring_of_handles
from studies.benchmarks.solving import iterations_to
from studies.benchmarks.timing import scaled, summary


def test_summary_and_share_of_timings() -> None:
    timing = summary([3.0, 1.0, 2.0, 4.0, 5.0])
    assert timing == {"median": 3.0, "low": 2.0, "high": 4.0, "least": 1.0, "runs": 5}
    assert scaled(timing, 0.5) == {"median": 1.5, "low": 1.0, "high": 2.0, "least": 0.5, "runs": 5}


@pytest.mark.parametrize(("vertices", "holes"), [(50, 0), (40, 50), (300, 7)])
def test_flowers_hold_their_handles(vertices: int, holes: int) -> None:
    domain = flower(vertices, holes)
    assert len(domain.cage.exterior) == vertices
    assert len(domain.cage.holes) == holes
    if not holes:
        assert domain.cage.contains(ring_of_handles(64).handles).all()


def test_iterations_to_a_gap_are_counted_from_the_history() -> None:
    domain = flower(50, 0)
    result = glid_nb.solve(domain, ring_of_handles(4), options=glid_nb.Options(restarts=0))
    count = iterations_to(result, 1e-6)
    energies = [entry.energy for entry in result.history]
    assert energies[count - 1] <= result.energy * (1 + 1e-6)
    assert count == 1 or energies[count - 2] > result.energy * (1 + 1e-6)


@pytest.fixture
def bench(tmp_path: Path, problems: Path) -> Callable[..., None]:
    """Measures some parts, as quickly as can be, into the folder ``speed``."""
    words = ["--quick", "--repeats", "1", "--reference", str(problems)]

    def measured(*names: str) -> None:
        only = [word for name in names for word in ("--only", name)]
        main([*words, "--out", str(tmp_path / "speed"), *only])

    return measured


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_bench_writes_its_page(bench: Callable[..., None], tmp_path: Path) -> None:
    out = tmp_path / "speed"
    bench("solves", "drags", "scaling")
    page = tmp_path / "speed.md"
    text = page.read_text()
    assert "| bar |" in text
    assert str(tmp_path) not in text
    pictures = ("scaling.png", "solves.png", "speedups.png")
    assert all((out / name).exists() and f"speed/{name}" in text for name in pictures)
    kept = out / "data" / "bar-solves.json"
    solves = json.loads(kept.read_text())
    for mode in ("paper", "default", "paper-aligned"):
        assert solves[mode]["certified"]
        assert solves[mode]["to_gap"]["median"] > 0

    page.unlink()
    main(["--render", "--out", str(out)])
    assert page.read_text() == text
    # What is there is not measured again, unless the settings differ.
    before = kept.stat().st_mtime_ns
    bench("solves")
    assert kept.stat().st_mtime_ns == before


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_bench_measures_starts_and_batches(bench: Callable[..., None], tmp_path: Path) -> None:
    out = tmp_path / "speed"
    bench("start", "compilations", "batches")
    text = (tmp_path / "speed.md").read_text()
    assert "one device | 2 devices" in text
    assert "| cold |" in text
    counts = json.loads((out / "data" / "compilations.json").read_text())["counts"]
    assert set(counts.values()) == {0}, counts


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--render"], "run.json"),
        (["--render", "--fresh"], "leave out --fresh"),
        (["--only", "hope"], "unknown part 'hope'"),
        (["--repeats", "0"], "repeats is 0"),
    ],
)
def test_what_bench_refuses(tmp_path: Path, words: list[str], said: str) -> None:
    with pytest.raises((ValueError, OSError), match=said):
        main(["--out", str(tmp_path / "speed"), *words])
