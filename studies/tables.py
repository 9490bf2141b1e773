"""Tables as CSV files, and the same tables in a page of Markdown.

A page marks the place of the table ``NAME.csv`` by ``<!-- table: NAME -->`` and ``<!-- end -->``.
The text between the two is replaced; the rest of the page stays unchanged.
"""

import csv
import io
import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from glid_nb._files import write_atomically

Row = dict[str, Any]
"""Cells by the name of their column."""

_PLACE = re.compile(r"<!-- table: ([\w-]+) -->\n.*?<!-- end -->", re.DOTALL)


def write_csv(path: Path, rows: Sequence[Row]) -> None:
    """Write a table with the columns of all rows, in their order of appearance."""
    columns = list(dict.fromkeys(name for row in rows for name in row))
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([cell(row.get(name)) for name in columns] for row in rows)
    write_atomically(path, buffer.getvalue())


def update_page(page: Path, folder: Path) -> None:
    """Put the tables of a folder into their places in a page.

    A place without a table in the folder stays unchanged. If the page does not exist, a page with
    all tables of the folder is made.
    """
    if not page.exists():
        names = sorted(path.stem for path in folder.glob("*.csv"))
        places = (f"<!-- table: {name} -->\n<!-- end -->\n" for name in names)
        page.write_text("\n".join(places), encoding="utf-8")

    def filled(place: re.Match[str]) -> str:
        path = folder / f"{place[1]}.csv"
        if not path.exists():
            return place[0]
        return f"<!-- table: {place[1]} -->\n\n{markdown(path)}\n<!-- end -->"

    text = page.read_text(encoding="utf-8")
    write_atomically(page, _PLACE.sub(filled, text))


def markdown(path: Path) -> str:
    """A CSV file as a table of Markdown."""
    with path.open(encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    lines = [header, ["---"] * len(header), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def cell(value: Any) -> str:
    """A cell's text: numbers with three digits, nothing for a missing value."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    if isinstance(value, float):
        return digits(value)
    return str(value)


def digits(value: float, count: int = 3) -> str:
    """A number with ``count`` significant digits, but never rounded before the decimal point."""
    if value == 0 or not math.isfinite(value):
        return f"{value:g}"
    places = count - 1 - math.floor(math.log10(abs(value)))
    return f"{value:.{max(places, 0)}f}" if -4 < math.log10(abs(value)) < 6 else f"{value:.2g}"


def seconds(value: float) -> str:
    """A time: milliseconds below a second."""
    return f"{value * 1e3:.0f} ms" if value < 1 else f"{value:.1f} s"


def percent(share: float) -> str:
    """A share of 1 in percent, with two digits; whole percents from 10 on."""
    value = 100 * share
    if 0 < value < 0.005:
        return "<0.01%"
    places = 0 if value >= 9.95 else 1 if value >= 0.995 else 2
    return f"{value:.{places}f}%"
