"""Run notebooks in place and save their outputs: ``python tools/run_notebooks.py [NUMBER ...]``.

Without numbers all chapters are run, one after the other. Another run saves the same file: outputs
have no widgets, which a page without a kernel cannot show, no times and no versions.
"""

from __future__ import annotations

import itertools
import sys
import time
from pathlib import Path

import nbformat
from nbclient import NotebookClient

FOLDER = Path(__file__).resolve().parent.parent / "notebooks"
WIDGET = "application/vnd.jupyter.widget-view+json"


def without_widgets(cell: nbformat.NotebookNode) -> None:
    """If a cell shows a widget, keep only the widget's picture, if there is one."""
    shown = [output for output in cell.outputs if output.get("data", {}).pop(WIDGET, None)]
    if shown:
        cell.outputs = [output for output in shown if "image/png" in output.data]


def run(path: Path) -> None:
    book = nbformat.read(path, as_version=4)
    metadata = dict(book.metadata)
    client = NotebookClient(
        book,
        kernel_name="python3",
        resources={"metadata": {"path": str(path.parent)}},
        timeout=600,
        record_timing=False,
        store_widget_state=False,
        coalesce_streams=True,
    )
    # With these handlers, nbclient may miss a cell's reply and wait for minutes.
    client.comm_open_handlers.clear()
    client.execute()
    book.metadata = metadata  # without the version of Python
    for cell in book.cells:
        if cell.cell_type == "code":
            without_widgets(cell)
    nbformat.write(book, path)


def main(numbers: list[str]) -> None:
    found = (sorted(FOLDER.glob(f"{number}_*.ipynb")) for number in numbers or ["[0-9][0-9]*"])
    paths = list(itertools.chain.from_iterable(found))
    if not paths:
        raise SystemExit(f"no chapter has the number {' or '.join(numbers)}\n\n{__doc__}")
    for path in paths:
        begin = time.perf_counter()
        run(path)
        print(f"{path.name}: {time.perf_counter() - begin:.0f} s", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
