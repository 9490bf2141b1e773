"""The live gecko of the start page: a page of its own beside it, which the start page frames."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

import glid_nb as glid


def gecko() -> str:
    """The sample at rest, with the pins of one of its poses."""
    image = glid.samples.image("gecko")
    pose = glid.io.load_pose(glid.samples.pose_path("gecko", "gentle"))
    rest = pose.with_targets(pose.handles)
    domain = glid.Domain.from_cage(glid.trace(image).cage)
    return glid.export.live_page_html(image, domain, rest, title="Gecko")


def write(app: Sphinx, exception: Exception | None) -> None:
    if exception is None and app.builder.format == "html":
        start = Path(app.outdir, app.builder.get_target_uri(app.config.root_doc))
        start.with_name("gecko.html").write_text(gecko(), encoding="utf-8")


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("build-finished", write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
