"""Put pictures of the documentation into the notebooks that show them.

For ``![...](attachment:NAME.png)`` in a cell, this attaches ``docs/NAME.png``. A path to the file
would fail in a copy of the notebook, on Colab, and on a server that serves only the notebook's
folder. Run ``python tools/attach_pictures.py`` after drawing pictures again.
"""

from __future__ import annotations

import base64
import re
from pathlib import Path

import nbformat

ROOT = Path(__file__).resolve().parent.parent
ATTACHED = re.compile(r"\]\(attachment:([^)]+)\)")


def attach(cell: nbformat.NotebookNode) -> bool:
    """Attach a Markdown cell's pictures to it. Returns whether the cell has any."""
    names = ATTACHED.findall(cell.source)
    if names:
        data = {name: (ROOT / "docs" / name).read_bytes() for name in names}
        pictures = {name: base64.b64encode(data[name]).decode("ascii") for name in names}
        cell.attachments = {name: {"image/png": text} for name, text in pictures.items()}
    return bool(names)


def main() -> None:
    for path in sorted((ROOT / "notebooks").glob("*.ipynb")):
        book = nbformat.read(path, as_version=4)
        attached = [attach(cell) for cell in book.cells if cell.cell_type == "markdown"]
        if any(attached):
            nbformat.write(book, path)


if __name__ == "__main__":
    main()
