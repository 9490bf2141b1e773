"""Tell in every notebook how to run it: ``python tools/badges.py [OWNER/NAME]``.

Adds two cells below the title: a line about Binder, Colab and a download, and a cell that installs
the package on Colab and does nothing elsewhere. OWNER/NAME is the public repository on GitHub; with
it, the line has links that open the notebook. Without it, the line links to the page about hosts.
Another run replaces both cells. The links are words, because badge pictures would need a network.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

import nbformat

FOLDER = Path(__file__).resolve().parent.parent / "notebooks"

COLAB = """\
# Google Colab (untested there): install the package, allow its widgets. Elsewhere: nothing.
# This is the extra `course` without JupyterLab, for Colab has a server of its own.
import sys

if "google.colab" in sys.modules:
    from google.colab import output

    get_ipython().run_line_magic("pip", "install -q 'glid-nb[compare,check]'")
    output.enable_custom_widget_manager()"""


def line(notebook: str, repository: str | None = None) -> str:
    """The line of links for the notebook with this file name."""
    if repository is None:
        return (
            "Run it in JupyterLab or Notebook 7, on Binder (once the repository is public), or on "
            "Colab (untested): [how to](../docs/howto/hosts.md)."
        )
    path = f"notebooks/{notebook}"
    binder = f"https://mybinder.org/v2/gh/{repository}/HEAD?labpath={path}"
    colab = f"https://colab.research.google.com/github/{repository}/blob/HEAD/{path}"
    download = f"https://raw.githubusercontent.com/{repository}/HEAD/{path}"
    return f"Run it: **[Binder]({binder})** · [Colab]({colab}) (untested) · [download]({download})"


def with_badges(book: nbformat.NotebookNode, notebook: str, repository: str | None = None) -> None:
    """Put the two cells below the title; replace them if they exist."""
    book.cells = [cell for cell in book.cells if cell.id not in ("run-it", "colab")]
    text = nbformat.v4.new_markdown_cell(line(notebook, repository), id="run-it")
    install = nbformat.v4.new_code_cell(COLAB, id="colab", metadata={"tags": ["remove-cell"]})
    book.cells[1:1] = [text, install]


def main() -> None:
    repository = sys.argv[1] if len(sys.argv) > 1 else None
    if repository and not re.fullmatch(r"[\w.-]+/[\w.-]+", repository):
        raise SystemExit(f"{repository} is not OWNER/NAME\n\n{__doc__}")
    for path in sorted(FOLDER.glob("[0-9][0-9]_*.ipynb")):
        book = nbformat.read(path, as_version=4)
        with_badges(book, path.name, repository)
        nbformat.write(book, path)


if __name__ == "__main__":
    main()
