"""Numbers in the text of pages are those of the tables that the studies wrote."""

from __future__ import annotations

import csv
import re
import statistics
from collections.abc import Callable
from pathlib import Path

import nbformat
import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
DOCS = REPOSITORY / "docs"
_TABLE = re.compile(r"<!-- table: ([\w-]+) -->\n\n(.*?)\n\n<!-- end -->", re.DOTALL)
_CLAIM = re.compile(
    r"""(?<![\w.])
    (?:\d[\d.,]*(?:\ (?:to|and|or)\ \d[\d.,]*)? | two|three|four|five|eight|ten|thirty
      | (?:under|about)\ an? | half\ an | (?:some|a\ few|several|few))
    \ (?:times\ (?:as|faster|slower) | ms | s | [kMG]B
      | (?:milli)?seconds? | minutes? | hours? | (?:kilo|mega|giga)?bytes?)\b""",
    re.VERBOSE,
)
# Pages of measurements: each says how its numbers were measured.
_MEASURED = {
    "benchmarks.md",
    "benchmarks-details.md",
    "checking.md",
    "comparisons.md",
    "comparisons-figures.md",
    "howto/live.md",
    "howto/many.md",
    "motion.md",
    "tried.md",
}
# Times and sizes that somebody has chosen, or that the paper has.
_CHOSEN = {
    "ARCHITECTURE.md": ["two seconds"],
    "docs/contributing.md": ["60 kB", "two seconds", "180 seconds"],
    "docs/lecturers.md": ["90 minutes", "60 seconds", "50 MB"],
    "docs/measurements.md": ["eight minutes"],
    "notebooks/07_newton.ipynb": ["300 times as", "60 seconds"],
    "notebooks/10_others.ipynb": ["125 times as"],
    "notebooks/11_fast.ipynb": ["16 milliseconds"],
}


