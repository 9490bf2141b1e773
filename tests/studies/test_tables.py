"""Tables on disk and in a page, and the numbers in them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from studies.tables import digits, percent, seconds, update_page, write_csv

ROWS = [{"shape": "rex", "ms": 12.345}, {"shape": "deer", "ms": np.nan, "note": "a, b"}]
TABLE = "| shape | ms | note |\n| --- | --- | --- |\n| rex | 12.3 |  |\n| deer |  | a, b |\n"


def test_a_table_goes_into_its_place_and_the_text_stays(tmp_path: Path) -> None:
    out, page = tmp_path / "speed", tmp_path / "speed.md"
    out.mkdir()
    write_csv(out / "solves.csv", ROWS)
    before = "# Speed\n\n<!-- table: solves -->\nold\n<!-- end -->\n\nFast.\n\n"
    other = "<!-- table: unmeasured -->\n| kept |\n<!-- end -->\n"
    page.write_text(before + other)
    update_page(page, out)
    text = page.read_text()
    assert text.startswith(f"# Speed\n\n<!-- table: solves -->\n\n{TABLE}\n<!-- end -->\n\nFast.")
    assert text.endswith(other)
    update_page(page, out)
    assert page.read_text() == text


def test_a_page_is_made_where_there_is_none(tmp_path: Path) -> None:
    out = tmp_path / "speed"
    out.mkdir()
    write_csv(out / "solves.csv", ROWS)
    update_page(tmp_path / "speed.md", out)
    assert TABLE in (tmp_path / "speed.md").read_text()


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.012345, "0.0123"), (1.0, "1.00"), (99.96, "100.0"), (1856.4, "1856"), (0.0, "0")],
)
def test_numbers_have_three_digits(value: float, text: str) -> None:
    assert digits(value) == text


def test_units() -> None:
    assert (seconds(0.0624), seconds(7.06)) == ("62 ms", "7.1 s")
    assert [percent(s) for s in (0.6, 0.0999, 0.012, 0.00002)] == ["60%", "10%", "1.2%", "<0.01%"]


DOCS = Path(__file__).parents[2] / "docs"


@pytest.mark.parametrize("page", sorted(DOCS.glob("*.md")), ids=lambda page: page.name)
def test_the_tables_of_a_page_are_the_files_beside_it(page: Path, tmp_path: Path) -> None:
    copy = tmp_path / page.name
    copy.write_bytes(page.read_bytes())
    for folder in ("benchmarks", "comparisons"):
        update_page(copy, DOCS / folder)
    assert copy.read_text(encoding="utf-8") == page.read_text(encoding="utf-8")
