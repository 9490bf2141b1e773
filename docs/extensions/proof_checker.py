"""The directive ``proof-checker``: the form of `proof_form`, in a page of the site."""

from __future__ import annotations

from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from docs.extensions.proof_form import CHECKER, PARTS, markup


class ProofChecker(SphinxDirective):
    """The form, in this place."""

    def run(self) -> list[nodes.Node]:
        for file in (CHECKER, *PARTS.iterdir()):
            self.env.note_dependency(str(file))
        return [nodes.raw("", markup(), format="html")]


def setup(app: Sphinx) -> dict[str, Any]:
    app.add_directive("proof-checker", ProofChecker)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
