"""Put two buttons below the title of each notebook: ``python tools/badges.py [OWNER/NAME]``.

OWNER/NAME is the public repository on GitHub. The buttons open the notebook on Binder and download
it. Without OWNER/NAME the buttons are removed. Another run replaces them. They are words, because
badge pictures would need a network.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

import nbformat

FOLDER = Path(__file__).resolve().parent.parent / "notebooks"


def buttons(notebook: str, repository: str) -> str:
    """The two buttons of the notebook with this file name."""
    path = f"notebooks/{notebook}"
    binder = f"https://mybinder.org/v2/gh/{repository}/HEAD?labpath={path}"
    download = f"https://raw.githubusercontent.com/{repository}/HEAD/{path}"
    return f"**[Run it on Binder]({binder})** · [Download it]({download})"


def with_buttons(book: nbformat.NotebookNode, notebook: str, repository: str | None = None) -> None:
    """Put the buttons below the title, or remove them if there is no repository."""
    book.cells = [cell for cell in book.cells if cell.id != "run-it"]
    if repository is not None:
        text = buttons(notebook, repository)
        book.cells.insert(1, nbformat.v4.new_markdown_cell(text, id="run-it"))


def main() -> None:
    repository = sys.argv[1] if len(sys.argv) > 1 else None
    if repository and not re.fullmatch(r"[\w.-]+/[\w.-]+", repository):
        raise SystemExit(f"{repository} is not OWNER/NAME\n\n{__doc__}")
    for path in sorted(FOLDER.glob("[0-9][0-9]*_*.ipynb")):
        book = nbformat.read(path, as_version=4)
        with_buttons(book, path.name, repository)
        nbformat.write(book, path)


if __name__ == "__main__":
    main()
