"""An index.html at the site's root that leads to the start page."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

_PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>glid_nb</title>
<meta http-equiv="refresh" content="0; url={target}">
<link rel="icon" href="_static/mark.svg">
</head>
<body><p><a href="{target}">glid_nb</a></p></body>
</html>
"""


def write(app: Sphinx, exception: Exception | None) -> None:
    if exception is None and app.builder.format == "html":
        target = app.builder.get_target_uri(app.config.root_doc)
        page = _PAGE.format(target=target)
        Path(app.outdir, "index.html").write_text(page, encoding="utf-8")
        # Folders that begin with an underscore are served too.
        Path(app.outdir, ".nojekyll").touch()


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("build-finished", write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
