"""Put pictures of the documentation into the notebooks that show them.

A cell shows ``![...](attachment:NAME.png)``, which is ``docs/NAME.png`` once this was run. A path
would lead nowhere in a copy, on Colab, and on a server whose folder is the notebook's own. Run
``python tools/attach_pictures.py`` after pictures were drawn anew.
"""

from __future__ import annotations

import base64
import re
from pathlib import Path

import nbformat

ROOT = Path(__file__).resolve().parent.parent
ATTACHED = re.compile(r"\]\(attachment:([^)]+)\)")


def attach(cell: nbformat.NotebookNode) -> bool:
    """Put what a Markdown cell shows into it; whether that is anything."""
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
