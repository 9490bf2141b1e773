"""The benchmarks run from end to end and write their tables. No number is judged here."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import glid_nb
from studies.__main__ import main
from studies.bench import many
from studies.bench.scaling import flower, local_exponents, ring_of_handles
from studies.bench.solving import MODES, iterations_to


@pytest.mark.parametrize(("vertices", "holes"), [(50, 0), (40, 50), (300, 7)])
def test_flowers_hold_their_handles(vertices: int, holes: int) -> None:
    domain = flower(vertices, holes)
    assert len(domain.cage.exterior) == vertices
    assert len(domain.cage.holes) == holes
    if not holes:
        assert domain.cage.contains(ring_of_handles(64).handles).all()


@pytest.mark.slow
def test_iterations_to_a_gap_are_counted_from_the_history() -> None:
    domain = flower(50, 0)
    result = glid_nb.solve(domain, ring_of_handles(4), options=glid_nb.Options(restarts=0))
    count = iterations_to(result, 1e-6)
    energies = [entry.energy for entry in result.history]
    assert energies[count - 1] <= result.energy * (1 + 1e-6)
    assert count == 1 or energies[count - 2] > result.energy * (1 + 1e-6)


def test_exponents_of_a_power() -> None:
    x = np.array([10, 20, 80])
    np.testing.assert_allclose(local_exponents(x, 3 * x**2.5), [2.5, 2.5])
    assert len(local_exponents(x[:1], x[:1])) == 0


def test_what_noise_outweighs_has_no_exponent() -> None:
    assert np.isnan(local_exponents(np.array([10, 20, 40]), np.array([1.0, -0.1, 16.0]))).all()


@pytest.fixture
def bench(tmp_path: Path, problems: Path) -> Callable[..., None]:
    """Measures some parts, as quickly as possible, into the folder ``speed``."""
    words = ["bench", "--quick", "--repeats", "1", "--reference", str(problems)]

    def measured(*names: str) -> None:
        only = [word for name in names for word in ("--only", name)]
        main([*words, "--out", str(tmp_path / "speed"), *only])

    return measured


def table(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_bench_writes_its_tables(bench: Callable[..., None], tmp_path: Path) -> None:
    out = tmp_path / "speed"
    bench("solves", "scaling")
    kept = out / "data" / "solves-bar.json"
    solves = json.loads(kept.read_text())
    for mode in MODES:
        assert solves[mode]["certified"]
        assert solves[mode]["to_gap"]["median"] > 0
    (row,) = table(out / "solves.csv")
    assert row["shape"] == "bar"
    ratio = solves["paper"]["to_gap"]["median"] / solves["default"]["to_gap"]["median"]
    assert float(row["ratio"]) == pytest.approx(ratio, rel=0.05)
    assert [row["settings"] for row in table(out / "breakdown.csv")] == ["paper", "default"]
    assert float(row["drag step, ms"]) > 0
    assert len(table(out / "scaling-vertices.csv")) == 1
    assert (out / "solves.webp").exists()

    page = tmp_path / "speed.md"
    text = page.read_text()
    page.unlink()
    main(["bench", "--render", "--out", str(out)])
    assert page.read_text() == text
    # Existing measurements are not repeated, unless the settings differ.
    before = kept.stat().st_mtime_ns
    bench("solves")
    assert kept.stat().st_mtime_ns == before


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_bench_measures_starts_and_batches(bench: Callable[..., None], tmp_path: Path) -> None:
    bench("start", "batches")
    out = tmp_path / "speed"
    rows = table(out / "batches.csv")
    assert [row["poses"] for row in rows] == ["one by one", "1"]
    assert float(rows[1]["1 device(s)"]) > 0
    cold, warm = table(out / "start.csv")
    assert float(cold["first solve"]) > float(warm["second solve"])


@pytest.mark.slow
def test_bench_measures_many_problems(
    bench: Callable[..., None], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(many, "EXECUTORS", {"this process": many.EXECUTORS["this process"]})
    bench("many")
    rows = table(tmp_path / "speed" / "many.csv")
    assert [row["executor"] for row in rows] == ["solve in a loop", "this process"]
    assert all(float(row["poses per second"]) > 0 for row in rows)
    sizes = {row["part"]: row["bytes"] for row in table(tmp_path / "speed" / "many-parts.csv")}
    assert int(sizes["answer"]) < int(sizes["whole result, pickled"]) / 100


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["bench", "--only", "hope"], "unknown study 'hope'; choose one of solves"),
        (["bench", "--repeats", "0"], "repeats is 0"),
        (["compare", "--only", "magic"], "unknown study 'magic'; choose one of progress"),
        (
            ["compare", "--reference", "nowhere"],
            "no JSON file in this folder holds a cage and handles",
        ),
    ],
)
def test_what_is_refused(tmp_path: Path, words: list[str], said: str) -> None:
    with pytest.raises(glid_nb.InputError, match=said):
        main([*words, "--out", str(tmp_path / "speed")])
    assert not (tmp_path / "speed").exists()
