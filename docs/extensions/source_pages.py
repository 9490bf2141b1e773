"""Links from pages to the repository's files, each to a page of this site.

- A link to a Python or JavaScript file, or a Python file's path in code type
  (`glid_nb/certificate/paper.py`), opens a page with that source, at the first name in the link's
  text that the file defines.
- A link to a folder opens a list of its files, for download.
- A name of a module below the package's parts (`glid_nb.certificate.paper.turning`) opens its
  source in the same way.
- A page's path in code type (`docs/proof.md`) opens that page.
- A public name in code type (`glid.solve`, `HarmonicMap.sigma1`) opens the reference.

If the Python file of a path does not exist, there is a warning, so that pages follow the code.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from html import escape
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.builders.html import StandaloneHTMLBuilder
from sphinx.environment import BuildEnvironment
from sphinx.transforms import SphinxTransform
from sphinx.util import logging

import glid_nb

logger = logging.getLogger(__name__)

FOLDER = "files"
_LANGUAGES = {".py": "python", ".js": "javascript"}
_PATH = re.compile(r"((?:glid_nb|checker|studies|tests|tools)/[\w/.]+\.py)(?:::(\w+).*)?")
_PAGE = re.compile(r"(docs/[\w/.-]+)\.md")
_CLASSES = "|".join(name for name in dir(glid_nb) if name[0].isupper())
_NAME = re.compile(
    rf"(?:(?:glid|glid_nb)\.(?=\w)|(?=(?:{_CLASSES})\b))([\w.]+)(?:\(.*\))?", re.DOTALL
)


def source_of(dotted: str, root: Path) -> tuple[str, str] | None:
    """The file of a dotted name such as ``glid_nb.certificate.paper.turning``, and the name in it.

    None for shorter names: those of parts of the package are public, and the reference has them.
    """
    parts = dotted.split(".")
    for length in (3, 4) if parts[0] == "glid_nb" else ():
        path = "/".join(parts[:length]) + ".py"
        if len(parts) >= length and (root / path).is_file():
            return path, ".".join(parts[length:])
    return None


def _breakable(dotted: str) -> nodes.raw:
    """A dotted name in code type that may continue on the next line after each dot."""
    parts = "<wbr>".join(escape(part) for part in re.split(r"(?<=\.)", dotted))
    return nodes.raw("", f'<code class="docutils literal">{parts}</code>', format="html")


def definition(source: str, name: str) -> int | None:
    """The line, from 1, on which a name is defined."""
    last = re.escape(name.split("(", maxsplit=1)[0].rsplit(".", maxsplit=1)[-1])
    words = r"(?:export )?(?:(?:async )?def|class|function|const)"
    pattern = rf"^\s*{words} {last}\b|^{last}\s*[:=]"
    found = re.search(pattern, source, re.MULTILINE) if last else None
    return source.count("\n", 0, found.end()) + 1 if found else None


class RepositoryLinks(SphinxTransform):
    """Replaces references to files by links to their pages."""

    default_priority = 400

    def apply(self, **_: Any) -> None:
        self.root = Path(self.env.srcdir)
        self.seen: set[str] = set()
        for node in list(self.document.findall(addnodes.download_reference)):
            # MyST gives targets from the folder of the page.
            self._link(node, self._repository_path(node["reftarget"]))
        for node in list(self.document.findall(addnodes.pending_xref)):
            if node.get("reftype") == "myst":
                path = self._repository_path(node["reftarget"])
                if path and (self.root / path).is_dir():
                    self._link(node, path)
        for node in list(self.document.findall(nodes.literal)):
            self._literal(node)
        links(self.env)[self.env.docname] = self.seen

    def _repository_path(self, target: str) -> str:
        base = self.root if target.startswith("/") else self.root / Path(self.env.docname).parent
        path = (base / target.lstrip("/")).resolve()
        return path.relative_to(self.root).as_posix() if path.is_relative_to(self.root) else ""

    def _link(self, node: nodes.Element, path: str) -> None:
        file = self.root / path
        if not (path and (file.suffix in _LANGUAGES or file.is_dir())):
            return
        names = [literal.astext() for literal in node.findall(nodes.literal)]
        node.replace_self(self._reference(path, names, list(node.children)))

    def _reference(self, path: str, names: list[str], children: list[Any]) -> nodes.reference:
        self.seen.add(path)
        uri = self.app.builder.get_relative_uri(self.env.docname, f"{FOLDER}/{path}")
        if names and Path(path).suffix in _LANGUAGES:
            source = (self.root / path).read_text(encoding="utf-8")
            lines = [line for name in names if (line := definition(source, name))]
            uri += f"#L-{lines[0]}" if lines else ""
        return nodes.reference("", "", *children, refuri=uri, internal=True)

    def _literal(self, node: nodes.literal) -> None:
        parent = node.parent
        while parent is not None and not isinstance(parent, nodes.section):
            if isinstance(parent, nodes.reference | addnodes.pending_xref | nodes.title):
                return
            parent = parent.parent
        text = node.astext()
        if found := _PATH.fullmatch(text):
            if (self.root / found[1]).is_file():
                node.replace_self(self._reference(found[1], [found[2] or ""], [node.deepcopy()]))
            else:
                logger.warning("there is no file %s", found[1], location=node)
        elif (found := _PAGE.fullmatch(text)) and found[1] != self.env.docname:
            self._page(node, found[1])
        elif place := source_of(text, self.root):
            path, name = place
            node.replace_self(self._reference(path, [name], [_breakable(text)]))
        elif found := _NAME.fullmatch(text):
            target = f"glid_nb.{found[1]}"
            node.replace_self(
                addnodes.pending_xref(
                    "",
                    node.deepcopy(),
                    refdomain="py",
                    reftype="obj",
                    reftarget=target,
                    refdoc=self.env.docname,
                    refexplicit=True,
                )
            )

    def _page(self, node: nodes.literal, page: str) -> None:
        if page not in self.env.found_docs:
            logger.warning("there is no page %s.md", page, location=node)
            return
        uri = self.app.builder.get_relative_uri(self.env.docname, page)
        node.replace_self(nodes.reference("", "", node.deepcopy(), refuri=uri, internal=True))


def links(env: BuildEnvironment) -> dict[str, set[str]]:
    """Which files each page links to."""
    if not hasattr(env, "repository_links"):
        env.repository_links = {}  # type: ignore[attr-defined]
    return env.repository_links  # type: ignore[attr-defined]


def purge(_app: Sphinx, env: BuildEnvironment, docname: str) -> None:
    links(env).pop(docname, None)


def pages(app: Sphinx) -> Iterator[tuple[str, dict[str, Any], str]]:
    """A page for every file or folder that is linked to."""
    assert isinstance(app.builder, StandaloneHTMLBuilder)
    for path in sorted(set().union(*links(app.env).values())):
        file = Path(app.srcdir, path)
        if file.is_dir():
            body = "\n".join(_listed(app, file, path))
        else:
            source = file.read_text(encoding="utf-8")
            language = _LANGUAGES[file.suffix]
            body = app.builder.highlighter.highlight_block(source, language, lineanchors="L")
        title = f"<h1><code>{escape(path)}</code></h1>"
        yield f"{FOLDER}/{path}", {"title": path, "body": title + body, "parents": []}, "page.html"


def _listed(app: Sphinx, folder: Path, path: str) -> Iterator[str]:
    into = Path(app.outdir, FOLDER, path)
    into.mkdir(parents=True, exist_ok=True)
    yield "<ul>"
    for file in sorted(folder.iterdir()):
        if file.suffix in (".csv", ".json", ".png", ".webp"):
            shutil.copy(file, into)
            name = escape(file.name)
            yield f'<li><a class="reference" href="{escape(folder.name)}/{name}">{name}</a></li>'
    yield "</ul>"


def setup(app: Sphinx) -> dict[str, Any]:
    app.add_transform(RepositoryLinks)
    app.connect("env-purge-doc", purge)
    app.connect("html-collect-pages", pages)
    return {"parallel_read_safe": False, "parallel_write_safe": True, "env_version": 1}