def rows(table: str) -> list[dict[str, str]]:
    """A table of a study, such as `comparisons/speed`."""
    with (DOCS / f"{table}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def number(text: str) -> float:
    """The first number of a cell; `1,074` is one number, `30 / 103` are two."""
    found = re.search(r"\d[\d,]*(?:\.\d+)?(?:e[+-]?\d+)?", text)
    assert found is not None, text
    return float(found[0].replace(",", ""))


def column(table: str, name: str, place: int = 0, between: str = " / ") -> list[float]:
    """The numbers of a column; `place` chooses one of several in a cell."""
    cells = [row[name].split(between) for row in rows(table)]
    return [number(cell[place]) for cell in cells if re.search(r"\d", cell[0])]


def middle(table: str, name: str, place: int = 0) -> float:
    return statistics.median(column(table, name, place))


def ratios(table: str, above: str, below: str) -> list[float]:
    return [a / b for a, b in zip(column(table, above), column(table, below), strict=True)]


def shares(table: str, name: str) -> list[float]:
    """The first number of each cell over its last one."""
    first, last = column(table, name), column(table, name, -1)
    return [a / b for a, b in zip(first, last, strict=True)]


def of_shape(table: str, shape: str, name: str) -> float:
    (row,) = (row for row in rows(table) if next(iter(row.values())) == shape)
    return number(row[name])


def halted() -> list[float]:
    """Where unmodified Newton halts: its energy over that of the minimum."""
    best = {row["shape"]: number(row["Newton, ours"]) for row in rows("comparisons/distortion")}
    found = []
    for row in rows("comparisons/iterations"):
        energy = re.search(r"indefinite at \d+ \((.*)\)", row["Newton, unmodified"])
        if energy:
            found.append(float(energy[1]) / best[row["shape"]])
    return found


def both_converge() -> list[bool]:
    """Where the paper's Newton and Newton-Eigen converge: whether the former is no slower."""
    table = rows("comparisons/iterations")
    pairs = [(row["Newton, the paper's"], row["Newton-Eigen"]) for row in table]
    return [int(a) <= int(b) for a, b in pairs if a.isdigit() and b.isdigit()]


def over_free_mesh() -> list[float]:
    """Our mean of E_iso over the least one on a mesh."""
    found = []
    for row in rows("comparisons/distortion"):
        meshes = [row[name] for name in ("SLIM", "AQP", "mesh, from ours") if row[name]]
        found.append(number(row["Newton, ours"]) / min(map(number, meshes)))
    return found


def phrases_of_comparisons() -> list[str]:
    speed, iterations = "comparisons/speed", "comparisons/iterations"
    ours, first = column(iterations, "Newton, ours"), "comparisons/iteration-times"
    time, mesh = column(speed, "ours, ms", -1), over_free_mesh()
    light = column("comparisons/variants", "L-BFGS, light targets")
    eigen = column(speed, "Newton-Eigen")
    dear = ratios(first, "Newton-Eigen", "Newton, stage by stage")
    cheap = ratios(first, "Newton, stage by stage", "AQP")
    slim, aqp = ([middle(speed, name, i) for i in range(3)] for name in ("SLIM", "AQP"))
    conformal = column("comparisons/conformal", "mean of E_iso")
    exponential = [column("comparisons/exponential", n) for n in ("its maximum", "mean of E_iso")]
    lipschitz = sorted(column("comparisons/lipschitz", "ratio"))
    on_10000 = sorted(column("comparisons/lipschitz", "ratio on 10,000"))
    converge = both_converge()
    return [
        f"our default takes {min(ours):.0f} to {max(ours):.0f} iterations "
        f"and {min(time):.0f} to {max(time):.0f} ms to its minimum",
        f"SLIM takes {slim[0]:.0f} times as long, AQP {aqp[0]:.0f} times, "
        f"Newton-Eigen {statistics.median(eigen):.0f} times",
        f"our mean of E_iso is {min(mesh):.2f} to {max(mesh):.2f} times that of a free mesh",
        f"halts on {len(halted())} of {len(time)} shapes, "
        f"on {sum(ratio > 10 for ratio in halted())} at over 10 times the minimum's energy",
        f"on {sum(converge)} of the {len(converge)} shapes where both converge",
        f"{min(light):,.0f} to {max(light):,.0f} with light targets",
        f"to within 1% of the minimum: {slim[0]:.0f} times and {aqp[0]:.0f} times in the median",
        f"{statistics.median(eigen):.0f} times in the median, "
        f"{min(eigen):.0f} to {max(eigen):.0f}, on one CPU",
        f"{min(dear):.1f} to {max(dear):.1f} times, "
        f"on {sum(one > 1 for one in dear)} of {len(dear)} shapes",
        f"on {sum(one > 1 for one in cheap)} of {len(cheap)} shapes; on archery and colorbar",
        f"mean of E_iso {conformal[1]:.2f} against {conformal[0]:.2f}",
        "{:.2f} to {:.2f}, and {:.3f} to {:.3f}".format(*exponential[0], *exponential[1]),
        "{:.1f} and {:.1f} times on its number of segments, {:.1f} and {:.1f} on 10,000".format(
            *lipschitz, *on_10000
        ),
        f"In the median SLIM takes {slim[0]:.0f}, {slim[1]:.0f} and over {slim[2]:,.0f} times "
        f"as long, AQP {aqp[0]:.0f}, {aqp[1]:.0f} and over {aqp[2]:,.0f} times",
        *phrases_of_minima(),
    ]


def phrases_of_minima() -> list[str]:
    times, minima = "comparisons/minima-times", "comparisons/minima"
    kinds = ("good, all", "good, none tried", "good, others tried", "poor")
    good, none, others, poor = (of_shape(times, kind, "poses") for kind in kinds)
    assert set(column(minima, "poses")) == {good + poor}
    return [f"Of {good:.0f} good poses, {none:.0f} need no restart; the other {others:.0f} cost"]


def phrases_of_benchmarks() -> list[str]:
    solves = "benchmarks/solves"
    time, ratio, drag = (column(solves, n) for n in ("default, ms", "ratio", "drag step, ms"))
    aligned, low = column(solves, "ratio, paper aligned"), of_shape(solves, "archery", "ratio")
    iterations = shares(solves, "iterations, paper / aligned / default")
    each = shares(solves, "per iteration, paper / default, ms")
    memory = max(
        value
        for kind in ("vertices", "holes", "handles")
        for value in column(f"benchmarks/scaling-{kind}", "memory, GB")
    )
    cold, warm = rows("benchmarks/start")
    energies = [column(solves, "energy, paper / default", i)[1] for i in (0, 1)]
    one, two = (column("benchmarks/batches", f"{n} device(s)")[-1] for n in (1, 2))
    assert low == min(ratio)
    assert round(two / one, 1) == 1.3  # in benchmarks-details.md
    return [
        f"certificate included:** {min(time):.0f} to {max(time):.0f} ms",
        f"{min(ratio):.1f} to {max(ratio):.1f} times faster than the paper's settings in the same "
        f"code, {statistics.median(ratio):.1f} times in the median",
        f"Rex takes {of_shape(solves, 'rex', 'default, ms'):.1f} ms",
        f"to a gap of 1e-4): {min(drag):.0f} to {max(drag):.0f} ms",
        f"takes {number(cold['first solve']):.1f} s, or {number(warm['first solve']):.2f} s if its "
        f"programs are on disk. Later solves take {number(warm['second solve']):.2f} s",
        f"{memory:.2f} GB at most",
        f"has fewer iterations ({statistics.median(iterations):.1f} times in the median), "
        f"and each is cheaper ({statistics.median(each):.1f} times)",
        f"the paper's settings are still {statistics.median(aligned):.1f} times slower in the "
        f"median, and {min(aligned):.1f} times at least",
        f"a lower minimum, {energies[1]:.2f} instead of {energies[0]:.2f}",
        f"a median ratio of 5 (it is {statistics.median(ratio):.1f}), "
        f"and a least ratio of 2.5 (it is {min(ratio):.1f})",
    ]


def prose(path: Path) -> str:
    """The text of a page without its tables of studies, in one line."""
    text = _TABLE.sub("", path.read_text(encoding="utf-8"))
    return " ".join(text.split())


@pytest.mark.parametrize(
    ("page", "phrases"),
    [("comparisons", phrases_of_comparisons), ("benchmarks", phrases_of_benchmarks)],
)
def test_the_text_of_a_page_has_the_numbers_of_its_tables(
    page: str, phrases: Callable[[], list[str]]
) -> None:
    text = prose(DOCS / f"{page}.md")
    missing = [phrase for phrase in phrases() if " ".join(phrase.split()) not in text]
    assert not missing


@pytest.mark.parametrize(
    "page", ["comparisons", "comparisons-figures", "benchmarks", "benchmarks-details"]
)
def test_the_tables_of_a_page_are_the_files_of_the_study(page: str) -> None:
    folder = DOCS / page.partition("-")[0]
    for name, table in _TABLE.findall((DOCS / f"{page}.md").read_text(encoding="utf-8")):
        file = folder / f"{name}.csv"
        if not file.is_file():
            assert "|" not in table, f"{name} is on the page, and its file is not there"
            continue
        with file.open(encoding="utf-8", newline="") as opened:
            written = list(csv.reader(opened))
        shown = [line.strip("|").split("|") for line in table.splitlines() if "---" not in line]
        assert [[cell.strip() for cell in row] for row in shown] == written, name


def written(path: Path) -> str:
    """A page's text, or that of a chapter, in one line and without its code blocks."""
    if path.suffix == ".md":
        text = re.sub(r"^```.*?^```", "", path.read_text(encoding="utf-8"), flags=re.M | re.S)
    else:
        cells = nbformat.read(path, as_version=4).cells
        text = "\n".join(c.source for c in cells if c.cell_type == "markdown")
    return " ".join(text.split())


def claims(text: str) -> list[str]:
    """Times and sizes in a text, in digits or in words."""
    return [found[0] for found in _CLAIM.finditer(text)]


def pages_without_measurements() -> list[Path]:
    docs = [
        path for path in DOCS.glob("**/*.md") if path.relative_to(DOCS).as_posix() not in _MEASURED
    ]
    chapters = (REPOSITORY / "notebooks").glob("*.ipynb")
    return sorted([REPOSITORY / "README.md", REPOSITORY / "ARCHITECTURE.md", *docs, *chapters])


@pytest.mark.parametrize("path", pages_without_measurements(), ids=lambda path: path.stem)
def test_other_pages_claim_no_time_and_no_size(path: Path) -> None:
    """They link to the page with the table, which a new measurement changes."""
    chosen = _CHOSEN.get(path.relative_to(REPOSITORY).as_posix(), [])
    assert claims(written(path)) == chosen


@pytest.mark.parametrize(
    "text", ["runs in under a minute", "takes 0.1 s", "14 MB", "a few kilobytes", "half an hour"]
)
def test_a_claim_is_found_in_digits_and_in_words(text: str) -> None:
    assert claims(f"It {text}.")
