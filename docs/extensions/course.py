"""The directive ``course``: a table of the chapters, read from the notebooks themselves."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

from docutils import nodes
from docutils.statemachine import StringList
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective


def chapter(path: Path) -> tuple[str, str, str]:
    """Title, question and minutes, as the first cells of a notebook state them."""
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    text = "\n".join("".join(c["source"]) for c in cells[:3] if c["cell_type"] == "markdown")

    def stated(pattern: str) -> str:
        found = re.search(pattern, text, re.MULTILINE)
        return found[1].strip(" *_.") if found else ""

    question = stated(r"(?i)^\W*the question:?\W*:?\s*(.+?)$")
    title = re.sub(r"^\d+[a-z]?\W+", "", stated(r"^# +(.+)$"))
    return (
        title,
        question[:1].upper() + question[1:],
        stated(r"(?i)minutes:?\W*\s*(\d+(?: ?(?:to|-|–) ?\d+)?)"),
    )


def offer_notebook(app: Sphinx, page: str, _template: str, context: dict[str, Any], _: Any) -> None:
    """Tell a chapter's page where the file is that the course's table links."""
    if page.startswith("notebooks/"):
        files = {Path(name): place for name, (_, place) in app.env.dlfiles.items()}
        context["notebook_file"] = f"_downloads/{files[Path(f'{page}.ipynb')]}"


class Course(SphinxDirective):
    """A table of all notebooks: title, question, minutes, the file."""

    def run(self) -> list[nodes.Node]:
        lines = ["| | chapter | minutes | |", "| --- | --- | ---: | --- |"]
        for path in sorted(Path(self.env.srcdir, "notebooks").glob("*.ipynb")):
            self.env.note_dependency(str(path))
            title, question, minutes = chapter(path)
            question = f"<br>{question}" if question else ""
            link = f"[{title or path.stem}](/notebooks/{path.name})"
            file = f"{{download}}`download </notebooks/{path.name}>`"
            number = path.stem.partition("_")[0]
            lines.append(f"| {number} | {link}{question} | {minutes} | {file} |")
        self.content = StringList(lines)
        return self.parse_content_to_nodes()


def setup(app: Sphinx) -> dict[str, Any]:
    app.add_directive("course", Course)
    # Before the theme looks which parts of the sidebar are empty.
    app.connect("html-page-context", offer_notebook, priority=100)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
