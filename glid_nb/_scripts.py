"""What runs in the browser: modules joined into one, style sheets, shaders."""

import re
from pathlib import Path

_WIDGETS = Path(__file__).parent / "widgets"
_FOLDER = _WIDGETS / "js"
_IMPORT = re.compile(r'^import\s+\{[^}]*\}\s+from\s+"(\.\.?/[\w./-]+)";\n', re.MULTILINE)
_EXPORT = re.compile(r"^export (?=(?:async )?(?:class|const|function) )", re.MULTILINE)


def bundle(entry: str) -> str:
    """The text of ``widgets/js/entry`` after that of all modules it imports, each once.

    Modules import by name, ``import { a, b } from "./other.js";``, and share one scope when joined,
    so their top-level names must differ. Only the entry has a default export.
    """
    done: dict[str, str] = {}

    def add(path: Path, above: tuple[Path, ...]) -> None:
        if path in above:
            raise ValueError(f"{path.name} imports itself by way of {above[-1].name}")
        if str(path) in done:
            return
        text = path.read_text(encoding="utf-8")
        for found in _IMPORT.finditer(text):
            add((path.parent / found[1]).resolve(), (*above, path))
        done[str(path)] = _EXPORT.sub("", _IMPORT.sub("", text))

    add(_FOLDER / entry, ())
    return "\n".join(done.values())


def stylesheet(name: str) -> str:
    """The text of ``js/name``, after the rules that the canvas and the tracer share."""
    parts = (_FOLDER / "pad/pad.css", _FOLDER / name)
    return "\n".join(part.read_text(encoding="utf-8") for part in parts)


def glsl(name: str) -> str:
    """The text of a shader file."""
    return (_WIDGETS / "glsl" / name).read_text(encoding="utf-8")
