"""The files that Python hands to the browser.

The modules in ``js`` and their style sheets are bundled by ``make page`` into ``built``, which lies
in the repository, so neither installing nor running needs node.
"""

from pathlib import Path

_FOLDER = Path(__file__).parent


def bundle(name: str) -> str:
    """The JavaScript of ``built/name.js``: one of the entries in ``tools/build_page.js``."""
    return _read(f"built/{name}.js")


def stylesheet(name: str) -> str:
    """The style sheet ``built/name.css``."""
    return _read(f"built/{name}.css")


def template(name: str) -> str:
    """The HTML of ``html/name.html``, with places such as ``{{title}}`` to fill."""
    return _read(f"html/{name}.html")


def glsl(name: str) -> str:
    """The shader file ``glsl/name``."""
    return _read(f"glsl/{name}")


def _read(path: str) -> str:
    return (_FOLDER / path).read_text(encoding="utf-8")
