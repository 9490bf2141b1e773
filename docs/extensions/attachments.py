"""Pictures that are attached to cells of notebooks, which MyST-NB does not read, become files."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx


def write_attachments(app: Sphinx, name: str, source: list[str]) -> None:
    """Write a notebook's attachments below the doctrees, and name those files in its cells."""
    if app.env.doc2path(name).suffix != ".ipynb":
        return
    book = json.loads(source[0])
    folder = Path(app.doctreedir).resolve() / "attachments" / name
    for cell in book["cells"]:
        for picture, (data,) in ((k, v.values()) for k, v in cell.pop("attachments", {}).items()):
            folder.mkdir(parents=True, exist_ok=True)
            (folder / picture).write_bytes(base64.b64decode(data))
            place = "/" + (folder / picture).relative_to(Path(app.srcdir).resolve()).as_posix()
            text = "".join(cell["source"])
            cell["source"] = text.replace(f"(attachment:{picture})", f"({place})")
    source[0] = json.dumps(book)


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("source-read", write_attachments)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
